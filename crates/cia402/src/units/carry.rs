//! Steps converted one by one without drift.
use super::{Ratio, UnitError, ratio::product};

/// Converts the steps of a moving position; what rounding leaves over goes into the next step.
///
/// After steps that sum to `s` the results sum to `s·ratio`, rounded once. Nothing is lost however long the axis runs.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Carry {
    ratio: Ratio,
    inverted: bool,
    /// Numerator of the part not handed out yet, from 0 to the denominator; half a denominator at the start rounds to
    /// the nearest.
    remainder: i64,
}

impl Carry {
    /// A conversion by `ratio` with nothing left over.
    #[must_use]
    pub const fn new(ratio: Ratio) -> Self {
        Self { ratio, inverted: false, remainder: ratio.denominator() / 2 }
    }

    /// The same with the opposite sign, as the polarity (607Eh) asks for.
    #[must_use]
    pub const fn inverted(self, inverted: bool) -> Self {
        Self { inverted, ..self }
    }

    /// The step in the other unit.
    ///
    /// # Errors
    /// [`UnitError::CountOverflow`] if the step times the numerator leaves 127 bits; nothing has changed then.
    pub fn step(&mut self, step: i128) -> Result<i128, UnitError> {
        let overflow = || UnitError::CountOverflow { value: step, numerator: self.ratio.numerator().into() };
        let step = if self.inverted { step.checked_neg().ok_or_else(overflow)? } else { step };
        let narrow = i64::try_from(step).ok().and_then(|step| step.checked_mul(self.ratio.numerator()));
        if let Some(numerator) = narrow.and_then(|product| product.checked_add(self.remainder)) {
            let (whole, remainder) = self.ratio.split(numerator);
            self.remainder = remainder;
            return Ok(whole.into());
        }
        let numerator =
            product(step, self.ratio.numerator().into())?.checked_add(self.remainder.into()).ok_or_else(overflow)?;
        let denominator = i128::from(self.ratio.denominator());
        #[expect(clippy::cast_possible_truncation, reason = "less than the denominator, which is an `i64`")]
        {
            self.remainder = numerator.rem_euclid(denominator) as i64;
        }
        Ok(numerator.div_euclid(denominator))
    }
}
