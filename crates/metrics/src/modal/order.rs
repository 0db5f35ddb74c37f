//! How many components a record holds.
use super::fit::{Candidates, Fit};
use super::model::{Component, Oscillation};
use super::series::Series;
use super::spectrum::{self, HIGHEST, LOWEST};

/// A component must leave at most this share of the energy.
const WORTH: f64 = 0.75;
const MAX_COMPONENTS: usize = 6;
/// What is left below this share of the record (squared) is not looked at any more.
pub(crate) const NOTHING: f64 = 1e-20;
const START_DAMPING: [f64; 5] = [0.0, 0.003, 0.02, 0.1, 0.3];
/// Starting points of tails, λ·T.
const START_TAILS: [f64; 4] = [1.0, 5.0, 25.0, 100.0];
/// A step of a fit that still grows takes this share of what is left, or the next component is tried.
const COARSE: f64 = 1e-2;
/// The same for the fit that is reported.
const FINE: f64 = 1e-9;
/// An oscillation is the same in two fits when its frequency (relative) and its damping ratio differ by no more.
const SAME: f64 = 0.01;

/// A fit, and what becomes of it with one component more.
#[derive(Debug)]
pub(crate) struct Order {
    /// The fit.
    pub(crate) fit: Fit,
    next: Next,
}

/// One component more.
#[derive(Debug)]
enum Next {
    /// Nothing is left for it.
    Needless,
    /// It takes too little to count: the fit with it.
    Worthless(Fit),
    /// It might well take its share, but there are [`MAX_COMPONENTS`].
    TooMany,
}

impl Order {
    /// Component after component, while each takes a good part of what is left. Oscillations start from the frequencies
    /// `proposed` (Hz) and from the spectrum of what is left. `resolution`: what means nothing in the series.
    pub(crate) fn of(series: &Series, proposed: &[f64], resolution: f64) -> Option<Self> {
        let mut fit = Fit::of(vec![], series)?;
        let nothing = (NOTHING * fit.energy).max(resolution * resolution * series.values.len() as f64);
        let tails = tails(series);
        let next = loop {
            if fit.components.len() == MAX_COMPONENTS {
                break Next::TooMany;
            }
            if fit.energy <= nothing {
                break Next::Needless;
            }
            match with_another(&fit, series, proposed, &tails) {
                Some(better) if is_worth(&better, &fit) => fit = better,
                Some(next) => break Next::Worthless(next),
                None => break Next::TooMany,
            }
        };
        Some(Self { fit: fit.refined(series, FINE), next })
    }

    /// Whether an oscillation is one of the record rather than of the number of components: one component more does not
    /// change it. (The stabilisation diagram of experimental modal analysis, with two orders.)
    pub(crate) fn confirms(&self, found: Oscillation) -> bool {
        let same = |other: Oscillation| {
            (other.frequency() - found.frequency()).abs() <= SAME * found.frequency()
                && (other.damping() - found.damping()).abs() <= SAME
        };
        match &self.next {
            Next::Needless => true,
            Next::Worthless(next) => next.components.iter().filter_map(|component| component.oscillation()).any(same),
            Next::TooMany => false,
        }
    }
}

/// The tail of a series, where it has one.
pub(crate) fn trend(series: &Series) -> Option<Fit> {
    let bare = Fit::of(vec![], series)?;
    with_best_of(&bare, series, &tails(series)).filter(|with| is_worth(with, &bare))
}

fn is_worth(with: &Fit, without: &Fit) -> bool {
    with.energy <= WORTH * without.energy
}

fn with_another(fit: &Fit, series: &Series, proposed: &[f64], tails: &Candidates) -> Option<Fit> {
    let (low, high) = (LOWEST / series.length(), HIGHEST / series.step);
    let mut frequencies = spectrum::peaks(&fit.residual, series.step, low, high);
    frequencies.extend_from_slice(proposed);
    let fits = [with_best_of(fit, series, tails), with_best_of(fit, series, &oscillations(series, &frequencies))];
    fits.into_iter().flatten().reduce(|one, two| if two.energy < one.energy { two } else { one })
}

fn with_best_of(fit: &Fit, series: &Series, candidates: &Candidates) -> Option<Fit> {
    Some(fit.with_best_of(candidates, series)?.refined(series, COARSE))
}

fn tails(series: &Series) -> Candidates {
    let of = |start: &f64| Component::Tail { rate: start / series.length() };
    Candidates::of(START_TAILS.iter().map(of).collect(), series)
}

fn oscillations(series: &Series, frequencies: &[f64]) -> Candidates {
    let of = |frequency: &f64| START_DAMPING.map(|zeta| Component::oscillating(*frequency, zeta));
    Candidates::of(frequencies.iter().flat_map(of).collect(), series)
}
