//! The same move in a longer time.
use crate::boxes::MAX_SAMPLES;
use crate::{PlanError, Profile};
use servobench_base::positive;

/// Longest duration (s) of a planned or stretched move: its fourth power is still a normal number.
pub(crate) const LONGEST: f64 = 1e60;

impl Profile {
    /// The same move in `duration` seconds: all moving averages longer by the same factor k, hence velocity, acceleration, jerk
    /// and snap lower by k, k², k³ and k⁴.
    ///
    /// A sampled plan is stretched to the first whole number of samples N' that is not shorter (within 1e-9 samples).
    /// All averages but the last become `⌊n·N'/N⌋`, the last takes the rest: never shorter than before, so that no peak
    /// rises; and `⌊a⌋ + ⌊b⌋ ≤ ⌊a + b⌋` keeps their order. A move of zero distance stays as it is.
    ///
    /// # Errors
    /// [`PlanError::TooShort`] below the duration at the limits; [`PlanError::TooManySamples`] above 2⁵³ samples, and
    /// [`PlanError::OutOfRange`] above 1e60 s.
    pub fn stretched_to(&self, duration: f64) -> Result<Self, PlanError> {
        let duration = positive("duration", duration)?;
        if duration > LONGEST {
            let (lowest, remedy) = (self.duration(), "correct its unit");
            return Err(PlanError::OutOfRange { name: "duration", value: duration, lowest, highest: LONGEST, remedy });
        }
        if self.duration() == 0.0 {
            return Ok(*self);
        }
        if let Some(samples) = self.samples() {
            let wanted = duration / samples.time;
            let wanted = libm::ceil(wanted - 1e-9f64.max(2.0 * f64::EPSILON * wanted));
            if wanted > MAX_SAMPLES {
                return Err(PlanError::TooManySamples { samples: wanted, sample_time: samples.time });
            }
            let total = samples.total();
            #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "a whole number up to 2⁵³")]
            let wanted = wanted as u64;
            if wanted < total {
                return Err(PlanError::TooShort { duration, shortest: self.duration() });
            }
            let last = self.order().derivative() - 1;
            let (mut boxes, mut rest) = ([0.0; 4], wanted);
            for (length, count) in boxes.iter_mut().zip(samples.boxes).take(last) {
                #[expect(clippy::cast_possible_truncation, reason = "count ≤ total, so the quotient is at most wanted")]
                let count = (u128::from(count) * u128::from(wanted) / u128::from(total)) as u64;
                *length = count as f64;
                rest -= count;
            }
            boxes[last] = rest as f64;
            return Ok(Self::from_boxes(self.order(), self.distance(), boxes, Some(samples.time)));
        }
        let factor = duration / self.duration();
        if factor < 1.0 - 1e-12 {
            return Err(PlanError::TooShort { duration, shortest: self.duration() });
        }
        let Some(known) = self.box_units() else { return Ok(self.slowed(factor.max(1.0))) };
        // By the dwells: one of zero stays exactly zero.
        let (mut boxes, mut sum) = ([0.0; 4], 0.0);
        for (length, dwell) in boxes.iter_mut().zip(known.dwells).take(self.order().derivative()) {
            *length = dwell * factor.max(1.0) + sum;
            sum += *length;
        }
        Ok(Self::from_boxes(self.order(), self.distance(), boxes, None))
    }
}
