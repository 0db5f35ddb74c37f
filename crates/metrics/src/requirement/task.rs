//! The task of a run as its rules judge it: motions, rests, and holds of a velocity, each measured against the response of the loop.
//!
//! Phases that request a position follow each other without a gap: their motions lead from one rest to the next. A rest shorter than
//! [`Task::least_rest`] belongs to the motion that passes it, unless the run ends in it.
use super::phases::{RequestPhase, between_turning_points, request_phases};
use super::stretch::{Rows, Stretch, measure};
use super::{Expected, Rules, arrival_window};
use crate::extremes::{most_of, span_of};
use crate::quantity::Quantity;
use servobench_base::RequestKind;
use servobench_signals::{PerLimit, Signal};
use servobench_trace::Recording;
use std::ops::Range;

/// Least distance between turns of the request, in increments or units of the bus; closer ones do not count.
const TURNS: f64 = 20.0;
/// The same as a share of the farthest motion: an interpolation overshoots by less.
pub(super) const OF_FARTHEST: f64 = 1e-3;
/// Share of positions below which their differences are rounding.
pub(super) const ROUNDING: f64 = 1e-12;
/// Shortest rest and shortest hold that is judged (s).
const SHORTEST: f64 = 0.02;
/// Time constants after which the loop has come to rest.
pub(super) const TIME_CONSTANTS: f64 = 5.0;
/// Shortest rest that is judged, in periods of the slowest oscillation.
const PERIODS: f64 = 2.0;
/// Largest time (s) between a fault and the end of the request of the task, either way.
const SEEN_WITHIN: f64 = 0.02;
/// Swings of the load that do not count: in increments, and as a share of the window.
const SWING: (f64, f64) = (4.0, 1e-3);
/// Cycles at the end of a rest over which the load is averaged, if the first one in its second half exceeds the last by [`DIES_OUT`].
const CYCLES: usize = 2;
const DIES_OUT: f64 = 2.0;
/// Ratio to the last swing beyond which a motion is no longer a swing.
const GROWS: f64 = 2.0;
/// Least rows of a hold, and tolerance of equal velocities.
const HOLD: (usize, f64) = (20, 1e-9);

/// A piece of the task.
#[derive(Debug, Clone, PartialEq)]
pub(super) enum Piece {
    /// From one turning point of the request to the next.
    Way,
    /// At a target, after a motion over the distance `way`; `is_short`: too short for the loop to come to rest.
    Rest { way: f64, is_short: bool },
    /// At this velocity, in the second half of the time.
    Hold(f64),
}

/// The task of a run.
pub(super) struct Task<'a> {
    pub(super) recording: &'a Recording,
    pub(super) rules: &'a Rules<'a>,
    pub(super) expected: &'a [Expected],
    pub(super) phases: Vec<RequestPhase>,
    /// `None`: the recording lacks a channel.
    pub(super) rows: Option<Rows<'a>>,
    pub(super) pieces: Vec<(Piece, Stretch)>,
    /// Largest disturbance of motor and load, both as efforts of the motor, and that of the load in its own coordinate.
    pub(super) disturbance: f64,
    pub(super) on_load: f64,
}

impl<'a> Task<'a> {
    pub(super) fn of(recording: &'a Recording, rules: &'a Rules<'a>, expected: &'a [Expected]) -> Self {
        let largest = |signal| {
            let values: &[f64] = recording.channel(signal).unwrap_or_default();
            most_of([values], |[value]| value.abs())
        };
        let on_load = largest(Signal::DisturbanceLoad);
        let mut task = Self {
            recording,
            rules,
            expected,
            phases: request_phases(recording),
            rows: Rows::of(recording),
            pieces: Vec::new(),
            disturbance: largest(Signal::DisturbanceMotor) + rules.transmission.abs() * on_load,
            on_load,
        };
        if let Some(rows) = task.rows {
            task.pieces = task.cut(&rows);
            let (pieces, mut stretches): (Vec<_>, Vec<_>) = std::mem::take(&mut task.pieces).into_iter().unzip();
            measure(&rows, &task.phases, rules, &mut stretches);
            task.pieces = pieces.into_iter().zip(stretches).collect();
        }
        task
    }

    /// Half width of the window around a target after a motion over `distance`.
    pub(super) fn window(&self, distance: f64) -> f64 {
        self.rules.window.unwrap_or_else(|| arrival_window(distance, self.rules.resolution()))
    }

    /// Shortest rest in which the loop comes to rest (s).
    pub(super) fn least_rest(&self) -> f64 {
        let of_loop = self.rules.servo.map_or(0.0, |servo| TIME_CONSTANTS / servo.slowest_rate());
        let of_swing = self.rules.oscillation().map_or(0.0, |slowest| PERIODS / slowest.frequency);
        of_loop.max(of_swing).max(SHORTEST)
    }

    /// True if an expected fault occurs in `rows`, or where they end.
    pub(super) fn is_excused(&self, rows: &Range<usize>) -> bool {
        let (start, end) = (self.recording.time_of(rows.start), self.recording.time_of(rows.end));
        self.expected.iter().filter_map(|one| one.met).any(|at| (start - SEEN_WITHIN..end + SEEN_WITHIN).contains(&at))
    }

