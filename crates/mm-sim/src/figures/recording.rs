//! The samples of a run, column by column.

use std::io::{self, Write};

use mm_model::{Real, Robot};
use nalgebra::Vector3;

use crate::channels::{torques, velocities};
use crate::experiment::Experiment;
use crate::log::LogFile;
use crate::simulation::{Recorder, Sample};

/// Columns that belong together.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Group {
    /// Time.
    Time,
    /// Midpoint of the wheel axle, and heading.
    Pose,
    /// Joint angles.
    Joints,
    /// Velocity nu.
    Velocity,
    /// Virtual velocity nu_c, which nu should follow; nu itself where velocities are imposed.
    Virtual,
    /// Position of the tip.
    Tip,
    /// Velocity of the tip, J nu.
    TipVelocity,
    /// Desired position of the tip.
    Reference,
    /// Desired velocity of the tip.
    ReferenceVelocity,
    /// Error of the tip, actual minus desired.
    Error,
    /// Torques at the plant's input.
    Torque,
    /// Disturbance, as torques on the actuators' axes.
    Disturbance,
    /// Sliding variable; zero where velocities are imposed.
    Sliding,
    /// Manipulability.
    Manipulability,
}

impl Group {
    /// All of them, in the order of the columns.
    pub const ALL: [Self; 14] = [
        Self::Time,
        Self::Pose,
        Self::Joints,
        Self::Velocity,
        Self::Virtual,
        Self::Tip,
        Self::TipVelocity,
        Self::Reference,
        Self::ReferenceVelocity,
        Self::Error,
        Self::Torque,
        Self::Disturbance,
        Self::Sliding,
        Self::Manipulability,
    ];

    /// Names of its columns, with their units.
    #[must_use]
    pub const fn names(self) -> &'static [&'static str] {
        match self {
            Self::Time => &["t_s"],
            Self::Pose => &["x_m", "y_m", "heading_rad"],
            Self::Joints => &["joint1_rad", "joint2_rad", "joint3_rad"],
            Self::Velocity => {
                &["forward_m_s", "yaw_rate_rad_s", "joint1_rad_s", "joint2_rad_s", "joint3_rad_s"]
            }
            Self::Virtual => &[
                "virtual_forward_m_s",
                "virtual_yaw_rate_rad_s",
                "virtual_joint1_rad_s",
                "virtual_joint2_rad_s",
                "virtual_joint3_rad_s",
            ],
            Self::Tip => &["tip_x_m", "tip_y_m", "tip_z_m"],
            Self::TipVelocity => &["tip_x_m_s", "tip_y_m_s", "tip_z_m_s"],
            Self::Reference => &["reference_x_m", "reference_y_m", "reference_z_m"],
            Self::ReferenceVelocity => &["reference_x_m_s", "reference_y_m_s", "reference_z_m_s"],
            Self::Error => &["error_x_m", "error_y_m", "error_z_m"],
            Self::Torque => &[
                "torque_right_n_m",
                "torque_left_n_m",
                "torque_joint1_n_m",
                "torque_joint2_n_m",
                "torque_joint3_n_m",
            ],
            Self::Disturbance => &[
                "disturbance_right_n_m",
                "disturbance_left_n_m",
                "disturbance_joint1_n_m",
                "disturbance_joint2_n_m",
                "disturbance_joint3_n_m",
            ],
            Self::Sliding => &[
                "sliding_forward_m_s",
                "sliding_yaw_rate_rad_s",
                "sliding_joint1_rad_s",
                "sliding_joint2_rad_s",
                "sliding_joint3_rad_s",
            ],
            Self::Manipulability => &["manipulability"],
        }
    }

    /// Names of its columns among the fields of a log's `/control`; none of the tip's velocity, which is not logged.
    #[must_use]
    pub const fn log_names(self) -> &'static [&'static str] {
        match self {
            Self::Velocity => &[
                "forward_m_s",
                "yaw_rate_rad_s",
                "joint1_rate_rad_s",
                "joint2_rate_rad_s",
                "joint3_rate_rad_s",
            ],
            Self::ReferenceVelocity => &["reference_dx_m_s", "reference_dy_m_s", "reference_dz_m_s"],
            Self::Torque => &[
                "torque_applied_right_n_m",
                "torque_applied_left_n_m",
                "torque_applied_joint1_n_m",
                "torque_applied_joint2_n_m",
                "torque_applied_joint3_n_m",
            ],
            Self::TipVelocity => &[],
            other => other.names(),
        }
    }

    /// Number of the columns before its first one.
    fn offset(self) -> usize {
        Self::ALL.iter().take_while(|group| **group != self).map(|group| group.names().len()).sum()
    }
}

/// A recorder that keeps every sample: one column a quantity, at the log rate of the scenario.
#[derive(Debug, Clone)]
pub struct Recording {
    /// The robot whose tip velocity is recorded; none where samples come from a log.
    robot: Option<Robot<f64, 3>>,
    is_imposed: bool,
    columns: Vec<Vec<f64>>,
}

impl Recording {
    /// An empty recording of an experiment.
    #[must_use]
    pub fn of(experiment: &Experiment) -> Self {
        Self {
            robot: Some(*experiment.plant().robot()),
            is_imposed: matches!(experiment, Experiment::Open(_)),
            columns: vec![Vec::new(); Self::names().count()],
        }
    }

