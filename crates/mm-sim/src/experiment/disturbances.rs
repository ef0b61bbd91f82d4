//! The disturbances of a scenario.

use mm_model::Torque;
use nalgebra::Vector3;

use crate::disturbance::{Disturbance, Disturbances, Shape, Slip, Target};
use crate::random::split_mix;
use crate::scenario::{self, DisturbanceTarget};

/// All disturbances of the file; the seed of a noise is made of the run's and the disturbance's place in the file.
pub(super) fn disturbances(file: &scenario::ScenarioFile) -> Disturbances {
    let all = file.disturbance.iter().zip(1_u64..).map(|(raw, number)| Disturbance {
        target: target(raw),
        shape: match raw.shape {
            scenario::Shape::Sine { frequency_rad_s, phase_rad } => {
                Shape::Sine { frequency: frequency_rad_s, phase: phase_rad }
            }
            scenario::Shape::Noise { hold_s } => {
                Shape::Noise { hold: hold_s, seed: split_mix(file.simulation.seed) ^ number }
            }
            scenario::Shape::Step | scenario::Shape::Pulse => Shape::Constant,
        },
        amplitude: [raw.amplitude_n_m, raw.amplitude_n, raw.amplitude_m_s, raw.amplitude_rad_s]
            .into_iter()
            .flatten()
            .next()
            .unwrap_or(0.0),
        from: raw.from_s,
        to: raw.to_s.unwrap_or(f64::INFINITY),
    });
    Disturbances::new(all.collect())
}

fn target(raw: &scenario::Disturbance) -> Target {
    let torque = |right, left, joints| Target::Torque(Torque { right, left, joints });
    match raw.on {
        DisturbanceTarget::Right => torque(1.0, 0.0, [0.0; 3]),
        DisturbanceTarget::Left => torque(0.0, 1.0, [0.0; 3]),
        DisturbanceTarget::Joint1 => torque(0.0, 0.0, [1.0, 0.0, 0.0]),
        DisturbanceTarget::Joint2 => torque(0.0, 0.0, [0.0, 1.0, 0.0]),
        DisturbanceTarget::Joint3 => torque(0.0, 0.0, [0.0, 0.0, 1.0]),
        DisturbanceTarget::Joints => torque(0.0, 0.0, [1.0; 3]),
        DisturbanceTarget::Tip => {
            let direction = Vector3::from(raw.direction.unwrap_or([0.0, 0.0, 1.0]));
            let length = mm_model::Real::sqrt(direction.norm_squared());
            Target::Tip(direction / length)
        }
        DisturbanceTarget::SlipForward => Target::Slip(Slip { forward: 1.0, ..Slip::default() }),
        DisturbanceTarget::SlipSideways => Target::Slip(Slip { sideways: 1.0, ..Slip::default() }),
        DisturbanceTarget::SlipYaw => Target::Slip(Slip { yaw_rate: 1.0, ..Slip::default() }),
    }
}
