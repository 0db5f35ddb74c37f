//! Runs of set-points on the machines of a search, and the best of them.
use crate::merit::Merit;
use crate::set_point::SetPoint;
use std::collections::{HashMap, HashSet};

/// What a run gave.
#[derive(Debug, Clone, PartialEq)]
pub struct Reading {
    /// Move and settling (s); not a number where the load does not settle.
    pub time: f64,
    /// Share of each limit that is used; not a number where it could not be measured.
    pub usage: Vec<f64>,
    /// Whether nothing else failed: a requirement, a run that broke off.
    pub is_sound: bool,
}

/// Makes runs.
pub trait Bench {
    /// Duration of the moves of each set-point (s); nothing of one that cannot be planned.
    fn durations(&mut self, points: &[SetPoint]) -> Vec<Option<f64>>;

    /// A run of each set-point on the machine beside it.
    fn run(&mut self, runs: &[(SetPoint, &[f64])]) -> Vec<Reading>;
}

/// The worst that a set-point gave on several machines.
#[derive(Debug, Clone, PartialEq)]
pub struct Worst {
    /// Longest move with settling (s).
    pub time: f64,
    /// Of each limit the largest share that is used, and the machine with it.
    pub usage: Vec<(f64, Vec<f64>)>,
}

/// A set-point, and how long its moves take (s).
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Planned {
    pub(crate) point: SetPoint,
    pub(crate) duration: f64,
}

/// A set-point that was run on all machines.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Found {
    pub(crate) planned: Planned,
    pub(crate) worst: Worst,
    pub(crate) merit: Merit,
}

/// Share of each limit that a run may use: 1 is the limit itself.
pub(crate) type Allowance = Vec<f64>;

/// Machines that join the search at a time.
const JOINING: usize = 4;

/// Set-points that are looked at together.
const CHUNK: usize = 16;

/// So many set-points are run before some are left out.
const DENSE: usize = 800;

/// By how much two times differ at least where one is the better (s).
pub(crate) const SAME: f64 = 1e-9;

/// Bits by which a set-point is told from others.
type Key = (usize, [u64; 4]);

/// What is known of all runs until now.
pub(crate) struct Search<'b> {
    bench: &'b mut dyn Bench,
    machines: Vec<Vec<f64>>,
    readings: HashMap<(Key, usize), Reading>,
    /// How many set-points each machine has ended.
    ended: Vec<usize>,
    runs: usize,
    /// Set-points that were run on all machines that there were, each once.
    known: Vec<Planned>,
    keys: HashSet<Key>,
}

impl<'b> Search<'b> {
    pub(crate) fn new(bench: &'b mut dyn Bench, machines: Vec<Vec<f64>>) -> Self {
        let ended = vec![0; machines.len()];
        Self { bench, machines, readings: HashMap::new(), ended, runs: 0, known: Vec::new(), keys: HashSet::new() }
    }

    /// How many runs were made.
    pub(crate) const fn runs(&self) -> usize {
        self.runs
    }

    /// One of the machines.
    pub(crate) fn machine(&self, index: usize) -> &[f64] {
        &self.machines[index]
    }

    /// From now on a set-point has to do on these machines, too.
    pub(crate) fn add(&mut self, machines: impl Iterator<Item = Vec<f64>>) {
        self.machines.extend(machines);
        self.ended.resize(self.machines.len(), 0);
    }

    /// From now on a set-point has to do on a few of these machines too, as far from each other in their order as they are.
    pub(crate) fn add_some(&mut self, machines: &[Vec<f64>]) {
        let count = machines.len().min(JOINING);
        for k in 0..count {
            self.machines.push(machines[k * (machines.len() - 1) / (count - 1).max(1)].clone());
            self.ended.push(0);
        }
    }

    /// The set-points with the durations of their moves, the shortest first; those that cannot be planned are left out.
    pub(crate) fn planned(&mut self, points: &[SetPoint]) -> Vec<Planned> {
        let durations = self.bench.durations(points);
        let with = points.iter().zip(durations);
        let mut all: Vec<Planned> =
            with.filter_map(|(point, duration)| Some(Planned { point: *point, duration: duration? })).collect();
        all.sort_by(|one, other| one.duration.total_cmp(&other.duration));
        all
    }

