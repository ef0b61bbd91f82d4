//! The four switching laws channel by channel.
//!
//! Laws: every law opposes s, s_i f_i <= 0, which is all that V' < 0 needs of it beyond its size; bsmc is -k sign(s) with
//! sign(0) = 0; bsmc-sat is its saturation of slope k/phi; bfsmc-thesis jumps at 0 by k plus 0.8889 k_f, the centroid
//! of its rule base there; bfsmc is odd, falling, continuous and 0 at 0.
//!
//! Reference: (4.30), (4.33), (4.41) and Appendix C of the thesis; by hand, the centroid of the triangle
//! (-4/3, -1, -2/3) cut to [-1, 1] is -1 + 1/9 = -0.8889.
//!
//! Tolerance: signs, zeros and oddness are exact; magnitudes to a few roundings; 1e-4 for 0.8889, the printed breakpoints
//! having four digits.

#![expect(clippy::unwrap_used, reason = "a helper that cannot build its law has failed the test")]

use crate::common::random::Random;
use mm_control::fuzzy::{Curve, FuzzyError, MamdaniTables, SMOOTH, THESIS};
use mm_control::laws::{FuzzyTerm, InnerLaw, Misprints};
use mm_control::{
    Bfsmc, ControlStack, Estimator, Gains, Input, Law, LawKind, OuterParams, Reference, SetupError,
    StackParams,
};
use mm_model::{Configuration, Force, Robot, RobotParams, Torque, Velocity};
use nalgebra::Vector3;

const PERIOD: f64 = 1e-3;

fn robot() -> Robot<f64, 3> {
    Robot::try_new(RobotParams::thesis()).unwrap()
}

fn law(kind: LawKind) -> (Law<f64, 3>, Gains<f64, 3>) {
    let gains = Gains::for_robot(&robot(), kind, PERIOD);
    (Law::try_new(kind, &robot(), &gains).unwrap(), gains)
}

fn pairs(a: &Velocity<f64, 3>, b: &Force<f64, 3>) -> Vec<(f64, f64)> {
    a.channels().zip(b.channels()).collect()
}

/// A number of either sign, spread evenly over the exponents from the smallest to the largest, zeros among them.
fn any(draw: &mut Random) -> f64 {
    let exponent = draw.between(-330.0, 308.0);
    let size = if exponent < -323.0 { 0.0 } else { power_of_ten(exponent) };
    if draw.between(0.0, 1.0) < 0.5 { -size } else { size }
}

/// 10^exponent, roughly: only the spread matters.
fn power_of_ten(exponent: f64) -> f64 {
    format!("1e{exponent:.0}").parse().unwrap()
}

#[test]
fn every_law_opposes_the_sliding_variable() {
    let mut draw = Random::seeded(1);
    for kind in LawKind::SWITCHING {
        let (law, _) = law(kind);
        for _ in 0..5000 {
            let s = Velocity::splat(0.0).map(|_: f64| any(&mut draw));
            let force = law.switching_force(&s).unwrap();
            for (s, f) in pairs(&s, &force.total) {
                assert!(f.is_finite(), "{}: s = {s:e} gives {f}", kind.name());
                // The signs, not the product: that would underflow.
                let against = (s > 0.0 && f <= 0.0) || (s < 0.0 && f >= 0.0);
                assert!(
                    against || s.abs() + f.abs() < f64::MIN_POSITIVE,
                    "{}: s = {s:e} gives {f:e}",
                    kind.name()
                );
            }
            for (s, f) in pairs(&s, &force.fuzzy) {
                assert!(
                    !(s > 0.0 && f > 0.0 || s < 0.0 && f < 0.0),
                    "{}: fuzzy part {f:e} at {s:e}",
                    kind.name()
                );
            }
        }
        for zero in [0.0, -0.0] {
            let force = law.switching_force(&Velocity::splat(zero)).unwrap();
            assert!(force.total.channels().all(|f| f.abs() <= 0.0), "{}: {force:?} at {zero}", kind.name());
        }
    }
}

#[test]
fn the_force_far_out_is_at_least_the_authority() {
    for kind in LawKind::SWITCHING {
        let (law, gains) = law(kind);
        let expected = if kind == LawKind::Bfsmc { gains.fuzzy } else { gains.switching };
        for (a, k) in law.authority().unwrap().channels().zip(expected.channels()) {
            assert!((a - k).abs() <= 1e-14 * k, "{}: authority {a} instead of {k}", kind.name());
        }
        for s in [50.0, -50.0, 1e300] {
            let force = law.switching_force(&Velocity::splat(s)).unwrap().total;
            for (f, k) in force.channels().zip(law.authority().unwrap().channels()) {
                assert!(
                    f.abs() >= k * (1.0 - 1e-14),
                    "{}: {f} at {s} is below the authority {k}",
                    kind.name()
                );
            }
        }
    }
}

