//! A curve through points with continuous first and second derivatives: a cubic spline.
//!
//! Between two points the curve is a cubic of a parameter u that grows by an interval of its own for each piece. At either end the
//! second derivative is given as a part of that at the next point: none of it is the natural spline, which straightens its ends;
//! all of it ends in parabolas. With many close points the natural one has to bend within its first piece, a third derivative that
//! grows as the points come closer. The equations for the second derivatives are diagonally dominant, however unequal the
//! intervals. Through two points the curve is the straight line.

use mm_model::Real;
use nalgebra::Vector3;

/// Parts of a piece over which the speed by u is bounded.
const PARTS: u8 = 16;

/// The cubic from one point to the next: c0 + c1 w + c2 w^2 + c3 w^3 with w = u - start.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Piece {
    start: f64,
    /// Interval of u.
    length: f64,
    c: [Vector3<f64>; 4],
}

/// A curve through points.
#[derive(Debug, Clone, PartialEq)]
pub struct Spline {
    pieces: Vec<Piece>,
}

impl Spline {
    /// The curve through points over intervals of u, all above 0, one for each two points in a row; its second derivative at
    /// either end is `end`, from 0 to 1, times that at the next point.
    #[must_use]
    pub fn through(points: &[Vector3<f64>], intervals: &[f64], end: f64) -> Self {
        let chords: Vec<(Vector3<f64>, f64)> = points
            .iter()
            .zip(points.iter().skip(1))
            .zip(intervals)
            .map(|((from, to), interval)| ((to - from) / *interval, *interval))
            .collect();
        let bends = second_derivatives(&chords, end);
        let mut start = 0.0;
        let ends = bends.iter().zip(bends.iter().skip(1));
        let pieces = points.iter().zip(&chords).zip(ends).map(|((from, (slope, length)), (here, next))| {
            let c1 = slope - (here * 2.0 + next) * (length / 6.0);
            let c = [*from, c1, here * 0.5, (next - here) / (6.0 * length)];
            let piece = Piece { start, length: *length, c };
            start += length;
            piece
        });
        Self { pieces: pieces.collect() }
    }

    /// Sum of the intervals.
    #[must_use]
    pub fn length(&self) -> f64 {
        self.pieces.last().map_or(0.0, |piece| piece.start + piece.length)
    }

    /// Position and its first two derivatives by u.
    #[must_use]
    pub fn at(&self, u: f64) -> [Vector3<f64>; 3] {
        let next = self.pieces.partition_point(|piece| piece.start <= u);
        let Some(piece) = self.pieces.get(next.saturating_sub(1)) else { return [Vector3::zeros(); 3] };
        let w = u - piece.start;
        let [c0, c1, c2, c3] = piece.c;
        [c0 + (c1 + (c2 + c3 * w) * w) * w, c1 + (c2 * 2.0 + c3 * (3.0 * w)) * w, c2 * 2.0 + c3 * (6.0 * w)]
    }

    /// Bounds on the norms of the first three derivatives by u, over the whole curve.
    #[must_use]
    pub fn bounds(&self) -> [f64; 3] {
        self.pieces.iter().fold([0.0; 3], |[b1, b2, b3], piece| {
            let [p1, p2, p3] = piece.bounds();
            [b1.max(p1), b2.max(p2), b3.max(p3)]
        })
    }

    /// The bounds of each piece by itself.
    pub(super) fn bounds_by_piece(&self) -> impl Iterator<Item = [f64; 3]> {
        self.pieces.iter().map(Piece::bounds)
    }
}

impl Piece {
    /// Bounds on the norms of the first three derivatives.
    ///
    /// The second derivative is linear and the third constant, so that their bounds are exact. The first is a quadratic and lies
    /// within the triangle of its control points: that gives a bound, near to exact on short parts.
    fn bounds(&self) -> [f64; 3] {
        let Self { length, c: [_, c1, c2, c3], .. } = *self;
        let norm = |v: Vector3<f64>| Real::sqrt(v.dot(&v));
        let speed = |w: f64| c1 + (c2 * 2.0 + c3 * (3.0 * w)) * w;
        let bend = |w: f64| c2 * 2.0 + c3 * (6.0 * w);
        let part = length / f64::from(PARTS);
        let of_part = |number: u8| {
            let w = f64::from(number) * part;
            norm(speed(w)).max(norm(speed(w) + bend(w) * (0.5 * part)))
        };
        let fastest = (0..PARTS).map(of_part).fold(norm(speed(length)), f64::max);
        [fastest, norm(bend(0.0)).max(norm(bend(length))), norm(c3 * 6.0)]
    }
}

/// Second derivatives by u at the points: those that make the first derivative continuous, and the parts of them at the ends.
///
/// Equation: h0 m0 + 2 (h0 + h1) m1 + h1 m2 = 6 (slope1 - slope0) for each two pieces in a row, by Thomas's algorithm.
fn second_derivatives(chords: &[(Vector3<f64>, f64)], end: f64) -> Vec<Vector3<f64>> {
    let zero = Vector3::zeros();
    if chords.len() < 2 {
        return vec![zero; 2];
    }
    // Forwards: each unknown is `constant - ratio * next`; the first one is that part of it.
    let (mut ratio, mut constant) = (-end, zero);
    let mut rows = vec![(ratio, constant)];
    for ((slope0, h0), (slope1, h1)) in chords.iter().zip(chords.iter().skip(1)) {
        let pivot = 2.0 * (h0 + h1) - h0 * ratio;
        constant = ((slope1 - slope0) * 6.0 - constant * *h0) / pivot;
        ratio = h1 / pivot;
        rows.push((ratio, constant));
    }
    // Backwards: the last one is that part of the one before.
    let mut next = constant * (end / (1.0 + end * ratio));
    let mut bends = vec![next];
    for (ratio, constant) in rows.iter().rev() {
        next = constant - next * *ratio;
        bends.push(next);
    }
    bends.reverse();
    bends
}
