//! The square of Appendix B, as printed.
//!
//! Straights of 2 m and quarter arcs of radius 1 m at 0.31416 m/s, 0.5 m high. The printed constants are rounded: the position
//! jumps by up to 8.2e-5 m at the joints, and the acceleration by 0.0987 m/s^2, since straight and arc meet without a
//! transition. After the last arc the printed text goes straight on for ever.

use mm_control::Reference;
use mm_model::Real;
use nalgebra::Vector3;

/// Speed in m/s, and angular speed on the arcs of radius 1 m in rad/s.
const RATE: f64 = 0.31416;
const HEIGHT: f64 = 0.5;

/// One branch of the printed text.
enum Branch {
    /// `X = x + along * RATE * t`, `Y = y + up * RATE * t`.
    Straight { x: f64, along: f64, y: f64, up: f64 },
    /// With `a = RATE * (t - start)`: `X = x + xc cos a + xs sin a`, `Y = y + yc cos a + ys sin a`.
    Arc { start: f64, x: f64, xc: f64, xs: f64, y: f64, yc: f64, ys: f64 },
}

/// Upwards at a fixed X.
const fn up(x: f64, y: f64, direction: f64) -> Branch {
    Branch::Straight { x, along: 0.0, y, up: direction }
}

/// To the right at a fixed Y.
const fn right(x: f64, y: f64) -> Branch {
    Branch::Straight { x, along: 1.0, y, up: 0.0 }
}

/// The arc `X = x - cos a`, `Y = y + side sin a`.
const fn out_of_vertical(start: f64, x: f64, y: f64, side: f64) -> Branch {
    Branch::Arc { start, x, xc: -1.0, xs: 0.0, y, yc: 0.0, ys: side }
}

/// The arc `X = x + sin a`, `Y = y + side cos a`.
const fn into_vertical(start: f64, x: f64, y: f64, side: f64) -> Branch {
    Branch::Arc { start, x, xc: 0.0, xs: 1.0, y, yc: side, ys: 0.0 }
}

/// The branches with the times at which they end.
const BRANCHES: [(f64, Branch); 16] = [
    (6.36618, up(0.0, 0.0, 1.0)),
    (11.36618, out_of_vertical(6.36618, 1.0, 2.0, 1.0)),
    (17.73236, right(-2.5708, 3.0)),
    (22.73236, into_vertical(17.73236, 3.0, 2.0, 1.0)),
    (29.09855, up(4.0, 9.1416, -1.0)),
    (34.09855, out_of_vertical(29.09855, 5.0, 0.0, -1.0)),
    (40.46447, right(-5.7124, -1.0)),
    (45.46447, into_vertical(40.46447, 7.0, 0.0, -1.0)),
    (51.83065, up(8.0, -14.28312, 1.0)),
    (56.83065, out_of_vertical(51.83065, 9.0, 2.0, 1.0)),
    (63.19683, right(-8.85391, 3.0)),
    (68.19683, into_vertical(63.19683, 11.0, 2.0, 1.0)),
    (74.56301, up(12.0, 23.42472, -1.0)),
    (79.56301, out_of_vertical(74.56301, 13.0, 0.0, -1.0)),
    (85.92919, right(-11.99552, -1.0)),
    (90.92919, into_vertical(85.92919, 15.0, 0.0, -1.0)),
];

/// The branch after the last arc.
const LAST: Branch = up(16.0, -28.56631, 1.0);

/// Position, velocity and acceleration at time `t`.
pub(super) fn at(t: f64) -> Reference<f64> {
    let branch = BRANCHES.iter().find(|(end, _)| t <= *end).map_or(&LAST, |(_, branch)| branch);
    match *branch {
        Branch::Straight { x, along, y, up } => Reference {
            position: Vector3::new(x + along * RATE * t, y + up * RATE * t, HEIGHT),
            velocity: Vector3::new(along * RATE, up * RATE, 0.0),
            acceleration: Vector3::zeros(),
        },
        Branch::Arc { start, x, xc, xs, y, yc, ys } => {
            let (sin, cos) = Real::sin_cos(RATE * (t - start));
            let out = Vector3::new(xc * cos + xs * sin, yc * cos + ys * sin, 0.0);
            let ahead = Vector3::new(xs * cos - xc * sin, ys * cos - yc * sin, 0.0);
            Reference {
                position: out + Vector3::new(x, y, HEIGHT),
                velocity: ahead * RATE,
                acceleration: out * -(RATE * RATE),
            }
        }
    }
}
