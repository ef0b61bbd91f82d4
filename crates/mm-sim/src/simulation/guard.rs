//! What stands before the controller in a loop: faults that corrupt its inputs, and the supervisor that finds them.

use std::borrow::Cow;

use mm_control::supervisor::{Findings, Mode};
use mm_control::{
    Command, ControlError, ControlStack, ControlState, Input, Measurement, Output, Reference, Signals,
    Status, SupervisedStack, SupervisedState, Timing, WheelAngles,
};
use mm_model::{Configuration, Force, Torque, Velocity};
use nalgebra::Vector3;
use serde::Serialize;

use super::Ending;
use crate::faults::{Coming, Fault, Faults, Numbers, place};

/// Supervisor and faults of a loop.
#[derive(Debug, Clone)]
pub struct Guard {
    /// The supervised stack, the same as that of the loop; without it the controller runs on whatever comes.
    pub supervisor: Option<SupervisedStack<f64, 3>>,
    /// What goes wrong.
    pub faults: Vec<Fault>,
}

/// What a supervisor did in a run; the part `supervisor` of the summary.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct SupervisorReport {
    /// Mode after the last update.
    pub mode: &'static str,
    /// Updates with a held torque.
    pub held_periods: u64,
    /// Updates in a stop.
    pub stopped_periods: u64,
    /// Stops begun.
    pub stops: u64,
    /// When the first of them began, s.
    pub first_stop_s: Option<f64>,
    /// Everything that was found, in the order of the supervisor's documentation.
    pub findings: Vec<Found>,
}

/// One kind of finding.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Found {
    /// Its name.
    pub finding: &'static str,
    /// Updates with it.
    pub periods: u64,
    /// When it was first found, s.
    pub first_s: f64,
}

/// A guard at work.
#[derive(Debug, Clone)]
pub(super) struct Running<'a> {
    stack: Cow<'a, ControlStack<f64, 3>>,
    supervisor: Option<(Cow<'a, SupervisedStack<f64, 3>>, SupervisedState<f64, 3>)>,
    faults: Faults<'a>,
    /// What the last update gave, with the torque that acts now.
    last: Output<f64, 3>,
    /// Time since the last update for which the controller did not run, s.
    stalled: f64,
    report: SupervisorReport,
    found: [Option<(u64, f64)>; Findings::ALL.len()],
    mode: Mode,
}

impl<'a> Running<'a> {
    pub(super) fn new(guard: &'a Guard, stack: &'a ControlStack<f64, 3>) -> Self {
        Self {
            stack: Cow::Borrowed(stack),
            supervisor: guard
                .supervisor
                .as_ref()
                .map(|supervised| (Cow::Borrowed(supervised), supervised.initial_state())),
            faults: Faults::new(&guard.faults),
            last: nothing(),
            stalled: 0.0,
            report: SupervisorReport {
                mode: Mode::Run.name(),
                held_periods: 0,
                stopped_periods: 0,
                stops: 0,
                first_stop_s: None,
                findings: Vec::new(),
            },
            found: [None; Findings::ALL.len()],
            mode: Mode::Run,
        }
    }

    /// Goes on with another controller, which remembers what this one does.
    pub(super) fn retune(
        &mut self,
        stack: ControlStack<f64, 3>,
        supervised: Option<SupervisedStack<f64, 3>>,
    ) {
        self.stack = Cow::Owned(stack);
        if let (Some((current, state)), Some(supervised)) = (&mut self.supervisor, supervised) {
            supervised.take_over(state, current);
            *current = Cow::Owned(supervised);
        }
    }

    /// The controller's period that begins at `t`, with what reaches it of the input.
    #[inline(never)]
    pub(super) fn update(
        &mut self,
        (t, period): (f64, f64),
        control: &mut ControlState<f64, 3>,
        input: &Input<f64, 3>,
        measured: Option<Measurement<f64, 3>>,
    ) -> Result<Output<f64, 3>, Ending> {
        let mut numbers = packed(input, measured.as_ref(), self.stalled + period);
        let coming = self.faults.corrupt(t, &mut numbers);
        if coming == Coming::Stalled {
            self.stalled += period;
            return Ok(self.last);
        }
        self.stalled = 0.0;
        let wheels = measured.as_ref().map(|measured| measured.wheels.is_some());
        let times = if coming == Coming::Twice { 2 } else { 1 };
        for repeated in 0..times {
            let comes = coming != Coming::Missing;
            let elapsed = if repeated == 0 { numbers[place::CLOCK] } else { 0.0 };
            let numbers = comes.then(|| with_clock(&numbers, elapsed));
            self.once(t, elapsed, control, (numbers.as_ref(), wheels))?;
        }
        Ok(self.last)
    }

    /// One update of the controller; `wheels` is some with sensors, and says whether the wheels have encoders.
    fn once(
        &mut self,
        t: f64,
        elapsed: f64,
        control: &mut ControlState<f64, 3>,
        (numbers, wheels): (Option<&Numbers>, Option<bool>),
    ) -> Result<(), Ending> {
        let Some((supervised, state)) = &mut self.supervisor else {
            let Some(numbers) = numbers else { return Ok(()) };
            self.last = unguarded(&self.stack, control, numbers, wheels)
                .map_err(|error| Ending::Refused { t, error })?;
            return Ok(());
        };
        let command = match numbers {
            None => supervised.missed(state, elapsed),
            Some(numbers) => {
                let timing = Timing { elapsed, age: numbers[place::AGE] };
                let input = unpacked(numbers);
                match wheels {
                    None => supervised.update(state, timing, &input),
                    Some(encoders) => supervised.update_measured(
                        state,
                        timing,
                        &measurement(numbers, encoders),
                        &input.reference,
                    ),
                }
            }
        };
        self.take(t, &command)
    }

