//! From a function of two numbers to a table of knots.

use mm_control::fuzzy::fixed::Surface2;

use super::CompileError;
use super::reach::{doubled, reachable};
use super::request::{Request, check_range};
use super::steps::Scale;
use super::surface1::widened;

/// Passes that move knots towards the middle of the errors around them.
const PASSES: usize = 12;
/// What these passes may gain at most; a table that is worse at first is given up.
const GAIN: f64 = 2.5;

/// A compiled surface of two inputs with what is known about it.
#[derive(Debug, Clone, PartialEq)]
pub struct CompiledSurface2 {
    /// Name of the system.
    pub name: String,
    /// Lower and upper end of each input.
    pub input_ranges: [(f64, f64); 2],
    /// Lower and upper end of the output; wider than the system's own where its outputs leave that.
    pub output_range: (f64, f64),
    /// Bits to which the inputs are rounded.
    pub input_bits: u32,
    /// Bits of a knot.
    pub bits: u32,
    /// Distances of the knots along each input: 2^shift points.
    pub shifts: [u32; 2],
    /// Whether it holds first inputs from the middle on alone.
    pub odd: bool,
    /// The knots, row by row; along a row the second input varies.
    pub knots: Vec<i16>,
    /// The bound that is met, in output units: the one asked for, or the one found.
    pub bound: f64,
    /// The largest error over all points of the inputs, in output units.
    pub error: f64,
    /// Where that is.
    pub error_at: [f64; 2],
}

impl CompiledSurface2 {
    /// The surface; it borrows the knots.
    #[must_use]
    pub fn surface(&self) -> Surface2<'_> {
        let columns = (1 << self.input_bits.saturating_sub(self.shifts[1]).min(16)) + 1;
        Surface2 { bits: self.input_bits, shifts: self.shifts, columns, knots: &self.knots, odd: self.odd }
    }

    /// Bytes in flash: two for a knot, 24 for what describes them.
    #[must_use]
    pub fn bytes(&self) -> usize {
        2 * self.knots.len() + 24
    }

    /// Compiles a function of two numbers over their ranges.
    ///
    /// Inputs are rounded to `input_bits` bits, so that there are (2^bits + 1)^2 points; the finished table is checked at each of them: the bound
    /// holds by construction for every input so rounded. Knots stand at distances of a power of two along each input; of those distances that
    /// lead to a table within the bound, starting from the samples and moving knots to balance the errors around them, it takes
    /// those with the fewest knots. An odd function to 10^-6 units gives a table of half the size.
    ///
    /// A function that jumps, or is steep, needs a knot for every point there. A bound asked for that cannot be met is refused; without
    /// one ([`Request::bound`]) the default is doubled until it is met.
    ///
    /// Cost: (2^bits + 1)^2 evaluations of `f`, on all cores.
    ///
    /// # Errors
    /// [`CompileError::Request`], [`CompileError::NotFinite`]; [`CompileError::Bound`] with a bound that can be met; [`CompileError::Knots`] for a
    /// limit below four knots.
    pub fn compile(
        name: &str,
        f: &(dyn Fn(&[f64]) -> f64 + Sync),
        (input_ranges, output_range): ([(f64, f64); 2], (f64, f64)),
        request: &Request,
    ) -> Result<Self, CompileError> {
        request.check()?;
        check_range("first input range", input_ranges[0])?;
        check_range("second input range", input_ranges[1])?;
        check_range("output range", output_range)?;
        let lattice = Lattice::of(f, input_ranges, output_range, request.input_bits)?;
        let whole = lattice.output.difference(65536.0);
        let attempt = |bound: f64| Some((bound, lattice.met(bound, request)?));
        let found = match request.bound {
            Some(bound) => attempt(bound),
            None => doubled(lattice.output.difference(128.0), whole, &attempt),
        };
        let Some((bound, Fitted { shifts, knots, error, at })) = found else {
            let max_knots = request.max_knots;
            let least = lattice.output.difference(0.25);
            let refused = request.bound.and_then(|bound| {
                let reachable = reachable(bound, (least, whole), &|bound| attempt(bound).is_some())?;
                Some(CompileError::Bound { bound, reachable, max_knots })
            });
            return Err(refused.unwrap_or(CompileError::Knots { max_knots, least: 4 }));
        };
        let at = lattice.position(at);
        Ok(Self {
            name: name.to_owned(),
            input_ranges,
            output_range: lattice.output_range,
            input_bits: request.input_bits,
            bits: request.bits,
            shifts,
            odd: lattice.odd,
            knots,
            bound,
            error: lattice.output.difference(error),
            error_at: at,
        })
    }
}

