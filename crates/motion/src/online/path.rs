//! What a kernel plans: stretches of time in which the highest derivative of its chain is constant.

/// One stretch: the highest derivative, and how long it holds (s).
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub(crate) struct Stretch {
    pub(crate) value: f64,
    pub(crate) length: f64,
}

/// Up to `N` stretches, one after the other.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Path<const N: usize> {
    stretches: [Stretch; N],
    count: usize,
}

impl<const N: usize> Path<N> {
    pub(crate) const EMPTY: Self = Self { stretches: [Stretch { value: 0.0, length: 0.0 }; N], count: 0 };

    /// Adds a stretch, unless it has no length.
    ///
    /// Capacities are sums of what is added to them, so that there is always room. If that were wrong, the index would say so
    /// in every build, where a sweep of the tests sees it.
    pub(crate) fn push(&mut self, value: f64, length: f64) {
        if length > 0.0 {
            self.stretches[self.count] = Stretch { value, length };
            self.count += 1;
        }
    }

    /// Adds all of another one.
    pub(crate) fn extend<const M: usize>(&mut self, other: &Path<M>) {
        for Stretch { value, length } in other.stretches() {
            self.push(*value, *length);
        }
    }

    /// Adds the first `time` seconds of another one.
    pub(crate) fn extend_until<const M: usize>(&mut self, other: &Path<M>, mut time: f64) {
        for Stretch { value, length } in other.stretches() {
            self.push(*value, length.min(time));
            time -= length;
            if time <= 0.0 {
                return;
            }
        }
    }

    pub(crate) fn stretches(&self) -> &[Stretch] {
        &self.stretches[..self.count]
    }

    /// How long it lasts (s).
    pub(crate) fn duration(&self) -> f64 {
        self.stretches().iter().map(|stretch| stretch.length).sum()
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
