//! What is counted: one update of the supervised controller, `bfsmc` with the robot of the thesis, in single precision or fixed point.

use core::fmt::Write;
use core::hint::black_box;

use mm_control::fuzzy::fixed::{SMOOTH_SURFACE, Scaled, Surface1};
use mm_control::fuzzy::{Bundled, Surface};
use mm_control::laws::SwitchingTerm;
use mm_control::{
    Bfsmc, Command, ControlStack, Estimator, Gains, Input, LawKind, OuterParams, Reference, SetupError,
    StackParams, SupervisedStack, SupervisedState, SupervisorParams, Timing,
};
use mm_model::{Configuration, Q32, Real, Robot, RobotParams, Torque, Velocity};

use crate::motions::{Arrived, MOTIONS, Motion, PERIOD, UPDATES};
use crate::{Clock, Count, Counter, Depth};

/// A stack of one law alone, which links nothing of the others.
type Stack<T, F> = SupervisedStack<T, 3, Bfsmc<T, 3, F>>;

/// A scalar that a controller is counted in. Motions are in single precision.
pub trait Counted: Bundled {
    /// The number nearest to one in single precision.
    fn of(value: f32) -> Self;
    /// The lower half of its bits.
    fn bits(self) -> u32;
}

impl Counted for f32 {
    fn of(value: f32) -> Self {
        value
    }

    fn bits(self) -> u32 {
        self.to_bits()
    }
}

impl Counted for Q32 {
    fn of(value: f32) -> Self {
        Self::from_f64(f64::from(value))
    }

    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "bits for a check sum")]
    fn bits(self) -> u32 {
        self.to_raw() as u32
    }
}

/// Counts every motion and writes a line for each, first with the fuzzy surface as a table of numbers, then as whole numbers.
///
/// The bytes of the stack are those of the updates, and those of setting the controller up.
///
/// # Errors
/// A [`SetupError`]: none in practice.
pub fn run<T: Counted, C: Clock>(
    counter: &Counter<C>,
    depth: &mut impl Depth,
    out: &mut impl Write,
) -> Result<(), SetupError> {
    let setup = one::<T, _, _>(counter, depth, (Surface::smooth()?, "control"), out)?;
    // A line that cannot be written is missed on the other side.
    let _ = writeln!(out, "stack update={} setup={} checksum=00000000", setup.update, setup.setup);
    let (edge, most) = (T::ONE, T::from_u32(4) / T::from_u32(3));
    let whole: Scaled<T, Surface1<'static>> = Scaled::try_new(SMOOTH_SURFACE, (-edge, edge), (-most, most))?;
    one::<T, _, _>(counter, depth, (whole, "control-integer-surface"), out)?;
    Ok(())
}

/// Bytes of the stack.
struct Bytes {
    update: u32,
    setup: u32,
}

/// Counts a controller with a switching term. There is one controller at a time: two in fixed point are too many for 16 KiB.
#[inline(never)]
fn one<T: Counted, C: Clock, F: SwitchingTerm<T>>(
    counter: &Counter<C>,
    depth: &mut impl Depth,
    (term, name): (F, &str),
    out: &mut impl Write,
) -> Result<Bytes, SetupError> {
    depth.begin();
    let stack = black_box(stack(term)?);
    let setup = depth.deepest();
    Ok(Bytes { update: counted(counter, depth, (&stack, name), out), setup })
}

/// The robot of the thesis under the law `bfsmc`, as they are.
#[inline(never)]
fn stack<T: Counted, F: SwitchingTerm<T>>(term: F) -> Result<Stack<T, F>, SetupError> {
    let period = T::of(PERIOD);
    let robot = Robot::try_new(RobotParams::thesis())?;
    let gains = Gains::for_robot(&robot, LawKind::Bfsmc, period);
    let outer = OuterParams::for_robot(&robot);
    let law = Bfsmc::with_term(&gains, term)?;
    let params = StackParams { period, outer, gains, estimator: Estimator::None };
    let supervisor = SupervisorParams::for_robot(&robot, period);
    SupervisedStack::try_new(ControlStack::with_law(robot, law, params)?, supervisor)
}

/// Counts every motion; the most bytes of the stack that an update took.
fn counted<T: Counted, C: Clock, F: SwitchingTerm<T>>(
    counter: &Counter<C>,
    depth: &mut impl Depth,
    (stack, name): (&Stack<T, F>, &str),
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
fn updates<T: Counted, C: Clock, F: SwitchingTerm<T>>(
    counter: &Counter<C>,
    depth: &mut impl Depth,
    stack: &Stack<T, F>,
    motion: &Motion,
) -> (Count, u32) {
    let tip = stack.stack().robot().tip_position(&configuration(&motion.middle()));
    let tip = tip.map(in_single_precision);
    let at = |number: u16| arrived::<T>(&motion.at(number, &tip));
    let (mut count, mut torque) = (Count::none(), Torque::zero());
    let mut state = stack.initial_state();
    let overhead = counter.timed_work(|| nothing(stack, &mut state, (&at(0), &mut torque))).0;
    for number in 0..UPDATES {
        let arrived = black_box(at(number));
        let (instructions, mode) = counter.timed_work(|| update(stack, &mut state, (&arrived, &mut torque)));
        count.add(instructions.saturating_sub(overhead));
        for number in [torque.right, torque.left].into_iter().chain(torque.joints) {
            count.note(number.bits());
        }
        count.note(mode);
    }
    // Once more for the stack: to paint it takes longer than an update.
    let mut state = stack.initial_state();
    depth.begin();
    for number in 0..UPDATES {
        let arrived = black_box(at(number));
        black_box(update(stack, &mut state, (&arrived, &mut torque)));
    }
    (count, depth.deepest())
}

/// What arrives at an update, and where its torque goes.
type Ends<'a, T> = (&'a Arrived<T>, &'a mut Torque<T, 3>);

/// One update, as a timer's interrupt would do it.
#[inline(never)]
fn update<T: Counted, F: SwitchingTerm<T>>(
    stack: &Stack<T, F>,
    state: &mut SupervisedState<T, 3>,
    ((timing, input), to): Ends<'_, T>,
) -> u32 {
    let Command { torque, mode, findings, .. } = stack.update(state, *timing, input);
    *to = torque;
    u32::from(findings.bits()) << 8 | mode as u32
}

/// The same call, without an update.
#[inline(never)]
fn nothing<T: Counted, F: SwitchingTerm<T>>(
    stack: &Stack<T, F>,
    state: &mut SupervisedState<T, 3>,
    ends: Ends<'_, T>,
) -> u32 {
    black_box((stack, state, ends));
    0
}

/// What arrives, in another scalar.
fn arrived<T: Counted>((timing, input): &Arrived<f32>) -> Arrived<T> {
    let Input { q, nu, reference } = input;
    let timing = Timing { elapsed: T::of(timing.elapsed), age: T::of(timing.age) };
    let nu = Velocity::from_channels(nu.channels().map(T::of));
    let reference = Reference {
        position: reference.position.map(T::of),
        velocity: reference.velocity.map(T::of),
        acceleration: reference.acceleration.map(T::of),
    };
    (timing, Input { q: configuration(q), nu, reference })
}

fn configuration<T: Counted>(q: &Configuration<f32, 3>) -> Configuration<T, 3> {
    Configuration { x: T::of(q.x), y: T::of(q.y), heading: T::of(q.heading), joints: q.joints.map(T::of) }
}

#[expect(clippy::cast_possible_truncation, reason = "rounding is what is asked for")]
fn in_single_precision<T: Real>(value: T) -> f32 {
    value.to_f64() as f32
}
