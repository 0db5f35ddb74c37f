//! Combinations of values, and draws in each of them.
use crate::axis::{Axis, Value};
use crate::draws::Draws;
use crate::error::SweepError;
use servobench_config::choices;
use std::collections::HashSet;

/// Largest number of points of a sweep.
pub const MOST_POINTS: usize = 100_000_000;

choices! {
    /// Combination of the values of several keys.
    pub enum Arrangement default Grid {
        /// Each value of one key with each value of the others; those of the last key follow each other.
        Grid = "grid",
        /// The first values of all keys, then the second ones, and so on.
        Zip = "zip",
    }
}

/// A key with its value in a run.
#[derive(Debug, Clone, PartialEq)]
pub struct Setting<'a> {
    /// The key: `setpoint.jerk`.
    pub key: &'a str,
    /// Its value.
    pub value: Value,
}

impl Setting<'_> {
    /// The setting as on the command line: `setpoint.jerk=50 m/s3`.
    #[must_use]
    pub fn written(&self) -> String {
        format!("{}={}", self.key, self.value.written())
    }
}

/// Keys that vary from run to run, with their values.
#[derive(Debug, Clone, PartialEq)]
pub struct Sweep {
    axes: Vec<Axis>,
    arrangement: Arrangement,
    draws: Option<Draws>,
    points: usize,
    /// Keys that have the value of another one: the other key, and the follower.
    followers: Vec<(String, String)>,
    /// Axes that are given rather than chosen.
    pub(crate) given: Vec<String>,
    /// Axes that belong to the machine, and so are given when combinations are chosen.
    pub(crate) machine: Vec<String>,
}

impl Sweep {
    /// The values of `axes`, and for each combination of them all of the `draws`: the same ones, so that combinations are compared on the
    /// same machines.
    ///
    /// # Errors
    /// [`SweepError::NoValues`], [`SweepError::Twice`], [`SweepError::UnequalLength`] with the key; [`SweepError::TooMany`].
    pub fn new(axes: Vec<Axis>, arrangement: Arrangement, draws: Option<Draws>) -> Result<Self, SweepError> {
        let mut taken = HashSet::new();
        let drawn = draws.iter().flat_map(Draws::keys).map(|drawn| &drawn.key);
        if let Some(key) = axes.iter().map(|axis| &axis.key).chain(drawn).find(|key| !taken.insert(key.as_str())) {
            return Err(SweepError::Twice { key: key.clone() });
        }
        if let Some(axis) = axes.iter().find(|axis| axis.values.is_empty()) {
            return Err(SweepError::NoValues { key: axis.key.clone() });
        }
        let combinations = combinations(&axes, arrangement)?;
        let draws_of_each = draws.as_ref().map_or(1, |draws| draws.count() as usize);
        let points = combinations.checked_mul(draws_of_each).filter(|points| *points <= MOST_POINTS);
        let points = points.ok_or(SweepError::TooMany { most: MOST_POINTS })?;
        Ok(Self { axes, arrangement, draws, points, followers: Vec::new(), given: Vec::new(), machine: Vec::new() })
    }

    /// Adds `followers`, which have the value of `key` in every run: the measured mode follows the frequency of the load.
    ///
    /// # Errors
    /// [`SweepError::Twice`], if one of them already varies.
    pub fn followed(mut self, key: &str, followers: &[String]) -> Result<Self, SweepError> {
        for follower in followers {
            let taken = self.keys().map(|(key, _)| key);
            if taken.chain(self.followers.iter().map(|(_, other)| other.as_str())).any(|taken| taken == follower) {
                return Err(SweepError::Twice { key: follower.clone() });
            }
            self.followers.push((key.to_owned(), follower.clone()));
        }
        Ok(self)
    }

