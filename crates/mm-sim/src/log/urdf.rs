//! The robot as URDF, of boxes and cylinders, for the viewers' 3D scene.

use super::frames::{BASE, Joint, joints};
use core::f64::consts::FRAC_PI_2;
use mm_model::{Limits, RobotParams};
use std::fmt::{self, Write};

/// Length and width of the base's box, m; the model has no use for them.
const BASE_SIZE_M: [f64; 2] = [0.5, 0.4];
/// Smallest height of the base's box, m.
const BASE_MIN_HEIGHT_M: f64 = 0.08;
/// Width of a wheel, m.
const WHEEL_WIDTH_M: f64 = 0.03;
/// Radius of a link, m.
const LINK_RADIUS_M: f64 = 0.025;

/// Wheels, which come first among the joints.
const WHEELS: usize = 2;

/// What a drawing of the robot needs, and the masses that go with it, in SI units.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct RobotShape {
    /// Radius of a wheel, m.
    pub wheel_radius_m: f64,
    /// Distance between the wheels, m.
    pub track_width_m: f64,
    /// Distance of the arm's yaw axis ahead of the wheel axle, m.
    pub arm_offset_m: f64,
    /// Height of the arm's foot above the ground, m.
    pub mount_height_m: f64,
    /// Lengths of the three links, base to tip, m.
    pub link_lengths_m: [f64; 3],
    /// Mass of the base with its wheels, kg.
    pub base_mass_kg: f64,
    /// Distance of the base's centre of mass ahead of the wheel axle, m.
    pub base_com_offset_m: f64,
    /// Inertia of the base about the vertical through its centre of mass, kg m^2.
    pub base_yaw_inertia_kg_m2: f64,
    /// Masses of the links, kg.
    pub link_masses_kg: [f64; 3],
    /// Distances of the links' centres of mass from their joints, along the links, m.
    pub link_com_m: [f64; 3],
    /// Inertias of each link about its axis, the pitch axis and the normal to both, kg m^2.
    pub link_inertias_kg_m2: [[f64; 3]; 3],
}

impl From<&RobotParams<f64, 3>> for RobotShape {
    fn from(p: &RobotParams<f64, 3>) -> Self {
        Self {
            wheel_radius_m: p.wheel_radius,
            track_width_m: p.track_width,
            arm_offset_m: p.arm_offset,
            mount_height_m: p.mount_height,
            link_lengths_m: p.links.map(|link| link.length),
            base_mass_kg: p.base_mass,
            base_com_offset_m: p.base_com_offset,
            base_yaw_inertia_kg_m2: p.base_yaw_inertia,
            link_masses_kg: p.links.map(|link| link.mass),
            link_com_m: p.links.map(|link| link.com),
            link_inertias_kg_m2: p
                .links
                .map(|link| [link.axial_inertia, link.pitch_inertia, link.normal_inertia]),
        }
    }
}

/// Writes the URDF of a robot.
///
/// The root is `base_link`; its pose in `world` is on `/tf` alone, as everywhere in ROS. Joints are `right_wheel`,
/// `left_wheel`, `joint1` (about z), `joint2` and `joint3` (about -y: positive raises the link) and the fixed
/// `tip_joint`. Inertias are the model's: the wheels have none of their own, and the base's, of which the model
/// knows the vertical one only, is repeated on all axes.
#[must_use]
pub fn urdf(shape: &RobotShape) -> String {
    text_of(shape, None)
}

/// Writes the same with the largest torques, and with the ranges of the arm's joints, which a log may show beyond them.
#[must_use]
pub fn urdf_with_limits(shape: &RobotShape, limits: &Limits<f64, 3>) -> String {
    text_of(shape, Some(limits))
}

fn text_of(shape: &RobotShape, limits: Option<&Limits<f64, 3>>) -> String {
    let mut text = String::with_capacity(4096);
    // Formatting numbers into a string cannot fail.
    let _ = write_urdf(&mut text, shape, limits);
    text
}

