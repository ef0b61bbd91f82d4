//! Where the tip has been, in a bounded number of points.

/// Most points of a published trail, the newest one included.
pub(super) const MAX_POINTS: usize = 256;
/// Spacing of the points of a trail that has never been full, in nanoseconds.
const FIRST_SPACING_NS: u64 = 20_000_000;

/// A stamp in nanoseconds and a position in metres.
pub(super) type TrailPoint = (u64, [f64; 3]);

/// The path so far: points at a spacing in time that doubles whenever there are too many of them.
///
/// So a trail always spans the run from its start, and a message that carries it has a bounded size.
#[derive(Debug)]
pub(super) struct Trail {
    points: Vec<TrailPoint>,
    spacing_ns: u64,
}

impl Trail {
    /// A trail without points.
    pub(super) fn new() -> Self {
        Self { points: Vec::with_capacity(MAX_POINTS), spacing_ns: FIRST_SPACING_NS }
    }

    /// Adds a point if it is far enough, in time, from the last one kept.
    pub(super) fn offer(&mut self, stamp_ns: u64, position: [f64; 3]) {
        if !self.is_due(stamp_ns) {
            return;
        }
        if self.points.len() + 1 == MAX_POINTS {
            let mut index = 0_usize;
            self.points.retain(|_| {
                index += 1;
                index % 2 == 1
            });
            self.spacing_ns *= 2;
            if !self.is_due(stamp_ns) {
                return;
            }
        }
        self.points.push((stamp_ns, position));
    }

    /// The points kept, oldest first; at most one fewer than [`MAX_POINTS`].
    pub(super) fn points(&self) -> &[TrailPoint] {
        &self.points
    }

    fn is_due(&self, stamp_ns: u64) -> bool {
        self.points.last().is_none_or(|&(last, _)| stamp_ns >= last.saturating_add(self.spacing_ns))
    }
}

#[cfg(test)]
mod tests {
    use super::{FIRST_SPACING_NS, MAX_POINTS, Trail};

    #[test]
    fn a_trail_spans_the_run_in_a_bounded_number_of_points() {
        let mut trail = Trail::new();
        for millisecond in 0..600_000_u64 {
            trail.offer(millisecond * 1_000_000, [0.0; 3]);
            assert!(trail.points().len() < MAX_POINTS, "room for the newest point at {millisecond} ms");
        }
        let points = trail.points();
        assert!(points.len() >= MAX_POINTS / 2 - 1, "half full at least: {} points", points.len());
        assert_eq!(points[0].0, 0, "the start is kept");
        let spacing = points[1].0 - points[0].0;
        assert_eq!(spacing / FIRST_SPACING_NS, 128, "600 s at 255 points: 20 ms doubled seven times");
        assert!(points.windows(2).all(|pair| pair[1].0 - pair[0].0 == spacing), "even spacing");
    }

    #[test]
    fn samples_slower_than_the_spacing_are_all_kept() {
        let mut trail = Trail::new();
        for second in 0..100_u64 {
            trail.offer(second * 1_000_000_000, [0.0; 3]);
        }
        assert_eq!(trail.points().len(), 100, "one point a second");
    }
}
