//! From a question to an answer that was verified.
use crate::machines::Machines;
use crate::refine::refined;
use crate::search::{Allowance, Bench, Found, Planned, SAME, Search, Worst};
use crate::set_point::{Family, SetPoint, grid};
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

/// Set-points that are at most so much slower than the best on the coarse grid are refined, so many of them and of each family.
const NEAR: f64 = 1.06;
const REFINED: usize = 12;
const OF_EACH_FAMILY: usize = 4;
/// The same where a price is asked for.
const REFINED_FOR_A_PRICE: usize = 2;
/// Rounds of search and verification.
const ROUNDS: u32 = 16;
/// From this round on draws may fail, as many as the promised share allows.
const PATIENT: u32 = 8;
/// Factors of the priced limit, in ascending order.
const TIGHTER: [f64; 4] = [0.1, 0.25, 0.5, 0.9];
const WIDER: [f64; 2] = [1.1, 2.0];

/// The fastest set-point that keeps all limits on the machines of the box.
///
/// # Errors
/// [`AdviseError`]
pub fn advise(question: &Question, bench: &mut dyn Bench) -> Result<Advice, AdviseError> {
    let mut machines = question.machines.corners();
    machines.push(question.machines.middle());
    let mut search = Search::new(bench, machines);
    let mut planned = candidates(question, &mut search)?;
    let allowed = vec![1.0; question.limits];
    let (mut shown, mut looks) = (0.0, 0);
    for round in 0..ROUNDS {
        let found = best(question, &mut search, &planned, &allowed, REFINED);
        let Some(best) = found.first().cloned() else {
            return Err(AdviseError::NoneKeeps { planned: planned.len() });
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
        let tighter = priced(question, &mut search, &planned, &TIGHTER);
        if let Some(faster) = fastest(&tighter).filter(|found| found.worst.time < best.worst.time - SAME) {
            // What keeps a tighter limit keeps this one, too: the search begins again with it.
            let place = planned.partition_point(|one| one.duration <= faster.planned.duration);
            planned.insert(place, faster.planned);
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
        let wider = priced(question, &mut search, &planned, &WIDER);
        let Planned { point, duration } = best.planned;
        let worst = worse(&best.worst, &verification.worst);
        return Ok(Advice {
            point,
            duration,
            prices: prices(&tighter, &wider, best.worst.time, worst.time),
            worst,
            verification,
            others: others(&found, point.family),
            runs: search.runs(),
            planned: planned.len(),
        });
    }
    Err(AdviseError::NotVerified { wanted: 100.0 * question.share, found: 100.0 * shown, rounds: ROUNDS })
}

/// All set-points of the coarse grid.
fn candidates(question: &Question, search: &mut Search<'_>) -> Result<Vec<Planned>, AdviseError> {
    let Limits { velocity, acceleration, .. } = question.ceiling;
    let fast = SetPoint { family: 0, limits: [velocity, acceleration, f64::INFINITY, f64::INFINITY] };
    let of_second = question.families.iter().position(|family| family.order == 2);
    let fast = SetPoint { family: of_second.unwrap_or(0), ..fast };
    let shortest = search.planned(&[fast]).first().ok_or(AdviseError::NoPlan)?.duration;
    let all: Vec<SetPoint> = question
        .families
        .iter()
        .enumerate()
        .flat_map(|(index, family)| grid(index, family, &question.ceiling, shortest))
        .collect();
    let planned = search.planned(&all);
    if planned.is_empty() { Err(AdviseError::NoPlan) } else { Ok(planned) }
}

/// The best set-points, refined, the fastest first.
fn best(
    question: &Question,
    search: &mut Search<'_>,
    planned: &[Planned],
    allowed: &Allowance,
    most: usize,
) -> Vec<Found> {
    let coarse = search.fastest(planned, allowed, NEAR);
    let mut of_family = vec![0; question.families.len()];
    let mut starts = Vec::new();
    for found in coarse {
        let count = &mut of_family[found.planned.point.family];
        if *count < OF_EACH_FAMILY && starts.len() < most {
            *count += 1;
            starts.push(found);
        }
    }
    let refine = |found| refined(search, &question.families, &question.ceiling, allowed, found);
    let mut all: Vec<Found> = starts.into_iter().map(refine).collect();
    all.sort_by(|one, other| one.worst.time.total_cmp(&other.worst.time));
    all
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

/// The best of each family but one.
fn others(found: &[Found], but: usize) -> Vec<(SetPoint, f64)> {
    let mut others: Vec<(SetPoint, f64)> = Vec::new();
    for one in found.iter().filter(|one| one.planned.point.family != but) {
        if others.iter().all(|(point, _)| point.family != one.planned.point.family) {
            others.push((one.planned.point, one.worst.time));
        }
    }
    others
}

/// The fastest with other values of the priced limit, each with its factor.
fn priced(
    question: &Question,
    search: &mut Search<'_>,
    planned: &[Planned],
    factors: &[f64],
) -> Vec<(f64, Option<Found>)> {
    let Some(priced) = question.priced else { return Vec::new() };
    let with = |factor: &f64| {
        let mut allowed = vec![1.0; question.limits];
        allowed[priced] = *factor;
        let found = best(question, search, planned, &allowed, REFINED_FOR_A_PRICE);
        (*factor, found.into_iter().next())
    };
    factors.iter().map(with).collect()
}

/// The fastest of all.
fn fastest(priced: &[(f64, Option<Found>)]) -> Option<&Found> {
    let found = priced.iter().filter_map(|(_, found)| found.as_ref());
    found.min_by(|one, other| one.worst.time.total_cmp(&other.worst.time))
}

/// What tighter and wider limits cost and save beside an advice that takes `own` (s) on the machines of the search and `worst` on those of
/// the verification, too. What keeps a tighter limit keeps a wider one, too.
fn prices(tighter: &[(f64, Option<Found>)], wider: &[(f64, Option<Found>)], own: f64, worst: f64) -> Vec<Price> {
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

/// The worse of both in each respect.
fn worse(one: &Worst, other: &Worst) -> Worst {
    let usage = one.usage.iter().zip(&other.usage).map(|(one, other)| if one.0 >= other.0 { one } else { other });
    Worst { time: one.time.max(other.time), usage: usage.cloned().collect() }
}
