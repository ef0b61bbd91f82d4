//! The topics of a log, each named once.

use super::schema::{self, Schema};

/// A name, and what makes its schema.
type Topic = (&'static str, fn() -> Schema);

/// Topics and their types, in the order of their channels.
pub(super) static TOPICS: [Topic; 8] = [
    ("/robot_description", schema::string),
    ("/reference", schema::path),
    ("/tf", schema::tf_message),
    ("/joint_states", schema::joint_state),
    ("/odom", schema::odometry),
    ("/control", schema::control),
    ("/path", schema::path),
    ("/disturbance", schema::marker_array),
];

/// The topics of a log and the types of their messages.
pub fn topics() -> impl Iterator<Item = (&'static str, &'static str)> {
    TOPICS.iter().map(|(topic, schema)| (*topic, schema().name))
}
