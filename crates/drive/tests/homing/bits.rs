//! The statusword's bits 10, 12 and 13, and the ways to cancel the search.
use crate::axis::{Axis, Machine, Seen, idle, start};
use crate::methods::params;
use servobench_base::Setpoint;
use servobench_cia402::{ControlBit, Controlword};

/// Bits 13, 12 and 10.
fn bits(seen: &Seen) -> [bool; 3] {
    let answer = seen.output.answer;
    [answer.bit_13, answer.bit_12, answer.target_reached]
}

const UNDER_WAY: [bool; 3] = [false, false, false];
const NOT_STARTED: [bool; 3] = [false, false, true];
const ATTAINED: [bool; 3] = [false, true, false];
const HOMED: [bool; 3] = [false, true, true];
const FAILED_MOVING: [bool; 3] = [true, false, false];
const FAILED: [bool; 3] = [true, false, true];

/// Sequence of the bits, without repetitions, with the controlword `word` until they are `last`.
fn until(axis: &mut Axis, word: Controlword, last: [bool; 3]) -> Vec<[bool; 3]> {
    let mut said: Vec<[bool; 3]> = vec![];
    for _ in 0..300_000 {
        let bits = bits(&axis.step(word));
        if said.last() != Some(&bits) {
            said.push(bits);
        }
        if bits == last {
            return said;
        }
    }
    panic!("{said:?}");
}

#[test]
fn a_search_says_under_way_then_attained_then_homed() {
    let machine = Machine::with_home(0.2..=0.3);
    let mut axis = Axis::new(&machine, params(7), 0.0);
    assert_eq!(bits(&axis.step(idle())), NOT_STARTED);
    assert_eq!(until(&mut axis, start(), HOMED), [UNDER_WAY, ATTAINED, HOMED]);
    // The axis stays homed, with bit 4 cleared or not, until bit 4 rises again.
    assert_eq!(bits(&axis.step(start())), HOMED);
    assert_eq!(bits(&axis.step(idle())), HOMED);
    assert_eq!(bits(&axis.step(start())), UNDER_WAY);
}

#[test]
fn a_failed_search_stays_failed_until_it_is_started_anew() {
    let machine = Machine { home: 5.0..=6.0, pulses: vec![] };
    let mut axis = Axis::new(&machine, params(3), 0.9);
    assert_eq!(until(&mut axis, start(), FAILED), [UNDER_WAY, FAILED_MOVING, FAILED]);
    assert_eq!(bits(&axis.step(idle())), FAILED);
    assert_eq!(bits(&axis.step(start())), FAILED, "it is on the limit switch still");
    axis.params = params(5);
    assert_eq!(bits(&axis.step(idle())), FAILED);
    assert_eq!(bits(&axis.step(start())), UNDER_WAY);
}

#[test]
fn a_start_that_is_taken_back_interrupts_and_the_next_one_begins_anew() {
    let machine = Machine::with_home(0.2..=0.3);
    let mut axis = Axis::new(&machine, params(23), 0.0);
    for _ in 0..4_000 {
        assert_eq!(bits(&axis.step(start())), UNDER_WAY);
    }
    assert_eq!(until(&mut axis, idle(), NOT_STARTED), [UNDER_WAY, NOT_STARTED]);
    assert!(axis.demanded.v == 0.0 && axis.demanded.x < 0.2, "{:?}", axis.demanded);
    let at = axis.demanded;
    assert_eq!(bits(&axis.step(idle())), NOT_STARTED);
    assert_eq!(axis.demanded, Setpoint::at_rest(at.x));
    until(&mut axis, start(), HOMED);
    assert!((0.5 - axis.shift - 0.2).abs() < 1e-5);
}

#[test]
fn a_bit_that_is_set_as_the_mode_takes_over_starts_nothing() {
    let machine = Machine::with_home(0.2..=0.3);
    let mut axis = Axis::new(&machine, params(23), 0.0);
    axis.take_over(start());
    assert_eq!(bits(&axis.step(start())), NOT_STARTED);
    assert_eq!(bits(&axis.step(idle())), NOT_STARTED);
    assert_eq!(bits(&axis.step(start())), UNDER_WAY);
}

#[test]
fn halt_stops_the_axis_on_its_leg_and_lets_it_go_on() {
    let machine = Machine::with_home(0.2..=0.3);
    let mut axis = Axis::new(&machine, params(8), 0.0);
    for _ in 0..4_000 {
        axis.step(start());
    }
    let halt = start().with(ControlBit::Halt, true);
    assert_eq!(until(&mut axis, halt, NOT_STARTED), [UNDER_WAY, NOT_STARTED]);
    let at = axis.demanded;
    assert_eq!(bits(&axis.step(halt)), NOT_STARTED);
    assert!(axis.demanded == Setpoint::at_rest(at.x) && at.x < 0.2);
    assert_eq!(until(&mut axis, start(), HOMED), [UNDER_WAY, ATTAINED, HOMED]);
    // Rounded twice: the shift, and its difference to the offset.
    assert!((0.5 - axis.shift - machine.pulse_right_of(0.2)).abs() < 1e-15);
}

#[test]
fn velocity_and_acceleration_are_those_of_the_parameters_through_every_turn() {
    let machine = Machine::with_home(0.2..=0.3);
    let mut axis = Axis::new(&machine, params(25), 0.9);
    let mut last = axis.demanded;
    for k in 0..60_000 {
        // Cancelled and started again, halted and released.
        let word = if k % 7_001 < 40 { idle() } else { start().with(ControlBit::Halt, k % 5_003 < 30) };
        axis.step(word);
        let now = axis.demanded;
        let (v, a) = (now.v - last.v, now.a - last.a);
        let period = crate::axis::PERIOD;
        let slack = 1.0 + 1e-9;
        assert!(now.v.abs() <= 0.1 * slack && now.a.abs() <= 1.0 * slack, "{k}: {now:?}");
        assert!(v.abs() <= 1.0 * period * slack && a.abs() <= 200.0 * period * slack, "{k}: {last:?} {now:?}");
        // The mean velocity between two set-points lies between theirs, up to the effect of the jerk.
        let mean = (now.x - last.x) / period;
        let bend = 200.0 * period * period;
        assert!(mean <= now.v.max(last.v) + bend && mean >= now.v.min(last.v) - bend, "{k}: {last:?} {now:?}");
        last = now;
    }
}
