//! The Riccati equation of the linear quadratic regulator for x'' = M^-1 f.

use mm_model::{Force, Real, Velocity};

use crate::SetupError;

/// A square matrix over the channels, by rows: rows are forces, columns velocities.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ChannelMatrix<T, const N: usize> {
    /// Row of the force along forward.
    pub forward: Velocity<T, N>,
    /// Row of the moment about the vertical.
    pub yaw: Velocity<T, N>,
    /// Rows of the joints.
    pub joints: [Velocity<T, N>; N],
}

impl<T: Real, const N: usize> ChannelMatrix<T, N> {
    /// The zero matrix.
    #[must_use]
    pub fn zero() -> Self {
        Self { forward: Velocity::zero(), yaw: Velocity::zero(), joints: [Velocity::zero(); N] }
    }

    /// The diagonal matrix of the given channels.
    #[must_use]
    pub fn diagonal(entries: impl Iterator<Item = T>) -> Self {
        let mut matrix = Self::zero();
        for (i, (row, entry)) in matrix.rows_mut().zip(entries).enumerate() {
            *row = unit(i).scaled(entry);
        }
        matrix
    }

    /// The matrix whose columns are the images of the unit vectors.
    #[must_use]
    pub fn from_columns(image: impl Fn(&Velocity<T, N>) -> Force<T, N>) -> Self {
        let mut columns = Self::zero();
        for (j, column) in columns.rows_mut().enumerate() {
            *column = Velocity::from_channels(image(&unit(j)).channels());
        }
        columns.transpose()
    }

    /// The product with a velocity.
    #[must_use]
    #[inline]
    pub fn product(&self, x: &Velocity<T, N>) -> Force<T, N> {
        Force::from_channels(self.rows().map(|row| dot(row, x)))
    }

    /// The rows in order.
    pub fn rows(&self) -> impl Iterator<Item = &Velocity<T, N>> {
        [&self.forward, &self.yaw].into_iter().chain(&self.joints)
    }

    fn rows_mut(&mut self) -> impl Iterator<Item = &mut Velocity<T, N>> {
        [&mut self.forward, &mut self.yaw].into_iter().chain(&mut self.joints)
    }

    fn transpose(&self) -> Self {
        let mut out = Self::zero();
        for (i, row) in out.rows_mut().enumerate() {
            *row = Velocity::from_channels(self.rows().map(|of| of.channels().nth(i).unwrap_or(T::ZERO)));
        }
        out
    }

    fn zip(&self, other: &Self, f: impl Fn(T, T) -> T) -> Self {
        let mut out = *self;
        for (row, by) in out.rows_mut().zip(other.rows()) {
            *row = row.zip(*by, &f);
        }
        out
    }

    fn plus(&self, other: &Self) -> Self {
        self.zip(other, |a, b| a + b)
    }

    fn minus(&self, other: &Self) -> Self {
        self.zip(other, |a, b| a - b)
    }

    fn scaled(&self, factor: T) -> Self {
        self.zip(self, |a, _| a * factor)
    }

    /// The product A B.
    fn times(&self, other: &Self) -> Self {
        let columns = other.transpose();
        let mut out = *self;
        for (row, mine) in out.rows_mut().zip(self.rows()) {
            *row = Velocity::from_channels(columns.rows().map(|column| dot(mine, column)));
        }
        out
    }

    fn trace(&self) -> T {
        self.diagonal_entries().channels().fold(T::ZERO, |sum, entry| sum + entry)
    }

    fn diagonal_entries(&self) -> Velocity<T, N> {
        Velocity::from_channels(
            self.rows().enumerate().map(|(i, row)| row.channels().nth(i).unwrap_or(T::ZERO)),
        )
    }

    /// Whether every entry a_ij is at most `part` of sqrt(r_i c_j): a bound that does not depend on units.
    fn is_below(&self, part: T, rows: &Velocity<T, N>, columns: &Velocity<T, N>) -> bool {
        let square = part * part;
        self.rows().zip(rows.channels()).all(|(row, r)| {
            row.channels().zip(columns.channels()).all(|(entry, c)| entry * entry <= square * (r * c))
        })
    }
}

