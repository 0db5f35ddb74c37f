//! Runs of set-points on the machines of a search, and the best of them.
use crate::merit::Merit;
use crate::set_point::SetPoint;
use std::collections::{HashMap, HashSet};

/// Result of a run.
#[derive(Debug, Clone, PartialEq)]
pub struct Reading {
    /// Move and settling time (s); NaN if the load does not settle.
    pub time: f64,
    /// Used share of each limit; NaN if it could not be measured.
    pub usage: Vec<f64>,
    /// True if nothing else failed: no requirement, no aborted run.
    pub is_sound: bool,
}

/// Execution of runs.
pub trait Bench {
    /// Duration of the moves of each set-point (s); `None` if it cannot be planned.
    fn durations(&mut self, points: &[SetPoint]) -> Vec<Option<f64>>;

    /// Runs each set-point on its machine.
    fn run(&mut self, runs: &[(SetPoint, &[f64])]) -> Vec<Reading>;
}

/// The worst figures of a set-point on several machines.
#[derive(Debug, Clone, PartialEq)]
pub struct Worst {
    /// Longest move with settling (s).
    pub time: f64,
    /// The largest used share of each limit, and the machine of that.
    pub usage: Vec<(f64, Vec<f64>)>,
}

/// A set-point with the duration of its moves (s).
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Planned {
    pub(crate) point: SetPoint,
    pub(crate) duration: f64,
}

/// A set-point with results on all machines.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Found {
    pub(crate) planned: Planned,
    pub(crate) worst: Worst,
    pub(crate) merit: Merit,
}

/// Share of each limit that a run may use: 1 is the limit itself.
pub(crate) type Allowance = Vec<f64>;

/// Number of machines that join the search at once.
const JOINING: usize = 4;

/// Number of set-points evaluated together.
const CHUNK: usize = 16;

/// Number of set-points run before some are skipped.
const DENSE: usize = 800;

/// Smallest difference of times that counts as better (s).
pub(crate) const SAME: f64 = 1e-9;

/// Bits that identify a set-point.
type Key = (usize, [u64; 4]);

/// Results of all runs so far.
pub(crate) struct Search<'b> {
    bench: &'b mut dyn Bench,
    machines: Vec<Vec<f64>>,
    readings: HashMap<(Key, usize), Reading>,
    /// Number of set-points that each machine has excluded.
    ended: Vec<usize>,
    runs: usize,
    /// Set-points run on all machines present at that time, each once.
    known: Vec<Planned>,
    keys: HashSet<Key>,
}

impl<'b> Search<'b> {
    pub(crate) fn new(bench: &'b mut dyn Bench, machines: Vec<Vec<f64>>) -> Self {
        let ended = vec![0; machines.len()];
        Self { bench, machines, readings: HashMap::new(), ended, runs: 0, known: Vec::new(), keys: HashSet::new() }
    }

    /// Number of runs.
    pub(crate) const fn runs(&self) -> usize {
        self.runs
    }

    /// One of the machines.
    pub(crate) fn machine(&self, index: usize) -> &[f64] {
        &self.machines[index]
    }

    /// Adds machines on which set-points must also meet the limits.
    pub(crate) fn add(&mut self, machines: impl Iterator<Item = Vec<f64>>) {
        self.machines.extend(machines);
        self.ended.resize(self.machines.len(), 0);
    }

    /// Adds a few of these machines, evenly spread in their order.
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

    /// The machine with the longest promised times of `probes`.
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

    /// Runs `points`, each with an estimate of its duration (s), the shortest first, on `machine`, until they take longer than `within`
    /// times the best within its limits on all machines; returns those run. The longer none is found, the more points are skipped.
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

    /// Merit of a set-point on the machines on which it has run.
    pub(crate) fn known_merit(&self, one: &Planned, allowed: &Allowance) -> Merit {
        let of = |machine| self.readings.get(&(one.point.key(), machine));
        let readings = (0..self.machines.len()).filter_map(of);
        readings.fold(Merit::NONE, |merit, reading| merit.worse(Merit::of(reading, allowed, one.duration)))
    }

    /// Set-points run on all machines present at that time.
    pub(crate) fn known(&self) -> &[Planned] {
        &self.known
    }

    /// The fastest known set-point, of a given family if any, that meets its limits in the runs so far; makes no run.
    pub(crate) fn fastest_known(&self, allowed: &Allowance, family: Option<usize>) -> Option<Planned> {
        let is_of_it = |one: &&Planned| family.is_none_or(|family| one.point.family == family);
        let times = self.known.iter().filter(is_of_it).map(|one| (self.known_merit(one, allowed).time_kept(), *one));
        let kept = times.filter(|(time, _)| time.is_finite());
        kept.min_by(|one, other| one.0.total_cmp(&other.0)).map(|(_, one)| one)
    }

    fn merit(&self, one: &Planned, machine: usize, allowed: &Allowance) -> Merit {
        Merit::of(&self.readings[&(one.point.key(), machine)], allowed, one.duration)
    }

    /// Those of `planned` whose merit by `of` (s) stays below `bound` on all machines.
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

    /// `planned` on all machines, if it is better than `than`: faster if that meets its limits; otherwise faster or closer to them.
    pub(crate) fn better(&mut self, planned: &Planned, allowed: &Allowance, than: &Found) -> Option<Found> {
        let of = if than.merit.keeps() { Merit::time_kept } else { Merit::penalised };
        let bound = of(than.merit) - SAME;
        // Settling only lengthens a move.
        let may_be: &[Planned] = if planned.duration < bound { std::slice::from_ref(planned) } else { &[] };
        self.on_all(may_be, allowed, bound, of).into_iter().next()
    }

    /// The reading of `planned` on `machine`.
    pub(crate) fn reading(&mut self, planned: &Planned, machine: usize) -> &Reading {
        self.make_runs(std::slice::from_ref(planned), machine);
        &self.readings[&(planned.point.key(), machine)]
    }

    /// Largest used share of the allowed values of `planned` for each machine on which it has run.
    pub(crate) fn uses(&self, planned: &Planned, allowed: &Allowance) -> Vec<(usize, f64)> {
        let over = |machine: usize| {
            let reading = self.readings.get(&(planned.point.key(), machine))?;
            Some((machine, reading.usage.iter().zip(allowed).map(|(usage, most)| usage / most).fold(0.0, f64::max)))
        };
        (0..self.machines.len()).filter_map(over).collect()
    }

    /// The machines, those that exclude most set-points first.
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

    /// The worst known figures of `point`.
    fn worst(&self, point: &SetPoint) -> Worst {
        let machines = self.machines.iter().enumerate();
        let known =
            machines.filter_map(|(k, machine)| Some((machine.as_slice(), self.readings.get(&(point.key(), k))?)));
        worst_of(known)
    }

    /// Runs of one set-point on machines outside of the search; the results are not stored.
    pub(crate) fn on(&mut self, point: SetPoint, machines: &[Vec<f64>]) -> Vec<Reading> {
        self.runs += machines.len();
        let runs: Vec<(SetPoint, &[f64])> = machines.iter().map(|machine| (point, machine.as_slice())).collect();
        self.bench.run(&runs)
    }
}

/// True if a run is within the allowed values.
pub(crate) fn keeps(reading: &Reading, allowed: &Allowance) -> bool {
    // An unmeasured limit is not met.
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
