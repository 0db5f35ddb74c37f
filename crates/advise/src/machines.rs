//! A box of machines: what a property of the machine may be.

/// What a property of the machine is, from the lowest to the highest value (in whatever unit it has).
#[derive(Debug, Clone, PartialEq)]
pub struct Range {
    /// Its key: `axis.load.frequency`.
    pub key: String,
    /// Lowest and highest value.
    pub ends: [f64; 2],
    /// The unit of both.
    pub unit: String,
    /// Whether, and how, the frequency of the mode goes with it.
    pub stretch: Stretch,
}

/// How a natural frequency goes with a property.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Stretch {
    /// It is the frequency.
    Frequency,
    /// The frequency goes with its square root: a stiffness, or the inverse of a mass.
    Root,
    /// Not at all: a damping.
    None,
}

/// The machines of a box. A machine is a value for each of the ranges, in their order.
#[derive(Debug, Clone, PartialEq)]
pub struct Machines {
    ranges: Vec<Range>,
}

/// Points of a grid along one range, at most.
const MOST_ALONG: usize = 2_000;

impl Machines {
    /// Those of these ranges.
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

    /// Machines along each range that moves a mode of `frequency` (Hz), between all corners of the others, nearer to each other than a tenth
    /// of a lobe of a profile whose longest box is `longest` (s): 0.1/longest in frequency. Ends are corners, and left out.
    #[must_use]
    pub fn along(&self, frequency: f64, longest: f64, lobe: f64) -> Vec<Vec<f64>> {
        let mut all = Vec::new();
        for (k, range) in self.ranges.iter().enumerate() {
            let [low, high] = range.ends;
            let width = match range.stretch {
                Stretch::Frequency => high - low,
                Stretch::Root => frequency * (0.5 * (high / low).abs().ln()).abs(),
                Stretch::None => 0.0,
            };
            let steps = (width * longest / lobe).ceil();
            #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "within the bounds")]
            let steps = if steps.is_finite() { (steps.max(0.0) as usize).min(MOST_ALONG) } else { 0 };
            let others =
                Self::new(self.ranges.iter().enumerate().filter(|(i, _)| *i != k).map(|(_, r)| r.clone()).collect());
            for step in 1..steps {
                let share = step as f64 / steps as f64;
                let value = match range.stretch {
                    Stretch::Root => low * (high / low).powf(share),
                    Stretch::Frequency | Stretch::None => low * (1.0 - share) + high * share,
                };
                all.extend(others.corners().into_iter().map(|mut corner| {
                    corner.insert(k, value);
                    corner
                }));
            }
        }
        all
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
        let along = machines.along(18.0, 0.5, 0.1);
        assert_eq!(along.len(), 2 * 39);
        assert!(along.windows(2).all(|pair| (pair[1][0] - pair[0][0]).abs() < 0.2 + 1e-12));
        assert!(along.iter().all(|machine| machine[0] > 14.0 && machine[0] < 22.0));
    }

    #[test]
    fn a_mass_moves_a_mode_by_its_root() {
        let machines = Machines::new(vec![range("mass", [8.0, 12.5], Stretch::Root)]);
        let along = machines.along(20.0, 0.5, 0.1);
        // 20 Hz·ln(1.25) = 4.46 Hz in steps of less than 0.2 Hz.
        assert_eq!(along.len(), 22);
        let fixed = Machines::new(vec![range("mass", [8.0, 8.0], Stretch::Root)]);
        assert_eq!((fixed.corners().len(), fixed.along(20.0, 0.5, 0.1).len()), (1, 0));
    }
}
