//! What parameters are refused, in which words, and what the preset is.
//!
//! Law: a robot that was built has only numbers that a robot can have, so that nothing is checked later; an error names the
//! field, with its unit. References: the documentation of each field; for the preset, eigenvalues of M over a grid of
//! postures. Tolerance: three digits for the eigenvalues, which is how they are quoted; scaling is exact to rounding.

use crate::common::mass;
use mm_model::{Configuration, Link, Mechanism, ParamError, Robot, RobotParams, Velocity};

type Params = RobotParams<f64, 3>;

/// A field: its name in errors, and how to put a value there.
struct Field {
    name: &'static str,
    put: fn(&mut Params, f64),
}

/// Numbers that must be above zero.
const POSITIVE: [Field; 12] = [
    Field { name: "base_mass_kg", put: |p, x| p.base_mass = x },
    Field { name: "base_yaw_inertia_kg_m2", put: |p, x| p.base_yaw_inertia = x },
    Field { name: "wheel_radius_m", put: |p, x| p.wheel_radius = x },
    Field { name: "track_width_m", put: |p, x| p.track_width = x },
    Field { name: "length_m", put: |p, x| p.links[0].length = x },
    Field { name: "length_m", put: |p, x| p.links[2].length = x },
    Field { name: "mass_kg", put: |p, x| p.links[1].mass = x },
    Field { name: "mass_kg", put: |p, x| p.links[2].mass = x },
    Field { name: "smoothing_rad_s", put: |p, x| p.friction.smoothing = x },
    Field { name: "wheel_torque_limit_n_m", put: |p, x| p.limits.wheel_torque = x },
    Field { name: "torque_limit_n_m", put: |p, x| p.limits.joint_torque[2] = x },
    Field { name: "speed_limit_m_s", put: |p, x| p.limits.speed = x },
];

/// Numbers that may be zero but not below.
const NON_NEGATIVE: [Field; 10] = [
    Field { name: "gravity_m_s2", put: |p, x| p.gravity = x },
    Field { name: "com_m", put: |p, x| p.links[0].com = x },
    Field { name: "com_m", put: |p, x| p.links[2].com = x },
    Field { name: "inertia_kg_m2", put: |p, x| p.links[0].axial_inertia = x },
    Field { name: "inertia_kg_m2", put: |p, x| p.links[1].pitch_inertia = x },
    Field { name: "inertia_kg_m2", put: |p, x| p.links[2].normal_inertia = x },
    Field { name: "wheel_viscous_n_m_s", put: |p, x| p.friction.wheel_viscous = x },
    Field { name: "wheel_coulomb_n_m", put: |p, x| p.friction.wheel_coulomb = x },
    Field { name: "joint_viscous_n_m_s", put: |p, x| p.friction.joint_viscous[1] = x },
    Field { name: "joint_coulomb_n_m", put: |p, x| p.friction.joint_coulomb[2] = x },
];

/// Numbers of either sign.
const FINITE: [Field; 6] = [
    Field { name: "base_com_offset_m", put: |p, x| p.base_com_offset = x },
    Field { name: "arm_offset_m", put: |p, x| p.arm_offset = x },
    Field { name: "mount_height_m", put: |p, x| p.mount_height = x },
    Field { name: "rest_posture_rad", put: |p, x| p.rest_posture[1] = x },
    Field { name: "joint_limit_rad", put: |p, x| p.limits.joints[0].0 = x },
    Field { name: "joint_limit_rad", put: |p, x| p.limits.joints[2].1 = x },
];

/// What becomes of the preset with one number replaced.
fn outcome(field: &Field, value: f64) -> Result<(), ParamError> {
    let mut params = Params::thesis();
    (field.put)(&mut params, value);
    let built = Robot::try_new(params).map(|robot| assert_eq!(robot.params(), &params, "{}", field.name));
    assert_eq!(built, params.check(), "{}: check and try_new disagree", field.name);
    built
}

#[test]
fn every_number_must_be_finite() {
    for field in POSITIVE.iter().chain(&NON_NEGATIVE).chain(&FINITE) {
        for value in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
            assert_eq!(outcome(field, value), Err(ParamError::NonFinite(field.name)), "{value}");
        }
    }
}

