//! The 6 x 6 form (3.90) to (3.97) of the thesis, written out term by term: the slow reference of the closed form.
//!
//! Coordinates (x, y, heading, q1, q2, q3) of the axle's midpoint, the constraint still to be eliminated:
//!
//! ```text
//! M(q) q" + C(q, q') q' + G(q) = E(q) tau + A'(q) lambda,    A(q) q' = 0,    q' = S(q) nu
//! ```
//!
//! Multiplying by S' removes lambda and leaves the reduced form (3.100), which [`reduce`] forms by matrix products. Nothing
//! is simplified on the way: each body contributes its own 3 x 6 Jacobian and the derivative of that Jacobian. Use it to check
//! the closed form of [`Mechanism`](crate::Mechanism), not to run a controller.
//!
//! The thesis gives the entries of (3.93) and (3.94) nowhere; they follow from its positions (3.78) to (3.81), velocities
//! (3.82) to (3.86) and energies (3.87) and (3.88). Each function says what is printed there and what had to be mended.

use nalgebra::{Matrix3x6, Matrix5, Matrix6, SMatrix, Vector3, Vector5, Vector6, matrix, vector};

use crate::params::Link;
use crate::{Angle, Configuration, Real, Robot, Velocity};

/// The reduced equations (3.100) as full matrices: `mass nu' + coriolis nu + gravity = input tau`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Reduced<T> {
    /// `S' M S`.
    pub mass: Matrix5<T>,
    /// `S' (M dS/dt + C S)`.
    pub coriolis: Matrix5<T>,
    /// `S' G`.
    pub gravity: Vector5<T>,
    /// `S' E`.
    pub input: Matrix5<T>,
}

/// Reduces the 6 x 6 form to the quasi-velocities, (3.90) to (3.100).
///
/// Equation: `S' M S`, `S' (M dS/dt + C S)`, `S' G`, `S' E`, with M, C, G, E and S of this module at q and `q' = S nu`.
///
/// Mended: (3.99) and (3.100) print v for both nu and its rate; the left-hand side of (3.100) is nu'.
#[must_use]
pub fn reduce<T: Real>(robot: &Robot<T, 3>, q: &Configuration<T, 3>, nu: &Velocity<T, 3>) -> Reduced<T> {
    let heading = Angle::of(q.heading);
    let s = Robot::<T, 3>::velocity_map(heading);
    let s_rate = velocity_map_rate(heading, nu.yaw_rate);
    let [d1, d2, d3] = nu.joints;
    let rate = s * vector![nu.forward, nu.yaw_rate, d1, d2, d3];
    let mass = mass_matrix(robot, q);
    let back = s.transpose();
    Reduced {
        mass: back * mass * s,
        coriolis: back * (mass * s_rate + coriolis_matrix(robot, q, &rate) * s),
        gravity: back * gravity(robot, q),
        input: back * input_map(robot, heading),
    }
}

/// Mass matrix M(q) of (3.93), 6 x 6.
///
/// Equation: `M = sum over base and links of m J'J + (yaw inertia) e e' + (pitch inertia) P P'`, where `J q'` is the velocity
/// of the centre of mass, `e q'` the yaw rate and `P q'` the pitch rate of the body.
///
/// Mended: the yaw entry of (3.76) is I_b + m_b d^2 where I_b + m_b^2 is printed, and the base's kinetic energy in (3.87)
/// takes the velocity of its centre of mass (3.82), not that of the axle. A pitching link turns about the vertical with
/// I_a sin^2 + I_v cos^2 of its pitch and about the pitch axis with I_p; (3.87) prints I2^2 for link 2, and for link 3 leaves
/// q3' out, so that joint 3 would move no inertia.
#[must_use]
pub fn mass_matrix<T: Real>(robot: &Robot<T, 3>, q: &Configuration<T, 3>) -> Matrix6<T> {
    let still = Vector6::zeros();
    bodies(robot, q, &still).iter().fold(Matrix6::zeros(), |sum, body| {
        let spin = &body.spin;
        sum + body.jacobian.tr_mul(&body.jacobian) * body.mass
            + spin.yaw * spin.yaw.transpose() * spin.yaw_inertia
            + spin.pitch * spin.pitch.transpose() * spin.pitch_inertia
    })
}

