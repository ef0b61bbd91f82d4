//! What is counted: one update of the supervised controller, `bfsmc` with the robot of the thesis, in single precision.

use core::fmt::Write;
use core::hint::black_box;

use mm_control::fuzzy::Surface;
use mm_control::fuzzy::fixed::{SMOOTH_SURFACE, Scaled, Surface1};
use mm_control::laws::SwitchingTerm;
use mm_control::{
    Bfsmc, Command, ControlStack, Estimator, Gains, Input, LawKind, OuterParams, SetupError, StackParams,
    SupervisedStack, SupervisedState, SupervisorParams, Timing,
};
use mm_model::{Robot, RobotParams, Torque};

use crate::motions::{MOTIONS, Motion, PERIOD, UPDATES};
use crate::{Clock, Count, Counter, Depth};

/// A stack of one law alone, which links nothing of the others.
type Stack<F> = SupervisedStack<f32, 3, Bfsmc<f32, 3, F>>;

/// Counts every motion and writes a line for each, first with the fuzzy surface as a table of numbers, then as whole numbers.
///
/// The bytes of the stack are those of the updates, and those of setting the controller up.
///
/// # Errors
/// A [`SetupError`]: none in practice.
pub fn run<C: Clock>(
    counter: &Counter<C>,
    depth: &mut impl Depth,
    out: &mut impl Write,
) -> Result<(), SetupError> {
    depth.begin();
    let stack = black_box(stack(Surface::smooth()?)?);
    let setup = depth.deepest();
    let most = counted(counter, depth, (&stack, "control"), out);
    // A line that cannot be written is missed on the other side.
    let _ = writeln!(out, "stack update={most} setup={setup} checksum=00000000");
    let range = (-1.0, 1.0);
    let whole: Scaled<f32, Surface1<'static>> =
        Scaled::try_new(SMOOTH_SURFACE, range, (-4.0 / 3.0, 4.0 / 3.0))?;
    let stack = black_box(self::stack(whole)?);
    counted(counter, depth, (&stack, "control-integer-surface"), out);
    Ok(())
}

/// The robot of the thesis under the law `bfsmc`, as they are.
#[inline(never)]
fn stack<F: SwitchingTerm<f32>>(term: F) -> Result<Stack<F>, SetupError> {
    let robot = Robot::try_new(RobotParams::thesis())?;
    let gains = Gains::for_robot(&robot, LawKind::Bfsmc, PERIOD);
    let outer = OuterParams::for_robot(&robot);
    let law = Bfsmc::with_term(&gains, term)?;
    let params = StackParams { period: PERIOD, outer, gains, estimator: Estimator::None };
    let supervisor = SupervisorParams::for_robot(&robot, PERIOD);
    SupervisedStack::try_new(ControlStack::with_law(robot, law, params)?, supervisor)
}

/// Counts every motion; the most bytes of the stack that an update took.
fn counted<C: Clock, F: SwitchingTerm<f32>>(
    counter: &Counter<C>,
    depth: &mut impl Depth,
    (stack, name): (&Stack<F>, &str),
    out: &mut impl Write,
) -> u32 {
    let mut most = 0;
    for motion in &MOTIONS {
        let (count, bytes) = updates(counter, depth, stack, motion);
        most = most.max(bytes);
        let _ = writeln!(out, "{name}-{} {count}", motion.name);
    }
    most
}

/// The updates of a motion, each timed; and the most bytes of the stack that one took.
#[inline(never)]
fn updates<C: Clock, F: SwitchingTerm<f32>>(
    counter: &Counter<C>,
    depth: &mut impl Depth,
    stack: &Stack<F>,
    motion: &Motion,
) -> (Count, u32) {
    let tip = stack.stack().robot().tip_position(&motion.middle());
    let (mut count, mut torque) = (Count::none(), Torque::zero());
    let mut state = stack.initial_state();
    let overhead = counter.timed_work(|| nothing(stack, &mut state, (&motion.at(0, &tip), &mut torque))).0;
    for number in 0..UPDATES {
        let arrived = black_box(motion.at(number, &tip));
        let (instructions, mode) = counter.timed_work(|| update(stack, &mut state, (&arrived, &mut torque)));
        count.add(instructions.saturating_sub(overhead));
        for number in [torque.right, torque.left].into_iter().chain(torque.joints) {
            count.note(number.to_bits());
        }
        count.note(mode);
    }
    // Once more for the stack: to paint it takes longer than an update.
    let mut state = stack.initial_state();
    depth.begin();
    for number in 0..UPDATES {
        let arrived = black_box(motion.at(number, &tip));
        black_box(update(stack, &mut state, (&arrived, &mut torque)));
    }
    (count, depth.deepest())
}

/// What arrives at an update, and where its torque goes.
type Ends<'a> = (&'a (Timing<f32>, Input<f32, 3>), &'a mut Torque<f32, 3>);

/// One update, as a timer's interrupt would do it.
#[inline(never)]
fn update<F: SwitchingTerm<f32>>(
    stack: &Stack<F>,
    state: &mut SupervisedState<f32, 3>,
    ((timing, input), to): Ends<'_>,
) -> u32 {
    let Command { torque, mode, findings, .. } = stack.update(state, *timing, input);
    *to = torque;
    u32::from(findings.bits()) << 8 | mode as u32
}

/// The same call, without an update.
#[inline(never)]
fn nothing<F: SwitchingTerm<f32>>(
    stack: &Stack<F>,
    state: &mut SupervisedState<f32, 3>,
    ends: Ends<'_>,
) -> u32 {
    black_box((stack, state, ends));
    0
}