    /// The keys of point `index` and their values, followers after all others.
    #[must_use]
    pub fn settings(&self, index: usize) -> Vec<Setting<'_>> {
        let mut settings = self.point(index);
        let following = self.followers.iter().filter_map(|(key, follower)| {
            let value = settings.iter().find(|setting| setting.key == key)?.value.clone();
            Some(Setting { key: follower, value })
        });
        let following: Vec<_> = following.collect();
        settings.extend(following);
        settings
    }

    /// Number of points.
    #[must_use]
    pub const fn points(&self) -> usize {
        self.points
    }

    /// The keys with listed values.
    #[must_use]
    pub fn axes(&self) -> &[Axis] {
        &self.axes
    }

    /// Method by which their values are combined.
    #[must_use]
    pub const fn arrangement(&self) -> Arrangement {
        self.arrangement
    }

    /// The draws in each combination of the axes, if any.
    #[must_use]
    pub const fn draws(&self) -> Option<&Draws> {
        self.draws.as_ref()
    }

    /// Number of draws per combination: 1 without draws.
    #[must_use]
    pub fn draws_of_each(&self) -> usize {
        self.draws.as_ref().map_or(1, |draws| draws.count() as usize)
    }

    /// Number of combinations of the axes: 1 without axes.
    #[must_use]
    pub fn combinations(&self) -> usize {
        self.points / self.draws_of_each()
    }

    /// The keys that vary with the units of their values, axes first, in the order of the settings of a point. The unit is empty for pure
    /// numbers and for texts.
    pub fn keys(&self) -> impl Iterator<Item = (&str, &str)> {
        let axes = self.axes.iter().map(|axis| (axis.key.as_str(), axis.values.first().map_or("", Value::unit)));
        let drawn = self.draws.iter().flat_map(Draws::keys);
        axes.chain(drawn.map(|drawn| (drawn.key.as_str(), drawn.unit.as_str())))
    }

    /// Values of the keys at point `index`; empty beyond the last one.
    #[must_use]
    pub fn point(&self, index: usize) -> Vec<Setting<'_>> {
        if index >= self.points {
            return Vec::new();
        }
        let (combination, draw) = (index / self.draws_of_each(), index % self.draws_of_each());
        let mut settings = self.combination(combination);
        if let (Some(draws), Ok(draw)) = (&self.draws, u32::try_from(draw)) {
            settings.extend(draws.settings(draw));
        }
        settings
    }

    /// Values of the axes at combination `index`, without draws; empty beyond the last one.
    #[must_use]
    pub fn combination(&self, index: usize) -> Vec<Setting<'_>> {
        let places = self.places(index);
        self.axes
            .iter()
            .zip(places)
            .map(|(axis, at)| Setting { key: &axis.key, value: axis.values[at].clone() })
            .collect()
    }

    /// Index, from 0, of the value of each axis at combination `index`; empty beyond the last one.
    #[must_use]
    pub fn places(&self, index: usize) -> Vec<usize> {
        if index >= self.combinations() {
            return Vec::new();
        }
        let mut rest = index;
        let mut places: Vec<usize> = self
            .axes
            .iter()
            .rev()
            .map(|axis| match self.arrangement {
                Arrangement::Zip => index,
                Arrangement::Grid => {
                    let at = rest % axis.values.len();
                    rest /= axis.values.len();
                    at
                }
            })
            .collect();
        places.reverse();
        places
    }
}

