//! Machines within tolerances: ranges of properties of the machine.
use crate::best::AdviseError;

/// Range of a property of the machine, from the lowest to the highest value (in its unit).
#[derive(Debug, Clone, PartialEq)]
pub struct Range {
    /// Its key: `axis.load.frequency`.
    pub key: String,
    /// Lowest and highest value.
    pub ends: [f64; 2],
    /// The unit of both.
    pub unit: String,
    /// Dependence of the mode's frequency on it.
    pub stretch: Stretch,
}

/// Dependence of a natural frequency on a property.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Stretch {
    /// The property is the frequency.
    Frequency,
    /// The frequency is proportional to its square root: a stiffness, or the inverse of a mass.
    Root,
    /// Independent: a damping.
    None,
}

/// The machines within tolerances. A machine is a value for each of the ranges, in their order.
#[derive(Debug, Clone, PartialEq)]
pub struct Machines {
    ranges: Vec<Range>,
}

/// Largest number of grid points along one range.
const MOST_ALONG: f64 = 2_000.0;

impl Machines {
    /// Machines with these ranges.
    #[must_use]
    pub const fn new(ranges: Vec<Range>) -> Self {
        Self { ranges }
    }

    /// The ranges.
    #[must_use]
    pub fn ranges(&self) -> &[Range] {
        &self.ranges
    }

    /// The machine in the middle.
    #[must_use]
    pub fn middle(&self) -> Vec<f64> {
        self.ranges.iter().map(|range| f64::midpoint(range.ends[0], range.ends[1])).collect()
    }

    /// Every corner once.
    #[must_use]
    pub fn corners(&self) -> Vec<Vec<f64>> {
        self.ranges.iter().fold(vec![Vec::new()], |corners, range| {
            let with = |end: f64| corners.iter().map(move |corner| [&corner[..], &[end]].concat());
            let [low, high] = range.ends;
            if low.to_bits() == high.to_bits() { with(low).collect() } else { with(low).chain(with(high)).collect() }
        })
    }

    /// Machines along each range that shifts a mode of `frequency` (Hz), between all corners of the others, with modes at most `spacing`
    /// (Hz) apart. Ends are corners, and omitted.
    ///
    /// # Errors
    /// [`AdviseError::TooWide`] with the range that would need more than 2 000 machines.
    pub fn along(&self, frequency: f64, spacing: f64) -> Result<Vec<Vec<f64>>, AdviseError> {
        let mut all = Vec::new();
        for (k, range) in self.ranges.iter().enumerate() {
            let [low, high] = range.ends;
            let width = match range.stretch {
                Stretch::Frequency => high - low,
                Stretch::Root => frequency * (0.5 * (high / low).ln()).abs(),
                Stretch::None => continue,
            };
            let steps = (width / spacing).ceil();
            if !(0.0..=MOST_ALONG).contains(&steps) {
                let needed = if steps.is_finite() { steps } else { f64::INFINITY };
                return Err(AdviseError::TooWide { key: range.key.clone(), needed, most: MOST_ALONG });
            }
            let others = self.ranges.iter().enumerate().filter(|(other, _)| *other != k);
            let others = Self::new(others.map(|(_, range)| range.clone()).collect()).corners();
            #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "0 to 2 000")]
            for step in 1..steps as usize {
                let share = step as f64 / steps;
                let value = match range.stretch {
                    Stretch::Root => low * (high / low).powf(share),
                    Stretch::Frequency | Stretch::None => low * (1.0 - share) + high * share,
                };
                all.extend(others.iter().map(|corner| [&corner[..k], &[value], &corner[k..]].concat()));
            }
        }
        Ok(all)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn range(key: &str, ends: [f64; 2], stretch: Stretch) -> Range {
        Range { key: key.into(), ends, unit: String::new(), stretch }
    }

    #[test]
    fn a_box_has_its_corners_and_lines_between_them() {
        let machines = Machines::new(vec![
            range("frequency", [14.0, 22.0], Stretch::Frequency),
            range("damping", [0.004, 0.04], Stretch::None),
        ]);
        assert_eq!(machines.middle(), [18.0, 0.022]);
        assert_eq!(machines.corners(), [vec![14.0, 0.004], vec![22.0, 0.004], vec![14.0, 0.04], vec![22.0, 0.04]]);
        // Nearer than a tenth of 1/0.5 s: 0.2 Hz, 8 Hz wide, at both dampings.
        let along = machines.along(18.0, 0.2).unwrap();
        assert_eq!(along.len(), 2 * 39);
        assert!(along.windows(2).all(|pair| (pair[1][0] - pair[0][0]).abs() < 0.2 + 1e-12));
        assert!(along.iter().all(|machine| machine[0] > 14.0 && machine[0] < 22.0));
    }

    #[test]
    fn a_mass_moves_a_mode_by_its_root() {
        let machines = Machines::new(vec![range("mass", [8.0, 12.5], Stretch::Root)]);
        let along = machines.along(20.0, 0.2).unwrap();
        // 20 Hz·ln(1.25) = 4.46 Hz in steps of less than 0.2 Hz.
        assert_eq!(along.len(), 22);
        for ends in [[1e-9, 1e300], [-1.0, 8.0], [0.0, 8.0]] {
            let wide = Machines::new(vec![range("mass", ends, Stretch::Root)]);
            assert!(matches!(wide.along(20.0, 1e-3), Err(AdviseError::TooWide { .. })), "{ends:?}");
        }
        let fixed = Machines::new(vec![range("mass", [8.0, 8.0], Stretch::Root)]);
        assert_eq!((fixed.corners().len(), fixed.along(20.0, 0.2).unwrap().len()), (1, 0));
    }
}
