//! Estimators, a base without an arm, and parameters.

use super::*;

#[test]
fn measured_positions_are_checked_the_same_way() {
    let estimator = Estimator::FilteredDifference { cutoff_hz: 60.0 };
    let stack = SupervisedStack::try_new(plain(estimator), params()).unwrap();
    let alone = plain(estimator);
    let (mut state, mut twin) = (stack.initial_state(), alone.initial_state());
    let measured = |k: u32| {
        let Input { q, reference, .. } = input(k);
        let rates = robot().wheel_rates(0.2, 0.1);
        let t = f64::from(k) * PERIOD;
        let wheels = WheelAngles { right: rates.right * t, left: rates.left * t };
        (Measurement { q, wheels: Some(wheels) }, reference)
    };
    for k in 0..100 {
        let (measurement, reference) = measured(k);
        let wanted = alone.update_measured(&mut twin, &measurement, &reference).unwrap();
        let command = stack.update_measured(&mut state, exact(), &measurement, &reference);
        assert_eq!((command.output, command.findings), (Some(wanted), Findings::NONE), "update {k}");
    }
    let ready = state;
    type SpoilMeasured = fn(&mut Measurement<f64, 3>);
    let cases: [(Findings, SpoilMeasured); 4] = [
        (Findings::STATE_NOT_FINITE, |m| m.q.x = f64::NAN),
        (Findings::STATE_NOT_FINITE, |m| m.wheels = Some(WheelAngles { right: f64::NAN, left: 0.0 })),
        (Findings::STATE_RATE, |m| m.q.joints[0] += 0.2),
        // A wheel that jumps by most of a turn is seen in the estimated speed alone.
        (Findings::STATE_RANGE.and(Findings::REFUSED), |m| {
            m.wheels = m.wheels.map(|w| WheelAngles { right: w.right + 3.0, left: w.left + 3.0 });
        }),
    ];
    for (wanted, spoil) in cases {
        let mut state = ready;
        let mut modes = Vec::new();
        for k in 100..104 {
            let (mut measurement, reference) = measured(k);
            spoil(&mut measurement);
            let command = stack.update_measured(&mut state, exact(), &measurement, &reference);
            assert!(command.findings.contains(wanted) || k > 100, "found {:?}", command.findings);
            assert!(within_limits(&command.torque), "update {k}");
            modes.push(command.mode);
        }
        assert_eq!(modes[..2], [Mode::Hold, Mode::Hold], "{wanted:?}");
    }
    // A stop goes on estimating, and a good reference ends it.
    let mut state = ready;
    for k in 100..150 {
        let (measurement, mut reference) = measured(k);
        reference.position.x = f64::NAN;
        let command = stack.update_measured(&mut state, exact(), &measurement, &reference);
        assert_eq!(command.findings, Findings::REFERENCE, "update {k}");
    }
    let run: Vec<_> = (150..160)
        .map(|k| {
            let (measurement, reference) = measured(k);
            stack.update_measured(&mut state, exact(), &measurement, &reference)
        })
        .collect();
    assert_eq!(run.iter().position(|command| command.mode == Mode::Run), Some(9), "ten good ones");
    let nu = run.last().and_then(|command| command.output).unwrap().signals.nu;
    assert!((nu.forward - 0.2).abs() < 1e-3, "the estimate did not begin anew: {}", nu.forward);
}

