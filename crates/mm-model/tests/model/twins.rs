//! The closed form against two slower twins, on 10,000 random robots and states.
//!
//! Law: M, C nu, C nu_r, g, the energies, tip, Jacobian, dJ/dt nu and forward dynamics are those of four rigid bodies on two
//! wheels. They must be: the closed form is only an arrangement of the same sums. References: (1) full rigid bodies in space
//! with geometric Jacobians, Christoffel symbols from automatic differentiation, the wheels' constraint held by a Lagrange
//! multiplier (7 x 7 linear system); (2) the thesis's 6 x 6 form (3.90) of `mm_model::reference`, reduced by S.
//! Tolerance: 1e-13 relative to the norm of the terms that are summed, about 500 roundings; ten times that, relative to the
//! acceleration itself, where M is solved, since these M have condition numbers up to 5e4.

use crate::common::random::{self, Random};
use crate::common::rigid::Rigid;
use crate::common::vectors::{of_force, of_velocity};
use crate::common::worst::Worst;
use crate::common::{coriolis, mass};
use mm_model::{Angle, Force, Mechanism, Real, Torque, reference};
use nalgebra::{SMatrix, SVector};

const CASES: u32 = 10_000;
const TOLERANCE: f64 = 1e-13;

/// dq/dt = S nu and its rate, written here anew: (x, y, heading, joints) of the axle's midpoint.
fn velocity_map(heading: f64, yaw_rate: f64) -> (SMatrix<f64, 6, 5>, SMatrix<f64, 6, 5>) {
    let (sin, cos) = Real::sin_cos(heading);
    let (mut s, mut rate) = (SMatrix::<f64, 6, 5>::zeros(), SMatrix::<f64, 6, 5>::zeros());
    (s[(0, 0)], s[(1, 0)]) = (cos, sin);
    (rate[(0, 0)], rate[(1, 0)]) = (-sin * yaw_rate, cos * yaw_rate);
    for joint in 1..5 {
        s[(joint + 1, joint)] = 1.0;
    }
    (s, rate)
}

#[test]
fn rigid_bodies_in_space() {
    let mut draw = Random::seeded(1);
    let [mut mass, mut coriolis, mut reaching, mut gravity] = ["M", "C nu", "C nu_r", "g"].map(Worst::of);
    let mut skew = Worst::of("dM/dt = C + C'");
    let [mut kinetic, mut potential] = ["kinetic energy", "potential energy"].map(Worst::of);
    let [mut tip, mut jacobian, mut bias] = ["tip", "J", "dJ/dt nu"].map(Worst::of);
    for case in 0..CASES {
        let robot = random::robot(draw.params(case));
        let (q, nu, nu_r) = (draw.configuration(), draw.velocity(), draw.velocity());
        let twin = Rigid::new(robot.params(), &q);
        let (s, s_rate) = velocity_map(q.heading, nu.yaw_rate);
        let (u, u_r) = (of_velocity(&nu), of_velocity(&nu_r));
        let rate = s * u;
        let inertia = robot.inertia(&robot.posture(&q.joints));

        let m = s.transpose() * twin.mass * s;
        mass.see(case, &mass::dense(&robot.mass_matrix(&inertia)), &m, m.norm());
        let c = s.transpose() * (twin.mass * s_rate + twin.coriolis(&rate) * s);
        let product = robot.coriolis_product(&inertia, &nu, &nu);
        coriolis.see(case, &of_force(&product), &(c * u), c.norm() * u.norm());
        let product = robot.coriolis_product(&inertia, &nu, &nu_r);
        reaching.see(case, &of_force(&product), &(c * u_r), c.norm() * u_r.norm());
        let g = s.transpose() * twin.gravity;
        let p = robot.params();
        let moments = p.links.iter().fold(0.0, |sum, link| sum + link.mass) * p.gravity;
        gravity.see(case, &of_force(&robot.gravity(&inertia)), &g, moments);

        // d(S'MS)/dt, exact, is C + C': Property 3 with nothing differenced.
        let of_mass =
            twin.mass_by.iter().zip(rate.iter()).fold(SMatrix::zeros(), |sum, (by, &r)| sum + by * r);
        let half = s.transpose() * of_mass * s * 0.5 + s.transpose() * twin.mass * s_rate;
        let c = coriolis::matrix(&robot, &q, &nu);
        let scale = twin.mass.norm() * u.norm();
        skew.see(case, &(c + c.transpose()), &(half + half.transpose()), scale);

        let one = |x: f64| SVector::<f64, 1>::new(x);
        let energy = 0.5 * (rate.transpose() * twin.mass * rate)[0];
        kinetic.see(
            case,
            &one(robot.kinetic_energy(&q, &nu)),
            &one(energy),
            0.5 * m.norm() * u.norm_squared(),
        );
        potential.see(case, &one(robot.potential_energy_at(&q)), &one(twin.potential), moments);

        tip.see(case, &robot.tip_position(&q), &twin.tip, 1.0 + twin.tip.norm());
        let j = twin.tip_jacobian * s;
        jacobian.see(case, &robot.jacobian(&q).to_matrix(), &j, j.norm());
        let j_rate =
            (0..6).fold(SMatrix::<f64, 3, 6>::zeros(), |sum, k| sum + twin.tip_jacobian_by[k] * rate[k]);
        let expected = (j_rate * s + twin.tip_jacobian * s_rate) * u;
        bias.see(case, &robot.jacobian_bias(&q, &nu), &expected, j.norm() * u.norm_squared());
    }
    for worst in [mass, coriolis, reaching, gravity, skew, kinetic, potential, tip, jacobian, bias] {
        worst.within(TOLERANCE);
    }
}