/// Coriolis matrix C(q, q') of (3.94), 6 x 6, at the coordinate rates `rate`.
///
/// Equation: `C = sum of m J' dJ/dt + I_y' (theta' e e' + Omega (e P' - P e')) / 2`, with theta the pitch of the link, Omega
/// its yaw rate and `I_y' = 2 (I_a - I_v) sin theta cos theta`. These are the Christoffel symbols of M, so that
/// dM/dt - 2C is skew (Property 3).
///
/// Mended: in the base's part the signs of (3.73) to (3.75), as (3.76) has them. The velocities behind J are (3.82) to (3.86),
/// with the distance of the centre of mass where (3.83) to (3.85) print r_2 and, once, q_2.
#[must_use]
pub fn coriolis_matrix<T: Real>(
    robot: &Robot<T, 3>,
    q: &Configuration<T, 3>,
    rate: &Vector6<T>,
) -> Matrix6<T> {
    bodies(robot, q, rate).iter().fold(Matrix6::zeros(), |sum, body| {
        let Spin { yaw, pitch, yaw_slope, .. } = &body.spin;
        let half = *yaw_slope * T::HALF;
        let exchange = yaw * pitch.transpose() - pitch * yaw.transpose();
        sum + body.jacobian.tr_mul(&body.jacobian_rate) * body.mass
            + yaw * yaw.transpose() * (half * pitch.dot(rate))
            + exchange * (half * yaw.dot(rate))
    })
}

/// Gravity G(q) of (3.98), 6 entries.
///
/// Equation: the gradient of (3.88), zero but for the pitch joints; q2: `g (m2 c2 + m3 a2) cos q2 + g m3 c3 cos(q2 + q3)`,
/// q3: `g m3 c3 cos(q2 + q3)`.
///
/// Mended: (3.96) lists 5 entries for an equation of 6 rows. (3.88) puts the centres of mass at the tips, (3.98) at r_i; here
/// they are where [`Link::com`](crate::Link::com) says.
#[must_use]
pub fn gravity<T: Real>(robot: &Robot<T, 3>, q: &Configuration<T, 3>) -> Vector6<T> {
    let p = robot.params();
    let up = Vector3::new(T::ZERO, T::ZERO, p.gravity);
    bodies(robot, q, &Vector6::zeros())
        .iter()
        .fold(Vector6::zeros(), |sum, body| sum + body.jacobian.tr_mul(&up) * body.mass)
}

/// Input map E(q) of (3.95), 6 x 5, for torques (right wheel, left wheel, joints) as (3.97) orders them.
///
/// Mended: the yaw row is (l/r, -l/r), as the power of the wheels demands; (3.95) prints (-r/(2l), r/(2l)), which is a
/// ratio of speeds and has the wheels exchanged, and (3.76) prints (2l/r, -2l/r).
#[must_use]
pub fn input_map<T: Real>(robot: &Robot<T, 3>, heading: Angle<T>) -> SMatrix<T, 6, 5> {
    let p = robot.params();
    let (push, turn) = (T::ONE / p.wheel_radius, p.track_width * T::HALF / p.wheel_radius);
    let (c, s, zero, one) = (heading.cos * push, heading.sin * push, T::ZERO, T::ONE);
    matrix![
        c, c, zero, zero, zero;
        s, s, zero, zero, zero;
        turn, -turn, zero, zero, zero;
        zero, zero, one, zero, zero;
        zero, zero, zero, one, zero;
        zero, zero, zero, zero, one
    ]
}

/// Rate dS/dt of the [velocity map](Robot::velocity_map) of (3.92) while the base turns at `yaw_rate`.
///
/// Mended: like the map itself, in quasi-velocities and for the axle's midpoint, where only the first column changes.
#[must_use]
pub fn velocity_map_rate<T: Real>(heading: Angle<T>, yaw_rate: T) -> SMatrix<T, 6, 5> {
    let mut rate = SMatrix::<T, 6, 5>::zeros();
    rate.fixed_view_mut::<2, 1>(0, 0).copy_from(&vector![-(heading.sin * yaw_rate), heading.cos * yaw_rate]);
    rate
}

/// One rigid body as the energies see it.
struct Body<T> {
    mass: T,
    /// Velocity of the centre of mass per coordinate rate, and the rate of that.
    jacobian: Matrix3x6<T>,
    jacobian_rate: Matrix3x6<T>,
    spin: Spin<T>,
}

/// How a body turns: `yaw q'` about the vertical, `pitch q'` about the arm's pitch axis.
struct Spin<T> {
    yaw: Vector6<T>,
    pitch: Vector6<T>,
    yaw_inertia: T,
    pitch_inertia: T,
    /// Derivative of `yaw_inertia` by the pitch.
    yaw_slope: T,
}

