//! The signals of an update in the order in which it computes them.

use core::fmt;

use mm_control::{Output, Status};
use mm_model::Torque;
use nalgebra::Vector3;

use crate::Scalar;

/// The stages of an update in their order.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Stage {
    /// The velocity, known or estimated.
    Estimate,
    /// Tip, its error, the virtual control, manipulability and damping.
    Kinematics,
    /// nu_r, its rate, the sliding variable, the equivalent force.
    Dynamics,
    /// The forces of the fuzzy system and of the observer.
    Fuzzy,
    /// The torque before and after the limits, and the outcomes.
    Torque,
}

impl fmt::Display for Stage {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Estimate => "estimate",
            Self::Kinematics => "kinematics",
            Self::Dynamics => "dynamics",
            Self::Fuzzy => "fuzzy",
            Self::Torque => "torque",
        })
    }
}

/// One of the numbers that an update gives.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Signal {
    /// Stage that computes it.
    pub stage: Stage,
    /// Field of [`mm_control::Signals`] or [`Output`].
    pub name: &'static str,
    /// Place of the number in that field, from 0.
    pub index: usize,
}

impl fmt::Display for Signal {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}: {}[{}]", self.stage, self.name, self.index)
    }
}

/// What is compared of each update, besides the outcomes: stage, name and how many numbers.
pub const SIGNALS: [(Stage, &str, usize); 14] = [
    (Stage::Estimate, "nu", 5),
    (Stage::Kinematics, "tip", 3),
    (Stage::Kinematics, "error", 3),
    (Stage::Kinematics, "nu_c", 5),
    (Stage::Kinematics, "manipulability_squared", 1),
    (Stage::Kinematics, "damping_squared", 1),
    (Stage::Dynamics, "nu_r", 5),
    (Stage::Dynamics, "dnu_r", 5),
    (Stage::Dynamics, "sliding", 5),
    (Stage::Dynamics, "equivalent", 5),
    (Stage::Fuzzy, "fuzzy", 5),
    (Stage::Fuzzy, "learned", 5),
    (Stage::Torque, "commanded", 5),
    (Stage::Torque, "torque", 5),
];

/// Numbers that are compared of each update.
pub const COUNT: usize = {
    let mut count = 0;
    let mut rest: &[(Stage, &str, usize)] = &SIGNALS;
    while let [(_, _, numbers), others @ ..] = rest {
        count += *numbers;
        rest = others;
    }
    count
};

/// The numbers of an update, in the order of [`SIGNALS`].
pub fn numbers<T: Scalar>(output: &Output<T, 3>) -> impl Iterator<Item = T> + '_ {
    let signals = &output.signals;
    let kinematics = space(&signals.tip).chain(space(&signals.error)).chain(signals.nu_c.channels());
    let dynamics = signals.nu_r.channels().chain(signals.dnu_r.channels()).chain(signals.sliding.channels());
    let torques = channels(&signals.commanded).chain(channels(&output.torque));
    (signals.nu.channels())
        .chain(kinematics)
        .chain([signals.manipulability_squared, signals.damping_squared])
        .chain(dynamics)
        .chain(signals.equivalent.channels())
        .chain(signals.fuzzy.channels())
        .chain(signals.learned.channels())
        .chain(torques)
}

/// Which signal the number at a place is; the outcomes behind the last.
#[must_use]
pub fn signal(mut place: usize) -> Signal {
    for (stage, name, count) in SIGNALS {
        if place < count {
            return Signal { stage, name, index: place };
        }
        place -= count;
    }
    Signal { stage: Stage::Torque, name: "status", index: 0 }
}

/// The outcomes, one bit each.
#[must_use]
pub fn outcomes(status: &Status) -> u32 {
    let Status { saturated, near_singular, speed_limited, joint_limited, beyond_joint_limit } = *status;
    [saturated, near_singular, speed_limited, joint_limited, beyond_joint_limit]
        .into_iter()
        .rfold(0, |bits, outcome| bits << 1 | u32::from(outcome))
}

fn space<T: Scalar>(v: &Vector3<T>) -> impl Iterator<Item = T> {
    [v.x, v.y, v.z].into_iter()
}

fn channels<T: Scalar>(torque: &Torque<T, 3>) -> impl Iterator<Item = T> + '_ {
    [torque.right, torque.left].into_iter().chain(torque.joints)
}
