//! From a question to an answer that was verified.
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

/// What is asked.
#[derive(Debug, Clone, PartialEq)]
pub struct Question {
    /// Kinds of set-points to choose from.
    pub families: Vec<Family>,
    /// The largest limits that a set-point may have; infinite where none is given.
    pub ceiling: Limits,
    /// Distance of the longest move (m or rad).
    pub distance: f64,
    /// The machines on which it has to do.
    pub machines: Machines,
    /// Natural frequency of the mode that rings (Hz), which says how fine lobes are.
    pub frequency: f64,
    /// How many limits a run is judged by.
    pub limits: usize,
    /// The limit whose price is asked for, by its index.
    pub priced: Option<usize>,
    /// Share of the machines that is promised.
    pub share: f64,
    /// Draws that verify it.
    pub draws: u32,
    /// Seed of the draws.
    pub seed: u64,
}

/// The answer.
#[derive(Debug, Clone, PartialEq)]
pub struct Advice {
    /// The fastest set-point that was found.
    pub point: SetPoint,
    /// Duration of its moves (s).
    pub duration: f64,
    /// The worst that it gave on any machine of search and verification.
    pub worst: Worst,
    /// How it was verified.
    pub verification: Verification,
    /// The best of each other family, with its worst time (s), the fastest first: on the machines of the search.
    pub others: Vec<(SetPoint, f64)>,
    /// What another limit would cost or save.
    pub prices: Vec<Price>,
    /// Runs that were made.
    pub runs: usize,
    /// Set-points that were planned.
    pub planned: usize,
}

/// What a limit costs.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Price {
    /// The limit, in parts of what it is.
    pub factor: f64,
    /// The worst time (s) with that limit: that of the advice, and what the fastest set-point differs from it on the machines of the
    /// search; `None`: there is none.
    pub time: Option<f64>,
}

/// Why there is no advice.
#[derive(Debug, Clone, PartialEq, Error)]
pub enum AdviseError {
    /// No move can be planned.
    #[error("no move can be planned within the limits of the set-point")]
    NoPlan,
    /// No set-point keeps the limits.
    #[error(
        "none of the {planned} set-points that were planned keeps all limits on all machines: raise `[limits]`, make the box smaller, or let \
         the run be longer if moves do not come to their end in it"
    )]
    NoneKeeps {
        /// Set-points that were planned.
        planned: usize,
    },
    /// What was found failed on machines that the search had not seen, again and again.
    #[error(
        "no set-point was found that keeps all limits on {wanted:.1} % of the machines: after {rounds} rounds the best one keeps them on \
         {found:.1} % at least; promise a smaller share, or make the box smaller"
    )]
    NotVerified {
        /// Share that is wanted (%).
        wanted: f64,
        /// What was shown (%).
        found: f64,
        /// Rounds of search and verification.
        rounds: u32,
    },
    /// Fewer draws than the promise needs, were they all clean.
    #[error(
        "{draws} draws show {shown:.1} % of the machines at most: a promise of {wanted} % needs {needed}; draw as many, or promise less"
    )]
    TooFewDraws {
        /// Draws.
        draws: u32,
        /// Share that as many clean draws show (%).
        shown: f64,
        /// Share that is wanted (%).
        wanted: f64,
        /// Draws that it needs.
        needed: u32,
    },
    /// A promise that no number of draws shows.
    #[error("a promise of {wanted} % of the machines needs more than {most} draws; promise less")]
    TooMuch {
        /// Share that is wanted (%).
        wanted: f64,
        /// The most draws.
        most: u32,
    },
    /// A box that is too wide to be verified.
    #[error(
        "`{key}` moves the mode through {needed} machines that would have to be run, at most {most} are: make its range smaller, or advise \
         for parts of it"
    )]
    TooWide {
        /// The range.
        key: String,
        /// Machines along it.
        needed: f64,
        /// The most that are run.
        most: f64,
    },
    /// The box cannot be drawn from.
    #[error(transparent)]
    Draws(#[from] SweepError),
}

/// The search begins again where machines that have joined make the best so many times slower.
const SLOWER: f64 = 1.01;
/// Rounds of search and verification.
const ROUNDS: u32 = 16;
/// From this round on draws may fail, as many as the promised share allows.
const PATIENT: u32 = 8;
/// Other kinds are told that take so many times the best time at most.
const WORTH: f64 = 1.06;
/// So many set-points of a kind are tried on machines that have joined.
const TRIES: usize = 4;

/// The fastest set-point that keeps all limits on the machines of the box.
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
            // Machines that have joined leave another set-point the best.
            let from = [known, sifted.clone()].concat();
            found = best(question, &mut search, &from, &allowed, Effort::of_first(question.families.len()));
        }
        before = found.first().map_or(before, |found| found.worst.time);
        let Some(best) = found.first().cloned() else {
            return Err(AdviseError::NoneKeeps { planned });
        };
        // Draws that have helped to find it prove nothing.
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
            // What keeps a tighter limit keeps this one, too: the search begins again with it, which it knows now.
            continue;
        }
        let (verification, failed) = on_draws(&mut search, &best.planned, &grid, &allowed, plan)?;
        looks += 1;
        shown = verification.share;
        // A draw on which it fails joins the search, as long as there are rounds for that.
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

/// Refuses a promise that the draws of a question do not show, were they all clean.
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

/// The best that is known of each family but that of `best`, if it takes little more time: on the machines of the search.
fn others(question: &Question, search: &mut Search<'_>, allowed: &Allowance, best: &Found) -> Vec<(SetPoint, f64)> {
    let most = WORTH * best.worst.time;
    let mut others: Vec<(SetPoint, f64)> = Vec::new();
    for family in (0..question.families.len()).filter(|family| *family != best.planned.point.family) {
        // Machines may have joined since it was run.
        for _ in 0..TRIES {
            let Some(fastest) = search.fastest_known(allowed, Some(family)) else { break };
            match search.on_all(&[fastest], allowed, most, Merit::time_kept).pop() {
                Some(found) => {
                    others.push((found.planned.point, found.worst.time));
                    break;
                }
                // It takes too long, and so do all others.
                None if search.known_merit(&fastest, allowed).keeps() => break,
                None => {}
            }
        }
    }
    others.sort_by(|one, other| one.1.total_cmp(&other.1));
    others
}

/// The worse of both in each respect.
fn worse(one: &Worst, other: &Worst) -> Worst {
    let usage = one.usage.iter().zip(&other.usage).map(|(one, other)| if one.0 >= other.0 { one } else { other });
    Worst { time: one.time.max(other.time), usage: usage.cloned().collect() }
}
