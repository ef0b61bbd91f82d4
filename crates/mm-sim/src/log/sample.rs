//! What is logged of one instant.

/// Everything logged of one instant of a run, in SI units and radians.
///
/// Order of the arrays of five: forward, yaw rate, joints 1 to 3 for velocities and generalized forces; right
/// wheel, left wheel, joints 1 to 3 for torques. Points are those of the tip in the world frame.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct LogSample {
    /// Time of the scenario, s.
    pub t_s: f64,
    /// Midpoint of the wheel axle along x, m.
    pub x: f64,
    /// Midpoint of the wheel axle along y, m.
    pub y: f64,
    /// Heading of the base, rad.
    pub heading: f64,
    /// Arm joints: yaw, shoulder and elbow pitch (positive raises the link), rad.
    pub joints: [f64; 3],
    /// Forward speed of the base, m/s.
    pub forward: f64,
    /// Yaw rate of the base, rad/s.
    pub yaw_rate: f64,
    /// Rates of the arm joints, rad/s.
    pub joint_rates: [f64; 3],
    /// Angles the right and the left wheel have turned through, positive forward, rad.
    pub wheel_angles: [f64; 2],
    /// Desired position of the tip, m.
    pub p_d: [f64; 3],
    /// Desired velocity of the tip, m/s.
    pub dp_d: [f64; 3],
    /// Position of the tip, m.
    pub tip: [f64; 3],
    /// Tracking error, actual minus desired, m.
    pub error: [f64; 3],
    /// Virtual velocity that the outer loop asks for, m/s and rad/s.
    pub nu_c: [f64; 5],
    /// Velocity that the controller worked with: true or estimated, m/s and rad/s.
    pub estimated: [f64; 5],
    /// Sliding variable, m/s and rad/s.
    pub sliding: [f64; 5],
    /// Torque commanded by the controller, N m.
    pub torque_commanded: [f64; 5],
    /// Torque at the plant's input, N m.
    pub torque_applied: [f64; 5],
    /// Disturbance torque on the right wheel, the left wheel and the joints, N m.
    pub disturbance: [f64; 5],
    /// Fuzzy part of the generalized force, N and N m.
    pub fuzzy: [f64; 5],
    /// Learned part of the generalized force, N and N m.
    pub learned: [f64; 5],
    /// Manipulability, the square root of the determinant of J transpose(J).
    pub manipulability: f64,
    /// Damping of the pseudo-inverse.
    pub damping: f64,
    /// Smallest switching gain that the reaching condition allows, N and N m; 0 for a law without a switching gain.
    pub reaching_bound: [f64; 5],
    /// Lyapunov function of the sliding mode, J.
    pub lyapunov: f64,
    /// Its rate by the law's own nu_r', W; with an estimator that of V but for the estimate's error and slip.
    pub lyapunov_rate: f64,
    /// Whether a torque was limited.
    pub saturated: bool,
    /// Whether the manipulability was below its threshold; damped if damping is on.
    pub near_singular: bool,
    /// Whether the outer loop bounded the correction's speed or the base's forward speed.
    pub speed_limited: bool,
    /// Whether a joint was held to the bound of its rate.
    pub joint_limited: bool,
    /// Which torques were limited.
    pub torque_limited: [bool; 5],
}

impl LogSample {
    /// The sample's time in whole nanoseconds; 0 for a negative or undefined time.
    pub(crate) fn stamp_ns(&self) -> u64 {
        stamp_ns(self.t_s)
    }
}

/// A time of the scenario in whole nanoseconds; 0 for a negative or undefined time.
#[expect(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "the conversion saturates, which is the rule stated above"
)]
pub(super) fn stamp_ns(t_s: f64) -> u64 {
    (t_s * 1e9).round() as u64
}

#[cfg(test)]
mod tests {
    use super::stamp_ns;

    #[test]
    fn stamps_are_whole_nanoseconds() {
        assert_eq!(stamp_ns(0.1 + 0.2), 300_000_000, "rounded, not cut");
        assert_eq!(stamp_ns(98.0), 98_000_000_000, "a whole run");
        assert_eq!(stamp_ns(-1.0), 0, "before the start");
        assert_eq!(stamp_ns(f64::NAN), 0, "undefined");
    }
}
