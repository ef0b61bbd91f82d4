//! From a function of one number to a table of knots.

use mm_control::fuzzy::fixed::{Evaluate, Section, Surface1};

use super::CompileError;
use super::fit::{self, Band};
use super::jumps::{self, Jump};
use super::reach::reachable;
use super::request::{Request, check_range};
use super::steps::Scale;

/// A compiled surface of one input with what is known about it.
#[derive(Debug, Clone, PartialEq)]
pub struct CompiledSurface {
    /// Name of the system.
    pub name: String,
    /// Lower and upper end of the input.
    pub input_range: (f64, f64),
    /// Lower and upper end of the output; wider than the system's own where its outputs leave that.
    pub output_range: (f64, f64),
    /// Whether it holds positive inputs alone.
    pub odd: bool,
    /// The sections, the first included.
    pub sections: Vec<Section>,
    /// The knots.
    pub knots: Vec<i16>,
    /// Bits of a knot.
    pub bits: u32,
    /// The bound that was asked for, in output units.
    pub bound: f64,
    /// The largest error over all 65,536 inputs, in output units.
    pub error: f64,
    /// Where that is, in the unit of the input.
    pub error_at: f64,
    /// The jumps, each between two sections.
    pub jumps: Vec<Jump>,
}

impl CompiledSurface {
    /// The surface; it borrows the knots.
    #[must_use]
    pub fn surface(&self) -> Surface1<'_> {
        let none = Section { start: 0, knot: u32::MAX, shift: 0 };
        let (first, others) =
            self.sections.split_first().map_or((none, &[][..]), |(first, others)| (*first, others));
        Surface1 { first, others, knots: &self.knots, odd: self.odd }
    }

    /// The surface, stored for the rest of the program, as a control law needs it.
    #[must_use]
    pub fn leak(&self) -> Surface1<'static> {
        let Surface1 { first, others, knots, odd } = self.surface();
        Surface1 { first, others: Vec::leak(others.to_vec()), knots: Vec::leak(knots.to_vec()), odd }
    }

    /// Bytes in flash: two for a knot, twelve for a section.
    #[must_use]
    pub fn bytes(&self) -> usize {
        2 * self.knots.len() + 12 * self.sections.len()
    }

    /// Compiles a function of one number over a range.
    ///
    /// The error is checked at every one of the 65,536 inputs while the knots are chosen: the bound holds by construction. Of all tables with knots at
    /// distances of a power of two between jumps it is one with the fewest knots (values of knots are searched exhaustively
    /// for bounds up to 48 steps, and thinned out beyond), and with the smallest error among those of that size.
    ///
    /// Where the function is its own mirror image to 10^-6 units, the table is for positive inputs alone and exactly odd. Where it leaves the
    /// output range (a Sugeno system may), the range is widened about its middle.
    ///
    /// # Errors
    /// [`CompileError::Request`], [`CompileError::NotFinite`]; [`CompileError::Bound`] with a bound that can be met; [`CompileError::Knots`] for a
    /// limit below what any table takes.
    pub fn compile(
        name: &str,
        f: &dyn Fn(f64) -> f64,
        (input_range, output_range): ((f64, f64), (f64, f64)),
        request: &Request,
    ) -> Result<Self, CompileError> {
        request.check()?;
        check_range("input range", input_range)?;
        check_range("output range", output_range)?;
        let samples = Samples::of(f, input_range, output_range)?;
        let bound = request.bound.unwrap_or_else(|| samples.output.difference(32.0));
        Self::within(name, f, &samples, (bound, request))
            .ok_or_else(|| Self::refused(f, &samples, (bound, request)))
    }

    /// The table for a bound, if there is one.
    fn within(
        name: &str,
        f: &dyn Fn(f64) -> f64,
        samples: &Samples,
        (bound, request): (f64, &Request),
    ) -> Option<Self> {
        // Beyond the whole range every table is good.
        let bound_steps = samples.output.difference_in_steps(bound).min(65536.0);
        let jumps = samples.jumps(f, bound_steps);
        let with = |jumps| Self::with_jumps(name, samples, jumps, (bound, bound_steps), request);
        // A jump that lies within the bound may still be worth a section of its own.
        with(jumps.clone()).or_else(|| {
            let more = samples.jumps(f, bound_steps / 16.0);
            if more == jumps { None } else { with(more) }
        })
    }

    /// The table that is cut at these jumps, if there is one.
    fn with_jumps(
        name: &str,
        samples: &Samples,
        jumps: Vec<Jump>,
        (bound, bound_steps): (f64, f64),
        request: &Request,
    ) -> Option<Self> {
        let parts = samples.parts(&jumps);
        let found = Fitted::fewest(samples, &parts, bound_steps, request)?;
        let fitted = found.tightened(samples, &parts, bound_steps, request.knot_step());
        let (sections, knots) = fitted.joined(&parts);
        let mut compiled = Self {
            name: name.to_owned(),
            input_range: samples.input_range,
            output_range: samples.output_range,
            odd: samples.odd,
            sections,
            knots,
            bits: request.bits,
            bound,
            error: 0.0,
            error_at: samples.input.value(0.0),
            jumps,
        };
        compiled.measure(samples);
        let is_met = compiled.error <= bound * (1.0 + 1e-9) && compiled.knots.len() <= request.max_knots;
        is_met.then_some(compiled)
    }

    /// Why there is no table: a bound that can be met, or the number of knots that any table takes.
    fn refused(f: &dyn Fn(f64) -> f64, samples: &Samples, (bound, request): (f64, &Request)) -> CompileError {
        let (least, whole) = (samples.output.difference(0.25), samples.output.difference(65536.0));
        let max_knots = request.max_knots;
        let is_met = |bound| Self::within("", f, samples, (bound, request)).is_some();
        reachable(bound, (least, whole), &is_met).map_or_else(
            || {
                let unlimited = Request { max_knots: usize::MAX, ..*request };
                let smallest = Self::within("", f, samples, (whole, &unlimited));
                CompileError::Knots { max_knots, least: smallest.map_or(5, |table| table.knots.len()) }
            },
            |reachable| CompileError::Bound { bound, reachable, max_knots },
        )
    }

    /// Finds the largest error over all inputs by evaluating the finished table.
    fn measure(&mut self, samples: &Samples) {
        let mut worst = (0.0, 0);
        let surface = self.surface();
        for q in i16::MIN..=i16::MAX {
            let error = (f64::from(surface.evaluate(q)) - samples.at(q.into())).abs();
            if error > worst.0 {
                worst = (error, i32::from(q));
            }
        }
        self.error = samples.output.difference(worst.0);
        self.error_at = samples.input.value(worst.1.into());
    }
}

