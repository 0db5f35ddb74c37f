//! Where the highest derivative switches: pulses and dwells in the order of time.
use crate::Profile;

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
        while self.next < (2 << (self.profile.order().derivative() - 1)) - 1 {
            let segment = nth(self.profile, self.next);
            self.next += 1;
            if segment.length > 0.0 {
                return Some(segment);
            }
        }
        None
    }
}

/// Segment `i` of the 2ⁿ − 1 that order n has, those of length zero included.
///
/// Pulse p = i/2 starts at the sum of the boxes `T2, T3, …` that the bits of p select and has the sign (−1)^(number of
/// bits). The dwell behind it is that of box 2 + (trailing zeros of p + 1).
pub(crate) fn nth(profile: &Profile, i: usize) -> Segment {
    let unit = profile.unit();
    let (boxes, dwells) = (profile.box_units(), profile.dwell_units());
    let pulse = i / 2;
    let mut start = 0.0;
    for (bit, length) in boxes[1..].iter().enumerate() {
        if pulse >> bit & 1 == 1 {
            start += length;
        }
    }
    if i.is_multiple_of(2) {
        let value = if pulse.count_ones().is_multiple_of(2) { profile.amplitude() } else { -profile.amplitude() };
        Segment { start: start * unit, length: boxes[0] * unit, value }
    } else {
        let dwell = dwells[1 + (pulse + 1).trailing_zeros() as usize];
        Segment { start: (start + boxes[0]) * unit, length: dwell * unit, value: 0.0 }
    }
}
