//! What enters and leaves an update, as structs of C.

use mm_control::{Input as StackInput, Measurement as StackMeasurement, Output as StackOutput, WheelAngles};
use mm_model::Real;
use nalgebra::Vector3;

use crate::MM_JOINTS;
use crate::kinds::{self, Mode};

/// Where the robot is.
#[derive(Debug, Clone, Copy, PartialEq)]
#[repr(C)]
pub struct Configuration<T> {
    /// Midpoint of the wheel axle along the world's x axis, m.
    pub x_m: T,
    /// The same along the world's y axis, m.
    pub y_m: T,
    /// Direction in which the base looks, counter-clockwise from the world's x axis, rad.
    pub heading_rad: T,
    /// Joint angles: yaw of the arm counter-clockwise, shoulder from level, elbow from link 2, both positive upwards, rad.
    pub joints_rad: [T; MM_JOINTS],
}

/// How the robot moves: quasi-velocities.
#[derive(Debug, Clone, Copy, PartialEq)]
#[repr(C)]
pub struct Velocity<T> {
    /// Forward speed of the axle's midpoint, m/s.
    pub forward_m_s: T,
    /// Yaw rate of the base, counter-clockwise, rad/s.
    pub yaw_rate_rad_s: T,
    /// Joint rates, rad/s.
    pub joints_rad_s: [T; MM_JOINTS],
}

/// Generalized forces along the quasi-velocities.
#[derive(Debug, Clone, Copy, PartialEq)]
#[repr(C)]
pub struct Force<T> {
    /// Along the forward speed, N.
    pub forward_n: T,
    /// About the vertical, N m.
    pub yaw_n_m: T,
    /// About the joints, N m.
    pub joints_n_m: [T; MM_JOINTS],
}

/// Torques of the actuators.
#[derive(Debug, Clone, Copy, PartialEq)]
#[repr(C)]
pub struct Torque<T> {
    /// Right wheel, positive forwards, N m.
    pub right_n_m: T,
    /// Left wheel, positive forwards, N m.
    pub left_n_m: T,
    /// Joints, N m.
    pub joints_n_m: [T; MM_JOINTS],
}

/// Where the tip shall be, and how that moves, in the world frame: x, y, z upwards.
#[derive(Debug, Clone, Copy, PartialEq)]
#[repr(C)]
pub struct Reference<T> {
    /// Position, m.
    pub position_m: [T; 3],
    /// Velocity, m/s.
    pub velocity_m_s: [T; 3],
    /// Acceleration, m/s^2.
    pub acceleration_m_s2: [T; 3],
}

/// What enters an update from configuration and velocity.
#[derive(Debug, Clone, Copy, PartialEq)]
#[repr(C)]
pub struct Input<T> {
    /// Configuration of the robot.
    pub configuration: Configuration<T>,
    /// Its velocity.
    pub velocity: Velocity<T>,
    /// The reference at this instant.
    pub reference: Reference<T>,
}

/// What enters an update from measured positions.
#[derive(Debug, Clone, Copy, PartialEq)]
#[repr(C)]
pub struct Measurement<T> {
    /// Configuration: the pose by whatever locates the base, the joints by their encoders.
    pub configuration: Configuration<T>,
    /// Angle of the right wheel, positive forwards, rad; counting turns or not.
    pub right_wheel_rad: T,
    /// Angle of the left wheel, rad.
    pub left_wheel_rad: T,
    /// The reference at this instant.
    pub reference: Reference<T>,
    /// Not 0 where the wheels have encoders; else the two angles are not looked at.
    pub has_wheels: u32,
}

/// What the clock says of a supervised update.
#[derive(Debug, Clone, Copy, PartialEq)]
#[repr(C)]
pub struct Timing<T> {
    /// Time since the update before, s; the period for the first.
    pub elapsed_s: T,
    /// Age of the input beyond mm_estimator.delay_s, s.
    pub age_s: T,
}

/// What an update gives.
#[derive(Debug, Clone, Copy, PartialEq)]
#[repr(C)]
pub struct Output<T> {
    /// Torque to apply until the next update, within the limits.
    pub torque: Torque<T>,
    /// Numerical outcomes, none of them an error: MM_FLAG_ bits.
    pub flags: u32,
}

/// What a supervised update gives.
#[derive(Debug, Clone, Copy, PartialEq)]
#[repr(C)]
pub struct Command<T> {
    /// Torque to apply until the next update: finite and within the limits, whatever came in.
    pub torque: Torque<T>,
    /// What the supervisor does: an mm_mode.
    pub mode: i32,
    /// What was wrong with the input: MM_FINDING_ bits.
    pub findings: u32,
    /// 1 where mechanical brakes, if the robot has them, shall hold it; else 0.
    pub brake: u32,
    /// 1 where the law ran, so that flags and signals are of this update; else 0.
    pub ran: u32,
    /// Numerical outcomes of the law: MM_FLAG_ bits; 0 where it did not run.
    pub flags: u32,
}

