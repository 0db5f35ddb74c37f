//! Draws of keys with a tolerance.
use crate::axis::Value;
use crate::distribution::Distribution;
use crate::error::SweepError;
use crate::random;
use crate::sweep::Setting;
use servobench_config::choices;

choices! {
    /// Sampling of a key's distribution.
    pub enum Method default LatinHypercube {
        /// Independent draws.
        Random = "random",
        /// One draw in each of as many equally likely parts as there are draws, in a random order for each key: fewer draws give as
        /// much information.
        LatinHypercube = "latin-hypercube",
    }
}

/// A key with a distribution.
#[derive(Debug, Clone, PartialEq)]
pub struct Drawn {
    /// The key: `axis.load.mass`.
    pub key: String,
    /// Unit of the values; empty for a pure number.
    pub unit: String,
    /// Distribution of its values.
    pub distribution: Distribution,
}

/// Keys that are drawn anew in each draw, independently of each other.
#[derive(Debug, Clone, PartialEq)]
pub struct Draws {
    count: u32,
    seed: u64,
    keys: Vec<Drawn>,
    /// Index of the part of its distribution for each draw of a key; empty for independent draws.
    parts: Vec<Vec<u32>>,
}

impl Draws {
    /// `count` draws of `keys`. The same seed yields the same draws on every machine; those of a key do not depend on the keys after it.
    ///
    /// # Errors
    /// [`SweepError::NothingDrawn`], [`SweepError::Distribution`].
    pub fn new(count: u32, seed: u64, method: Method, keys: Vec<Drawn>) -> Result<Self, SweepError> {
        if keys.is_empty() {
            return Err(SweepError::NothingDrawn("no key has a distribution"));
        }
        if count == 0 {
            return Err(SweepError::NothingDrawn("the number of draws is 0"));
        }
        for Drawn { key, distribution, .. } in &keys {
            if let Some(reason) = distribution.objection() {
                return Err(SweepError::Distribution { key: key.clone(), reason });
            }
        }
        let parts = match method {
            Method::Random => Vec::new(),
            Method::LatinHypercube => {
                (0..keys.len()).map(|key| random::order(stream(seed, key, Purpose::Order), count)).collect()
            }
        };
        Ok(Self { count, seed, keys, parts })
    }

    /// Number of draws.
    #[must_use]
    pub const fn count(&self) -> u32 {
        self.count
    }

    /// The keys that are drawn.
    #[must_use]
    pub fn keys(&self) -> &[Drawn] {
        &self.keys
    }

    /// The numbers of draw `index`, in the order of the keys.
    pub fn numbers(&self, index: u32) -> impl Iterator<Item = f64> {
        self.settings(index).filter_map(|setting| setting.value.number())
    }

    /// The values of draw `index`.
    pub(crate) fn settings(&self, index: u32) -> impl Iterator<Item = Setting<'_>> {
        self.keys.iter().enumerate().map(move |(key, drawn)| {
            let number = self.value(key, index);
            Setting { key: &drawn.key, value: Value::Number(number, drawn.unit.clone()) }
        })
    }

    /// The value of key `key` in draw `index`, in the unit of the key.
    pub(crate) fn value(&self, key: usize, index: u32) -> f64 {
        self.keys[key].distribution.quantile(self.share(key, index))
    }

    /// Share (between 0 and 1) of draw `index` in the distribution of key `key`.
    fn share(&self, key: usize, index: u32) -> f64 {
        let within = random::between(random::number(stream(self.seed, key, Purpose::Value), index.into()));
        match self.parts.get(key) {
            None => within,
            Some(parts) => in_part(parts[index as usize], within, self.count),
        }
    }
}

/// Share at `within` (0 to 1) of the part with index `part` of `count` equal parts. The last number of the last part would round to 1.
fn in_part(part: u32, within: f64, count: u32) -> f64 {
    ((f64::from(part) + within) / f64::from(count)).min(1.0 - f64::EPSILON / 2.0)
}

/// Purpose of a stream of random numbers.
#[derive(Clone, Copy)]
enum Purpose {
    Value,
    Order,
}

fn stream(seed: u64, key: usize, purpose: Purpose) -> u64 {
    random::stream(seed, 2 * key as u64 + purpose as u64)
}

#[cfg(test)]
mod tests {
    use super::*;

    const COUNT: u32 = 20_000;

    fn draws(method: Method, distribution: Distribution) -> Vec<f64> {
        let other = Distribution::Uniform { low: 0.0, high: 1.0 };
        let of = |key: &str, distribution| Drawn { key: key.into(), unit: "kg".into(), distribution };
        let draws = Draws::new(COUNT, 5, method, vec![of("other", other), of("mass", distribution)]).unwrap();
        (0..COUNT).map(|index| draws.settings(index).nth(1).unwrap().value.number().unwrap()).collect()
    }