fn write_urdf(text: &mut String, shape: &RobotShape, limits: Option<&Limits<f64, 3>>) -> fmt::Result {
    writeln!(text, "<?xml version=\"1.0\"?>\n<robot name=\"mmsim\">")?;
    writeln!(text, "  <material name=\"base\"><color rgba=\"0.35 0.40 0.46 1\"/></material>")?;
    writeln!(text, "  <material name=\"wheel\"><color rgba=\"0.12 0.12 0.13 1\"/></material>")?;
    writeln!(text, "  <material name=\"link\"><color rgba=\"0.90 0.49 0.13 1\"/></material>")?;
    write_base(text, shape)?;
    for wheel in ["right_wheel_link", "left_wheel_link"] {
        writeln!(text, "  <link name=\"{wheel}\">")?;
        let wheel = Body { center: [0.0; 3], tilt: [FRAC_PI_2, 0.0], color: "wheel" };
        wheel.write(text, &cylinder(shape.wheel_radius_m, WHEEL_WIDTH_M))?;
        writeln!(text, "  </link>")?;
    }
    for index in 0..3 {
        write_link(text, shape, index)?;
    }
    writeln!(text, "  <link name=\"tip\"/>")?;
    for (index, joint) in joints(shape).iter().enumerate() {
        write_joint(text, joint, limits.and_then(|limits| limit(limits, index)))?;
    }
    writeln!(text, "</robot>")
}

/// Where a solid stands in its frame and what colour it has.
struct Body {
    center: [f64; 3],
    /// Roll and pitch that turn the solid's z axis, rad.
    tilt: [f64; 2],
    color: &'static str,
}

impl Body {
    /// Writes the solid as what is seen and as what collides.
    fn write(&self, text: &mut String, geometry: &str) -> fmt::Result {
        let [x, y, z] = self.center;
        let [roll, pitch] = self.tilt;
        let origin = format!("<origin xyz=\"{x} {y} {z}\" rpy=\"{roll} {pitch} 0\"/>");
        let color = self.color;
        writeln!(text, "    <visual>{origin}{geometry}<material name=\"{color}\"/></visual>")?;
        writeln!(text, "    <collision>{origin}{geometry}</collision>")
    }
}

fn cylinder(radius_m: f64, length_m: f64) -> String {
    format!("<geometry><cylinder radius=\"{radius_m}\" length=\"{length_m}\"/></geometry>")
}

fn write_inertial(text: &mut String, mass_kg: f64, com: [f64; 3], inertia: [f64; 3]) -> fmt::Result {
    let ([x, y, z], [ixx, iyy, izz]) = (com, inertia);
    writeln!(text, "    <inertial><origin xyz=\"{x} {y} {z}\"/><mass value=\"{mass_kg}\"/>")?;
    writeln!(
        text,
        "      <inertia ixx=\"{ixx}\" ixy=\"0\" ixz=\"0\" iyy=\"{iyy}\" iyz=\"0\" izz=\"{izz}\"/></inertial>"
    )
}

/// The base: a box from the height of the axle up to the arm's foot, or a little higher.
fn write_base(text: &mut String, shape: &RobotShape) -> fmt::Result {
    let [length, width] = BASE_SIZE_M;
    let height = (shape.mount_height_m - shape.wheel_radius_m).max(BASE_MIN_HEIGHT_M);
    writeln!(text, "  <link name=\"{BASE}\">")?;
    let center = [shape.base_com_offset_m, 0.0, shape.wheel_radius_m + height / 2.0];
    let geometry = format!("<geometry><box size=\"{length} {width} {height}\"/></geometry>");
    Body { center, tilt: [0.0; 2], color: "base" }.write(text, &geometry)?;
    write_inertial(text, shape.base_mass_kg, center, [shape.base_yaw_inertia_kg_m2; 3])?;
    writeln!(text, "  </link>")
}

/// A link: a cylinder, upright for the first, along x for the others.
fn write_link(text: &mut String, shape: &RobotShape, index: usize) -> fmt::Result {
    let length = shape.link_lengths_m[index];
    let com = shape.link_com_m[index];
    let [axial, pitch, normal] = shape.link_inertias_kg_m2[index];
    let upright = index == 0;
    let along = |distance| if upright { [0.0, 0.0, distance] } else { [distance, 0.0, 0.0] };
    writeln!(text, "  <link name=\"link{}\">", index + 1)?;
    let tilt = if upright { [0.0; 2] } else { [0.0, FRAC_PI_2] };
    Body { center: along(length / 2.0), tilt, color: "link" }
        .write(text, &cylinder(LINK_RADIUS_M, length))?;
    let inertia = if upright { [normal, pitch, axial] } else { [axial, pitch, normal] };
    write_inertial(text, shape.link_masses_kg[index], along(com), inertia)?;
    writeln!(text, "  </link>")
}

