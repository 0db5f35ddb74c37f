use super::*;
use core::f64::consts::TAU;

const NONE: Motion = Motion { velocity: 0.0, dc_link: 320.0, winding: 20.0, is_cut: false };
const H: f64 = 1.0 / 8e3;
const FAST: f64 = 1e4;

fn of_motion(p: &Params, u: Motion) -> Option<Finding> {
    let mut x = State::default();
    watch_motion(p, &mut x, &u, H);
    x.found
}

#[test]
fn link_and_speed_have_their_thresholds() {
    let p = Params { undervoltage: Some(211.0), overvoltage: Some(391.0), overspeed: Some(97.0), ..Params::default() };
    for (dc_link, velocity, found) in [
        (391.0, 97.0, None),
        (211.0, -97.0, None),
        (391.1, 0.0, Some(Finding::OverVoltage)),
        (210.9, 0.0, Some(Finding::UnderVoltage)),
        (0.0, 0.0, Some(Finding::UnderVoltage)),
        (300.0, -97.1, Some(Finding::OverSpeed)),
    ] {
        assert_eq!(of_motion(&p, Motion { velocity, dc_link, ..NONE }), found, "{dc_link} V, {velocity} rad/s");
        assert_eq!(of_motion(&Params::default(), Motion { velocity, dc_link, ..NONE }), None, "off");
    }
}

#[test]
fn winding_and_current_have_their_thresholds() {
    let p = Params { winding_temperature: Some(130.0), overcurrent: Some(20.0), ..Params::default() };
    for (winding, found) in [(130.0, None), (130.1, Some(Finding::OverTemperature)), (-40.0, None)] {
        assert_eq!(of_motion(&p, Motion { winding, ..NONE }), found, "{winding} °C");
    }
    for (alpha, beta, found) in [
        (20.0, 0.0, None),
        (-20.1, 0.0, Some(Finding::OverCurrent)),
        (0.0, 23.0, None),
        (0.0, -23.2, Some(Finding::OverCurrent)),
    ] {
        let (mut x, measured) = (State::default(), AlphaBeta { alpha, beta });
        let u = Currents { velocity: 0.0, q: 0.0, reference: AlphaBeta::default(), bandwidth: FAST, measured };
        watch_currents(&p, &mut x, &u, H);
        assert_eq!(x.found, found, "{alpha} A, {beta} A");
    }
}

/// Oracle: 17 ms are 136 cycles, the finding comes at the 136th, and a cycle with motion restarts the count.
#[test]
fn a_stall_has_to_last() {
    let p = Params { stall: Some(Stall { speed: 0.3, time: 17e-3 }), ..Params::default() };
    let mut x = State::default();
    let stands = Motion { velocity: -0.3, is_cut: true, ..NONE };
    let count = |x: &mut State, of: Motion| {
        (1..=1000).find(|_| {
            watch_motion(&p, x, &of, H);
            x.found.is_some()
        })
    };
    for _ in 0..135 {
        watch_motion(&p, &mut x, &stands, H);
    }
    watch_motion(&p, &mut x, &Motion { velocity: 0.31, ..stands }, H);
    assert_eq!((count(&mut x, stands), x.found), (Some(136), Some(Finding::Stall)));
    assert_eq!(count(&mut State::default(), Motion { is_cut: false, ..stands }), None, "it may stand");
    assert_eq!(count(&mut State::default(), Motion { velocity: 5.0, ..stands }), None, "it may be at the limit");
}

fn commutation(way: impl Iterator<Item = (f64, f64)>) -> Option<usize> {
    let p = Params { commutation: Some(Commutation { speed: 20.0, current: 4.0 }), ..Params::default() };
    let mut x = State::default();
    for (at, (velocity, q)) in way.enumerate() {
        let u = Currents {
            velocity,
            q,
            reference: AlphaBeta::default(),
            bandwidth: FAST,
            measured: AlphaBeta { alpha: q, beta: 0.0 },
        };
        watch_currents(&p, &mut x, &u, H);
        if x.found.is_some() {
            return Some(at);
        }
    }
    None
}

/// Accelerating, braking, reversing, or being driven under a current below the threshold is not a fault; running away is.
#[test]
fn speed_gained_against_the_current_is_a_fault() {
    let line = |from: f64, step: f64, q: f64| (0..200).map(move |k| (from + step * f64::from(k), q));
    assert_eq!(commutation(line(0.0, 1.0, 9.0)), None, "accelerates");
    assert_eq!(commutation(line(150.0, -1.0, -9.0)), None, "brakes and turns round");
    assert_eq!(commutation(line(0.0, 1.0, -3.9)), None, "friction or weight, at a small current");
    // From rest, the cycle at -1 rad/s is the first against the current: 20 more.
    assert_eq!(commutation(line(0.0, -1.0, 9.0)), Some(21), "runs away");
    assert_eq!(commutation(line(70.0, 0.5, -4.0)), Some(40));
    // Braking down to 30 first, and then faster again.
    let way = (0..41).map(|k| 70.0 - f64::from(k)).chain((0..100).map(|k| 30.0 + f64::from(k)));
    assert_eq!(commutation(way.map(|v| (v, -8.0))), Some(41 + 20));
}

