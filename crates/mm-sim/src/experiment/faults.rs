//! The supervisor and the faults of a scenario.

use mm_control::{ControlStack, SetupError, SupervisedStack, SupervisorParams};
use mm_model::Velocity;

use crate::faults::{Fault, Kind, NUMBERS, Numbers, place};
use crate::random::split_mix;
use crate::scenario::{self, FaultKind, FaultTarget, Loaded, ScenarioError};
use crate::simulation::Guard;

/// What stands before the controller; none where there is neither a supervisor nor a fault.
pub(super) fn guard(
    loaded: &Loaded,
    stack: &ControlStack<f64, 3>,
) -> Result<Option<Box<Guard>>, ScenarioError> {
    let file = &loaded.file;
    let supervisor = if file.controller.supervisor.enabled { Some(supervised(loaded, stack)?) } else { None };
    let period = file.simulation.control_period_s;
    let mut faults = Vec::new();
    for (index, raw) in (0_u64..).zip(&file.fault) {
        if raw.on == FaultTarget::Velocity && stack.estimates() {
            let message = "a velocity that is estimated, not measured";
            let key = format!("fault.{index}.on");
            return Err(loaded.problem(&key, message, "`state`, `pose` or `joints`, which sensors read"));
        }
        faults.push(fault(raw, period, split_mix(file.simulation.seed) ^ index));
    }
    Ok((supervisor.is_some() || !faults.is_empty()).then(|| Box::new(Guard { supervisor, faults })))
}

pub(super) fn supervised(
    loaded: &Loaded,
    stack: &ControlStack<f64, 3>,
) -> Result<SupervisedStack<f64, 3>, ScenarioError> {
    let raw = &loaded.file.controller.supervisor;
    let mut params = SupervisorParams::for_robot(stack.robot(), loaded.file.simulation.control_period_s);
    let set = |field: &mut f64, value: Option<f64>| *field = value.unwrap_or(*field);
    let each = |field: &mut Velocity<f64, 3>, value: Option<[f64; 5]>| {
        *field = value.map_or(*field, |values| Velocity::from_channels(values.into_iter()));
    };
    let count = |field: &mut u32, value: Option<u32>| *field = value.unwrap_or(*field);
    set(&mut params.position, raw.position_m);
    set(&mut params.joint_margin, raw.joint_margin_rad);
    each(&mut params.speed, raw.speed);
    each(&mut params.acceleration, raw.acceleration);
    set(&mut params.position_noise, raw.position_noise);
    set(&mut params.velocity_noise, raw.velocity_noise);
    set(&mut params.reference_step, raw.reference_step_m);
    set(&mut params.reference_acceleration, raw.reference_acceleration_m_s2);
    set(&mut params.age, raw.age_s);
    count(&mut params.hold_periods, raw.hold_periods);
    count(&mut params.recovery_periods, raw.recovery_periods);
    count(&mut params.blind_periods, raw.blind_periods);
    count(&mut params.stop_periods, raw.stop_periods);
    set(&mut params.braking_rate, raw.braking_rate_1_s);
    SupervisedStack::try_new(*stack, params).map_err(|error| {
        let key = match error {
            SetupError::Param(error) => format!("controller.supervisor.{}", error.parameter()),
            _ => "controller.supervisor".to_owned(),
        };
        loaded.problem(&key, error.to_string(), "limits that a supervisor can work with")
    })
}

#[expect(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "the file's checks leave positive times; a cast saturates"
)]
fn fault(raw: &scenario::Fault, period: f64, seed: u64) -> Fault {
    let channel = raw.channel.map(|channel| channel as usize);
    let kind = match raw.kind {
        FaultKind::Nan => Kind::Nan,
        FaultKind::Infinite => Kind::Infinite,
        FaultKind::Offset => Kind::Offset,
        FaultKind::Spike => Kind::Spike((raw.every_s.unwrap_or(0.1) / period).round() as u64),
        FaultKind::Noise => Kind::Noise(seed),
        FaultKind::Scale => Kind::Scale(raw.factor.unwrap_or(1.0)),
        FaultKind::Stuck => Kind::Stuck,
        FaultKind::Delay => Kind::Delay(raw.delay_periods.unwrap_or(1) as usize),
        FaultKind::Drop => Kind::Drop,
        FaultKind::Duplicate => Kind::Duplicate,
        FaultKind::Stall => Kind::Stall,
    };
    let on = match (raw.on, raw.kind) {
        (_, FaultKind::Drop | FaultKind::Duplicate | FaultKind::Stall) => Vec::new(),
        (FaultTarget::State, _) => {
            // Without a channel the wheels' encoders go with the rest.
            let end = if channel.is_none() { place::WHEELS.end } else { place::VELOCITY.end };
            Fault::places(place::CONFIGURATION.start..end, NUMBERS, channel)
        }
        (FaultTarget::Pose, _) => Fault::places(0..3, 3, channel),
        (FaultTarget::Joints, _) => Fault::places(3..6, 3, channel),
        (FaultTarget::Velocity, _) => Fault::places(place::VELOCITY, 5, channel),
        (FaultTarget::Reference, _) => Fault::places(place::REFERENCE, 3, channel),
        (FaultTarget::Clock, _) => vec![place::CLOCK],
        (FaultTarget::Age, _) => vec![place::AGE],
    };
    let to = raw.to_s.unwrap_or(f64::INFINITY);
    Fault { kind, on, amplitudes: amplitudes(raw), from: raw.from_s, to }
}

fn amplitudes(raw: &scenario::Fault) -> Numbers {
    let mut all = [0.0; NUMBERS];
    for (place, slot) in all.iter_mut().enumerate() {
        let amplitude = match place {
            0 | 1 | 13..16 => raw.amplitude_m,
            2..6 => raw.amplitude_rad,
            6 => raw.amplitude_m_s,
            7..11 => raw.amplitude_rad_s,
            place::CLOCK | place::AGE => raw.amplitude_s,
            _ => None,
        };
        *slot = amplitude.unwrap_or(0.0);
    }
    all
}