#[test]
fn signs_are_checked() {
    for field in &POSITIVE {
        for value in [0.0, -0.0, -1e-300, -3.0] {
            assert_eq!(outcome(field, value), Err(ParamError::NonPositive(field.name)), "{value}");
        }
        assert_eq!(outcome(field, 0.25), Ok(()), "{}", field.name);
    }
    for field in &NON_NEGATIVE {
        for value in [-1e-300, -3.0] {
            assert_eq!(outcome(field, value), Err(ParamError::Negative(field.name)), "{value}");
        }
        for value in [0.0, 0.25] {
            assert_eq!(outcome(field, value), Ok(()), "{}", field.name);
        }
    }
    for field in &FINITE {
        for value in [-0.25, 0.0, 0.25] {
            assert_eq!(outcome(field, value), Ok(()), "{}", field.name);
        }
    }
}

#[test]
fn joint_limits_must_not_be_inverted() {
    for joint in 0..3 {
        for limits in [(0.5, -0.5), (0.5, 0.5)] {
            let mut params = Params::thesis();
            params.limits.joints[joint] = limits;
            assert_eq!(params.check(), Err(ParamError::Inverted("joint_limit_rad")), "joint {joint}");
        }
    }
}

#[test]
fn every_joint_must_move_some_inertia() {
    let weightless = |p: &mut Params, change: fn(&mut Link<f64>)| p.links.iter_mut().for_each(change);
    let mut yaw = Params::thesis();
    weightless(&mut yaw, |link| link.axial_inertia = 0.0);
    assert_eq!(yaw.check(), Err(ParamError::NotPositiveDefinite("inertia_kg_m2")));
    // Straight up, only axial inertia opposes the yaw joint: M would be singular there.
    yaw.links[0].axial_inertia = 1e-6;
    let robot = Robot::try_new(yaw).expect("link 1 alone makes the difference");
    let upright = Configuration { joints: [0.3, core::f64::consts::FRAC_PI_2, 0.0], ..Configuration::zero() };
    assert!(robot.mass_matrix_at(&upright).factor().is_some());

    for link in [1, 2] {
        let mut pitch = Params::thesis();
        (pitch.links[link].pitch_inertia, pitch.links[link].com) = (0.0, 0.0);
        assert_eq!(pitch.check(), Err(ParamError::NotPositiveDefinite("inertia_kg_m2")), "link {link}");
        pitch.links[link].com = 0.01;
        assert_eq!(pitch.check(), Ok(()), "link {link}");
    }
}

#[test]
fn errors_say_what_is_expected_of_which_parameter() {
    let texts = [
        (ParamError::NonFinite("a_m"), "a_m must be a finite number"),
        (ParamError::NonPositive("b_kg"), "b_kg must be above zero"),
        (ParamError::Negative("c_s"), "c_s must be zero or above"),
        (ParamError::OutOfRange("d_hz"), "d_hz must lie in its documented range"),
        (ParamError::Inverted("e_rad"), "e_rad must have its lower bound below its upper bound"),
        (
            ParamError::NotPositiveDefinite("f_kg_m2"),
            "f_kg_m2 must be above zero for the mass matrix to be positive definite",
        ),
    ];
    for (error, text) in texts {
        assert_eq!(error.to_string(), text);
        assert_eq!(text.split(' ').next(), Some(error.parameter()));
        assert!(text.ends_with(error.expectation()), "{text}");
        let as_error: &dyn core::error::Error = &error;
        assert!(as_error.source().is_none(), "{text}");
    }
}

fn smallest_eigenvalue(robot: &Robot<f64, 3>, joints: [f64; 3]) -> f64 {
    let q = Configuration { joints, ..Configuration::zero() };
    mass::dense(&robot.mass_matrix_at(&q)).symmetric_eigenvalues().min()
}

/// Least over a grid of the joint limits, and over the postures straight up.
fn smallest_anywhere(robot: &Robot<f64, 3>) -> f64 {
    let [one, two, three] = robot.params().limits.joints;
    let steps = 24;
    let at = |(lo, hi): (f64, f64), i: i32| lo + (hi - lo) * f64::from(i) / f64::from(steps);
    let mut least = f64::INFINITY;
    for i in 0..=steps {
        for j in 0..=steps {
            for k in 0..=steps {
                least = least.min(smallest_eigenvalue(robot, [at(one, i), at(two, j), at(three, k)]));
            }
        }
    }
    least
}

