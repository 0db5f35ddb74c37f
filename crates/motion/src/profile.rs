//! A planned rest-to-rest move: its segments, and the set-point at any time.
use crate::boxes;
use crate::request::Request;
use crate::sampled::Run;
use crate::{Limits, Order, Piece, PlanError, Segment, Segments, optimal, segment};
use servobench_base::{Setpoint, Stateful};

/// A rest-to-rest move from 0 to [`distance`](Self::distance), in the axis unit (m or rad) and seconds from its start.
#[derive(Debug, Clone, Copy, PartialEq, Stateful)]
pub struct Profile {
    order: Order,
    distance: f64,
    amplitude: f64,
    /// `None` if it is not a step through moving averages.
    boxes: Option<Boxes>,
    /// Largest magnitudes of velocity and its derivatives; infinite above the order.
    peaks: [f64; 4],
    duration: f64,
    /// Distance within which a switching instant counts as reached (s).
    tolerance: f64,
    /// Starts of the segments of the first half of the move (s); infinite beyond the order.
    starts: [f64; 8],
    /// Their lengths (s).
    lengths: [f64; 8],
    /// Their states at the start.
    anchors: [Setpoint; 8],
}

/// The moving averages of a move that is a step through them.
#[derive(Debug, Clone, Copy, PartialEq, Stateful)]
pub(crate) struct Boxes {
    /// Lengths in `unit`; zero beyond the order.
    pub(crate) lengths: [f64; 4],
    /// Dwells `T_k − T_1 − … − T_(k−1)` in `unit`.
    pub(crate) dwells: [f64; 4],
    /// One second, or the sample time of a sampled plan (s): times are whole numbers of it, rounded once.
    pub(crate) unit: f64,
    pub(crate) sampled: bool,
}

/// Times for which each derivative stays at its peak within one pulse of it (s), named as in the literature.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Times {
    /// Snap, order 4 only.
    pub t_d: Option<f64>,
    /// Jerk, orders 3 and 4.
    pub t_j: Option<f64>,
    /// Acceleration.
    pub t_a: f64,
    /// Velocity: the cruise.
    pub t_v: f64,
}

/// Largest magnitudes over the move, in closed form (SI); infinite for the derivatives above the order, which are
/// impulses.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Peaks {
    /// Velocity (m/s or rad/s).
    pub velocity: f64,
    /// Acceleration (m/s² or rad/s²).
    pub acceleration: f64,
    /// Jerk (m/s³ or rad/s³).
    pub jerk: f64,
    /// Snap (m/s⁴ or rad/s⁴).
    pub snap: f64,
}

/// The sample counts of a sampled plan.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Samples {
    /// Sample time (s).
    pub time: f64,
    /// Lengths of the moving averages in samples; zero beyond the order.
    pub boxes: [u64; 4],
}

impl Samples {
    /// Number of samples of the whole move, at most 2⁵³.
    #[must_use]
    pub fn total(&self) -> u64 {
        self.boxes.iter().sum()
    }
}

impl Profile {
    /// Plans a move of `distance` (m or rad; its sign is the direction) in continuous time.
    ///
    /// # Errors
    /// [`PlanError`] when the distance is not finite, a used limit is not positive, or one of them lies outside
    /// 1e-30 … 1e30 (SI). A distance of zero is a move of duration zero.
    pub fn plan(order: Order, distance: f64, limits: &Limits) -> Result<Self, PlanError> {
        let Request { distance, bounds } = Request::new(order, distance, limits)?;
        Ok(Self::continuous(order, distance, &bounds))
    }

    /// Plans a move all of whose switching instants are whole multiples of `sample_time` (s).
    ///
    /// The end position is exact; the amplitude and the peaks are lowered, never raised, to make the times fit.
    /// Executed by the forward-Euler [`Cascade`](crate::sampled::Cascade) or by the exact hold, the move lands on `distance`
    /// at its last sample; [`at`](Self::at) is the latter, and continuous between samples.
    ///
    /// # Errors
    /// As [`plan`](Self::plan), for the sample time too, and [`PlanError::TooManySamples`] above 2⁵³ samples.
    pub fn plan_sampled(order: Order, distance: f64, limits: &Limits, sample_time: f64) -> Result<Self, PlanError> {
        Self::whole(order, distance, limits, sample_time, boxes::whole)
    }

    /// As [`plan_sampled`](Self::plan_sampled), with the fewest samples for a step through moving averages, instead of the
    /// sequential rounding; never more than that. Among several solutions, that of the lowest amplitude.
    ///
    /// # Errors
    /// As [`plan_sampled`](Self::plan_sampled).
    pub fn plan_fewest(order: Order, distance: f64, limits: &Limits, sample_time: f64) -> Result<Self, PlanError> {
        Self::whole(order, distance, limits, sample_time, boxes::fewest)
    }

