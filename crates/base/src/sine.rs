//! Sine and cosine for the angles of a motor, inlined into the loop.
//!
//! A library function is a call, before which a processor with wide registers has to empty them. Up to a million radians these are the
//! same operations as in `libm`, one for one, for identical bits; all other arguments are passed to `libm`.
//!
//! Source: fdlibm (Sun Microsystems, 1993), `k_sin.c`, `k_cos.c`, `e_rem_pio2.c`: the coefficients of the polynomials, π/2 in two parts,
//! the bounds of the cases.
#![expect(clippy::inline_always, reason = "what is inlined is compiled for the registers of its caller")]

use core::f64::consts::FRAC_2_PI;

/// High word of π/4: up to there no reduction is needed.
const EIGHTH: u32 = 0x3fe9_21fb;
/// High word of 2⁻²⁷·√2: below it the sine equals the angle.
const TINY: u32 = 0x3e46_a09e;
/// High words of 9π/4 and 2²⁰·π/2, between which any number of quarter turns is subtracted.
const MANY: core::ops::Range<u32> = 0x401c_463c..0x4139_21fb;

/// Sine and cosine of `x` (rad).
#[inline(always)]
pub(crate) fn sincos(x: f64) -> (f64, f64) {
    let high = (x.to_bits() >> 32) as u32 & 0x7fff_ffff;
    if high <= EIGHTH {
        let (cubic, higher) = sine_terms(x);
        let sine = if high < TINY { x } else { x + cubic * (S1 + x * x * higher) };
        return (sine, cosine(x, 0.0));
    }
    if let Some((quarters, x, tail)) = reduced(x, high) {
        let (cubic, higher) = sine_terms(x);
        let sine = x - ((x * x * (0.5 * tail - cubic * higher) - tail) - cubic * S1);
        return turned(quarters, sine, cosine(x, tail));
    }
    libm::sincos(x)
}

const S1: f64 = -1.666_666_666_666_663_243_48e-1;
const S2: f64 = 8.333_333_333_322_489_461_24e-3;
const S3: f64 = -1.984_126_982_985_794_931_34e-4;
const S4: f64 = 2.755_731_370_707_006_767_89e-6;
const S5: f64 = -2.505_076_025_340_686_341_95e-8;
const S6: f64 = 1.589_690_995_211_550_102_21e-10;
const C1: f64 = 4.166_666_666_666_660_190_37e-2;
const C2: f64 = -1.388_888_888_887_410_957_49e-3;
const C3: f64 = 2.480_158_728_947_672_941_78e-5;
const C4: f64 = -2.755_731_435_139_066_330_35e-7;
const C5: f64 = 2.087_572_321_298_174_827_90e-9;
const C6: f64 = -1.135_964_755_778_819_482_65e-11;

/// `x³`, and the polynomial for the coefficients after the first.
#[inline(always)]
fn sine_terms(x: f64) -> (f64, f64) {
    let z = x * x;
    (z * x, S2 + z * (S3 + z * S4) + z * (z * z) * (S5 + z * S6))
}

/// The cosine of `x + tail`, |x| up to π/4.
#[inline(always)]
fn cosine(x: f64, tail: f64) -> f64 {
    let z = x * x;
    let terms = z * (C1 + z * (C2 + z * C3)) + (z * z) * (z * z) * (C4 + z * (C5 + z * C6));
    let half = 0.5 * z;
    let one = 1.0 - half;
    one + (((1.0 - one) - half) + (z * terms - x * tail))
}