#[test]
fn the_base_alone_is_supervised_too() {
    let thesis = RobotParams::<f64, 3>::thesis();
    let robot = Robot::try_new(RobotParams {
        base_mass: thesis.base_mass,
        base_yaw_inertia: thesis.base_yaw_inertia,
        base_com_offset: 0.0,
        arm_offset: 0.2,
        mount_height: 0.0,
        wheel_radius: thesis.wheel_radius,
        track_width: thesis.track_width,
        gravity: thesis.gravity,
        links: [],
        rest_posture: [],
        friction: mm_model::Friction::none(),
        limits: mm_model::Limits { joints: [], wheel_torque: 60.0, joint_torque: [], speed: 2.0 },
    })
    .unwrap();
    let gains = Gains::for_robot(&robot, LawKind::Bfsmc, PERIOD);
    let outer =
        OuterParams { position_gain: Vector3::new(18.0, 18.0, 18.0), ..OuterParams::for_robot(&robot) };
    let params = StackParams { period: PERIOD, outer, gains, estimator: Estimator::None };
    let stack = ControlStack::try_new(robot, LawKind::Bfsmc, params).unwrap();
    let stack = SupervisedStack::try_new(stack, SupervisorParams::for_robot(&robot, PERIOD)).unwrap();
    let mut state = stack.initial_state();
    let q = Configuration { x: 0.0, y: 0.0, heading: 0.0, joints: [] };
    let reference = Reference {
        position: Vector3::new(0.2, 0.0, 0.0),
        velocity: Vector3::zeros(),
        acceleration: Vector3::zeros(),
    };
    let nu = Velocity { forward: 0.5, yaw_rate: 0.0, joints: [] };
    assert_eq!(stack.update(&mut state, exact(), &Input { q, nu, reference }).mode, Mode::Run, "runs");
    for _ in 0..3 {
        stack.missed(&mut state, PERIOD);
    }
    let command = stack.missed(&mut state, PERIOD);
    assert_eq!(command.mode, Mode::Stop, "stops");
    assert!(command.torque.right < 0.0 && command.torque.left < 0.0, "against the motion");
}

type SpoilParams = fn(&mut SupervisorParams<f64, 3>);

#[test]
fn parameters_are_refused_by_name() {
    use ParamError::{Negative, NonFinite, NonPositive, OutOfRange};
    let cases: [(ParamError, SpoilParams); 18] = [
        (NonPositive("position_m"), |p| p.position = 0.0),
        (NonFinite("position_m"), |p| p.position = f64::NAN),
        (Negative("joint_margin_rad"), |p| p.joint_margin = -0.1),
        (NonPositive("speed"), |p| p.speed.forward = 0.0),
        (NonFinite("speed"), |p| p.speed.joints[2] = f64::INFINITY),
        (NonPositive("acceleration"), |p| p.acceleration.yaw_rate = -1.0),
        (NonFinite("acceleration"), |p| p.acceleration.joints[0] = f64::NAN),
        (NonPositive("position_noise"), |p| p.position_noise = 0.0),
        (NonPositive("velocity_noise"), |p| p.velocity_noise = -1.0),
        (NonPositive("reference_step_m"), |p| p.reference_step = 0.0),
        (NonPositive("reference_acceleration_m_s2"), |p| p.reference_acceleration = 0.0),
        (Negative("age_s"), |p| p.age = -1e-3),
        (NonFinite("age_s"), |p| p.age = f64::NAN),
        (OutOfRange("hold_periods"), |p| p.hold_periods = 101),
        (NonPositive("recovery_periods"), |p| p.recovery_periods = 0),
        (OutOfRange("blind_periods"), |p| p.blind_periods = p.hold_periods),
        (NonPositive("stop_periods"), |p| p.stop_periods = 0),
        (NonPositive("braking_rate_1_s"), |p| p.braking_rate = 0.0),
    ];
    for (wanted, spoil) in cases {
        let mut spoilt = params();
        spoil(&mut spoilt);
        let error = SupervisedStack::try_new(plain(Estimator::None), spoilt).err();
        assert_eq!(error, Some(SetupError::Param(wanted)), "{wanted}");
    }
}

#[test]
fn a_recovery_may_be_forbidden() {
    let limits = SupervisorParams { recovery_periods: u32::MAX, ..params() };
    let stack = SupervisedStack::try_new(plain(Estimator::None), limits).unwrap();
    let (mut state, k) = running(&stack);
    let bad: Spoil = |i, _| i.reference.velocity.z = f64::NAN;
    modes(&stack, &mut state, k, 3, bad);
    assert_eq!(modes(&stack, &mut state, k + 3, 100, |_, _| {}), [Mode::Stop; 100], "only a reset helps");
}
