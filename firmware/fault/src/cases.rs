//! The cases, one after the other, each from the begin: some good updates, what goes wrong, good updates again.

use core::fmt::Write;

use mm_control::supervisor::{Findings, Mode};
use mm_control::{
    Command, ControlStack, Estimator, Gains, Input, LawKind, OuterParams, Reference, SetupError, StackParams,
    SupervisedStack, SupervisedState, SupervisorParams, Timing,
};
use mm_model::{Configuration, Robot, RobotParams, Velocity};
use nalgebra::Vector3;

type Stack = SupervisedStack<f32, 3>;

/// Time between two updates, s.
const PERIOD: f32 = 1e-3;

/// What happens in an update.
#[derive(Clone, Copy)]
enum Event {
    /// The input is good, and on time.
    Good,
    /// The input is spoilt.
    Spoilt(fn(&mut Input<f32, 3>)),
    /// The input is good; periods since the update before, and its age in periods.
    Clock(f32, f32),
    /// There is no input.
    Missed,
    /// The operator starts anew; no update.
    Reset,
}

use Event::{Clock, Good, Missed, Reset, Spoilt};

/// A case: its name, and how often what happens.
type Case = (&'static str, &'static [(u32, Event)]);

const CASES: [Case; 17] = [
    ("good", &[(40, Good)]),
    ("nan-once", &[(20, Good), (1, Spoilt(|input| input.q.joints[1] = f32::NAN)), (20, Good)]),
    ("nan-velocity", &[(20, Good), (6, Spoilt(|input| input.nu.yaw_rate = f32::NAN)), (40, Good)]),
    ("infinite-position", &[(20, Good), (6, Spoilt(|input| input.q.x = f32::INFINITY)), (40, Good)]),
    ("nan-reference", &[(20, Good), (6, Spoilt(|input| input.reference.position.z = f32::NAN)), (40, Good)]),
    ("out-of-range", &[(20, Good), (6, Spoilt(|input| input.q.joints[2] = 40.0)), (40, Good)]),
    ("huge", &[(20, Good), (6, Spoilt(|input| input.nu.forward = 1e30)), (40, Good)]),
    ("jump", &[(20, Good), (6, Spoilt(|input| input.q.joints[0] += 0.5)), (40, Good)]),
    ("reference-jump", &[(20, Good), (6, Spoilt(|input| input.reference.position.x += 9.0)), (40, Good)]),
    ("early", &[(20, Good), (4, Clock(0.1, 0.0)), (40, Good)]),
    ("late", &[(20, Good), (1, Clock(1.9, 0.0)), (1, Clock(30.0, 0.0)), (40, Good)]),
    ("backwards", &[(20, Good), (1, Clock(-1.0, 0.0)), (40, Good)]),
    ("stale", &[(20, Good), (6, Clock(1.0, 9.0)), (40, Good)]),
    ("missed-once", &[(20, Good), (1, Missed), (20, Good)]),
    ("missed", &[(20, Good), (30, Missed), (40, Good)]),
    ("blind", &[(20, Good), (700, Missed), (40, Good), (1, Reset), (20, Good)]),
    ("first-nan", &[(3, Spoilt(|input| input.q.heading = f32::NAN)), (40, Good)]),
];

/// Runs all cases; whether every torque was within the limits, and the stack refused what it should.
pub(crate) fn run(out: &mut impl Write) -> bool {
    let stack = match stack(PERIOD) {
        Ok(stack) => stack,
        Err(error) => {
            let _ = writeln!(out, "no stack: {error}");
            return false;
        }
    };
    let good = at_rest(stack.stack().robot());
    let mut well = true;
    for (name, events) in &CASES {
        let mut seen = Seen { within: true, ..Seen::default() };
        let mut state = stack.initial_state();
        let _ = write!(out, "{name}:");
        for (count, event) in *events {
            for _ in 0..*count {
                if let Some(command) = happen(&stack, &mut state, &good, event) {
                    seen.add(&stack, &command, out);
                }
            }
        }
        let Seen { mode, updates, findings, brakes, within, checksum } = seen;
        let limits = if within { "within limits" } else { "BEYOND LIMITS" };
        let _ = write!(out, " {mode:?}*{updates}; ");
        let _ = writeln!(out, "findings={findings:03x} brakes={brakes} {limits} checksum={checksum:08x}");
        well &= within;
    }
    refused(out, &stack, &good) && well
}

