//! Cosines and sines of angles at equal steps, by the addition theorems.
//!
//! Each depends on the one before, and a processor waits for it. So the angles are cut into stretches, which begin with fresh values and
//! are processed side by side: the same operations in the same order for each.
#![expect(clippy::inline_always, reason = "what is inlined is compiled for the registers of its caller")]

use servobench_base::wide_registers;

/// Steps between two fresh evaluations of the transcendental functions; each step rounds once.
pub(crate) const FRESH: usize = 64;
/// Number of such stretches that are processed side by side.
const LANES: usize = 8;
/// Values that are processed side by side.
pub(crate) const TOGETHER: usize = LANES * FRESH;

/// Fills in `cosines` and `sines`, one pair per value k. `fresh` gives the pair of a value, `step` is the pair of one step;
/// they are `cos √q·t` and `sin √q·t/√q`, `square` being q, which may be negative.
pub(crate) fn by_addition(
    fresh: impl Fn(usize) -> (f64, f64),
    step: (f64, f64),
    square: f64,
    cosines: &mut [f64],
    sines: &mut [f64],
) {
    let groups = cosines.chunks_mut(TOGETHER).zip(sines.chunks_mut(TOGETHER));
    for (group, (cosines, sines)) in groups.enumerate() {
        let mut here = [[0.0; LANES]; 2];
        let [c, s] = &mut here;
        let lanes = 0..cosines.len().div_ceil(FRESH);
        for (lane, (c, s)) in lanes.zip(c.iter_mut().zip(s)) {
            (*c, *s) = fresh((group * LANES + lane) * FRESH);
        }
        go_on(here, step, square, cosines, sines);
    }
}

/// Fills in `cosines` and `sines`, stretches of [`FRESH`] values whose first values are those in `here`, by the addition theorems,
/// which hold on either side of q = 0. `step` is the [`pair`] of one step.
fn go_on(here: [[f64; LANES]; 2], step: (f64, f64), square: f64, cosines: &mut [f64], sines: &mut [f64]) {
    wide_registers!(
        go_on_in_any(here, step, square, cosines, sines),
        go_on_in_wide_registers,
        here,
        step,
        square,
        cosines,
        sines
    );
}

#[cfg(target_arch = "x86_64")]
#[target_feature(enable = "avx2")]
fn go_on_in_wide_registers(
    here: [[f64; LANES]; 2],
    step: (f64, f64),
    square: f64,
    cosines: &mut [f64],
    sines: &mut [f64],
) {
    go_on_in_any(here, step, square, cosines, sines);
}

#[inline(always)]
fn go_on_in_any(
    [mut c, mut s]: [[f64; LANES]; 2],
    step: (f64, f64),
    square: f64,
    cosines: &mut [f64],
    sines: &mut [f64],
) {
    // Side by side in memory first: the columns have them far apart.
    let mut rows = [[[0.0; LANES]; 2]; FRESH];
    for row in &mut rows {
        *row = [c, s];
        for lane in 0..LANES {
            let (here, there) = (c[lane], s[lane]);
            c[lane] = here * step.0 - square * (there * step.1);
            s[lane] = here * step.1 + there * step.0;
        }
    }
    for (lane, (cosines, sines)) in cosines.chunks_mut(FRESH).zip(sines.chunks_mut(FRESH)).enumerate() {
        for ((cos, sin), [c, s]) in cosines.iter_mut().zip(sines).zip(&rows) {
            (*cos, *sin) = (c[lane], s[lane]);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Oracle: one value after the other, with fresh ones where they are due.
    #[test]
    fn the_bits_are_those_of_one_after_the_other() {
        for count in [0, 1, 63, 64, 65, 511, 512, 513, 1700] {
            for square in [4.0, -2.25, 0.0] {
                let fresh = |k: usize| (1.0 + k as f64 * 1e-3, 0.5 - k as f64 * 1e-4);
                let step = (0.999, 0.003);
                let mut found = [vec![0.0; count], vec![0.0; count]];
                let [cosines, sines] = &mut found;
                by_addition(fresh, step, square, cosines, sines);
                let mut here = (0.0, 0.0);
                for (k, (cos, sin)) in found[0].iter().zip(&found[1]).enumerate() {
                    here = if k % FRESH == 0 {
                        fresh(k)
                    } else {
                        (here.0 * step.0 - square * (here.1 * step.1), here.0 * step.1 + here.1 * step.0)
                    };
                    assert_eq!((cos.to_bits(), sin.to_bits()), (here.0.to_bits(), here.1.to_bits()), "{k} of {count}");
                }
            }
        }
    }

    #[test]
    fn both_kinds_of_processors_give_the_same_bits() {
        let mut random = servobench_testkit::Random::seeded(19);
        for count in [1, 64, 200, TOGETHER] {
            let here = [[(); LANES].map(|()| random.signed()), [(); LANES].map(|()| random.signed())];
            let (step, square) = ((0.99 + 0.01 * random.signed(), 0.1 * random.signed()), 3.0 * random.signed());
            let (mut one, mut other) = ([vec![0.0; count], vec![0.0; count]], [vec![0.0; count], vec![0.0; count]]);
            let [cosines, sines] = &mut one;
            go_on(here, step, square, cosines, sines);
            let [cosines, sines] = &mut other;
            go_on_in_any(here, step, square, cosines, sines);
            assert_eq!(
                one.map(|values| values.iter().map(|x| x.to_bits()).collect::<Vec<_>>()),
                other.map(|values| values.iter().map(|x| x.to_bits()).collect::<Vec<_>>())
            );
        }
    }
}
