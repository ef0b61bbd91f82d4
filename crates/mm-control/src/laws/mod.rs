//! Inner laws: what turns the velocity that the outer loop asks for into forces.
//!
//! All of them share the outer loop, the sliding variable s (actual minus desired) and the limits. The switching laws and
//! `super-twisting` add a force that opposes s to the same equivalent control M nu_r' + C nu_r + g + friction; the others make their
//! own of the same quantities. Each acts on generalized forces: applied to the torques directly, as (4.31) and (4.41) print
//! it, s_v would drive the right wheel and s_omega the left.
//!
//! | law | force besides friction | memory |
//! | --- | --- | --- |
//! | [`Bsmc`] | equivalent - k sign(s) | |
//! | [`BsmcSat`] | equivalent - k sat(s/phi) | |
//! | [`BfsmcThesis`] | equivalent - k sign(s) + k_f FIS(s/scale) | |
//! | [`Bfsmc`] | equivalent + k_f phi(s/scale) - d_hat | momentum observer |
//! | [`Ctc`] | M (nu_c' - Kv lag - Ki integral(lag)) + C nu + g | |
//! | [`Pid`] | base: its own dynamics linearized, then PID; joints: PID | integral of the integral |
//! | [`Lqr`] | M0 nu_c' + g0 - K1 integral(lag) - K2 lag | |
//! | [`SmcDecentralized`] | equivalent without the coupling of base and arm - k sat(s/phi) | |
//! | [`BacksteppingAdaptive`] | Y theta - K s - d_hat | body factors theta, d_hat |
//! | [`SuperTwisting`] | equivalent - k1 sqrt(abs s) sign(s) + v | v |
//!
//! with lag = nu - nu_c.

mod backstepping_adaptive;
mod bfsmc;
mod bfsmc_thesis;
mod bsmc;
mod bsmc_sat;
mod ctc;
mod fuzzy_term;
pub(crate) mod gains;
mod inner;
mod lqr;
mod pid;
mod riccati;
mod smc_decentralized;
mod super_twisting;
mod tracking;

pub use backstepping_adaptive::BacksteppingAdaptive;
pub use bfsmc::Bfsmc;
pub use bfsmc_thesis::{BfsmcThesis, Misprints};
pub use bsmc::Bsmc;
pub use bsmc_sat::BsmcSat;
pub use ctc::Ctc;
pub use fuzzy_term::{FuzzyTerm, SwitchingTerm};
pub use gains::{EffectiveInertia, Gains};
pub use inner::InnerLaw;
pub use lqr::Lqr;
pub use pid::Pid;
pub use riccati::{ChannelMatrix, StateFeedback};
pub use smc_decentralized::SmcDecentralized;
pub use super_twisting::SuperTwisting;
pub use tracking::{Drive, LawMemory, Tracking};

use mm_model::{Force, Mechanism, Real, Robot, Velocity};

use crate::SetupError;
use crate::fuzzy::{Bundled, FuzzyError};

/// The laws by name.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[non_exhaustive]
pub enum LawKind {
    /// Backstepping and sliding mode with sign.
    Bsmc,
    /// The same with a boundary layer.
    BsmcSat,
    /// Sign and the fuzzy term of Appendix C, as printed.
    BfsmcThesis,
    /// Continuous fuzzy surface and a learned disturbance: the default.
    Bfsmc,
    /// Computed torque.
    Ctc,
    /// PID, the base by partial feedback linearization.
    Pid,
    /// Linear quadratic regulator about the rest posture.
    Lqr,
    /// Sliding modes of base and arm apart.
    SmcDecentralized,
    /// Adaptive backstepping.
    BacksteppingAdaptive,
    /// Super-twisting, a sliding mode of second order.
    SuperTwisting,
}

impl LawKind {
    /// Every law.
    pub const ALL: [Self; 10] = [
        Self::Bsmc,
        Self::BsmcSat,
        Self::BfsmcThesis,
        Self::Bfsmc,
        Self::Ctc,
        Self::Pid,
        Self::Lqr,
        Self::SmcDecentralized,
        Self::BacksteppingAdaptive,
        Self::SuperTwisting,
    ];