    /// Mean and quantiles against the distribution, within three standard errors: σ/√n of the mean, √(p(1 − p)/n) of a share.
    #[test]
    fn draws_are_distributed_as_they_are_to_be() {
        let n = f64::from(COUNT);
        for (distribution, mean, sigma) in [
            (Distribution::Uniform { low: 2.0, high: 5.0 }, 3.5, 3.0 / 12_f64.sqrt()),
            (Distribution::Normal { mean: -1.0, sigma: 0.25 }, -1.0, 0.25),
            (Distribution::Triangular { low: 0.0, mode: 1.0, high: 4.0 }, 5.0 / 3.0, (13.0 / 18.0_f64).sqrt()),
        ] {
            for method in [Method::Random, Method::LatinHypercube] {
                let found = draws(method, distribution);
                let average = found.iter().sum::<f64>() / n;
                assert!((average - mean).abs() < 3.0 * sigma / n.sqrt(), "{distribution:?} {method:?}: {average}");
                for share in [0.01, 0.1, 0.5, 0.9, 0.99] {
                    let below = found.iter().filter(|x| **x < distribution.quantile(share)).count() as f64 / n;
                    let error = (share * (1.0 - share) / n).sqrt();
                    assert!((below - share).abs() < 3.0 * error, "{distribution:?} {method:?} {share}: {below}");
                }
            }
        }
    }

    /// Each of the equally likely parts of a hypercube has one draw.
    #[test]
    fn a_latin_hypercube_has_one_draw_in_each_part() {
        let mut found = draws(Method::LatinHypercube, Distribution::Uniform { low: 0.0, high: 1.0 });
        found.sort_by(f64::total_cmp);
        for (part, x) in found.iter().enumerate() {
            let (low, high) = (part as f64 / f64::from(COUNT), (part + 1) as f64 / f64::from(COUNT));
            assert!((low..=high).contains(x), "{part}: {x}");
        }
    }

    #[test]
    fn the_last_number_of_the_last_part_is_below_1() {
        let last = 1.0 - f64::EPSILON / 2.0;
        let normal = Distribution::Normal { mean: 0.0, sigma: 1.0 };
        for count in [1, 2, 3, 1_000, 10_000_000, u32::MAX] {
            let share = in_part(count - 1, last, count);
            assert!(share < 1.0 && normal.quantile(share).is_finite(), "{count}: {share}");
            assert!(in_part(0, f64::EPSILON / 2.0, count) > 0.0);
        }
    }

    /// Keys are uncorrelated: their correlation is that of independent draws, 1/√n.
    #[test]
    fn keys_are_drawn_independently() {
        for method in [Method::Random, Method::LatinHypercube] {
            let uniform = Distribution::Uniform { low: -1.0, high: 1.0 };
            let keys = ["a", "b", "c"].map(|key| Drawn { key: key.into(), unit: String::new(), distribution: uniform });
            let draws = Draws::new(COUNT, 1, method, keys.to_vec()).unwrap();
            let rows: Vec<Vec<f64>> = (0..COUNT)
                .map(|index| draws.settings(index).map(|setting| setting.value.number().unwrap()).collect())
                .collect();
            for (one, other) in [(0, 1), (0, 2), (1, 2)] {
                let product: f64 = rows.iter().map(|row| row[one] * row[other]).sum();
                let correlation = product * 3.0 / f64::from(COUNT);
                assert!(correlation.abs() < 3.0 / f64::from(COUNT).sqrt(), "{method:?} {one} {other}: {correlation}");
            }
        }
    }

    #[test]
    fn a_draw_does_not_depend_on_what_is_drawn_beside_it() {
        let of = |key: &str| Drawn {
            key: key.into(),
            unit: String::new(),
            distribution: Distribution::Normal { mean: 0.0, sigma: 1.0 },
        };
        for method in [Method::Random, Method::LatinHypercube] {
            let one = Draws::new(50, 3, method, vec![of("a")]).unwrap();
            let two = Draws::new(50, 3, method, vec![of("a"), of("b")]).unwrap();
            let other = Draws::new(50, 4, method, vec![of("a")]).unwrap();
            for index in 0..50 {
                assert_eq!(one.settings(index).next(), two.settings(index).next());
                assert_ne!(one.settings(index).next(), other.settings(index).next());
            }
        }
    }

    #[test]
    fn what_cannot_be_drawn_is_refused() {
        let of = |distribution| vec![Drawn { key: "load.mass".into(), unit: "kg".into(), distribution }];
        let good = Distribution::Normal { mean: 5.0, sigma: 1.0 };
        assert!(Draws::new(0, 1, Method::Random, of(good)).unwrap_err().to_string().contains("number of draws is 0"));
        assert!(Draws::new(5, 1, Method::Random, vec![]).unwrap_err().to_string().contains("no key"));
        let bad = Distribution::Normal { mean: 5.0, sigma: -1.0 };
        let refusal = Draws::new(5, 1, Method::Random, of(bad)).unwrap_err().to_string();
        assert!(refusal.starts_with("`load.mass`: the standard deviation -1"), "{refusal}");
    }
}
