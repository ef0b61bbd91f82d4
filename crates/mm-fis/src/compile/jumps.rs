//! Where a function of one number jumps.

/// A jump between two neighbouring inputs.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Jump {
    /// Where it is, in the unit of the input; found by halving the interval between the two inputs.
    pub at: f64,
    /// The 16-bit input below it.
    pub below: i32,
    /// Output at that input.
    pub from: f64,
    /// Output at the next input.
    pub to: f64,
}

/// Halvings of the interval: down to the spacing of double precision.
const HALVINGS: u32 = 48;

/// The jumps between `values` at neighbouring inputs, the first of which is `first`; `threshold` is the smallest that matters.
///
/// A difference is a jump if half of it remains, however small the interval is made around it; a steep slope vanishes.
pub(super) fn find(
    f: &dyn Fn(f64) -> f64,
    values: &[f64],
    (first, position): (i32, &dyn Fn(i32) -> f64),
    threshold: f64,
) -> Vec<Jump> {
    let mut jumps = Vec::new();
    for (below, pair) in (first..).zip(values.windows(2)) {
        let (from, to) = (pair[0], pair[1]);
        if (to - from).abs() <= threshold {
            continue;
        }
        let (mut low, mut high) = ((position(below), from), (position(below + 1), to));
        for _ in 0..HALVINGS {
            let x = 0.5 * low.0 + 0.5 * high.0;
            let middle = (x, f(x));
            if (middle.1 - low.1).abs() > (high.1 - middle.1).abs() {
                high = middle;
            } else {
                low = middle;
            }
        }
        if (high.1 - low.1).abs() > 0.5 * (to - from).abs() {
            jumps.push(Jump { at: high.0, below, from, to });
        }
    }
    jumps
}
