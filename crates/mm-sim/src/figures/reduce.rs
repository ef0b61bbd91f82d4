//! Fewer points for the same picture.

/// A point on the canvas, px.
pub(crate) type Pixel = (f64, f64);

/// Deviation from the full curve that nobody sees, px.
const INVISIBLE: f64 = 0.12;

/// Indices of the points to draw of a function of the horizontal axis: in each pixel column the first, the last, the lowest
/// and the highest point, so that chatter keeps its full height; then without those on a straight line.
pub(crate) fn function(points: &[Pixel]) -> Vec<usize> {
    let mut kept = Vec::new();
    let mut begin = 0;
    while let Some(first) = points.get(begin) {
        let column = first.0.floor();
        let length = points.iter().skip(begin).take_while(|point| point.0 < column + 1.0).count().max(1);
        let inside = begin..begin + length;
        let height = |i: &usize| points.get(*i).map_or(0.0, |point| point.1);
        let low = inside.clone().min_by(|a, b| height(a).total_cmp(&height(b)));
        let high = inside.clone().max_by(|a, b| height(a).total_cmp(&height(b)));
        let mut column = [Some(begin), low, high, Some(begin + length - 1)];
        column.sort_unstable();
        kept.extend(column.into_iter().flatten());
        begin += length;
    }
    kept.dedup();
    straight(points, kept)
}

/// Indices of the points to draw of a curve that may turn back.
pub(crate) fn path(points: &[Pixel]) -> Vec<usize> {
    straight(points, (0..points.len()).collect())
}

/// Drops the points that lie on the line between those kept (Ramer, Douglas, Peucker).
fn straight(points: &[Pixel], chosen: Vec<usize>) -> Vec<usize> {
    let at = |i: usize| chosen.get(i).and_then(|&index| points.get(index)).copied().unwrap_or_default();
    let Some(last) = chosen.len().checked_sub(1) else { return chosen };
    let mut keep = vec![false; chosen.len()];
    let mut open = vec![(0, last)];
    while let Some((from, to)) = open.pop() {
        for end in [from, to] {
            if let Some(flag) = keep.get_mut(end) {
                *flag = true;
            }
        }
        let farthest = (from + 1..to)
            .map(|i| (distance(at(i), at(from), at(to)), i))
            .max_by(|(a, _), (b, _)| a.total_cmp(b));
        if let Some((far, i)) = farthest
            && far > INVISIBLE
        {
            open.push((from, i));
            open.push((i, to));
        }
    }
    chosen.into_iter().zip(keep).filter_map(|(index, keep)| keep.then_some(index)).collect()
}

/// Distance of a point from the segment between two others.
fn distance(p: Pixel, a: Pixel, b: Pixel) -> f64 {
    let (dx, dy) = (b.0 - a.0, b.1 - a.1);
    let (px, py) = (p.0 - a.0, p.1 - a.1);
    let squared = dx * dx + dy * dy;
    let along = if squared > 0.0 { ((px * dx + py * dy) / squared).clamp(0.0, 1.0) } else { 0.0 };
    let (ex, ey) = (px - along * dx, py - along * dy);
    mm_model::Real::sqrt(ex * ex + ey * ey)
}

#[cfg(test)]
mod tests {
    use super::{Pixel, distance, function, path};

    #[test]
    fn chatter_keeps_its_height_in_every_column() {
        // A relay at 100 samples a pixel, with one spike.
        let points: Vec<Pixel> = (0..10_000)
            .map(|i| {
                let height = if i == 5432 { 9.0 } else { f64::from(i % 2) };
                (f64::from(i) * 0.01, height)
            })
            .collect();
        let kept = function(&points);
        assert!(kept.len() <= 4 * 101, "{} points for 100 columns", kept.len());
        assert!(kept.contains(&5432), "the spike is kept");
        for column in 0..100 {
            let heights: Vec<f64> = kept
                .iter()
                .map(|&i| points[i])
                .filter(|p| (p.0.floor() - f64::from(column)).abs() < 0.5)
                .map(|p| p.1)
                .collect();
            let low = heights.iter().copied().fold(f64::INFINITY, f64::min);
            let high = heights.iter().copied().fold(f64::NEG_INFINITY, f64::max);
            assert!(low <= 0.0 && high >= 1.0, "column {column} spans {low} to {high}");
        }
    }

    #[test]
    fn no_point_is_farther_than_a_fraction_of_a_pixel_from_what_is_drawn() {
        let points: Vec<Pixel> = (0..3000)
            .map(|i| {
                let (sin, cos) = mm_model::Real::sin_cos(f64::from(i) * 0.01);
                (300.0 + 10.0 * f64::from(i) * 0.01 * cos, 300.0 + 10.0 * f64::from(i) * 0.01 * sin)
            })
            .collect();
        let kept = path(&points);
        assert!(kept.len() < 600, "{} of 3000 points are enough", kept.len());
        assert_eq!((kept[0], kept[kept.len() - 1]), (0, 2999), "both ends stay");
        for pair in kept.windows(2) {
            for i in pair[0]..pair[1] {
                let off = distance(points[i], points[pair[0]], points[pair[1]]);
                assert!(off <= 0.12, "point {i} is {off} px off");
            }
        }
    }

    #[test]
    fn a_straight_line_is_two_points_and_nothing_is_nothing() {
        let points: Vec<Pixel> = (0..1000).map(|i| (f64::from(i), 2.0 * f64::from(i))).collect();
        assert_eq!(function(&points), [0, 999], "a line");
        assert_eq!(path(&points[..1]), [0], "a point");
        assert!(function(&[]).is_empty() && path(&[]).is_empty(), "no points");
    }
}