    /// The move through the moving averages that `choose` returns for the bounds in units of the sample time.
    fn whole(
        order: Order,
        distance: f64,
        limits: &Limits,
        sample_time: f64,
        choose: impl Fn(&[f64]) -> Option<[f64; 4]>,
    ) -> Result<Self, PlanError> {
        let Request { distance, bounds } = Request::sampled(order, distance, limits, sample_time)?;
        if distance == 0.0 {
            return Ok(Self::from_boxes(order, distance, [0.0; 4], Some(sample_time)));
        }
        let n = order.derivative();
        let Some(boxes) = choose(&bounds[..=n]) else {
            let samples = Self::plan(order, distance, limits)?.duration / sample_time;
            return Err(PlanError::TooManySamples { samples, sample_time });
        };
        Ok(Self::from_boxes(order, distance, boxes, Some(sample_time)))
    }

    /// Plans the shortest move of `distance` (m or rad; its sign is the direction) in continuous time.
    ///
    /// At orders 2 and 3, and for an order 4 with a cruise, that is [`plan`](Self::plan); without a cruise the jerk continues
    /// through peak velocity and the move takes up to 6.94 % less time: (384·x/d)^¼ instead of (512·x/d)^¼, which is 7.457 %
    /// longer, with the snap alone limited. With a cruise the shortest path to the velocity limit would leave it again in ever shorter
    /// swings (Fuller's phenomenon); that gain, below 0.1 %, is left out.
    ///
    /// # Errors
    /// As [`plan`](Self::plan).
    pub fn plan_optimal(order: Order, distance: f64, limits: &Limits) -> Result<Self, PlanError> {
        let Request { distance, bounds } = Request::new(order, distance, limits)?;
        if order == Order::Fourth && distance != 0.0 {
            let [snap, jerk, acceleration, velocity, length] = bounds;
            // The unit of time in which distance and snap limit are one.
            let unit = libm::sqrt(libm::sqrt(length / snap));
            let scaled = optimal::Scaled {
                velocity: velocity / length * unit,
                acceleration: acceleration / length * unit * unit,
                jerk: jerk / snap / unit,
            };
            if let Some(half) = optimal::half(&scaled) {
                return Ok(Self::from_half(distance, &half, unit));
            }
        }
        Ok(Self::continuous(order, distance, &bounds))
    }

    /// The move through moving averages of any length; `bounds` as in [`Request`].
    fn continuous(order: Order, distance: f64, bounds: &[f64; 5]) -> Self {
        let boxes = if distance == 0.0 { [0.0; 4] } else { boxes::continuous(&bounds[..=order.derivative()]) };
        Self::from_boxes(order, distance, boxes, None)
    }

    /// The move of `distance` with averages of these lengths, in seconds or in samples. They fulfil the order conditions.
    pub(crate) fn from_boxes(order: Order, distance: f64, lengths: [f64; 4], sample_time: Option<f64>) -> Self {
        let n = order.derivative();
        let unit = sample_time.unwrap_or(1.0);
        let (mut dwells, mut sum) = ([0.0; 4], 0.0);
        for (dwell, length) in dwells.iter_mut().zip(lengths).take(n) {
            *dwell = length - sum;
            sum += length;
        }
        let mut peaks = [f64::INFINITY; 4];
        let mut peak = distance.abs();
        for (slot, length) in peaks.iter_mut().zip(lengths[..n].iter().rev()) {
            peak = if *length > 0.0 { peak / (length * unit) } else { 0.0 };
            *slot = peak;
        }
        let boxes = Boxes { lengths, dwells, unit, sampled: sample_time.is_some() };
        let duration = sum * unit;
        // k·Ts against k/f is 1.5 ulp; a time computed by subtraction is worse, which the sample grid tolerates.
        let tolerance = rounding(duration).max(if boxes.sampled { 1e-9 * unit } else { 0.0 });
        if sum == 0.0 {
            return Self { boxes: Some(boxes), peaks, tolerance, ..Self::empty(order, distance, duration) };
        }
        let (amplitude, v) = (peak.copysign(distance), peaks[0].copysign(distance));
        let (starts, lengths) = (segment::starts(&boxes, n), segment::lengths(&boxes, n));
        // In the cruise only the velocity is not zero: the residue that the integration leaves in the acceleration would
        // drift through a long one.
        let cruise = Setpoint { x: v * (starts[(1 << (n - 1)) - 1] / 2.0), v, ..Setpoint::default() };
        let anchors = match order {
            Order::Second => segment::anchors::<1>(|state, value| state.a = value, amplitude, &lengths, cruise),
            Order::Third => segment::anchors::<3>(|state, value| state.j = value, amplitude, &lengths, cruise),
            Order::Fourth => segment::anchors::<7>(|state, value| state.s = value, amplitude, &lengths, cruise),
        };
        Self { order, distance, amplitude, boxes: Some(boxes), peaks, duration, tolerance, starts, lengths, anchors }
    }

