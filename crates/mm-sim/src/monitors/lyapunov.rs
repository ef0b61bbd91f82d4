//! The Lyapunov function of the sliding mode (4.34) and its rate, with the robot as it really is.

use mm_control::Output;
use mm_model::{Force, Mechanism, Robot, Torque, Velocity};

use crate::plant::PlantSines;

/// V = s'M s/2 and its rate along the true motion.
///
/// Equation, with M and C of the true robot, s = nu - nu_r and nu' its acceleration under torque and disturbance:
///
/// ```text
/// V = s'M s / 2,   V' = s'(M s' + C s),   s' = nu' - nu_r'
/// ```
/// V' follows from M_dot = C + C' (Property 3). nu_r' is that of the law; while a torque is limited the integral in nu_r is held, and
/// nu_r' = nu_c' then. With an estimator s is that of the true velocity, while nu_r' is what the law worked out from its estimate:
/// V' is then the rate of V but for the estimate's error and slip. V is zero on the sliding surface, and a law that reaches makes it fall everywhere else; within the band that
/// sampling leaves it rises and falls.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct Lyapunov {
    /// V, J.
    pub value: f64,
    /// V', W.
    pub rate: f64,
}

impl Lyapunov {
    /// Evaluates V and V' where the true robot is at `sines` and `nu`, under the torque that arrives there and an external force.
    ///
    /// `sliding_gain` is c of the outer loop.
    #[must_use]
    pub fn evaluate(
        robot: &Robot<f64, 3>,
        (sines, nu): (&PlantSines, &Velocity<f64, 3>),
        (output, torque): (&Output<f64, 3>, &Torque<f64, 3>),
        external: &Force<f64, 3>,
        sliding_gain: &Velocity<f64, 3>,
    ) -> Self {
        let signals = &output.signals;
        let inertia = robot.inertia(&sines.posture);
        let force = robot.force_of(torque).plus(*external);
        let acceleration = robot.acceleration(&inertia, nu, &force);
        let mut dnu_r = signals.dnu_r;
        if output.status.saturated {
            dnu_r = dnu_r.plus(sliding_gain.zip(signals.nu.minus(signals.nu_c), |c, lag| c * lag));
        }
        let s = nu.minus(signals.nu_r);
        let momentum = robot.mass_product(&inertia, &s);
        let pull = robot.mass_product(&inertia, &acceleration.minus(dnu_r));
        let turn = robot.coriolis_product(&inertia, nu, &s);
        Self { value: 0.5 * s.power(&momentum), rate: s.power(&pull.plus(turn)) }
    }
}
