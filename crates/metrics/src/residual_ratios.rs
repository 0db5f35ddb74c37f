//! Ratio of the residual vibrations of two set-points in modes around a frequency, by closed form.
use crate::undamped::undamped_residual;
use servobench_trace::Move;
use std::f64::consts::TAU;

/// Frequencies at which the ratio is computed. A lobe of the spectrum is 1/T wide, T the duration of the move: even of
/// a hundred lobes each gets twenty.
const STEPS: u32 = 2000;
/// Relative difference below which the lengths of two moving averages are the same.
const SAME: f64 = 1e-9;

/// Share of the frequencies that is left out at either end, as a divisor: a ratio has poles where a spectrum has its zeros, which no
/// real mode hits.
const LEFT_OUT: u32 = 10;

/// Ratio of the residual vibration of a reference set-point to that of another, for most modes around a frequency: above 1 if the
/// other leaves less.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ResidualRatios {
    /// Tenth percentile: one mode in ten has a smaller ratio.
    pub low: f64,
    /// Ninetieth percentile: one mode in ten has a larger ratio.
    pub high: f64,
}

impl ResidualRatios {
    /// Compares `this` with the reference `other`, for undamped modes within `around` (relative) of `frequency` (Hz); `None` unless both
    /// make one move of bounded order.
    #[must_use]
    pub fn of(this: &[Move], other: &[Move], frequency: f64, around: f64) -> Option<Self> {
        let ([this], [other]) = (this, other) else { return None };
        let (mut boxes, mut other_boxes) = (boxes(this)?, boxes(other)?);
        // Common moving averages cancel, and their zeros are not zeros of the ratio.
        boxes.retain(|length| {
            let same = other_boxes.iter().position(|other| (other - length).abs() <= SAME * length);
            same.map(|index| other_boxes.remove(index)).is_none()
        });
        let (distance, other_distance) = (this.to - this.from, other.to - other.from);
        let ratio = |k: u32| {
            let offset = around * (2.0 * f64::from(k) / f64::from(STEPS) - 1.0);
            let omega = TAU * frequency * (1.0 + offset);
            undamped_residual(other_distance, omega, &other_boxes) / undamped_residual(distance, omega, &boxes)
        };
        let mut ratios: Vec<f64> = (0..=STEPS).map(ratio).collect();
        ratios.sort_by(f64::total_cmp);
        let left_out = (STEPS / LEFT_OUT) as usize;
        Some(Self { low: ratios[left_out], high: ratios[ratios.len() - 1 - left_out] })
    }
}

/// Lengths (s) of the moving averages whose convolution is the velocity of `made`: each is the peak of a derivative over that of the
/// next, x/v, v/a, a/j, j/s, up to the order. `None` for a move without a distance.
fn boxes(made: &Move) -> Option<Vec<f64>> {
    let derivatives = [(made.to - made.from).abs()].into_iter().chain(made.peaks);
    let derivatives: Vec<f64> = derivatives.take_while(|peak| peak.is_finite() && *peak > 0.0).collect();
    (derivatives.len() > 2).then(|| derivatives.windows(2).map(|pair| pair[0] / pair[1]).collect())
}

#[cfg(test)]
mod tests {
    use super::*;
    use servobench_trace::Ending;

    /// By 1 m at 1 m/s, 5 m/s², 50 m/s³ and, of order 4, 1000 m/s⁴.
    fn lambrechts_move(order: usize) -> Move {
        let mut peaks = [1.0, 5.0, 50.0, 1000.0];
        peaks[order..].fill(f64::INFINITY);
        Move {
            label: String::new(),
            start: 0.0,
            end: 1.35,
            from: 0.0,
            to: 1.0,
            peaks,
            limits: [None; 4],
            cruise: (0.35, 0.65),
            ending: Ending::AtRest,
        }
    }

    /// The two moves of Lambrechts share the moving averages 1 s, 0.2 s and 0.1 s; the fourth, 0.05 s, is the whole ratio:
    /// x/|sin x| with x = 0.05·π·f. Up to its pole at 40 Hz it grows; within 1 % of 38.985 Hz it rises from 28 to 63, and
    /// without a tenth at either end from its value at 38.985·0.992 Hz to that at 38.985·1.008 Hz.
    #[test]
    fn the_ratio_is_that_of_the_box_that_only_one_has() {
        let (jerk, snap) = ([lambrechts_move(3)], [lambrechts_move(4)]);
        let (near, wide) =
            (ResidualRatios::of(&snap, &jerk, 38.985, 0.01), ResidualRatios::of(&snap, &jerk, 38.985, 0.1));
        let is_near = |found: f64, expected: f64| (found - expected).abs() < 1e-3 * expected;
        let near = near.unwrap();
        assert!(is_near(near.low, 29.3580) && is_near(near.high, 56.0031), "{near:?}");
        // Sorted over the frequencies, computed outside.
        let wide = wide.unwrap();
        assert!(is_near(wide.low, 9.31742) && is_near(wide.high, 102.331), "{wide:?}");
        let back = ResidualRatios::of(&jerk, &snap, 38.985, 0.01).unwrap();
        assert!(is_near(back.low, 1.0 / near.high) && is_near(back.high, 1.0 / near.low), "{back:?}");
    }

    #[test]
    fn what_has_no_closed_form_has_no_ratio() {
        let (jerk, snap) = ([lambrechts_move(3)], [lambrechts_move(4)]);
        assert_eq!(ResidualRatios::of(&[lambrechts_move(4), lambrechts_move(4)], &jerk, 30.0, 0.1), None);
        assert_eq!(ResidualRatios::of(&[], &jerk, 30.0, 0.1), None);
        let nowhere = Move { to: 0.0, ..lambrechts_move(3) };
        assert_eq!(ResidualRatios::of(&snap, &[nowhere], 30.0, 0.1), None);
    }
}
