//! Unwrapping of an absolute encoder that restarts after a number of turns.
//!
//! Of all its images, a reading is taken for the one nearest to the previous reading: this is right while the axis moves less than half the
//! range in between. The first one is taken unchanged, since a drive knows nothing more when it is switched on.

use servobench_base::Stateful;
/// State of the unwrapping from tick to tick.
#[derive(Debug, Clone, Copy, PartialEq, Stateful)]
pub struct Unwrap {
    #[state(constant)]
    range: f64,
    last: Option<f64>,
    #[state(derived)]
    ranges: f64,
}

impl Unwrap {
    /// State for an encoder that restarts after `range`.
    #[must_use]
    pub const fn new(range: f64) -> Self {
        Self { range, last: None, ranges: 0.0 }
    }

    /// Unwrapped position of the reading `wrapped`.
    pub fn position(&mut self, wrapped: f64) -> f64 {
        let step = wrapped - self.last.replace(wrapped).unwrap_or(wrapped);
        if step > self.range / 2.0 {
            self.ranges -= 1.0;
        } else if step < -self.range / 2.0 {
            self.ranges += 1.0;
        }
        wrapped + self.ranges * self.range
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn it_follows_over_the_ends_in_both_directions() {
        let mut unwrap = Unwrap::new(4.0);
        let mut position = 1.0_f64;
        let mut first = None;
        for k in 0..400 {
            position += if k < 250 { 1.7 } else { -1.9 };
            let found = unwrap.position(position.rem_euclid(4.0));
            // The unwrapping cannot know in which range it began.
            let offset = *first.get_or_insert(found - position);
            assert!((found - position - offset).abs() < 1e-11, "{k}: {found} {position}");
        }
    }

    #[test]
    fn more_than_half_the_range_at_once_is_taken_the_short_way() {
        let mut unwrap = Unwrap::new(4.0);
        assert_eq!([0.5, 3.0].map(|read| unwrap.position(read).to_bits()), [0.5_f64, -1.0].map(f64::to_bits));
    }
}