/// The stack of the thesis's robot with the law `bfsmc`.
fn stack(period: f32) -> Result<Stack, SetupError> {
    let robot = Robot::try_new(RobotParams::thesis())?;
    let gains = Gains::for_robot(&robot, LawKind::Bfsmc, period);
    let outer = OuterParams::for_robot(&robot);
    let params = StackParams { period, outer, gains, estimator: Estimator::None };
    let supervisor = SupervisorParams::for_robot(&robot, PERIOD);
    SupervisedStack::try_new(ControlStack::try_new(robot, LawKind::Bfsmc, params)?, supervisor)
}

/// The rest posture, with the tip where it should be: nothing moves, and nothing shall.
fn at_rest(robot: &Robot<f32, 3>) -> Input<f32, 3> {
    let q = Configuration { joints: robot.params().rest_posture, ..Configuration::zero() };
    let position = robot.tip_position(&q);
    let reference = Reference { position, velocity: Vector3::zeros(), acceleration: Vector3::zeros() };
    Input { q, nu: Velocity::zero(), reference }
}

/// One update, or none.
#[inline(never)]
fn happen(
    stack: &Stack,
    state: &mut SupervisedState<f32, 3>,
    good: &Input<f32, 3>,
    event: &Event,
) -> Option<Command<f32, 3>> {
    let (mut input, mut timing) = (*good, Timing::exact(PERIOD));
    match event {
        Good => {}
        Spoilt(spoil) => spoil(&mut input),
        Clock(elapsed, age) => timing = Timing { elapsed: elapsed * PERIOD, age: age * PERIOD },
        Missed => return Some(stack.missed(state, PERIOD)),
        Reset => {
            stack.reset(state);
            return None;
        }
    }
    Some(stack.update(state, timing, &input))
}

/// What was seen of a case.
#[derive(Default)]
struct Seen {
    mode: Mode,
    /// Updates in this mode.
    updates: u32,
    findings: u16,
    /// Updates with the brakes on.
    brakes: u32,
    within: bool,
    checksum: u32,
}

impl Seen {
    fn add(&mut self, stack: &Stack, command: &Command<f32, 3>, out: &mut impl Write) {
        if command.mode != self.mode {
            if self.updates > 0 {
                let _ = write!(out, " {:?}*{}", self.mode, self.updates);
            }
            (self.mode, self.updates) = (command.mode, 0);
        }
        self.updates += 1;
        self.findings |= Findings::bits(command.findings);
        self.brakes += u32::from(command.brake);
        let (_, is_cut) = stack.stack().robot().limit_torque(&command.torque);
        self.within &= !is_cut && command.torque.is_finite();
        let torque = &command.torque;
        let numbers = [torque.right, torque.left].into_iter().chain(torque.joints);
        // Bits as the digits of a number with base 31, modulo 2^32.
        self.checksum =
            numbers.fold(self.checksum, |sum, value| sum.wrapping_mul(31).wrapping_add(value.to_bits()));
    }
}

/// What the stack itself, without a supervisor, refuses; its state is then as before.
fn refused(out: &mut impl Write, stack: &Stack, good: &Input<f32, 3>) -> bool {
    let stack = stack.stack();
    let mut state = stack.initial_state();
    let mut well = stack.update(&mut state, good).is_ok();
    let spoils: [fn(&mut Input<f32, 3>); 4] = [
        |input| input.q.y = f32::NAN,
        |input| input.nu.joints[0] = f32::NEG_INFINITY,
        |input| input.reference.acceleration.x = f32::NAN,
        |input| input.nu.forward = 1e38,
    ];
    for spoil in spoils {
        let (mut input, before) = (*good, state);
        spoil(&mut input);
        let is_kept = match stack.update(&mut state, &input) {
            Ok(_) => false,
            Err(error) => write!(out, "refused: {error}").is_ok() && state == before,
        };
        let _ = writeln!(out, "; {}", if is_kept { "state kept" } else { "NOT REFUSED, OR STATE CHANGED" });
        well &= is_kept;
    }
    let zero = self::stack(0.0).map(|_| ());
    let _ = match zero {
        Ok(()) => writeln!(out, "a period of 0 s is accepted"),
        Err(error) => writeln!(out, "no stack: {error}"),
    };
    well && zero.is_err()
}
