//! `stands`: before its first motion, the axis stays at its place.
use super::excitation::disturbed;
use super::rules::Driven;
use super::task::Task;
use servobench_base::RequestKind;
use servobench_signals::Signal;

/// Multiple of the explained deflection that is allowed.
const TIMES: f64 = 3.0;
/// Multiple of the stroke within which friction holds the load.
const STICK: f64 = 1.5;
/// Resolutions within which the axis stands.
const RESOLUTIONS: f64 = 10.0;
/// Multiple of the initial deviation, and of the distance in which the loop brakes a load that moves at the beginning.
const INITIAL: f64 = 2.0;
/// Least share of the explained deflection that is allowed at any time: integrators of increments and friction never remove it.
const LEFT: f64 = 0.01;
/// Time in which the velocity at the beginning is read (s).
const FIRST: f64 = 1e-3;

/// Reasons why the axis does not stand; `None` where it need not stand before it moves.
pub(super) fn broken(task: &Task<'_>) -> Option<Vec<String>> {
    let rows = task.rows.as_ref()?;
    let servo = task.rules.servo.filter(|_| task.rules.driven == Driven::ByLoops)?;
    let moves = |kind| matches!(kind, RequestKind::Follow | RequestKind::Velocity | RequestKind::Effort);
    let standing: Vec<_> = task
        .phases
        .iter()
        .take_while(|phase| !moves(phase.kind))
        .filter(|phase| matches!(phase.kind, RequestKind::Stand | RequestKind::Rest))
        .collect();
    if standing.is_empty() {
        return None;
    }
    let rules = task.rules;
    let deflection = &rules.deflection;
    let of_pole = rules.poles.and_then(|poles| poles.slowest_real).unwrap_or(servo.gain / 2.0);
    let sigma = rules.oscillation().map_or(of_pole, |slowest| slowest.decay.min(of_pole)).max(0.0);
    let kept = (-sigma * rows.h).exp();
    let efforts = |row: usize| {
        let at = |signal| task.recording.channel(signal).map_or(0.0, |values| values[row]);
        (at(Signal::DisturbanceMotor), at(Signal::DisturbanceLoad))
    };
    let window = rules.window.unwrap_or(0.0).max(RESOLUTIONS * rules.resolution());
    // The response of an FMU to the load's motion does not explain that motion.
    let steps = disturbed(task.recording, rules);
    let mut reasons = Vec::new();
    for phase in standing {
        let place = rows.request[phase.rows.start];
        let is_told = rows.request[phase.rows.clone()].iter().all(|x| x.to_bits() == place.to_bits());
        let place = if is_told { place } else { rows.load[phase.rows.start] };
        let braking = speed(&rows.load[phase.rows.clone()], rows.h) / servo.slowest_rate();
        let mut last = efforts(phase.rows.start);
        let mut steps = steps.iter().skip_while(|step| step.end <= phase.rows.start).peekable();
        let (mut time, mut decay) = (0.0, 1.0);
        for row in phase.rows.clone() {
            let (on_motor, on_load) = if task.disturbance > 0.0 { efforts(row) } else { (0.0, 0.0) };
            let effort = |(motor, load): (f64, f64)| motor.abs() + rules.transmission.abs() * load.abs();
            if steps.peek().is_some_and(|step| step.start <= row) {
                (last, time, decay) = ((on_motor, on_load), 0.0, 1.0);
                steps.next_if(|step| step.end <= row + 1);
            }
            let elastic = deflection.elastic + deflection.elastic_per_effort * on_load.abs();
            let explained = TIMES * (deflection.explained(effort(last).max(effort((on_motor, on_load)))) + elastic);
            // Three real poles at most: position, velocity and its integral.
            let passed = sigma * time;
            let fading = explained * ((1.0 + passed + passed * passed / 2.0) * decay).max(LEFT);
            let bound = if deflection.has_integral { window.max(fading) } else { fading.max(window + explained) }
                + STICK * (deflection.stick + elastic)
                + INITIAL * (deflection.initial + braking);
            let off = (rows.load[row] - place).abs();
            if off.is_nan() || off > bound {
                reasons.push(format!(
                    "the load is {} from its rest position at {}: more than {}{}",
                    task.length(off),
                    task.time(row),
                    task.length(bound),
                    task.bound_by(&(row..phase.rows.end))
                ));
                break;
            }
            time += rows.h;
            decay *= kept;
        }
    }
    Some(reasons)
}

