//! What the equations of motion must have in common with those of every mechanism, on 10,000 random robots and states.
//!
//! Law: M is symmetric and positive definite (Properties 1 and 2); dM/dt - 2C is skew (Property 3), so that
//! dM/dt = C + C'; energy changes by what the actuators put in and friction takes out; nothing depends on where the robot
//! stands. The closed form must have them because it is a sum over bodies; a slip in any term breaks at least one.
//! References: nalgebra's Cholesky and eigenvalues; central differences of M and of the energy (`tests/twins.rs` has the
//! exact dM/dt).
//! Tolerance: 1e-13 relative to the norm of the terms that are summed; where M is solved the residual is held to it, not the
//! solution, since these M have condition numbers up to 1.2e5; 1e-11 for differences (see `common/differences.rs`).

use crate::common::differences::derivative;
use crate::common::random::{self, Random};
use crate::common::vectors::{of_force, of_velocity};
use crate::common::worst::Worst;
use crate::common::{coriolis, mass};
use mm_model::{Configuration, Force, Mechanism, Torque, Velocity};
use nalgebra::SVector;

const CASES: u32 = 10_000;
const TOLERANCE: f64 = 1e-13;
const BY_DIFFERENCES: f64 = 1e-11;

fn random_force(draw: &mut Random) -> Force<f64, 3> {
    let v = draw.velocity();
    Force { forward: v.forward, yaw: v.yaw_rate, joints: v.joints }.scaled(30.0)
}

/// The joint angles after a time at constant rates.
fn moved(joints: &[f64; 3], rates: &[f64; 3], time: f64) -> [f64; 3] {
    let mut moved = *joints;
    for (angle, rate) in moved.iter_mut().zip(rates) {
        *angle += time * rate;
    }
    moved
}

#[test]
fn mass_matrix_is_symmetric_and_positive_definite() {
    let mut draw = Random::seeded(21);
    let mut smallest = f64::INFINITY;
    for case in 0..CASES {
        let robot = random::robot(draw.params(case));
        let blocks = robot.mass_matrix_at(&draw.configuration());
        let m = mass::dense(&blocks);
        assert_eq!(m, m.transpose(), "case {case}: M is not symmetric");
        assert!(m.cholesky().is_some(), "case {case}: M has no Cholesky factor");
        let eigenvalues = m.symmetric_eigenvalues();
        smallest = smallest.min(eigenvalues.min() / eigenvalues.max());
        assert!(eigenvalues.min() > 0.0, "case {case}: eigenvalues {eigenvalues}");
        assert!(blocks.factor().is_some(), "case {case}: the block factorization refused M");
    }
    println!("smallest eigenvalue over largest: {smallest:.1e}");
}

#[test]
fn a_matrix_that_is_not_positive_definite_has_no_factor() {
    let mut draw = Random::seeded(22);
    let m = random::robot(draw.params(0)).mass_matrix_at(&draw.configuration());
    assert!(m.factor().is_some());
    for index in 0..2 {
        let mut bad = m;
        bad.base[(index, index)] = -bad.base[(index, index)];
        assert_eq!(bad.factor(), None, "base entry {index} negative");
    }
    for index in 0..3 {
        let mut bad = m;
        bad.arm[(index, index)] = -bad.arm[(index, index)];
        assert_eq!(bad.factor(), None, "arm entry {index} negative");
        bad.arm[(index, index)] = f64::NAN;
        assert_eq!(bad.factor(), None, "arm entry {index} NaN");
    }
    let mut coupled = m;
    coupled.coupling *= 100.0;
    assert_eq!(coupled.factor(), None, "coupling beyond the diagonal");
}

#[test]
fn products_and_solutions_agree_with_the_matrix() {
    let mut draw = Random::seeded(23);
    let [mut product, mut blocks, mut solved, mut factored] =
        ["M a", "M a by blocks", "solve", "factor and solve"].map(Worst::of);
    for case in 0..CASES {
        let robot = random::robot(draw.params(case));
        let (q, a, f) = (draw.configuration(), draw.velocity(), random_force(&mut draw));
        let inertia = robot.inertia(&robot.posture(&q.joints));
        let mass = robot.mass_matrix(&inertia);
        let m = mass::dense(&mass);
        let (expected, scale) = (m * of_velocity(&a), m.norm() * of_velocity(&a).norm());
        product.see(case, &of_force(&robot.mass_product(&inertia, &a)), &expected, scale);
        blocks.see(case, &of_force(&mass.product(&a)), &expected, scale);
        let force = of_force(&f);
        let x = of_velocity(&robot.solve(&inertia, &f));
        solved.see(case, &(m * x), &force, m.norm() * x.norm());
        let factor = mass.factor().expect("checked by the test above");
        let x = of_velocity(&factor.solve(&f));
        factored.see(case, &(m * x), &force, m.norm() * x.norm());
    }
    for worst in [product, blocks, solved, factored] {
        worst.within(TOLERANCE);
    }
}

