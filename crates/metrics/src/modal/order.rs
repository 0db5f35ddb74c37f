//! How many components a record holds.
use super::fit::{Candidates, Fit};
use super::model::Component;
use super::series::Series;
use super::spectrum::{self, HIGHEST, LOWEST};

/// A component must leave at most this share of the energy.
const WORTH: f64 = 0.75;
const MAX_COMPONENTS: usize = 12;
/// Least-squares fits of one record. A record that is a sum of decaying modes needs twenty to forty; what is not explained then is no such
/// sum.
const MAX_FITS: usize = 40;
/// The same of its last refinement.
const FINE_FITS: usize = 9;
/// What is left below this share of the record (squared) is not looked at any more.
pub(crate) const NOTHING: f64 = 1e-20;
const START_DAMPING: [f64; 4] = [0.0, 0.005, 0.03, 0.15];
/// Starting points of tails, λ·T.
const START_TAILS: [f64; 4] = [1.0, 5.0, 25.0, 100.0];
/// A step of a fit that still grows takes this share of what is left, or the next component is tried.
const COARSE: f64 = 0.1;
/// The same for the fit that is reported.
const FINE: f64 = 1e-9;
/// Share of what nobody asks for (squared) that the fit that is reported need not take, either: a tenth of its peak.
const PRECISE: f64 = 1e-2;
/// Of two kinds of components, one that takes so many times less than the other before its poles are moved is not tried.
const FAR_BEHIND: f64 = 2.0;
/// Frequencies closer than this share start the same fit.
const SAME: f64 = 0.03;

/// A fit, and whether it leaves anything.
#[derive(Debug)]
pub(crate) struct Order {
    /// The fit.
    pub(crate) fit: Fit,
    /// True where nothing is left but what nobody asks for.
    pub(crate) is_whole: bool,
}

impl Order {
    /// Component after component, while each takes a good part of what is left, until nothing above `least` is. Oscillations start from
    /// the frequencies `proposed` (Hz) and from the spectrum of what is left.
    pub(crate) fn of(series: &Series, proposed: &[f64], least: f64) -> Option<Self> {
        let mut fit = Fit::of(vec![], series)?;
        let nothing = NOTHING * fit.energy;
        let is_whole = |fit: &Fit| fit.energy <= nothing || fit.peak() <= least;
        let tails = tails(series);
        let mut fits = MAX_FITS;
        while !is_whole(&fit) && fit.components.len() < MAX_COMPONENTS && fits > 0 {
            match with_another(&fit, series, proposed, &tails, &mut fits) {
                Some(better) if is_worth(&better, &fit) => fit = better,
                _ => break,
            }
        }
        let precise = PRECISE * least * least * series.values.len() as f64;
        let fit = fit.refined(series, FINE, precise, &mut { FINE_FITS });
        Some(Self { is_whole: is_whole(&fit), fit })
    }
}

/// The tail of a series, where it has one.
pub(crate) fn trend(series: &Series) -> Option<Fit> {
    let bare = Fit::of(vec![], series)?;
    let with = bare.with_best_of(&tails(series), series)?.refined(series, COARSE, 0.0, &mut { MAX_FITS });
    is_worth(&with, &bare).then_some(with)
}

fn is_worth(with: &Fit, without: &Fit) -> bool {
    with.energy <= WORTH * without.energy
}

fn with_another(fit: &Fit, series: &Series, proposed: &[f64], tails: &Candidates, fits: &mut usize) -> Option<Fit> {
    let (low, high) = (LOWEST / series.length(), HIGHEST / series.step);
    let mut frequencies = spectrum::peaks(&fit.residual, series.step, low, high);
    let found = frequencies.clone();
    let is_new = |frequency: &&f64| !found.iter().any(|other| (other - **frequency).abs() < SAME * other);
    frequencies.extend(proposed.iter().filter(is_new));
    let mut best = [tails, &oscillations(series, &frequencies)].map(|candidates| fit.best_of(candidates));
    // What promises more goes first.
    best.sort_by(|one, two| gain(*two).total_cmp(&gain(*one)));
    let most = gain(best[0]);
    let worth_a_try = best.into_iter().flatten().filter(|(_, gain)| FAR_BEHIND * gain >= most);
    let with = |(component, _)| Some(fit.with(component, series)?.refined(series, COARSE, 0.0, fits));
    worth_a_try.filter_map(with).reduce(|one, two| if two.energy < one.energy { two } else { one })
}

fn gain(found: Option<(Component, f64)>) -> f64 {
    found.map_or(0.0, |(_, gain)| gain)
}

fn tails(series: &Series) -> Candidates {
    let of = |start: &f64| Component::Tail { rate: start / series.length() };
    Candidates::of(START_TAILS.iter().map(of).collect(), series)
}

fn oscillations(series: &Series, frequencies: &[f64]) -> Candidates {
    let of = |frequency: &f64| START_DAMPING.map(|zeta| Component::oscillating(*frequency, zeta));
    Candidates::of(frequencies.iter().flat_map(of).collect(), series)
}
