//! What the runs of a suite are called.
use crate::results::Unfinished;

/// What the runs of a suite are called, by their places in it. Those of a sweep are called alike: a million of them take no more room
/// than one.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Planned {
    kinds: Vec<Unfinished>,
    /// How many runs in a row are called like each of them.
    each: usize,
}

impl Planned {
    /// `each` runs in a row for each of `kinds`.
    #[must_use]
    pub const fn repeated(kinds: Vec<Unfinished>, each: usize) -> Self {
        Self { kinds, each }
    }

    /// What the run at `index` is called.
    #[must_use]
    pub fn get(&self, index: usize) -> Option<&Unfinished> {
        self.kinds.get(index.checked_div(self.each)?)
    }

    /// How many runs there are.
    #[must_use]
    pub const fn len(&self) -> usize {
        self.kinds.len() * self.each
    }

    /// Whether there is none.
    #[must_use]
    pub const fn is_empty(&self) -> bool {
        self.len() == 0
    }
}

/// Each by itself.
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
        let of = |engine: &str| Unfinished { name: "a".into(), file: None, engine: engine.into() };
        let planned = Planned::repeated(vec![of("exact"), of("rapier")], 3);
        let engines: Vec<_> = (0..planned.len()).map(|index| planned.get(index).unwrap().engine.as_str()).collect();
        assert_eq!(engines, ["exact", "exact", "exact", "rapier", "rapier", "rapier"]);
        assert_eq!((planned.get(6), Planned::repeated(vec![of("exact")], 0).get(0)), (None, None));
        assert!(Planned::default().is_empty());
    }
}