    /// The laws that add a force of s alone to the equivalent control: the thesis's baseline, its fuzzy law and their kin.
    pub const SWITCHING: [Self; 4] = [Self::Bsmc, Self::BsmcSat, Self::BfsmcThesis, Self::Bfsmc];

    /// The name used in scenarios and on the command line.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Bsmc => "bsmc",
            Self::BsmcSat => "bsmc-sat",
            Self::BfsmcThesis => "bfsmc-thesis",
            Self::Bfsmc => "bfsmc",
            Self::Ctc => "ctc",
            Self::Pid => "pid",
            Self::Lqr => "lqr",
            Self::SmcDecentralized => "smc-decentralized",
            Self::BacksteppingAdaptive => "backstepping-adaptive",
            Self::SuperTwisting => "super-twisting",
        }
    }

    /// The law of a name.
    #[must_use]
    pub fn from_name(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|kind| kind.name() == name)
    }
}

/// One of the laws, with its gains.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Law<T: Real, const N: usize> {
    /// See [`Bsmc`].
    Bsmc(Bsmc<T, N>),
    /// See [`BsmcSat`].
    BsmcSat(BsmcSat<T, N>),
    /// See [`BfsmcThesis`].
    BfsmcThesis(BfsmcThesis<T, N>),
    /// See [`Bfsmc`].
    Bfsmc(Bfsmc<T, N>),
    /// See [`Ctc`].
    Ctc(Ctc<T, N>),
    /// See [`Pid`].
    Pid(Pid<T, N>),
    /// See [`Lqr`].
    Lqr(Lqr<T, N>),
    /// See [`SmcDecentralized`].
    SmcDecentralized(SmcDecentralized<T, N>),
    /// See [`BacksteppingAdaptive`].
    BacksteppingAdaptive(BacksteppingAdaptive<T, N>),
    /// See [`SuperTwisting`].
    SuperTwisting(SuperTwisting<T, N>),
}

/// The force of a switching law, and the part of it that its fuzzy system makes.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct RobustForce<T, const N: usize> {
    /// Force added to the equivalent control, N and N m.
    pub total: Force<T, N>,
    /// The share of the fuzzy system.
    pub fuzzy: Force<T, N>,
}

impl<T: Real, const N: usize> RobustForce<T, N> {
    /// No force.
    #[must_use]
    #[inline]
    pub fn zero() -> Self {
        Self::plain(Force::zero())
    }

    /// A force without a fuzzy share.
    #[must_use]
    #[inline]
    pub fn plain(total: Force<T, N>) -> Self {
        Self { total, fuzzy: Force::zero() }
    }
}