    /// No segment yet.
    fn empty(order: Order, distance: f64, duration: f64) -> Self {
        Self {
            order,
            distance,
            amplitude: 0.0,
            boxes: None,
            peaks: [0.0; 4],
            duration,
            tolerance: rounding(duration),
            starts: [f64::INFINITY; 8],
            lengths: [0.0; 8],
            anchors: [Setpoint::default(); 8],
        }
    }

    /// The move of order 4 that begins with `half`, in units of `unit` seconds.
    fn from_half(distance: f64, half: &optimal::Half, unit: f64) -> Self {
        const SIGNS: [f64; 7] = [1.0, 0.0, -1.0, 0.0, -1.0, 0.0, 1.0];
        let lengths = half.lengths().map(|length| length * unit);
        let duration: f64 = lengths.iter().sum();
        let mut profile = Self::empty(Order::Fourth, distance, 2.0 * duration);
        // Integrals of a unit of snap: the amplitude that ends in the middle follows, the limit except for rounding.
        let (mut state, mut start) = (Setpoint::default(), 0.0);
        let segments = lengths.into_iter().zip(SIGNS).filter(|(length, _)| *length > 0.0);
        for (i, (length, sign)) in segments.enumerate() {
            state.s = sign;
            profile.starts[i] = start;
            profile.lengths[i] = length;
            profile.anchors[i] = state;
            state = state.after(length);
            start += length;
        }
        let amplitude = 0.5 * distance / state.x;
        for anchor in &mut profile.anchors {
            *anchor = anchor.scaled(amplitude);
        }
        let magnitude = amplitude.abs();
        let [jerk, acceleration] = [half.jerk() * unit, half.acceleration() * unit * unit];
        profile.peaks = [state.v * magnitude, acceleration * magnitude, jerk * magnitude, magnitude];
        profile.amplitude = amplitude;
        profile
    }

    /// The same move with every time multiplied by `factor`.
    pub(crate) fn slowed(&self, factor: f64) -> Self {
        let mut slow = Self::empty(self.order, self.distance, self.duration * factor);
        let slower = 1.0 / factor;
        slow.starts = self.starts.map(|start| start * factor);
        slow.lengths = self.lengths.map(|length| length * factor);
        slow.anchors = self.anchors.map(|anchor| anchor.at_pace(slower));
        let mut power = 1.0;
        for (peak, known) in slow.peaks.iter_mut().zip(self.peaks) {
            power *= slower;
            *peak = known * power;
        }
        slow.amplitude = self.amplitude * libm::pow(slower, self.order.derivative() as f64);
        slow
    }

    /// The set-point `t` seconds after the start: at rest at 0 before it, at rest at exactly the distance from the end
    /// on. A value that switches has its new value from the switching instant on.
    ///
    /// The polynomial is evaluated from the start of the segment, and from the end of the move for its second half
    /// (x(t) = x_end − x(T − t)): no state is carried along, nothing drifts. A switching instant counts as reached
    /// within 4 ulp of the duration, and of a sampled plan within 1e-9 samples: k·Ts always hits, however it was
    /// rounded. NaN counts as before the start.
    #[must_use]
    #[inline]
    pub fn at(&self, t: f64) -> Setpoint {
        self.piece(t).at(t)
    }

    /// The polynomial that [`at`](Self::at) evaluates at `t` (s).
    #[must_use]
    pub fn piece(&self, t: f64) -> Piece {
        let Self { tolerance, duration, distance, .. } = *self;
        let reached = t + tolerance;
        if reached >= duration {
            return Piece::at_rest(distance);
        }
        if reached < 0.0 || t.is_nan() {
            return Piece { tolerance, until: 0.0, ..Piece::at_rest(0.0) };
        }
        let half = 0.5 * duration;
        let is_late = reached >= half;
        let nearer = if is_late { duration - reached } else { reached };
        // The segment, and the starts on both sides of it that are the nearest.
        let (mut i, mut before, mut after) = (0, 0.0_f64, half);
        for start in &self.starts[1..] {
            if *start <= nearer {
                i += 1;
                before = before.max(*start);
            } else {
                after = after.min(*start);
            }
        }
        let (anchor, start, length) = (self.anchors[i], self.starts[i], self.lengths[i]);
        if is_late {
            // Traversed from its end to its start, which belongs to it; except for the first segment, as the end of the move
            // is at rest.
            let until = if i == 0 { 0.0 } else { (-before).next_up() };
            Piece { anchor, start, length, origin: duration, sign: -1.0, base: distance, tolerance, until }
        } else {
            Piece { anchor, start, length, origin: 0.0, sign: 1.0, base: 0.0, tolerance, until: after }
        }
    }