/// Base and links at a configuration and coordinate rates.
fn bodies<T: Real>(robot: &Robot<T, 3>, q: &Configuration<T, 3>, rate: &Vector6<T>) -> [Body<T>; 4] {
    let p = robot.params();
    let [one, two, three] = &p.links;
    let zero = T::ZERO;
    let point = |mass: T, foot: T, along: [T; 2], spin: Spin<T>| {
        let (jacobian, jacobian_rate) = centre_of_mass(q, rate, foot, along);
        Body { mass, jacobian, jacobian_rate, spin }
    };
    let [_, q2, q3] = q.joints;
    let lb = p.arm_offset;
    [
        point(p.base_mass, p.base_com_offset, [zero, zero], upright(zero, p.base_yaw_inertia)),
        point(one.mass, lb, [zero, zero], upright(T::ONE, one.axial_inertia)),
        point(two.mass, lb, [two.com, zero], pitching(two, Angle::of(q2), zero)),
        point(three.mass, lb, [two.length, three.com], pitching(three, Angle::of(q2 + q3), T::ONE)),
    ]
}

/// Jacobian, and its rate, of a point that `along` puts so far along the directions of links 2 and 3 from a yaw axis
/// `foot` ahead of the axle: the velocities (3.82) to (3.86).
fn centre_of_mass<T: Real>(
    q: &Configuration<T, 3>,
    rate: &Vector6<T>,
    foot: T,
    along: [T; 2],
) -> (Matrix3x6<T>, Matrix3x6<T>) {
    let (zero, one) = (T::ZERO, T::ONE);
    let [[_, _, w, w1, w2, w3]] = rate.data.0;
    let [q1, q2, q3] = q.joints;
    let (heading, psi) = (Angle::of(q.heading), Angle::of(q.heading + q1));
    let (shoulder, forearm) = (Angle::of(q2), Angle::of(q2 + q3));
    let [b, c] = along;
    let (turning, pitch2, pitch3) = (w + w1, w2, w2 + w3);
    // Unit vectors ahead and to the left, of the base and of the arm; each turns into the other.
    let ahead = |a: Angle<T>| Vector3::new(a.cos, a.sin, zero);
    let left = |a: Angle<T>| Vector3::new(-a.sin, a.cos, zero);
    let up = Vector3::new(zero, zero, one);
    // Distance from the yaw axis, its partial derivatives, and the rates of all three.
    let rho = b * shoulder.cos + c * forearm.cos;
    let rho_2 = -(b * shoulder.sin + c * forearm.sin);
    let rho_3 = -(c * forearm.sin);
    let d_rho = rho_2 * w2 + rho_3 * w3;
    let d_rho_2 = -(b * shoulder.cos * pitch2 + c * forearm.cos * pitch3);
    let d_rho_3 = -(c * forearm.cos * pitch3);
    // Height: z_2 = rho, z_3 = c cos(q2 + q3).
    let (z_3, d_z_3) = (c * forearm.cos, rho_3 * pitch3);
    let swing = left(psi) * rho;
    let swing_rate = left(psi) * d_rho - ahead(psi) * (rho * turning);
    let pitched = |rho_k: T, z_k: T| ahead(psi) * rho_k + up * z_k;
    let pitched_rate =
        |rho_k: T, d_rho_k: T, d_z_k: T| ahead(psi) * d_rho_k + left(psi) * (rho_k * turning) + up * d_z_k;
    let still = Vector3::zeros();
    let jacobian = Matrix3x6::from_columns(&[
        Vector3::new(one, zero, zero),
        Vector3::new(zero, one, zero),
        left(heading) * foot + swing,
        swing,
        pitched(rho_2, rho),
        pitched(rho_3, z_3),
    ]);
    let jacobian_rate = Matrix3x6::from_columns(&[
        still,
        still,
        swing_rate - ahead(heading) * (foot * w),
        swing_rate,
        pitched_rate(rho_2, d_rho_2, d_rho),
        pitched_rate(rho_3, d_rho_3, d_z_3),
    ]);
    (jacobian, jacobian_rate)
}

/// A body that only turns about the vertical; `with_arm` is 1 where q1 turns it too.
fn upright<T: Real>(with_arm: T, yaw_inertia: T) -> Spin<T> {
    let zero = T::ZERO;
    Spin {
        yaw: vector![zero, zero, T::ONE, with_arm, zero, zero],
        pitch: Vector6::zeros(),
        yaw_inertia,
        pitch_inertia: zero,
        yaw_slope: zero,
    }
}

/// A link at a pitch above the horizontal; `with_elbow` is 1 where q3 pitches it too.
fn pitching<T: Real>(link: &Link<T>, pitch: Angle<T>, with_elbow: T) -> Spin<T> {
    let (zero, one) = (T::ZERO, T::ONE);
    let Angle { sin, cos } = pitch;
    Spin {
        yaw: vector![zero, zero, one, one, zero, zero],
        pitch: vector![zero, zero, zero, zero, one, with_elbow],
        yaw_inertia: link.axial_inertia * sin * sin + link.normal_inertia * cos * cos,
        pitch_inertia: link.pitch_inertia,
        yaw_slope: T::TWO * (link.axial_inertia - link.normal_inertia) * sin * cos,
    }
}