fn combinations(axes: &[Axis], arrangement: Arrangement) -> Result<usize, SweepError> {
    let Some(first) = axes.first() else { return Ok(1) };
    match arrangement {
        Arrangement::Grid => axes
            .iter()
            .try_fold(1_usize, |product, axis| product.checked_mul(axis.values.len()))
            .ok_or(SweepError::TooMany { most: MOST_POINTS }),
        Arrangement::Zip => match axes.iter().find(|axis| axis.values.len() != first.values.len()) {
            None => Ok(first.values.len()),
            Some(axis) => Err(SweepError::UnequalLength {
                first: first.key.clone(),
                expected: first.values.len(),
                key: axis.key.clone(),
                found: axis.values.len(),
            }),
        },
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Distribution, Drawn, Method};

    fn axis(key: &str, values: &[f64]) -> Axis {
        let values = values.iter().map(|value| Value::Number(*value, "m".into())).collect();
        Axis { key: key.into(), values }
    }

    fn draws(count: u32) -> Draws {
        let distribution = Distribution::Uniform { low: 1.0, high: 2.0 };
        Draws::new(count, 1, Method::Random, vec![Drawn { key: "mass".into(), unit: "kg".into(), distribution }])
            .unwrap()
    }

    fn written(sweep: &Sweep, index: usize) -> String {
        sweep.point(index).iter().map(Setting::written).collect::<Vec<_>>().join(" ")
    }

    #[test]
    fn a_grid_has_each_combination_once() {
        let axes = vec![axis("a", &[1.0, 2.0]), axis("b", &[3.0, 4.0, 5.0])];
        let sweep = Sweep::new(axes, Arrangement::Grid, None).unwrap();
        let all: Vec<_> = (0..sweep.points()).map(|index| written(&sweep, index)).collect();
        assert_eq!(all, ["a=1 m b=3 m", "a=1 m b=4 m", "a=1 m b=5 m", "a=2 m b=3 m", "a=2 m b=4 m", "a=2 m b=5 m"]);
        assert!(sweep.point(6).is_empty() && sweep.combination(6).is_empty() && sweep.places(6).is_empty());
        assert_eq!((sweep.places(4), sweep.combinations()), (vec![1, 1], 6));
    }

    #[test]
    fn a_zip_goes_through_all_keys_at_once() {
        let axes = vec![axis("a", &[1.0, 2.0]), axis("b", &[3.0, 4.0])];
        let sweep = Sweep::new(axes, Arrangement::Zip, None).unwrap();
        assert_eq!(
            (0..sweep.points()).map(|index| written(&sweep, index)).collect::<Vec<_>>(),
            ["a=1 m b=3 m", "a=2 m b=4 m"]
        );
        let unequal = Sweep::new(vec![axis("a", &[1.0]), axis("b", &[3.0, 4.0])], Arrangement::Zip, None);
        let message = unequal.unwrap_err().to_string();
        assert!(message.starts_with("`b` has 2 values and `a` 1"), "{message}");
    }

    /// All combinations have the same machines.
    #[test]
    fn each_combination_has_the_same_draws() {
        let sweep = Sweep::new(vec![axis("a", &[1.0, 2.0])], Arrangement::Grid, Some(draws(7))).unwrap();
        assert_eq!(sweep.points(), 14);
        for draw in 0..7 {
            let (one, other) = (sweep.point(draw), sweep.point(7 + draw));
            assert_eq!((one[0].written().as_str(), other[0].written().as_str()), ("a=1 m", "a=2 m"));
            assert_eq!(one[1], other[1]);
        }
        assert_eq!(sweep.keys().collect::<Vec<_>>(), [("a", "m"), ("mass", "kg")]);
        assert_eq!((sweep.combinations(), sweep.draws_of_each(), sweep.combination(1).len()), (2, 7, 1));
        let alone = Sweep::new(vec![], Arrangement::Grid, Some(draws(7))).unwrap();
        assert_eq!(alone.points(), 7);
        assert_eq!(alone.point(3)[0], sweep.point(3)[1]);
    }

    #[test]
    fn a_follower_has_the_value_of_its_key() {
        let sweep = Sweep::new(vec![axis("a", &[1.0, 2.0])], Arrangement::Grid, Some(draws(2))).unwrap();
        let sweep = sweep.followed("a", &["b".into(), "c".into()]).unwrap();
        let found: Vec<_> = sweep.settings(2).iter().map(Setting::written).collect();
        assert_eq!((found[0].as_str(), &found[2..]), ("a=2 m", &["b=2 m".to_owned(), "c=2 m".to_owned()][..]));
        assert!(found[1].starts_with("mass="), "{found:?}");
        for taken in ["a", "mass", "c"] {
            let refusal = sweep.clone().followed("a", &[taken.into()]).unwrap_err().to_string();
            assert!(refusal.contains("varies twice"), "{refusal}");
        }
    }

    #[test]
    fn what_cannot_be_combined_is_refused_by_name() {
        let refusal = |axes, draws| Sweep::new(axes, Arrangement::Grid, draws).unwrap_err().to_string();
        assert!(refusal(vec![axis("a", &[])], None).contains("`a` has no values"));
        assert!(refusal(vec![axis("a", &[1.0]), axis("a", &[2.0])], None).contains("`a` varies twice"));
        assert!(refusal(vec![axis("mass", &[1.0])], Some(draws(3))).contains("`mass` varies twice"));
        let long: Vec<f64> = (0..20_000).map(f64::from).collect();
        assert!(refusal(vec![axis("a", &long), axis("b", &long)], None).contains("more than 100000000 points"));
        let endless = ["a", "b", "c", "d", "e"].map(|key| axis(key, &long)).to_vec();
        assert!(refusal(endless, None).contains("more than 100000000 points"));
    }
}
