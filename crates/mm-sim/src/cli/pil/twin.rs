//! The controller on the target, and the same one here beside it: every answer is compared.

use mm_control::supervisor::{Mode, Timing};
use mm_control::{
    Command, Input, Measurement, Output, Reference, Signals, Status, SupervisedStack, SupervisedState,
    WheelAngles,
};
use mm_link::{Kind, Scalar, Seen, Setup, Stage, Stages, Tick};
use mm_model::{Configuration, Force, Torque, Velocity};
use nalgebra::Vector3;
use serde::Serialize;

use super::client::{Client, LinkError};
use crate::simulation::{Controller, Ending};

/// Where host and target part for the first time.
#[derive(Debug, Clone, Serialize)]
pub(super) struct Difference {
    pub(super) tick: u64,
    pub(super) t_s: f64,
    /// The first stage whose signals differ, or what the supervisor says.
    pub(super) stage: String,
}

/// What was compared.
#[derive(Debug, Clone, Default)]
pub(super) struct Tally {
    pub(super) ticks: u64,
    pub(super) equal: u64,
    pub(super) first: Option<Difference>,
    /// Ticks of the target's timer, update by update.
    pub(super) costs: Vec<u32>,
    /// Updates for which the supervisor did not let the law run.
    pub(super) unsupervised: u64,
}

/// A target at the end of a link, and its twin here.
pub(super) struct Twin<'a, T: Scalar> {
    client: &'a mut Client,
    stack: SupervisedStack<T, 3>,
    state: SupervisedState<T, 3>,
    timing: Timing<T>,
    seq: u32,
    last: Output<f64, 3>,
    pub(super) tally: Tally,
    /// Why the link failed, where it did.
    pub(super) failed: Option<LinkError>,
}

impl<'a, T: Scalar> Twin<'a, T> {
    pub(super) fn new(client: &'a mut Client, stack: SupervisedStack<T, 3>, setup: &Setup<T>) -> Self {
        Self {
            state: stack.initial_state(),
            stack,
            timing: Timing::exact(setup.stack.period),
            client,
            seq: 0,
            last: nothing(),
            tally: Tally::default(),
            failed: None,
        }
    }

    fn here(&mut self, tick: &Tick<T>) -> Command<T, 3> {
        match &tick.seen {
            Seen::State { q, nu } => {
                let input = Input { q: *q, nu: *nu, reference: tick.reference };
                self.stack.update(&mut self.state, tick.timing, &input)
            }
            Seen::Measured(measurement) => {
                self.stack.update_measured(&mut self.state, tick.timing, measurement, &tick.reference)
            }
        }
    }
}

impl<T: Scalar> Controller for Twin<'_, T> {
    const ELSEWHERE: bool = true;

    fn update(
        &mut self,
        t: f64,
        input: &Input<f64, 3>,
        measured: Option<Measurement<f64, 3>>,
    ) -> Result<Output<f64, 3>, Ending> {
        let seen = measured.map_or_else(
            || Seen::State { q: configuration(&input.q), nu: velocity(&input.nu) },
            |measured| Seen::Measured(measurement(&measured)),
        );
        let tick = Tick { timing: self.timing, seen, reference: reference(&input.reference) };
        let number = self.tally.ticks;
        // Numbers begin at 1 and may begin anew.
        self.seq = self.seq.wrapping_add(1);
        let asked = self.client.ask((T::TICK, T::COMMAND), ("a tick", self.seq), &tick);
        let there: mm_link::Command<T> = match asked {
            Ok(command) => command,
            Err(error) => {
                self.failed = Some(error);
                return Err(Ending::Stopped { t });
            }
        };
        let here = self.here(&tick);
        self.tally.ticks += 1;
        self.tally.costs.push(there.cost);
        match difference(&here, &there) {
            None => self.tally.equal += 1,
            Some(stage) if self.tally.first.is_none() => {
                self.tally.first = Some(Difference { tick: number, t_s: t, stage });
            }
            Some(_) => {}
        }
        match &here.output {
            Some(output) => self.last = widened(output),
            None => self.tally.unsupervised += 1,
        }
        // What acts on the plant is what the target computed.
        self.last.torque = torque(&there.torque);
        if here.mode != Mode::Run {
            self.last.signals.commanded = self.last.torque;
        }
        Ok(self.last)
    }
}

