//! Vectors in the blocks of the robot: two numbers of the base, then one for each joint.

use crate::Real;

/// Where the robot is: the pose of the axle's midpoint in the world and the joint angles.
///
/// | field | meaning | unit |
/// | --- | --- | --- |
/// | `x`, `y` | midpoint of the wheel axle in the world frame | m |
/// | `heading` | direction of travel, counter-clockwise from the world's x axis (the thesis's bare q) | rad |
/// | `joints` | joint angles, base to tip | rad |
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(
    feature = "serde",
    serde(bound(serialize = "T: serde::Serialize", deserialize = "T: Copy + serde::Deserialize<'de>"))
)]
#[expect(missing_docs, reason = "the table above says what each field is")]
pub struct Configuration<T, const N: usize> {
    pub x: T,
    pub y: T,
    pub heading: T,
    #[cfg_attr(feature = "serde", serde(with = "crate::array"))]
    pub joints: [T; N],
}

impl<T: Real, const N: usize> Configuration<T, N> {
    /// The axle's midpoint at the origin, heading along x, every joint at zero.
    #[must_use]
    pub fn zero() -> Self {
        Self { x: T::ZERO, y: T::ZERO, heading: T::ZERO, joints: [T::ZERO; N] }
    }

    /// Whether no coordinate is infinite or NaN.
    #[must_use]
    #[inline]
    pub fn is_finite(&self) -> bool {
        all_finite([self.x, self.y, self.heading], &self.joints)
    }
}

/// Whether none of the numbers is infinite or NaN: a finite number times zero is zero, any other is NaN.
#[inline]
fn all_finite<T: Real, const N: usize>([a, b, c]: [T; 3], joints: &[T; N]) -> bool {
    joints.iter().fold((a * T::ZERO) + (b * T::ZERO) + (c * T::ZERO), |sum, &joint| sum + joint * T::ZERO)
        == T::ZERO
}

/// Defines a vector of two base channels and N joint channels with the arithmetic that the laws need.
macro_rules! block_vector {
    ($(#[$doc:meta])* $name:ident { $(#[$first_doc:meta])* $first:ident, $(#[$second_doc:meta])* $second:ident, $(#[$joints_doc:meta])* joints }) => {
        $(#[$doc])*
        #[derive(Debug, Clone, Copy, PartialEq)]
        #[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
        #[cfg_attr(
            feature = "serde",
            serde(bound(serialize = "T: serde::Serialize", deserialize = "T: Copy + serde::Deserialize<'de>"))
        )]
        pub struct $name<T, const N: usize> {
            $(#[$first_doc])*
            pub $first: T,
            $(#[$second_doc])*
            pub $second: T,
            $(#[$joints_doc])*
            #[cfg_attr(feature = "serde", serde(with = "crate::array"))]
            pub joints: [T; N],
        }

        impl<T: Real, const N: usize> $name<T, N> {
            /// The vector of zeros.
            #[must_use]
            #[inline]
            pub fn zero() -> Self {
                Self::splat(T::ZERO)
            }

            /// The vector with the same number in every channel.
            #[must_use]
            #[inline]
            pub fn splat(value: T) -> Self {
                Self { $first: value, $second: value, joints: [value; N] }
            }

            /// The vector of `f` of each channel.
            #[must_use]
            #[inline]
            pub fn map(self, mut f: impl FnMut(T) -> T) -> Self {
                Self { $first: f(self.$first), $second: f(self.$second), joints: self.joints.map(f) }
            }

            /// The vector of `f` of each channel of this vector and the same channel of another.
            #[must_use]
            #[inline]
            pub fn zip(self, other: Self, mut f: impl FnMut(T, T) -> T) -> Self {
                let $first = f(self.$first, other.$first);
                let $second = f(self.$second, other.$second);
                let mut joints = self.joints;
                for (mine, theirs) in joints.iter_mut().zip(other.joints) {
                    *mine = f(*mine, theirs);
                }
                Self { $first, $second, joints }
            }

            /// The sum of two vectors.
            #[must_use]
            #[inline]
            pub fn plus(self, other: Self) -> Self {
                self.zip(other, |a, b| a + b)
            }

            /// This vector less another.
            #[must_use]
            #[inline]
            pub fn minus(self, other: Self) -> Self {
                self.zip(other, |a, b| a - b)
            }

            /// This vector times a number.
            #[must_use]
            #[inline]
            pub fn scaled(self, factor: T) -> Self {
                self.map(|a| a * factor)
            }

            /// The channels in order: the two of the base, then the joints.
            #[inline]
            pub fn channels(&self) -> impl Iterator<Item = T> + '_ {
                [self.$first, self.$second].into_iter().chain(self.joints.iter().copied())
            }

            /// A channel by its number in that order; none beyond the last.
            #[must_use]
            #[inline]
            pub fn channel(&self, channel: usize) -> Option<T> {
                match channel {
                    0 => Some(self.$first),
                    1 => Some(self.$second),
                    _ => self.joints.get(channel - 2).copied(),
                }
            }

            /// The same, to change it.
            #[inline]
            pub fn channel_mut(&mut self, channel: usize) -> Option<&mut T> {
                match channel {
                    0 => Some(&mut self.$first),
                    1 => Some(&mut self.$second),
                    _ => self.joints.get_mut(channel - 2),
                }
            }

            /// The vector whose channels are the first 2 + N numbers of an iterator; zero where it ends early.
            #[must_use]
            #[inline]
            pub fn from_channels(mut values: impl Iterator<Item = T>) -> Self {
                let mut next = || values.next().unwrap_or(T::ZERO);
                let $first = next();
                let $second = next();
                let mut joints = [T::ZERO; N];
                for joint in &mut joints {
                    *joint = next();
                }
                Self { $first, $second, joints }
            }

            /// Whether no channel is infinite or NaN.
            #[must_use]
            #[inline]
            pub fn is_finite(&self) -> bool {
                all_finite([self.$first, self.$second, T::ZERO], &self.joints)
            }
        }
    };
}

block_vector! {
    /// Quasi-velocities nu of the robot, or their rates.
    ///
    /// The rates that the wheels leave free: x' = `forward` cos(heading), y' = `forward` sin(heading).
    Velocity {
        /// Forward speed of the axle's midpoint, m/s.
        forward,
        /// Yaw rate of the base, counter-clockwise positive, rad/s.
        yaw_rate,
        /// Joint rates, rad/s.
        joints
    }
}

block_vector! {
    /// Generalized forces along the quasi-velocities: what multiplies [`Velocity`] to give power.
    Force {
        /// Force along the direction of travel, N.
        forward,
        /// Moment about the vertical, on the base, N m.
        yaw,
        /// Joint torques, N m.
        joints
    }
}

block_vector! {
    /// Torques of the actuators.
    Torque {
        /// Right wheel, N m.
        right,
        /// Left wheel, N m.
        left,
        /// Joints, N m.
        joints
    }
}

impl<T: Real, const N: usize> Velocity<T, N> {
    /// Power of a generalized force at this velocity, W.
    #[must_use]
    #[inline]
    pub fn power(&self, force: &Force<T, N>) -> T {
        let joints =
            self.joints.iter().zip(&force.joints).fold(T::ZERO, |sum, (&rate, &torque)| sum + rate * torque);
        self.forward * force.forward + self.yaw_rate * force.yaw + joints
    }
}
