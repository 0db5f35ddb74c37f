//! The last edge of an encoder: the time at which its signals passed from one increment to the next.
//!
//! ```text
//! edges at (n + 1/2)·q      time since one between two ticks: h·(s(k) − s_e)/(s(k) − s(k−1))
//! ```
//! s is the position that is counted in increments, with all errors before that. Between two ticks it is a line, which is exact at constant
//! speed; an acceleration a moves the edge by up to a·h²/8 of position: of second order in the tick.

use servobench_base::Stateful;
/// The last edge.
#[derive(Debug, Clone, Copy, PartialEq, Stateful)]
pub struct Edge {
    /// Time since the edge (s).
    pub age: f64,
    /// Position of the edge relative to the reading: half an increment in one direction or the other.
    pub offset: f64,
}

/// Timing of edges; its state from tick to tick.
#[derive(Debug, Clone, Copy, PartialEq, Default, Stateful)]
pub(super) struct Timing {
    /// Position at the last tick, and the increments that were read then.
    last: Option<(f64, f64)>,
    edge: Option<Edge>,
}

impl Timing {
    /// The last edge at a tick, `h` (s) after the last one, with the position `position` and the reading of `count` increments of
    /// `step`; none before the first one.
    pub(super) fn read(&mut self, position: f64, count: f64, step: f64, h: f64) -> Option<Edge> {
        if let Some(edge) = &mut self.edge {
            edge.age += h;
        }
        if let Some((before, last_count)) = self.last.replace((position, count))
            && (count - last_count).abs() > 0.5
        {
            let offset = if count > last_count { -0.5 } else { 0.5 } * step;
            let beyond = (position - (count * step + offset)) / (position - before);
            self.edge = Some(Edge { age: h * beyond.clamp(0.0, 1.0), offset });
        }
        self.edge
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const STEP: f64 = 1.7e-3;

    /// Largest and effective error of the age over the edges of `position`, whose instants are those of `instant(border)`.
    fn error(position: impl Fn(f64) -> f64, instant: impl Fn(f64) -> f64, h: f64, until: f64) -> [f64; 2] {
        let (mut timing, mut worst, mut squares, mut found) = (Timing::default(), 0.0_f64, 0.0, 0);
        let mut k = 0.0;
        while k * h < until {
            let x = position(k * h);
            let count = (x / STEP).round();
            if let Some(edge) = timing.read(x, count, STEP, h) {
                let border = count * STEP + edge.offset;
                let error = k * h - edge.age - instant(border);
                worst = worst.max(error.abs());
                squares += error * error;
                found += 1;
            }
            k += 1.0;
        }
        assert!(found > 100);
        [worst, (squares / f64::from(found)).sqrt()]
    }

    /// Oracle: x = v·t passes a border b at b/v, exactly except for roundings, in both directions and at any number of edges per tick.
    #[test]
    fn edges_of_a_constant_speed_are_timed_exactly() {
        for v in [0.731, -3.3, 27.9, -313.7] {
            let [worst, _] = error(|t| v * t, |border| border / v, 62.5e-6, 0.4);
            // The age is a sum of up to 37 ticks; positions of up to 130 over speeds.
            assert!(worst < 1e-12, "{v}: {worst}");
        }
    }

    /// Oracle: x = v·t + a·t²/2, whose borders are passed at the root of a quadratic: the error is up to a·h²/(8·v), of order two.
    #[test]
    fn edges_of_a_ramp_are_timed_with_order_two() {
        let (v, a) = (2.1, 57.0);
        let found = |h: f64| {
            let instant = |border: f64| 2.0 * border / (v + (v * v + 2.0 * a * border).sqrt());
            error(|t| v * t + a * t * t / 2.0, instant, h, 0.3)
        };
        let ([worst, coarse], [_, fine]) = (found(1e-4), found(5e-5));
        // Effective values: the place of an edge within a tick is random at every step.
        let order = (coarse / fine).log2();
        assert!((order - 2.0).abs() < 0.05, "{order}");
        let bound = a * 1e-8 / (8.0 * v);
        assert!(worst < bound && worst > 0.6 * bound, "{worst} {bound}");
    }

    #[test]
    fn there_is_none_before_the_first_edge_and_it_grows_old() {
        let (mut timing, h) = (Timing::default(), 1e-3);
        assert_eq!(timing.read(0.1 * STEP, 0.0, STEP, h), None);
        assert_eq!(timing.read(0.4 * STEP, 0.0, STEP, h), None);
        let edge = timing.read(0.6 * STEP, 1.0, STEP, h).unwrap();
        assert!((edge.age - 0.5e-3).abs() < 1e-15 && (edge.offset + 0.5 * STEP).abs() < 1e-18, "{edge:?}");
        let later = timing.read(0.6 * STEP, 1.0, STEP, h).unwrap();
        assert!((later.age - 1.5e-3).abs() < 1e-15 && later.offset < 0.0);
        let back = timing.read(0.4 * STEP, 0.0, STEP, h).unwrap();
        assert!((back.age - 0.5e-3).abs() < 1e-15 && (back.offset - 0.5 * STEP).abs() < 1e-18, "{back:?}");
    }
}
