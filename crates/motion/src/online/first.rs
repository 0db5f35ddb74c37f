//! First meeting with a target.
use super::newton::{Bracket, Near};
use super::path::{Path, Stretch};

/// A product takes a fifth of the time of a quotient.
pub(crate) const THIRD: f64 = 1.0 / 3.0;

/// Parts of a stretch that are examined separately.
const PARTS: u32 = 4;

/// Maximum number of points that are evaluated on a hill.
const CLIMB: usize = 30;

/// A state that a stretch continues.
pub(crate) trait State: Copy {
    /// Number of derivatives, from the highest on, that are zero in a cruise.
    const CRUISE: u8;

    /// The lowest of its integrals.
    fn position(self) -> f64;

    /// Its rate.
    fn velocity(self) -> f64;

    /// The state `t` later while the highest derivative is `rate`.
    fn after(self, rate: f64, t: f64) -> Self;

    /// The state with the `zeros` highest of its derivatives, from the one that switches on, at zero and the next at `value`.
    fn held(self, zeros: u8, value: f64) -> Self;

    /// The state `t` after the start of `stretch`.
    #[inline]
    fn on(self, stretch: &Stretch, t: f64) -> Self {
        let start = if stretch.zeros == 0 { self } else { self.held(stretch.zeros, stretch.value) };
        start.after(stretch.rate(), t)
    }

    /// The state at the end of `path`.
    #[inline]
    fn along<const N: usize>(self, path: &Path<N>) -> Self {
        path.stretches().fold(self, |state, stretch| state.on(&stretch, stretch.length))
    }

    /// The state after `time` on `path`, and the highest derivative there.
    #[inline]
    fn until<const N: usize>(self, path: &Path<N>, mut time: f64) -> (Self, f64) {
        let (mut state, mut last) = (self, 0.0);
        for stretch in path.stretches() {
            (state, last) = (state.on(&stretch, stretch.length.min(time)), stretch.rate());
            time -= stretch.length;
            if time <= 0.0 {
                break;
            }
        }
        (state, last)
    }
}

/// The first time on `path` from `start` at which `beyond` is zero; `None` when it stays below, as it is at
/// the start. `beyond` gives its value at a state, and its slope at the present highest derivative.
///
/// A path that turns home later covers more than one that turned before and waits at the target's velocity. Towards a target that
/// moves away, or rests, that is more by any measure, and [`Bracket::root`] finds the time at which it is enough. Towards one that moves
/// the other way the waiting counts against it: `beyond` may rise, sink and rise again, and there can be several times.
pub(crate) fn meeting<S: State, const N: usize>(
    start: S,
    path: &Path<N>,
    beyond: impl Fn(S, f64) -> (f64, f64),
) -> Option<f64> {
    let (mut state, mut begin) = (start, 0.0);
    for stretch in path.stretches() {
        let length = stretch.length;
        let beyond = |time: f64| beyond(state.on(&stretch, time), stretch.rate());
        let mut low = Point::of(&beyond, 0.0);
        for k in 1..=PARTS {
            let high = Point::of(&beyond, length * f64::from(k) / f64::from(PARTS));
            let reached = if high.value >= 0.0 { Some(high) } else { hill(&beyond, low, high) };
            if let Some(high) = reached {
                let bracket = Bracket { low: low.time, high: high.time, missing: -low.value };
                let middle = Near::to(0.5 * (low.time + high.time));
                return bracket.root(&middle, |part| part, beyond).map(|time| begin + time);
            }
            low = high;
        }
        state = state.on(&stretch, length);
        begin += length;
    }
    None
}

/// A function at a time.
#[derive(Clone, Copy)]
struct Point {
    time: f64,
    value: f64,
    slope: f64,
}

impl Point {
    fn of(f: &impl Fn(f64) -> (f64, f64), time: f64) -> Self {
        let (value, slope) = f(time);
        Self { time, value, slope }
    }
}

/// A time between two points below zero at which `f` is not: on a hill that is high enough.
///
/// The tangents at both sides of a hill meet above it. That point is evaluated, and taken for the side to which it
/// belongs, until a point is not below zero, or the tangents meet there.
fn hill(f: &impl Fn(f64) -> (f64, f64), mut low: Point, mut high: Point) -> Option<Point> {
    for _ in 0..CLIMB {
        let is_hill = low.slope > 0.0 && high.slope < 0.0;
        let (length, bend) = (high.time - low.time, low.slope - high.slope);
        let part = (high.value - low.value - high.slope * length) / (bend * length);
        if !is_hill || low.value + low.slope * part * length < 0.0 {
            return None;
        }
        let point = Point::of(f, low.time + part.clamp(0.1, 0.9) * length);
        if point.value >= 0.0 {
            return Some(point);
        }
        if point.slope > 0.0 {
            low = point;
        } else {
            high = point;
        }
    }
    None
}
