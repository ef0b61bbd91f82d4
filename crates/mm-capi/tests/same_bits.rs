//! Law: for the same bits in, the functions of C give the same bits out as the stack of `mm-control`, for every law, both estimators and
//! the supervisor, in both precisions; the defaults of parameters are those of the stack.
//!
//! Reference: the stack, called from Rust with its own types. Exact: bits are compared. Misuse is tested from C, in `c/misuse.c`.

#[path = "../../mm-control/tests/control/common/random.rs"]
mod random;

use core::mem::MaybeUninit;
use core::ptr::null_mut;

use mm_capi::kinds::EstimatorKind;
use mm_capi::status::Status;
use mm_control::{
    ControlStack, Estimator, Gains, LawKind, OuterParams, StackParams, SupervisedStack, SupervisorParams,
};
use mm_model::{Configuration, Robot, RobotParams, Velocity};
use nalgebra::Vector3;
use random::Random;

/// Updates of each run.
const TICKS: u32 = 40;

/// The number of a law in C: they are in the order of `LawKind::ALL`, from 1.
fn laws() -> impl Iterator<Item = (i32, LawKind)> {
    (1..).zip(LawKind::ALL)
}

/// The runs of one precision: its scalar, its module, its storage, and its functions.
macro_rules! runs {
    ($name:ident, $scalar:ident, $storage:ident, [$thesis:ident, $defaults:ident, $init:ident, $update:ident, $measured:ident, $step:ident, $missed:ident]) => {
        mod $name {
            use super::*;
            use mm_capi::params::Params;
            use mm_capi::storage::$storage as Storage;
            use mm_capi::values::{self, Command, Input, Measurement, Output, Reference, Signals, Timing};
            use mm_capi::$name as c;

            /// The parameters of the thesis's robot and a law.
            fn params(law: i32) -> Params<$scalar> {
                let mut params = MaybeUninit::uninit();
                // SAFETY: the pointer is valid for writing.
                let status = unsafe { c::$thesis(params.as_mut_ptr()) };
                assert_eq!(status, Status::Ok, "the robot of the thesis");
                // SAFETY: the call has filled all fields.
                let mut params: Params<$scalar> = unsafe { params.assume_init() };
                params.law = law;
                // SAFETY: the pointer is valid for reading and writing.
                let status = unsafe { c::$defaults(&mut params, null_mut()) };
                assert_eq!(status, Status::Ok, "defaults");
                params
            }

            fn storage(params: &Params<$scalar>) -> Storage {
                let mut storage = Storage::empty();
                let (size, version) = (size_of::<Storage>(), mm_capi::MM_ABI_VERSION);
                // SAFETY: the pointers are valid.
                let status = unsafe { c::$init(&mut storage, size, version, params, null_mut()) };
                assert_eq!(status, Status::Ok, "initialization of law {}", params.law);
                storage
            }

            fn stack(kind: LawKind, estimator: Estimator<$scalar>) -> ControlStack<$scalar, 3> {
                let robot = Robot::try_new(RobotParams::thesis()).expect("the robot of the thesis");
                let period: $scalar = 1.0 / 1000.0;
                let gains = Gains::for_robot(&robot, kind, period);
                let outer = OuterParams::for_robot(&robot);
                ControlStack::try_new(robot, kind, StackParams { period, outer, gains, estimator })
                    .expect("defaults")
            }

            fn input(random: &mut Random) -> Input<$scalar> {
                let mut next = |size: f64| <$scalar as mm_model::Real>::from_f64(random.between(-size, size));
                let joints_rad = [next(1.0), 1.0 + next(0.5), -2.0 + next(0.5)];
                Input {
                    configuration: values::Configuration {
                        x_m: next(0.2),
                        y_m: next(0.2),
                        heading_rad: next(3.0),
                        joints_rad,
                    },
                    velocity: values::Velocity {
                        forward_m_s: next(0.5),
                        yaw_rate_rad_s: next(0.5),
                        joints_rad_s: [next(0.5), next(0.5), next(0.5)],
                    },
                    reference: Reference {
                        position_m: [0.5 + next(0.2), next(0.2), 0.5 + next(0.2)],
                        velocity_m_s: [next(0.2), next(0.2), next(0.2)],
                        acceleration_m_s2: [next(0.2), next(0.2), next(0.2)],
                    },
                }
            }

            fn known(input: &Input<$scalar>) -> mm_control::Input<$scalar, 3> {
                let Input { configuration: q, velocity: nu, reference: r } = *input;
                mm_control::Input {
                    q: Configuration { x: q.x_m, y: q.y_m, heading: q.heading_rad, joints: q.joints_rad },
                    nu: Velocity {
                        forward: nu.forward_m_s,
                        yaw_rate: nu.yaw_rate_rad_s,
                        joints: nu.joints_rad_s,
                    },
                    reference: mm_control::Reference {
                        position: Vector3::from(r.position_m),
                        velocity: Vector3::from(r.velocity_m_s),
                        acceleration: Vector3::from(r.acceleration_m_s2),
                    },
                }
            }

            fn bits(numbers: impl IntoIterator<Item = $scalar>) -> Vec<u64> {
                numbers.into_iter().map(|number| number.to_bits().into()).collect()
            }

            fn torque_bits(torque: &values::Torque<$scalar>) -> Vec<u64> {
                bits([torque.right_n_m, torque.left_n_m].into_iter().chain(torque.joints_n_m))
            }

            fn expected_bits(torque: &mm_model::Torque<$scalar, 3>) -> Vec<u64> {
                bits([torque.right, torque.left].into_iter().chain(torque.joints))
            }

            #[test]
            fn every_law_gives_the_bits_of_the_stack() {
                for (law, kind) in laws() {
                    let (mut storage, stack) = (storage(&params(law)), stack(kind, Estimator::None));
                    let (mut state, mut random) = (stack.initial_state(), Random::seeded(11));
                    for tick in 0..TICKS {
                        let input = input(&mut random);
                        let expected = stack.update(&mut state, &known(&input)).expect("finite");
                        let (mut output, mut signals) = (MaybeUninit::uninit(), MaybeUninit::uninit());
                        // SAFETY: the pointers are valid.
                        let status = unsafe {
                            c::$update(&mut storage, &input, output.as_mut_ptr(), signals.as_mut_ptr())
                        };
                        assert_eq!(status, Status::Ok, "{kind:?}, tick {tick}");
                        // SAFETY: the call has filled it.
                        let output: Output<$scalar> = unsafe { output.assume_init() };
                        // SAFETY: and this.
                        let signals: Signals<$scalar> = unsafe { signals.assume_init() };
                        assert_eq!(
                            torque_bits(&output.torque),
                            expected_bits(&expected.torque),
                            "{kind:?}, tick {tick}"
                        );
                        let flags = expected.status;
                        assert_eq!(
                            output.flags & 1 != 0,
                            flags.saturated,
                            "{kind:?}, tick {tick}: saturated"
                        );
                        assert_eq!(
                            output.flags & 16 != 0,
                            flags.beyond_joint_limit,
                            "{kind:?}, tick {tick}: joint limit"
                        );
                        let sliding = expected.signals.sliding;
                        let learned = expected.signals.learned;
                        assert_eq!(
                            bits([
                                signals.sliding.forward_m_s,
                                signals.learned.yaw_n_m,
                                signals.manipulability_squared
                            ]),
                            bits([sliding.forward, learned.yaw, expected.signals.manipulability_squared]),
                            "{kind:?}, tick {tick}: signals"
                        );
                    }
                }
            }

            #[test]
            fn measured_positions_give_the_bits_of_the_stack() {
                let cutoff_hz = 60.0;
                let kinds = [
                    (EstimatorKind::FilteredDifference, Estimator::FilteredDifference { cutoff_hz }),
                    (EstimatorKind::Observer, Estimator::Observer { cutoff_hz }),
                ];
                for (kind, estimator) in kinds {
                    let mut params = params(4);
                    (params.estimator.kind, params.estimator.cutoff_hz) = (kind as i32, cutoff_hz);
                    let (mut storage, stack) = (storage(&params), stack(LawKind::Bfsmc, estimator));
                    let (mut state, mut random) = (stack.initial_state(), Random::seeded(12));
                    for tick in 0..TICKS {
                        let input = input(&mut random);
                        let wheels = [input.velocity.forward_m_s, input.velocity.yaw_rate_rad_s];
                        let measurement = Measurement {
                            configuration: input.configuration,
                            right_wheel_rad: wheels[0],
                            left_wheel_rad: wheels[1],
                            reference: input.reference,
                            has_wheels: tick % 2,
                        };
                        let angles = mm_control::WheelAngles { right: wheels[0], left: wheels[1] };
                        let read = mm_control::Measurement {
                            q: known(&input).q,
                            wheels: (tick % 2 == 1).then_some(angles),
                        };
                        let expected = stack
                            .update_measured(&mut state, &read, &known(&input).reference)
                            .expect("finite");
                        let mut output = MaybeUninit::<Output<$scalar>>::uninit();
                        // SAFETY: the pointers are valid.
                        let status = unsafe {
                            c::$measured(&mut storage, &measurement, output.as_mut_ptr(), null_mut())
                        };
                        assert_eq!(status, Status::Ok, "{kind:?}, tick {tick}");
                        // SAFETY: the call has filled it.
                        let output = unsafe { output.assume_init() };
                        assert_eq!(
                            torque_bits(&output.torque),
                            expected_bits(&expected.torque),
                            "{kind:?}, tick {tick}"
                        );
                    }
                }
            }

            #[test]
            fn the_supervisor_gives_the_bits_of_the_stack() {
                let mut params = params(4);
                params.supervised = 1;
                let (mut storage, stack) = (storage(&params), stack(LawKind::Bfsmc, Estimator::None));
                let limits = SupervisorParams::for_robot(stack.robot(), params.period_s);
                let stack = SupervisedStack::try_new(stack, limits).expect("defaults");
                let (mut state, mut random) = (stack.initial_state(), Random::seeded(13));
                let mut input = input(&mut random);
                for tick in 0..TICKS {
                    let late = if tick == 20 { 1.0 } else { params.period_s };
                    let timing = Timing { elapsed_s: late, age_s: 0.0 };
                    input.configuration.x_m = if tick == 9 { <$scalar>::NAN } else { 0.0 };
                    let mut command = MaybeUninit::<Command<$scalar>>::uninit();
                    let (status, expected) = if tick == 30 {
                        // SAFETY: the pointers are valid.
                        let status = unsafe { c::$missed(&mut storage, &timing, command.as_mut_ptr()) };
                        (status, stack.missed(&mut state, late))
                    } else {
                        // SAFETY: the pointers are valid.
                        let status = unsafe {
                            c::$step(&mut storage, &timing, &input, command.as_mut_ptr(), null_mut())
                        };
                        let timing = mm_control::Timing { elapsed: late, age: 0.0 };
                        (status, stack.update(&mut state, timing, &known(&input)))
                    };
                    assert_eq!(status, Status::Ok, "tick {tick}");
                    // SAFETY: the call has filled it.
                    let command = unsafe { command.assume_init() };
                    assert_eq!(torque_bits(&command.torque), expected_bits(&expected.torque), "tick {tick}");
                    let all = (command.findings, command.brake == 1, command.ran == 1);
                    let known = (expected.findings.bits().into(), expected.brake, expected.output.is_some());
                    assert_eq!(all, known, "tick {tick}: findings, brake, whether the law ran");
                    assert_eq!(
                        command.mode,
                        mm_capi::kinds::Mode::from(expected.mode) as i32,
                        "tick {tick}: mode"
                    );
                }
            }
        }
    };
}

runs!(
    double,
    f64,
    DoubleController,
    [
        mm_params_thesis,
        mm_params_defaults,
        mm_controller_init,
        mm_controller_update,
        mm_controller_update_measured,
        mm_controller_step,
        mm_controller_missed
    ]
);
runs!(
    single,
    f32,
    SingleController,
    [
        mmf_params_thesis,
        mmf_params_defaults,
        mmf_controller_init,
        mmf_controller_update,
        mmf_controller_update_measured,
        mmf_controller_step,
        mmf_controller_missed
    ]
);
