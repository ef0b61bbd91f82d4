//! The plots of the report, as data: adding one is a line here.

use serde::Serialize;

/// Plots that belong together.
#[derive(Debug, Clone, Copy, Serialize)]
pub(super) struct Section {
    pub(super) title: &'static str,
    pub(super) plots: &'static [Plot],
}

/// A signal over time, a curve for each run.
#[derive(Debug, Clone, Copy, Serialize)]
pub(super) struct Plot {
    pub(super) title: &'static str,
    /// Unit of what is shown.
    pub(super) unit: &'static str,
    /// What the signal is multiplied by, for that unit.
    pub(super) factor: f64,
    /// Name of the field in the log, or [`ERROR_NORM`].
    pub(super) signal: &'static str,
    /// What the signal should follow; none if nothing.
    pub(super) desired: Option<&'static str>,
    pub(super) is_logarithmic: bool,
}

/// Distance of the tip from its reference, which the log holds by its components.
pub(super) const ERROR_NORM: &str = "error_norm_m";

const fn plot(title: &'static str, unit: &'static str, signal: &'static str) -> Plot {
    Plot { title, unit, factor: 1.0, signal, desired: None, is_logarithmic: false }
}

const fn error(title: &'static str, signal: &'static str) -> Plot {
    Plot { factor: 1e3, ..plot(title, "mm", signal) }
}

impl Plot {
    const fn follows(self, desired: &'static str) -> Self {
        Self { desired: Some(desired), ..self }
    }
}

/// All plots, in the order of the page. One without a signal in any run, or zero in all, is left out.
pub(super) static SECTIONS: &[Section] = &[
    Section {
        title: "Error of the tip",
        plots: &[
            Plot { is_logarithmic: true, ..error("|error|", ERROR_NORM) },
            error("error x", "error_x_m"),
            error("error y", "error_y_m"),
            error("error z", "error_z_m"),
        ],
    },
    Section {
        title: "Position of the tip",
        plots: &[
            plot("tip x", "m", "tip_x_m").follows("reference_x_m"),
            plot("tip y", "m", "tip_y_m").follows("reference_y_m"),
            plot("tip z", "m", "tip_z_m").follows("reference_z_m"),
        ],
    },
    Section {
        title: "Torques at the plant's input",
        plots: &[
            plot("joint 1", "N m", "torque_applied_joint1_n_m"),
            plot("joint 2", "N m", "torque_applied_joint2_n_m"),
            plot("joint 3", "N m", "torque_applied_joint3_n_m"),
            plot("right wheel", "N m", "torque_applied_right_n_m"),
            plot("left wheel", "N m", "torque_applied_left_n_m"),
        ],
    },
    Section {
        title: "Disturbance",
        plots: &[
            plot("on joint 1", "N m", "disturbance_joint1_n_m"),
            plot("on joint 2", "N m", "disturbance_joint2_n_m"),
            plot("on joint 3", "N m", "disturbance_joint3_n_m"),
            plot("on right wheel", "N m", "disturbance_right_n_m"),
            plot("on left wheel", "N m", "disturbance_left_n_m"),
        ],
    },
    Section {
        title: "Base",
        plots: &[
            plot("forward speed", "m/s", "forward_m_s").follows("virtual_forward_m_s"),
            plot("yaw rate", "rad/s", "yaw_rate_rad_s").follows("virtual_yaw_rate_rad_s"),
            plot("heading", "rad", "heading_rad"),
        ],
    },
    Section {
        title: "Arm",
        plots: &[
            plot("joint 1", "rad", "joint1_rad"),
            plot("joint 2", "rad", "joint2_rad"),
            plot("joint 3", "rad", "joint3_rad"),
            plot("rate of joint 1", "rad/s", "joint1_rate_rad_s").follows("virtual_joint1_rad_s"),
            plot("rate of joint 2", "rad/s", "joint2_rate_rad_s").follows("virtual_joint2_rad_s"),
            plot("rate of joint 3", "rad/s", "joint3_rate_rad_s").follows("virtual_joint3_rad_s"),
        ],
    },
    Section {
        title: "Sliding variables",
        plots: &[
            plot("forward", "m/s", "sliding_forward_m_s"),
            plot("yaw", "rad/s", "sliding_yaw_rate_rad_s"),
            plot("joint 1", "rad/s", "sliding_joint1_rad_s"),
            plot("joint 2", "rad/s", "sliding_joint2_rad_s"),
            plot("joint 3", "rad/s", "sliding_joint3_rad_s"),
            plot("V = s'Ms/2", "J", "lyapunov_j"),
        ],
    },
    Section {
        title: "What the law learned",
        plots: &[
            plot("forward", "N", "learned_forward_n"),
            plot("yaw", "N m", "learned_yaw_n_m"),
            plot("joint 1", "N m", "learned_joint1_n_m"),
            plot("joint 2", "N m", "learned_joint2_n_m"),
            plot("joint 3", "N m", "learned_joint3_n_m"),
        ],
    },
    Section { title: "Conditions", plots: &[plot("manipulability", "", "manipulability")] },
];

/// What the replay needs besides the plots.
const REPLAY: [&str; 4] = ["x_m", "y_m", "wheel_right_rad", "wheel_left_rad"];

/// Names of all signals that the page shows, and whether only their logarithm is; each once.
pub(super) fn signals() -> Vec<(&'static str, bool)> {
    let plots = SECTIONS.iter().flat_map(|section| section.plots);
    let of = |plot: &Plot| {
        let own = (plot.signal, plot.is_logarithmic);
        core::iter::once(own).chain(plot.desired.map(|desired| (desired, false)))
    };
    let mut all: Vec<(&str, bool)> = REPLAY.into_iter().map(|name| (name, false)).collect();
    for signal in plots.flat_map(of) {
        if !all.contains(&signal) {
            all.push(signal);
        }
    }
    all
}

#[cfg(test)]
mod tests {
    use super::{ERROR_NORM, signals};
    use crate::log::control_field_names;

    #[test]
    fn every_signal_is_a_field_of_the_log() {
        let fields: Vec<&str> = control_field_names().collect();
        for (name, _) in signals() {
            assert!(name == ERROR_NORM || fields.contains(&name), "{name} is no field of /control");
        }
    }
}
