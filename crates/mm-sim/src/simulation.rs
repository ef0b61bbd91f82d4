//! The closed loop: reference, controller, plant, metrics and digest, tick by tick.

mod controller;
mod guard;
mod outcome;
mod runaway;

pub use controller::{Controller, Own};
pub use guard::{Found, Guard, SupervisorReport};
pub use outcome::{ASK_EVERY, Ending, NoRecorder, Recorder, Retuned, RunResult, Sample};
pub(crate) use runaway::runaway;

use mm_control::{ControlStack, Input, Output, Reference, Signals, required_gain};
use mm_model::{Force, Mechanism, Torque};
use nalgebra::Vector3;

use crate::digest::Digest;
use crate::hardware::{Hardware, Running};
use crate::metrics::{Accumulator, Tick};
use crate::monitors::{Lyapunov, Monitors};
use crate::plant::{Plant, PlantSines, PlantState};
use crate::trajectory::Trajectory;

/// A closed loop with everything checked: what a scenario becomes.
#[derive(Debug, Clone)]
pub struct Simulation {
    /// Controller.
    pub stack: ControlStack<f64, 3>,
    /// Plant.
    pub plant: Plant,
    /// Reference.
    pub trajectory: Trajectory,
    /// State at time 0.
    pub initial: PlantState,
    /// Clock.
    pub clock: Clock,
    /// Sensors and actuators; none where the controller knows the true state and its torques act at once.
    pub hardware: Option<Hardware>,
    /// Supervisor and faults; none where the controller runs on everything, and everything is right.
    pub guard: Option<Box<Guard>>,
}

/// Ticks of the controller and steps of the plant.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Clock {
    /// Control period, s.
    pub period: f64,
    /// Plant steps in a control period.
    pub substeps: u32,
    /// Control ticks in the run.
    pub ticks: u64,
    /// A sample is given to the recorder every so many ticks.
    pub log_every: u64,
}

impl Clock {
    /// Time of a tick, s.
    #[must_use]
    #[inline]
    #[expect(clippy::cast_precision_loss, reason = "a tick count is far below 2^53")]
    pub fn time(&self, tick: u64) -> f64 {
        tick as f64 * self.period
    }

    /// Duration of the run, s.
    #[must_use]
    pub fn duration(&self) -> f64 {
        self.time(self.ticks)
    }
}

impl Simulation {
    /// Runs the closed loop.
    ///
    /// At each control tick: true tip and error, sensors and controller, actuators, metrics, digest; then the plant under the torque.
    ///
    /// # Errors
    /// Those of the recorder; the run ends there.
    pub fn run<R: Recorder>(&self, recorder: &mut R) -> Result<RunResult, R::Error> {
        self.run_with(recorder, &mut Own)
    }

    /// Runs the closed loop with torques that somebody else computes, or with a plant that somebody else moves.
    ///
    /// # Errors
    /// Those of the recorder; the run ends there.
    pub fn run_with<R: Recorder, C: Controller>(
        &self,
        recorder: &mut R,
        controller: &mut C,
    ) -> Result<RunResult, R::Error> {
        let mut run = Run::new(self);
        let mut ending = Ending::Finished;
        for tick in 0..self.clock.ticks {
            if tick.is_multiple_of(ASK_EVERY) && !recorder.goes_on() {
                ending = Ending::Stopped { t: self.clock.time(tick) };
                break;
            }
            if let Some(early) = run.tick(tick, recorder, controller)? {
                ending = early;
                break;
            }
        }
        Ok(run.result(ending))
    }
}

/// What arrives at the plant's input.
#[derive(Debug, Clone, Copy)]
struct AtPlant {
    torque: Torque<f64, 3>,
    /// Whether the controller or an actuator limited it.
    saturated: bool,
}

/// A run under way.
struct Run<'a> {
    simulation: &'a Simulation,
    /// On the heap, where nothing of the run lies that a period writes: it is not read anew after every store.
    stack: Box<ControlStack<f64, 3>>,
    control: mm_control::ControlState<f64, 3>,
    hardware: Option<Box<Running<'a>>>,
    guard: Option<Box<guard::Running<'a>>>,
    state: PlantState,
    metrics: Accumulator,
    digest: Digest,
    monitors: Monitors,
    /// Whether the law has a switching gain.
    reaches: bool,
    crossed_at: Option<f64>,
}

