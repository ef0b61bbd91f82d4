//! Kinds that C chooses by number, and the bits of flags.

use mm_control::supervisor::Findings;
use mm_control::{LawKind, supervisor};

use crate::status::Refusal;

/// Inner laws. None has the number 0, so that forgotten parameters are refused.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[repr(i32)]
pub enum Law {
    /// Backstepping and sliding mode with sign.
    Bsmc = 1,
    /// The same with a boundary layer.
    BsmcSat = 2,
    /// Sign and the fuzzy term of the thesis, as printed.
    BfsmcThesis = 3,
    /// Continuous fuzzy surface and a learned disturbance: the one to begin with.
    Bfsmc = 4,
    /// Computed torque.
    Ctc = 5,
    /// PID, the base by partial feedback linearization.
    Pid = 6,
    /// Linear quadratic regulator about the rest posture.
    Lqr = 7,
    /// Sliding modes of base and arm apart.
    SmcDecentralized = 8,
    /// Adaptive backstepping.
    BacksteppingAdaptive = 9,
    /// Super-twisting, a sliding mode of second order.
    SuperTwisting = 10,
}

/// How MM_LAW_BFSMC and MM_LAW_BFSMC_THESIS evaluate their fuzzy system; other laws take the default alone.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[repr(i32)]
pub enum FuzzyEngine {
    /// What the law chooses: a table for MM_LAW_BFSMC, the rules for MM_LAW_BFSMC_THESIS.
    Default = 0,
    /// 65 equally spaced knots in floating point: the fastest with a floating-point unit.
    Table = 1,
    /// The rules, centroid in closed form.
    Exact = 2,
    /// The rules in whole numbers of 16 bits.
    Q15 = 3,
    /// A compiled table of whole numbers: the fastest without a floating-point unit.
    Surface = 4,
}

/// How the velocity is found where only positions are measured.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[repr(i32)]
pub enum EstimatorKind {
    /// Not at all: the caller knows the velocity.
    None = 0,
    /// Differences through a low-pass of second order; it lags by sqrt(2)/(2 pi cutoff).
    FilteredDifference = 1,
    /// A tracking observer with the dynamics of the robot.
    Observer = 2,
}

/// What the supervisor does.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[repr(i32)]
pub enum Mode {
    /// The law decides.
    Run = 0,
    /// The last torque of the law is held.
    Hold = 1,
    /// The robot is brought to rest and its weight held.
    Stop = 2,
    /// No torque, brakes on; left by mm_controller_reset only.
    Fault = 3,
}

/// Flag: a torque was cut to its limit.
pub const MM_FLAG_SATURATED: u32 = 1;
/// Flag: the arm is near a singularity, where the pseudo-inverse is damped if damping is on.
pub const MM_FLAG_NEAR_SINGULAR: u32 = 2;
/// Flag: the correction of the tip's error was cut to its largest speed, or the base held to its own.
pub const MM_FLAG_SPEED_LIMITED: u32 = 4;
/// Flag: a joint's rate was held to the bound that keeps it within its limits.
pub const MM_FLAG_JOINT_LIMITED: u32 = 8;
/// Flag: a joint is outside its limits.
pub const MM_FLAG_BEYOND_JOINT_LIMIT: u32 = 16;

/// Finding: a number of the measured state is infinite or NaN.
pub const MM_FINDING_STATE_NOT_FINITE: u32 = 1;
/// Finding: a measured number is outside its range.
pub const MM_FINDING_STATE_RANGE: u32 = 2;
/// Finding: a measured number changed faster than the robot can move.
pub const MM_FINDING_STATE_RATE: u32 = 4;
/// Finding: the measured state stands still although the robot moves.
pub const MM_FINDING_STATE_FROZEN: u32 = 8;
/// Finding: the input is too old.
pub const MM_FINDING_STALE: u32 = 16;
/// Finding: a number of the reference is infinite, NaN or outside its range.
pub const MM_FINDING_REFERENCE: u32 = 32;
/// Finding: the update came too early, or the clock ran backwards.
pub const MM_FINDING_EARLY: u32 = 64;
/// Finding: the update came too late.
pub const MM_FINDING_LATE: u32 = 128;
/// Finding: no input came.
pub const MM_FINDING_MISSED: u32 = 256;
/// Finding: the stack refused the input.
pub const MM_FINDING_REFUSED: u32 = 512;

