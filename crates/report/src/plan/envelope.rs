//! Envelope of a plan of very many polynomials: the lowest and the highest value in each column of pixels.
use super::derivatives;
use super::window::Window;
use crate::drawing::Axis;
use servobench_planner::Span;
use std::fmt::Write;

/// Columns over the width of a panel.
pub(super) const COLUMNS: usize = 640;
/// Samples of a polynomial beside its ends: an extreme between them is missed by less than a hundredth of its swing.
const LOOKS: u32 = 4;

/// Lowest and highest values of position and its derivatives (SI) in equal parts of the window.
#[derive(Debug, Clone)]
pub(super) struct Envelope {
    columns: Vec<[(f64, f64); 5]>,
    window: Window,
}

impl Envelope {
    /// The envelope of `spans`, which fill `window`.
    pub(super) fn of(spans: impl Iterator<Item = Span>, window: &Window) -> Self {
        let (begin, length) = (window.from, window.to - window.from);
        let mut columns = vec![[(f64::INFINITY, f64::NEG_INFINITY); 5]; COLUMNS];
        for span in spans {
            let (first, last) = (column(span.start - begin, length), column(span.start + span.length - begin, length));
            for (i, column) in columns.iter_mut().enumerate().take(last + 1).skip(first) {
                let within = |t: f64| (t - span.start).clamp(0.0, span.length);
                let edge = |i: usize| begin + length * i as f64 / COLUMNS as f64;
                let (from, to) = (within(edge(i)), within(edge(i + 1)));
                for look in 0..=LOOKS {
                    let t = from + (to - from) * f64::from(look) / f64::from(LOOKS);
                    // From the right at its end: the next one begins there with another value.
                    for (value, (low, high)) in derivatives(&span.after(t)).into_iter().zip(column.iter_mut()) {
                        (*low, *high) = (low.min(value), high.max(value));
                    }
                }
            }
        }
        Self { columns, window: *window }
    }

    /// The lowest and the highest value of derivative `k` (SI).
    pub(super) fn range(&self, k: usize) -> (f64, f64) {
        let all = self.columns.iter().map(|column| column[k]);
        all.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), (l, h)| (low.min(l), high.max(h)))
    }

    /// The outline of derivative `k` in a unit of size `scale` in SI.
    pub(super) fn path(&self, k: usize, scale: f64, time: &Axis, value: &Axis) -> String {
        let Window { from, to, .. } = self.window;
        let x = |i: usize| time.at(from + (to - from) * (i as f64 + 0.5) / COLUMNS as f64);
        let known = || self.columns.iter().map(|column| column[k]).enumerate().filter(|(_, (low, high))| low <= high);
        let mut path = String::new();
        let highs = known().map(|(i, (_, high))| (i, high));
        let lows: Vec<_> = known().map(|(i, (low, _))| (i, low)).collect();
        for (n, (i, level)) in highs.chain(lows.into_iter().rev()).enumerate() {
            let written = write!(path, "{}{:.1},{:.1}", if n == 0 { 'M' } else { 'L' }, x(i), value.at(level / scale));
            debug_assert!(written.is_ok(), "a string takes everything");
        }
        if path.is_empty() { path } else { path + "Z" }
    }
}

/// The column in which `t` (s) lies.
fn column(t: f64, duration: f64) -> usize {
    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "limited to the columns")]
    let column = (t / duration * COLUMNS as f64).clamp(0.0, COLUMNS as f64 - 1.0) as usize;
    column
}

#[cfg(test)]
mod tests {
    use super::*;
    use servobench_base::Setpoint;

    /// A saw-tooth of a thousand teeth: each column sees it from 0 to 1.
    #[test]
    fn every_column_sees_all_there_is_in_it() {
        let tooth = |k: u32| Span {
            start: f64::from(k) * 1e-3,
            length: 1e-3,
            state: Setpoint { v: 1000.0, ..Setpoint::default() },
            is_held: false,
        };
        let envelope = Envelope::of((0..1000).map(tooth), &Window::of(1.0, None, None).unwrap());
        for column in &envelope.columns {
            let (low, high) = column[0];
            assert!(low >= 0.0 && high <= 1.0 + 1e-9 && high - low > 0.5, "{low} {high}");
        }
        let time = Axis { low: 0.0, high: 1.0, from: 0.0, to: 640.0 };
        let value = Axis { low: 0.0, high: 1000.0, from: 100.0, to: 0.0 };
        let path = envelope.path(1, 1.0, &time, &value);
        assert!(path.starts_with("M0.5,0.0L1.5,0.0L") && path.ends_with("L0.5,0.0Z"), "{path}");
        assert_eq!(path.matches('L').count(), 2 * COLUMNS - 1);
    }
}
