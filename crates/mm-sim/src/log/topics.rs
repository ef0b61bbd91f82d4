//! The topics of a log, each named once.

use super::schema::{self, Schema};

/// A topic.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Topic {
    RobotDescription,
    Reference,
    Tf,
    JointStates,
    Odom,
    Control,
    Path,
    Disturbance,
}

/// A name, and what makes its schema.
type Named = (&'static str, fn() -> Schema);

/// The topics in the order of their channels, which is that of [`PerTopic`].
pub(super) static TOPICS: [Named; 8] = [
    ("/robot_description", schema::string),
    ("/reference", schema::path),
    ("/tf", schema::tf_message),
    ("/joint_states", schema::joint_state),
    ("/odom", schema::odometry),
    ("/control", schema::control),
    ("/path", schema::path),
    ("/disturbance", schema::marker_array),
];

/// One value for each topic.
#[derive(Debug, Clone, Copy)]
pub(crate) struct PerTopic<T>([T; TOPICS.len()]);

impl<T> PerTopic<T> {
    /// The values that `make` gives for a topic's name and schema.
    pub(crate) fn try_make<E>(mut make: impl FnMut(&'static str, Schema) -> Result<T, E>) -> Result<Self, E>
    where
        T: Default,
    {
        let mut values: [T; TOPICS.len()] = Default::default();
        for (value, (name, schema)) in values.iter_mut().zip(&TOPICS) {
            *value = make(name, schema())?;
        }
        Ok(Self(values))
    }

    pub(crate) const fn of(&self, topic: Topic) -> &T {
        let [robot_description, reference, tf, joint_states, odom, control, path, disturbance] = &self.0;
        match topic {
            Topic::RobotDescription => robot_description,
            Topic::Reference => reference,
            Topic::Tf => tf,
            Topic::JointStates => joint_states,
            Topic::Odom => odom,
            Topic::Control => control,
            Topic::Path => path,
            Topic::Disturbance => disturbance,
        }
    }
}

/// The topics of a log and the types of their messages.
pub fn topics() -> impl Iterator<Item = (&'static str, &'static str)> {
    TOPICS.iter().map(|(topic, schema)| (*topic, schema().name))
}
