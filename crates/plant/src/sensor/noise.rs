//! Gaussian noise by number: the n-th value of a stream follows from seed and n alone, whatever was drawn before.
//!
//! A 64-bit word of `SplitMix64` (Steele, Lea and Flood, OOPSLA 2014), whose n-th output is a mix of a counter, becomes a normal
//! variate by the ziggurat of Marsaglia and Tsang (Journal of Statistical Software 5(8), 2000) with 256 layers of equal area: a table
//! look-up for more than 98 % of the values. If a value is not accepted at once, further words come from a stream whose key is the first.
use std::sync::LazyLock;

/// Weyl increment of `SplitMix64`: the odd number next to 2⁶⁴ over the golden ratio.
const INCREMENT: u64 = 0x9e37_79b9_7f4a_7c15;
const LAYERS: usize = 256;
/// Beginning of the tail, with 256 layers: Marsaglia and Tsang 2000.
const TAIL: f64 = 3.654_152_885_361_008_8;

/// Right ends of the layers from the lowest on, and the heights of the density there.
#[derive(Debug)]
struct Layers {
    ends: [f64; LAYERS + 1],
    heights: [f64; LAYERS + 1],
}

/// The normal density without its factor.
fn density(x: f64) -> f64 {
    libm::exp(-x * x / 2.0)
}

static ZIGGURAT: LazyLock<Layers> = LazyLock::new(|| {
    let half_turn = core::f64::consts::PI / 2.0;
    let area = TAIL * density(TAIL) + libm::sqrt(half_turn) * libm::erfc(TAIL * core::f64::consts::FRAC_1_SQRT_2);
    // The lowest layer is as wide as its area, which includes the tail, requires.
    let (mut ends, mut x) = ([area / density(TAIL); LAYERS + 1], TAIL);
    for end in &mut ends[1..LAYERS] {
        *end = x;
        x = libm::sqrt(-2.0 * libm::log((area / x + density(x)).min(1.0)));
    }
    ends[LAYERS] = 0.0;
    Layers { ends, heights: ends.map(density) }
});

/// A stream of Gaussian noise.
#[derive(Debug, Clone, Copy)]
pub(super) struct Noise {
    key: u64,
    layers: &'static Layers,
}

impl Noise {
    /// The stream number `stream` of `seed`.
    pub(super) fn new(seed: u32, stream: u32) -> Self {
        Self { key: mix(u64::from(seed) << 32 | u64::from(stream)), layers: &ZIGGURAT }
    }

    /// Its `n`-th value, of mean 0 and variance 1.
    #[inline]
    pub(super) fn value(self, n: u64) -> f64 {
        let word = nth(self.key, n);
        let layer = (word & 0xff) as usize;
        let x = unit(word) * self.layers.ends[layer];
        let x = if x < self.layers.ends[layer + 1] { x } else { self.other(word, layer, x) };
        if word & 0x100 == 0 { x } else { -x }
    }

    /// Completes the value of `x`, which is beyond the part of its layer that is below the density throughout.
    #[cold]
    fn other(self, first: u64, layer: usize, x: f64) -> f64 {
        let Layers { ends, heights } = self.layers;
        let (mut layer, mut x) = (layer, x);
        for further in 0.. {
            let [height, again] = [0, 1].map(|k| nth(first, 2 * further + k));
            if layer == 0 {
                // Marsaglia 1964: the tail beyond, by two exponentials.
                let [x, y] = [height, again].map(|word| -libm::log(unit(word)));
                let x = x / TAIL;
                if 2.0 * y > x * x {
                    return TAIL + x;
                }
                continue;
            }
            if heights[layer] + unit(height) * (heights[layer + 1] - heights[layer]) < density(x) {
                return x;
            }
            layer = (again & 0xff) as usize;
            x = unit(again) * ends[layer];
            if x < ends[layer + 1] {
                return x;
            }
        }
        x
    }
}

/// The `n`-th word of the stream `key`.
#[inline]
const fn nth(key: u64, n: u64) -> u64 {
    mix(key.wrapping_add(n.wrapping_add(1).wrapping_mul(INCREMENT)))
}

/// The finaliser of `SplitMix64`.
#[inline]
const fn mix(word: u64) -> u64 {
    let word = (word ^ word >> 30).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    let word = (word ^ word >> 27).wrapping_mul(0x94d0_49bb_1331_11eb);
    word ^ word >> 31
}

/// A number between 0 and 1, exclusive, from the upper 52 bits of `word`; the lower ones choose layer and sign.
#[inline]
fn unit(word: u64) -> f64 {
    ((word >> 12) as f64 + 0.5) / (1_u64 << 52) as f64
}

