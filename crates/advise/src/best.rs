//! The advice for a question: search and verification.
use crate::explore::{Effort, best, sown};
use crate::machines::Machines;
use crate::merit::Merit;
use crate::prices::{TIGHTER, WIDER, fastest, priced, prices};
use crate::search::{Allowance, Bench, Found, Planned, SAME, Search, Worst};
use crate::set_point::{Family, SetPoint};
use crate::verify::{Plan, Verification, needed, on_draws, on_grid, shown_by};
use servobench_motion::Limits;
use servobench_sweep::SweepError;
use thiserror::Error;

/// The question.
#[derive(Debug, Clone, PartialEq)]
pub struct Question {
    /// Kinds of set-points to choose from.
    pub families: Vec<Family>,
    /// Upper bounds of the limits of a set-point; infinite without a bound.
    pub ceiling: Limits,
    /// Distance of the longest move (m or rad).
    pub distance: f64,
    /// Machines on which the limits must be met.
    pub machines: Machines,
    /// Natural frequency of the oscillating mode (Hz), which determines the width of the lobes.
    pub frequency: f64,
    /// Number of limits that a run has to meet.
    pub limits: usize,
    /// Index of the limit whose price is requested.
    pub priced: Option<usize>,
    /// Promised share of the machines.
    pub share: f64,
    /// Number of draws for the verification.
    pub draws: u32,
    /// Seed of the draws.
    pub seed: u64,
}

/// The answer.
#[derive(Debug, Clone, PartialEq)]
pub struct Advice {
    /// The fastest set-point found.
    pub point: SetPoint,
    /// Duration of its moves (s).
    pub duration: f64,
    /// Its worst figures on all machines of search and verification.
    pub worst: Worst,
    /// Result of its verification.
    pub verification: Verification,
    /// The best of each other family with its worst time (s), the fastest first, on the machines of the search.
    pub others: Vec<(SetPoint, f64)>,
    /// Cost or saving with other values of a limit.
    pub prices: Vec<Price>,
    /// Number of runs.
    pub runs: usize,
    /// Number of set-points planned.
    pub planned: usize,
}

/// Price of a limit.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Price {
    /// The limit as a multiple of its value.
    pub factor: f64,
    /// The worst time (s) with that limit: that of the advice plus the difference between the fastest set-points on the machines of the
    /// search; `None` if no set-point was found.
    pub time: Option<f64>,
}

/// Reason why there is no advice.
#[derive(Debug, Clone, PartialEq, Error)]
pub enum AdviseError {
    /// No move can be planned.
    #[error("no move can be planned within the limits of the set-point")]
    NoPlan,
    /// No set-point meets the limits.
    #[error(
        "none of the {planned} set-points that were planned keeps all limits on all machines: raise `[limits]`, make the box smaller, or let \
         the run be longer if moves do not come to their end in it"
    )]
    NoneKeeps {
        /// Number of set-points planned.
        planned: usize,
    },
    /// The set-points found failed repeatedly on machines that the search had not seen.
    #[error(
        "no set-point was found that keeps all limits on {wanted:.1} % of the machines: after {rounds} rounds the best one keeps them on \
         {found:.1} % at least; promise a smaller share, or make the box smaller"
    )]
    NotVerified {
        /// Promised share (%).
        wanted: f64,
        /// Share shown (%).
        found: f64,
        /// Number of rounds of search and verification.
        rounds: u32,
    },
    /// Too few draws for the promise, even if none fails.
    #[error(
        "{draws} draws show {shown:.1} % of the machines at most: a promise of {wanted} % needs {needed}; draw as many, or promise less"
    )]
    TooFewDraws {
        /// Draws.
        draws: u32,
        /// Share that this number of draws shows if none fails (%).
        shown: f64,
        /// Promised share (%).
        wanted: f64,
        /// Number of draws needed.
        needed: u32,
    },
    /// A promise that no number of draws can show.
    #[error("a promise of {wanted} % of the machines needs more than {most} draws; promise less")]
    TooMuch {
        /// Promised share (%).
        wanted: f64,
        /// Largest number of draws.
        most: u32,
    },
    /// Tolerances too wide to be verified.
    #[error(
        "`{key}` moves the mode through {needed} machines that would have to be run, at most {most} are: make its range smaller, or advise \
         for parts of it"
    )]
    TooWide {
        /// The range.
        key: String,
        /// Number of machines along it.
        needed: f64,
        /// Largest number of machines.
        most: f64,
    },
    /// The tolerances do not permit draws.
    #[error(transparent)]
    Draws(#[from] SweepError),
}

/// Slowdown of the best set-point by added machines from which on a new search begins.
const SLOWER: f64 = 1.01;
/// Largest number of rounds of search and verification.
const ROUNDS: u32 = 16;
/// Round from which on draws may fail, as many as the promised share allows.
const PATIENT: u32 = 8;
/// Largest time, relative to the best, of other families that are reported.
const WORTH: f64 = 1.06;
/// Number of set-points of a family that are tried on added machines.
const TRIES: usize = 4;

