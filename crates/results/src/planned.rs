//! Names of the runs of a suite.
use crate::results::Unfinished;

/// Names of the runs of a suite, by their places in it. Those of a sweep have the same name: a million of them take no more memory
/// than one.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Planned {
    kinds: Vec<Unfinished>,
    /// Number of consecutive runs with each name.
    each: usize,
}

impl Planned {
    /// `each` consecutive runs for each of `kinds`.
    #[must_use]
    pub const fn repeated(kinds: Vec<Unfinished>, each: usize) -> Self {
        Self { kinds, each }
    }

    /// Name of the run at `index`.
    #[must_use]
    pub fn get(&self, index: usize) -> Option<&Unfinished> {
        self.kinds.get(index.checked_div(self.each)?)
    }

    /// Number of runs.
    #[must_use]
    pub const fn len(&self) -> usize {
        self.kinds.len() * self.each
    }

    /// True without runs.
    #[must_use]
    pub const fn is_empty(&self) -> bool {
        self.len() == 0
    }
}

/// One run of each name.
impl From<Vec<Unfinished>> for Planned {
    fn from(kinds: Vec<Unfinished>) -> Self {
        Self::repeated(kinds, 1)
    }
}

impl Default for Planned {
    fn default() -> Self {
        Vec::new().into()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn runs_in_a_row_are_called_alike() {
        let of = |engine: &str| Unfinished { name: "a".into(), file: None, engine: engine.into(), axis: None };
        let planned = Planned::repeated(vec![of("exact"), of("rapier")], 3);
        let engines: Vec<_> = (0..planned.len()).map(|index| planned.get(index).unwrap().engine.as_str()).collect();
        assert_eq!(engines, ["exact", "exact", "exact", "rapier", "rapier", "rapier"]);
        assert_eq!((planned.get(6), Planned::repeated(vec![of("exact")], 0).get(0)), (None, None));
        assert!(Planned::default().is_empty());
    }
}