/// The signals of the law, for logs and monitors. Errors are actual minus desired.
#[derive(Debug, Clone, Copy, PartialEq)]
#[repr(C)]
pub struct Signals<T> {
    /// Velocity that the law worked with: the caller's, or the estimated one.
    pub velocity: Velocity<T>,
    /// Tip by the controller's kinematics, in the world frame, m.
    pub tip_m: [T; 3],
    /// Tip error, m.
    pub error_m: [T; 3],
    /// Virtual control: the velocity that the outer loop asks for.
    pub virtual_velocity: Velocity<T>,
    /// Reference velocity of the sliding mode.
    pub reference_velocity: Velocity<T>,
    /// Its rate, m/s^2 and rad/s^2.
    pub reference_acceleration: Velocity<T>,
    /// Sliding variable: velocity minus reference velocity.
    pub sliding: Velocity<T>,
    /// The law's force as far as it takes the model as true.
    pub equivalent: Force<T>,
    /// Force of the fuzzy system.
    pub fuzzy: Force<T>,
    /// Learned disturbance.
    pub learned: Force<T>,
    /// Torque asked for, before the limits.
    pub commanded: Torque<T>,
    /// det(J J').
    pub manipulability_squared: T,
    /// Square of the damping.
    pub damping_squared: T,
}

// The header asserts the same sizes: with them the fields of both sides lie at the same places.
const _: () = {
    assert!(size_of::<Input<f64>>() == 20 * 8 && size_of::<Input<f32>>() == 20 * 4, "mm_input");
    assert!(
        size_of::<Measurement<f64>>() == 18 * 8 && size_of::<Measurement<f32>>() == 18 * 4,
        "mm_measurement"
    );
    assert!(size_of::<Timing<f64>>() == 2 * 8 && size_of::<Timing<f32>>() == 2 * 4, "mm_timing");
    assert!(size_of::<Output<f64>>() == 6 * 8 && size_of::<Output<f32>>() == 6 * 4, "mm_output");
    assert!(size_of::<Command<f64>>() == 8 * 8 && size_of::<Command<f32>>() == 10 * 4, "mm_command");
    assert!(size_of::<Signals<f64>>() == 53 * 8 && size_of::<Signals<f32>>() == 53 * 4, "mm_signals");
};

impl<T: Real> Configuration<T> {
    fn of(self) -> mm_model::Configuration<T, 3> {
        let Self { x_m: x, y_m: y, heading_rad: heading, joints_rad: joints } = self;
        mm_model::Configuration { x, y, heading, joints }
    }
}

impl<T: Real> Reference<T> {
    pub(crate) fn of(self) -> mm_control::Reference<T> {
        mm_control::Reference {
            position: Vector3::from(self.position_m),
            velocity: Vector3::from(self.velocity_m_s),
            acceleration: Vector3::from(self.acceleration_m_s2),
        }
    }
}

impl<T: Real> Input<T> {
    pub(crate) fn of(self) -> StackInput<T, 3> {
        let Velocity { forward_m_s: forward, yaw_rate_rad_s: yaw_rate, joints_rad_s: joints } = self.velocity;
        StackInput {
            q: self.configuration.of(),
            nu: mm_model::Velocity { forward, yaw_rate, joints },
            reference: self.reference.of(),
        }
    }
}

impl<T: Real> Measurement<T> {
    pub(crate) fn of(self) -> StackMeasurement<T, 3> {
        let angles = WheelAngles { right: self.right_wheel_rad, left: self.left_wheel_rad };
        StackMeasurement { q: self.configuration.of(), wheels: (self.has_wheels != 0).then_some(angles) }
    }
}

impl<T> From<mm_model::Velocity<T, 3>> for Velocity<T> {
    fn from(nu: mm_model::Velocity<T, 3>) -> Self {
        Self { forward_m_s: nu.forward, yaw_rate_rad_s: nu.yaw_rate, joints_rad_s: nu.joints }
    }
}

impl<T> From<mm_model::Force<T, 3>> for Force<T> {
    fn from(force: mm_model::Force<T, 3>) -> Self {
        Self { forward_n: force.forward, yaw_n_m: force.yaw, joints_n_m: force.joints }
    }
}

impl<T> From<mm_model::Torque<T, 3>> for Torque<T> {
    fn from(torque: mm_model::Torque<T, 3>) -> Self {
        Self { right_n_m: torque.right, left_n_m: torque.left, joints_n_m: torque.joints }
    }
}

impl<T: Real> From<&StackOutput<T, 3>> for Output<T> {
    fn from(output: &StackOutput<T, 3>) -> Self {
        Self { torque: output.torque.into(), flags: kinds::flags(&output.status) }
    }
}

impl<T: Real> From<&mm_control::Command<T, 3>> for Command<T> {
    fn from(command: &mm_control::Command<T, 3>) -> Self {
        let output = command.output.as_ref();
        Self {
            torque: command.torque.into(),
            mode: Mode::from(command.mode) as i32,
            findings: command.findings.bits().into(),
            brake: command.brake.into(),
            ran: output.is_some().into(),
            flags: output.map_or(0, |output| kinds::flags(&output.status)),
        }
    }
}

impl<T: Real> From<&mm_control::Signals<T, 3>> for Signals<T> {
    fn from(signals: &mm_control::Signals<T, 3>) -> Self {
        Self {
            velocity: signals.nu.into(),
            tip_m: signals.tip.into(),
            error_m: signals.error.into(),
            virtual_velocity: signals.nu_c.into(),
            reference_velocity: signals.nu_r.into(),
            reference_acceleration: signals.dnu_r.into(),
            sliding: signals.sliding.into(),
            equivalent: signals.equivalent.into(),
            fuzzy: signals.fuzzy.into(),
            learned: signals.learned.into(),
            commanded: signals.commanded.into(),
            manipulability_squared: signals.manipulability_squared,
            damping_squared: signals.damping_squared,
        }
    }
}