#[test]
fn forward_dynamics_with_the_constraint_force() {
    let mut draw = Random::seeded(2);
    let (mut forward, mut back) = (Worst::of("forward dynamics"), Worst::of("inverse dynamics"));
    for case in 0..CASES {
        let robot = random::robot(draw.params(case));
        let (q, nu) = (draw.configuration(), draw.velocity());
        let torque = Torque {
            right: draw.between(-60.0, 60.0),
            left: draw.between(-60.0, 60.0),
            joints: [(); 3].map(|()| draw.between(-150.0, 150.0)),
        };
        let push = draw.velocity();
        let external = Force { forward: push.forward, yaw: push.yaw_rate, joints: push.joints }.scaled(20.0);
        let twin = Rigid::new(robot.params(), &q);
        let (s, s_rate) = velocity_map(q.heading, nu.yaw_rate);
        let rate = s * of_velocity(&nu);
        let (sin, cos) = Real::sin_cos(q.heading);

        // A force F at the rim of each wheel pushes forwards and turns by its lever, half the track.
        let p = robot.params();
        let rims = [(torque.right, 0.5 * p.track_width), (torque.left, -0.5 * p.track_width)];
        let mut applied = SVector::<f64, 6>::zeros();
        for (wheel, lever) in rims {
            let rim = wheel / p.wheel_radius;
            applied += SVector::<f64, 6>::new(rim * cos, rim * sin, rim * lever, 0.0, 0.0, 0.0);
        }
        applied.fixed_rows_mut::<3>(3).copy_from(&SVector::from(torque.joints));
        // S (S'S)^-1 f = S f: S has orthonormal columns.
        let friction = of_force(&robot.friction(&nu));
        applied += s * (of_force(&external) - friction);
        let coriolis = twin.coriolis(&rate) * rate;

        // [ M  -A' ] [ q" ]   [ applied - C q' - G ]
        // [ A   0  ] [ l  ] = [ -dA/dt q'          ],  A = (-sin, cos, 0, 0, 0, 0).
        let mut system = SMatrix::<f64, 7, 7>::zeros();
        system.fixed_view_mut::<6, 6>(0, 0).copy_from(&twin.mass);
        (system[(6, 0)], system[(6, 1)]) = (-sin, cos);
        (system[(0, 6)], system[(1, 6)]) = (sin, -cos);
        let mut right = SVector::<f64, 7>::zeros();
        right.fixed_rows_mut::<6>(0).copy_from(&(applied - coriolis - twin.gravity));
        right[6] = (cos * rate[0] + sin * rate[1]) * rate[2];
        let solution = system.full_piv_lu().solve(&right).expect("M positive definite, A of rank 1");
        // nu' = S' (q" - dS/dt nu), again by the orthonormal columns.
        let expected = s.transpose() * (solution.fixed_rows::<6>(0) - s_rate * of_velocity(&nu));

        let got = of_velocity(&robot.forward_dynamics(&q, &nu, &torque, &external));
        let m = s.transpose() * twin.mass * s;
        let forces = applied.norm() + coriolis.norm() + twin.gravity.norm();
        let scale = forces + m.norm() * expected.norm();
        forward.see(case, &got, &expected, expected.norm());

        let inertia = robot.inertia(&robot.posture(&q.joints));
        let acceleration = robot.acceleration(&inertia, &nu, &robot.force_of(&torque).plus(external));
        let force = robot.inverse_dynamics(&q, &nu, &acceleration).minus(external);
        let applied = of_force(&robot.force_of(&torque));
        back.see(case, &of_force(&force), &applied, scale);
    }
    forward.within(10.0 * TOLERANCE);
    back.within(TOLERANCE);
}

