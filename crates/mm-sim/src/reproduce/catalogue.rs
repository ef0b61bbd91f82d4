//! The experiments of the thesis and its figures, as data.

use crate::figures::Kind;

/// An experiment: a bundled scenario with the laws that run it.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Experiment {
    /// Name in tables and file names.
    pub name: &'static str,
    /// Section of the thesis.
    pub section: &'static str,
    /// Bundled scenario.
    pub scenario: &'static str,
    /// Edits that make the experiment of the scenario.
    pub sets: &'static [&'static str],
    /// Laws, each a run.
    pub controllers: &'static [&'static str],
}

/// A figure of the thesis and what stands for it.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Figure {
    /// Number in the thesis; of an addition, a name.
    pub number: &'static str,
    /// What it shows, in short.
    pub caption: &'static str,
    /// Name of the experiment.
    pub experiment: &'static str,
    /// Runs shown; all of the experiment if empty.
    pub controllers: &'static [&'static str],
    /// How it is shown.
    pub kind: Kind,
}

const fn verify(name: &'static str, section: &'static str, scenario: &'static str) -> Experiment {
    Experiment { name, section, scenario, sets: &[], controllers: &["none"] }
}

const fn track(name: &'static str, section: &'static str) -> Experiment {
    Experiment { name, section, scenario: name, sets: &[], controllers: &["bfsmc"] }
}

/// The laws of the comparisons. The thesis's fuzzy law is `bfsmc-thesis`; `bfsmc` is another one.
const COMPARED: &[&str] = &["bsmc", "bfsmc-thesis", "bfsmc"];

const fn compare(name: &'static str, section: &'static str) -> Experiment {
    Experiment { name, section, scenario: name, sets: &[], controllers: COMPARED }
}

/// All experiments, in the order of the thesis. One whose scenario is not bundled is left out.
pub static EXPERIMENTS: &[Experiment] = &[
    verify("verify-straight", "3.7.1", "verify-straight"),
    verify("verify-circle", "3.7.2", "verify-circle"),
    verify("verify-reverse-circle", "3.7.3", "verify-reverse-circle"),
    verify("verify-joint2", "3.7.3", "verify-joint2"),
    verify("verify-joints23", "3.7.3", "verify-joints23"),
    Experiment {
        name: "verify-resting-base",
        section: "3.7.3",
        scenario: "verify-moving-base",
        sets: &["trajectory.segment.0.forward_m_s=0"],
        controllers: &["none"],
    },
    verify("verify-moving-base", "3.7.3", "verify-moving-base"),
    track("sinusoid", "5.3"),
    track("sinusoid-base-held", "5.3"),
    track("spiral", "5.4"),
    track("square", "5.5"),
    track("spiral-disturbed", "5.6.1"),
    track("step-disturbed", "5.6.2"),
    compare("spiral-compare", "5.7"),
    compare("square-compare", "5.8"),
];

const fn fig(number: &'static str, experiment: &'static str, kind: Kind, caption: &'static str) -> Figure {
    Figure { number, caption, experiment, controllers: &[], kind }
}

const fn fig_of(figure: Figure, controllers: &'static [&'static str]) -> Figure {
    Figure { controllers, ..figure }
}

const BSMC: &[&str] = &["bsmc"];
const FUZZY: &[&str] = &["bfsmc-thesis", "bfsmc"];