    /// Keeps what a command gives and counts what was found.
    fn take(&mut self, t: f64, command: &Command<f64, 3>) -> Result<(), Ending> {
        match command.output {
            Some(output) => self.last = output,
            None => {
                self.last.torque = command.torque;
                self.last.status = Status::default();
                self.last.signals.commanded = command.torque;
            }
        }
        for (slot, (finding, _)) in self.found.iter_mut().zip(Findings::ALL) {
            if command.findings.contains(finding) {
                slot.get_or_insert((0, t)).0 += 1;
            }
        }
        let report = &mut self.report;
        report.held_periods += u64::from(command.mode == Mode::Hold);
        if command.mode == Mode::Stop {
            report.stopped_periods += 1;
            if self.mode != Mode::Stop {
                report.stops += 1;
                report.first_stop_s.get_or_insert(t);
            }
        }
        self.mode = command.mode;
        report.mode = command.mode.name();
        if command.mode == Mode::Fault {
            return Err(Ending::Faulted { t, findings: command.findings });
        }
        Ok(())
    }

    /// What the supervisor did; none without one.
    pub(super) fn report(self) -> Option<SupervisorReport> {
        self.supervisor.as_ref()?;
        let found = self.found.into_iter().zip(Findings::ALL);
        let findings = found
            .filter_map(|(found, (_, finding))| {
                found.map(|(periods, first_s)| Found { finding, periods, first_s })
            })
            .collect();
        Some(SupervisorReport { findings, ..self.report })
    }
}

/// The stack without a supervisor.
fn unguarded(
    stack: &ControlStack<f64, 3>,
    control: &mut ControlState<f64, 3>,
    numbers: &Numbers,
    wheels: Option<bool>,
) -> Result<Output<f64, 3>, ControlError> {
    let input = unpacked(numbers);
    match wheels {
        None => stack.update(control, &input),
        Some(encoders) => stack.update_measured(control, &measurement(numbers, encoders), &input.reference),
    }
}

fn with_clock(numbers: &Numbers, elapsed: f64) -> Numbers {
    let mut numbers = *numbers;
    numbers[place::CLOCK] = elapsed;
    numbers
}

fn packed(input: &Input<f64, 3>, measured: Option<&Measurement<f64, 3>>, elapsed: f64) -> Numbers {
    let Input { q, nu, reference } = input;
    let q = measured.map_or(q, |measured| &measured.q);
    let wheels = measured.and_then(|measured| measured.wheels);
    let [q1, q2, q3] = q.joints;
    let [d1, d2, d3] = nu.joints;
    let (right, left) = wheels.map_or((0.0, 0.0), |wheels| (wheels.right, wheels.left));
    let Reference { position: p, velocity: v, acceleration: a } = reference;
    [
        q.x,
        q.y,
        q.heading,
        q1,
        q2,
        q3,
        nu.forward,
        nu.yaw_rate,
        d1,
        d2,
        d3,
        right,
        left,
        p.x,
        p.y,
        p.z,
        v.x,
        v.y,
        v.z,
        a.x,
        a.y,
        a.z,
        elapsed,
        0.0,
    ]
}

const fn unpacked(numbers: &Numbers) -> Input<f64, 3> {
    let [
        x,
        y,
        heading,
        q1,
        q2,
        q3,
        forward,
        yaw_rate,
        d1,
        d2,
        d3,
        _,
        _,
        px,
        py,
        pz,
        vx,
        vy,
        vz,
        ax,
        ay,
        az,
        _,
        _,
    ] = *numbers;
    Input {
        q: Configuration { x, y, heading, joints: [q1, q2, q3] },
        nu: Velocity { forward, yaw_rate, joints: [d1, d2, d3] },
        reference: Reference {
            position: Vector3::new(px, py, pz),
            velocity: Vector3::new(vx, vy, vz),
            acceleration: Vector3::new(ax, ay, az),
        },
    }
}

fn measurement(numbers: &Numbers, encoders: bool) -> Measurement<f64, 3> {
    let wheels = WheelAngles { right: numbers[place::WHEELS.start], left: numbers[place::WHEELS.start + 1] };
    Measurement { q: unpacked(numbers).q, wheels: encoders.then_some(wheels) }
}

/// What a controller gave that never ran.
fn nothing() -> Output<f64, 3> {
    let (nu, force) = (Velocity::zero(), Force::zero());
    Output {
        torque: Torque::zero(),
        status: Status::default(),
        signals: Signals {
            nu,
            tip: Vector3::zeros(),
            error: Vector3::zeros(),
            nu_c: nu,
            nu_r: nu,
            dnu_r: nu,
            sliding: nu,
            equivalent: force,
            fuzzy: force,
            learned: force,
            commanded: Torque::zero(),
            manipulability_squared: 0.0,
            damping_squared: 0.0,
        },
    }
}