// The bits of the header are those of the supervisor.
const _: () = {
    assert!(Findings::STATE_NOT_FINITE.bits() as u32 == MM_FINDING_STATE_NOT_FINITE, "another bit");
    assert!(Findings::STATE_RANGE.bits() as u32 == MM_FINDING_STATE_RANGE, "another bit");
    assert!(Findings::STATE_RATE.bits() as u32 == MM_FINDING_STATE_RATE, "another bit");
    assert!(Findings::STATE_FROZEN.bits() as u32 == MM_FINDING_STATE_FROZEN, "another bit");
    assert!(Findings::STALE.bits() as u32 == MM_FINDING_STALE, "another bit");
    assert!(Findings::REFERENCE.bits() as u32 == MM_FINDING_REFERENCE, "another bit");
    assert!(Findings::EARLY.bits() as u32 == MM_FINDING_EARLY, "another bit");
    assert!(Findings::LATE.bits() as u32 == MM_FINDING_LATE, "another bit");
    assert!(Findings::MISSED.bits() as u32 == MM_FINDING_MISSED, "another bit");
    assert!(Findings::REFUSED.bits() as u32 == MM_FINDING_REFUSED, "another bit");
};

impl Law {
    pub(crate) const fn of(number: i32) -> Result<LawKind, Refusal> {
        Ok(match number {
            1 => LawKind::Bsmc,
            2 => LawKind::BsmcSat,
            3 => LawKind::BfsmcThesis,
            4 => LawKind::Bfsmc,
            5 => LawKind::Ctc,
            6 => LawKind::Pid,
            7 => LawKind::Lqr,
            8 => LawKind::SmcDecentralized,
            9 => LawKind::BacksteppingAdaptive,
            10 => LawKind::SuperTwisting,
            _ => return Err(Refusal::no_such("law")),
        })
    }
}

impl FuzzyEngine {
    pub(crate) const fn of(number: i32) -> Result<Self, Refusal> {
        Ok(match number {
            0 => Self::Default,
            1 => Self::Table,
            2 => Self::Exact,
            3 => Self::Q15,
            4 => Self::Surface,
            _ => return Err(Refusal::no_such("fuzzy_engine")),
        })
    }
}

impl EstimatorKind {
    pub(crate) const fn of(number: i32) -> Result<Self, Refusal> {
        Ok(match number {
            0 => Self::None,
            1 => Self::FilteredDifference,
            2 => Self::Observer,
            _ => return Err(Refusal::no_such("kind")),
        })
    }
}

impl From<supervisor::Mode> for Mode {
    fn from(mode: supervisor::Mode) -> Self {
        match mode {
            supervisor::Mode::Run => Self::Run,
            supervisor::Mode::Hold => Self::Hold,
            supervisor::Mode::Stop => Self::Stop,
            supervisor::Mode::Fault => Self::Fault,
        }
    }
}

/// The flags of an update as bits.
pub(crate) fn flags(status: &mm_control::Status) -> u32 {
    let bit = |set: bool, bit: u32| if set { bit } else { 0 };
    bit(status.saturated, MM_FLAG_SATURATED)
        | bit(status.near_singular, MM_FLAG_NEAR_SINGULAR)
        | bit(status.speed_limited, MM_FLAG_SPEED_LIMITED)
        | bit(status.joint_limited, MM_FLAG_JOINT_LIMITED)
        | bit(status.beyond_joint_limit, MM_FLAG_BEYOND_JOINT_LIMIT)
}
