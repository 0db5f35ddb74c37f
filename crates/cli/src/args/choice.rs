//! Arguments that are one of a few named values.
use clap::builder::{PossibleValue, PossibleValuesParser, TypedValueParser};
use servobench_config::Choice;

/// Takes the name of a value of `T`; the help lists all of them with their meanings.
pub(crate) fn choice<T: Choice + Send + Sync>() -> impl TypedValueParser<Value = T> {
    let names = T::ALL.iter().map(|(name, _, meaning)| PossibleValue::new(*name).help(plain(meaning)));
    PossibleValuesParser::new(names).try_map(|name| T::from_name(&name).ok_or("not among the names"))
}

/// A meaning names parameters as files do, `maximum_jerk`; help is plain text.
pub(super) fn plain(meaning: &str) -> String {
    let words = meaning.split('`').enumerate();
    words.map(|(k, words)| if k % 2 == 1 { words.replace('_', " ") } else { words.to_owned() }).collect()
}
