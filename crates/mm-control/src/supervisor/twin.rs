//! The quick path against the slow one.
//!
//! Law: after an ordinary update, `judge` leaves what `examine` leaves. Reference: `examine` itself, which looks at every number, on a
//! copy of the state. Tolerance: none. What was learned is read late on the quick path: it is compared where it counts, when
//! something is doubtful.

use mm_model::{Configuration, Robot, RobotParams, Torque, Velocity};
use nalgebra::Vector3;

use super::{SupervisedStack, SupervisorParams, Timing, Verdict};
use crate::{
    ControlStack, Estimator, Gains, Input, LawKind, OuterParams, Reference, SetupError, StackParams,
};

const PERIOD: f64 = 1e-3;

/// Numbers in [0, 1) by a linear congruence (D. E. Knuth, MMIX).
struct Draw(u64);

impl Draw {
    #[expect(clippy::cast_precision_loss, reason = "53 bits of it")]
    fn next(&mut self) -> f64 {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 11) as f64 / (1_u64 << 53) as f64
    }

    fn within(&mut self, amount: f64) -> f64 {
        (2.0 * self.next() - 1.0) * amount
    }
}

fn supervised() -> Result<SupervisedStack<f64, 3>, SetupError> {
    let robot = Robot::try_new(RobotParams::thesis())?;
    let gains = Gains::for_robot(&robot, LawKind::Bfsmc, PERIOD);
    let outer = OuterParams::for_robot(&robot);
    let params = StackParams { period: PERIOD, outer, gains, estimator: Estimator::None };
    let stack = ControlStack::try_new(robot, LawKind::Bfsmc, params)?;
    SupervisedStack::try_new(stack, SupervisorParams::for_robot(&robot, PERIOD))
}

#[test]
fn the_quick_path_leaves_what_the_slow_one_leaves() -> Result<(), SetupError> {
    let stack = supervised()?;
    let mut draw = Draw(1);
    let (mut quick, mut doubtful, mut frozen) = (0, 0, 0);
    for _ in 0..200 {
        let mut state = stack.initial_state();
        let mut q: Configuration<f64, 3> =
            Configuration { joints: [0.1, 1.0, -2.0], ..Configuration::zero() };
        // How often a coordinate keeps its bits, and how hard the actuators push.
        let (stays, push) = ((1.3 * draw.next()).min(1.0), draw.next());
        for _ in 0..60 {
            let nu = Velocity::<f64, 3>::zero().map(|_| draw.within(0.01));
            let way =
                Velocity::<f64, 3>::zero().map(|_| if draw.next() < stays { 0.0 } else { draw.within(1e-4) });
            q.x += way.forward;
            q.heading += way.yaw_rate;
            for (joint, way) in q.joints.iter_mut().zip(way.joints) {
                *joint += way;
            }
            let near = Vector3::new(draw.within(0.01), draw.within(0.01), 0.5);
            let reference = Reference { position: near, velocity: near * 0.1, acceleration: near };
            let elapsed = PERIOD * if draw.next() < 0.1 { 3.0 } else { 0.9 + 0.2 * draw.next() };
            let (timing, input) = (Timing::exact(elapsed), Input { q, nu, reference });
            let mut slow = state;
            let settled = state.settled;
            let verdicts =
                (stack.judge(&mut state, timing, &input), stack.examine(&mut slow, timing, &input));
            let (Verdict::Run(one) | Verdict::Safe(one), Verdict::Run(other) | Verdict::Safe(other)) =
                verdicts;
            assert_eq!(one, other, "findings");
            let matters = stack.plausibility.is_doubtful(&state.doubt);
            if !matters && state.settled {
                slow.load = state.load;
            }
            assert_eq!(state, slow);
            quick += u32::from(settled && state.settled);
            doubtful += u32::from(settled && matters);
            frozen += u32::from(settled && !state.settled);
            let sines = stack.stack.robot().sines(&q);
            if stack.stack.control(&mut state.control, &input, &sines).is_ok() {
                state.machine.ran();
            }
            state.torque = Torque::<f64, 3>::zero().map(|_| push * (40.0 + draw.within(40.0)));
        }
    }
    // It led through all there is.
    assert!(
        quick > 3000 && doubtful > 300 && frozen > 10,
        "{quick} quick, {doubtful} doubtful, {frozen} frozen"
    );
    Ok(())
}