/// |Velocity| at the first of `positions`, a row of `h` (s) apart: homing and a sag before power leave one.
fn speed(positions: &[f64], h: f64) -> f64 {
    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "rows of a millisecond")]
    let rows = ((FIRST / h) as usize).clamp(1, positions.len().saturating_sub(1).max(1));
    match (positions.first(), positions.get(rows)) {
        (Some(first), Some(later)) => (later - first).abs() / (rows as f64 * h),
        _ => 0.0,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::requirement::rules::Disturbance;
    use crate::requirement::tests::rules;
    use crate::requirement::{Deflection, Poles, Rules, Servo};
    use crate::synthetic::Build;

    const SERVO: Servo = Servo {
        gain: 50.0,
        position_integral_time: None,
        velocity_feedforward: 0.0,
        bandwidth: 250.0,
        reference_weight: 1.0,
        integral_time: Some(0.02),
        inertia_feedforward: 0.0,
        viscous: 0.0,
        viscous_feedforward: 0.0,
        is_closed_at_the_load: false,
    };

    /// Two seconds at 1 kHz, with a force on the load from 1 s on.
    fn found(rules: &Rules<'_>, force: f64, load: impl Fn(f64) -> f64) -> usize {
        let recording = Build::new(1000, 2001)
            .channel(Signal::RequestPosition, "m", |_| 0.0)
            .channel(Signal::RequestVelocity, "m/s", |_| 0.0)
            .channel(Signal::LoadPosition, "m", load)
            .channel(Signal::DisturbanceLoad, "N", |t| if t < 1.0 { 0.0 } else { force })
            .requests(&[(0.0, "stand")])
            .finish();
        let step = Disturbance { start: 1.0, end: f64::INFINITY, effort: force, frequency: None };
        let rules = Rules { disturbances: if force == 0.0 { Vec::new() } else { vec![step] }, ..rules.clone() };
        broken(&Task::of(&recording, &rules, &[])).unwrap().len()
    }

    /// The force of an FMU is in the same channel.
    #[test]
    fn a_force_that_nobody_orders_does_not_explain_that_the_load_moves() {
        let deflection = Deflection { per_effort: 1e-5, ..Deflection::default() };
        let poles = Some(Poles { oscillating: None, slowest_real: Some(20.0) });
        let rules = Rules { servo: Some(SERVO), deflection, poles, window: Some(1e-5), ..rules() };
        let load = |t: f64| if t < 1.0 { 0.0 } else { 2.9e-3 * (-20.0 * (t - 1.0)).exp() };
        assert_eq!(found(&rules, 100.0, load), 0);
        let recording = Build::new(1000, 2001)
            .channel(Signal::RequestPosition, "m", |_| 0.0)
            .channel(Signal::RequestVelocity, "m/s", |_| 0.0)
            .channel(Signal::LoadPosition, "m", load)
            .channel(Signal::DisturbanceLoad, "N", |t| if t < 1.0 { 0.0 } else { 100.0 })
            .requests(&[(0.0, "stand")])
            .finish();
        assert_eq!(broken(&Task::of(&recording, &rules, &[])).unwrap().len(), 1);
    }

    /// Homing ends while the load still moves to where its drive has stopped: 5 mm/s at 50 1/s are 0.1 mm.
    #[test]
    fn a_load_that_moves_at_the_beginning_is_braked() {
        let rules = Rules { servo: Some(SERVO), window: Some(1e-6), ..rules() };
        let brakes = |way: f64, rate: f64| move |t: f64| way * (1.0 - (-rate * t).exp());
        assert_eq!(found(&rules, 0.0, brakes(1e-4, 50.0)), 0);
        assert_eq!(found(&rules, 0.0, brakes(5e-4, 10.0)), 1, "too late");
        assert_eq!(found(&rules, 0.0, |t| 5e-3 * t), 1, "it goes on");
    }

    /// Oracle: 100 N at 1e-5 m/N are 1 mm, of which three times are allowed, fading with 20 1/s.
    #[test]
    fn an_axis_with_an_integral_comes_back() {
        let deflection = Deflection { effort: 100.0, per_effort: 1e-5, ..Deflection::default() };
        let poles = Some(Poles { oscillating: None, slowest_real: Some(20.0) });
        let rules = Rules { servo: Some(SERVO), deflection, poles, window: Some(1e-5), ..rules() };
        let sags = |size: f64, sigma: f64| move |t: f64| -size * (1.0 + sigma * t) * (-sigma * t).exp();
        assert_eq!(found(&rules, 0.0, sags(2.9e-3, 20.0)), 0);
        assert_eq!(found(&rules, 0.0, sags(3.1e-3, 20.0)), 1);
        assert_eq!(found(&rules, 0.0, sags(2.9e-3, 10.0)), 1, "it comes back too late");
        assert_eq!(found(&rules, 0.0, |t| -9.81 / 2.0 * t * t), 1, "it falls");
        let again = |t: f64| if t < 1.0 { 0.0 } else { sags(5.8e-3, 20.0)(t - 1.0) };
        assert_eq!(found(&rules, 100.0, again), 0);
        assert_eq!(found(&rules, 0.0, again), 1);
    }

    #[test]
    fn an_axis_without_an_integral_stays_where_its_load_draws_it() {
        let deflection = Deflection { effort: 100.0, per_effort: 1e-5, has_integral: false, ..Deflection::default() };
        let rules = Rules { servo: Some(SERVO), deflection, window: Some(1e-5), ..rules() };
        assert_eq!(found(&rules, 0.0, |_| -3e-3), 0);
        assert_eq!(found(&rules, 0.0, |_| -3.1e-3), 1);
        let weak = Rules { deflection: Deflection { max_effort: 10.0, ..deflection }, ..rules.clone() };
        assert_eq!(found(&weak, 0.0, |_| -4e-4), 1, "what the drive cannot hold explains nothing");
    }

    #[test]
    fn what_moves_or_is_not_held_does_not_stand() {
        let recording = |kind| {
            Build::new(1000, 101)
                .channel(Signal::RequestPosition, "m", |_| 0.0)
                .channel(Signal::RequestVelocity, "m/s", |_| 0.0)
                .channel(Signal::LoadPosition, "m", |t| t)
                .requests(&[(0.0, kind)])
                .finish()
        };
        let rules = Rules { servo: Some(SERVO), ..rules() };
        for (kind, is_asked) in [("stand", true), ("follow", false), ("nothing", false), ("velocity", false)] {
            assert_eq!(broken(&Task::of(&recording(kind), &rules, &[])).is_some(), is_asked, "{kind}");
        }
    }
}