/// The function at all inputs, in steps of the output.
struct Samples {
    input_range: (f64, f64),
    input: Scale,
    output: Scale,
    output_range: (f64, f64),
    /// For the inputs -32768..=32768.
    steps: Vec<f64>,
    odd: bool,
}

impl Samples {
    fn of(
        f: &dyn Fn(f64) -> f64,
        input_range: (f64, f64),
        output_range: (f64, f64),
    ) -> Result<Self, CompileError> {
        let input = Scale::of(input_range);
        let values: Vec<f64> = (-32768..=32768).map(|q: i32| f(input.value(q.into()))).collect();
        if let Some((q, &value)) = (-32768..).zip(&values).find(|(_, value)| !value.is_finite()) {
            return Err(CompileError::NotFinite { at: vec![input.value(q.into())], value });
        }
        let output_range = widened(output_range, values.iter().copied());
        let output = Scale::of(output_range);
        let steps: Vec<f64> = values.into_iter().map(|value| output.steps(value)).collect();
        let odd = steps.iter().zip(steps.iter().rev()).all(|(y, mirrored)| (y + mirrored).abs() <= 1e-6);
        Ok(Self { input_range, input, output, output_range, steps, odd })
    }

    fn at(&self, q: i32) -> f64 {
        usize::try_from(q + 32768).ok().and_then(|index| self.steps.get(index)).copied().unwrap_or(0.0)
    }

    /// The inputs that the table holds.
    const fn domain(&self) -> (i32, i32) {
        if self.odd { (0, 32768) } else { (-32768, 32767) }
    }

    /// The jumps within the domain that are larger than half of the bound.
    fn jumps(&self, f: &dyn Fn(f64) -> f64, bound: f64) -> Vec<Jump> {
        let (first, last) = self.domain();
        let values: Vec<f64> = (first..=last).map(|q| self.output.value(self.at(q))).collect();
        let threshold = self.output.difference((0.5 * bound).max(2.0));
        jumps::find(f, &values, (first, &|q| self.input.value(q.into())), threshold)
    }

