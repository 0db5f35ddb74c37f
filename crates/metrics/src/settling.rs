//! Settling time, overshoot and the error at rest: the load against its target.
use crate::absence::Absence;
use crate::basis;
use crate::measure::Question;
use crate::metric::{MetricSet, MoveMetrics};
use crate::modal::{Mode, rest_beside};
use crate::name::Name;
use crate::span::{Checked, Phase, channel, largest};
use servobench_signals::Signal;
use servobench_trace::Ending;

const LOAD: Signal = Signal::LoadPosition;
/// Divisor of the time after the profile: the load must be inside the window for one such part, or it has not settled:
/// a vibration beyond the window passes through it, too.
const DWELL: usize = 20;
/// Divisor of the time after the profile: the mean over the last such part is the error at rest.
const REST: usize = 10;

/// Notes duration, settling, overshoot and the error at rest of one move.
/// `mode` is the mode of the load's ringing afterwards, if any.
pub(crate) fn note(
    set: &mut MetricSet,
    recording: &Checked<'_>,
    phase: &Phase<'_>,
    question: &Question,
    mode: Option<Mode>,
) {
    let made = phase.made;
    let length = made.end - made.start;
    let load = channel(recording, LOAD);
    let basis = basis::of(recording, &phase.rest, question);
    let at_rest = load.clone().and_then(|load| basis.map(|()| load));
    let settling = at_rest.clone().and_then(|load| settling_time(recording, load, phase, question.window));
    let unit = recording.about.axis_unit.as_str();
    set.note(Name::MoveTime, "s", Ok(length));
    set.note(Name::SettlingTime, "s", settling.clone());
    set.note(Name::MoveAndSettlingTime, "s", settling.map(|settling| length + settling));
    set.note(Name::Overshoot, unit, load.clone().and_then(|load| overshoot(load, phase)));
    set.note(
        Name::SteadyStateError,
        unit,
        at_rest.map(|load| error_at_rest(load, phase, recording.rate.period(), mode)),
    );
}

/// Notes the worst of `moves`. A move that is followed by the next before it can settle does not count, nor one whose distance is not
/// larger than the window.
pub(crate) fn note_worst(set: &mut MetricSet, recording: &Checked<'_>, moves: &[MoveMetrics]) {
    let unit = recording.about.axis_unit.as_str();
    for (name, unit) in [
        (Name::MoveTime, "s"),
        (Name::SettlingTime, "s"),
        (Name::MoveAndSettlingTime, "s"),
        (Name::Overshoot, unit),
        (Name::SteadyStateError, unit),
    ] {
        set.note(name, unit, worst(moves, name));
    }
}