    /// The machine on which `probes` promise least.
    pub(crate) fn hardest(&mut self, probes: &[SetPoint], allowed: &Allowance) -> usize {
        let probes = self.planned(probes);
        let promises = |search: &mut Self, machine| {
            search.make_runs(&probes, machine);
            let all = probes.iter().map(|one| search.merit(one, machine, allowed).promise());
            all.filter(|promise| promise.is_finite()).sum::<f64>()
        };
        let sums: Vec<f64> = (0..self.machines.len()).map(|machine| promises(self, machine)).collect();
        (0..sums.len()).fold(0, |most, k| if sums[k] > sums[most] { k } else { most })
    }

    /// Runs `points`, each with an estimate of its duration (s) and the shortest first, on `machine`, until they take longer than `within` times
    /// the best that keeps its limits on all machines: those that were run. The longer none does, the more are left out.
    pub(crate) fn sifted(
        &mut self,
        points: &[(f64, SetPoint)],
        allowed: &Allowance,
        machine: usize,
        within: f64,
    ) -> Vec<Planned> {
        let (mut all, mut best, mut next) = (Vec::new(), f64::INFINITY, 0);
        while next < points.len() {
            let stride = if best.is_finite() { 1 } else { 1 + all.len() / DENSE };
            let chunk = points[next..].iter().step_by(stride).take(CHUNK);
            next += stride * CHUNK;
            let alive: Vec<SetPoint> = chunk.filter(|one| one.0 < within * best).map(|one| one.1).collect();
            if alive.is_empty() {
                break;
            }
            let planned = self.planned(&alive);
            self.make_runs(&planned, machine);
            let (kept, _): (Vec<_>, Vec<_>) =
                planned.iter().copied().partition(|one| self.merit(one, machine, allowed).keeps());
            let kept = self.on_all(&kept, allowed, best, Merit::time_kept);
            best = kept.iter().map(|one| one.merit.time).fold(best, f64::min);
            all.extend(planned);
        }
        all
    }

    /// Merit of a set-point on the machines on which it was run.
    pub(crate) fn known_merit(&self, one: &Planned, allowed: &Allowance) -> Merit {
        let of = |machine| self.readings.get(&(one.point.key(), machine));
        let readings = (0..self.machines.len()).filter_map(of);
        readings.fold(Merit::NONE, |merit, reading| merit.worse(Merit::of(reading, allowed, one.duration)))
    }

    /// Set-points that were run on all machines that there were.
    pub(crate) fn known(&self) -> &[Planned] {
        &self.known
    }

    /// The fastest of these, of a family if one is named, that keeps its limits by what is known of it; no run is made.
    pub(crate) fn fastest_known(&self, allowed: &Allowance, family: Option<usize>) -> Option<Planned> {
        let is_of_it = |one: &&Planned| family.is_none_or(|family| one.point.family == family);
        let times = self.known.iter().filter(is_of_it).map(|one| (self.known_merit(one, allowed).time_kept(), *one));
        let kept = times.filter(|(time, _)| time.is_finite());
        kept.min_by(|one, other| one.0.total_cmp(&other.0)).map(|(_, one)| one)
    }

    fn merit(&self, one: &Planned, machine: usize, allowed: &Allowance) -> Merit {
        Merit::of(&self.readings[&(one.point.key(), machine)], allowed, one.duration)
    }

    /// Those of `planned` on all machines whose merit stays below `bound` (s, as `of` has it).
    pub(crate) fn on_all(
        &mut self,
        planned: &[Planned],
        allowed: &Allowance,
        bound: f64,
        of: fn(Merit) -> f64,
    ) -> Vec<Found> {
        let mut alive: Vec<(Planned, Merit)> = planned.iter().map(|one| (*one, Merit::NONE)).collect();
        for machine in self.order() {
            let points: Vec<Planned> = alive.iter().map(|(one, _)| *one).collect();
            self.make_runs(&points, machine);
            let before = alive.len();
            alive.retain_mut(|(one, merit)| {
                *merit = merit.worse(self.merit(one, machine, allowed));
                of(*merit) < bound
            });
            self.ended[machine] += before - alive.len();
        }
        for (one, _) in &alive {
            if self.keys.insert(one.point.key()) {
                self.known.push(*one);
            }
        }
        alive.into_iter().map(|(planned, merit)| Found { planned, worst: self.worst(&planned.point), merit }).collect()
    }

