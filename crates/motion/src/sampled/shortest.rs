//! The sampled move of the fewest samples, of any shape.
use super::half::Half;
use super::reach::{Answer, Cell, Reach};
use super::symmetric::SymmetricMove;
use super::{Execution, Run};
use crate::request::Request;
use crate::{Limits, Order, Peaks, Piece, PlanError, Profile};
use servobench_base::Setpoint;
use std::vec::Vec;

/// A rest-to-rest move whose highest derivative may change at every sample, in the fewest samples in which the
/// distance can be reached within the limits.
///
/// [`Profile::plan_fewest`] is bound to moving averages. This one begins where the continuous optimum switches, and lets a linear program
/// find the amplitudes for one number of samples after the other, until one reaches the distance and the one below is
/// proven not to.
///
/// ```
/// use servobench_motion::{Limits, Order, Profile, sampled::Shortest};
/// let limits = Limits { velocity: 1.0, acceleration: 5.0, jerk: 50.0, snap: 1000.0 };
/// let (published, fewest) = (
///     Profile::plan_sampled(Order::Fourth, 0.01, &limits, 5e-3)?,
///     Profile::plan_fewest(Order::Fourth, 0.01, &limits, 5e-3)?,
/// );
/// let shortest = Shortest::plan(Order::Fourth, 0.01, &limits, 5e-3)?;
/// let counts = [published, fewest].map(|plan| plan.samples().map_or(0, |samples| samples.total()));
/// assert_eq!((counts, shortest.samples(), shortest.at_least()), ([56, 55], 50, 50));
/// # Ok::<(), servobench_motion::PlanError>(())
/// ```
#[derive(Debug, Clone, PartialEq)]
pub struct Shortest {
    /// The move in the fewest samples by moving averages, which is the result if nothing shorter was found.
    boxes: Profile,
    sample_time: f64,
    samples: u64,
    at_least: u64,
    runs: Vec<Run>,
    peaks: Peaks,
    /// `None` if the move is that of the averages.
    symmetric: Option<SymmetricMove>,
}

/// Largest number of samples of a searched move: each is evaluated for every number that is tried.
const MOST: f64 = 131_072.0;

/// Numbers of samples without an answer after which the search ends.
const PATIENCE: usize = 3;

impl Shortest {
    /// Plans a move of `distance` (m or rad; its sign is the direction) in samples of `sample_time` (s), which keeps the limits
    /// at every sample of the forward-Euler cascade, hence at every time of the exact hold ([`sampled`](super)).
    ///
    /// # Errors
    /// As [`Profile::plan_sampled`].
    pub fn plan(order: Order, distance: f64, limits: &Limits, sample_time: f64) -> Result<Self, PlanError> {
        let boxes = Profile::plan_fewest(order, distance, limits, sample_time)?;
        let samples = boxes.samples().map_or(0, |samples| samples.total());
        let mut plan = Self {
            boxes,
            sample_time,
            samples,
            at_least: samples.min(1),
            runs: boxes.runs().collect(),
            peaks: boxes.peaks(),
            symmetric: None,
        };
        let known = samples as f64;
        if samples > 0 && known <= MOST {
            let Request { bounds, .. } = Request::sampled(order, distance, limits, sample_time)?;
            let n = order.derivative();
            let mut search = Search {
                bounds: bounds[1..=n].iter().map(|bound| bound / bounds[0]).collect(),
                continuous: Profile::plan_optimal(order, distance, limits)?,
                sample_time,
                at_least: 1.0,
                best: None,
            };
            search.between(known);
            plan.at_least = whole(search.at_least);
            if let Some((cells, samples)) = search.best {
                let symmetric = SymmetricMove::new(order, boxes.distance(), sample_time, samples, &cells);
                plan.samples = whole(samples);
                plan.runs = symmetric.runs();
                plan.peaks = symmetric.peaks(Execution::ForwardEuler, &plan.runs);
                plan.symmetric = Some(symmetric);
            }
        }
        Ok(plan)
    }

