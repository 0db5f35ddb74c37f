//! The generator block against the paper's equations, written down here a second time.
#![expect(clippy::float_cmp, reason = "what ends on a target ends exactly there")]
use servobench_motion::{Limits, Order, Profile, Times};
use servobench_plcopen::generator::{Input, Method, Mounting, Output, Params, State, step};

const LIMITS: Limits = Limits { velocity: 1.0, acceleration: 5.0, jerk: 50.0, snap: 1000.0 };
const TS: f64 = 1e-3;
const SETTLING: f64 = 0.02;

fn params() -> Params {
    Params::new(TS, SETTLING).unwrap()
}

fn input(reference: f64) -> Input {
    Input {
        method: Method::Step,
        order: Order::Fourth,
        reference,
        limits: LIMITS,
        enable: false,
        actual_reference: 0.0,
        mounting: Mounting::Same,
    }
}

/// Outputs from the edge of enable, which lasts one sample, until done.
fn outputs(params: &Params, input: &Input) -> Vec<Output> {
    let mut state = State::default();
    let mut outputs = vec![step(params, &mut state, &Input { enable: true, ..*input })];
    while !outputs.last().is_some_and(|last| last.done) {
        outputs.push(step(params, &mut state, input));
        assert!(outputs.len() < 100_000);
    }
    outputs
}

/// (52)–(53), (57)–(63) in seconds, as printed; the last row is `t_final`, (54).
fn snap(times: &Times, amplitude: f64, t_exec: f64) -> (f64, f64) {
    const SWITCHING: [[f64; 4]; 16] = [
        [0., 0., 0., 0.],
        [1., 0., 0., 0.],
        [1., 1., 0., 0.],
        [2., 1., 0., 0.],
        [2., 1., 1., 0.],
        [3., 1., 1., 0.],
        [3., 2., 1., 0.],
        [4., 2., 1., 0.],
        [4., 2., 1., 1.],
        [5., 2., 1., 1.],
        [5., 3., 1., 1.],
        [6., 3., 1., 1.],
        [6., 3., 2., 1.],
        [7., 3., 2., 1.],
        [7., 4., 2., 1.],
        [8., 4., 2., 1.],
    ];
    const SIGNS: [f64; 16] = [1., -1., -1., 1., -1., 1., 1., -1., -1., 1., 1., -1., 1., -1., -1., 1.];
    let dwells = [times.t_d.unwrap(), times.t_j.unwrap(), times.t_a, times.t_v];
    let at = |row: &[f64; 4]| row.iter().zip(dwells).map(|(factor, time)| factor * time).sum::<f64>();
    let sum = SWITCHING.iter().zip(SIGNS).map(|(row, sign)| if t_exec > at(row) { sign * amplitude } else { 0.0 });
    (sum.sum(), at(&SWITCHING[15]))
}

/// Short and long moves, each limit binding in one of them.
const DISTANCES: [f64; 6] = [1.0, -0.3, 0.02, 1e-3, -1e-5, 4.0];

#[test]
fn the_snap_is_that_of_equations_62_and_63() {
    for distance in DISTANCES {
        let plan = Profile::plan_sampled(Order::Fourth, distance, &LIMITS, TS).unwrap();
        let (times, amplitude) = (plan.times().unwrap(), plan.segments().next().unwrap().value);
        for (k, output) in outputs(&params(), &input(distance)).iter().enumerate().skip(1) {
            // Start is in sample 1, where t_exec = −Ts/2.
            let t_exec = (k as f64 - 1.5) * TS;
            let (expected, _) = snap(&times, amplitude, t_exec);
            assert_eq!(output.set_point.s.to_bits(), (expected + 0.0).to_bits(), "{distance} m, sample {k}");
        }
    }
}

