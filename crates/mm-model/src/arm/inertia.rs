//! The equations of motion of base and arm, in closed form.
//!
//! The arm's own yaw rate `Omega = omega + dq1` replaces dq1 inside this file. In the velocities
//! (v, omega, Omega, dq2, dq3) the mass matrix has a constant diagonal base block and an arm block that splits into yaw
//! and pitch, and what the base and the arm exchange reduces to two mass moments, alpha and beta:
//!
//! ```text
//! M' = [ m     0          -alpha s1    -beta c1      -beta3 c1    ]
//!      [ .     J0         lb alpha c1  -lb beta s1   -lb beta3 s1 ]
//!      [ .     .          Theta        0             0            ]
//!      [ .     .          .            M44           M45          ]
//!      [ .     .          .            .             M55          ]
//! ```
//! The forces go back by f_omega = f'_omega + f'_Omega, f_1 = f'_Omega. Matrix and products are those of the sum over the
//! bodies, m J'J and m J'(dJ/dt + omega k x J), which the tests form literally.

use nalgebra::{Matrix2, Matrix2x3, Matrix3};

use super::ArmPosture;
use crate::robot::Lumped;
use crate::{Force, MassMatrix, Real, Velocity};

/// Posture-dependent terms of the equations of motion: everything that M, C and g share.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ArmInertia<T> {
    /// Sine and cosine of the arm's yaw.
    s1: T,
    c1: T,
    /// First mass moments about the yaw axis: A2 c2, A3 c23 and their sum alpha.
    a2c2: T,
    a3c23: T,
    alpha: T,
    /// First mass moments above the shoulder: A2 s2, beta3 = A3 s23 and their sum beta.
    a2s2: T,
    beta3: T,
    beta: T,
    /// Yaw inertia of the arm about its axis, and half its derivatives by q2 and q3.
    theta: T,
    half_theta_2: T,
    half_theta_3: T,
    /// Pitch block.
    m44: T,
    m45: T,
    /// m3 a2 com3 sin(q3): the centrifugal coupling of the two pitch joints.
    k23s3: T,
}

/// What the arm exchanges with the base at a pair of velocities: parts of C nu_r.
struct Exchange<T> {
    x: T,
    y: T,
    yaw: T,
}

impl<T: Real> ArmInertia<T> {
    #[inline(always)]
    pub(super) fn new(k: &Lumped<T>, posture: &ArmPosture<T>) -> Self {
        let ArmPosture { yaw, shoulder, forearm } = *posture;
        let elbow = forearm.minus(shoulder);
        let (a2c2, a3c23) = (k.moment2 * shoulder.cos, k.moment3 * forearm.cos);
        let (a2s2, beta3) = (k.moment2 * shoulder.sin, k.moment3 * forearm.sin);
        let (k22c2, k33c23) = (k.yaw22 * shoulder.cos, k.yaw33 * forearm.cos);
        let (k23c2, k23c23) = (k.yaw23 * shoulder.cos, k.yaw23 * forearm.cos);
        let half_theta_3 = -((k33c23 + k23c2) * forearm.sin);
        let k23c3 = k.yaw23 * elbow.cos;
        Self {
            s1: yaw.sin,
            c1: yaw.cos,
            a2c2,
            a3c23,
            alpha: a2c2 + a3c23,
            a2s2,
            beta3,
            beta: a2s2 + beta3,
            theta: k.yaw0 + shoulder.cos * (k22c2 + k23c23 + k23c23) + k33c23 * forearm.cos,
            half_theta_2: half_theta_3 - (k22c2 + k23c23) * shoulder.sin,
            half_theta_3,
            m44: k.pitch22 + k23c3 + k23c3,
            m45: k.pitch33 + k23c3,
            k23s3: k.yaw23 * elbow.sin,
        }
    }

