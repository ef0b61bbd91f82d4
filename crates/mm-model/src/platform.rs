//! The two driven wheels: speeds, constraints and the input map.

use nalgebra::{SMatrix, matrix};

use crate::{Angle, Force, Real, Robot, Torque, Velocity};

/// Rates of the two wheels.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct WheelRates<T> {
    /// Right wheel, rad/s, positive forwards.
    pub right: T,
    /// Left wheel, rad/s, positive forwards.
    pub left: T,
}

impl<T: Real, const N: usize> Robot<T, N> {
    /// Rates of the wheels at forward speed v and yaw rate omega (3.33, 3.34).
    ///
    /// Equation: w_r = (v + l omega)/r, w_l = (v - l omega)/r, with l half the track. Turning counter-clockwise, the right
    /// wheel is the faster one.
    #[must_use]
    #[inline]
    pub fn wheel_rates(&self, forward: T, yaw_rate: T) -> WheelRates<T> {
        let turn = self.lumped.half_track * yaw_rate;
        let k = self.lumped.inverse_radius;
        WheelRates { right: (forward + turn) * k, left: (forward - turn) * k }
    }

    /// Forward speed and yaw rate at given rates of the wheels (3.23).
    ///
    /// Equation: v = r (w_r + w_l)/2, omega = r (w_r - w_l)/(2 l).
    #[must_use]
    pub fn base_speed(&self, rates: WheelRates<T>) -> (T, T) {
        let half_radius = self.params().wheel_radius * T::HALF;
        (
            half_radius * (rates.right + rates.left),
            half_radius * (rates.right - rates.left) / self.lumped.half_track,
        )
    }

    /// Input map: generalized force f = B tau of actuator torques.
    ///
    /// Equation: f_v = (tau_r + tau_l)/r, f_omega = l (tau_r - tau_l)/r, joints one to one. This is S'E of (3.95) with its
    /// yaw row mended to +-l/r.
    #[must_use]
    #[inline]
    pub fn force_of(&self, torque: &Torque<T, N>) -> Force<T, N> {
        let k = self.lumped.inverse_radius;
        Force {
            forward: (torque.right + torque.left) * k,
            yaw: (torque.right - torque.left) * self.lumped.track_per_radius,
            joints: torque.joints,
        }
    }

    /// Inverse of the input map: actuator torques tau = B^-1 f.
    ///
    /// Equation: tau_r = r (f_v + f_omega/l)/2, tau_l = r (f_v - f_omega/l)/2.
    #[must_use]
    #[inline]
    pub fn torque_of(&self, force: &Force<T, N>) -> Torque<T, N> {
        let push = force.forward * self.lumped.half_radius;
        let turn = force.yaw * self.lumped.radius_per_track;
        Torque { right: push + turn, left: push - turn, joints: force.joints }
    }

    /// Friction of wheels and joints as a generalized force on the left-hand side: along the motion.
    ///
    /// Equation: see [`Friction`](crate::Friction); the wheels' torques go through the input map.
    #[must_use]
    #[inline]
    pub fn friction(&self, nu: &Velocity<T, N>) -> Force<T, N> {
        if self.lumped.frictionless {
            return Force::zero();
        }
        let f = &self.params().friction;
        let drag = |rate: T, viscous: T, coulomb: T| {
            viscous * rate + coulomb * rate / (rate * rate + f.smoothing * f.smoothing).sqrt()
        };
        let wheels = self.wheel_rates(nu.forward, nu.yaw_rate);
        let mut joints = nu.joints;
        for ((rate, &viscous), &coulomb) in joints.iter_mut().zip(&f.joint_viscous).zip(&f.joint_coulomb) {
            *rate = drag(*rate, viscous, coulomb);
        }
        self.force_of(&Torque {
            right: drag(wheels.right, f.wheel_viscous, f.wheel_coulomb),
            left: drag(wheels.left, f.wheel_viscous, f.wheel_coulomb),
            joints,
        })
    }

    /// Constraint matrix A of the base with its wheel angles (3.31), for coordinates (x_c, y_c, heading, wheel_r, wheel_l).
    ///
    /// (x_c, y_c) is the base's centre of mass, d ahead of the axle: A dq/dt = 0 says that it does not slip sideways, and
    /// that neither wheel slips forwards. The printed third row repeats the second; mended, the matrix has rank 3.
    #[must_use]
    pub fn wheel_constraint_matrix(&self, heading: Angle<T>) -> SMatrix<T, 3, 5> {
        let Angle { sin, cos } = heading;
        let (d, l, r, zero) =
            (self.params().base_com_offset, self.lumped.half_track, self.params().wheel_radius, T::ZERO);
        matrix![
            -sin, cos, -d, zero, zero;
            cos, sin, l, -r, zero;
            cos, sin, -l, zero, -r
        ]
    }

    /// Velocity map S of the base with its wheel angles (before 3.32): dq/dt = S (w_r, w_l), with A S = 0.
    #[must_use]
    pub fn wheel_velocity_map(&self, heading: Angle<T>) -> SMatrix<T, 5, 2> {
        let Angle { sin, cos } = heading;
        let (d, l) = (self.params().base_com_offset, self.lumped.half_track);
        let k = self.params().wheel_radius / (T::TWO * l);
        matrix![
            k * (l * cos - d * sin), k * (l * cos + d * sin);
            k * (l * sin + d * cos), k * (l * sin - d * cos);
            k, -k;
            T::ONE, T::ZERO;
            T::ZERO, T::ONE
        ]
    }
}

impl<T: Real> Robot<T, 3> {
    /// Constraint matrix A of base and arm (3.91), for coordinates (x, y, heading, q1, q2, q3) of the axle's midpoint.
    ///
    /// The third entry, printed as -1, is 0 at the axle: the axle's midpoint does not slip sideways.
    #[must_use]
    pub fn constraint_matrix(heading: Angle<T>) -> SMatrix<T, 1, 6> {
        let zero = T::ZERO;
        matrix![-heading.sin, heading.cos, zero, zero, zero, zero]
    }

    /// Velocity map S of base and arm (3.92): dq/dt = S nu, with A S = 0.
    ///
    /// In the quasi-velocities nu in place of the wheel rates, and with the yaw row's sign mended.
    #[must_use]
    pub fn velocity_map(heading: Angle<T>) -> SMatrix<T, 6, 5> {
        let mut s = SMatrix::<T, 6, 5>::zeros();
        s.fixed_view_mut::<2, 1>(0, 0).copy_from(&matrix![heading.cos; heading.sin]);
        s.fixed_view_mut::<4, 4>(2, 1).fill_with_identity();
        s
    }
}