#[cfg(test)]
mod tests {
    use super::*;

    const MANY: u64 = 800_000;

    /// Oracle: published outputs of `SplitMix64` from the state 1234567 (Vigna's reference code).
    #[test]
    fn the_words_are_those_of_the_published_generator() {
        assert_eq!([0, 1].map(|n| nth(1_234_567, n)), [6_457_827_717_110_365_317, 3_203_168_211_198_807_973]);
    }

    /// Oracle: the layers close at the top of the density, which they do for the published end of the tail alone.
    #[test]
    fn the_layers_are_of_equal_area_and_close() {
        let Layers { ends, heights } = &*ZIGGURAT;
        let area = ends[0] * heights[1];
        for layer in 1..LAYERS {
            let found = ends[layer] * (heights[layer + 1] - heights[layer]);
            // The top gathers the roundings of 255 layers.
            assert!((found / area - 1.0).abs() < 1e-9, "{layer}: {found} {area}");
        }
        // Their programs give it to ten digits.
        assert!((area / 0.004_928_673_233_99 - 1.0).abs() < 1e-10, "{area}");
        let at_once = ends.windows(2).map(|layer| layer[1] / layer[0]).sum::<f64>() / LAYERS as f64;
        assert!((0.98..0.99).contains(&at_once), "{at_once}");
    }

    /// Oracle: moments and shares of the normal distribution. Their standard deviations over n values are 1/√n of a mean,
    /// √2/√n of a variance, √96/√n of a fourth moment, √(p(1−p)/n) of a share; five of them are allowed.
    #[test]
    fn it_is_normal() {
        for (seed, stream) in [(0, 0), (1, 2), (77, 3)] {
            let noise = Noise::new(seed, stream);
            let values: Vec<f64> = (0..MANY).map(|n| noise.value(n)).collect();
            let (count, root) = (values.len() as f64, (values.len() as f64).sqrt());
            let mean = |of: fn(f64) -> f64| values.iter().map(|x| of(*x)).sum::<f64>() / count;
            assert!(mean(|x| x).abs() < 5.0 / root);
            assert!((mean(|x| x * x) - 1.0).abs() < 5.0 * 2.0_f64.sqrt() / root);
            assert!((mean(|x| x.powi(4)) - 3.0).abs() < 5.0 * 96.0_f64.sqrt() / root);
            // Shares within a bound: in the top layers, at their edges, and in the tail.
            for bound in [0.05, 0.3, 1.0, 2.0, 3.0, 3.5, TAIL, 4.0] {
                let share = libm::erf(bound * core::f64::consts::FRAC_1_SQRT_2);
                let found = values.iter().filter(|x| x.abs() < bound).count() as f64 / count;
                let deviation = (share * (1.0 - share) / count).sqrt();
                assert!((found - share).abs() < 5.0 * deviation, "{bound}: {found} {share}");
            }
        }
    }

    /// From one value to the next, and between streams: correlations of 1/√n, five times that allowed.
    #[test]
    fn it_is_white_and_streams_are_strangers() {
        let (one, other, reseeded) = (Noise::new(5, 1), Noise::new(5, 2), Noise::new(6, 1));
        let correlation = |first: &dyn Fn(u64) -> f64, second: &dyn Fn(u64) -> f64| {
            (0..MANY).map(|n| first(n) * second(n)).sum::<f64>() / MANY as f64
        };
        let bound = 5.0 / (MANY as f64).sqrt();
        let value = |n: u64| one.value(n);
        for (what, second) in [
            ("next", &(|n: u64| one.value(n + 1)) as &dyn Fn(u64) -> f64),
            ("second next", &|n| one.value(n + 2)),
            ("seventh next", &|n| one.value(n + 7)),
            ("stream", &|n| other.value(n)),
            ("seed", &|n| reseeded.value(n)),
        ] {
            let found = correlation(&value, second);
            assert!(found.abs() < bound, "{what}: {found}");
        }
        assert!((correlation(&value, &value) - 1.0).abs() < bound * 2.0, "and it is found where there is one");
    }

    #[test]
    fn a_value_follows_from_its_number_alone() {
        let noise = Noise::new(9, 1);
        let forwards: Vec<_> = (0..2000).map(|n| noise.value(n)).collect();
        let backwards: Vec<_> = (0..2000).rev().map(|n| noise.value(n)).collect();
        assert!(forwards.iter().eq(backwards.iter().rev()));
        assert!([0, u64::MAX / 2, u64::MAX].iter().all(|n| noise.value(*n).is_finite()));
    }
}
