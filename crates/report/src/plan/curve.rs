//! Curves of few points.

/// The polyline without the points that lie within a twentieth of a pixel of a straight line.
pub(super) fn straightened(points: &[(f64, f64)]) -> Vec<(f64, f64)> {
    const INVISIBLE: f64 = 0.05;
    let mut kept: Vec<(f64, f64)> = points.first().copied().into_iter().collect();
    let mut start = 0;
    for end in 2..points.len() {
        let skipped = &points[start + 1..end];
        if skipped.iter().any(|point| distance(*point, points[start], points[end]) > INVISIBLE) {
            start = end - 1;
            kept.push(points[start]);
        }
    }
    if points.len() > 1 {
        kept.extend(points.last());
    }
    kept
}

/// Distance of `point` from the straight line through `from` and `to`; from `from` when these are one point.
fn distance(point: (f64, f64), from: (f64, f64), to: (f64, f64)) -> f64 {
    let (dx, dy) = (to.0 - from.0, to.1 - from.1);
    let (px, py) = (point.0 - from.0, point.1 - from.1);
    let length = (dx * dx + dy * dy).sqrt();
    // A curve that turns back on itself must not lose its turning point.
    let along = if length > 0.0 { (px * dx + py * dy) / length } else { 0.0 };
    if length == 0.0 || along < 0.0 || along > length {
        return (px * px + py * py).sqrt();
    }
    (px * dy - py * dx).abs() / length
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A triangle of 1 001 points is three.
    #[test]
    fn straight_lines_are_two_points_each() {
        let points: Vec<_> = (0..=1000).map(|k| (f64::from(k), f64::from(500 - (k - 500_i32).abs()))).collect();
        assert_eq!(straightened(&points), [(0.0, 0.0), (500.0, 500.0), (1000.0, 0.0)]);
        assert_eq!(straightened(&points[..1]), [(0.0, 0.0)]);
        assert_eq!(straightened(&[]), []);
    }

    /// A peak that is left by the way it came lies on a straight line.
    #[test]
    fn turning_points_stay() {
        let spike = [(0.0, 0.0), (1.0, 0.0), (1.0, 9.0), (1.0, 0.0), (2.0, 0.0)];
        assert_eq!(straightened(&spike), spike);
    }
}
