//! The message definitions that travel in the file.
//!
//! A definition is the text of the message followed by those of the types it uses, each after a line of `=` and
//! a line `MSG: package/Type`.

use super::control::{FLAGS, NUMBERS};
use std::fmt::Write;

/// Name and full definition of a message type.
#[derive(Debug)]
pub(crate) struct Schema {
    /// `package/msg/Type`.
    pub(crate) name: &'static str,
    /// The definition with everything it uses.
    pub(crate) text: String,
}

/// How the definitions are written.
pub(crate) const SCHEMA_ENCODING: &str = "ros2msg";
/// How the messages are written.
pub(crate) const MESSAGE_ENCODING: &str = "cdr";
/// The profile of the file.
pub(super) const PROFILE: &str = "ros2";

const TIME: (&str, &str) = ("builtin_interfaces/Time", "int32 sec\nuint32 nanosec\n");
const HEADER: (&str, &str) = ("std_msgs/Header", "builtin_interfaces/Time stamp\nstring frame_id\n");
const POINT: (&str, &str) = ("geometry_msgs/Point", "float64 x\nfloat64 y\nfloat64 z\n");
const VECTOR3: (&str, &str) = ("geometry_msgs/Vector3", "float64 x\nfloat64 y\nfloat64 z\n");
const QUATERNION: (&str, &str) =
    ("geometry_msgs/Quaternion", "float64 x 0\nfloat64 y 0\nfloat64 z 0\nfloat64 w 1\n");
const POSE: (&str, &str) =
    ("geometry_msgs/Pose", "geometry_msgs/Point position\ngeometry_msgs/Quaternion orientation\n");
const POSE_STAMPED: (&str, &str) =
    ("geometry_msgs/PoseStamped", "std_msgs/Header header\ngeometry_msgs/Pose pose\n");
const POSE_WITH_COVARIANCE: (&str, &str) =
    ("geometry_msgs/PoseWithCovariance", "geometry_msgs/Pose pose\nfloat64[36] covariance\n");
const TWIST: (&str, &str) =
    ("geometry_msgs/Twist", "geometry_msgs/Vector3 linear\ngeometry_msgs/Vector3 angular\n");
const TWIST_WITH_COVARIANCE: (&str, &str) =
    ("geometry_msgs/TwistWithCovariance", "geometry_msgs/Twist twist\nfloat64[36] covariance\n");
const TRANSFORM: (&str, &str) =
    ("geometry_msgs/Transform", "geometry_msgs/Vector3 translation\ngeometry_msgs/Quaternion rotation\n");
const TRANSFORM_STAMPED: (&str, &str) = (
    "geometry_msgs/TransformStamped",
    "std_msgs/Header header\nstring child_frame_id\ngeometry_msgs/Transform transform\n",
);

const DURATION: (&str, &str) = ("builtin_interfaces/Duration", "int32 sec\nuint32 nanosec\n");
const COLOR: (&str, &str) = ("std_msgs/ColorRGBA", "float32 r\nfloat32 g\nfloat32 b\nfloat32 a\n");
const IMAGE: (&str, &str) =
    ("sensor_msgs/CompressedImage", "std_msgs/Header header\nstring format\nuint8[] data\n");
const UV: (&str, &str) = ("visualization_msgs/UVCoordinate", "float32 u\nfloat32 v\n");
const MESH: (&str, &str) = ("visualization_msgs/MeshFile", "string filename\nuint8[] data\n");
const MARKER: (&str, &str) = (
    "visualization_msgs/Marker",
    "int32 ARROW=0\nint32 ADD=0\nint32 DELETE=2\nstd_msgs/Header header\nstring ns\nint32 id\nint32 type\nint32 action\n\
     geometry_msgs/Pose pose\ngeometry_msgs/Vector3 scale\nstd_msgs/ColorRGBA color\n\
     builtin_interfaces/Duration lifetime\nbool frame_locked\ngeometry_msgs/Point[] points\n\
     std_msgs/ColorRGBA[] colors\nstring texture_resource\nsensor_msgs/CompressedImage texture\n\
     visualization_msgs/UVCoordinate[] uv_coordinates\nstring text\nstring mesh_resource\n\
     visualization_msgs/MeshFile mesh_file\nbool mesh_use_embedded_materials\n",
);