    /// The recording that a log holds. The tip's velocity, which is not logged, comes of differences of its position.
    #[must_use]
    pub fn of_log(log: &LogFile) -> Self {
        let mut columns = Vec::new();
        for group in Group::ALL {
            if group == Group::TipVelocity {
                let rate = |name: &&str| slopes(log.columns.time(), log.columns.get(name));
                columns.extend(Group::Tip.log_names().iter().map(rate));
            } else {
                columns.extend(group.log_names().iter().map(|name| log.columns.get(name).to_vec()));
            }
        }
        Self { robot: None, is_imposed: log.says("controller") == "none", columns }
    }

    /// A column by the name of its field in a log's `/control`; empty if it is not recorded.
    #[must_use]
    pub fn named(&self, log_name: &str) -> &[f64] {
        let place = |group: &Group| group.log_names().iter().position(|name| *name == log_name);
        let found = Group::ALL.iter().find_map(|group| place(group).map(|number| (*group, number)));
        found.map_or(&[], |(group, number)| self.column(group, number))
    }

    /// Names of all columns, in order.
    pub fn names() -> impl Iterator<Item = &'static str> {
        Group::ALL.into_iter().flat_map(|group| group.names().iter().copied())
    }

    /// One column of a group; empty if the group has no such column.
    #[must_use]
    pub fn column(&self, group: Group, number: usize) -> &[f64] {
        if number >= group.names().len() {
            return &[];
        }
        self.columns.get(group.offset() + number).map_or(&[], Vec::as_slice)
    }

    /// Times of the samples, s.
    #[must_use]
    pub fn time(&self) -> &[f64] {
        self.column(Group::Time, 0)
    }

    /// Whether the velocities were imposed: then the reference is the motion in closed form.
    #[must_use]
    pub const fn is_imposed(&self) -> bool {
        self.is_imposed
    }

    /// Points in space: the three columns of a group.
    #[must_use]
    pub fn points(&self, group: Group) -> Vec<[f64; 3]> {
        let [x, y, z] = [0, 1, 2].map(|number| self.column(group, number));
        x.iter().zip(y).zip(z).map(|((&x, &y), &z)| [x, y, z]).collect()
    }

    /// Largest distance of the tip from its reference at samples from time `from` on, m; none without such samples.
    #[must_use]
    pub fn largest_error(&self, from: f64) -> Option<f64> {
        let errors = self.points(Group::Error);
        let late = self.time().iter().zip(errors).filter(|(t, _)| **t >= from);
        late.map(|(_, e)| Vector3::from(e).norm()).reduce(f64::max)
    }

    /// Writes the columns as CSV with a header line, in seven significant digits.
    ///
    /// # Errors
    /// Those of the writer.
    pub fn write_csv(&self, out: &mut impl Write) -> io::Result<()> {
        writeln!(out, "{}", Self::names().collect::<Vec<_>>().join(","))?;
        for row in 0..self.time().len() {
            for (number, column) in self.columns.iter().enumerate() {
                if number > 0 {
                    out.write_all(b",")?;
                }
                #[expect(clippy::cast_possible_truncation, reason = "seven digits are what is written")]
                let value = column.get(row).map_or(f32::NAN, |value| *value as f32);
                write!(out, "{value:?}")?;
            }
            out.write_all(b"\n")?;
        }
        Ok(())
    }

    fn push(&mut self, group: Group, values: &[f64]) {
        let columns = self.columns.iter_mut().skip(group.offset());
        for (column, value) in columns.zip(values) {
            column.push(*value);
        }
    }
}

impl Recorder for Recording {
    type Error = core::convert::Infallible;

    fn record(&mut self, sample: &Sample<'_>) -> Result<bool, Self::Error> {
        let state = sample.state;
        let Some(robot) = self.robot else { return Ok(false) };
        let tip_velocity = robot.jacobian(&state.q).product(&state.nu);
        let signals = sample.output.map(|output| &output.signals);
        self.push(Group::Time, &[sample.t]);
        self.push(Group::Pose, &[state.q.x, state.q.y, state.q.heading]);
        self.push(Group::Joints, &state.q.joints);
        self.push(Group::Velocity, &velocities(&state.nu));
        self.push(Group::Virtual, &velocities(signals.map_or(&state.nu, |signals| &signals.nu_c)));
        self.push(Group::Tip, sample.tip.as_slice());
        self.push(Group::TipVelocity, tip_velocity.as_slice());
        self.push(Group::Reference, sample.reference.position.as_slice());
        self.push(Group::ReferenceVelocity, sample.reference.velocity.as_slice());
        self.push(Group::Error, (sample.tip - sample.reference.position).as_slice());
        self.push(Group::Torque, &torques(sample.torque));
        self.push(Group::Disturbance, &torques(&robot.torque_of(&sample.external)));
        self.push(Group::Sliding, &signals.map_or([0.0; 5], |signals| velocities(&signals.sliding)));
        self.push(Group::Manipulability, &[Real::sqrt(Real::max(sample.manipulability_squared, 0.0))]);
        Ok(true)
    }
}

/// Central differences of a column, one-sided at its ends.
fn slopes(time: &[f64], values: &[f64]) -> Vec<f64> {
    let at = |column: &[f64], i: usize| column.get(i).or(column.last()).copied().unwrap_or_default();
    let slope = |i: usize| {
        let (before, after) = (i.saturating_sub(1), i + 1);
        let span = at(time, after) - at(time, before);
        if span > 0.0 { (at(values, after) - at(values, before)) / span } else { 0.0 }
    };
    (0..values.len()).map(slope).collect()
}