#[test]
fn the_literal_form_reduces_to_the_closed_form() {
    let mut draw = Random::seeded(3);
    let [mut mass, mut coriolis, mut gravity, mut input] =
        ["S'MS", "S'(M dS + C S)", "S'G", "S'E"].map(Worst::of);
    for case in 0..CASES {
        let robot = random::robot(draw.params(case));
        let (q, nu) = (draw.configuration(), draw.velocity());
        let reduced = reference::reduce(&robot, &q, &nu);
        let inertia = robot.inertia(&robot.posture(&q.joints));
        let m = mass::dense(&robot.mass_matrix(&inertia));
        mass.see(case, &reduced.mass, &m, m.norm());
        let c = coriolis::matrix(&robot, &q, &nu);
        coriolis.see(case, &reduced.coriolis, &c, c.norm());
        let g = of_force(&robot.gravity(&inertia));
        let p = robot.params();
        gravity.see(case, &reduced.gravity, &g, p.gravity * p.links.iter().fold(0.0, |sum, l| sum + l.mass));
        let columns: Vec<_> = (0..5)
            .map(|j| {
                let unit = (0..5).map(|i| if i == j { 1.0 } else { 0.0 });
                of_force(&robot.force_of(&Torque::from_channels(unit)))
            })
            .collect();
        let b = SMatrix::<f64, 5, 5>::from_columns(&columns);
        input.see(case, &reduced.input, &b, b.norm());
    }
    for worst in [mass, coriolis, gravity, input] {
        worst.within(TOLERANCE);
    }
}

#[test]
fn the_literal_form_is_the_rigid_bodies_before_reduction() {
    let mut draw = Random::seeded(4);
    let [mut mass, mut coriolis, mut gravity] = ["6 x 6 M", "6 x 6 C", "6 G"].map(Worst::of);
    let mut map = Worst::of("S and dS/dt");
    for case in 0..CASES {
        let robot = random::robot(draw.params(case));
        let (q, nu) = (draw.configuration(), draw.velocity());
        let twin = Rigid::new(robot.params(), &q);
        let (s, s_rate) = velocity_map(q.heading, nu.yaw_rate);
        // Rates that violate the constraint, too: the 6 x 6 form is that of a base that may slide.
        let slide = SVector::<f64, 6>::from_fn(|_, _| draw.between(-1.0, 1.0));
        let rate = s * of_velocity(&nu) + slide;
        mass.see(case, &reference::mass_matrix(&robot, &q), &twin.mass, twin.mass.norm());
        let c = twin.coriolis(&rate);
        coriolis.see(case, &reference::coriolis_matrix(&robot, &q, &rate), &c, c.norm());
        let weight = robot.params().gravity * twin.mass[(0, 0)];
        gravity.see(case, &reference::gravity(&robot, &q), &twin.gravity, weight);
        let heading = Angle::of(q.heading);
        map.see(case, &mm_model::Robot::<f64, 3>::velocity_map(heading), &s, 1.0);
        map.see(case, &reference::velocity_map_rate(heading, nu.yaw_rate), &s_rate, 1.0);
    }
    for worst in [mass, coriolis, gravity, map] {
        worst.within(TOLERANCE);
    }
}
