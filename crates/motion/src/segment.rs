//! Switching of the highest derivative: pulses and dwells in the order of time.
use crate::Profile;
use crate::profile::Boxes;
use core::array::from_fn;
use core::cmp::Ordering;
use servobench_base::Setpoint;

/// A stretch of time in which the highest derivative is constant.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Segment {
    /// Time since the start of the move (s).
    pub start: f64,
    /// Length (s), above zero.
    pub length: f64,
    /// Acceleration, jerk or snap by order (SI), with the sign of the direction; zero in a dwell.
    pub value: f64,
}

/// The segments of a [`Profile`] that last longer than zero, from the first to the last.
#[derive(Debug, Clone)]
pub struct Segments<'a> {
    profile: &'a Profile,
    next: usize,
}

impl<'a> Segments<'a> {
    pub(crate) const fn of(profile: &'a Profile) -> Self {
        Self { profile, next: 0 }
    }
}

impl Iterator for Segments<'_> {
    type Item = Segment;

    fn next(&mut self) -> Option<Segment> {
        while self.next < MOST {
            let segment = self.profile.box_units().map_or_else(
                || turned(self.profile, self.next),
                |boxes| {
                    let n = self.profile.order().derivative();
                    (self.next < (1 << n) - 1).then(|| nth(boxes, n, self.profile.amplitude(), self.next))
                },
            );
            self.next += 1;
            if let Some(segment) = segment.filter(|segment| segment.length > 0.0) {
                return Some(segment);
            }
        }
        None
    }
}

/// Maximum number of segments.
const MOST: usize = 16;

/// Segment `i` of 16 of a move of order 4 whose second half is the first one rotated about the middle: s(t) = −s(T − t).
fn turned(profile: &Profile, i: usize) -> Option<Segment> {
    if i < MOST / 2 {
        return profile.first_half(i);
    }
    let Segment { start, length, value } = profile.first_half((MOST - 1).checked_sub(i)?)?;
    Some(Segment { start: profile.duration() - start - length, length, value: 0.0 - value })
}

/// Segment `i` of the 2ⁿ − 1 of a step of `amplitude` through n moving averages (`boxes`), those of length zero included.
///
/// Pulse p = i/2 starts at the sum of the lengths `T2, T3, …` that the bits of p select and has the sign (−1)^(number of
/// bits). The dwell behind it is that of average 2 + (trailing zeros of p + 1).
pub(crate) fn nth(boxes: &Boxes, n: usize, amplitude: f64, i: usize) -> Segment {
    let Boxes { lengths, dwells, unit, .. } = boxes;
    let pulse = i / 2;
    let mut start = 0.0;
    for (bit, length) in lengths[1..n].iter().enumerate() {
        if pulse >> bit & 1 == 1 {
            start += length;
        }
    }
    if i.is_multiple_of(2) {
        let value = if pulse.count_ones().is_multiple_of(2) { amplitude } else { -amplitude };
        Segment { start: start * unit, length: lengths[0] * unit, value }
    } else {
        let dwell = dwells[1 + (pulse + 1).trailing_zeros() as usize];
        Segment { start: (start + lengths[0]) * unit, length: dwell * unit, value: 0.0 }
    }
}

/// Starts (s) of the segments of the first half of a step through n moving averages (`boxes`), the cruise included, as in [`nth`];
/// infinite beyond the order.
pub(crate) fn starts(boxes: &Boxes, n: usize) -> [f64; MOST / 2] {
    let [first, second, third, _] = boxes.lengths;
    let pulses = [0.0, second, third, second + third];
    from_fn(|i| if i < 1 << (n - 1) { (pulses[i / 2] + [0.0, first][i % 2]) * boxes.unit } else { f64::INFINITY })
}

/// Their lengths (s); zero beyond the order.
pub(crate) fn lengths(boxes: &Boxes, n: usize) -> [f64; MOST / 2] {
    let [pulse, second, third, fourth] = boxes.dwells;
    let lengths = [pulse, second, pulse, third, pulse, second, pulse, fourth];
    from_fn(|i| if i < 1 << (n - 1) { lengths[i] * boxes.unit } else { 0.0 })
}

/// The states at their starts: from rest through pulses of `amplitude`, which `set` makes the highest derivative, to the
/// last, the `cruise`.
pub(crate) fn anchors<const CRUISE: usize>(
    set: impl Fn(&mut Setpoint, f64),
    amplitude: f64,
    lengths: &[f64; MOST / 2],
    cruise: Setpoint,
) -> [Setpoint; MOST / 2] {
    let values = [amplitude, 0.0, -amplitude, 0.0, -amplitude, 0.0, amplitude];
    let mut state = Setpoint::default();
    from_fn(|i| match i.cmp(&CRUISE) {
        Ordering::Less => {
            set(&mut state, values[i]);
            let anchor = state;
            state = state.after(lengths[i]);
            anchor
        }
        Ordering::Equal => cruise,
        Ordering::Greater => Setpoint::default(),
    })
}
