//! Smallest and largest of many values: the order of comparison does not matter, so that several are compared side by side.

/// Values that are compared side by side.
const LANES: usize = 16;

/// Largest of `of` over the rows of `columns`, at least 0; not-a-number values are skipped.
pub(crate) fn most_of<const N: usize>(columns: [&[f64]; N], of: impl Fn([f64; N]) -> f64) -> f64 {
    let larger = |most: f64, value: f64| if value > most { value } else { most };
    let rows = columns.iter().map(|column| column.len()).min().unwrap_or(0);
    let chunks = columns.map(|column| column[..rows].as_chunks::<LANES>());
    let mut most = [0.0; LANES];
    for k in 0..rows / LANES {
        for (lane, most) in most.iter_mut().enumerate() {
            *most = larger(*most, of(chunks.map(|(chunks, _)| chunks[k][lane])));
        }
    }
    let rest = (0..rows % LANES).map(|k| of(chunks.map(|(_, rest)| rest[k])));
    most.into_iter().chain(rest).fold(0.0, larger)
}

/// Smallest and largest of `values`; infinite where there are none. Not-a-number values are skipped.
pub(crate) fn range_of(values: &[f64]) -> (f64, f64) {
    let within = |(low, high): (f64, f64), x: f64| (if x < low { x } else { low }, if x > high { x } else { high });
    let (chunks, rest) = values.as_chunks::<LANES>();
    let mut ranges = [(f64::INFINITY, f64::NEG_INFINITY); LANES];
    for values in chunks {
        for (range, x) in ranges.iter_mut().zip(values) {
            *range = within(*range, *x);
        }
    }
    let all = ranges.into_iter().reduce(|(low, high), (x, y)| (within((low, high), x).0, within((low, high), y).1));
    rest.iter().fold(all.unwrap_or((f64::INFINITY, f64::NEG_INFINITY)), |range, x| within(range, *x))
}

/// Distance between the smallest and the largest of `values`; 0 where there are none.
pub(crate) fn span_of(values: &[f64]) -> f64 {
    let (low, high) = range_of(values);
    (high - low).max(0.0)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Oracle: one value after the other, as the standard library compares them.
    #[test]
    fn what_is_found_is_what_one_after_the_other_finds() {
        let mut random = servobench_testkit::Random::seeded(19);
        for count in (0..70).chain([1000]) {
            for without in [usize::MAX, 0, 3, 17, 40] {
                let mut column = || -> Vec<f64> {
                    (0..count).map(|k| if k == without { f64::NAN } else { random.signed() }).collect()
                };
                let (one, two) = (column(), column());
                let low = one.iter().copied().fold(f64::INFINITY, f64::min);
                let high = one.iter().copied().fold(f64::NEG_INFINITY, f64::max);
                assert_eq!(range_of(&one), (low, high), "{count}");
                let most = one.iter().map(|x| x.abs()).fold(0.0, f64::max);
                assert_eq!(most_of([&one], |[x]| x.abs()).to_bits(), most.to_bits(), "{count}");
                let squares = one.iter().zip(&two).map(|(x, y)| x * x + y * y).fold(0.0, f64::max);
                assert_eq!(most_of([&one, &two], |[x, y]| x * x + y * y).to_bits(), squares.to_bits(), "{count}");
            }
        }
    }
}
