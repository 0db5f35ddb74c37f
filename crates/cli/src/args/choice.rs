//! Arguments that are one of a few named values.
use clap::builder::{PossibleValue, PossibleValuesParser, TypedValueParser};
use servobench_config::Choice;

/// Takes the name of a value of `T`; the help lists all of them with their meanings.
pub(super) fn choice<T: Choice + Send + Sync>() -> impl TypedValueParser<Value = T> {
    let names = T::ALL.iter().map(|(name, _, meaning)| PossibleValue::new(*name).help(*meaning));
    PossibleValuesParser::new(names).try_map(|name| T::from_name(&name).ok_or("not among the names"))
}