#[test]
fn rate_of_mass_less_twice_coriolis_is_skew() {
    let mut draw = Random::seeded(24);
    let [mut skew, mut quadratic, mut transpose, mut momentum] =
        ["N + N', N = dM/dt - 2C", "x'(dM/dt - 2C)x", "C' nu", "dM/dt nu = C nu + C' nu"].map(Worst::of);
    for case in 0..CASES {
        let robot = random::robot(draw.params(case));
        let (q, nu, x) = (draw.configuration(), draw.velocity(), of_velocity(&draw.velocity()));
        // M has the second harmonic of angles that turn at up to 10 rad/s.
        let rate = derivative(20.0, |t| {
            let there = Configuration { joints: moved(&q.joints, &nu.joints, t), ..q };
            mass::dense(&robot.mass_matrix_at(&there))
        });
        let c = coriolis::matrix(&robot, &q, &nu);
        let n = rate - c * 2.0;
        let size = mass::dense(&robot.mass_matrix_at(&q)).norm() * 20.0;
        skew.see(case, &n, &-n.transpose(), size);
        let form = SVector::<f64, 1>::new(x.dot(&(n * x)));
        quadratic.see(case, &form, &SVector::<f64, 1>::zeros(), size * x.norm_squared());
        let inertia = robot.inertia(&robot.posture(&q.joints));
        let (forward, back) =
            (robot.coriolis_product(&inertia, &nu, &nu), robot.coriolis_transpose_product(&inertia, &nu));
        let u = of_velocity(&nu);
        transpose.see(case, &of_force(&back), &(c.transpose() * u), c.norm() * u.norm());
        momentum.see(case, &of_force(&forward.plus(back)), &(rate * u), size * u.norm());
    }
    transpose.within(TOLERANCE);
    for worst in [skew, quadratic, momentum] {
        worst.within(BY_DIFFERENCES);
    }
}

#[test]
fn energy_changes_by_the_power_of_actuators_less_friction() {
    let mut draw = Random::seeded(25);
    let mut balance = Worst::of("power balance");
    for case in 0..CASES {
        let robot = random::robot(draw.params(case));
        let (q, nu, f) = (draw.configuration(), draw.velocity(), random_force(&mut draw));
        let torque = robot.torque_of(&f);
        let a = robot.forward_dynamics(&q, &nu, &torque, &Force::zero());
        // Along (q + t q', nu + t nu') the derivative of the energy at t = 0 is that along the motion.
        let energy = |t: f64| {
            let there = Configuration { joints: moved(&q.joints, &nu.joints, t), ..q };
            let speed = nu.plus(a.scaled(t));
            let total = robot.kinetic_energy(&there, &speed) + robot.potential_energy_at(&there);
            SVector::<f64, 1>::new(total)
        };
        let speed = 10.0 + of_velocity(&a).norm() / 3.0;
        let power = nu.power(&robot.force_of(&torque)) - nu.power(&robot.friction(&nu));
        let scale = energy(0.0).norm() * speed + of_force(&f).norm() * of_velocity(&nu).norm();
        balance.see(case, &derivative(speed, energy), &SVector::<f64, 1>::new(power), scale);
    }
    balance.within(BY_DIFFERENCES);
}

#[test]
fn nothing_depends_on_where_the_robot_stands() {
    let mut draw = Random::seeded(26);
    let mut turned = Worst::of("J turned with the base");
    for case in 0..CASES {
        let robot = random::robot(draw.params(case));
        let (q, nu) = (draw.configuration(), draw.velocity());
        let elsewhere = Configuration { joints: q.joints, ..draw.configuration() };
        let torque = Torque { right: 11.0, left: -3.0, joints: [20.0, 60.0, -10.0] };
        let run = |at| robot.forward_dynamics(at, &nu, &torque, &Force::zero());
        assert_eq!(robot.mass_matrix_at(&q), robot.mass_matrix_at(&elsewhere), "case {case}");
        assert_eq!(run(&q), run(&elsewhere), "case {case}");
        let zero = Velocity::zero();
        assert_eq!(robot.inverse_dynamics(&q, &nu, &zero), robot.inverse_dynamics(&elsewhere, &nu, &zero));
        let energies = |at| {
            [robot.kinetic_energy(at, &nu), robot.potential_energy_at(at), robot.manipulability(at)]
                .map(f64::to_bits)
        };
        assert_eq!(energies(&q), energies(&elsewhere), "case {case}");
        let (sin, cos) = mm_model::Real::sin_cos(elsewhere.heading - q.heading);
        let rotation = nalgebra::matrix![cos, -sin, 0.0; sin, cos, 0.0; 0.0, 0.0, 1.0];
        let j = robot.jacobian(&q).to_matrix();
        // The two headings and their difference are rounded separately: up to 14 rad, 2e-15.
        turned.see(case, &robot.jacobian(&elsewhere).to_matrix(), &(rotation * j), j.norm());
    }
    turned.within(TOLERANCE);
}

/// Law: a payload is a point mass m at the tip: M grows by m J'J, the bias by J'(m dJ/dt nu + m g up). Reference: the tip's Jacobian,
/// which knows no masses.
#[test]
fn a_payload_is_a_point_mass_at_the_tip() {
    let mut draw = Random::seeded(29);
    let [mut mass_gap, mut bias_gap] = ["M with a payload", "bias with a payload"].map(Worst::of);
    for case in 0..1000 {
        let params = draw.params(case);
        let load = draw.between(0.1, 10.0);
        let (bare, loaded) = (random::robot(params), random::robot(params.with_payload(load)));
        let (q, nu) = (draw.configuration(), draw.velocity());
        let jacobian = bare.jacobian(&q).to_matrix();
        let [less, more] = [bare, loaded].map(|robot| mass::dense(&robot.mass_matrix_at(&q)));
        mass_gap.see(case, &more, &(less + jacobian.transpose() * jacobian * load), more.norm());

        let up = nalgebra::Vector3::new(0.0, 0.0, params.gravity);
        let push = jacobian.transpose() * (bare.jacobian_bias(&q, &nu) + up) * load;
        let still = Velocity::zero();
        let [less, more] = [bare, loaded].map(|robot| of_force(&robot.inverse_dynamics(&q, &nu, &still)));
        bias_gap.see(case, &more, &(less + push), more.norm() + less.norm() + push.norm());
    }
    mass_gap.within(TOLERANCE);
    bias_gap.within(TOLERANCE);
}
