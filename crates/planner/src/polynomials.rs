//! A trajectory of any number of polynomials, on the heap.
use servobench_base::Setpoint;
use servobench_motion::{Course, Piece};

/// Consecutive polynomials.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Polynomials {
    /// Start of each (s), the first at 0, ascending.
    starts: Vec<f64>,
    /// The set-points at the starts.
    anchors: Vec<Setpoint>,
    between: Between,
    duration: f64,
    end: Setpoint,
    /// A start closer than this counts as reached (s).
    tolerance: f64,
}

/// Continuation of a set-point until the next one.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Between {
    /// Continues with its derivatives.
    Polynomial,
    /// Is held.
    Held,
}

/// Share of a sample by which its start may be missed.
const NEAR: f64 = 1e-9;

impl Polynomials {
    /// Polynomials that start at the times and set-points of `parts`, the first at time 0, up to `end` at `duration` (s).
    pub(crate) fn new(
        parts: impl IntoIterator<Item = (f64, Setpoint)>,
        between: Between,
        duration: f64,
        end: Setpoint,
    ) -> Self {
        let (starts, anchors): (Vec<f64>, _) = parts.into_iter().unzip();
        // A multiple of the sample time differs from one of a task's period by a rounding or two.
        let samples = if between == Between::Held { starts.len() as f64 } else { f64::INFINITY };
        let tolerance = (4.0 * f64::EPSILON * duration).max(NEAR * duration / samples);
        Self { starts, anchors, between, duration, end, tolerance }
    }

    /// The polynomials that `piece` returns in sequence from `start` (s) until `end` (s) of its own time.
    pub(crate) fn collect(start: f64, end: f64, mut piece: impl FnMut(f64) -> Piece) -> Self {
        let (mut t, mut parts) = (start, Vec::new());
        while t < end {
            let current = piece(t);
            parts.push((t - start, current.at(t)));
            t = current.ends().max(t.next_up());
        }
        Self::new(parts, Between::Polynomial, end - start, piece(end).at(end))
    }
}

impl Polynomials {
    /// The set-point at the start of each, with its length (s).
    pub(crate) fn parts(&self) -> impl Iterator<Item = (Setpoint, f64)> {
        let ends = self.starts.iter().skip(1).copied().chain([self.duration]);
        self.anchors.iter().zip(self.starts.iter().zip(ends)).map(|(anchor, (start, end))| (*anchor, end - start))
    }
}

impl Course for Polynomials {
    fn duration(&self) -> f64 {
        self.duration
    }

    fn piece(&self, t: f64) -> Piece {
        let reached = t + self.tolerance;
        if reached >= self.duration || self.starts.is_empty() {
            return Piece::between(self.end, self.duration, f64::INFINITY);
        }
        let i = self.starts.partition_point(|start| *start <= reached).saturating_sub(1);
        let until = self.starts.get(i + 1).copied().unwrap_or(self.duration);
        let piece = match self.between {
            Between::Polynomial => Piece::between(self.anchors[i], self.starts[i], until),
            Between::Held => Piece::held(self.anchors[i], until),
        };
        piece.within(self.tolerance)
    }
}
