//! Prices of limits: the time that another value would cost or save.
use crate::best::{Price, Question};
use crate::explore::{Effort, best};
use crate::search::{Found, Search};

/// Factors of the priced limit, in ascending order.
pub(crate) const TIGHTER: [f64; 4] = [0.1, 0.25, 0.5, 0.9];
pub(crate) const WIDER: [f64; 2] = [1.1, 2.0];

/// The fastest with other values of the priced limit, with the factors.
pub(crate) type Priced = Vec<(f64, Option<Found>)>;

/// The fastest with each of these factors of the priced limit, in order of their distance from the limit: each search also starts from the
/// results of the previous ones.
pub(crate) fn priced(question: &Question, search: &mut Search<'_>, factors: &[f64]) -> Priced {
    let Some(priced) = question.priced else { return Vec::new() };
    let mut order: Vec<f64> = factors.to_vec();
    order.sort_by(|one, other| one.ln().abs().total_cmp(&other.ln().abs()));
    let with = |factor: &f64| {
        let mut allowed = vec![1.0; question.limits];
        allowed[priced] = *factor;
        let known = search.known().to_vec();
        (*factor, best(question, search, &known, &allowed, Effort::PRICE).into_iter().next())
    };
    let mut all: Priced = order.iter().map(with).collect();
    all.sort_by(|one, other| one.0.total_cmp(&other.0));
    all
}

/// The fastest overall.
pub(crate) fn fastest(priced: &Priced) -> Option<&Found> {
    let found = priced.iter().filter_map(|(_, found)| found.as_ref());
    found.min_by(|one, other| one.worst.time.total_cmp(&other.worst.time))
}

/// Prices of tighter and wider limits for an advice with the worst time `own` (s) on the machines of the search and `worst` including those
/// of the verification. A set-point that meets a tighter limit also meets a wider one.
pub(crate) fn prices(tighter: &Priced, wider: &Priced, own: f64, worst: f64) -> Vec<Price> {
    let mut fastest = f64::INFINITY;
    let mut prices = Vec::new();
    for (all, known) in [(tighter, f64::INFINITY), (wider, own)] {
        fastest = fastest.min(known);
        for (factor, found) in all {
            fastest = found.as_ref().map_or(fastest, |found| fastest.min(found.worst.time));
            prices.push(Price { factor: *factor, time: fastest.is_finite().then_some(worst + (fastest - own)) });
        }
    }
    prices
}