    /// Number of samples N.
    #[must_use]
    pub const fn samples(&self) -> u64 {
        self.samples
    }

    /// A number of samples below which no move reaches the distance, of any shape: equal to [`samples`](Self::samples) if
    /// this move is proven to be the shortest, lower if the search ended without a proof, 1 if it did not begin.
    #[must_use]
    pub const fn at_least(&self) -> u64 {
        self.at_least
    }

    /// Order of the move.
    #[must_use]
    pub const fn order(&self) -> Order {
        self.boxes.order()
    }

    /// Signed distance (m or rad).
    #[must_use]
    pub const fn distance(&self) -> f64 {
        self.boxes.distance()
    }

    /// Sample time (s).
    #[must_use]
    pub const fn sample_time(&self) -> f64 {
        self.sample_time
    }

    /// Duration (s).
    #[must_use]
    pub fn duration(&self) -> f64 {
        self.samples as f64 * self.sample_time
    }

    /// The highest derivative, run by run.
    #[must_use]
    pub fn runs(&self) -> impl ExactSizeIterator<Item = Run> + '_ {
        self.runs.iter().copied()
    }

    /// Largest magnitudes, over the samples of the forward-Euler cascade. Those of the exact hold are not larger.
    #[must_use]
    pub const fn peaks(&self) -> Peaks {
        self.peaks
    }

    /// Largest magnitudes under one `execution`.
    #[must_use]
    pub fn peaks_by(&self, execution: Execution) -> Peaks {
        self.symmetric.as_ref().map_or(self.peaks, |own| own.peaks(execution, &self.runs))
    }

    /// The set-point of the exact hold `t` seconds after the start, as [`Profile::at`].
    #[must_use]
    #[inline]
    pub fn at(&self, t: f64) -> Setpoint {
        self.piece(t).at(t)
    }

    /// The polynomial that [`at`](Self::at) evaluates at `t` (s).
    #[must_use]
    pub fn piece(&self, t: f64) -> Piece {
        self.symmetric.as_ref().map_or_else(|| self.boxes.piece(t), |own| own.piece(t))
    }
}

/// A whole number up to 2⁵³.
#[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "whole and positive")]
pub(super) const fn whole(count: f64) -> u64 {
    count as u64
}

/// The search for the smallest number of samples.
struct Search {
    bounds: Vec<f64>,
    continuous: Profile,
    sample_time: f64,
    at_least: f64,
    best: Option<(Vec<Cell>, f64)>,
}

impl Search {
    fn answer(&self, samples: f64) -> Answer {
        let half = Half { order: self.bounds.len(), samples };
        let pace = samples / self.continuous.duration();
        Reach { half, bounds: &self.bounds }.answer(self.continuous.segments().map(|segment| segment.start * pace))
    }

    /// Up from the continuous optimum to a number that suffices, but is below `known`; then down to one that does not. A number
    /// that suffices makes every larger one suffice, by a sample of rest.
    fn between(&mut self, known: f64) {
        let mut samples = libm::ceil(self.continuous.duration() / self.sample_time).min(known - 1.0).max(1.0);
        let mut unknown = 0;
        while samples < known && unknown < PATIENCE {
            match self.answer(samples) {
                Answer::Reached(cells) => {
                    self.best = Some((cells, samples));
                    break;
                }
                Answer::Beyond(_) => self.at_least = samples + 1.0,
                Answer::Unknown => unknown += 1,
            }
            samples += 1.0;
        }
        let mut step = 1.0;
        while samples - step >= self.at_least && unknown < PATIENCE {
            match self.answer(samples - step) {
                Answer::Reached(cells) => {
                    samples -= step;
                    self.best = Some((cells, samples));
                    step = 1.0;
                }
                Answer::Beyond(_) => {
                    self.at_least = samples - step + 1.0;
                    break;
                }
                Answer::Unknown => {
                    step *= 2.0;
                    unknown += 1;
                }
            }
        }
    }
}
