//! Plan of a kernel: stretches of time in which the highest derivative of its chain is constant.

/// One stretch: the `zeros` highest derivatives are zero, the one below them is `value`, for `length` (s).
///
/// A held derivative is planned, and not left to the result of integration: a residue of the jerk of 1e-17 would be
/// metres after a day of cruising.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub(crate) struct Stretch {
    pub(crate) value: f64,
    pub(crate) length: f64,
    /// 0 while the highest derivative is not zero, 1 while the next one is held; up to the order less 1 in a cruise.
    pub(crate) zeros: u8,
}

impl Stretch {
    /// The highest derivative.
    #[inline]
    pub(crate) fn rate(&self) -> f64 {
        if self.zeros == 0 { self.value } else { 0.0 }
    }
}

/// Up to `N` consecutive stretches; paths are copied often, so their data lies close together.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Path<const N: usize> {
    values: [f64; N],
    lengths: [f64; N],
    zeros: [u8; N],
    count: usize,
}

impl<const N: usize> Path<N> {
    pub(crate) const EMPTY: Self = Self { values: [0.0; N], lengths: [0.0; N], zeros: [0; N], count: 0 };

    /// Adds a stretch of the highest derivative `rate`, unless it has no length.
    pub(crate) fn push(&mut self, rate: f64, length: f64) {
        self.add(Stretch { value: rate, length, zeros: 0 });
    }

    /// Adds a stretch in which the derivative below the `zeros` highest is held at `value`, unless it has no length.
    pub(crate) fn hold(&mut self, zeros: u8, value: f64, length: f64) {
        self.add(Stretch { value, length, zeros });
    }

    /// Adds a stretch, unless it has no length.
    ///
    /// Capacities are sums of the numbers of added stretches, so that there is always room. If that were wrong, the index would panic
    /// in every build, and a sweep of the tests would find it.
    #[inline]
    fn add(&mut self, Stretch { value, length, zeros }: Stretch) {
        if length > 0.0 {
            let i = self.count;
            (self.values[i], self.lengths[i], self.zeros[i]) = (value, length, zeros);
            self.count += 1;
        }
    }

    /// Adds all stretches of another one.
    pub(crate) fn extend<const M: usize>(&mut self, other: &Path<M>) {
        for stretch in other.stretches() {
            self.add(stretch);
        }
    }

    /// Adds the first `time` seconds of another one.
    pub(crate) fn extend_until<const M: usize>(&mut self, other: &Path<M>, mut time: f64) {
        for stretch in other.stretches() {
            self.add(Stretch { length: stretch.length.min(time), ..stretch });
            time -= stretch.length;
            if time <= 0.0 {
                return;
            }
        }
    }

    #[inline]
    pub(crate) fn stretches(&self) -> impl DoubleEndedIterator<Item = Stretch> + '_ {
        let both = self.values[..self.count].iter().zip(&self.lengths[..self.count]);
        both.zip(&self.zeros[..self.count]).map(|((value, length), zeros)| Stretch {
            value: *value,
            length: *length,
            zeros: *zeros,
        })
    }

    /// Its duration (s).
    pub(crate) fn duration(&self) -> f64 {
        self.lengths[..self.count].iter().sum()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    #[should_panic(expected = "index out of bounds")]
    fn a_stretch_too_many_is_seen_in_every_build() {
        let mut path = Path::<1>::EMPTY;
        path.push(1.0, 0.0);
        path.push(1.0, 1.0);
        path.push(1.0, 1.0);
    }
}