    /// The move at `row`, in words: `, in "move to 0.2 m"`.
    pub(super) fn within(&self, row: usize) -> String {
        let time = self.recording.time_of(row);
        let made = self.recording.moves.iter().rfind(|made| made.start <= time);
        made.map_or_else(String::new, |made| format!(" in `{}`", made.label))
    }

    /// The row at which the move at `row` began.
    pub(super) fn begun(&self, row: usize) -> usize {
        let time = self.recording.time_of(row);
        let made = self.recording.moves.iter().rfind(|made| made.start <= time);
        made.map_or(row, |made| self.recording.index_at(made.start)).min(row)
    }

    /// Distance that the request covers at a velocity right before and behind a motion: a ramp is a part of that motion.
    pub(super) fn beside(&self, way: &Range<usize>) -> f64 {
        let Some(rows) = self.rows else { return 0.0 };
        let touches = |phase: &&RequestPhase| phase.rows.end == way.start || phase.rows.start == way.end;
        let held = self.phases.iter().filter(|phase| phase.kind == RequestKind::Velocity).filter(touches);
        held.map(|phase| span_of(&rows.request[phase.rows.clone()])).sum()
    }

    /// A position of the axis in words.
    pub(super) fn length(&self, value: f64) -> Quantity<'_> {
        Quantity::new(value, &self.recording.about.axis_unit)
    }

    /// A time of the run in words.
    pub(super) fn time(&self, row: usize) -> Quantity<'static> {
        Quantity::new(self.recording.time_of(row), "s")
    }

    /// The limit of the drive that binds for the longest time in `rows`, as the end of a sentence.
    pub(super) fn bound_by(&self, rows: &Range<usize>) -> String {
        let (start, end) = (self.recording.time_of(rows.start), self.recording.time_of(rows.end));
        let PerLimit { voltage, current, effort, speed, master } = PerLimit::NAMES;
        let bound = [effort, current, voltage, speed, master].map(|limit| {
            let events = self.recording.events.iter();
            let binding = events.filter(|event| event.limit.as_ref().is_some_and(|bound| bound.name == limit));
            let time: f64 = binding.map(|event| (event.end.min(end) - event.start.max(start)).max(0.0)).sum();
            (limit, time)
        });
        match bound.into_iter().reduce(|one, two| if two.1 > one.1 { two } else { one }) {
            Some((limit, time)) if time > 0.0 => format!("; {limit} bound for {}", Quantity::new(time, "s")),
            _ => String::new(),
        }
    }

    fn cut(&self, rows: &Rows<'_>) -> Vec<(Piece, Stretch)> {
        let mut pieces = Vec::new();
        let mut way: Option<Range<usize>> = None;
        let mut left: Option<usize> = None;
        let mut is_interrupted = false;
        // Beginning of a motion that a silence has broken off.
        let mut broken_off: Option<usize> = None;
        let least = self.least_rest();
        let least_way = self.least_way(rows);
        for (k, phase) in self.phases.iter().enumerate() {
            let before = &self.phases[k.saturating_sub(2)..k];
            if phase.kind == RequestKind::Nothing {
                broken_off = way.as_ref().map(|way| left.unwrap_or(way.start));
            } else if phase.kind != RequestKind::Rest {
                broken_off = None;
            }
            match phase.kind {
                RequestKind::Follow | RequestKind::Velocity => left = left.or(Some(phase.rows.start)),
                RequestKind::Stand | RequestKind::Effort | RequestKind::Nothing => left = None,
                RequestKind::Rest => {}
            }
            match phase.kind {
                RequestKind::Follow => {
                    // The link catches up with a task that has continued in the meantime.
                    is_interrupted |= way.is_none() && is_silence(before);
                    way = Some(way.map_or(phase.rows.start, |way| way.start)..phase.rows.end);
                }
                RequestKind::Rest => {
                    let is_short = (phase.rows.len() as f64) * rows.h < least;
                    if is_short && phase.rows.end < self.recording.len() {
                        way = way.map(|way| way.start..phase.rows.end);
                    } else if let Some(way) = way.take() {
                        let from = left.take().unwrap_or(way.start);
                        let distance = span_of(&rows.request[from..way.end]);
                        Self::ways(rows, way, least_way, std::mem::take(&mut is_interrupted), &mut pieces);
                        let piece = Piece::Rest { way: distance, is_short };
                        pieces.push((piece, Stretch::new(self.settled(rows, &phase.rows, distance))));
                    } else if let Some(from) = broken_off.take() {
                        // The task has continued to its target meanwhile.
                        let distance = (rows.request[phase.rows.start] - rows.request[from]).abs();
                        let piece = Piece::Rest { way: distance, is_short };
                        pieces.push((piece, Stretch::new(self.settled(rows, &phase.rows, distance))));
                    }
                }
                RequestKind::Velocity | RequestKind::Effort | RequestKind::Stand | RequestKind::Nothing => {
                    if let Some(way) = way.take() {
                        Self::ways(rows, way, least_way, std::mem::take(&mut is_interrupted), &mut pieces);
                    }
                    if phase.kind == RequestKind::Velocity {
                        holds(rows, &phase.rows, &mut pieces);
                    }
                }
            }
        }
        if let Some(way) = way {
            Self::ways(rows, way, least_way, std::mem::take(&mut is_interrupted), &mut pieces);
        }
        pieces
    }

    /// Least distance of the request between turning points.
    fn least_way(&self, rows: &Rows<'_>) -> f64 {
        let follows = self.phases.iter().filter(|phase| phase.kind == RequestKind::Follow);
        let farthest = follows.map(|phase| span_of(&rows.request[phase.rows.clone()])).fold(0.0, f64::max);
        (TURNS * self.rules.resolution()).max(OF_FARTHEST * farthest)
    }

    /// The motions of the request in `all`, except one on which a link recovers from an interruption.
    fn ways(rows: &Rows<'_>, all: Range<usize>, least: f64, is_interrupted: bool, pieces: &mut Vec<(Piece, Stretch)>) {
        let request = &rows.request[all.clone()];
        let rounding = ROUNDING * request[0].abs().max(request[request.len() - 1].abs());
        let least = least.max(rounding);
        if span_of(request) > least {
            let ways = between_turning_points(rows.request, &all, least);
            let ways = ways.into_iter().skip(usize::from(is_interrupted));
            let ways = ways.filter(|way| !way.is_empty() && !jumps(rows, &all, way, least));
            pieces.extend(ways.map(|way| (Piece::Way, Stretch::new(way))));
        }
    }

    /// Rows of a rest over which the load is averaged: whole cycles if it swings to its end, the whole rest if there are too few of
    /// them, otherwise its last tenth.
    fn settled(&self, rows: &Rows<'_>, rest: &Range<usize>, way: f64) -> Range<usize> {
        const REST: usize = 10;
        let hysteresis = (SWING.0 * self.rules.increment).max(SWING.1 * self.window(way));
        let pieces = between_turning_points(rows.load, rest, hysteresis.max(ROUNDING * rows.load[rest.start].abs()));
        let turns: Vec<usize> = pieces.iter().skip(1).map(|piece| piece.start).collect();
        let middle = rest.start + rest.len() / 2;
        // One turn is the end of a creeping approach. A swing that continues at the end turns again after half a cycle, and a little later
        // that is seen; it is not larger than before.
        let goes_on = match turns[..] {
            [.., before, last] => {
                let (swing, rest_of_it) = (span_of(&rows.load[before..last]), span_of(&rows.load[last..rest.end]));
                last >= middle && 2 * (rest.end - last) <= 3 * (last - before) && rest_of_it <= GROWS * swing
            }
            _ => false,
        };
        if let [.., one, _, last] = turns[..]
            && goes_on
        {
            // If they die out, only the last ones: those before still come nearer.
            let half: Vec<usize> = turns.iter().rev().step_by(2).copied().take_while(|turn| *turn >= middle).collect();
            let sizes = || half.windows(2).map(|cycle| span_of(&rows.load[cycle[1]..cycle[0]]));
            let dies_out = sizes().next_back() > sizes().next().map(|size| DIES_OUT * size);
            let cycles = if dies_out { half.get(CYCLES).or(half.last()) } else { half.last() };
            let from = cycles.copied().filter(|from| *from < last).unwrap_or(one);
            return from..last;
        }
        if goes_on { rest.clone() } else { rest.end - rest.len().div_ceil(REST)..rest.end }
    }
}

