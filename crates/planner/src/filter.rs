//! Filters between a generator and the drive.
use crate::cascade::{MOST_SAMPLES, too_many};
use crate::plan::Plan;
use crate::polynomials::{Between, Polynomials};
use core::f64::consts::TAU;
use servobench_base::{ParamError, Setpoint, positive};
use servobench_motion::PlanError;
use servobench_motion::shape::{Impulses, MovingAverage, Shaper, Vibration};

/// Input shapers, then moving averages.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Filter {
    /// Each a sum of scaled and delayed set-points, exact at any time. Applied in series, one for each mode of the axis.
    pub shapers: Vec<Shaping>,
    /// Moving averages after the shapers.
    pub averages: Option<Averages>,
}

/// An input shaper and the vibration that it suppresses.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Shaping {
    /// Type of the shaper.
    pub shaper: Shaper,
    /// Natural frequency of the vibration (Hz).
    pub frequency: f64,
    /// Damping ratio of the vibration.
    pub damping: f64,
}

/// Moving averages in series, of samples; a set-point is held until the next one.
#[derive(Debug, Clone, PartialEq)]
pub struct Averages {
    /// Their lengths (s), whole numbers of samples.
    pub lengths: Vec<f64>,
    /// Sample time (s).
    pub sample_time: f64,
}

/// Distance to a whole number of samples (in samples) up to which a length counts as whole.
const NEAR: f64 = 1e-6;

impl Filter {
    /// No filter.
    pub const NONE: Self = Self { shapers: Vec::new(), averages: None };

    /// The impulses of all shapers, convolved; `None` without shapers.
    ///
    /// # Errors
    /// Those of [`Shaping::impulses`] and [`Impulses::and`].
    pub fn impulses(&self) -> Result<Option<Impulses>, PlanError> {
        self.shapers.iter().map(Shaping::impulses).reduce(|all, next| all?.and(&next?)).transpose()
    }

    /// The filter with the impulses of its shapers.
    pub(crate) fn solved(&self) -> Result<Solved<'_>, PlanError> {
        Ok(Solved { impulses: self.impulses()?, averages: self.averages.as_ref() })
    }
}

impl Shaping {
    /// The impulses of the shaper.
    ///
    /// # Errors
    /// Those of [`Vibration::new`] and [`Shaper::impulses`].
    pub fn impulses(&self) -> Result<Impulses, PlanError> {
        self.shaper.impulses(&Vibration::new(TAU * self.frequency, self.damping)?)
    }
}

/// A filter with the impulses of its shapers.
pub(crate) struct Solved<'a> {
    pub(crate) impulses: Option<Impulses>,
    pub(crate) averages: Option<&'a Averages>,
}

impl Solved<'_> {
    /// The same filter with the impulses at whole samples of `sample_time` (s), as are the set-points that they shape.
    pub(crate) fn sampled(self, sample_time: f64) -> Result<Self, PlanError> {
        let impulses = self.impulses.map(|impulses| impulses.on_grid(sample_time)).transpose()?;
        Ok(Self { impulses, ..self })
    }

    /// Time by which it lengthens a move (s).
    pub(crate) fn length(&self) -> f64 {
        self.impulses.as_ref().map_or(0.0, Impulses::duration)
            + self.averages.map_or(0.0, |averages| averages.lengths.iter().sum())
    }
}

impl Averages {
    /// The set-points of `plan` after the averages.
    pub(crate) fn of(&self, plan: &Plan) -> Result<Polynomials, PlanError> {
        let sample_time = positive("sample_time", self.sample_time)?;
        // Before the move the axis rests: a derivative that begins at the first instant, such as snap, is a step to the averages.
        let start = Setpoint::at_rest(plan.start().x);
        let mut filters = Vec::with_capacity(self.lengths.len());
        let mut total = 0;
        for length in &self.lengths {
            let samples = self.samples(*length)?;
            total += samples;
            filters.push(MovingAverage::over(vec![start; samples], start)?);
        }
        let duration = plan.duration() + total as f64 * sample_time;
        let samples = libm::ceil(duration / sample_time - NEAR);
        if samples > MOST_SAMPLES {
            return Err(too_many(sample_time));
        }
        let mut reader = plan.reader_at(0.0);
        let mut parts = Vec::new();
        #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "a whole number up to 10 million")]
        for k in 0..samples as u64 {
            let t = k as f64 * sample_time;
            if !reader.holds(t) {
                reader.look_up(plan, t);
            }
            let averaged = filters.iter_mut().try_fold(reader.at(t), |setpoint, filter| filter.next(setpoint))?;
            parts.push((t, averaged));
        }
        Ok(Polynomials::new(parts, Between::Held, duration, Setpoint::at_rest(plan.end().x)))
    }

    /// A length in samples.
    fn samples(&self, length: f64) -> Result<usize, PlanError> {
        let samples = length / self.sample_time;
        let whole = libm::round(samples);
        if !((1.0..=MOST_SAMPLES).contains(&whole) && (samples - whole).abs() <= NEAR) {
            let bound = "a whole number of samples, 1 to 10 million";
            return Err(ParamError { name: "averages", value: length, bound }.into());
        }
        #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "a whole number up to 10 million")]
        Ok(whole as usize)
    }
}
