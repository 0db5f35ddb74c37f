//! A motion that is not a sum of decaying modes, by its reversals.
//!
//! A reversal is an extreme from which the motion has come back by more than a hysteresis. Between two of them is a swing.

/// Periods that reversals must show to have a frequency.
const PERIODS: f64 = 2.0;

/// Swings of a record.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Swings {
    /// Half of the largest swing (unit of the values).
    pub(crate) amplitude: f64,
    /// Periods between the first reversal and the last.
    pub(crate) periods: f64,
    /// One over twice the mean time between two reversals (Hz), where they show two periods.
    pub(crate) frequency: Option<f64>,
}

impl Swings {
    /// Swings of `values` with steps of `step` (s), with reversals larger than `hysteresis`. `None` where the motion never comes back:
    /// it rests or goes in one direction.
    ///
    /// A single reversal has a stretch before it and one after it. The smaller one counts: an overshoot is a swing, the last crumb of a
    /// tail is equally small.
    pub(crate) fn of(values: &[f64], step: f64, hysteresis: f64) -> Option<Self> {
        let (first, last) = (*values.first()?, *values.last()?);
        let reversals = reversals(values, hysteresis);
        let sizes = reversals.windows(2).map(|pair| (pair[1].1 - pair[0].1).abs());
        let largest = match *reversals.as_slice() {
            [] => return None,
            [(_, only)] => (only - first).abs().min((only - last).abs()),
            _ => sizes.fold(0.0, f64::max),
        };
        let intervals = reversals.len() - 1;
        let periods = intervals as f64 / 2.0;
        let time = (reversals[intervals].0 - reversals[0].0) as f64 * step;
        Some(Self { amplitude: largest / 2.0, periods, frequency: (periods >= PERIODS).then(|| periods / time) })
    }
}

/// Rows and values from which `values` come back by more than `hysteresis`.
fn reversals(values: &[f64], hysteresis: f64) -> Vec<(usize, f64)> {
    let mut found = Vec::new();
    let Some(&first) = values.first() else { return found };
    // Before the direction of the motion is known, the lowest and the highest value so far.
    let (mut low, mut high) = ((0, first), (0, first));
    let mut rises: Option<bool> = None;
    for (row, &y) in values.iter().enumerate() {
        if y > high.1 {
            high = (row, y);
        }
        if y < low.1 {
            low = (row, y);
        }
        let (falls_back, rises_back) = (high.1 - y > hysteresis, y - low.1 > hysteresis);
        match rises {
            Some(true) if falls_back => {
                found.push(high);
                (rises, low) = (Some(false), (row, y));
            }
            Some(false) if rises_back => {
                found.push(low);
                (rises, high) = (Some(true), (row, y));
            }
            // The first direction of a motion: its beginning is not a reversal.
            None if falls_back || rises_back => {
                rises = Some(rises_back);
                (low, high) = if rises_back { (low, (row, y)) } else { ((row, y), high) };
            }
            _ => {}
        }
    }
    found
}

#[cfg(test)]
mod tests {
    use super::*;
    use core::f64::consts::PI;

    fn record(at: impl Fn(f64) -> f64) -> Vec<f64> {
        (0..1000).map(|k| at(f64::from(k) * 1e-3)).collect()
    }

    fn of(at: impl Fn(f64) -> f64) -> Option<Swings> {
        Swings::of(&record(at), 1e-3, 0.1)
    }

    /// 1·cos at 5 Hz: crests at 0.1, 0.2, … 0.9 s, of which nine are seen; the one at 0 is the first value. Rows are 1 ms apart, crests lie
    /// on them.
    #[test]
    fn a_wave_has_its_amplitude_and_frequency() {
        let found = of(|t| 3.0 + (2.0 * PI * 5.0 * t).cos()).unwrap();
        assert!((found.amplitude - 1.0).abs() < 1e-4, "{found:?}");
        assert!((found.frequency.unwrap() - 5.0).abs() < 1e-9 && (found.periods - 4.0).abs() < 1e-12, "{found:?}");
        let upside_down = of(|t| -3.0 - (2.0 * PI * 5.0 * t).cos()).unwrap();
        assert_eq!(found.frequency, upside_down.frequency);
    }

    #[test]
    fn rest_and_one_way_have_no_swing() {
        assert_eq!(of(|_| 1.0), None);
        assert_eq!(of(|t| 5.0 * t), None);
        assert_eq!(of(|t| -(-t / 0.1).exp()), None);
        assert_eq!(of(|t| 0.04 * (300.0 * t).sin()), None, "below the hysteresis");
        assert_eq!(of(|t| 5.0 * t + 0.04 * (300.0 * t).sin()), None, "below the hysteresis on the way");
        assert_eq!(Swings::of(&[], 1e-3, 0.1), None);
    }

    /// 2 up and back by 1.5: the smaller one is the swing. 2 up and back by 0.2: a crumb.
    #[test]
    fn a_single_reversal_is_as_large_as_its_smaller_side() {
        let back = |by: f64| move |t: f64| if t < 0.5 { 4.0 * t } else { 2.0 - by * (t - 0.5) / 0.499 };
        for by in [1.5, 0.2] {
            let found = of(back(by)).unwrap();
            assert!((found.amplitude - by / 2.0).abs() < 1e-9 && found.frequency.is_none(), "{found:?}");
        }
    }

    /// Sawtooth of 1 with a pause in each: the frequency is that of the teeth.
    #[test]
    fn a_tooth_counts_once() {
        let tooth = |t: f64| {
            let phase = (t / 0.1).fract();
            if phase < 0.5 {
                2.0 * phase
            } else if phase < 0.6 {
                10.0 * (0.6 - phase)
            } else {
                0.0
            }
        };
        let found = of(tooth).unwrap();
        assert!((found.amplitude - 0.5).abs() < 1e-9, "{found:?}");
        assert!((found.frequency.unwrap() - 10.0).abs() < 0.5, "{found:?}");
    }
}