impl<'a> Run<'a> {
    fn new(simulation: &'a Simulation) -> Self {
        let clock = &simulation.clock;
        let authority = simulation.stack.law().authority();
        Self {
            simulation,
            stack: Box::new(simulation.stack),
            control: simulation.stack.initial_state(),
            hardware: simulation.hardware.as_ref().map(|hardware| {
                Box::new(Running::new(hardware, simulation.plant.robot(), &simulation.initial))
            }),
            guard: simulation
                .guard
                .as_ref()
                .map(|guard| Box::new(guard::Running::new(guard, &simulation.stack))),
            state: simulation.initial,
            metrics: Accumulator::new(clock.duration(), clock.period),
            digest: Digest::new(),
            monitors: Monitors::new(authority),
            reaches: authority.is_some(),
            crossed_at: None,
        }
    }

    /// One control period; `Some` ends the run.
    #[inline]
    fn tick<R: Recorder, C: Controller>(
        &mut self,
        tick: u64,
        recorder: &mut R,
        controller: &mut C,
    ) -> Result<Option<Ending>, R::Error> {
        let Simulation { plant, trajectory, clock, .. } = self.simulation;
        let stack = &*self.stack;
        let t = clock.time(tick);
        let reference = trajectory.at(t);
        let PlantState { q, nu, .. } = self.state;
        let sines = plant.sines(&q);
        let robot = plant.robot();
        let tip = robot.tip_offset(sines.heading, &sines.posture) + Vector3::new(q.x, q.y, 0.0);
        let error = tip - reference.position;
        if let Some((state, value)) = runaway(&error, &nu) {
            self.metrics.note_last_error(&error);
            return Ok(Some(Ending::Diverged { t, state, value }));
        }
        let updated = match (&mut self.guard, &mut self.hardware) {
            (_, hardware) if C::ELSEWHERE => {
                let sensors = hardware.as_deref_mut().filter(|_| stack.estimates());
                let measured = sensors.map(|sensors| sensors.measure(&self.state));
                match controller.update(t, &Input { q, nu, reference }, measured) {
                    Ok(output) => Ok(output),
                    Err(ending) => return Ok(Some(ending)),
                }
            }
            (None, Some(hardware)) if stack.estimates() => {
                stack.update_measured(&mut self.control, &hardware.measure(&self.state), &reference)
            }
            (None, _) => stack.update_with_sines(&mut self.control, &Input { q, nu, reference }, &sines),
            (Some(guard), hardware) => {
                let hardware = hardware.as_deref_mut().filter(|_| stack.estimates());
                let measured = hardware.map(|hardware| hardware.measure(&self.state));
                let input = Input { q, nu, reference };
                match guard.update((t, clock.period), &mut self.control, &input, measured) {
                    Ok(output) => Ok(output),
                    Err(ending) => return Ok(Some(ending)),
                }
            }
        };
        let output = match updated {
            Ok(output) => output,
            Err(error) => return Ok(Some(Ending::Refused { t, error })),
        };
        let mut at_plant = AtPlant { torque: output.torque, saturated: output.status.saturated };
        if let Some(hardware) = &mut self.hardware {
            at_plant.saturated |= hardware.command(&output.torque, &nu);
            at_plant.torque = hardware.torque();
        }
        let manipulability_squared = robot.manipulability_squared(&sines.posture);
        self.measure(t, error, (&output, &at_plant), manipulability_squared);
        if tick.is_multiple_of(clock.log_every) {
            let sample =
                self.sample(t, (tip, &reference), &sines, (&output, &at_plant), manipulability_squared);
            if !recorder.record(&sample)? {
                return Ok(Some(Ending::Stopped { t }));
            }
            if let Some(retuned) = recorder.retuned() {
                self.retune(*retuned);
            }
        }
        if C::MOVES {
            match controller.advance((t, clock.period), &self.state, &at_plant.torque) {
                Ok(state) => self.state = state,
                Err(ending) => return Ok(Some(ending)),
            }
        } else {
            self.advance(t, sines, &at_plant.torque);
        }
        Ok(None)
    }

