//! The outer loop where it is restrained: the correction at its largest speed, channels at their bounds, the base held.
//!
//! Laws: (1) the correction is K e up to its largest speed and points the same way with that length beyond; (2) no joint rate leaves
//! gamma (hi - q) and -gamma (q - lo), no forward speed that of the robot's limits; the free channels make the solution of least
//! weighted norm for what the held ones leave, less what they fall short of, so that where enough is left the tip still gets
//! the velocity asked for; where nothing is exceeded the law is the ordinary one, bit for bit; nu_c does not jump when a channel comes
//! to its bound; (3) with the base held nu_c leaves it at rest, and released it has its weight by beta; (4) in all of this dnu_c
//! is the derivative of nu_c along the motion.
//!
//! Reference: central differences along the exact arc, extrapolated twice; the conditions of the minimum as one linear system, held
//! channels' columns left out, solved anew for every channel held, what is left as a quotient of determinants; beta in closed form.
//!
//! Tolerance: 1e-6 of |dnu_c| for the differences, of which they leave 3e-8; rounding times their condition for the minima;
//! 1e-12 for bounds. Where several channels are at their bounds the order in which they are held decides, and nu_c
//! may jump: the test counts those changes and asks for none at the first channel.

mod held_base;
mod held_channels;
mod speed;

use crate::common::motion::random_params;
use crate::common::random::Random;
use mm_control::{ControlStack, Gains, LawKind, OuterOutput, OuterParams, Reference, StackParams};
use mm_model::{Configuration, Robot, Velocity};
use nalgebra::SVector;

type Stack = ControlStack<f64, 3>;
type Params = OuterParams<f64, 3>;

#[expect(clippy::expect_used, reason = "a test that cannot build its stack has failed")]
fn stack(robot: &Robot<f64, 3>, outer: Params, period: f64) -> Stack {
    let gains = Gains::for_robot(robot, LawKind::Bsmc, period);
    ControlStack::try_new(
        *robot,
        LawKind::Bsmc,
        StackParams { period, outer, gains, estimator: mm_control::Estimator::None },
    )
    .expect("the random gains are allowed")
}

fn evaluate(
    stack: &Stack,
    (q, nu): (&Configuration<f64, 3>, &Velocity<f64, 3>),
    reference: &Reference<f64>,
    update: u32,
) -> OuterOutput<f64, 3> {
    let robot = stack.robot();
    stack.outer().evaluate(robot, (q, &robot.sines(q)), nu, reference, update)
}

/// What the channels are held to: lower and upper bounds, none for the yaw rate.
fn bounds(stack: &Stack, q: &Configuration<f64, 3>) -> [(f64, f64); 5] {
    let limits = &stack.robot().params().limits;
    let gamma = stack.outer().params().joint_limit_rate;
    let mut all = [(-limits.speed, limits.speed); 5];
    all[1] = (f64::NEG_INFINITY, f64::INFINITY);
    for (bound, (q, (lo, hi))) in all[2..].iter_mut().zip(q.joints.iter().zip(limits.joints)) {
        *bound = (gamma * (lo - q), gamma * (hi - q));
    }
    all
}

/// A case in which channels are likely to be held: a random robot within its joint limits, a small gamma.
fn tight(draw: &mut Random) -> (Stack, Configuration<f64, 3>) {
    let robot = draw.robot();
    let mut q = draw.configuration();
    for (joint, (lo, hi)) in q.joints.iter_mut().zip(robot.params().limits.joints) {
        *joint = lo + (hi - lo) * draw.between(0.02, 0.98);
    }
    let ratio = draw.between(0.2, 0.8);
    let mut params = random_params(draw, robot.manipulability(&q), ratio);
    params.joint_limit_rate = draw.between(0.3, 3.0);
    // The push off the limits is of the second order at its margin: differences lose theirs there.
    params.joint_limit_gain = 0.0;
    (stack(&robot, params, 1e-3), q)
}

/// Which channels are at a bound, as a mark each.
fn held(stack: &Stack, q: &Configuration<f64, 3>, nu_c: &SVector<f64, 5>) -> [bool; 5] {
    let bounds = bounds(stack, q);
    core::array::from_fn(|i| {
        let (lo, hi) = bounds[i];
        (nu_c[i] - lo).abs() < 1e-10 || (nu_c[i] - hi).abs() < 1e-10
    })
}