fn unit<T: Real, const N: usize>(i: usize) -> Velocity<T, N> {
    Velocity::from_channels((0..2 + N).map(|j| if i == j { T::ONE } else { T::ZERO }))
}

fn dot<T: Real, const N: usize>(a: &Velocity<T, N>, b: &Velocity<T, N>) -> T {
    a.channels().zip(b.channels()).fold(T::ZERO, |sum, (a, b)| sum + a * b)
}

/// Optimal state feedback f = -K1 x - K2 x'.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct StateFeedback<T, const N: usize> {
    /// K1: force per integral of the velocity's error, N/m and N m/rad on the diagonal.
    pub position: ChannelMatrix<T, N>,
    /// K2: force per error of the velocity, N s/m and N m s/rad on the diagonal.
    pub velocity: ChannelMatrix<T, N>,
}

/// Steps after which the flow counts as not converging; default weights take some hundred.
const MOST_STEPS: u32 = 100_000;

impl<T: Real, const N: usize> StateFeedback<T, N> {
    /// The feedback that minimizes integral(x'Q1 x + x''Q2 x' + f'R f) for x'' = M^-1 f, all weights by Bryson's rule: the inverse squares of
    /// the largest acceptable values.
    ///
    /// The solution P = [P1 P2; P2' P3] is where the Riccati flow from P = 0,
    ///
    /// ```text
    /// P1' = Q1 - P2 G P2',   P2' = P1 - P2 G P3,   P3' = Q2 + P2 + P2' - P3 G P3,   G = M^-1 R^-1 M^-1,
    /// ```
    /// comes to rest; it is followed by explicit steps well inside its stability limit (1/4 over the sum of the closed loop's poles), whose
    /// error does not matter since only the rest point does. K1 = R^-1 M^-1 P2', K2 = R^-1 M^-1 P3.
    ///
    /// # Errors
    /// Weights so far apart that the flow does not come to rest in 100,000 steps.
    pub fn solve(
        inverse_inertia: &ChannelMatrix<T, N>,
        (position, velocity): (&Velocity<T, N>, &Velocity<T, N>),
        force: &Force<T, N>,
    ) -> Result<Self, SetupError> {
        let square = |x: T| x * x;
        let inverse_r = ChannelMatrix::diagonal(force.channels().map(square));
        let q1 = ChannelMatrix::diagonal(position.channels().map(|x| T::ONE / square(x)));
        let q2 = ChannelMatrix::diagonal(velocity.channels().map(|x| T::ONE / square(x)));
        let drive = inverse_r.times(inverse_inertia);
        let g = inverse_inertia.times(&drive);
        let start = q1.times(&g).trace().sqrt().sqrt();
        let (mut p1, mut p2, mut p3) = (ChannelMatrix::zero(), ChannelMatrix::zero(), ChannelMatrix::zero());
        for _ in 0..MOST_STEPS {
            let (p2g, p3g) = (p2.times(&g), p3.times(&g));
            let step = T::HALF * T::HALF / (start + p3g.trace());
            let (p2t, p3p2) = (p2.transpose(), p2g.times(&p3));
            let d1 = q1.minus(&p2g.times(&p2t));
            let d2 = p1.minus(&p3p2);
            let d3 = q2.plus(&p2).plus(&p2t).minus(&p3g.times(&p3));
            if !(step > T::ZERO) {
                break;
            }
            let (x1, x3) = (p1.diagonal_entries(), p3.diagonal_entries());
            let still = |change: &ChannelMatrix<T, N>, rows, columns| {
                change.scaled(step).is_below(T::from_f64(4.0) * T::EPSILON, rows, columns)
            };
            if still(&d1, &x1, &x1) && still(&d2, &x1, &x3) && still(&d3, &x3, &x3) {
                return Ok(Self { position: drive.times(&p2t), velocity: drive.times(&p3) });
            }
            p1 = p1.plus(&d1.scaled(step));
            p2 = p2.plus(&d2.scaled(step));
            p3 = p3.plus(&d3.scaled(step));
        }
        Err(SetupError::Riccati)
    }
}
