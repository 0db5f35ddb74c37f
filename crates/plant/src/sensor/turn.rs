//! Sine and cosine of a share of a turn, inlined into the loop.
#![expect(clippy::inline_always, reason = "what is inlined is compiled for the registers of its caller")]
use core::f64::consts::TAU;
use servobench_base::{ElectricalAngle, Rotation};

/// The nearest whole number, below 2⁵¹: larger numbers have no fraction, so that a sum with one is rounded.
#[inline(always)]
pub(super) fn whole(x: f64) -> f64 {
    const WHOLE: f64 = 1.5 / f64::EPSILON;
    x + WHOLE - WHOLE
}

/// The rotation by `turns` turns, from which whole ones and quarters are subtracted without rounding.
#[inline(always)]
pub(super) fn rotation(turns: f64) -> Rotation {
    let quarters = whole(4.0 * turns);
    let Rotation { sin, cos } = ElectricalAngle(TAU * (turns - quarters / 4.0)).rotation();
    #[expect(clippy::cast_possible_truncation, reason = "a whole number, well below 2⁶¹ turns")]
    let quarters = quarters as i64;
    let (sin, cos) = if quarters & 1 == 0 { (sin, cos) } else { (cos, sin) };
    let signed = |value: f64, is_negative: bool| if is_negative { -value } else { value };
    Rotation { sin: signed(sin, quarters & 2 != 0), cos: signed(cos, (quarters + 1) & 2 != 0) }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Oracle: the angle itself. A rounding of the angle, and one of each.
    #[test]
    fn it_is_the_rotation_of_the_angle() {
        for k in -4000..4000 {
            let turns = f64::from(k) * 0.001_37 + 1e-7;
            let (found, (sine, cosine)) = (rotation(turns), (TAU * turns).sin_cos());
            let bound = 4.0 * f64::EPSILON * (1.0 + TAU * turns.abs());
            assert!((found.sin - sine).abs() < bound && (found.cos - cosine).abs() < bound, "{turns}: {found:?}");
        }
        for (turns, sin, cos) in
            [(0.0, 0.0, 1.0), (0.25, 1.0, 0.0), (-0.5, 0.0, -1.0), (0.75, -1.0, 0.0), (9.0, 0.0, 1.0)]
        {
            let found = rotation(turns);
            assert!((found.sin - sin).abs() + (found.cos - cos).abs() == 0.0, "{turns}: {found:?}, exactly");
        }
    }
}