#[test]
fn bsmc_is_sign() {
    let (law, gains) = law(LawKind::Bsmc);
    for s in [5e-324, 1e-9, 1.0, 1e308] {
        for side in [1.0, -1.0] {
            for (f, k) in law
                .switching_force(&Velocity::splat(side * s))
                .unwrap()
                .total
                .channels()
                .zip(gains.switching.channels())
            {
                assert_eq!(f.to_bits(), (-side * k).to_bits(), "the force at {s:e} is not -k sign(s)");
            }
        }
    }
}

#[test]
fn bsmc_sat_is_a_line_between_two_plateaus() {
    let (law, gains) = law(LawKind::BsmcSat);
    let slope_of = |at: f64, step: f64| {
        let force = |x: f64| law.switching_force(&gains.boundary_layer.scaled(x)).unwrap().total;
        force(at + step).minus(force(at - step)).scaled(0.5 / step)
    };
    let channels = || gains.switching.channels();
    for at in [0.0, 0.4, -0.9] {
        for (slope, k) in slope_of(at, 0.05).channels().zip(channels()) {
            assert!((slope + k).abs() < 1e-12 * k, "inside the layer the slope is {slope}, not -k = {k}");
        }
    }
    for at in [-1.5, 1.5, 30.0] {
        assert!(slope_of(at, 0.1).channels().all(|slope| slope.abs() <= 0.0), "no plateau at {at}");
    }
    for edge in [-1.0, 1.0] {
        let force = |x: f64| law.switching_force(&gains.boundary_layer.scaled(x)).unwrap().total;
        let jump = force(edge * (1.0 + 1e-12)).minus(force(edge * (1.0 - 1e-12)));
        for (jump, k) in jump.channels().zip(channels()) {
            assert!(jump.abs() < 1e-11 * k, "a jump of {jump} at the edge of the layer");
        }
    }
}

#[test]
fn the_fuzzy_term_of_the_thesis_is_a_second_relay() {
    let (law, gains) = law(LawKind::BfsmcThesis);
    for side in [1.0, -1.0] {
        for s in [1e-300, 1e-12, 1e-6] {
            let force = law.switching_force(&Velocity::splat(side * s)).unwrap();
            for ((f, fuzzy), (k, kf)) in force
                .total
                .channels()
                .zip(force.fuzzy.channels())
                .zip(gains.switching.channels().zip(gains.fuzzy.channels()))
            {
                assert!((f + side * (k + 0.8889 * kf)).abs() < 1e-4 * kf, "{f} at {s:e}");
                assert!((fuzzy + side * 0.8889 * kf).abs() < 1e-4 * kf, "fuzzy part {fuzzy} at {s:e}");
            }
        }
    }
    // Far away it is weaker, a third, where a relay is what it always is.
    let far = law.switching_force(&Velocity::splat(100.0)).unwrap().fuzzy;
    for (fuzzy, kf) in far.channels().zip(gains.fuzzy.channels()) {
        assert!((fuzzy + kf / 3.0).abs() < 1e-3 * kf, "{fuzzy} far away");
    }
}

#[test]
fn bfsmc_is_odd_falling_and_continuous() {
    let (law, gains) = law(LawKind::Bfsmc);
    let force = |x: f64| law.switching_force(&gains.fuzzy_scale.scaled(x)).unwrap().total;
    let steps = 3000;
    let step = 1.2 / f64::from(steps);
    let mut last = Force::zero();
    for i in 1..=steps {
        let x = f64::from(i) * step;
        let (now, mirrored) = (force(x), force(-x));
        for (((f, m), before), k) in
            now.channels().zip(mirrored.channels()).zip(last.channels()).zip(gains.fuzzy.channels())
        {
            assert_eq!(f.to_bits(), (-m).to_bits(), "not odd at {x}");
            if x < 1.0 {
                assert!(f < before, "not falling at {x}: {before} to {f}");
            } else {
                assert!((f + k).abs() <= 1e-14 * k, "{f} at {x}, not the edge value {k}");
            }
            assert!((f - before).abs() <= 2.0 * k * step, "a jump from {before} to {f} at {x}");
        }
        last = now;
    }
}

fn table(tables: &MamdaniTables<'_, f64>) -> FuzzyTerm<f64> {
    FuzzyTerm::table(&Curve::<f64>::try_new(tables).unwrap()).unwrap()
}

fn output(term: Option<FuzzyTerm<f64>>, gains: Gains<f64, 3>) -> [f64; 5] {
    let robot = robot();
    let params =
        StackParams { period: PERIOD, outer: OuterParams::default(), gains, estimator: Estimator::None };
    let stack = match term {
        None => ControlStack::try_new(robot, LawKind::Bfsmc, params).unwrap(),
        Some(term) => ControlStack::with_fuzzy(robot, LawKind::Bfsmc, term, params).unwrap(),
    };
    let q = Configuration { joints: [0.1, 0.9, -1.8], ..Configuration::zero() };
    let position = robot.tip_position(&q) + Vector3::repeat(1e-3);
    let reference = Reference { position, velocity: Vector3::zeros(), acceleration: Vector3::zeros() };
    let input = Input { q, nu: Velocity::zero(), reference };
    let torque = stack.update(&mut stack.initial_state(), &input).unwrap().torque;
    [torque.right, torque.left, torque.joints[0], torque.joints[1], torque.joints[2]]
}