    pub(super) fn mass_matrix(&self, k: &Lumped<T>) -> MassMatrix<T, 3> {
        let Self { s1, c1, alpha, beta, beta3, theta, .. } = *self;
        let lb = k.arm_offset;
        let across = -(alpha * s1);
        let m23 = theta + lb * alpha * c1;
        let zero = T::ZERO;
        MassMatrix {
            base: Matrix2::new(k.mass, across, across, k.base_yaw + m23 + lb * alpha * c1),
            coupling: Matrix2x3::new(
                across,
                -(beta * c1),
                -(beta3 * c1),
                m23,
                -(lb * beta * s1),
                -(lb * beta3 * s1),
            ),
            arm: Matrix3::new(theta, zero, zero, zero, self.m44, self.m45, zero, self.m45, k.pitch33),
        }
    }

    #[inline]
    pub(super) fn mass_product(&self, k: &Lumped<T>, a: &Velocity<T, 3>) -> Force<T, 3> {
        let [a1, a2, a3] = a.joints;
        let (v, omega, arm) = (a.forward, a.yaw_rate, a.yaw_rate + a1);
        let swing = self.alpha * arm;
        let stretch = -(self.a2s2 * a2 + self.beta3 * (a2 + a3));
        let lb_omega = k.arm_offset * omega;
        // The base's acceleration at the arm's foot, across the arm and along it.
        let across = lb_omega * self.c1 - v * self.s1;
        let along = v * self.c1 + lb_omega * self.s1;
        let yaw = self.alpha * across + self.theta * arm;
        Force {
            forward: k.mass * v - swing * self.s1 + stretch * self.c1,
            yaw: k.base_yaw * omega + k.arm_offset * (swing * self.c1 + stretch * self.s1) + yaw,
            joints: [
                yaw,
                self.m44 * a2 + self.m45 * a3 - self.beta * along,
                self.m45 * a2 + k.pitch33 * a3 - self.beta3 * along,
            ],
        }
    }

    #[inline(always)]
    pub(super) fn coriolis_product(
        &self,
        k: &Lumped<T>,
        nu: &Velocity<T, 3>,
        nu_r: &Velocity<T, 3>,
    ) -> Force<T, 3> {
        let ([d1, d2, d3], [r1, r2, r3]) = (nu.joints, nu_r.joints);
        let (omega, omega_r) = (nu.yaw_rate, nu_r.yaw_rate);
        let (arm, arm_r) = (omega + d1, omega_r + r1);
        let (d23, r23) = (d2 + d3, r2 + r3);
        let turn = arm * arm_r;
        let (shoulder, forearm) = (d2 * r2, d23 * r23);
        let exchange = {
            let radial = -(self.a2c2 * shoulder + self.a3c23 * forearm + self.alpha * turn);
            let rate = -(self.a2s2 * d2 + self.beta3 * d23);
            let rate_r = -(self.a2s2 * r2 + self.beta3 * r23);
            let tangential = arm * rate_r + arm_r * rate;
            let half_theta = self.half_theta_2 * d2 + self.half_theta_3 * d3;
            let half_theta_r = self.half_theta_2 * r2 + self.half_theta_3 * r3;
            Exchange {
                x: radial * self.c1 - tangential * self.s1,
                y: radial * self.s1 + tangential * self.c1,
                yaw: arm * half_theta_r + arm_r * half_theta,
            }
        };
        // The acceleration of the arm's foot, across the arm and, negated, along it.
        let (spin, slide) = (k.arm_offset * omega * omega_r, omega * nu_r.forward);
        let across = slide * self.c1 + spin * self.s1;
        let back = slide * self.s1 - spin * self.c1;
        let yaw = self.alpha * across + exchange.yaw;
        let pitch = self.k23s3 * shoulder;
        Force {
            forward: exchange.x - k.moment * omega * omega_r,
            yaw: k.moment * slide + k.arm_offset * exchange.y + yaw,
            joints: [
                yaw,
                pitch - self.k23s3 * forearm - self.beta * back - self.half_theta_2 * turn,
                pitch - self.beta3 * back - self.half_theta_3 * turn,
            ],
        }
    }

