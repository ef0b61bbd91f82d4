//! `lqr`: the linear quadratic regulator about the rest posture.

use mm_model::{Force, Mechanism, Real, Robot, Velocity};

use super::riccati::{ChannelMatrix, StateFeedback};
use super::{Drive, Gains, InnerLaw, LawMemory, Tracking};
use crate::SetupError;

/// Linear state feedback, optimal for the robot linearized about its rest posture: with x = integral(lag), lag = nu - nu_c,
///
/// ```text
/// f = M0 nu_c' + g0 - K1 x - K2 lag,     M0, g0: inertia and gravity at the rest posture
/// ```
/// and (K1, K2) minimizing integral(x'Q1 x + lag'Q2 lag + f'R f) for x'' = M0^-1 f. The weights follow Bryson's rule: Q1 = diag(1/x_max^2),
/// Q2 = diag(1/lag_max^2), R = diag(1/f_max^2), with the largest acceptable values as gains. The Riccati equation is solved once, when the law is
/// built, by [`StateFeedback::solve`].
///
/// Stability: asymptotic for the linearized robot, with the margins of LQR (gain from 1/2 to infinity, phase 60 degrees on each input);
/// away from the rest posture and for a wrong model only locally. Sampled with period dt: the largest pole times dt below 2.
///
/// Uses the gains `acceptable_position` (x_max), `acceptable_velocity` (lag_max) and `acceptable_force` (f_max).
///
/// # Source
/// B. D. O. Anderson, J. B. Moore, Optimal Control: Linear Quadratic Methods (1990); A. E. Bryson, Y.-C. Ho, Applied Optimal Control
/// (1975), section 5.2.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Lqr<T: Real, const N: usize> {
    inertia: ChannelMatrix<T, N>,
    gravity: Force<T, N>,
    feedback: StateFeedback<T, N>,
}

impl<T: Real, const N: usize> Lqr<T, N>
where
    Robot<T, N>: Mechanism<T, N>,
{
    /// The law with checked gains.
    ///
    /// # Errors
    /// The first gain that does not work, by name.
    pub fn try_new(robot: &Robot<T, N>, gains: &Gains<T, N>) -> Result<Self, SetupError> {
        gains.check()?;
        let rest = robot.inertia(&robot.posture(&robot.params().rest_posture));
        let inertia = ChannelMatrix::from_columns(|unit| robot.mass_product(&rest, unit));
        let inverse = ChannelMatrix::from_columns(|&Velocity { forward, yaw_rate, joints }| {
            let Velocity { forward, yaw_rate, joints } =
                robot.solve(&rest, &Force { forward, yaw: yaw_rate, joints });
            Force { forward, yaw: yaw_rate, joints }
        });
        let feedback = StateFeedback::solve(
            &inverse,
            (&gains.acceptable_position, &gains.acceptable_velocity),
            &gains.acceptable_force,
        )?;
        Ok(Self { inertia, gravity: robot.gravity(&rest), feedback })
    }

    /// The feedback gains K1 and K2.
    #[must_use]
    pub const fn feedback(&self) -> &StateFeedback<T, N> {
        &self.feedback
    }
}

impl<T: Real, const N: usize> InnerLaw<T, N> for Lqr<T, N>
where
    Robot<T, N>: Mechanism<T, N>,
{
    fn drive(&self, at: &Tracking<'_, T, N>, _memory: &LawMemory<T, N>) -> Drive<T, N> {
        let ahead = self.inertia.product(at.dnu_c).plus(self.gravity);
        let force = ahead
            .minus(self.feedback.position.product(at.lag_integral))
            .minus(self.feedback.velocity.product(&at.lag));
        Drive::of_model(force)
    }
}
