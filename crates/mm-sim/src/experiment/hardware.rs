//! Sensors, actuators and payload of a scenario.

use mm_control::Estimator;
use mm_model::RobotParams;

use crate::hardware::{Actuators, Axis, Hardware, Motor, PoseSource, Sensors};
use crate::plant::Payload;
use crate::scenario::{self, EstimatorKind, Loaded, ScenarioError};

/// The estimator that the file asks for, or that its sensors need.
pub(super) fn estimator(loaded: &Loaded) -> Result<Estimator<f64>, ScenarioError> {
    let file = &loaded.file;
    let is_ideal = file.plant.sensors == scenario::Sensors::default();
    let scenario::Estimator { kind, cutoff_hz, .. } = file.controller.estimator;
    Ok(match kind {
        Some(EstimatorKind::None) if !is_ideal => {
            let message = "no estimator, where sensors read positions alone";
            let expected = "`filtered-difference` or `observer`";
            return Err(loaded.problem("controller.estimator.kind", message, expected));
        }
        Some(EstimatorKind::None) => Estimator::None,
        None if is_ideal => Estimator::None,
        None | Some(EstimatorKind::FilteredDifference) => Estimator::FilteredDifference { cutoff_hz },
        Some(EstimatorKind::Observer) => Estimator::Observer { cutoff_hz },
    })
}

/// Sensors and actuators, where any of them is more than a wire or an estimator wants to be fed.
pub(super) fn hardware(file: &scenario::ScenarioFile, estimates: bool) -> Option<Hardware> {
    let sensors = sensors(file);
    let actuators = actuators(&file.plant.actuators, file.simulation.plant_step_s);
    (estimates || !actuators.is_ideal()).then_some(Hardware { sensors, actuators })
}

#[expect(clippy::cast_precision_loss, reason = "a power of two is exact")]
fn sensors(file: &scenario::ScenarioFile) -> Sensors {
    let raw = &file.plant.sensors;
    let step = |own: Option<u32>| {
        own.or(raw.bits).map_or(0.0, |bits| core::f64::consts::TAU / (1_u64 << bits) as f64)
    };
    Sensors {
        wheel_encoders: raw.wheel_encoders,
        wheel_step: step(raw.wheel_bits),
        joint_step: step(raw.joint_bits),
        pose: match raw.pose_source {
            scenario::PoseSource::True => PoseSource::True {
                position_resolution: raw.position_resolution_m,
                position_noise: raw.position_noise_m,
                heading_resolution: raw.heading_resolution_rad,
                heading_noise: raw.heading_noise_rad,
            },
            scenario::PoseSource::Odometry => PoseSource::Odometry,
        },
        delay: raw.delay_periods as usize,
        seed: file.simulation.seed,
    }
}

fn actuators(raw: &scenario::Actuators, step: f64) -> Actuators {
    let axis = |limit: Option<f64>| Axis {
        limit: limit.unwrap_or(f64::INFINITY),
        lag: raw.lag_s,
        rate: raw.rate_limit_n_m_s.unwrap_or(f64::INFINITY),
    };
    let wheel = axis(raw.wheel_torque_limit_n_m);
    let joint = |i: usize| axis(raw.joint_torque_limit_n_m.map(|limits| limits[i]));
    let wheel_motor = raw.motor.wheel.as_ref().map(motor);
    let joint_motor = |i: usize| raw.motor.joint.get(i).map(motor);
    Actuators {
        axes: [wheel, wheel, joint(0), joint(1), joint(2)],
        motors: [wheel_motor, wheel_motor, joint_motor(0), joint_motor(1), joint_motor(2)],
        delay: raw.delay_periods as usize,
        step,
    }
}

fn motor(raw: &scenario::Motor) -> Motor {
    Motor {
        resistance: raw.resistance_ohm,
        inductance: raw.inductance_h,
        torque_constant: raw.torque_constant_n_m_a,
        gear_ratio: raw.gear_ratio,
        supply: raw.supply_v,
        current_limit: raw.current_limit_a.unwrap_or(f64::INFINITY),
    }
}

/// Refuses what imposed velocities leave without a use.
pub(super) fn refuse(loaded: &Loaded) -> Result<(), ScenarioError> {
    let plant = &loaded.file.plant;
    for (key, is_given) in [
        ("plant.sensors", plant.sensors != scenario::Sensors::default()),
        ("plant.actuators", plant.actuators != scenario::Actuators::default()),
    ] {
        if is_given {
            let message = "imposed velocities are neither measured nor driven";
            return Err(loaded.problem(key, message, "a trajectory that a controller follows"));
        }
    }
    Ok(())
}

/// The payload of the file, given the parameters of the robot without it.
pub(super) fn payload(loaded: &Loaded, bare: RobotParams<f64, 3>) -> Result<Option<Payload>, ScenarioError> {
    let raw = &loaded.file.plant;
    if !(raw.payload_kg > 0.0) {
        return Ok(None);
    }
    Ok(Some(Payload {
        robot: super::robot::checked(loaded, bare.with_payload(raw.payload_kg))?,
        from: raw.payload_from_s,
        to: raw.payload_to_s.unwrap_or(f64::INFINITY),
    }))
}
