//! `smc-decentralized`: sliding modes of base and arm apart.

use mm_model::{Force, Mechanism, Real, Robot, Velocity};

use super::{BsmcSat, Drive, Gains, InnerLaw, LawMemory, Tracking};
use crate::SetupError;

/// Base and arm each by a sliding mode with boundary layer that knows its own dynamics alone:
///
/// ```text
/// f_b = M_bb nu_r,b' + C_bb(nu_b) nu_r,b       + friction_b - k_b sat(s_b / phi_b)
/// f_a = M_aa nu_r,a' + C_aa(nu_a) nu_r,a + g_a + friction_a - k_a sat(s_a / phi_a)
/// ```
/// What base and arm do to each other is a disturbance, M_ba nu_r,a' + ... on the base and the like on the arm.
///
/// Stability: as for [`BsmcSat`](super::BsmcSat) outside the layer, with the coupling counted into the uncertainty: k_i must exceed
/// |coupling_i| + |uncertainty_i| + |f_ext,i| + eta_i. The coupling grows with the reference's acceleration, so that a gain that
/// suffices for one path may not for another.
///
/// Uses the gains `switching` (k) and `boundary_layer` (phi).
///
/// # Source
/// J. H. Chung, S. A. Velinsky, R. A. Hess, Interaction control of a redundant mobile manipulator, IJRR 17 (1998): base and arm
/// controlled apart, robustly.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SmcDecentralized<T, const N: usize> {
    switching: BsmcSat<T, N>,
}

impl<T: Real, const N: usize> SmcDecentralized<T, N> {
    /// The law with checked gains.
    ///
    /// # Errors
    /// The first gain that does not work, by name.
    pub fn try_new(gains: &Gains<T, N>) -> Result<Self, SetupError> {
        Ok(Self { switching: BsmcSat::try_new(gains)? })
    }

    pub(super) const fn authority(&self) -> Force<T, N> {
        self.switching.gain
    }
}

impl<T: Real, const N: usize> InnerLaw<T, N> for SmcDecentralized<T, N>
where
    Robot<T, N>: Mechanism<T, N>,
{
    fn drive(&self, at: &Tracking<'_, T, N>, _memory: &LawMemory<T, N>) -> Drive<T, N> {
        let Tracking { robot, inertia, nu, nu_r, dnu_r, .. } = at;
        let own = |part: fn(&Velocity<T, N>) -> Velocity<T, N>| {
            robot.mass_product(inertia, &part(dnu_r)).plus(robot.coriolis_product(
                inertia,
                &part(nu),
                &part(nu_r),
            ))
        };
        let base = own(|v| Velocity { joints: [T::ZERO; N], ..*v });
        let arm = own(|v| Velocity { forward: T::ZERO, yaw_rate: T::ZERO, joints: v.joints });
        let equivalent = Force { forward: base.forward, yaw: base.yaw, joints: arm.joints }.plus(at.load);
        let force = equivalent.plus(self.switching.force(&at.sliding));
        Drive { equivalent, ..Drive::of_model(force) }
    }
}
