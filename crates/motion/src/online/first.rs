//! The first time at which a target is met.
use super::path::{Path, Stretch};
use crate::root::{between, increasing};

/// A product takes a fifth of the time of a quotient.
pub(crate) const THIRD: f64 = 1.0 / 3.0;

/// Parts of a stretch that are looked at one by one.
const PARTS: u32 = 12;

/// A state that a stretch leads on.
pub(crate) trait State: Copy {
    /// The state `t` later while the highest derivative is `value`.
    fn after(self, value: f64, t: f64) -> Self;

    /// The state at the end of `path`.
    fn along<const N: usize>(self, path: &Path<N>) -> Self {
        path.stretches().iter().fold(self, |state, Stretch { value, length }| state.after(*value, *length))
    }

    /// The state after `time` on `path`.
    fn until<const N: usize>(self, path: &Path<N>, mut time: f64) -> Self {
        let mut state = self;
        for Stretch { value, length } in path.stretches() {
            state = state.after(*value, length.min(time));
            time -= length;
            if time <= 0.0 {
                break;
            }
        }
        state
    }
}

/// The first time on the way of these `stretches` from `start` at which `beyond` of the state is zero; `None` when it stays
/// below. At the start it is `first`, below zero.
///
/// Who turns home later covers more than whoever turned before and waits at the target's velocity. Towards a target that
/// moves away, or rests, that is more by any measure, and `grows`. Towards one that moves the other way the waiting counts
/// against it: what is beyond may rise, sink and rise again, and there can be several times.
pub(crate) fn meeting<S: State>(
    start: S,
    first: f64,
    stretches: &[Stretch],
    grows: bool,
    beyond: impl Fn(S) -> f64,
) -> Option<f64> {
    let parts = if grows { 1 } else { PARTS };
    let (mut state, mut begin, mut reached) = (start, 0.0, first);
    for Stretch { value, length } in stretches {
        let beyond = |time: f64| beyond(state.after(*value, time));
        // The last two points.
        let mut last = [(0.0, reached); 2];
        for k in 1..=parts {
            let time = length * f64::from(k) / f64::from(parts);
            let now = (time, beyond(time));
            if !grows && last[1].1 < 0.0 && last[1].1 >= last[0].1 && last[1].1 > now.1 && k > 1 {
                let top = highest(last[0].0, time, beyond);
                if beyond(top) >= 0.0 {
                    return Some(begin + increasing(last[0].0, top, beyond));
                }
            }
            if now.1 >= 0.0 {
                return Some(begin + between(last[1], now, beyond));
            }
            last = [last[1], now];
        }
        state = state.after(*value, *length);
        (begin, reached) = (begin + length, last[1].1);
    }
    None
}

/// Where `f`, which rises and falls between `low` and `high`, is highest: by the golden section.
fn highest(mut low: f64, mut high: f64, f: impl Fn(f64) -> f64) -> f64 {
    const GOLDEN: f64 = 0.618_033_988_749_894_9;
    for _ in 0..30 {
        let step = GOLDEN * (high - low);
        if f(high - step) >= f(low + step) {
            high = low + step;
        } else {
            low = high - step;
        }
    }
    0.5 * (low + high)
}
