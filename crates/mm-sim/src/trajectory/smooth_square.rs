//! The square of Appendix B from exact constants, its joints blended: continuous acceleration, bounded jerk.
//!
//! Straights of 2 m and quarter arcs of radius 1 m at pi/10 m/s, so that a straight takes 20/pi s and an arc 5 s; after the
//! sixteenth piece straight on, as printed. The reference is the average of that motion over a window of time T about each
//! instant. A straight stays what it is; an arc of angular speed w keeps its centre and shrinks by sin(wT/2)/(wT/2); and
//! where the printed acceleration jumps by w^2 R, that of the average climbs within T: its jerk is at most w^2 R/T, and it
//! cuts the corner by at most w^2 R T^2/24.

use mm_control::Reference;
use mm_model::Real;
use nalgebra::Vector3;

/// Speed in m/s, and angular speed on the arcs of radius 1 m in rad/s.
const RATE: f64 = core::f64::consts::PI / 10.0;
const HEIGHT: f64 = 0.5;
/// Time on a straight of 2 m, s.
const STRAIGHT: f64 = 2.0 / RATE;
/// Time on a quarter of a circle, s.
const ARC: f64 = 5.0;
/// Way along x after which the wave repeats itself, m.
const WAVE: f64 = 8.0;

/// One piece of the wave, without its height.
#[derive(Debug, Clone, Copy)]
struct Piece {
    /// Where a straight starts, or the centre of an arc, m.
    from: [f64; 2],
    /// From an arc's centre to its start, m; nothing for a straight.
    out: Option<[f64; 2]>,
    /// Direction of travel at its start.
    ahead: [f64; 2],
}

const fn straight(from: [f64; 2], ahead: [f64; 2]) -> Piece {
    Piece { from, out: None, ahead }
}

const fn arc(center: [f64; 2], out: [f64; 2], ahead: [f64; 2]) -> Piece {
    Piece { from: center, out: Some(out), ahead }
}

/// One wave: up, over the top, down and through the bottom.
const PIECES: [Piece; 8] = [
    straight([0.0, 0.0], [0.0, 1.0]),
    arc([1.0, 2.0], [-1.0, 0.0], [0.0, 1.0]),
    straight([1.0, 3.0], [1.0, 0.0]),
    arc([3.0, 2.0], [0.0, 1.0], [1.0, 0.0]),
    straight([4.0, 2.0], [0.0, -1.0]),
    arc([5.0, 0.0], [-1.0, 0.0], [0.0, -1.0]),
    straight([5.0, -1.0], [1.0, 0.0]),
    arc([7.0, 0.0], [0.0, -1.0], [1.0, 0.0]),
];

/// Times at which the pieces of the two waves end, s.
const ENDS: [f64; 16] = {
    let mut ends = [0.0; 16];
    let (mut pairs, mut i) = (0.0, 0);
    while i < 16 {
        ends[i] = pairs * (STRAIGHT + ARC) + STRAIGHT;
        pairs += 1.0;
        ends[i + 1] = pairs * (STRAIGHT + ARC);
        i += 2;
    }
    ends
};

/// The piece of a number, its start in time and the way along x of its wave: the pieces of two waves, then a straight.
fn piece(number: usize) -> (&'static Piece, f64, f64) {
    const UP: Piece = straight([0.0, 0.0], [0.0, 1.0]);
    let start = number.checked_sub(1).and_then(|before| ENDS.get(before)).copied().unwrap_or(0.0);
    let x = WAVE * f64::from(u8::try_from(number / PIECES.len()).unwrap_or(2));
    (PIECES.get(number % PIECES.len()).unwrap_or(&UP), start, x)
}

/// The average of a piece's motion from time `a` to time `b`: that at the middle, on an arc nearer to the centre.
fn average(number: usize, a: f64, b: f64) -> Reference<f64> {
    let (piece, start, x) = piece(number);
    let vector = |[x, y]: [f64; 2]| Vector3::new(x, y, 0.0);
    let from = vector(piece.from) + Vector3::new(x, 0.0, HEIGHT);
    let ahead = vector(piece.ahead);
    let turned = RATE * (0.5 * (a + b) - start);
    let Some(out) = piece.out else {
        return Reference {
            position: from + ahead * turned,
            velocity: ahead * RATE,
            acceleration: Vector3::zeros(),
        };
    };
    let (sin, cos) = Real::sin_cos(turned);
    let half = 0.5 * RATE * (b - a);
    let nearer = if half > 0.0 { Real::sin_cos(half).0 / half } else { 1.0 };
    let out = vector(out);
    let (away, along) = ((out * cos + ahead * sin) * nearer, (ahead * cos - out * sin) * nearer);
    Reference { position: from + away, velocity: along * RATE, acceleration: away * -(RATE * RATE) }
}

/// Position, velocity and acceleration at time `t`, averaged over a window of time `window` about it.
///
/// Equation: the sum over the pieces within the window of (share of the window) times (average of the piece over its share).
/// Before time 0 the first straight comes from behind. A window of 0 gives the square itself.
pub(super) fn at(t: f64, window: f64) -> Reference<f64> {
    let (first, last) = (t - 0.5 * window, t + 0.5 * window);
    let mut number = ENDS.iter().position(|end| first < *end).unwrap_or(ENDS.len());
    let end_of = |number: usize| ENDS.get(number).copied().unwrap_or(f64::INFINITY);
    if last <= end_of(number) {
        return average(number, first, last);
    }
    let zero = Vector3::zeros();
    let mut sum = Reference { position: zero, velocity: zero, acceleration: zero };
    let (mut from, mut total) = (first, 0.0);
    while from < last {
        let until = last.min(end_of(number));
        let (part, share) = (average(number, from, until), until - from);
        sum.position += part.position * share;
        sum.velocity += part.velocity * share;
        sum.acceleration += part.acceleration * share;
        (from, number, total) = (until, number + 1, total + share);
    }
    // Over the sum of the shares, not the window: their difference by rounding would count the way from the origin.
    Reference {
        position: sum.position / total,
        velocity: sum.velocity / total,
        acceleration: sum.acceleration / total,
    }
}