#[test]
fn the_preset_is_lightest_straight_up() {
    let preset = Params::thesis();
    let mut middle = preset;
    for link in &mut middle.links {
        link.com = link.length / 2.0;
    }
    let up = core::f64::consts::FRAC_PI_2;
    // The least eigenvalue over all postures, where the arm is stretched straight up; then that of the rest posture.
    for (params, yaw, least, rest) in [(preset, up, 0.247, 0.630), (middle, 0.0, 0.079, 0.308)] {
        let robot = Robot::try_new(params).expect("the preset is a robot");
        let upright = smallest_eigenvalue(&robot, [yaw, up, 0.0]);
        assert!((upright - least).abs() < 5e-4, "straight up: {upright}");
        let at_rest = smallest_eigenvalue(&robot, params.rest_posture);
        assert!((at_rest - rest).abs() < 5e-4, "at rest: {at_rest}");
        let anywhere = smallest_anywhere(&robot);
        assert!(
            anywhere > upright - 1e-9 && anywhere < 1.05 * upright,
            "{anywhere} somewhere, {upright} upright"
        );
    }
}

#[test]
#[expect(clippy::float_cmp, reason = "the numbers of the table are copied, not computed")]
fn the_preset_has_the_numbers_of_table_5_1() {
    let p = Params::thesis();
    let table = [p.base_mass, p.wheel_radius, p.track_width, p.arm_offset, p.gravity];
    assert_eq!(table, [50.0, 0.06, 0.2, 0.06, 9.81]);
    assert_eq!(p.links.map(|link| link.mass), [4.0, 6.0, 4.0]);
    assert_eq!(p.links.map(|link| (link.length, link.com)), [(0.5, 0.5); 3]);
    // m a^2 / 12 and the box 50 (0.5^2 + 0.4^2) / 12.
    for (link, inertia) in p.links.iter().zip([1.0 / 12.0, 0.125, 1.0 / 12.0]) {
        assert!((link.axial_inertia - inertia).abs() < 1e-15, "{link:?}");
        assert!((link.pitch_inertia - inertia).abs() < 1e-15, "{link:?}");
        assert!((link.normal_inertia - inertia).abs() < 1e-15, "{link:?}");
    }
    assert!((p.base_yaw_inertia - 1.708).abs() < 5e-4, "{}", p.base_yaw_inertia);
    // Gravity at joint 2, stretched out: (6 + 4) 0.5 g + 4 * 0.5 g.
    let robot = Robot::try_new(p).expect("the preset is a robot");
    let gravity = robot.gravity(&robot.inertia(&robot.posture(&[0.0; 3])));
    assert!((gravity.joints[1] - 68.67).abs() < 1e-12, "{gravity:?}");
    assert!(robot.params().friction.is_none());
}

#[test]
fn scaling_the_mass_scales_the_dynamics() {
    let preset = Params::thesis();
    let light = Robot::try_new(preset).expect("the preset is a robot");
    let heavy = Robot::try_new(preset.with_mass_scaled(1.25)).expect("so is a heavier one");
    let q = Configuration { joints: [0.4, 0.8, -1.1], ..Configuration::zero() };
    let nu = Velocity { forward: 0.7, yaw_rate: -0.5, joints: [0.3, 1.1, -2.0] };
    let acceleration = Velocity { forward: 0.1, yaw_rate: 0.9, joints: [-0.2, 0.6, 0.5] };
    let force = light.inverse_dynamics(&q, &nu, &acceleration);
    let scaled = heavy.inverse_dynamics(&q, &nu, &acceleration);
    // The largest entry is 150 N m.
    assert!(scaled.minus(force.scaled(1.25)).channels().all(|x| x.abs() < 1e-12), "{scaled:?}, {force:?}");
    assert_eq!(heavy.tip_position(&q), light.tip_position(&q), "lengths are not scaled");
    assert_eq!(heavy.params().limits, preset.limits);
}
