//! The fastest of many set-points that keeps its limits on all machines.
use crate::set_point::SetPoint;
use std::collections::HashMap;

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

/// A set-point that keeps all limits.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Found {
    pub(crate) planned: Planned,
    pub(crate) worst: Worst,
}

/// Machines that join the search at a time.
const JOINING: usize = 4;

/// Set-points that are looked at together.
const CHUNK: usize = 32;

/// By how much two times differ at least where one is the better (s).
pub(crate) const SAME: f64 = 1e-9;

/// What is known of all runs until now.
pub(crate) struct Search<'b> {
    bench: &'b mut dyn Bench,
    machines: Vec<Vec<f64>>,
    readings: HashMap<((usize, [u64; 4]), usize), Reading>,
    /// How many set-points each machine has ended.
    ended: Vec<usize>,
    runs: usize,
}

/// What is asked of a run: how much of each limit it may use. 1 is the limit itself.
pub(crate) type Allowance = Vec<f64>;

impl<'b> Search<'b> {
    pub(crate) fn new(bench: &'b mut dyn Bench, machines: Vec<Vec<f64>>) -> Self {
        let ended = vec![0; machines.len()];
        Self { bench, machines, readings: HashMap::new(), ended, runs: 0 }
    }

    /// How many runs were made.
    pub(crate) const fn runs(&self) -> usize {
        self.runs
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

    /// Those of `planned`, the shortest moves first, that are within `allowed` on all machines and take at most `within` times as long as the
    /// fastest of them; the fastest first.
    pub(crate) fn fastest(&mut self, planned: &[Planned], allowed: &Allowance, within: f64) -> Vec<Found> {
        self.fastest_below(planned, allowed, within, f64::INFINITY)
    }

    /// The same of those that are faster than `most` (s).
    pub(crate) fn fastest_below(
        &mut self,
        planned: &[Planned],
        allowed: &Allowance,
        within: f64,
        most: f64,
    ) -> Vec<Found> {
        let mut found: Vec<Found> = Vec::new();
        let mut bound = most;
        for chunk in planned.chunks(CHUNK) {
            let mut alive: Vec<Planned> = chunk.iter().copied().filter(|one| one.duration < bound - SAME).collect();
            if alive.is_empty() && chunk.iter().all(|one| one.duration >= bound - SAME) {
                break;
            }
            for machine in self.order() {
                self.make_runs(&alive, machine);
                let before = alive.len();
                alive.retain(|one| {
                    let reading = &self.readings[&(one.point.key(), machine)];
                    keeps(reading, allowed) && reading.time < bound - SAME
                });
                self.ended[machine] += before - alive.len();
            }
            for planned in alive {
                let worst = self.worst(&planned.point);
                bound = bound.min(within * worst.time);
                found.push(Found { planned, worst });
            }
        }
        let best = found.iter().map(|found| found.worst.time).fold(f64::INFINITY, f64::min);
        found.retain(|found| found.worst.time <= within * best);
        found.sort_by(|one, other| {
            one.worst.time.total_cmp(&other.worst.time).then(one.planned.duration.total_cmp(&other.planned.duration))
        });
        found
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
