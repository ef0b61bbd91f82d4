//! A direct-current motor behind a gear.

use mm_model::Real;

/// Constants of a motor with its gear and its drive.
///
/// ```text
/// L di/dt = V - R i - k n w,   torque at the axis = k n i
/// ```
/// with V the voltage at the armature, w the rate of the axis behind a gear of ratio n, k the torque constant, which is also that of
/// the back-EMF. The drive asks for the current i* = torque/(k n), within its limit, and applies V = R i* + k n w, within the supply: the
/// current then settles with the time constant L/R, and the torque falls with the rate once the supply is used up. At a constant rate
/// the torque is at most k n (supply - k n |w|)/R against the back-EMF.
///
/// Approximations: the rate is the one at the begin of a plant step, throughout the step; with an inductance, the current heads for
/// the torque asked for in the middle of the step, throughout the step; the gear has no losses, no backlash and no
/// inertia of its own (the links' inertias may hold n^2 times the rotor's); the drive knows the rate and the constants exactly.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Motor {
    /// Armature resistance R, ohm.
    pub resistance: f64,
    /// Armature inductance L, H; 0 for a current that follows at once.
    pub inductance: f64,
    /// Torque constant k, N m/A, and V s/rad of the back-EMF.
    pub torque_constant: f64,
    /// Gear ratio n.
    pub gear_ratio: f64,
    /// Supply voltage, V.
    pub supply: f64,
    /// Largest current asked for, A.
    pub current_limit: f64,
}

/// A motor with what a fixed step makes of its time constant.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct MotorAxis {
    motor: Motor,
    /// k n, N m/A.
    per_current: f64,
    /// exp(-h R/(2 L)): what is left of a current's error after half a step.
    half_decay: f64,
}

impl MotorAxis {
    /// The motor, integrated in steps of `step` s.
    #[must_use]
    pub fn new(motor: Motor, step: f64) -> Self {
        let half_decay = if motor.inductance > 0.0 {
            Real::exp(-0.5 * step * motor.resistance / motor.inductance)
        } else {
            0.0
        };
        Self { motor, per_current: motor.torque_constant * motor.gear_ratio, half_decay }
    }

    /// The current, A, that the drive heads for to make a torque at a rate of the axis, and whether a limit is in its way.
    #[must_use]
    pub fn target(&self, torque: f64, rate: f64) -> (f64, bool) {
        let Motor { resistance, supply, current_limit, .. } = self.motor;
        let asked = torque / self.per_current;
        let current = asked.clamp_to(-current_limit, current_limit);
        let emf = self.per_current * rate;
        let voltage = resistance * current + emf;
        if Real::abs(voltage) <= supply {
            return (current, Real::abs(asked) > current_limit);
        }
        ((voltage.clamp_to(-supply, supply) - emf) / resistance, true)
    }

    /// Torque at the begin, in the middle and at the end of a step towards a current; the current moves on.
    ///
    /// The equation is linear while the voltage and the rate are held: i(t) = target + (i - target) exp(-t R/L), exactly.
    pub fn advance(&self, current: &mut f64, target: f64) -> [f64; 3] {
        let off = *current - target;
        let begin = if self.half_decay > 0.0 { *current } else { target };
        let middle = target + off * self.half_decay;
        *current = target + off * self.half_decay * self.half_decay;
        [begin, middle, *current].map(|current| self.per_current * current)
    }

    /// Torque of a current, N m.
    #[must_use]
    pub fn torque(&self, current: f64) -> f64 {
        self.per_current * current
    }

    /// Whether the current follows at once.
    #[must_use]
    pub fn is_immediate(&self) -> bool {
        !(self.half_decay > 0.0)
    }
}
