//! Inverse kinematics at position level: all postures that put the tip at a point, for a given base pose.

use nalgebra::Vector3;

use crate::{Configuration, Real, Robot};

/// One posture that puts the tip where it was asked for.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct JointSolution<T> {
    /// Joint angles (q1, q2, q3), q1 in [-pi, pi), rad.
    pub joints: [T; 3],
    /// Whether the arm reaches forwards (rho >= 0) or over its back.
    pub facing: bool,
    /// Whether the elbow is above the line from shoulder to tip, seen along the reach.
    pub elbow_up: bool,
    /// Whether every joint is within its limits.
    pub within_limits: bool,
}

/// What inverse kinematics found.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum InverseKinematics<T> {
    /// The four branches: facing with the elbow up and down, then over the back with the elbow up and down.
    ///
    /// Where the arm is stretched or folded, the elbow's two branches coincide. Where the tip is on the yaw axis, q1 is free:
    /// it is given as 0 and `yaw_is_free` is true.
    Solutions {
        /// The branches.
        branches: [JointSolution<T>; 4],
        /// Whether the tip is on the yaw axis, so that every q1 does.
        yaw_is_free: bool,
    },
    /// No posture reaches the point.
    OutOfReach {
        /// Distance of the point from the shoulder, m.
        distance: T,
        /// Smallest and largest distance that the arm reaches, m.
        reach: (T, T),
    },
    /// The point or the base pose is infinite or NaN.
    NotFinite,
}

impl<T: Real> Robot<T, 3> {
    /// Finds all joint angles that put the tip at `tip`, the base standing at the pose of `base`.
    ///
    /// Equation: with (dx, dy, dz) from shoulder to tip in the base's directions and rho = +-sqrt(dx^2 + dy^2):
    /// q1 = atan2(+-dy, +-dx), cos q3 = (rho^2 + dz^2 - a2^2 - a3^2) / (2 a2 a3),
    /// q2 = atan2(dz, rho) - atan2(a3 sin q3, a2 + a3 cos q3). The joints of `base` are not used.
    ///
    /// Joint limits are reported for each branch and exclude none.
    #[must_use]
    pub fn inverse_kinematics(&self, base: &Configuration<T, 3>, tip: &Vector3<T>) -> InverseKinematics<T> {
        let p = self.params();
        let [link1, link2, link3] = &p.links;
        let (a2, a3) = (link2.length, link3.length);
        if !(base.is_finite() && tip.iter().all(|x| x.is_finite())) {
            return InverseKinematics::NotFinite;
        }
        let (sin, cos) = base.heading.sin_cos();
        let (wx, wy) = (tip.x - base.x, tip.y - base.y);
        let dx = wx * cos + wy * sin - p.arm_offset;
        let dy = wy * cos - wx * sin;
        let dz = tip.z - p.mount_height - link1.length;
        let radius = (dx * dx + dy * dy).sqrt();
        let squared = radius * radius + dz * dz;
        // A point on the edge of the reach must not be lost to rounding, nor one on the yaw axis: the sizes that went into
        // (dx, dy, dz) say how well it is known.
        let lengths = [base.x, base.y, p.arm_offset, p.mount_height, link1.length, a2, a3];
        let size = tip.iter().chain(&lengths).fold(T::ZERO, |sum, &x| sum + x.abs());
        let resolution = T::EPSILON * T::from_f64(8.0) * size;
        let slack = resolution * (a2 + a3) / (a2 * a3);
        let cos3 = (squared - a2 * a2 - a3 * a3) / (T::TWO * a2 * a3);
        if !(cos3.abs() - slack <= T::ONE) {
            return InverseKinematics::OutOfReach {
                distance: squared.sqrt(),
                reach: ((a2 - a3).abs(), a2 + a3),
            };
        }
        let bend = cos3.clamp_to(-T::ONE, T::ONE).acos();
        let yaw_is_free = !(radius > resolution);
        let yaw = if yaw_is_free { T::ZERO } else { dy.atan2(dx) };
        let branch = |facing: bool, elbow_up: bool| {
            let (q1, rho) =
                if facing { (yaw.wrap_to_pi(), radius) } else { ((yaw + T::PI).wrap_to_pi(), -radius) };
            // Bending down (q3 < 0) lifts the elbow, as long as the arm reaches forwards.
            let q3 = if elbow_up == facing { -bend } else { bend };
            let (s3, c3) = q3.sin_cos();
            let q2 = (dz.atan2(rho) - (a3 * s3).atan2(a2 + a3 * c3)).wrap_to_pi();
            let joints = [q1, q2, q3];
            JointSolution { joints, facing, elbow_up, within_limits: self.within_joint_limits(&joints) }
        };
        InverseKinematics::Solutions {
            branches: [branch(true, true), branch(true, false), branch(false, true), branch(false, false)],
            yaw_is_free,
        }
    }

    /// Lowest and highest tip that the arm reaches within its joint limits, m above the ground.
    ///
    /// Equation: extremes of `z_mount + a1 + a2 sin q2 + a3 sin(q2 + q3)` over the box of joint limits: for each q2 of a
    /// grid of 1,024 steps the best q3 is known in closed form. Resolution: below 1e-5 of a2 + a3.
    #[must_use]
    pub fn tip_height_range(&self) -> (T, T) {
        let p = self.params();
        let [link1, link2, link3] = &p.links;
        let [_, (lo2, hi2), (lo3, hi3)] = p.limits.joints;
        // More than a turn adds nothing.
        let hi2 = hi2.min(lo2 + T::TAU);
        let foot = p.mount_height + link1.length;
        let steps = 1024;
        let mut range: Option<(T, T)> = None;
        for i in 0..=steps {
            let q2 = lo2 + (hi2 - lo2) * T::from_f64(f64::from(i) / f64::from(steps));
            let base = foot + link2.length * q2.sin_cos().0;
            let (low, high) = sine_range(q2 + lo3, q2 + hi3);
            let (low, high) = (base + link3.length * low, base + link3.length * high);
            range = Some(range.map_or((low, high), |(a, b)| (a.min(low), b.max(high))));
        }
        range.unwrap_or((foot, foot))
    }
}

/// Smallest and largest sine over the angles from `lo` to `hi`.
fn sine_range<T: Real>(lo: T, hi: T) -> (T, T) {
    let (a, b) = (lo.sin_cos().0, hi.sin_cos().0);
    let quarter = T::PI * T::HALF;
    // Whether some top + 2 pi n lies in [lo, hi].
    let holds = |top: T| top + T::TAU * (((hi - top) / T::TAU).floor()) >= lo;
    let low = if holds(-quarter) { -T::ONE } else { a.min(b) };
    let high = if holds(quarter) { T::ONE } else { a.max(b) };
    (low, high)
}
