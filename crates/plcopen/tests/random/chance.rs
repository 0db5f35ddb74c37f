//! Random events and inputs.
use servobench_motion::Limits;
use servobench_testkit::Random;

/// Fraction of the limits of each of two blocks whose motions are superimposed.
const PART: f64 = 0.5;

/// Random inputs of blocks.
pub(crate) struct Chance(Random);

impl Chance {
    pub(crate) const fn new(seed: u64) -> Self {
        Self(Random::seeded(seed))
    }

    pub(crate) fn between(&mut self, low: f64, high: f64) -> f64 {
        self.0.between(low, high)
    }

    pub(crate) fn once_in(&mut self, times: u64) -> bool {
        self.0.once_in(times)
    }

    pub(crate) fn one_of<T: Copy>(&mut self, choices: &[T]) -> T {
        self.0.one_of(choices)
    }

    /// `value`, or now and then one that no program should pass.
    pub(crate) fn input(&mut self, value: f64) -> f64 {
        if self.once_in(500) {
            return self.one_of(&[f64::NAN, f64::INFINITY, f64::NEG_INFINITY, 1e300, f64::MIN_POSITIVE, -0.0, -value]);
        }
        value
    }

    /// Limits of a block: random fractions of those of the axis, every other time so small that two blocks together keep them.
    pub(crate) fn limits(&mut self, axis: Limits) -> Limits {
        let whole = if self.once_in(2) { 1.0 } else { PART };
        let mut part = || {
            let part = whole * if self.once_in(2) { 1.0 } else { self.between(0.5, 1.0) };
            self.input(part)
        };
        Limits {
            velocity: part() * axis.velocity,
            acceleration: part() * axis.acceleration,
            jerk: part() * axis.jerk,
            snap: part() * axis.snap,
        }
    }

    /// Pairs of a table: times, and values of at most `most`.
    pub(crate) fn table(&mut self, most: f64) -> Vec<(f64, f64)> {
        let pairs = self.one_of(&[1, 2, 3, 5]);
        let quick = self.between(0.02, 0.6);
        let mut pair = || {
            let value = self.between(-most, most);
            (self.input(quick), self.input(value))
        };
        (0..pairs).map(|_| pair()).collect()
    }
}
