//! What the program does: one update of the supervised controller for each row of the table.

use core::fmt::Write;

use mm_control::fuzzy::Surface;
use mm_control::supervisor::Mode;
use mm_control::{
    Bfsmc, Command, ControlStack, Estimator, Gains, Input, LawKind, OuterParams, Reference, SetupError,
    StackParams, SupervisedStack, SupervisedState, SupervisorParams, Timing,
};
use mm_model::{Configuration, Robot, RobotParams, Velocity};
use nalgebra::Vector3;

use crate::table::{Row, TABLE};

/// The stack, of one law with one kind of fuzzy system: nothing of the others is linked.
pub(crate) type Stack = SupervisedStack<f32, 3, Bfsmc<f32, 3, Surface<f32, 65>>>;

/// Time between two updates, s.
const PERIOD: f32 = 1e-3;

/// Updates and prints a checksum of what came out; whether that worked.
pub(crate) fn run(out: &mut impl Write, (stack, state): (&Stack, &mut SupervisedState<f32, 3>)) -> bool {
    let (mut runs, mut checksum) = (0, 0);
    for row in &TABLE {
        let command = update(stack, state, &input(row));
        runs += u32::from(command.mode == Mode::Run);
        checksum = added(checksum, &command);
    }
    writeln!(out, "control-tick updates={} runs={runs} checksum={checksum:08x}", TABLE.len()).is_ok()
}

/// The robot of the thesis under the law `bfsmc`, as they are.
pub(crate) fn stack() -> Result<Stack, SetupError> {
    let robot = Robot::try_new(RobotParams::thesis())?;
    let gains = Gains::for_robot(&robot, LawKind::Bfsmc, PERIOD);
    let outer = OuterParams::for_robot(&robot);
    let params = StackParams { period: PERIOD, outer, gains, estimator: Estimator::None };
    let supervisor = SupervisorParams::for_robot(&robot, PERIOD);
    let law = Bfsmc::with_term(&params.gains, Surface::smooth()?)?;
    SupervisedStack::try_new(ControlStack::with_law(robot, law, params)?, supervisor)
}

/// The update: a function of its own, so that its instructions can be counted and its stack measured.
#[inline(never)]
fn update(stack: &Stack, state: &mut SupervisedState<f32, 3>, input: &Input<f32, 3>) -> Command<f32, 3> {
    stack.update(state, Timing::exact(PERIOD), input)
}

/// What enters an update, from a row of the table.
fn input(row: &Row) -> Input<f32, 3> {
    let Row { q: [x, y, heading, q1, q2, q3], nu, reference } = *row;
    let [position, velocity, acceleration] = reference.map(Vector3::from);
    Input {
        q: Configuration { x, y, heading, joints: [q1, q2, q3] },
        nu: Velocity::from_channels(nu.into_iter()),
        reference: Reference { position, velocity, acceleration },
    }
}

/// The checksum with a command more: bits as the digits of a number with base 31, modulo 2^32.
fn added(checksum: u32, command: &Command<f32, 3>) -> u32 {
    let torque = &command.torque;
    let numbers = [torque.right, torque.left].into_iter().chain(torque.joints).map(f32::to_bits);
    numbers
        .chain([u32::from(command.findings.bits()), command.mode as u32])
        .fold(checksum, |sum, bits| sum.wrapping_mul(31).wrapping_add(bits))
}
