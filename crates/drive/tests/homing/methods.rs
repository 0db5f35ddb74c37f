//! Every method from every side of its switch.
use crate::axis::{Axis, ENDS, INCREMENT, Machine, PERIOD, Seen, idle, start};
use crate::published::{self, Fine, LimitSwitch, Main};
use servobench_drive::modes::homing::{Failure, Method, Params, Switch, UnknownMethod};

const SWITCH_SPEED: f64 = 0.1;
const ZERO_SPEED: f64 = 0.01;

pub(crate) fn params(number: i8) -> Params {
    Params {
        method: Method::from_number(number).unwrap(),
        switch_speed: SWITCH_SPEED,
        zero_speed: ZERO_SPEED,
        acceleration: 1.0,
        jerk: Some(200.0),
        home_offset: 0.5,
    }
}

/// Longer than the longest search: all of the axis at the speed for zero.
const LONGEST: usize = 1_000_000;

/// Steps until homing has ended, and the axis afterwards.
fn home(machine: &Machine, params: Params, at: f64) -> (Vec<Seen>, Axis<'_>) {
    let mut axis = Axis::new(machine, params, at);
    let before = axis.step(idle());
    assert!(before.output.answer.target_reached && !before.output.answer.bit_12, "{before:?}");
    let mut seen = Vec::new();
    for _ in 0..LONGEST {
        seen.push(axis.step(start()));
        let answer = seen[seen.len() - 1].output.answer;
        if answer.target_reached && (answer.bit_12 || answer.bit_13) {
            return (seen, axis);
        }
    }
    panic!("{params:?} from {at} is still looking");
}

/// The machine for a row of the table, and the edge that the row names.
fn machine(main: Main, width: f64) -> (Machine, f64) {
    let cam = Machine::with_home(0.2..=0.2 + width);
    match main {
        Main::NegativeLimit => (cam, ENDS.0),
        Main::PositiveLimit => (cam, ENDS.1),
        Main::PositiveHome => (Machine::with_home(0.2..=9.0), 0.2),
        Main::NegativeHome => (Machine::with_home(-9.0..=0.2), 0.2),
        Main::LeftEdge => (cam, 0.2),
        Main::RightEdge => (cam, 0.2 + width),
    }
}

/// Index of a switch in the result of [`Machine::switches`].
fn signal(main: Main) -> usize {
    match main {
        Main::NegativeLimit => 0,
        Main::PositiveLimit => 1,
        _ => 2,
    }
}

