//! Manipulability of base and arm, its gradient and the rate of the gradient.
//!
//! With the columns of J written in the arm's plane, the formula of Cauchy and Binet sums det(J J') to
//!
//! ```text
//! det(J J') = P Q + D^2 R,   P = rho^2 + z3^2,   D = a2 a3 sin q3,
//! Q = (l_b + rho c1)^2 + rho^2 (c1^2 + l_b^2 s1^2),   R = s1^2 + (l_b c1 + rho)^2 + rho^2
//! ```
//! with z3 = a3 c23. It vanishes exactly where the arm is stretched straight up or down over its yaw axis.

use core::ops::{Add, Mul, Neg, Sub};

use super::ArmPosture;
use crate::mechanism::ManipulabilitySlope;
use crate::params::RobotParams;
use crate::{Angle, Real};

/// det(J J'): the square of the manipulability of the full, unweighted 3 x 5 Jacobian.
#[inline]
pub(super) fn squared<T: Real>(params: &RobotParams<T, 3>, posture: &ArmPosture<T>) -> T {
    let (reach, lb) = (posture.reach(params), params.arm_offset);
    let Angle { sin: s1, cos: c1 } = posture.yaw;
    let [_, link2, link3] = &params.links;
    let d = link2.length * link3.length * posture.forearm.minus(posture.shoulder).sin;
    let rho = reach.rho;
    let (ahead, beside) = (lb + rho * c1, lb * c1 + rho);
    let q = ahead * ahead + rho * rho * (c1 * c1 + lb * lb * s1 * s1);
    let r = s1 * s1 + beside * beside + rho * rho;
    (rho * rho + reach.z_3 * reach.z_3) * q + d * d * r
}

/// Gradient of det(J J') by (q1, q2, q3), and its rate at the joint rates.
pub(super) fn slope<T: Real>(
    params: &RobotParams<T, 3>,
    posture: &ArmPosture<T>,
    rates: &[T; 3],
) -> ManipulabilitySlope<T, 3> {
    let [dq1, dq2, dq3] = *rates;
    let along = |angle: Angle<T>, rate: T| Angle {
        sin: Rate { value: angle.sin, rate: angle.cos * rate },
        cos: Rate { value: angle.cos, rate: -(angle.sin * rate) },
    };
    let [_, link2, link3] = &params.links;
    let gradient = gradient(
        [params.arm_offset, link2.length, link3.length].map(|value| Rate { value, rate: T::ZERO }),
        along(posture.yaw, dq1),
        along(posture.shoulder, dq2),
        along(posture.forearm, dq2 + dq3),
    );
    ManipulabilitySlope { gradient: gradient.map(|g| g.value), rate: gradient.map(|g| g.rate) }
}

/// The gradient in any arithmetic: with numbers that carry their rate, its rate comes along exactly.
fn gradient<S>(lengths: [S; 3], yaw: Angle<S>, shoulder: Angle<S>, forearm: Angle<S>) -> [S; 3]
where
    S: Copy + Add<Output = S> + Sub<Output = S> + Mul<Output = S> + Neg<Output = S>,
{
    let [lb, a2, a3] = lengths;
    let Angle { sin: s1, cos: c1 } = yaw;
    let z3 = a3 * forearm.cos;
    let rho = a2 * shoulder.cos + z3;
    let rho_3 = -(a3 * forearm.sin);
    let rho_2 = rho_3 - a2 * shoulder.sin;
    let d = a2 * a3 * (forearm.sin * shoulder.cos - forearm.cos * shoulder.sin);
    let d_3 = a2 * a3 * (forearm.cos * shoulder.cos + forearm.sin * shoulder.sin);
    let twice = |x: S| x + x;
    let (ahead, beside) = (lb + rho * c1, lb * c1 + rho);
    let round = c1 * c1 + lb * lb * s1 * s1;
    let p = rho * rho + z3 * z3;
    let q = ahead * ahead + rho * rho * round;
    let r = s1 * s1 + beside * beside + rho * rho;
    let q_rho = twice(c1 * ahead + rho * round);
    let q_1 = twice(rho * rho * s1 * c1 * lb * lb - rho * rho * s1 * c1 - s1 * rho * ahead);
    let r_rho = twice(beside + rho);
    let r_1 = twice(s1 * c1 - lb * s1 * beside);
    let by_rho = twice(rho) * q + p * q_rho + d * d * r_rho;
    let by_z3 = twice(z3) * q;
    let by_d = twice(d) * r;
    [p * q_1 + d * d * r_1, by_rho * rho_2 + by_z3 * rho_3, by_rho * rho_3 + by_z3 * rho_3 + by_d * d_3]
}

/// A number together with its time derivative.
#[derive(Debug, Clone, Copy)]
struct Rate<T> {
    value: T,
    rate: T,
}

impl<T: Real> Add for Rate<T> {
    type Output = Self;
    fn add(self, other: Self) -> Self {
        Self { value: self.value + other.value, rate: self.rate + other.rate }
    }
}

impl<T: Real> Sub for Rate<T> {
    type Output = Self;
    fn sub(self, other: Self) -> Self {
        Self { value: self.value - other.value, rate: self.rate - other.rate }
    }
}

impl<T: Real> Mul for Rate<T> {
    type Output = Self;
    fn mul(self, other: Self) -> Self {
        Self { value: self.value * other.value, rate: self.rate * other.value + self.value * other.rate }
    }
}

impl<T: Real> Neg for Rate<T> {
    type Output = Self;
    fn neg(self) -> Self {
        Self { value: -self.value, rate: -self.rate }
    }
}