    /// The domain cut at the jumps, first and last input of each part; of an odd function without its 0 if it is alone.
    fn parts(&self, jumps: &[Jump]) -> Vec<(i32, i32)> {
        let (first, last) = self.domain();
        let starts = core::iter::once(first).chain(jumps.iter().map(|jump| jump.below + 1));
        let ends = jumps.iter().map(|jump| jump.below).chain(core::iter::once(last));
        starts.zip(ends).filter(|part| !(self.odd && *part == (0, 0))).collect()
    }

    /// What a part has to stay within.
    #[expect(clippy::cast_possible_truncation, reason = "clamped to 16 bits just before")]
    fn band(&self, (first, last): (i32, i32), bound: f64) -> Band {
        let least = if self.odd { -32767.0 } else { -32768.0 };
        let exact: Vec<f64> = (first..=last).map(|q| self.at(q)).collect();
        let zero = |q: i32| self.odd && q == 0;
        // The tolerance is that of the sum, far below a step; an upper end of exactly 32768 may come out as 32767.
        let low = |(q, y): (i32, &f64)| {
            if zero(q) { 0 } else { (y - bound - 1e-9).ceil().clamp(least, 32768.0) as i32 }
        };
        let high = |(q, y): (i32, &f64)| {
            if zero(q) { 0 } else { (y + bound + 1e-9).floor().clamp(-32769.0, 32767.0) as i32 }
        };
        let lowest = (first..).zip(&exact).map(low).collect();
        let highest = (first..).zip(&exact).map(high).collect();
        Band { lowest, highest, exact }
    }
}

/// The shift and the knots of each part.
struct Fitted(Vec<(u32, Vec<i16>)>);

impl Fitted {
    /// The fewest knots for each part, or `None` where there are none or too many.
    fn fewest(samples: &Samples, parts: &[(i32, i32)], bound: f64, request: &Request) -> Option<Self> {
        let mut left = request.max_knots;
        let mut fitted = Vec::new();
        for &part in parts {
            let band = samples.band(part, bound);
            let length = band.exact.len();
            let most = length.next_power_of_two().ilog2().min(14);
            let found = (0..=most)
                .rev()
                .take_while(|shift| (length - 1) >> shift < left)
                .find_map(|shift| Some((shift, fit::knots(&band, shift, request.knot_step())?)))?;
            left = left.checked_sub(found.1.len())?;
            fitted.push(found);
        }
        Some(Self(fitted))
    }

    /// The same number of knots with a smaller error, where that is possible.
    fn tightened(mut self, samples: &Samples, parts: &[(i32, i32)], bound: f64, step: i32) -> Self {
        for (&part, fitted) in parts.iter().zip(&mut self.0) {
            let (mut fails, mut meets) = (0.0, bound);
            for _ in 0..5 {
                let middle = 0.5 * (fails + meets);
                match fit::knots(&samples.band(part, middle), fitted.0, step) {
                    Some(knots) => (meets, fitted.1) = (middle, knots),
                    None => fails = middle,
                }
            }
        }
        self
    }

    /// All sections and knots, and a neighbour for the last one.
    fn joined(self, parts: &[(i32, i32)]) -> (Vec<Section>, Vec<i16>) {
        let (mut sections, mut knots) = (Vec::new(), Vec::new());
        let mut needs_neighbour = false;
        for (&(start, end), (shift, own)) in parts.iter().zip(self.0) {
            let knot = u32::try_from(knots.len()).unwrap_or(u32::MAX);
            sections.push(Section { start, knot, shift: 14 - shift });
            needs_neighbour = (end - start) % (1 << shift) == 0;
            knots.extend(own);
        }
        if let Some(&last) = knots.last().filter(|_| needs_neighbour) {
            knots.push(last);
        }
        (sections, knots)
    }
}

/// The range, widened about its middle to hold all values.
pub(super) fn widened((lo, hi): (f64, f64), values: impl Iterator<Item = f64>) -> (f64, f64) {
    let (middle, half) = (0.5 * lo + 0.5 * hi, 0.5 * hi - 0.5 * lo);
    let reach = values.fold(half, |reach, value| reach.max((value - middle).abs()));
    if reach <= half * (1.0 + 1e-12) { (lo, hi) } else { (middle - reach, middle + reach) }
}