fn check(row: (i8, Main, Fine, LimitSwitch), width: f64, at: f64, jerk: Option<f64>) {
    let (number, main, fine, limit_switch) = row;
    let (machine, edge) = machine(main, width);
    let params = Params { jerk, ..params(number) };
    let (seen, axis) = home(&machine, params, at);
    let case = format!("method {number} from {at}, switch {width} wide, jerk {jerk:?}");
    assert!(axis.state.is_homed(), "{case}: {:?}", axis.state);

    // The reference: that of the table, at the home offset.
    let reference = params.home_offset - axis.shift;
    let found = seen.iter().position(|seen| seen.output.answer.bit_12).unwrap();
    let (from, to) = (seen[found - 1].at, seen[found].at);
    let signal = signal(main);
    let edges = (machine.switches(from.x)[signal], machine.switches(to.x)[signal]);
    match fine {
        Fine::PulseLeft => assert_near(reference, machine.pulse_left_of(edge), 1e-12, &case),
        Fine::PulseRight => assert_near(reference, machine.pulse_right_of(edge), 1e-12, &case),
        Fine::Falling | Fine::Rising => {
            assert_eq!(edges, if fine == Fine::Rising { (false, true) } else { (true, false) }, "{case}");
            // Seen at the first step behind the edge.
            assert_near(reference, edge, ZERO_SPEED * PERIOD * (1.0 + 1e-9), &case);
        }
    }

    // Speeds: the speed for switches is reached and not exceeded before the first edge; the reference is passed at the speed for zero.
    let peak = seen.iter().map(|seen| seen.demanded.v.abs()).fold(0.0, f64::max);
    assert!(peak <= SWITCH_SPEED * (1.0 + 1e-12), "{case}: {peak}");
    // The distance in which the axis reaches the speed for switches.
    let room = SWITCH_SPEED * SWITCH_SPEED / 2.0 + SWITCH_SPEED / 50.0;
    let meets = |k: &usize| machine.switches(seen[k - 1].at.x)[signal] != machine.switches(seen[*k].at.x)[signal];
    let passed = to.v.abs();
    assert!(passed <= ZERO_SPEED * (1.0 + 1e-12), "{case}: {passed}");
    if (at - edge).abs() > room {
        assert_near(passed, ZERO_SPEED, 1e-12, &case);
    }
    let first = (1..found).find(meets).map(|k| seen[k].at);
    if let Some(first) = first.filter(|first| (first.x - at).abs() > room && at.abs() < 1.0) {
        assert_near(first.v.abs(), SWITCH_SPEED, 1e-12, &case);
    }

    // Limit switches: only the one named in the table reverses the axis.
    let lowest = seen.iter().map(|seen| seen.at.x).fold(at, f64::min);
    let highest = seen.iter().map(|seen| seen.at.x).fold(at, f64::max);
    let may = (
        main == Main::NegativeLimit || limit_switch == LimitSwitch::Left || at <= ENDS.0,
        main == Main::PositiveLimit || limit_switch == LimitSwitch::Right || at >= ENDS.1,
    );
    assert!((lowest > ENDS.0 || may.0) && (highest < ENDS.1 || may.1), "{case}: {lowest} to {highest}");

    // At rest, in the coordinate of the reference.
    assert_eq!((axis.demanded.v, axis.demanded.a), (0.0, 0.0), "{case}");
}

fn assert_near(one: f64, other: f64, tolerance: f64, case: &str) {
    assert!((one - other).abs() <= tolerance, "{case}: {one} is not {other}");
}

/// Left of the switch, on each of its edges, on it, right of it, on index pulses, at the ends of the axis.
const STARTS: [f64; 13] = [-1.03, -1.0, -0.9, -0.563, 0.1, 0.137, 0.2, 0.237, 0.25, 0.3, 0.5, 1.0, 1.03];

#[test]
fn every_method_finds_what_the_published_table_names_from_every_side() {
    for row in published::TABLE {
        for at in STARTS {
            for jerk in [None, Some(200.0)] {
                check(row, 0.1, at, jerk);
            }
        }
    }
}

/// The axis runs past both edges before it has reversed: 5 mm and more at 0.1 m/s and 1 m/s².
#[test]
fn a_switch_that_is_narrower_than_the_reversal_is_found_by_the_same_edge() {
    for row in published::TABLE {
        for at in [-0.9, -0.1, 0.2005, 0.21, 0.9] {
            check(row, 0.001, at, Some(200.0));
        }
    }
}

/// A lagging axis still moves on when the demand reverses: an edge passed then is passed in the wrong direction. The width of the switch
/// decides if it is the far edge.
#[test]
fn an_axis_that_lags_behind_finds_the_same_edge() {
    for (number, main, fine, _) in published::TABLE {
        for width in [0.006, 0.0065, 0.007, 0.0075, 0.008, 0.0085] {
            let (machine, edge) = machine(main, width);
            let expected = match fine {
                Fine::PulseLeft => machine.pulse_left_of(edge),
                Fine::PulseRight => machine.pulse_right_of(edge),
                Fine::Falling | Fine::Rising => edge,
            };
            let at = 0.2 - 0.04 * f64::from(number % 2) + 0.05 * f64::from(number % 3);
            let mut axis = Axis::new(&machine, params(number), at);
            axis.lag = 0.03;
            axis.step(idle());
            let homed = (0..LONGEST).find(|_| axis.step(start()).output.shift.is_some());
            let case = format!("method {number} from {at}, switch {width} wide");
            assert!(homed.is_some(), "{case}: {:?}", axis.state);
            // A step at the speed for zero, and an increment of the encoder.
            assert_near(0.5 - axis.shift, expected, ZERO_SPEED * PERIOD + INCREMENT, &case);
        }
    }
}

