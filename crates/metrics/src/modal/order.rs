//! Number of components in a record.
use super::fit::{Candidates, Fit};
use super::model::Component;
use super::series::Series;
use super::spectrum::{self, HIGHEST, LOWEST};

/// A component must leave at most this share of the energy.
const WORTH: f64 = 0.75;
const MAX_COMPONENTS: usize = 12;
/// Maximum number of least-squares fits of one record. A record that is a sum of decaying modes needs twenty to forty; a motion
/// that is not explained then is not such a sum.
const MAX_FITS: usize = 40;
/// The same for its last refinement.
const FINE_FITS: usize = 9;
/// Share of the record (squared) below which a remainder is ignored.
pub(crate) const NOTHING: f64 = 1e-20;
const START_DAMPING: [f64; 4] = [0.0, 0.005, 0.03, 0.15];
/// Starting points of tails, λ·T.
const START_TAILS: [f64; 4] = [1.0, 5.0, 25.0, 100.0];
/// Least share of the remainder that a step of a growing fit takes, or else the next component is tried.
const COARSE: f64 = 0.1;
/// The same for the fit that is reported.
const FINE: f64 = 1e-9;
/// Share of the smallest vibration that matters (squared) that the reported fit may leave, too: a tenth of its peak.
const PRECISE: f64 = 1e-2;
/// Factor by which one kind of component may take less than the other before its poles are moved; if farther behind, it is not tried.
const FAR_BEHIND: f64 = 2.0;
/// Frequencies closer than this share start the same fit.
const SAME: f64 = 0.03;

/// A fit, and whether it is complete.
#[derive(Debug)]
pub(crate) struct Order {
    /// The fit.
    pub(crate) fit: Fit,
    /// True if the remainder is below the smallest vibration that matters.
    pub(crate) is_whole: bool,
}

impl Order {
    /// Adds component after component, while each takes a good part of the remainder, until that is not above `least`. Oscillations
    /// start from the frequencies `proposed` (Hz) and from the spectrum of the remainder.
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

/// The tail of a series, if it has one.
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
    // The most promising first.
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