impl<T: Real, const N: usize> Law<T, N>
where
    Robot<T, N>: Mechanism<T, N>,
{
    /// The law of a kind with the given gains, for a robot.
    ///
    /// # Errors
    /// The first gain that the law cannot work with.
    pub fn try_new(kind: LawKind, robot: &Robot<T, N>, gains: &Gains<T, N>) -> Result<Self, SetupError>
    where
        T: Bundled,
    {
        gains.check()?;
        Ok(match kind {
            LawKind::Bsmc => Self::Bsmc(Bsmc::try_new(gains)?),
            LawKind::BsmcSat => Self::BsmcSat(BsmcSat::try_new(gains)?),
            LawKind::BfsmcThesis => Self::BfsmcThesis(BfsmcThesis::try_new(robot.params(), gains)?),
            LawKind::Bfsmc => Self::Bfsmc(Bfsmc::try_new(gains)?),
            LawKind::Ctc => Self::Ctc(Ctc::try_new(gains)?),
            LawKind::Pid => Self::Pid(Pid::try_new(robot, gains)?),
            LawKind::Lqr => Self::Lqr(Lqr::try_new(robot, gains)?),
            LawKind::SmcDecentralized => Self::SmcDecentralized(SmcDecentralized::try_new(gains)?),
            LawKind::BacksteppingAdaptive => {
                Self::BacksteppingAdaptive(BacksteppingAdaptive::try_new(robot, gains)?)
            }
            LawKind::SuperTwisting => Self::SuperTwisting(SuperTwisting::try_new(gains)?),
        })
    }

    /// The law of a kind that has a fuzzy system, with one of the user's own.
    ///
    /// # Errors
    /// As [`try_new`](Self::try_new); `kind` out of range for a law without a fuzzy system, `rules` for one that aids the
    /// motion, which [`Bfsmc`] refuses.
    pub fn with_fuzzy(
        kind: LawKind,
        robot: &Robot<T, N>,
        gains: &Gains<T, N>,
        term: FuzzyTerm<T>,
    ) -> Result<Self, SetupError> {
        match kind {
            LawKind::Bfsmc => Bfsmc::with_term(gains, term).map(Self::Bfsmc),
            LawKind::BfsmcThesis => {
                BfsmcThesis::with_term(robot.params(), gains, term).map(Self::BfsmcThesis)
            }
            _ => Err(FuzzyError::OutOfRange("kind").into()),
        }
    }

    /// Which law this is.
    #[must_use]
    pub const fn kind(&self) -> LawKind {
        match self {
            Self::Bsmc(_) => LawKind::Bsmc,
            Self::BsmcSat(_) => LawKind::BsmcSat,
            Self::BfsmcThesis(_) => LawKind::BfsmcThesis,
            Self::Bfsmc(_) => LawKind::Bfsmc,
            Self::Ctc(_) => LawKind::Ctc,
            Self::Pid(_) => LawKind::Pid,
            Self::Lqr(_) => LawKind::Lqr,
            Self::SmcDecentralized(_) => LawKind::SmcDecentralized,
            Self::BacksteppingAdaptive(_) => LawKind::BacksteppingAdaptive,
            Self::SuperTwisting(_) => LawKind::SuperTwisting,
        }
    }

    /// Largest force that the law surely opposes to a large s, channel by channel: the k_i of the reaching condition (4.44).
    /// None for a law without a switching gain.
    #[must_use]
    pub fn authority(&self) -> Option<Force<T, N>> {
        match self {
            Self::Bsmc(law) => Some(law.gain),
            Self::BsmcSat(law) => Some(law.gain),
            Self::BfsmcThesis(law) => law.authority(),
            Self::Bfsmc(law) => Some(law.authority()),
            Self::SmcDecentralized(law) => Some(law.authority()),
            _ => None,
        }
    }
}

impl<T: Real, const N: usize> InnerLaw<T, N> for Law<T, N>
where
    Robot<T, N>: Mechanism<T, N>,
{
    #[inline(always)]
    fn switching_force(&self, s: &Velocity<T, N>) -> Option<RobustForce<T, N>> {
        match self {
            Self::Bsmc(law) => law.switching_force(s),
            Self::BsmcSat(law) => law.switching_force(s),
            Self::BfsmcThesis(law) => law.switching_force(s),
            Self::Bfsmc(law) => law.switching_force(s),
            _ => None,
        }
    }

    fn drive(&self, at: &Tracking<'_, T, N>, memory: &LawMemory<T, N>) -> Drive<T, N> {
        match self {
            Self::Bsmc(law) => law.drive(at, memory),
            Self::BsmcSat(law) => law.drive(at, memory),
            Self::BfsmcThesis(law) => law.drive(at, memory),
            Self::Bfsmc(law) => law.drive(at, memory),
            Self::Ctc(law) => law.drive(at, memory),
            Self::Pid(law) => law.drive(at, memory),
            Self::Lqr(law) => law.drive(at, memory),
            Self::SmcDecentralized(law) => law.drive(at, memory),
            Self::BacksteppingAdaptive(law) => law.drive(at, memory),
            Self::SuperTwisting(law) => law.drive(at, memory),
        }
    }

    fn learns(&self) -> bool {
        matches!(self, Self::Bfsmc(_))
    }
}

/// A vector of forces read as one of velocities, channel by channel.
#[inline]
fn channel_zip<T: Real, const N: usize>(
    s: &Velocity<T, N>,
    k: &Force<T, N>,
    mut f: impl FnMut(T, T) -> T,
) -> Force<T, N> {
    let mut joints = k.joints;
    let (forward, yaw) = (f(s.forward, k.forward), f(s.yaw_rate, k.yaw));
    for (gain, &value) in joints.iter_mut().zip(&s.joints) {
        *gain = f(value, *gain);
    }
    Force { forward, yaw, joints }
}