/// Notes the time at which the last target is reached for good, counted from t = 0. It ends with settling, not with the profile, and
/// includes all waits and earlier moves: of two programs with the same targets, the one with the smaller time is faster.
pub(crate) fn note_program(set: &mut MetricSet, phases: &[Phase<'_>], moves: &[MoveMetrics]) {
    set.note(Name::ProgramTime, "s", program_time(phases, moves));
}

fn program_time(phases: &[Phase<'_>], moves: &[MoveMetrics]) -> Result<f64, Absence> {
    let (Some(phase), Some(last)) = (phases.last(), moves.last()) else { return Err(Absence::NoMove) };
    if phase.made.ending != Ending::AtRest {
        return Err(Absence::NoLastTarget { label: phase.made.label.clone() });
    }
    match (last.metrics.value(Name::SettlingTime), last.metrics.absence(Name::SettlingTime)) {
        (Some(settling), _) => Ok(phase.made.end + settling),
        (None, absence) => Err(absence.cloned().unwrap_or(Absence::NoMove)),
    }
}

fn worst(moves: &[MoveMetrics], name: Name) -> Result<f64, Absence> {
    let mut worst = Err(Absence::NoMove);
    for (k, metrics) in moves.iter().map(|made| &made.metrics).enumerate() {
        match (metrics.value(name), metrics.absence(name)) {
            (Some(value), _) => {
                if worst.as_ref().is_ok_and(|other: &f64| other.abs() >= value.abs()) {
                    continue;
                }
                worst = Ok(value);
            }
            (None, Some(Absence::NothingRecorded { .. } | Absence::RestTooShort { .. })) if k + 1 < moves.len() => {}
            (None, Some(absence @ Absence::WindowIsTheWay { .. })) => {
                if matches!(worst, Err(Absence::NoMove)) {
                    worst = Err(absence.clone());
                }
            }
            (None, Some(absence)) => return Err(absence.clone()),
            (None, None) => {}
        }
    }
    worst
}

/// Last exit from the window minus end of the profile; 0 when the load is inside before the profile ends and stays.
fn settling_time(
    recording: &Checked<'_>,
    load: &[f64],
    phase: &Phase<'_>,
    window: Option<f64>,
) -> Result<f64, Absence> {
    let window = window.ok_or(Absence::NoWindow)?;
    let made = phase.made;
    let distance = (made.to - made.from).abs();
    if distance > 0.0 && window >= distance {
        let (label, unit) = (made.label.clone(), recording.about.axis_unit.clone());
        return Err(Absence::WindowIsTheWay { label, window, distance, unit });
    }
    let (period, deviation) = (recording.rate.period(), |row: usize| (load[row] - made.to).abs());
    let Some(outside) = phase.until_rest_ends().rev().find(|&row| deviation(row) > window) else {
        return Ok(0.0);
    };
    let inside = phase.rest.end - 1 - outside;
    let watched = phase.rest.len();
    if inside == 0 || inside * DWELL < watched {
        return Err(Absence::NotSettled {
            label: made.label.clone(),
            window,
            unit: recording.about.axis_unit.clone(),
            exit: outside as f64 * period - made.end,
            watched: watched as f64 * period,
        });
    }
    // The crossing lies between two rows; a straight line between them finds it.
    let (before, after) = (deviation(outside), deviation(outside + 1));
    let exit = (outside as f64 + (before - window) / (before - after)) * period;
    Ok((exit - made.end).max(0.0))
}

/// Largest excursion beyond the target in the direction of the move.
fn overshoot(load: &[f64], phase: &Phase<'_>) -> Result<f64, Absence> {
    let (from, to) = (phase.made.from, phase.made.to);
    let direction = if to < from { -1.0 } else { 1.0 };
    let beyond = load[phase.rows()].iter().map(|x| direction * (x - to));
    largest(beyond, "of the move").map(|beyond| beyond.max(0.0))
}

/// Target minus position, mean over the last tenth of the time before the next move. If a mode rings, over whole periods
/// of it, and without it: a mean over part of a period would be that of the vibration.
fn error_at_rest(load: &[f64], phase: &Phase<'_>, step: f64, mode: Option<Mode>) -> f64 {
    let rows = phase.rest.clone();
    let count = rows.len().div_ceil(REST);
    if let Some(mode) = mode {
        let period = 1.0 / (mode.frequency * (1.0 - mode.damping * mode.damping).sqrt() * step);
        let periods = (count as f64 / period).ceil();
        #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "a mode is seen for two periods")]
        let count = ((periods * period).round() as usize).min(rows.len());
        let last: Vec<f64> = load[rows.end - count..rows.end].iter().map(|x| phase.made.to - x).collect();
        if let Some(rest) = rest_beside(&mode, &last, step) {
            return rest;
        }
    }
    let last = &load[rows.end - count..rows.end];
    last.iter().map(|x| phase.made.to - x).sum::<f64>() / count as f64
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::measure::measure;
    use crate::span::phases;
    use crate::synthetic::{Build, planned};
    use core::f64::consts::PI;
    use servobench_trace::Recording;

    const WINDOW: f64 = 10e-6;

    fn of_first(recording: &Recording, window: Option<f64>) -> MetricSet {
        let mut set = MetricSet::default();
        let question = Question { window, ..Question::default() };
        note(&mut set, &Checked::of(recording), &phases(recording)[0], &question, None);
        set
    }

    /// One move to 1 m that ends at 1 s; the load is `deviation(t)` beyond the target afterwards.
    fn after_a_move(deviation: impl Fn(f64) -> f64) -> Recording {
        Build::new(8000, 16_000)
            .channel(Signal::LoadPosition, "m", |t| if t < 1.0 { t } else { 1.0 + deviation(t - 1.0) })
            .moves([planned(0.0, 1.0, 0.0, 1.0).made()])
            .finish()
    }

    /// 1 mm·exp(−t/τ) leaves ±10 µm at τ·ln 100. A chord of an exponential over h lies (h/τ)²/8 = 5e-7 of the value
    /// beside it, so the crossing is that far off times τ: 5e-9 s.
    #[test]
    fn an_exponential_settles_at_its_logarithm() {
        let recording = after_a_move(|t| 1e-3 * (-t / 0.06).exp());
        let set = of_first(&recording, Some(WINDOW));
        let exact = 0.06 * 100_f64.ln();
        assert!((set.value(Name::SettlingTime).unwrap() - exact).abs() < 6e-8);
        assert!((set.value(Name::MoveAndSettlingTime).unwrap() - 1.0 - exact).abs() < 6e-8);
    }

    /// A decaying cosine enters the window many times; the last of its crests above 10 µm decides, not the first entry.
    #[test]
    fn the_last_exit_counts_not_the_first_entry() {
        let (f, sigma) = (20.0, 8.0);
        let deviation = |t: f64| 100e-6 * (-sigma * t).exp() * (2.0 * PI * f * t).cos();
        let recording = after_a_move(deviation);
        // By bisection on the closed form: the last crossing of |deviation| = 10 µm, in steps finer than the record's.
        let steps = 1_000_000;
        let last = (0..steps).rev().map(|k| f64::from(k) * 1e-6).find(|t| deviation(*t).abs() > WINDOW).unwrap();
        let first_entry = (0..steps).map(|k| f64::from(k) * 1e-6).find(|t| deviation(*t).abs() < WINDOW).unwrap();
        let settling = of_first(&recording, Some(WINDOW)).value(Name::SettlingTime).unwrap();
        // The chord between rows 125 µs apart, on a curve of slope 1.3 mm/s: below 1 µs.
        assert!((settling - last).abs() < 2e-6, "{settling} {last}");
        assert!(settling > 20.0 * first_entry, "{settling} {first_entry}");
    }

    /// 1 µm short of its target, the load rings with 100 µm at 4.3 Hz and ζ = 0.005 about that, for 4.3 periods: a mean over
    /// the last tenth would be that of less than half a period.
    #[test]
    fn the_error_at_rest_does_not_see_what_rings() {
        let (f, zeta) = (4.3, 0.005_f64);
        let omega = 2.0 * PI * f;
        let ring = |t: f64| 100e-6 * (-zeta * omega * t).exp() * (omega * (1.0 - zeta * zeta).sqrt() * t + 0.4).cos();
        let recording = after_a_move(|t| ring(t) - 1e-6);
        let mode = Mode { amplitude: 100e-6, frequency: f, damping: zeta, share: 1.0 };
        let mut set = MetricSet::default();
        note(&mut set, &Checked::of(&recording), &phases(&recording)[0], &Question::default(), Some(mode));
        let rest = set.value(Name::SteadyStateError).unwrap();
        // Positions about 1 m are rounded to 1e-16.
        assert!((rest - 1e-6).abs() < 1e-14, "{rest}");
        let polluted = of_first(&recording, None).value(Name::SteadyStateError).unwrap();
        assert!((polluted - 1e-6).abs() > 10e-6, "{polluted}");
    }

    #[test]
    fn inside_before_the_profile_ends_is_zero() {
        let recording = after_a_move(|_| 1e-6);
        assert_eq!(of_first(&recording, Some(0.1)).value(Name::SettlingTime), Some(0.0));
    }

    #[test]
    fn what_never_settles_has_no_settling_time() {
        let stays = after_a_move(|_| 20e-6);
        let why = of_first(&stays, Some(WINDOW)).absence(Name::SettlingTime).unwrap().to_string();
        let expected = "`move to 1 m` has not settled: the load left its window of ±10.0 µm again 1.00 s after the profile, \
                        of 1.00 s recorded";
        assert_eq!(why, expected);
        // Amplitude 10 % beyond the window: three quarters of the time inside, the end of the recording too.
        let rings = after_a_move(|t| 11e-6 * (2.0 * PI * 20.0 * t).sin());
        assert!(matches!(of_first(&rings, Some(WINDOW)).absence(Name::SettlingTime), Some(Absence::NotSettled { .. })));
        assert_eq!(of_first(&rings, None).absence(Name::SettlingTime), Some(&Absence::NoWindow));
        // The duration of the move does not depend on its settling.
        assert_eq!(of_first(&rings, None).value(Name::MoveTime), Some(1.0));
    }

    /// A step response of damping ratio ζ overshoots by exp(−πζ/√(1−ζ²)), here 0.3.
    #[test]
    fn overshoot_is_beyond_the_target_in_the_direction_of_the_move() {
        let zeta = (10_f64 / 3.0).ln() / (PI * PI + (10_f64 / 3.0).ln().powi(2)).sqrt();
        let (wn, root) = (100.0, (1.0 - zeta * zeta).sqrt());
        let step = |t: f64| {
            let (c, s) = ((wn * root * t).cos(), (wn * root * t).sin());
            1.0 - (-zeta * wn * t).exp() * (c + zeta / root * s)
        };
        for (from, to) in [(0.0, 2e-3), (2e-3, 0.0), (0.0, -2e-3)] {
            let recording = Build::new(100_000, 50_000)
                .channel(Signal::LoadPosition, "m", |t| from + (to - from) * step(t))
                .moves([planned(0.0, 0.01, from, to).made()])
                .finish();
            let set = of_first(&recording, None);
            // The crest is met to half a row: ½·(ω·h)²/4 relative.
            assert!((set.value(Name::Overshoot).unwrap() - 0.6e-3).abs() < 1e-9, "{set:?}");
            let rest = set.value(Name::SteadyStateError).unwrap();
            assert!(rest.abs() < 1e-9, "{rest}");
        }
    }

    /// The load leaves ±10 µm for the last time 0.06·ln 100 s after the end of the second profile, at 2.5 s; the ringing of the first one
    /// does not count, and there is no value if the last target is not reached or does not exist.
    #[test]
    fn the_program_ends_when_its_last_target_is_reached_for_good() {
        let run = |after: fn(f64) -> f64, ending: Ending| {
            let mut last = planned(2.0, 2.5, 1.0, 0.0).made();
            last.ending = ending;
            let recording = Build::new(8000, 32_000)
                .channel(LOAD, "m", move |t| match t {
                    0.0..1.0 => t,
                    1.0..2.0 => 1.0 + 1e-3,
                    2.0..2.5 => 1.0 - 2.0 * (t - 2.0),
                    _ => after(t - 2.5),
                })
                .moves([planned(0.0, 1.0, 0.0, 1.0).made(), last])
                .finish();
            let question = Question { window: Some(WINDOW), ..Question::default() };
            let metrics = measure(&recording, &question);
            assert!(metrics.moves.iter().all(|made| made.metrics.get(Name::ProgramTime).is_none()));
            metrics.run
        };
        let settles = |t: f64| 1e-3 * (-t / 0.06).exp();
        let time = run(settles, Ending::AtRest).value(Name::ProgramTime).unwrap();
        assert!((time - 2.5 - 0.06 * 100_f64.ln()).abs() < 6e-8, "{time}");
        let off = run(|_| 1e-3, Ending::AtRest);
        assert!(matches!(off.absence(Name::ProgramTime), Some(Absence::NotSettled { .. })));
        let moving = run(settles, Ending::InMotion);
        let words = moving.absence(Name::ProgramTime).map(ToString::to_string);
        assert_eq!(words.as_deref(), Some("`move to 0 m`, the last move, does not end at rest"));
    }

    #[test]
    fn the_worst_move_stands_for_the_run() {
        let slow = |t: f64| 1e-3 * (-t / 0.08).exp();
        let recording = Build::new(1000, 6000)
            .channel(Signal::LoadPosition, "m", |t| match t {
                0.0..1.0 => t,
                1.0..3.0 => 1.0 + 1e-3 * (-(t - 1.0) / 0.04).exp(),
                3.0..3.5 => 1.0 - 2.0 * (t - 3.0),
                _ => slow(t - 3.5) - 2e-6,
            })
            .moves([planned(0.0, 1.0, 0.0, 1.0).made(), planned(3.0, 3.5, 1.0, 0.0).made()])
            .finish();
        let moves: Vec<_> = phases(&recording)
            .iter()
            .map(|phase| {
                let mut metrics = MetricSet::default();
                let question = Question { window: Some(WINDOW), ..Question::default() };
                note(&mut metrics, &Checked::of(&recording), phase, &question, None);
                let made = phase.made;
                MoveMetrics { label: made.label.clone(), start: made.start, end: made.end, metrics }
            })
            .collect();
        let mut run = MetricSet::default();
        note_worst(&mut run, &Checked::of(&recording), &moves);
        assert_eq!(run.value(Name::MoveTime), Some(1.0));
        assert_eq!(run.value(Name::SettlingTime), moves[1].metrics.value(Name::SettlingTime));
        assert!((run.value(Name::SettlingTime).unwrap() - 0.08 * (1e-3_f64 / 12e-6).ln()).abs() < 1e-5);
        let longest = moves[0].metrics.value(Name::MoveAndSettlingTime);
        assert_eq!(run.value(Name::MoveAndSettlingTime), longest, "1.18 s against 0.85 s");
        assert!((run.value(Name::SteadyStateError).unwrap() - 2e-6).abs() < 1e-12);
    }
}