/// The fastest set-point that meets all limits on the machines within the given tolerances.
///
/// # Errors
/// [`AdviseError`]
pub fn advise(question: &Question, bench: &mut dyn Bench) -> Result<Advice, AdviseError> {
    let mut search = Search::new(bench, question.machines.corners());
    let allowed = vec![1.0; question.limits];
    let (sifted, planned) = sown(question, &mut search, &allowed)?;
    let (mut shown, mut looks, mut before) = (0.0, 0, f64::INFINITY);
    for round in 0..ROUNDS {
        let known = search.known().to_vec();
        let mut found =
            if round == 0 { Vec::new() } else { best(question, &mut search, &known, &allowed, Effort::AGAIN) };
        if found.first().is_none_or(|found| found.worst.time > SLOWER * before) {
            // With the added machines, another set-point may be the best.
            let from = [known, sifted.clone()].concat();
            found = best(question, &mut search, &from, &allowed, Effort::of_first(question.families.len()));
        }
        before = found.first().map_or(before, |found| found.worst.time);
        let Some(best) = found.first().cloned() else {
            return Err(AdviseError::NoneKeeps { planned });
        };
        // Draws used in the search prove nothing.
        let seed = question.seed.wrapping_add(u64::from(round));
        let Question { machines, frequency, draws, share, .. } = question;
        let draws = (*draws).max(needed(*share, looks)?);
        let plan = Plan { machines, frequency: *frequency, draws, seed, looks };
        let grid = on_grid(&mut search, &best.planned, plan)?;
        let off_grid = grid.failed(&allowed);
        if !off_grid.is_empty() {
            search.add_some(&off_grid);
            continue;
        }
        let tighter = priced(question, &mut search, &TIGHTER);
        if fastest(&tighter).is_some_and(|found| found.worst.time < best.worst.time - SAME) {
            // A set-point that meets a tighter limit also meets this one: the search repeats, with that set-point known.
            continue;
        }
        let (verification, failed) = on_draws(&mut search, &best.planned, &grid, &allowed, plan)?;
        looks += 1;
        shown = verification.share;
        // A draw on which it fails joins the search while rounds remain.
        if shown < question.share || (!failed.is_empty() && round < PATIENT) {
            search.add_some(&failed);
            continue;
        }
        let wider = priced(question, &mut search, &WIDER);
        let Planned { point, duration } = best.planned;
        let worst = worse(&best.worst, &verification.worst);
        return Ok(Advice {
            point,
            duration,
            prices: prices(&tighter, &wider, best.worst.time, worst.time),
            worst,
            verification,
            others: others(question, &mut search, &allowed, &best),
            runs: search.runs(),
            planned,
        });
    }
    Err(AdviseError::NotVerified { wanted: 100.0 * question.share, found: 100.0 * shown, rounds: ROUNDS })
}

/// Refuses a promise that the draws of a question cannot show, even if none fails.
///
/// # Errors
/// [`AdviseError::TooFewDraws`], [`AdviseError::TooMuch`]
pub fn refuse_impossible(question: &Question) -> Result<(), AdviseError> {
    let least = needed(question.share, 0)?;
    if question.draws < least {
        let percent = |share: f64| 100.0 * share;
        let (draws, wanted) = (question.draws, percent(question.share));
        return Err(AdviseError::TooFewDraws { draws, shown: percent(shown_by(draws, 0)), wanted, needed: least });
    }
    Ok(())
}

/// The best known set-point of each family other than that of `best`, if it is only a little slower, on the machines of the search.
fn others(question: &Question, search: &mut Search<'_>, allowed: &Allowance, best: &Found) -> Vec<(SetPoint, f64)> {
    let most = WORTH * best.worst.time;
    let mut others: Vec<(SetPoint, f64)> = Vec::new();
    for family in (0..question.families.len()).filter(|family| *family != best.planned.point.family) {
        // Machines may have been added since it was run.
        for _ in 0..TRIES {
            let Some(fastest) = search.fastest_known(allowed, Some(family)) else { break };
            match search.on_all(&[fastest], allowed, most, Merit::time_kept).pop() {
                Some(found) => {
                    others.push((found.planned.point, found.worst.time));
                    break;
                }
                // This one is too slow, and so are all others.
                None if search.known_merit(&fastest, allowed).keeps() => break,
                None => {}
            }
        }
    }
    others.sort_by(|one, other| one.1.total_cmp(&other.1));
    others
}

/// The worse value of both in each figure.
fn worse(one: &Worst, other: &Worst) -> Worst {
    let usage = one.usage.iter().zip(&other.usage).map(|(one, other)| if one.0 >= other.0 { one } else { other });
    Worst { time: one.time.max(other.time), usage: usage.cloned().collect() }
}
