//! A few points that cover every value, to find mistakes of a sweep before it runs.
use crate::axis::Value;
use crate::draws::Draws;
use crate::sweep::{Arrangement, Sweep};
use std::collections::BTreeSet;

/// A key that varies, as a column of a table.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct KeyColumn<'a> {
    /// The key.
    pub key: &'a str,
    /// The unit of its numbers, empty for pure numbers; `None` unless all values are numbers in one unit.
    pub unit: Option<&'a str>,
}

impl Sweep {
    /// Points in ascending order that cover all combinations if there are at most `most` of them, or else each value of each axis,
    /// with the first values of the others; and for each drawn key its least and its greatest value.
    #[must_use]
    pub fn cover(&self, most: usize) -> Vec<usize> {
        let draws = self.draws_of_each();
        let combinations: BTreeSet<usize> = match self.arrangement() {
            _ if self.combinations() <= most => (0..self.combinations()).collect(),
            Arrangement::Zip => (0..self.combinations()).collect(),
            Arrangement::Grid => {
                let mut stride = self.combinations();
                let of_axis = self.axes().iter().flat_map(|axis| {
                    stride /= axis.values.len();
                    let stride = stride;
                    (0..axis.values.len()).map(move |value| value * stride)
                });
                of_axis.collect()
            }
        };
        let mut points: BTreeSet<usize> = combinations.into_iter().map(|combination| combination * draws).collect();
        let drawn = self.draws().map_or(0, |draws| draws.keys().len());
        for key in self.axes().len()..self.axes().len() + drawn {
            let number = |draw: usize| self.value(draw, key).and_then(|value| value.number()).unwrap_or(f64::NAN);
            let first = (number(0), 0);
            let (least, greatest) = (1..draws).fold((first, first), |(least, greatest), draw| {
                let number = number(draw);
                let less = if number < least.0 { (number, draw) } else { least };
                (less, if number > greatest.0 { (number, draw) } else { greatest })
            });
            points.extend([least.1, greatest.1]);
        }
        points.into_iter().collect()
    }

    /// The keys that vary as columns, axes first, in the order of the settings of a point.
    pub fn columns(&self) -> impl Iterator<Item = KeyColumn<'_>> {
        let axes = self.axes().iter().map(|axis| {
            let unit = axis.values.first().map_or("", Value::unit);
            let is_one = |value: &Value| value.number().is_some() && value.unit() == unit;
            KeyColumn { key: &axis.key, unit: axis.values.iter().all(is_one).then_some(unit) }
        });
        let drawn = self.draws().into_iter().flat_map(Draws::keys);
        axes.chain(drawn.map(|drawn| KeyColumn { key: &drawn.key, unit: Some(&drawn.unit) }))
    }

    /// The value at point `index` of the key in column `key`; `None` beyond the last ones.
    #[must_use]
    pub fn value(&self, index: usize, key: usize) -> Option<Value> {
        self.point(index).into_iter().nth(key).map(|setting| setting.value)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Axis, Distribution, Drawn, Draws, Method};

    fn axis(key: &str, values: &[f64]) -> Axis {
        let values = values.iter().map(|value| Value::Number(*value, "m".into())).collect();
        Axis { key: key.into(), values }
    }

    fn draws() -> Draws {
        let distribution = Distribution::Uniform { low: 1.0, high: 2.0 };
        let drawn = |key: &str| Drawn { key: key.into(), unit: "kg".into(), distribution };
        Draws::new(50, 1, Method::Random, vec![drawn("mass"), drawn("other")]).unwrap()
    }

    #[test]
    fn few_points_meet_every_value() {
        let axes = vec![axis("a", &[1.0, 2.0, 3.0]), axis("b", &[1.0, 2.0]), axis("c", &[1.0, 2.0, 3.0, 4.0])];
        let sweep = Sweep::new(axes, Arrangement::Grid, Some(draws())).unwrap();
        assert_eq!(sweep.cover(24).iter().filter(|point| *point % 50 == 0).count(), 24);
        let cover = sweep.cover(23);
        // 1 + 2 + 1 + 3 combinations, and two extremes of two keys.
        assert!(cover.len() <= 7 + 4 && cover.is_sorted(), "{cover:?}");
        for key in 0..5 {
            let number = |point: usize| sweep.value(point, key).unwrap().number().unwrap();
            let all: Vec<f64> = (0..sweep.points()).map(number).collect();
            let met: Vec<f64> = cover.iter().map(|point| number(*point)).collect();
            let ends = |numbers: &[f64]| [f64::min, f64::max].map(|end| numbers.iter().copied().reduce(end).unwrap());
            assert_eq!(ends(&all).map(f64::to_bits), ends(&met).map(f64::to_bits), "{key}");
            if key < 3 {
                assert!(all.iter().all(|value| met.contains(value)), "{key}: {met:?}");
            }
        }
        assert!(sweep.value(0, 5).is_none() && sweep.value(sweep.points(), 0).is_none());
    }

    #[test]
    fn a_column_has_a_unit_where_all_have_it() {
        let mixed =
            Axis { key: "d".into(), values: vec![Value::Number(1.0, "m".into()), Value::Number(1.0, "mm".into())] };
        let text = Axis { key: "e".into(), values: vec![Value::Text("zv".into())] };
        let sweep = Sweep::new(vec![axis("a", &[1.0]), mixed, text], Arrangement::Grid, Some(draws())).unwrap();
        let units: Vec<_> = sweep.columns().map(|column| column.unit).collect();
        assert_eq!(units, [Some("m"), None, None, Some("kg"), Some("kg")]);
    }
}