/// All figures, in the order of the thesis, the additions at the end.
///
/// Figures 5.36 and 5.37 have the same caption in print; the first is taken for BSMC, the second for BFSMC.
pub static FIGURES: &[Figure] = &[
    fig("3.4", "verify-straight", Kind::BasePath, "straight line of the base, from above"),
    fig("3.5", "verify-straight", Kind::BaseWorldVelocity, "straight line: velocity of the base"),
    fig("3.6", "verify-circle", Kind::BasePath, "circle of the base, from above"),
    fig("3.7", "verify-circle", Kind::BaseWorldVelocity, "circle: velocity of the base"),
    fig("3.8", "verify-reverse-circle", Kind::BasePath, "circle of the base in reverse, from above"),
    fig("3.9", "verify-reverse-circle", Kind::BaseWorldVelocity, "circle in reverse: velocity of the base"),
    fig("3.10", "verify-joint2", Kind::Path, "joint 2 turns: path of the tip"),
    fig("3.11", "verify-joint2", Kind::Position, "joint 2 turns: position of the tip"),
    fig("3.12", "verify-joint2", Kind::TipVelocity, "joint 2 turns: velocity of the tip"),
    fig("3.13", "verify-joints23", Kind::Path, "joints 2 and 3 turn: path of the tip"),
    fig("3.14", "verify-joints23", Kind::Position, "joints 2 and 3 turn: position of the tip"),
    fig("3.15", "verify-joints23", Kind::TipVelocity, "joints 2 and 3 turn: velocity of the tip"),
    fig("3.16", "verify-resting-base", Kind::Path, "semicircle of the arm, base at rest"),
    fig("3.17", "verify-moving-base", Kind::Path, "semicircle of the arm, base driving back"),
    fig("3.18", "verify-moving-base", Kind::FromAbove, "base and tip during the semicircle, from above"),
    fig("5.2", "sinusoid", Kind::Position, "sinusoid: position of the tip"),
    fig("5.3", "sinusoid", Kind::Joints, "sinusoid: joint angles and rates"),
    fig("5.4", "sinusoid", Kind::JointTorques, "sinusoid: torques of the joints"),
    fig("5.5", "sinusoid", Kind::BaseVelocity, "sinusoid: velocity of the base"),
    fig("5.6", "sinusoid", Kind::WheelTorques, "sinusoid: torques of the wheels"),
    fig("5.7", "sinusoid", Kind::Errors, "sinusoid: error of the tip"),
    fig("5.8", "sinusoid", Kind::Path, "sinusoid: path of the tip"),
    fig("5.9", "spiral", Kind::Position, "spiral: position of the tip"),
    fig("5.10", "spiral", Kind::Joints, "spiral: joint angles and rates"),
    fig("5.11", "spiral", Kind::JointTorques, "spiral: torques of the joints"),
    fig("5.12", "spiral", Kind::BaseVelocity, "spiral: velocity of the base"),
    fig("5.13", "spiral", Kind::WheelTorques, "spiral: torques of the wheels"),
    fig("5.14", "spiral", Kind::Errors, "spiral: error of the tip"),
    fig("5.15", "spiral", Kind::Path, "spiral: path of the tip"),
    fig("5.16", "square", Kind::Position, "square: position of the tip"),
    fig("5.17", "square", Kind::Joints, "square: joint angles and rates"),
    fig("5.18", "square", Kind::JointTorques, "square: torques of the joints"),
    fig("5.19", "square", Kind::BaseVelocity, "square: velocity of the base"),
    fig("5.20", "square", Kind::WheelTorques, "square: torques of the wheels"),
    fig("5.21", "square", Kind::Errors, "square: error of the tip"),
    fig("5.22", "square", Kind::Path, "square: path of the tip"),
    fig("5.23", "spiral-disturbed", Kind::Disturbance, "disturbed spiral: torque on joint 1"),
    fig("5.24", "spiral-disturbed", Kind::Position, "disturbed spiral: position of the tip"),
    fig("5.25", "spiral-disturbed", Kind::JointTorques, "disturbed spiral: torques of the joints"),
    fig("5.26", "spiral-disturbed", Kind::BaseVelocity, "disturbed spiral: velocity of the base"),
    fig("5.27", "spiral-disturbed", Kind::WheelTorques, "disturbed spiral: torques of the wheels"),
    fig("5.28", "spiral-disturbed", Kind::Errors, "disturbed spiral: error of the tip"),
    fig("5.29", "spiral-disturbed", Kind::Path, "disturbed spiral: path of the tip"),
    fig("5.30", "step-disturbed", Kind::Position, "step with a torque on joint 3: position of the tip"),
    fig("5.31", "spiral-compare", Kind::Disturbance, "compared on the spiral: disturbance"),
    fig(
        "5.32",
        "spiral-compare",
        Kind::Position,
        "compared on the spiral: position of the tip, and its error",
    ),
    fig("5.33", "spiral-compare", Kind::JointTorques, "compared on the spiral: torques of the joints"),
    fig_of(
        fig("5.34", "spiral-compare", Kind::BaseVelocity, "compared on the spiral: velocity of the base"),
        BSMC,
    ),
    fig_of(
        fig("5.35", "spiral-compare", Kind::BaseVelocity, "compared on the spiral: velocity of the base"),
        FUZZY,
    ),
    fig_of(
        fig("5.36", "spiral-compare", Kind::WheelTorques, "compared on the spiral: torques of the wheels"),
        BSMC,
    ),
    fig_of(
        fig("5.37", "spiral-compare", Kind::WheelTorques, "compared on the spiral: torques of the wheels"),
        FUZZY,
    ),
    fig("5.38", "spiral-compare", Kind::Path, "compared on the spiral: path of the tip"),
    fig(
        "5.39",
        "square-compare",
        Kind::Position,
        "compared on the square: position of the tip, and its error",
    ),
    fig("5.40", "square-compare", Kind::JointTorques, "compared on the square: torques of the joints"),
    fig_of(
        fig("5.41", "square-compare", Kind::BaseVelocity, "compared on the square: velocity of the base"),
        BSMC,
    ),
    fig_of(
        fig("5.42", "square-compare", Kind::BaseVelocity, "compared on the square: velocity of the base"),
        FUZZY,
    ),
    fig("5.43", "square-compare", Kind::WheelTorques, "compared on the square: torques of the wheels"),
    fig("5.44", "square-compare", Kind::Path, "compared on the square: path of the tip"),
    fig("step-errors", "step-disturbed", Kind::Errors, "step: error of the tip"),
    fig("step-torques", "step-disturbed", Kind::JointTorques, "step: torques of the joints"),
    fig(
        "held-position",
        "sinusoid-base-held",
        Kind::Position,
        "sinusoid, base held at first: position of the tip",
    ),
    fig(
        "held-velocity",
        "sinusoid-base-held",
        Kind::BaseVelocity,
        "sinusoid, base held at first: base velocity",
    ),
    fig("held-errors", "sinusoid-base-held", Kind::Errors, "sinusoid, base held at first: error of the tip"),
];
