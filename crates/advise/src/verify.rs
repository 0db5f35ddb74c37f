//! Verification of a set-point on machines that the search has not seen.
use crate::best::AdviseError;
use crate::machines::{Machines, Stretch};
use crate::search::{Allowance, Planned, Reading, Search, Worst, keeps, worst_of};
use crate::set_point::SetPoint;
use servobench_sweep::{Distribution, Drawn, Draws, Method, Proportion, SweepError};

/// Distance between machines of the grid in lobes: finer than a tenth. Between them a maximum is higher by at most (π·0.03/2)²/2 = 0.11 %.
const LOBE: f64 = 0.03;

/// Results of a set-point on machines that the search has not seen.
#[derive(Debug, Clone, PartialEq)]
pub struct Verification {
    /// Number of corners, and of machines between them along which a mode moves.
    pub grid: usize,
    /// Largest distance between these in frequency (Hz); `None` if no mode moves.
    pub spacing: Option<f64>,
    /// Counts of draws within all limits, and of others.
    pub draws: Proportion,
    /// Lower bound of the share of machines within all limits, with 95 % confidence for the whole search: if earlier draws were evaluated
    /// and led to another set-point, each evaluation has half of the error probability of the previous one.
    pub share: f64,
    /// The worst figures on all of them.
    pub worst: Worst,
}

/// Parameters of a verification.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Plan<'a> {
    pub(crate) machines: &'a Machines,
    /// Natural frequency of the mode (Hz).
    pub(crate) frequency: f64,
    pub(crate) draws: u32,
    pub(crate) seed: u64,
    /// Number of earlier evaluations of draws.
    pub(crate) looks: i32,
}

/// Probability that a promised share is wrong, over all evaluations of the search.
const DOUBT: f64 = 0.05;

/// Largest number of draws in one evaluation.
const MOST: u32 = 1_000_000;

/// Confidence of an evaluation of draws after `looks` others.
fn confidence(looks: i32) -> f64 {
    1.0 - DOUBT * 0.5_f64.powi(looks + 1)
}

/// Share of the machines that `draws` show if none fails, after `looks` others.
pub(crate) fn shown_by(draws: u32, looks: i32) -> f64 {
    Proportion::new(u64::from(draws), 0).at_least(confidence(looks))
}

/// Number of draws, none failing, that show `share` of the machines after `looks` others: n with shareⁿ ≤ 1 − confidence.
///
/// # Errors
/// [`AdviseError::TooMuch`] above 1 000 000.
pub(crate) fn needed(share: f64, looks: i32) -> Result<u32, AdviseError> {
    let draws = libm::ceil(libm::log(1.0 - confidence(looks)) / libm::log(share.max(f64::MIN_POSITIVE)));
    if draws.is_nan() || draws > f64::from(MOST) {
        return Err(AdviseError::TooMuch { wanted: 100.0 * share, most: MOST });
    }
    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "0 to a million")]
    let draws = draws.max(1.0) as u32;
    // The bound comes from bisection, which rounds.
    Ok((draws..=MOST).find(|draws| shown_by(*draws, looks) >= share).unwrap_or(MOST))
}

/// Machines on which a set-point ran, with the results.
#[derive(Debug)]
pub(crate) struct Tried {
    machines: Vec<Vec<f64>>,
    readings: Vec<Reading>,
}

impl Tried {
    fn on(machines: Vec<Vec<f64>>, point: SetPoint, search: &mut Search<'_>) -> Self {
        let readings = search.on(point, &machines);
        Self { machines, readings }
    }

    /// The machines on which it is not within `allowed`.
    pub(crate) fn failed(&self, allowed: &Allowance) -> Vec<Vec<f64>> {
        let failed = self.machines.iter().zip(&self.readings).filter(|(_, reading)| !keeps(reading, allowed));
        failed.map(|(machine, _)| machine.clone()).collect()
    }

    fn each(&self) -> impl Iterator<Item = (&[f64], &Reading)> {
        self.machines.iter().map(Vec::as_slice).zip(&self.readings)
    }
}

/// `planned` on corners, in the middle, and between the corners along every range that shifts the mode.
pub(crate) fn on_grid(search: &mut Search<'_>, planned: &Planned, plan: Plan<'_>) -> Result<Tried, AdviseError> {
    let mut grid = plan.machines.corners();
    grid.push(plan.machines.middle());
    grid.extend(plan.machines.along(plan.frequency, LOBE / planned.duration)?);
    Ok(Tried::on(grid, planned.point, search))
}

/// `planned`, which is within `allowed` on the grid, on draws: the combined result, and the draws on which it fails.
pub(crate) fn on_draws(
    search: &mut Search<'_>,
    planned: &Planned,
    grid: &Tried,
    allowed: &Allowance,
    plan: Plan<'_>,
) -> Result<(Verification, Vec<Vec<f64>>), AdviseError> {
    let drawn = Tried::on(drawn(plan)?, planned.point, search);
    let failed = drawn.failed(allowed);
    let moves = plan.machines.ranges().iter().any(|range| range.stretch != Stretch::None);
    let draws = Proportion::new((drawn.machines.len() - failed.len()) as u64, failed.len() as u64);
    let verification = Verification {
        grid: grid.machines.len(),
        spacing: moves.then_some(LOBE / planned.duration),
        draws,
        share: draws.at_least(confidence(plan.looks)),
        worst: worst_of(grid.each().chain(drawn.each())),
    };
    Ok((verification, failed))
}

/// Machines drawn at random, uniformly within the tolerances.
fn drawn(plan: Plan<'_>) -> Result<Vec<Vec<f64>>, SweepError> {
    let keys = plan.machines.ranges().iter().map(|range| {
        let [low, high] = range.ends;
        let distribution = Distribution::Uniform { low: low.min(high), high: low.max(high) };
        Drawn { key: range.key.clone(), unit: range.unit.clone(), distribution }
    });
    let draws = Draws::new(plan.draws, plan.seed, Method::Random, keys.collect())?;
    Ok((0..plan.draws).map(|index| draws.numbers(index).collect()).collect())
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Oracle: 0.99³⁶⁸ = 0.02476 is below 2.5 %, 0.99³⁶⁷ = 0.02501 is not.
    #[test]
    fn a_promise_needs_as_many_draws_as_show_it() {
        assert_eq!(needed(0.99, 0).unwrap(), 368);
        assert!(shown_by(368, 0) >= 0.99 && shown_by(367, 0) < 0.99);
        // 93.2 % of two hundred at 97.5 %: 0.025^(1/200) = 0.98172.
        assert!((shown_by(200, 0) - 0.025_f64.powf(0.005)).abs() < 1e-9);
        assert_eq!(needed(0.0, 0).unwrap(), 1);
        assert!(needed(0.99, 1).unwrap() > 368);
        assert!(matches!(needed(1.0 - 1e-9, 0), Err(AdviseError::TooMuch { .. })));
    }
}