/// The function at all points, in steps of the output.
struct Lattice {
    inputs: [Scale; 2],
    output: Scale,
    output_range: (f64, f64),
    bits: u32,
    steps: Vec<f64>,
    odd: bool,
}

/// A table that was tried.
struct Fitted {
    shifts: [u32; 2],
    knots: Vec<i16>,
    /// In steps; only a lower bound of it where the table was given up.
    error: f64,
    at: [usize; 2],
}

impl Lattice {
    fn of(
        f: &(dyn Fn(&[f64]) -> f64 + Sync),
        input_ranges: [(f64, f64); 2],
        output_range: (f64, f64),
        bits: u32,
    ) -> Result<Self, CompileError> {
        let inputs = input_ranges.map(Scale::of);
        let side = (1_usize << bits) + 1;
        let place = |index: usize| (index as f64 / (side - 1) as f64 * 2.0 - 1.0) * 32768.0;
        let mut values = vec![0.0; side * side];
        let threads = std::thread::available_parallelism().map_or(1, usize::from);
        let rows = side.div_ceil(threads);
        std::thread::scope(|scope| {
            for (number, part) in values.chunks_mut(rows * side).enumerate() {
                scope.spawn(move || {
                    for (row, line) in part.chunks_mut(side).enumerate() {
                        let x = inputs[0].value(place(number * rows + row));
                        for (column, value) in line.iter_mut().enumerate() {
                            *value = f(&[x, inputs[1].value(place(column))]);
                        }
                    }
                });
            }
        });
        if let Some((index, &value)) = values.iter().enumerate().find(|(_, value)| !value.is_finite()) {
            let at = vec![inputs[0].value(place(index / side)), inputs[1].value(place(index % side))];
            return Err(CompileError::NotFinite { at, value });
        }
        let output_range = widened(output_range, values.iter().copied());
        let output = Scale::of(output_range);
        let steps: Vec<f64> = values.into_iter().map(|value| output.steps(value)).collect();
        let odd = steps.iter().zip(steps.iter().rev()).all(|(y, opposite)| (y + opposite).abs() <= 1e-6);
        Ok(Self { inputs, output, output_range, bits, steps, odd })
    }

    const fn side(&self) -> usize {
        (1 << self.bits) + 1
    }

    fn at(&self, [row, column]: [usize; 2]) -> f64 {
        self.steps[row * self.side() + column]
    }

    /// First row that the table holds.
    const fn first_row(&self) -> usize {
        if self.odd { 1 << (self.bits - 1) } else { 0 }
    }

    /// Knots along each input.
    fn knots_along(&self, [first, second]: [u32; 2]) -> [usize; 2] {
        [(1 << (self.bits - u32::from(self.odd) - first)) + 1, (1 << (self.bits - second)) + 1]
    }

    /// All pairs of distances within the limit on knots, by their number.
    fn shifts(&self, max_knots: usize) -> Vec<[u32; 2]> {
        let firsts = 0..=self.bits - u32::from(self.odd);
        let mut pairs: Vec<_> =
            firsts.flat_map(|first| (0..=self.bits).map(move |second| [first, second])).collect();
        let count = |shifts: &[u32; 2]| self.knots_along(*shifts).into_iter().product::<usize>();
        pairs.retain(|shifts| count(shifts) <= max_knots);
        pairs.sort_by_key(count);
        pairs
    }

    fn position(&self, [row, column]: [usize; 2]) -> [f64; 2] {
        let place = |index: usize| (index as f64 / (self.side() - 1) as f64 * 2.0 - 1.0) * 32768.0;
        [self.inputs[0].value(place(row)), self.inputs[1].value(place(column))]
    }

    /// The 16-bit input that is rounded to a point.
    fn input(&self, index: usize) -> i16 {
        let input = i32::try_from(index << (16 - self.bits)).map_or(i32::MAX, |input| input - 32768);
        i16::try_from(input).unwrap_or(i16::MAX)
    }

