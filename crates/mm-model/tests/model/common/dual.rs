//! Forward-mode automatic differentiation: numbers that carry their derivatives by six coordinates, exactly.

use core::ops::{Add, Mul, Neg, Sub};
use mm_model::Real;

/// A value and its partial derivatives by (x, y, heading, q1, q2, q3).
#[derive(Debug, Clone, Copy)]
pub(crate) struct Dual {
    pub(crate) value: f64,
    pub(crate) by: [f64; 6],
}

impl Dual {
    pub(crate) const fn constant(value: f64) -> Self {
        Self { value, by: [0.0; 6] }
    }

    /// The coordinate of that index: its derivative by itself is one.
    pub(crate) fn coordinate(index: usize, value: f64) -> Self {
        let mut by = [0.0; 6];
        by[index] = 1.0;
        Self { value, by }
    }

    /// The chain rule: `value` with `slope` times the derivatives of this number.
    fn chain(self, value: f64, slope: f64) -> Self {
        Self { value, by: self.by.map(|d| slope * d) }
    }

    pub(crate) fn sin_cos(self) -> (Self, Self) {
        let (sin, cos) = Real::sin_cos(self.value);
        (self.chain(sin, cos), self.chain(cos, -sin))
    }
}

impl Add for Dual {
    type Output = Self;
    fn add(mut self, other: Self) -> Self {
        self.value += other.value;
        for (mine, theirs) in self.by.iter_mut().zip(other.by) {
            *mine += theirs;
        }
        self
    }
}

impl Neg for Dual {
    type Output = Self;
    fn neg(self) -> Self {
        self.chain(-self.value, -1.0)
    }
}

impl Sub for Dual {
    type Output = Self;
    fn sub(self, other: Self) -> Self {
        self + (-other)
    }
}

impl Mul for Dual {
    type Output = Self;
    fn mul(self, other: Self) -> Self {
        let mut by = self.by;
        for (mine, theirs) in by.iter_mut().zip(other.by) {
            *mine = *mine * other.value + self.value * theirs;
        }
        Self { value: self.value * other.value, by }
    }
}