/// True if the request jumps in `way` or where it meets others of `all`, by more than `least` beyond its velocity: a task that
/// stood still for a while continues from its position.
fn jumps(rows: &Rows<'_>, all: &Range<usize>, way: &Range<usize>, least: f64) -> bool {
    let (first, last) = (way.start.saturating_sub(1).max(all.start), way.end.min(all.end - 1));
    (first..last).any(|row| {
        let speed = rows.request_velocity[row].abs().max(rows.request_velocity[row + 1].abs());
        (rows.request[row + 1] - rows.request[row]).abs() > 2.0 * rows.h * speed + least
    })
}

/// True if a motion was broken off by a silence of the task.
fn is_silence(before: &[RequestPhase]) -> bool {
    matches!(before, [moved, silent] if moved.kind == RequestKind::Follow && silent.kind == RequestKind::Nothing)
}

/// Times of `phase` in which the requested velocity is constant: their second halves.
fn holds(rows: &Rows<'_>, phase: &Range<usize>, pieces: &mut Vec<(Piece, Stretch)>) {
    let mut start = phase.start;
    for row in phase.start + 1..=phase.end {
        let velocity = rows.request_velocity[start];
        let is_same = row < phase.end && (rows.request_velocity[row] - velocity).abs() <= HOLD.1 * velocity.abs();
        if is_same {
            continue;
        }
        let length = row - start;
        if length >= HOLD.0 && length as f64 * rows.h >= SHORTEST {
            pieces.push((Piece::Hold(velocity), Stretch::new(start + length / 2..row)));
        }
        start = row;
    }
}