/// Number of quarter turns, and the remaining angle in two parts; `None` where three parts of π/2 do not suffice.
#[inline(always)]
fn reduced(x: f64, high: u32) -> Option<(i32, f64, f64)> {
    /// Adding this number rounds to a whole number: numbers from here on have no fraction.
    const WHOLE: f64 = 1.5 / f64::EPSILON;
    const QUARTER: f64 = 1.570_796_326_734_125_614_17;
    const QUARTER_TAIL: f64 = 6.077_100_506_506_192_249_32e-11;
    const SECOND: f64 = 6.077_100_506_303_965_976_60e-11;
    const SECOND_TAIL: f64 = 2.022_266_248_795_950_631_54e-21;
    /// Bits that may cancel before the second part is subtracted from the tail, and before a third one would be needed.
    const LOST: [u32; 2] = [16, 49];
    let count = x * FRAC_2_PI + WHOLE - WHOLE;
    let exponent = |y: f64| (y.to_bits() >> 52) as u32 & 0x7ff;
    let cancels = |first: f64, lost: u32| exponent(first) + lost < high >> 20;
    let (mut rest, mut tail) = (x - count * QUARTER, count * QUARTER_TAIL);
    let mut first = rest - tail;
    let mut is_told = MANY.contains(&high);
    if cancels(first, LOST[0]) {
        // At whole turns, where axes often stop.
        let before = rest;
        let second = count * SECOND;
        rest = before - second;
        tail = count * SECOND_TAIL - ((before - rest) - second);
        first = rest - tail;
        is_told &= !cancels(first, LOST[1]);
    }
    #[expect(clippy::cast_possible_truncation, reason = "a whole number below 2²¹")]
    let quarters = count as i32;
    is_told.then_some((quarters, first, (rest - first) - tail))
}

/// Sine and cosine advanced by `quarters` quarter turns.
#[inline(always)]
fn turned(quarters: i32, sine: f64, cosine: f64) -> (f64, f64) {
    let (sine, cosine) = if quarters & 1 == 0 { (sine, cosine) } else { (cosine, sine) };
    let signed = |value: f64, is_negative: bool| if is_negative { -value } else { value };
    (signed(sine, quarters & 2 != 0), signed(cosine, (quarters + 1) & 2 != 0))
}

#[cfg(test)]
mod tests {
    use super::*;
    use core::f64::consts::{FRAC_PI_2, FRAC_PI_4, PI};

    fn is_same(x: f64) -> bool {
        let ((sine, cosine), (of_sine, of_cosine)) = (sincos(x), libm::sincos(x));
        sine.to_bits() == of_sine.to_bits() && cosine.to_bits() == of_cosine.to_bits()
    }

    /// Numbers of a generator (Steele & Vigna, `SplitMix64`): of one magnitude, then of every magnitude.
    #[test]
    fn the_bits_are_those_of_the_library() {
        let mut state = 19_u64;
        let mut random = || {
            state = state.wrapping_add(0x9e37_79b9_7f4a_7c15);
            let z = (state ^ (state >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
            let z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
            z ^ (z >> 31)
        };
        for size in [1e-9, 1e-6, 1e-3, 0.1, FRAC_PI_4, 2.0, 8.0, 100.0, 1e4, 1e6, 1e8] {
            for _ in 0..20_000 {
                let x = (random() as f64 / 2_f64.powi(63) - 1.0) * size;
                assert!(is_same(x), "{x:e}");
            }
        }
        for _ in 0..100_000 {
            let x = f64::from_bits(random());
            assert!(x.is_nan() || is_same(x), "{x:e}");
        }
    }

    /// At multiples of an eighth of a turn and a few numbers on either side, and at the boundaries between cases.
    #[test]
    fn the_bits_are_those_of_the_library_where_cases_meet() {
        let eighths = (-80..=80).chain([1_000, 65_536, 1 << 20, (1 << 22) + 2]).map(|k| f64::from(k) * FRAC_PI_4);
        let words = [EIGHTH, TINY, MANY.start, MANY.end].map(|high| f64::from_bits(u64::from(high) << 32));
        for x in eighths.chain(words).chain([0.0, -0.0, FRAC_PI_2, PI, 1e-320, 1e300, f64::INFINITY]) {
            for step in -300..=300 {
                let x = f64::from_bits(x.to_bits().wrapping_add_signed(step));
                for x in [x, -x] {
                    assert!(x.is_nan() || sincos(x).0.is_nan() || is_same(x), "{x:e}");
                }
            }
        }
        assert!(sincos(f64::NAN).0.is_nan() && sincos(f64::INFINITY).1.is_nan());
    }
}