/// A trapped motor gains 13 rad/s and loses them again in each swing; a braking one driven by a spring loses more than it gains.
#[test]
fn speed_gained_in_swings_is_a_fault() {
    let swing = |mean: f64, slope: f64, size: f64| {
        (0..8000).map(move |k| {
            let t = H * f64::from(k);
            ((mean - slope * t + size * (TAU * 15.0 * t).sin()).max(0.1), -9.0)
        })
    };
    assert!(commutation(swing(14.0, 0.0, 6.5)).is_some_and(|cycles| cycles < 2000), "trapped");
    assert_eq!(commutation(swing(14.0, 0.0, 2.4)), None, "each less than a quarter");
    assert_eq!(commutation(swing(900.0, 900.0, 9.5)), None, "brakes, on a spring");
}

/// Cycles until a lost phase is found, for a reference of `length` (A) that advances by `turn` turns per cycle, with the current that the
/// motor makes of it.
fn phases(length: f64, turn: f64, made: fn(AlphaBeta) -> AlphaBeta) -> Option<u32> {
    let p = Params { phases: Some(Phases { current: 1.3, time: 10e-3 }), ..Params::default() };
    let mut x = State::default();
    (0..4000).find(|k| {
        let (sin, cos) = (TAU * (turn * f64::from(*k) + 0.01)).sin_cos();
        let reference = AlphaBeta { alpha: length * cos, beta: length * sin };
        let measured = made(reference);
        watch_currents(&p, &mut x, &Currents { velocity: 0.0, q: length, reference, bandwidth: FAST, measured }, H);
        x.found == Some(Finding::LostPhase)
    })
}

/// Oracle: 80 cycles with a reference of 1.3 A or more in that leg; at 5 A the reference is that large for 1 − 2·asin(1.3/5)/π of a turn.
#[test]
fn a_leg_without_the_current_that_it_is_to_have_is_a_lost_phase() {
    for turn in [0.0, 1.0 / 731.0, -1.0 / 97.3, 0.031] {
        assert_eq!(phases(5.0, turn, |i| i), None, "healthy at {turn}");
        let lagging = |AlphaBeta { alpha, beta }| AlphaBeta { alpha: 0.8 * alpha + 0.3 * beta, beta: 0.7 * beta };
        assert_eq!(phases(5.0, turn, lagging), None, "lagging at {turn}");
    }
    let without_a = |AlphaBeta { beta, .. }| AlphaBeta { alpha: 0.0, beta };
    for turn in [1.0 / 97.3, 0.031] {
        let share = 1.0 - 2.0 / core::f64::consts::PI * (1.3_f64 / 5.0).asin();
        let found = f64::from(phases(5.0, turn, without_a).unwrap());
        // At most the duration of a zero crossing, earlier or later.
        assert!((found - 80.0 / share).abs() < (1.0 - share) / turn + 2.0, "{turn}: {found}");
    }
    assert_eq!(phases(1.29, 0.01, |_| AlphaBeta::default()), None, "less than what counts");
    assert_eq!(phases(5.0, 0.0, without_a), Some(79), "at rest, where it is to have some");
    let without_c = |AlphaBeta { alpha, .. }| AlphaBeta { alpha, beta: alpha / 3.0_f64.sqrt() };
    assert!(phases(5.0, 1.0 / 97.3, without_c).is_some());
}

/// An increment of a coarse encoder to and fro demands 5 A up and down in turn, which no loop can follow; the mean flows.
#[test]
fn a_reference_to_and_fro_is_not_a_lost_phase() {
    let found = |mean: f64, flows: f64| {
        let p = Params { phases: Some(Phases { current: 1.3, time: 10e-3 }), ..Params::default() };
        let mut x = State::default();
        for k in 0..4000 {
            let alpha = mean + if k % 2 == 0 { 5.0 } else { -5.0 };
            let (reference, measured) = (AlphaBeta { alpha, beta: 0.0 }, AlphaBeta { alpha: flows, beta: 0.0 });
            watch_currents(&p, &mut x, &Currents { velocity: 0.0, q: 0.0, reference, bandwidth: 2e3, measured }, H);
        }
        x.found
    };
    assert_eq!(found(0.3, 0.3), None);
    assert_eq!(found(2.0, 2.0), None);
    assert_eq!(found(2.0, 0.0), Some(Finding::LostPhase));
}

#[test]
fn errors_name_the_parameter() {
    let said = |p: Params| p.check().unwrap_err().to_string();
    assert_eq!(Params::default().check(), Ok(()));
    let wrong = Params { undervoltage: Some(0.0), ..Params::default() };
    assert_eq!(said(wrong), "`under-voltage threshold` must be finite and positive, got 0");
    let wrong = Params { phases: Some(Phases { current: 1.0, time: f64::NAN }), ..Params::default() };
    assert_eq!(said(wrong), "`time of a lost phase` must be finite and positive, got NaN");
}
