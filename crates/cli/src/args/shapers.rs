//! `--shaper`: kinds of input shapers.
use clap::builder::{PossibleValue, PossibleValuesParser, TypedValueParser};
use servobench_config::Choice as _;
use servobench_motion::shape::ShaperKind;

/// Shapers that a scenario is run with.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Shapers {
    /// One of every kind.
    All,
    /// No shaper.
    Without,
    /// One of this kind.
    Of(ShaperKind),
}

const ALL: &str = "all";
/// What a variant without a shaper is called.
pub(crate) const NONE: &str = "none";

impl Shapers {
    fn from_name(name: &str) -> Option<Self> {
        match name {
            ALL => Some(Self::All),
            NONE => Some(Self::Without),
            name => ShaperKind::from_name(name).map(Self::Of),
        }
    }

    /// The kinds that `wanted` asks for, each once, in that order; `None` is no shaper.
    pub(crate) fn kinds(wanted: &[Self]) -> Vec<Option<ShaperKind>> {
        let all = wanted.iter().flat_map(|one| match one {
            Self::All => ShaperKind::ALL.iter().map(|(_, kind, _)| Some(*kind)).collect(),
            Self::Without => vec![None],
            Self::Of(kind) => vec![Some(*kind)],
        });
        all.fold(Vec::new(), |mut kinds, kind| {
            if !kinds.contains(&kind) {
                kinds.push(kind);
            }
            kinds
        })
    }
}

/// Takes the name of a kind, `all` or `none`; the help lists them with their meanings.
pub(super) fn parser() -> impl TypedValueParser<Value = Shapers> {
    let kinds = ShaperKind::ALL.iter().map(|(name, _, meaning)| (*name, super::choice::plain(meaning)));
    let others =
        [(NONE, "no shaper, also where the scenario has one".to_owned()), (ALL, "one of every kind".to_owned())];
    let names = kinds.chain(others).map(|(name, meaning)| PossibleValue::new(name).help(meaning));
    PossibleValuesParser::new(names).try_map(|name| Shapers::from_name(&name).ok_or("not among the names"))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn each_kind_is_there_once() {
        let kinds = Shapers::kinds(&[Shapers::Of(ShaperKind::Zvd), Shapers::Without, Shapers::All]);
        assert_eq!(kinds.len(), ShaperKind::ALL.len() + 1);
        assert_eq!(kinds[..3], [Some(ShaperKind::Zvd), None, Some(ShaperKind::Zv)]);
    }
}