/// Rate that no run reaches, rad/s: URDF asks for one and the model has none.
const ANY_RATE_RAD_S: f64 = 1000.0;

/// Range, for those that have one, and largest torque of a joint.
fn limit(limits: &Limits<f64, 3>, index: usize) -> Option<(Option<(f64, f64)>, f64)> {
    let of_arm = |joint: usize| Some((Some(*limits.joints.get(joint)?), *limits.joint_torque.get(joint)?));
    match index.checked_sub(WHEELS) {
        None => Some((None, limits.wheel_torque)),
        Some(joint) => of_arm(joint),
    }
}

fn write_joint(text: &mut String, joint: &Joint, limit: Option<(Option<(f64, f64)>, f64)>) -> fmt::Result {
    let Joint { name, parent, child, origin: [x, y, z], axis } = joint;
    let fixed = axis.iter().all(|component| *component == 0.0);
    let kind = match limit {
        _ if fixed => "fixed",
        Some((Some(_), _)) => "revolute",
        _ => "continuous",
    };
    writeln!(
        text,
        "  <joint name=\"{name}\" type=\"{kind}\"><parent link=\"{parent}\"/><child link=\"{child}\"/>"
    )?;
    write!(text, "    <origin xyz=\"{x} {y} {z}\" rpy=\"0 0 0\"/>")?;
    if !fixed {
        let [x, y, z] = axis;
        write!(text, "<axis xyz=\"{x} {y} {z}\"/>")?;
    }
    if let Some((range, torque)) = limit {
        write!(text, "\n    <limit")?;
        if let Some((lo, hi)) = range {
            write!(text, " lower=\"{lo}\" upper=\"{hi}\"")?;
        }
        write!(text, " effort=\"{torque}\" velocity=\"{ANY_RATE_RAD_S}\"/>")?;
    }
    writeln!(text, "</joint>")
}

#[cfg(test)]
pub(super) mod tests {
    use super::{RobotShape, urdf};

    /// The preset robot.
    pub(in crate::log) fn thesis_like() -> RobotShape {
        RobotShape::from(&mm_model::RobotParams::thesis())
    }

    #[test]
    fn joints_turn_about_the_axes_of_the_model() {
        let text = urdf(&thesis_like());
        for line in [
            "<joint name=\"right_wheel\" type=\"continuous\"><parent link=\"base_link\"/><child link=\"right_wheel_link\"/>\n    \
             <origin xyz=\"0 -0.1 0.06\" rpy=\"0 0 0\"/><axis xyz=\"0 1 0\"/>",
            "<joint name=\"joint1\" type=\"continuous\"><parent link=\"base_link\"/><child link=\"link1\"/>\n    \
             <origin xyz=\"0.06 0 0\" rpy=\"0 0 0\"/><axis xyz=\"0 0 1\"/>",
            "<joint name=\"joint2\" type=\"continuous\"><parent link=\"link1\"/><child link=\"link2\"/>\n    \
             <origin xyz=\"0 0 0.5\" rpy=\"0 0 0\"/><axis xyz=\"0 -1 0\"/>",
            "<joint name=\"tip_joint\" type=\"fixed\"><parent link=\"link3\"/><child link=\"tip\"/>\n    \
             <origin xyz=\"0.5 0 0\" rpy=\"0 0 0\"/></joint>",
        ] {
            assert!(text.contains(line), "missing {line} in\n{text}");
        }
    }

    #[test]
    fn the_urdf_is_a_tree_with_one_root() {
        let text = urdf(&thesis_like());
        let count = |what: &str| text.matches(what).count();
        assert_eq!(count("<link name="), 7, "base, two wheels, three links, tip");
        assert_eq!(count("<joint name="), 6, "one joint fewer than links");
        assert_eq!(count("<child link=\"base_link\"/>"), 0, "the base is the root");
        assert!(text.is_ascii(), "plain text");
    }
}