/// Oracle: (72)–(75) added up. Their rounding is that of as many sums as samples, at most 5e3: 1e-12 of the values.
#[test]
fn the_rest_is_its_sum_and_the_position_ends_on_the_target() {
    for distance in DISTANCES {
        let start = 0.25;
        let outputs = outputs(&params(), &Input { actual_reference: start, ..input(start + distance) });
        let [mut x, mut v, mut a, mut j] = [start, 0.0, 0.0, 0.0];
        for output in &outputs {
            let is = output.set_point;
            for (expected, found, bound) in [(x, is.x, 5.0), (v, is.v, 1.0), (a, is.a, 5.0), (j, is.j, 50.0)] {
                assert!((expected - found).abs() < 1e-11 * bound, "{distance} m: {expected} {found}");
            }
            assert!(is.v.abs() <= LIMITS.velocity * (1.0 + 1e-12) && is.a.abs() <= LIMITS.acceleration * (1.0 + 1e-12));
            assert!(is.j.abs() <= LIMITS.jerk * (1.0 + 1e-12) && is.s.abs() <= LIMITS.snap * (1.0 + 1e-12));
            (x, v, a, j) = (x + TS * v, v + TS * a, a + TS * j, j + TS * is.s);
        }
        let last = outputs.last().unwrap();
        assert!((last.set_point.x - (start + distance)).abs() < 1e-12, "{:?}", last.set_point);
        assert_eq!([last.set_point.v, last.set_point.a, last.set_point.j, last.set_point.s], [0.0; 4]);
        // The last step to it is one of the cascade, not a jump: Ts⁴·snap, as all derivatives but that are zero after it.
        let near = outputs.iter().rev().find(|output| output.set_point.s != 0.0).unwrap();
        assert!((near.set_point.x - last.set_point.x).abs() <= LIMITS.snap * TS.powi(4) + 1e-12, "{distance} m");
    }
}

/// The table of the module: enable in sample 0, start in 1, the first pulse in 2; ready when more than `t_final` and `T_set` of
/// execution time are over.
#[test]
fn starts_and_becomes_ready_in_the_samples_that_the_equations_say() {
    let outputs = outputs(&params(), &input(1.0));
    let plan = Profile::plan_sampled(Order::Fourth, 1.0, &LIMITS, TS).unwrap();
    let (_, t_final) = snap(&plan.times().unwrap(), 1.0, 0.0);
    assert!((t_final - 1.35).abs() < 1e-12);
    assert!(outputs[0].ready && !outputs[0].done && outputs[0].added == 0.0);
    assert!(!outputs[1].ready && outputs[1].added == 1.0);
    assert_eq!([outputs[0].set_point.s, outputs[1].set_point.s, outputs[2].set_point.s], [0.0, 0.0, 1000.0]);
    // t_exec = (k − 1.5)·Ts in sample k.
    let first = outputs.iter().enumerate().position(|(k, output)| k > 0 && output.ready).unwrap();
    assert!((first as f64 - 1.5) * TS > t_final + SETTLING && (first as f64 - 2.5) * TS < t_final + SETTLING);
    assert_eq!((first, outputs.len() - 1), (1372, 1372));
}

#[test]
fn a_pulse_starts_one_move_and_an_enable_that_stays_starts_again() {
    let (params, mut state) = (params(), State::default());
    let mut enabled = Input { enable: true, ..input(0.01) };
    let mut last = Output::default();
    let mut run = |state: &mut State, enabled: &mut Input, samples: u32| {
        for _ in 0..samples {
            last = step(&params, state, enabled);
            enabled.actual_reference = last.set_point.x;
        }
        last
    };
    assert_eq!(run(&mut state, &mut enabled, 400).set_point.x, 0.01);
    // Each start is from the present reference: nothing is left to do until the reference changes.
    enabled.reference = 0.03;
    let end = run(&mut state, &mut enabled, 800);
    assert!((end.set_point.x - 0.03).abs() < 1e-12 && end.added.abs() < 1e-12);
    // During a move an edge has no effect.
    let mut state = State::default();
    let mut pulsed = input(0.01);
    for k in 0..600 {
        pulsed.enable = k % 3 == 0 && k < 60;
        pulsed.reference = if k < 30 { 0.01 } else { 0.5 };
        let output = step(&params, &mut state, &pulsed);
        assert!(output.set_point.x <= 0.01 && output.error.is_none(), "{k}");
    }
    assert_eq!(step(&params, &mut state, &pulsed).set_point.x, 0.01);
}