/// The first thing in which two commands differ.
fn difference<T: Scalar>(here: &Command<T, 3>, there: &mm_link::Command<T>) -> Option<String> {
    let stages = here.output.as_ref().map_or_else(Stages::default, Stages::of);
    if let Some(stage) = stages.first_difference(&there.stages) {
        return Some(stage.to_string());
    }
    if (here.mode, here.findings, here.brake) != (there.mode, there.findings, there.brake) {
        return Some("supervisor".to_owned());
    }
    (bits(&here.torque) != bits(&there.torque)).then(|| Stage::Torque.to_string())
}

/// The bits of a torque; single precision in double is exact.
fn bits<T: Scalar>(torque: &Torque<T, 3>) -> [u64; 5] {
    let Torque { right, left, joints: [a, b, c] } = *torque;
    [right, left, a, b, c].map(|number| number.to_f64().to_bits())
}

fn torque<T: Scalar>(torque: &Torque<T, 3>) -> Torque<f64, 3> {
    let Torque { right, left, joints } = *torque;
    Torque { right: right.to_f64(), left: left.to_f64(), joints: joints.map(T::to_f64) }
}

fn configuration<T: Scalar>(q: &Configuration<f64, 3>) -> Configuration<T, 3> {
    let n = T::from_f64;
    Configuration { x: n(q.x), y: n(q.y), heading: n(q.heading), joints: q.joints.map(n) }
}

fn velocity<T: Scalar>(nu: &Velocity<f64, 3>) -> Velocity<T, 3> {
    Velocity::from_channels(nu.channels().map(T::from_f64))
}

fn measurement<T: Scalar>(measured: &Measurement<f64, 3>) -> Measurement<T, 3> {
    let wheels = measured
        .wheels
        .map(|wheels| WheelAngles { right: T::from_f64(wheels.right), left: T::from_f64(wheels.left) });
    Measurement { q: configuration(&measured.q), wheels }
}

fn reference<T: Scalar>(reference: &Reference<f64>) -> Reference<T> {
    let space = |v: &Vector3<f64>| v.map(T::from_f64);
    Reference {
        position: space(&reference.position),
        velocity: space(&reference.velocity),
        acceleration: space(&reference.acceleration),
    }
}

/// The same output in double precision; exact.
fn widened<T: Scalar>(output: &Output<T, 3>) -> Output<f64, 3> {
    let signals = &output.signals;
    let rate = |v: &Velocity<T, 3>| Velocity::from_channels(v.channels().map(T::to_f64));
    let force = |v: &Force<T, 3>| Force::from_channels(v.channels().map(T::to_f64));
    let space = |v: &Vector3<T>| v.map(T::to_f64);
    Output {
        torque: torque(&output.torque),
        status: output.status,
        signals: Signals {
            nu: rate(&signals.nu),
            tip: space(&signals.tip),
            error: space(&signals.error),
            nu_c: rate(&signals.nu_c),
            nu_r: rate(&signals.nu_r),
            dnu_r: rate(&signals.dnu_r),
            sliding: rate(&signals.sliding),
            equivalent: force(&signals.equivalent),
            fuzzy: force(&signals.fuzzy),
            learned: force(&signals.learned),
            commanded: torque(&signals.commanded),
            manipulability_squared: signals.manipulability_squared.to_f64(),
            damping_squared: signals.damping_squared.to_f64(),
        },
    }
}

/// The output before the first.
fn nothing() -> Output<f64, 3> {
    let zero = Vector3::zeros();
    Output {
        torque: Torque::zero(),
        status: Status::default(),
        signals: Signals {
            nu: Velocity::zero(),
            tip: zero,
            error: zero,
            nu_c: Velocity::zero(),
            nu_r: Velocity::zero(),
            dnu_r: Velocity::zero(),
            sliding: Velocity::zero(),
            equivalent: Force::zero(),
            fuzzy: Force::zero(),
            learned: Force::zero(),
            commanded: Torque::zero(),
            manipulability_squared: 0.0,
            damping_squared: 0.0,
        },
    }
}

/// The same setup in the precision of the target.
pub(super) fn in_precision<T: Scalar>(setup: &Setup<f64>) -> Result<Setup<T>, serde_json::Error> {
    // Every number is finite, and a number as JSON keeps its bits: reading it as another type rounds it once.
    serde_json::from_value(serde_json::to_value(setup)?)
}

/// The end of a session, as far as the target can be told.
pub(super) fn leave(client: &mut Client) {
    client.attempts = 1;
    let _: Result<(), _> = client.ask((Kind::Bye, Kind::Done), ("the end", 0), &());
}