    /// Goes on with another controller, from the next tick.
    #[cold]
    fn retune(&mut self, Retuned { stack, supervised }: Retuned) {
        if let Some(guard) = &mut self.guard {
            guard.retune(stack, supervised);
        }
        stack.take_over(&mut self.control, &self.stack);
        let authority = stack.law().authority();
        self.reaches = authority.is_some();
        self.monitors.retune(authority);
        *self.stack = stack;
    }

    #[inline]
    fn measure(
        &mut self,
        t: f64,
        error: Vector3<f64>,
        (output, at_plant): (&Output<f64, 3>, &AtPlant),
        manipulability_squared: f64,
    ) {
        let PlantState { q, nu, .. } = &self.state;
        let robot = self.simulation.plant.robot();
        let wheels = robot.wheel_rates(nu.forward, nu.yaw_rate);
        let within_limits = robot.each_within_limits(&q.joints);
        if self.crossed_at.is_none() && within_limits != [true; 3] {
            self.crossed_at = Some(t);
        }
        self.metrics.add(&Tick {
            t,
            error,
            nu,
            wheels: (wheels.right, wheels.left),
            torque: &at_plant.torque,
            sliding: &output.signals.sliding,
            manipulability_squared,
            saturated: at_plant.saturated,
            within_limits,
        });
        self.monitors.tick(t, output, at_plant.saturated);
        self.digest.add(t, q, nu, &at_plant.torque);
    }

    /// A sample for the recorder, with the reaching condition, which only a simulator can evaluate.
    #[inline(never)]
    fn sample<'b>(
        &'b mut self,
        t: f64,
        (tip, reference): (Vector3<f64>, &'b Reference<f64>),
        sines: &PlantSines,
        (output, at_plant): (&'b Output<f64, 3>, &'b AtPlant),
        manipulability_squared: f64,
    ) -> Sample<'b> {
        let plant = &self.simulation.plant;
        let external = plant.external(t, sines);
        let nu = &self.state.nu;
        let required =
            if self.reaches { self.required_gain(t, sines, output, external) } else { Force::zero() };
        let c = &self.stack.outer().params().sliding_gain;
        let lyapunov =
            Lyapunov::evaluate(plant.robot_at(t), (sines, nu), (output, &at_plant.torque), &external, c);
        self.monitors.sample(&lyapunov, &required);
        Sample {
            t,
            state: &self.state,
            tip,
            reference,
            torque: &at_plant.torque,
            external,
            required_gain: required,
            lyapunov,
            manipulability_squared,
            saturated: at_plant.saturated,
            output: Some(output),
        }
    }

    /// The gain that the reaching condition asks for.
    ///
    /// The law's force is B(commanded); what the limit cuts off, B(torque - commanded), is authority that it has lost, and stands
    /// beside the external force.
    fn required_gain(
        &self,
        t: f64,
        sines: &PlantSines,
        output: &Output<f64, 3>,
        external: Force<f64, 3>,
    ) -> Force<f64, 3> {
        let stack = &*self.stack;
        let robot = self.simulation.plant.robot_at(t);
        let signals: &Signals<f64, 3> = &output.signals;
        let cut = robot.force_of(&output.torque).minus(robot.force_of(&signals.commanded));
        required_gain(
            (robot, stack.learns()),
            (&sines.posture, &self.state.nu),
            signals,
            &external.plus(cut),
            &stack.gains().reaching_margin,
        )
    }

    /// The plant over one control period.
    #[inline]
    fn advance(&mut self, t: f64, sines: PlantSines, torque: &Torque<f64, 3>) {
        let Simulation { plant, clock, .. } = self.simulation;
        if let Some(hardware) = &mut self.hardware {
            self.state = hardware.advance((t, clock), plant, &self.state, sines);
            return;
        }
        self.state = plant.step(t, &self.state, &sines, torque);
        let step = clock.period / f64::from(clock.substeps);
        for i in 1..clock.substeps {
            let sines = plant.sines(&self.state.q);
            self.state = plant.step(t + f64::from(i) * step, &self.state, &sines, torque);
        }
    }

    fn result(self, ending: Ending) -> RunResult {
        RunResult {
            metrics: self.metrics.finish(self.monitors.reaching()),
            monitors: Some(self.monitors.report(self.metrics.ticks())),
            supervisor: self.guard.and_then(|guard| guard.report()),
            digest: self.digest.finish(),
            ending,
            joint_limit_crossed_at: self.crossed_at,
            last: self.state,
        }
    }
}