#[test]
fn what_is_planned_is_what_the_inputs_are_at_the_start() {
    let (params, mut state) = (params(), State::default());
    step(&params, &mut state, &Input { enable: true, ..input(5.0) });
    // Start is one sample after the edge.
    let started = step(&params, &mut state, &input(0.5));
    assert_eq!(started.added, 0.5);
    for _ in 0..3000 {
        step(&params, &mut state, &Input { limits: Limits { velocity: -1.0, ..LIMITS }, ..input(7.0) });
    }
    assert_eq!(step(&params, &mut state, &input(7.0)).set_point.x, 0.5);
}

#[test]
fn a_motor_mounted_the_other_way_gets_the_mirror_image() {
    let same = outputs(&params(), &input(0.4));
    let opposite = outputs(&params(), &Input { mounting: Mounting::Opposite, ..input(0.4) });
    assert_eq!(same.len(), opposite.len());
    for (one, other) in same.iter().zip(&opposite) {
        assert_eq!(one.set_point.scaled(-1.0), other.set_point);
        assert_eq!(one.added, -other.added);
    }
}

#[test]
fn a_move_that_cannot_be_planned_is_refused_and_the_next_one_is_not() {
    let (params, mut state) = (params(), State::default());
    let wrong = Input { limits: Limits { snap: 0.0, ..LIMITS }, ..input(1.0) };
    step(&params, &mut state, &Input { enable: true, ..wrong });
    let refused = step(&params, &mut state, &wrong);
    assert_eq!(refused.error.unwrap().to_string(), "`snap` must be finite and positive, got 0");
    assert!(refused.ready && !refused.done && refused.set_point.x == 0.0);
    step(&params, &mut state, &Input { enable: true, ..input(1.0) });
    let accepted = step(&params, &mut state, &input(1.0));
    assert!(accepted.error.is_none() && !accepted.ready);
    // ssMethodType = 0 sets the block back, on the way too.
    for _ in 0..500 {
        step(&params, &mut state, &input(1.0));
    }
    let initial = step(&params, &mut state, &Input { method: Method::Initialize, actual_reference: 3.0, ..input(1.0) });
    assert!(initial.ready && !initial.done && initial.set_point.x == 3.0);
    assert_eq!(step(&params, &mut state, &input(1.0)).set_point.x, 3.0);
}

#[test]
fn times_are_checked() {
    assert!(Params::new(1e-3, 0.0).is_ok());
    let refused = Params::new(0.0, 0.1).unwrap_err();
    assert_eq!(refused.to_string(), "`sample_time` must be finite and positive, got 0");
    assert!(Params::new(1e-3, -0.1).is_err());
}

/// Oracle: (72)–(75) from the derivative that is switched downwards, added up; the plan of the order. Rounding as above.
#[test]
fn lower_orders_switch_a_lower_derivative_and_land_too() {
    for (order, last) in [(Order::Second, 2), (Order::Third, 3)] {
        for distance in DISTANCES {
            let unused = Limits { snap: f64::NAN, jerk: if last == 2 { -1.0 } else { LIMITS.jerk }, ..LIMITS };
            let outputs = outputs(&params(), &Input { order, limits: unused, ..input(distance) });
            let plan = Profile::plan_sampled(order, distance, &LIMITS, TS).unwrap();
            let samples = usize::try_from(plan.samples().unwrap().total()).unwrap();
            assert_eq!(outputs.len(), samples + 2 + 21, "{distance} m, order {last}");
            let mut sums = [0.0; 4];
            for output in &outputs {
                let is = output.set_point;
                let [x, v, a, j] = [is.x, is.v, is.a, is.j];
                assert!(is.s == 0.0 && (last == 3 || j == 0.0));
                // The switched derivative is an output; those below it are its sums.
                sums[last] = [x, v, a, j][last];
                for (k, found) in [x, v, a].into_iter().enumerate().take(last) {
                    let bound = [5.0, 1.0, 5.0][k];
                    assert!((found - sums[k]).abs() < 1e-11 * bound, "{distance} m, order {last}: {found} {}", sums[k]);
                }
                assert!(v.abs() <= LIMITS.velocity * (1.0 + 1e-12) && a.abs() <= LIMITS.acceleration * (1.0 + 1e-12));
                assert!(last == 2 || j.abs() <= LIMITS.jerk * (1.0 + 1e-12));
                for k in 0..last {
                    sums[k] += TS * sums[k + 1];
                }
            }
            assert_eq!(outputs.last().unwrap().set_point.x, distance);
        }
    }
}