#[test]
fn index_methods_find_the_next_pulse_in_their_direction() {
    let machine = Machine::with_home(0.2..=0.3);
    // On pulses too, which do not count.
    for at in [-0.9, machine.pulses[3], -0.56, machine.pulses[13], 0.25] {
        for (number, expected) in [(33, machine.pulse_left_of(at)), (34, machine.pulse_right_of(at))] {
            let (seen, axis) = home(&machine, params(number), at);
            assert_near(0.5 - axis.shift, expected, 1e-12, &format!("method {number} from {at}"));
            let peak = seen.iter().map(|seen| seen.demanded.v.abs()).fold(0.0, f64::max);
            assert_near(peak, ZERO_SPEED, 1e-12, "the speed during search for zero");
        }
        for number in [35, 37] {
            let (seen, axis) = home(&machine, params(number), at);
            assert_eq!(seen.len(), 1, "method {number} homes where it is");
            // Rounded twice: the shift, and what it is added to.
            assert_near(axis.demanded.x + axis.shift, 0.5, 1e-15, "the home offset");
        }
    }
}

#[test]
fn a_limit_switch_that_the_method_does_not_expect_is_an_error() {
    let bare = Machine { home: 5.0..=6.0, pulses: vec![] };
    let mute = Machine { pulses: vec![], ..Machine::with_home(0.2..=0.3) };
    let rows = [
        (&bare, 3, Switch::PositiveLimit),
        (&bare, 4, Switch::PositiveLimit),
        (&bare, 5, Switch::NegativeLimit),
        (&bare, 6, Switch::NegativeLimit),
        // Reversed at one end, the axis must find the switch before the other end.
        (&bare, 7, Switch::NegativeLimit),
        (&bare, 10, Switch::NegativeLimit),
        (&bare, 12, Switch::PositiveLimit),
        (&bare, 26, Switch::NegativeLimit),
        (&bare, 33, Switch::NegativeLimit),
        (&bare, 34, Switch::PositiveLimit),
        // The switch is there, the pulse is not.
        (&mute, 1, Switch::PositiveLimit),
        (&mute, 2, Switch::NegativeLimit),
        (&mute, 8, Switch::PositiveLimit),
        (&mute, 9, Switch::NegativeLimit),
    ];
    for (machine, number, switch) in rows {
        let (seen, axis) = home(machine, params(number), -0.2);
        assert_eq!(axis.state.failure(), Some(Failure::Limit(switch)), "method {number}");
        let last = seen[seen.len() - 1].output;
        assert!(last.answer.bit_13 && !last.answer.bit_12 && last.shift.is_none(), "{last:?}");
        let stop = SWITCH_SPEED * SWITCH_SPEED / 2.0 + SWITCH_SPEED / 50.0;
        assert!(axis.demanded.x.abs() - 1.0 < stop && axis.demanded.v == 0.0, "{:?}", axis.demanded);
    }
}

#[test]
fn numbers_that_are_no_method_are_refused_with_what_is_supported() {
    let known: Vec<i8> = Method::all().map(|method| method.number()).collect();
    let expected: Vec<i8> = (1..=14).chain(17..=30).chain([33, 34, 35, 37]).collect();
    assert_eq!(known, expected);
    for number in i8::MIN..=i8::MAX {
        let method = Method::from_number(number);
        assert_eq!(method.err(), (!known.contains(&number)).then_some(UnknownMethod { number }));
    }
    assert_eq!(
        Method::from_number(15).unwrap_err().to_string(),
        "homing method (6098h) must be one of 1 to 14, 17 to 30, 33, 34, 35 and 37, got 15"
    );
}
