//! Switching laws: what the inner loop adds to the equivalent control to hold the sliding surface.
//!
//! All of them share the equivalent control M nu_r' + C nu_r + g + friction, the sliding variable s (actual minus desired)
//! and the limits; they differ only in the force that they oppose to s. Each acts on generalized forces: applied to the
//! torques directly, as (4.31) and (4.41) print it, s_v would drive the right wheel and s_omega the left.

mod bfsmc;
mod bfsmc_thesis;
mod bsmc;
mod bsmc_sat;
mod gains;

pub use bfsmc::Bfsmc;
pub use bfsmc_thesis::BfsmcThesis;
pub use bsmc::Bsmc;
pub use bsmc_sat::BsmcSat;
pub use gains::{EffectiveInertia, Gains};

use mm_model::{Force, Mechanism, Real, Robot, Velocity};

use crate::SetupError;

/// The laws by name.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
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
}

impl LawKind {
    /// Every law.
    pub const ALL: [Self; 4] = [Self::Bsmc, Self::BsmcSat, Self::BfsmcThesis, Self::Bfsmc];

    /// The name used in scenarios and on the command line.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Bsmc => "bsmc",
            Self::BsmcSat => "bsmc-sat",
            Self::BfsmcThesis => "bfsmc-thesis",
            Self::Bfsmc => "bfsmc",
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
pub enum Law<T, const N: usize> {
    /// See [`Bsmc`].
    Bsmc(Bsmc<T, N>),
    /// See [`BsmcSat`].
    BsmcSat(BsmcSat<T, N>),
    /// See [`BfsmcThesis`].
    BfsmcThesis(BfsmcThesis<T, N>),
    /// See [`Bfsmc`].
    Bfsmc(Bfsmc<T, N>),
}

/// The force of a law, and the part of it that its fuzzy system makes.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct RobustForce<T, const N: usize> {
    /// Force added to the equivalent control, N and N m.
    pub total: Force<T, N>,
    /// The share of the fuzzy system.
    pub fuzzy: Force<T, N>,
}

impl<T: Real, const N: usize> Law<T, N>
where
    Robot<T, N>: Mechanism<T, N>,
{
    /// The law of a kind with the given gains.
    ///
    /// # Errors
    /// The first gain that the law cannot work with.
    pub fn try_new(kind: LawKind, gains: &Gains<T, N>) -> Result<Self, SetupError> {
        Ok(match kind {
            LawKind::Bsmc => Self::Bsmc(Bsmc::try_new(gains)?),
            LawKind::BsmcSat => Self::BsmcSat(BsmcSat::try_new(gains)?),
            LawKind::BfsmcThesis => Self::BfsmcThesis(BfsmcThesis::try_new(gains)?),
            LawKind::Bfsmc => Self::Bfsmc(Bfsmc::try_new(gains)?),
        })
    }

    /// Which law this is.
    #[must_use]
    pub const fn kind(&self) -> LawKind {
        match self {
            Self::Bsmc(_) => LawKind::Bsmc,
            Self::BsmcSat(_) => LawKind::BsmcSat,
            Self::BfsmcThesis(_) => LawKind::BfsmcThesis,
            Self::Bfsmc(_) => LawKind::Bfsmc,
        }
    }

    /// The force that the law opposes to the sliding variable.
    #[must_use]
    #[inline]
    pub fn force(&self, s: &Velocity<T, N>) -> RobustForce<T, N> {
        match self {
            Self::Bsmc(law) => RobustForce { total: law.force(s), fuzzy: Force::zero() },
            Self::BsmcSat(law) => RobustForce { total: law.force(s), fuzzy: Force::zero() },
            Self::BfsmcThesis(law) => law.force(s),
            Self::Bfsmc(law) => {
                let force = law.force(s);
                RobustForce { total: force, fuzzy: force }
            }
        }
    }

    /// Largest force that the law surely opposes to a large s, channel by channel: the k_i of the reaching condition (4.44).
    #[must_use]
    pub fn authority(&self) -> Force<T, N> {
        match self {
            Self::Bsmc(law) => law.gain,
            Self::BsmcSat(law) => law.gain,
            Self::BfsmcThesis(law) => law.gain,
            Self::Bfsmc(law) => law.authority(),
        }
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