    /// `planned` on all machines, if it is better than `than`: faster, where that keeps its limits; otherwise faster or nearer to them.
    pub(crate) fn better(&mut self, planned: &Planned, allowed: &Allowance, than: &Found) -> Option<Found> {
        let of = if than.merit.keeps() { Merit::time_kept } else { Merit::penalised };
        let bound = of(than.merit) - SAME;
        // Settling only adds to a move.
        let may_be: &[Planned] = if planned.duration < bound { std::slice::from_ref(planned) } else { &[] };
        self.on_all(may_be, allowed, bound, of).into_iter().next()
    }

    /// The reading of `planned` on `machine`.
    pub(crate) fn reading(&mut self, planned: &Planned, machine: usize) -> &Reading {
        self.make_runs(std::slice::from_ref(planned), machine);
        &self.readings[&(planned.point.key(), machine)]
    }

    /// Largest share of what is allowed that `planned` uses on each machine on which it was run.
    pub(crate) fn uses(&self, planned: &Planned, allowed: &Allowance) -> Vec<(usize, f64)> {
        let over = |machine: usize| {
            let reading = self.readings.get(&(planned.point.key(), machine))?;
            Some((machine, reading.usage.iter().zip(allowed).map(|(usage, most)| usage / most).fold(0.0, f64::max)))
        };
        (0..self.machines.len()).filter_map(over).collect()
    }

    /// The machines, those that end most set-points first.
    fn order(&self) -> Vec<usize> {
        let mut order: Vec<usize> = (0..self.machines.len()).collect();
        order.sort_by_key(|machine| (std::cmp::Reverse(self.ended[*machine]), *machine));
        order
    }

    fn make_runs(&mut self, points: &[Planned], machine: usize) {
        let is_new = |one: &&Planned| !self.readings.contains_key(&(one.point.key(), machine));
        let new: Vec<SetPoint> = points.iter().filter(is_new).map(|one| one.point).collect();
        let runs: Vec<(SetPoint, &[f64])> =
            new.iter().map(|point| (*point, self.machines[machine].as_slice())).collect();
        let readings = self.bench.run(&runs);
        self.runs += new.len();
        for (point, reading) in new.iter().zip(readings) {
            self.readings.insert((point.key(), machine), reading);
        }
    }

    /// The worst of what is known of `point`.
    fn worst(&self, point: &SetPoint) -> Worst {
        let machines = self.machines.iter().enumerate();
        let known =
            machines.filter_map(|(k, machine)| Some((machine.as_slice(), self.readings.get(&(point.key(), k))?)));
        worst_of(known)
    }

    /// Runs of one set-point on other machines than those of the search, which are not kept.
    pub(crate) fn on(&mut self, point: SetPoint, machines: &[Vec<f64>]) -> Vec<Reading> {
        self.runs += machines.len();
        let runs: Vec<(SetPoint, &[f64])> = machines.iter().map(|machine| (point, machine.as_slice())).collect();
        self.bench.run(&runs)
    }
}

/// Whether a run is within what is allowed.
pub(crate) fn keeps(reading: &Reading, allowed: &Allowance) -> bool {
    // What could not be measured is not kept.
    reading.is_sound && reading.time.is_finite() && reading.usage.iter().zip(allowed).all(|(usage, most)| usage <= most)
}

/// The worst of several readings, each with its machine.
pub(crate) fn worst_of<'m>(readings: impl Iterator<Item = (&'m [f64], &'m Reading)>) -> Worst {
    let mut worst = Worst { time: f64::NEG_INFINITY, usage: Vec::new() };
    for (machine, reading) in readings {
        worst.time = if reading.time.is_nan() { f64::INFINITY } else { worst.time.max(reading.time) };
        worst.usage.resize(reading.usage.len(), (f64::NEG_INFINITY, Vec::new()));
        for (most, usage) in worst.usage.iter_mut().zip(&reading.usage) {
            if usage.is_nan() || *usage > most.0 {
                *most = (*usage, machine.to_vec());
            }
        }
    }
    worst
}