    #[inline]
    pub(super) fn coriolis_transpose_product(&self, k: &Lumped<T>, nu: &Velocity<T, 3>) -> Force<T, 3> {
        let [d1, d2, d3] = nu.joints;
        let (v, omega) = (nu.forward, nu.yaw_rate);
        let arm = omega + d1;
        let d23 = d2 + d3;
        let turn = arm * arm;
        let swing = self.alpha * arm;
        let stretch = -(self.a2s2 * d2 + self.beta3 * d23);
        let lb_omega = k.arm_offset * omega;
        let across = lb_omega * self.c1 - v * self.s1;
        let along = v * self.c1 + lb_omega * self.s1;
        // Momentum to the left of the base: what turning the base turns into forward momentum.
        let sideways = k.moment * omega + stretch * self.s1 + swing * self.c1;
        let lift = self.a3c23 * d23;
        Force {
            forward: omega * sideways,
            yaw: -(v * sideways),
            joints: [
                stretch * across - swing * along,
                self.half_theta_2 * turn - self.beta * arm * across - (self.a2c2 * d2 + lift) * along,
                self.half_theta_3 * turn - self.beta3 * arm * across - lift * along - self.k23s3 * d2 * d23,
            ],
        }
    }

    #[inline]
    pub(super) fn gravity(&self, k: &Lumped<T>) -> Force<T, 3> {
        Force {
            forward: T::ZERO,
            yaw: T::ZERO,
            joints: [T::ZERO, k.gravity * self.alpha, k.gravity * self.a3c23],
        }
    }

    pub(super) fn potential_energy(&self, k: &Lumped<T>) -> T {
        k.gravity * (k.height + self.beta)
    }

    /// Eliminates the base, whose block is constant and diagonal, then factorizes what is left of the arm as L D L'.
    #[inline(always)]
    pub(super) fn solve(&self, k: &Lumped<T>, force: &Force<T, 3>) -> Velocity<T, 3> {
        let Self { s1, c1, alpha, beta, beta3, .. } = *self;
        let [f1, f2, f3] = force.joints;
        let v_free = force.forward * k.inverse_mass;
        let omega_free = force.yaw - f1;
        let lb_omega = omega_free * k.offset_per_yaw;
        let (ss, cc) = (s1 * s1, c1 * c1);
        let (u, w) = (k.inverse_mass, k.offset2_per_yaw);
        let along = u * cc + w * ss;
        let mixed = s1 * c1 * (u - w);
        // Right-hand side of the arm, the base free.
        let pull = v_free * c1 + lb_omega * s1;
        let r1 = f1 + alpha * (v_free * s1 - lb_omega * c1);
        let r2 = f2 + beta * pull;
        let r3 = f3 + beta3 * pull;
        // Schur complement of the base.
        let s11 = self.theta - alpha * alpha * (u * ss + w * cc);
        let alpha_mixed = alpha * mixed;
        let s12 = -(alpha_mixed * beta);
        let s13 = -(alpha_mixed * beta3);
        let beta3_along = beta3 * along;
        let s22 = self.m44 - beta * beta * along;
        let s23 = self.m45 - beta * beta3_along;
        let s33 = k.pitch33 - beta3 * beta3_along;
        // L D L', forearm first.
        let d3 = T::ONE / s33;
        let (l32, l31) = (s23 * d3, s13 * d3);
        let (t22, t12) = (s22 - l32 * s23, s12 - l32 * s13);
        let y2 = r2 - l32 * r3;
        let d2 = T::ONE / t22;
        let l21 = t12 * d2;
        let t11 = s11 - l31 * s13 - l21 * t12;
        let arm = (r1 - l31 * r3 - l21 * y2) / t11;
        let dd2 = y2 * d2 - l21 * arm;
        let dd3 = r3 * d3 - l32 * dd2 - l31 * arm;
        // Back to the base.
        let (swing, stretch) = (alpha * arm, beta * dd2 + beta3 * dd3);
        let forward = v_free + u * (swing * s1 + stretch * c1);
        let yaw_rate = omega_free * k.inverse_base_yaw - k.offset_per_yaw * (swing * c1 - stretch * s1);
        Velocity { forward, yaw_rate, joints: [arm - yaw_rate, dd2, dd3] }
    }
}