/// `tf2_msgs/msg/TFMessage`.
pub(super) fn tf_message() -> Schema {
    let uses = [TRANSFORM_STAMPED, HEADER, TIME, TRANSFORM, VECTOR3, QUATERNION];
    schema("tf2_msgs/msg/TFMessage", "geometry_msgs/TransformStamped[] transforms\n", &uses)
}

/// `std_msgs/msg/String`.
pub(super) fn string() -> Schema {
    schema("std_msgs/msg/String", "string data\n", &[])
}

/// `sensor_msgs/msg/JointState`.
pub(super) fn joint_state() -> Schema {
    let text =
        "std_msgs/Header header\nstring[] name\nfloat64[] position\nfloat64[] velocity\nfloat64[] effort\n";
    schema("sensor_msgs/msg/JointState", text, &[HEADER, TIME])
}

/// `nav_msgs/msg/Odometry`.
pub(super) fn odometry() -> Schema {
    let text = "std_msgs/Header header\nstring child_frame_id\ngeometry_msgs/PoseWithCovariance pose\n\
                geometry_msgs/TwistWithCovariance twist\n";
    let uses =
        [HEADER, TIME, POSE_WITH_COVARIANCE, POSE, POINT, QUATERNION, TWIST_WITH_COVARIANCE, TWIST, VECTOR3];
    schema("nav_msgs/msg/Odometry", text, &uses)
}

/// `nav_msgs/msg/Path`.
pub(super) fn path() -> Schema {
    let text = "std_msgs/Header header\ngeometry_msgs/PoseStamped[] poses\n";
    schema("nav_msgs/msg/Path", text, &[HEADER, TIME, POSE_STAMPED, POSE, POINT, QUATERNION])
}

/// `visualization_msgs/msg/MarkerArray`.
pub(super) fn marker_array() -> Schema {
    let uses = [MARKER, HEADER, TIME, POSE, POINT, QUATERNION, VECTOR3, COLOR, DURATION, IMAGE, UV, MESH];
    schema("visualization_msgs/msg/MarkerArray", "visualization_msgs/Marker[] markers\n", &uses)
}

/// `mmsim_msgs/msg/Control`, our own.
pub(super) fn control() -> Schema {
    let mut text = String::from("# One control instant, in SI units and radians.\nstd_msgs/Header header\n");
    // Formatting into a string cannot fail.
    for field in &NUMBERS {
        let _ = writeln!(text, "float64 {} # {}", field.name, field.comment);
    }
    for field in &FLAGS {
        let _ = writeln!(text, "bool {} # {}", field.name, field.comment);
    }
    schema("mmsim_msgs/msg/Control", &text, &[HEADER, TIME])
}

fn schema(name: &'static str, own: &str, uses: &[(&str, &str)]) -> Schema {
    let mut text = String::from(own);
    for (used, definition) in uses {
        text.push_str(&"=".repeat(80));
        let _ = write!(text, "\nMSG: {used}\n{definition}");
    }
    Schema { name, text }
}

#[cfg(test)]
mod tests {
    use super::{Schema, joint_state};
    use crate::log::topics::TOPICS;

    #[test]
    fn a_definition_brings_every_type_it_uses_once() {
        for Schema { name, text } in TOPICS.map(|(_, schema)| schema()) {
            let defined: Vec<&str> = text.lines().filter_map(|line| line.strip_prefix("MSG: ")).collect();
            for line in text.lines().filter(|line| !line.starts_with("MSG: ")) {
                let Some((used, _)) = line.split_once(' ') else { continue };
                let used = used.trim_end_matches("[]");
                let count = defined.iter().filter(|known| **known == used).count();
                assert!(!used.contains('/') || count == 1, "{name}: {used} is defined {count} times");
            }
            for known in defined {
                assert!(
                    text.contains(&format!("{known} ")) || text.contains(&format!("{known}[] ")),
                    "{name}: {known} is not used"
                );
            }
        }
    }

    #[test]
    fn the_separator_is_a_line_of_eighty() {
        let separator = format!("\n{}\nMSG: std_msgs/Header\n", "=".repeat(80));
        assert!(joint_state().text.contains(&separator), "as recorders write it");
    }
}
