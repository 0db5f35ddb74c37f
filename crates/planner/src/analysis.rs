//! Analysis of a plan: its polynomials, their extreme values, and the times at which a limit is reached.
use crate::plan::Plan;
use servobench_base::Setpoint;

/// A time span in which the set-point is a single polynomial.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Span {
    /// Start (s).
    pub start: f64,
    /// Its length (s), above zero.
    pub length: f64,
    /// The set-point at its beginning.
    pub state: Setpoint,
    /// True if the set-point is held constant instead of following its derivatives.
    pub is_held: bool,
}

/// The lowest and the highest value of a derivative.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Peak {
    /// Lowest.
    pub lowest: f64,
    /// Highest.
    pub highest: f64,
}

/// A time or time span in which a derivative is at its limit.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Binding {
    /// Derivative of position, 1 to 4.
    pub derivative: usize,
    /// Start (s).
    pub start: f64,
    /// Duration (s); 0 for an instant.
    pub length: f64,
    /// The value there.
    pub value: f64,
}

/// Bisections of a time interval, down to rounding.
const HALVINGS: usize = 60;

/// Relative distance to a limit up to which a value counts as at the limit.
const NEAR: f64 = 1e-9;

impl Span {
    /// The set-point `since` (s) after the start.
    #[must_use]
    pub fn after(&self, since: f64) -> Setpoint {
        if self.is_held { self.state } else { self.state.after(since) }
    }

    /// The times since the start (s) at which the derivative `k` may be extreme: both ends, and between them the zeros of the next
    /// derivative.
    fn turns(&self, k: usize) -> impl Iterator<Item = f64> {
        let Self { length, state, is_held, .. } = *self;
        let inner = match k {
            _ if is_held => [f64::NAN; 2],
            // a + j·t + s·t²/2 = 0 without cancellation.
            1 => {
                let root = libm::sqrt(state.j * state.j - 2.0 * state.s * state.a);
                let q = -(state.j + libm::copysign(root, state.j));
                [q / state.s, 2.0 * state.a / q]
            }
            2 => [-state.j / state.s, f64::NAN],
            _ => [f64::NAN; 2],
        };
        [0.0, length].into_iter().chain(inner.into_iter().filter(move |t| *t > 0.0 && *t < length))
    }
}

impl Span {
    /// The times since the start (s) at which the velocity changes sign: at most one between neighbouring extremes of it.
    fn reversals(&self) -> impl Iterator<Item = f64> {
        let mut ends: Vec<f64> = self.turns(1).collect();
        ends.sort_by(f64::total_cmp);
        let v = |t: f64| self.after(t).v;
        let between = |(mut low, mut high): (f64, f64)| {
            let first = v(low);
            if first * v(high) >= 0.0 {
                return None;
            }
            for _ in 0..HALVINGS {
                let middle = 0.5 * (low + high);
                if v(middle) * first > 0.0 { low = middle } else { high = middle }
            }
            Some(high)
        };
        let parts: Vec<_> = ends.windows(2).filter_map(|ends| between((ends[0], ends[1]))).collect();
        parts.into_iter()
    }
}

pub(crate) fn spans(plan: &Plan) -> impl Iterator<Item = Span> {
    let duration = plan.duration();
    let mut reader = plan.reader_at(0.0);
    let mut t = 0.0_f64;
    std::iter::from_fn(move || {
        if t >= duration {
            return None;
        }
        reader.look_up(plan, t);
        let ends = reader.ends().max(t.next_up()).min(duration);
        let span = Span { start: t, length: ends - t, state: reader.at(t), is_held: plan.held().is_some() };
        t = ends;
        Some(span)
    })
}

/// Derivative `k` of position, 1 to 4.
fn derivative(setpoint: &Setpoint, k: usize) -> f64 {
    [setpoint.x, setpoint.v, setpoint.a, setpoint.j, setpoint.s][k]
}

pub(crate) fn peaks(plan: &Plan) -> [Peak; 4] {
    let mut peaks = [Peak { lowest: 0.0, highest: 0.0 }; 4];
    for span in spans(plan) {
        for (peak, k) in peaks.iter_mut().zip(1..=plan.order()) {
            for t in span.turns(k) {
                let value = derivative(&span.after(t), k);
                *peak = Peak { lowest: peak.lowest.min(value), highest: peak.highest.max(value) };
            }
        }
    }
    peaks[plan.order()..].fill(Peak { lowest: f64::NEG_INFINITY, highest: f64::INFINITY });
    peaks
}

/// The lowest and the highest position of a plan.
pub(crate) fn positions(plan: &Plan) -> Peak {
    let ends = [plan.start().x, plan.end().x];
    let mut peak = Peak { lowest: ends[0].min(ends[1]), highest: ends[0].max(ends[1]) };
    for span in spans(plan) {
        for x in [0.0, span.length].into_iter().chain(span.reversals()).map(|t| span.after(t).x) {
            peak = Peak { lowest: peak.lowest.min(x), highest: peak.highest.max(x) };
        }
    }
    peak
}

pub(crate) fn bindings(plan: &Plan) -> Vec<Binding> {
    let mut found: Vec<Binding> = Vec::new();
    for (k, limit) in (1..=plan.order()).zip(plan.limits()) {
        let at_limit = |value: f64| {
            let bound = if value > 0.0 { limit.above } else { limit.below };
            bound.is_finite() && value.abs() >= bound * (1.0 - NEAR)
        };
        if limit.below.is_infinite() && limit.above.is_infinite() {
            continue;
        }
        let first = found.len();
        for span in spans(plan) {
            let inside = derivative(&span.after(0.5 * span.length), k);
            // With the limits of both directions, the ends of a span may be at a limit while its interior is not.
            let is_there = |value: f64| at_limit(value) && value * inside > 0.0;
            let is_whole = is_there(inside) && span.turns(k).all(|t| is_there(derivative(&span.after(t), k)));
            if is_whole {
                push(
                    &mut found,
                    first,
                    Binding { derivative: k, start: span.start, length: span.length, value: inside },
                );
                continue;
            }
            for t in span.turns(k) {
                let value = derivative(&span.after(t), k);
                if at_limit(value) {
                    push(&mut found, first, Binding { derivative: k, start: span.start + t, length: 0.0, value });
                }
            }
        }
    }
    found
}

/// Adds `next`, or extends the last of those from `first` on if they touch.
fn push(found: &mut Vec<Binding>, first: usize, next: Binding) {
    let last = if found.len() > first { found.last_mut() } else { None };
    match last {
        Some(last) if last.value * next.value > 0.0 && next.start <= (last.start + last.length) * (1.0 + 1e-12) => {
            last.length = last.length.max(next.start + next.length - last.start);
        }
        _ => found.push(next),
    }
}

pub(crate) fn cruise(plan: &Plan) -> (f64, f64) {
    let (mut longest, mut current) = ((0.0, 0.0), None::<(f64, f64, f64)>);
    for Span { start, length, state, .. } in spans(plan) {
        let Setpoint { v, a, j, s, .. } = state;
        if v == 0.0 || a != 0.0 || j != 0.0 || s != 0.0 {
            current = None;
            continue;
        }
        let (from, so_far) = match current {
            Some((from, so_far, before)) if (v - before).abs() <= 1e-12 * v.abs() => (from, so_far),
            _ => (start, 0.0),
        };
        current = Some((from, so_far + length, v));
        if so_far + length > longest.1 {
            longest = (from, so_far + length);
        }
    }
    longest
}
