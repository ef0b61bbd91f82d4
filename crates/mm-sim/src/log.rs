//! Logs of a run: MCAP files that the usual viewers open without being told anything.
//!
//! The file has the `ros2` profile: CDR messages with `ros2msg` schemas.
//!
//! | topic | type | when |
//! | --- | --- | --- |
//! | `/robot_description` | `std_msgs/msg/String` | once, first: the robot as URDF |
//! | `/reference` | `nav_msgs/msg/Path` | once: the whole desired path |
//! | `/tf` | `tf2_msgs/msg/TFMessage` | every sample: world to base, wheels, links and tip |
//! | `/joint_states` | `sensor_msgs/msg/JointState` | every sample |
//! | `/odom` | `nav_msgs/msg/Odometry` | every sample: the base's true pose and speed |
//! | `/control` | `mmsim_msgs/msg/Control` | every sample: everything the controller knew and did |
//! | `/path` | `nav_msgs/msg/Path` | twice per simulated second: where the tip has been |
//! | `/disturbance` | `visualization_msgs/msg/MarkerArray` | while something disturbs, up to 20 times per simulated second: arrows |
//!
//! Stamps are the scenario's time. The scenario's text (attachment `scenario.toml`), those of the files that it names and what
//! identifies the run (metadata `mmsim`) stand at the start of the file, so a run that is killed leaves them behind; the summary
//! (attachment `summary.json`) and the outcome (metadata `mmsim.result`) stand at its end. A file without
//! `mmsim.result` is that of a run that did not finish.

mod arrows;
mod cdr;
mod control;
mod convert;
mod encoder;
mod error;
mod frames;
mod header;
mod info;
mod messages;
pub mod read;
mod recover;
mod run_log;
mod sample;
mod scan;
mod schema;
mod timely;
mod topics;
mod trail;
mod urdf;
mod writer;

pub use control::control_field_names;
pub use error::LogError;
pub use header::{LogHeader, Outcome, edits};
pub use info::{AttachmentInfo, LogInfo, TopicInfo};
pub use read::{LogFile, ReadError};
pub use recover::{RECOVERED, Recovered, recover, recover_stream};
pub use run_log::RunLog;
pub use sample::LogSample;
pub use scan::{Damage, End, Scan};
pub use topics::topics;
pub use urdf::{RobotShape, urdf, urdf_with_limits};
pub use writer::LogWriter;
#[cfg(feature = "live")]
pub(crate) use {
    convert::{Converter, with_header},
    encoder::{Encoder, Message},
    schema::{MESSAGE_ENCODING, SCHEMA_ENCODING},
    topics::{PerTopic, Topic},
};