    /// Order of the profile.
    #[must_use]
    pub const fn order(&self) -> Order {
        self.order
    }

    /// Signed distance (m or rad).
    #[must_use]
    pub const fn distance(&self) -> f64 {
        self.distance
    }

    /// Duration (s).
    #[must_use]
    pub const fn duration(&self) -> f64 {
        self.duration
    }

    /// The effective snap, jerk or acceleration by order (SI), signed by the direction: the value of the pulses, at most
    /// the limit, `distance/∏ T_k`.
    #[must_use]
    pub const fn amplitude(&self) -> f64 {
        self.amplitude
    }

    /// Lengths of the moving averages `T1 … Tn` (s); none if the move is not a step through them.
    #[must_use]
    pub fn boxes(&self) -> impl ExactSizeIterator<Item = f64> + '_ {
        let (lengths, unit) = match &self.boxes {
            Some(boxes) => (&boxes.lengths[..self.order.derivative()], boxes.unit),
            None => (&[][..], 1.0),
        };
        lengths.iter().map(move |length| length * unit)
    }

    /// Dwell of each derivative at its peak; `None` if the move is not a step through moving averages.
    #[must_use]
    pub fn times(&self) -> Option<Times> {
        let Boxes { dwells, unit, .. } = self.boxes?;
        let [first, second, third, fourth] = dwells.map(|dwell| dwell * unit);
        Some(match self.order {
            Order::Second => Times { t_d: None, t_j: None, t_a: first, t_v: second },
            Order::Third => Times { t_d: None, t_j: Some(first), t_a: second, t_v: third },
            Order::Fourth => Times { t_d: Some(first), t_j: Some(second), t_a: third, t_v: fourth },
        })
    }

    /// Duration of the peak velocity (s).
    #[must_use]
    pub fn cruise(&self) -> f64 {
        self.times().map_or(0.0, |times| times.t_v)
    }

    /// Peak magnitudes; for a step through moving averages `|x|/T_n`, `|x|/(T_n·T_(n−1))`, …
    #[must_use]
    pub const fn peaks(&self) -> Peaks {
        let [velocity, acceleration, jerk, snap] = self.peaks;
        Peaks { velocity, acceleration, jerk, snap }
    }

    /// The sample counts; `None` for a continuous plan.
    #[must_use]
    pub fn samples(&self) -> Option<Samples> {
        #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "whole numbers up to 2⁵³")]
        self.boxes
            .filter(|boxes| boxes.sampled)
            .map(|Boxes { lengths, unit, .. }| Samples { time: unit, boxes: lengths.map(|count| count as u64) })
    }

    /// The segments with their highest derivative.
    #[must_use]
    pub const fn segments(&self) -> Segments<'_> {
        Segments::of(self)
    }

    /// The segments in whole samples; none for a continuous plan.
    pub fn runs(&self) -> impl Iterator<Item = Run> + '_ {
        #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "whole numbers up to 2⁵³")]
        self.boxes.filter(|boxes| boxes.sampled).into_iter().flat_map(|boxes| {
            self.segments().map(move |segment| Run {
                value: segment.value,
                count: libm::round(segment.length / boxes.unit) as u64,
            })
        })
    }

    pub(crate) const fn box_units(&self) -> Option<&Boxes> {
        self.boxes.as_ref()
    }

    /// Segment `i` of the first half of the move, the cruise included.
    pub(crate) fn first_half(&self, i: usize) -> Option<Segment> {
        let (start, length) = (*self.starts.get(i)?, self.lengths[i]);
        let anchor = &self.anchors[i];
        let value = match self.order {
            Order::Second => anchor.a,
            Order::Third => anchor.j,
            Order::Fourth => anchor.s,
        };
        start.is_finite().then_some(Segment { start, length, value })
    }
}

/// 4 ulp of the duration (s).
const fn rounding(duration: f64) -> f64 {
    4.0 * f64::EPSILON * duration
}