    /// The smallest table within a bound in output units.
    fn met(&self, bound: f64, request: &Request) -> Option<Fitted> {
        let steps = self.output.difference_in_steps(bound) * (1.0 + 1e-12);
        let fitted = |shifts| self.fitted(shifts, steps, request.knot_step());
        let mut tables = self.shifts(request.max_knots).into_iter().map(fitted);
        tables.find(|fitted| fitted.error <= steps)
    }

    /// A table with the given distances: samples, then knots moved to balance the errors around them, as long as that helps.
    fn fitted(&self, shifts: [u32; 2], bound: f64, step: i32) -> Fitted {
        let [rows, columns] = self.knots_along(shifts);
        let mut values: Vec<f64> = (0..rows * columns)
            .map(|index| {
                let row = self.first_row() + ((index / columns) << shifts[0]);
                self.at([row, (index % columns) << shifts[1]])
            })
            .collect();
        let mut best = self.measured(shifts, &values, step, GAIN * bound);
        for _ in 0..PASSES {
            if best.error <= bound || best.error > GAIN * bound {
                break;
            }
            self.balance(shifts, &mut values, step);
            let fitted = self.measured(shifts, &values, step, GAIN * bound);
            if fitted.error < best.error {
                best = fitted;
            }
        }
        best
    }

    fn rounded(&self, values: &[f64], step: i32) -> Vec<i16> {
        let step = f64::from(step);
        let lowest = if self.odd { -32767.0 } else { -32768.0 };
        #[expect(clippy::cast_possible_truncation, reason = "clamped to 16 bits just before")]
        let round = |value: &f64| {
            let (lowest, highest) = ((lowest / step).ceil() * step, (32767.0 / step).floor() * step);
            ((value / step).round() * step).clamp(lowest, highest) as i16
        };
        values.iter().map(round).collect()
    }

    /// The largest error of the rounded knots; given up beyond `hopeless`.
    fn measured(&self, shifts: [u32; 2], values: &[f64], step: i32, hopeless: f64) -> Fitted {
        let knots = self.rounded(values, step);
        let columns = u32::try_from(self.knots_along(shifts)[1]).unwrap_or(0);
        let surface = Surface2 { bits: self.bits, shifts, columns, knots: &knots, odd: self.odd };
        let (mut error, mut at) = (0.0, [0, 0]);
        'rows: for row in 0..self.side() {
            let first = self.input(row);
            for column in 0..self.side() {
                let y = surface.evaluate(first, self.input(column));
                let own = (f64::from(y) - self.at([row, column])).abs();
                if own > error {
                    (error, at) = (own, [row, column]);
                    if error > hopeless {
                        break 'rows;
                    }
                }
            }
        }
        Fitted { shifts, knots, error, at }
    }

    /// Moves every knot by a part of the middle of the errors in the cells around it.
    fn balance(&self, shifts: [u32; 2], values: &mut [f64], step: i32) {
        let knots = self.rounded(values, step);
        let [rows, columns] = self.knots_along(shifts);
        let surface = Surface2 {
            bits: self.bits,
            shifts,
            columns: u32::try_from(columns).unwrap_or(0),
            knots: &knots,
            odd: self.odd,
        };
        let mut spans = vec![(f64::INFINITY, f64::NEG_INFINITY); values.len()];
        for row in self.first_row()..self.side() {
            for column in 0..self.side() {
                let y = surface.evaluate(self.input(row), self.input(column));
                let off = self.at([row, column]) - f64::from(y);
                let own_row = row - self.first_row();
                for i in [own_row >> shifts[0], (own_row + (1 << shifts[0]) - 1) >> shifts[0]] {
                    for j in [column >> shifts[1], (column + (1 << shifts[1]) - 1) >> shifts[1]] {
                        let (low, high) = &mut spans[i.min(rows - 1) * columns + j.min(columns - 1)];
                        (*low, *high) = (low.min(off), high.max(off));
                    }
                }
            }
        }
        for (value, (low, high)) in values.iter_mut().zip(spans) {
            if low <= high {
                *value += 0.35 * (low + high);
            }
        }
    }
}