#[test]
fn other_rules_give_another_torque() {
    let (_, gains) = law(LawKind::Bfsmc);
    let smooth = output(Some(table(&SMOOTH)), gains);
    let bits = |torque: [f64; 5]| torque.map(f64::to_bits);
    assert_eq!(bits(output(None, gains)), bits(smooth), "the default rules are SMOOTH");

    // The two rules next to zero answer as strongly as their outer neighbours.
    let mut rules = SMOOTH.rules.to_vec();
    (rules[2].outputs, rules[4].outputs) = (&[6], &[2]);
    let tables = MamdaniTables { rules: &rules, ..SMOOTH };
    let (a, b) = (smooth, output(Some(table(&tables)), gains));
    for (channel, (a, b)) in a.iter().zip(b).enumerate() {
        assert!((a - b).abs() > 1e-3, "torque {channel} stays {a} under other rules");
    }
    let thesis = Law::Bfsmc(Bfsmc::with_term(&gains, table(&THESIS)).unwrap());
    let third = gains.fuzzy.scaled(1.0 / 3.0);
    for (a, k) in thesis.authority().unwrap().channels().zip(third.channels()) {
        assert!((a - k).abs() < 1e-3 * k, "authority {a} at the weak edge of Appendix C, not {k}");
    }
}

#[test]
fn rules_that_aid_the_motion_are_refused() {
    let (_, gains) = law(LawKind::Bfsmc);
    let mut turned = SMOOTH.rules.to_vec();
    for rule in &mut turned {
        rule.outputs = rule.inputs;
    }
    let mut lopsided = SMOOTH.rules.to_vec();
    lopsided[3].outputs = &[5];
    for (rules, what) in [(turned, "the wrong sign"), (lopsided, "an answer at zero")] {
        let tables = MamdaniTables { rules: &rules, ..SMOOTH };
        let refused = Bfsmc::with_term(&gains, table(&tables)).err();
        let expected = SetupError::Fuzzy(FuzzyError::OutOfRange("rules"));
        assert_eq!(refused, Some(expected), "rules with {what} are taken");
    }
}

#[test]
fn names_go_there_and_back() {
    for kind in LawKind::ALL {
        assert_eq!(LawKind::from_name(kind.name()), Some(kind), "{} is not found", kind.name());
        assert_eq!(law(kind).0.kind(), kind, "a law of another kind");
    }
    for name in ["", "BSMC", "bsmc ", "pd"] {
        assert_eq!(LawKind::from_name(name), None, "{name:?} is no law");
    }
}

#[test]
fn default_slopes_are_those_of_one_bandwidth() {
    // The table of Gains::for_robot: the loops of bsmc-sat and bfsmc have the same slope at s = 0, 100/s x inertia.
    let slope = |kind: LawKind| {
        let tiny = 1e-6;
        let force = law(kind).0.switching_force(&Velocity::splat(tiny)).unwrap().total;
        force.scaled(-1.0 / tiny)
    };
    let (sat, fuzzy) = (slope(LawKind::BsmcSat), slope(LawKind::Bfsmc));
    let inertia = mm_control::laws::EffectiveInertia::of(&robot()).0;
    for ((a, b), m) in sat.channels().zip(fuzzy.channels()).zip(inertia.channels()) {
        assert!((a / (100.0 * m) - 1.0).abs() < 1e-9, "bsmc-sat: {}/s", a / m);
        assert!((b / (100.0 * m) - 1.0).abs() < 1e-3, "bfsmc: {}/s", b / m);
    }
}

#[test]
fn misprints_turn_the_force_and_send_it_to_the_wheels() {
    let gains = Gains::for_robot(&robot(), LawKind::BfsmcThesis, PERIOD);
    let with = |sign, channels| {
        let gains = Gains { misprints: Misprints { sign, channels }, ..gains };
        Law::try_new(LawKind::BfsmcThesis, &robot(), &gains).unwrap()
    };
    let s = Velocity { forward: 0.2, yaw_rate: -0.3, joints: [0.1, -0.1, 0.4] };
    let right = with(false, false).switching_force(&s).unwrap().total;
    let turned = with(true, false).switching_force(&s).unwrap().total;
    assert_eq!(turned, right.map(|f| -f), "every channel aids its s");
    // What should be forces along forward and yaw are taken for torques of the right and the left wheel.
    let torque = Torque { right: right.forward, left: right.yaw, joints: right.joints };
    let diverted = with(false, true).switching_force(&s).unwrap().total;
    for (got, expected) in diverted.channels().zip(robot().force_of(&torque).channels()) {
        assert!((got - expected).abs() <= 1e-12 * expected.abs(), "{got} instead of {expected}");
    }
    assert!(with(false, false).authority().is_some(), "the mended law has a switching gain");
    assert!(
        with(true, false).authority().is_none() && with(false, true).authority().is_none(),
        "no reaching"
    );
}
