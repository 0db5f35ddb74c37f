//! MC_DigitalCamSwitch: each rule with numbers worked out by hand. The positions are fed in cycle by cycle, one of 1 ms; track k is
//! bit k of the outputs.
use crate::bench::{Bench, CYCLE_TIME};
use crate::calls::to;
use servobench_fieldbus::{AxisCommand, Power};
use servobench_plcopen::{
    Axis, AxisParams, AxisState, CamDirection, CamEnd, CamState, CamSwitch, DigitalCamSwitch, DigitalCamSwitchInputs,
    DigitalCamSwitchOutputs, ErrorId, FunctionBlock, MoveAbsolute, SetPosition, SetPositionInputs, TrackOptions,
    ValueSource, WriteDigitalOutput, WriteDigitalOutputInputs,
};

type Block = DigitalCamSwitch<[CamState; 40]>;

/// A switch of track 0 in both directions.
const fn window(first: f64, last: f64) -> CamSwitch {
    CamSwitch { track: 0, first, end: CamEnd::Position(last), direction: CamDirection::Both }
}

const fn timed(first: f64, duration: f64) -> CamSwitch {
    CamSwitch { end: CamEnd::Duration(duration), ..window(first, 0.0) }
}

const NONE: TrackOptions = TrackOptions { track: 0, on_compensation: 0.0, off_compensation: 0.0, hysteresis: 0.0 };

/// An axis whose actual position is given by the test.
struct Shaft {
    bench: Bench,
    block: Block,
    outputs: DigitalCamSwitchOutputs,
}

impl Shaft {
    fn new() -> Self {
        Self::of(Bench::params())
    }

    /// A modulo axis of 1 m per turn.
    fn round() -> Self {
        Self::of(AxisParams { modulo: Some(1.0), ..Bench::params() })
    }

    fn of(params: AxisParams) -> Self {
        let outputs = DigitalCamSwitchOutputs::default();
        Self { bench: Bench::powered(params), block: DigitalCamSwitch::new([CamState::default(); 40]), outputs }
    }

    /// Runs a cycle at this position and velocity: the digital outputs sent to the drive.
    fn at(&mut self, position: f64, velocity: f64, inputs: &DigitalCamSwitchInputs<'_>) -> u32 {
        (self.bench.feedback.position, self.bench.feedback.velocity) = (position, velocity);
        self.outputs = self.bench.cycle(|axis| self.block.step(axis, inputs));
        self.bench.command.unwrap().digital_outputs
    }

    /// The outputs at `positions` one after the other, with the velocity from each to the next.
    fn along(&mut self, positions: &[f64], inputs: &DigitalCamSwitchInputs<'_>) -> Vec<u32> {
        let next = positions.iter().skip(1).chain(positions.last());
        positions.iter().zip(next).map(|(x, next)| self.at(*x, (next - x) / CYCLE_TIME, inputs)).collect()
    }
}

const fn actual(switches: &[CamSwitch]) -> DigitalCamSwitchInputs<'_> {
    DigitalCamSwitchInputs { enable: true, value_source: ValueSource::Actual, ..DigitalCamSwitchInputs::of(switches) }
}

/// From `first` to `last` in steps of `step`.
fn way(first: f64, last: f64, steps: u32) -> Vec<f64> {
    (0..=steps).map(|i| first + (last - first) * f64::from(i) / f64::from(steps)).collect()
}

#[test]
fn a_window_is_true_between_its_positions_both_included() {
    let switches = [window(0.1, 0.2)];
    let mut shaft = Shaft::new();
    for (x, expected) in [(0.0, 0), (0.099_999, 0), (0.1, 1), (0.15, 1), (0.2, 1), (0.200_001, 0), (-5.0, 0)] {
        for v in [0.0, 0.3, -0.3] {
            // Without compensation the velocity does not matter; a way to the place would pass the window.
            let mut shaft = Shaft::new();
            assert_eq!(shaft.at(x, v, &actual(&switches)), expected, "{x} {v}");
        }
        shaft.at(x, 0.0, &actual(&switches));
        assert!(shaft.outputs.in_operation && shaft.outputs.busy && !shaft.outputs.error);
    }
}

/// All switches of a track are combined; each track has its output.
#[test]
fn switches_of_a_track_are_ored() {
    let switches = [
        window(0.1, 0.2),
        CamSwitch { track: 31, ..window(0.15, 0.35) },
        window(0.18, 0.3),
        CamSwitch { track: 5, ..window(0.3, 0.3) },
    ];
    let mut shaft = Shaft::new();
    let (top, middle) = (1 << 31, 1 << 5);
    let expected = [0, 1, 1 | top, 1 | top, 1 | top, 1 | top | middle, top, 0];
    assert_eq!(shaft.along(&[0.05, 0.12, 0.16, 0.19, 0.25, 0.3, 0.34, 0.4], &actual(&switches)), expected);
}

#[test]
fn a_direction_is_that_of_the_last_motion() {
    let of = |direction| [CamSwitch { direction, ..window(0.1, 0.2) }];
    let (up, down) = (of(CamDirection::Positive), of(CamDirection::Negative));
    let way = [0.0, 0.11, 0.15, 0.15, 0.15, 0.14, 0.14, 0.12, 0.05];
    for (switches, expected) in [(up, [0, 1, 1, 1, 1, 0, 0, 0, 0]), (down, [0, 0, 0, 0, 0, 1, 1, 1, 0])] {
        assert_eq!(Shaft::new().along(&way, &actual(&switches)), expected, "{switches:?}");
    }
    // Before the first motion there is no direction.
    assert_eq!(Shaft::new().along(&[0.15, 0.15, 0.16], &actual(&up)), [0, 0, 1]);
    assert_eq!(Shaft::new().along(&[0.15, 0.15, 0.16], &actual(&of(CamDirection::Both))), [1, 1, 1]);
}

/// 5 mm in 70 mm steps: no cycle is in the window. And a window of no width.
#[test]
fn a_window_between_two_cycles_is_true_for_one() {
    for switches in [[window(0.1, 0.105)], [window(0.1, 0.1)]] {
        assert_eq!(Shaft::new().along(&[0.0, 0.07, 0.14, 0.21], &actual(&switches)), [0, 0, 1, 0]);
        assert_eq!(Shaft::new().along(&[0.21, 0.14, 0.07, 0.0], &actual(&switches)), [0, 0, 1, 0]);
        assert_eq!(Shaft::new().along(&[0.14, 0.14, 0.2, 0.14], &actual(&switches)), [0; 4]);
    }
    // At rest on it.
    assert_eq!(Shaft::new().along(&[0.0, 0.1, 0.1, 0.1, 0.2], &actual(&[window(0.1, 0.1)])), [0, 1, 1, 1, 0]);
}

/// 3 ms from the passing of 0.1 m, in 10 mm steps: in the cycles at 0.1, 0.11 and 0.12 m, wherever the axis is then.
#[test]
fn a_switch_by_time_lasts_its_duration() {
    let switches = [timed(0.1, 3e-3)];
    let up = way(0.08, 0.14, 6);
    assert_eq!(Shaft::new().along(&up, &actual(&switches)), [0, 0, 1, 1, 1, 0, 0]);
    assert_eq!(Shaft::new().along(&[0.08, 0.1, 0.1, 0.1, 0.1, 0.2], &actual(&switches)), [0, 1, 1, 1, 0, 0]);
    let down: Vec<f64> = up.iter().rev().copied().collect();
    assert_eq!(Shaft::new().along(&down, &actual(&switches)), [0, 0, 0, 0, 1, 1, 1]);
    let up_only = [CamSwitch { direction: CamDirection::Positive, ..switches[0] }];
    assert_eq!(Shaft::new().along(&down, &actual(&up_only)), [0; 7]);
    // Reversed at once: the time continues, and restarts on the way back, and upwards again.
    let there_and_back = [0.095, 0.105, 0.095, 0.09, 0.08, 0.07, 0.105];
    assert_eq!(Shaft::new().along(&there_and_back, &actual(&switches)), [0, 1, 1, 1, 1, 0, 1]);
    assert_eq!(Shaft::new().along(&there_and_back, &actual(&up_only)), [0, 1, 1, 1, 0, 0, 1]);
    // 2.5 ms are three cycles, 0.1 ms one; an axis that starts at the edge has passed nothing.
    assert_eq!(Shaft::new().along(&up, &actual(&[timed(0.1, 2.5e-3)])), [0, 0, 1, 1, 1, 0, 0]);
    assert_eq!(Shaft::new().along(&up, &actual(&[timed(0.1, 1e-4)])), [0, 0, 1, 0, 0, 0, 0]);
    assert_eq!(Shaft::new().along(&up, &actual(&[timed(0.08, 3e-3)])), [0; 7]);
}

/// 1 m/s, 1 mm a cycle: 4 ms are 4 mm. A window of 100 to 110 mm.
#[test]
fn compensation_moves_an_edge_by_velocity_and_time() {
    let switches = [window(0.1, 0.11)];
    // Half steps, so that no cycle is on an edge; each cycle stands for the millimetre before it.
    let up: Vec<f64> = (0..40).map(|i| 0.0905 + 1e-3 * f64::from(i)).collect();
    let down: Vec<f64> = up.iter().rev().copied().collect();
    let true_at = |way: &[f64], on, off| {
        let options = [TrackOptions { on_compensation: on, off_compensation: off, ..NONE }];
        let inputs = DigitalCamSwitchInputs { track_options: &options, ..actual(&switches) };
        let mut shaft = Shaft::new();
        let velocity = (way[1] - way[0]).signum();
        let on = way.iter().filter(|x| shaft.at(**x, velocity, &inputs) == 1);
        let on: Vec<f64> = on.map(|x| (x * 1e4).round() / 10.0).collect();
        on.first().map(|first| (*first, on[on.len() - 1], on.len()))
    };
    for (on, off, upwards, downwards) in [
        (0.0, 0.0, Some((100.5, 109.5, 10)), Some((109.5, 100.5, 10))),
        (-4e-3, 0.0, Some((96.5, 109.5, 14)), Some((113.5, 100.5, 14))),
        (0.0, -4e-3, Some((100.5, 105.5, 6)), Some((109.5, 104.5, 6))),
        (-4e-3, -4e-3, Some((96.5, 105.5, 10)), Some((113.5, 104.5, 10))),
        (4e-3, 0.0, Some((104.5, 109.5, 6)), Some((105.5, 100.5, 6))),
        (2e-3, 4e-3, Some((102.5, 113.5, 12)), Some((107.5, 96.5, 12))),
        // Off before on: never.
        (4e-3, -7e-3, None, None),
    ] {
        assert_eq!(true_at(&up, on, off), upwards, "{on} {off}");
        assert_eq!(true_at(&down, on, off), downwards, "{on} {off}");
    }
    // At rest nothing is moved.
    let options = [TrackOptions { on_compensation: -1.0, off_compensation: 1.0, ..NONE }];
    let inputs = DigitalCamSwitchInputs { track_options: &options, ..actual(&switches) };
    assert_eq!([0.099, 0.1, 0.11, 0.111].map(|x| Shaft::new().at(x, 0.0, &inputs)), [0, 1, 1, 0]);
}

/// With compensation the on edge comes 2 ms earlier, at 98 mm, and the end 1 ms later: 5 + 2 + 1 = 8 cycles.
#[test]
fn compensation_moves_both_ends_of_a_switch_by_time() {
    let options = [TrackOptions { on_compensation: -2e-3, off_compensation: 1e-3, ..NONE }];
    let switches = [timed(0.1, 5e-3)];
    let inputs = DigitalCamSwitchInputs { track_options: &options, ..actual(&switches) };
    let mut shaft = Shaft::new();
    let way: Vec<f64> = (0..30).map(|i| 0.0905 + 1e-3 * f64::from(i)).collect();
    let on: Vec<usize> = (0..30).filter(|i| shaft.at(way[*i], 1.0, &inputs) == 1).collect();
    // 98.5 mm is the first cycle behind 98 mm.
    assert_eq!(on, (8..16).collect::<Vec<_>>());
    let options = [TrackOptions { on_compensation: 4e-3, off_compensation: -1e-3, ..NONE }];
    let inputs = DigitalCamSwitchInputs { track_options: &options, ..actual(&switches) };
    let mut shaft = Shaft::new();
    assert!(way.iter().all(|x| shaft.at(*x, 1.0, &inputs) == 0), "it would end as it begins");
}

/// An actual position that dithers by 40 um on an edge, with a velocity of either sign.
#[test]
fn hysteresis_keeps_an_output_from_chattering() {
    let changes = |switch: CamSwitch, hysteresis, edge: f64| {
        let options = [TrackOptions { hysteresis, ..NONE }];
        let switches = [switch];
        let inputs = DigitalCamSwitchInputs { track_options: &options, ..actual(&switches) };
        let mut shaft = Shaft::new();
        let dither = (0..200).map(|i| edge + 40e-6 * (f64::from(i) * 2.4).sin());
        let way: Vec<f64> = way(edge - 0.01, edge, 20).into_iter().chain(dither).chain([edge + 0.01]).collect();
        let outputs = shaft.along(&way, &inputs);
        outputs.windows(2).filter(|pair| pair[0] != pair[1]).count()
    };
    for switch in [window(0.1, 0.2), CamSwitch { direction: CamDirection::Positive, ..window(0.1, 0.2) }] {
        for edge in [0.1_f64, 0.2] {
            assert!(changes(switch, 0.0, edge) > 20, "{switch:?} {edge}");
            // A switch for one direction becomes TRUE with the first motion in its window, too.
            let starts_inside = switch.direction == CamDirection::Positive && edge > 0.15;
            assert_eq!(changes(switch, 100e-6, edge), 1 + usize::from(starts_inside), "{switch:?} {edge}");
        }
    }
    assert!(changes(timed(0.1, 1e-3), 0.0, 0.1) > 20);
    assert_eq!(changes(timed(0.1, 1e-3), 100e-6, 0.1), 2);
}

/// Switched at the edge itself, not at the end of the band; 1 mm of hysteresis around 100 mm.
#[test]
fn hysteresis_does_not_move_an_edge() {
    let options = [TrackOptions { hysteresis: 1e-3, ..NONE }];
    let switches = [window(0.1, 0.2)];
    let inputs = DigitalCamSwitchInputs { track_options: &options, ..actual(&switches) };
    let way =
        [0.0985, 0.0999, 0.1, 0.0999, 0.0991, 0.0989, 0.0999, 0.0989, 0.1001, 0.1012, 0.1001, 0.0999, 0.1009, 0.1011];
    // On at 100, held down to 99.1, off at 98.9; again on at 100.1, left by 1.2, off at 99.9, held at 100.9, on at 101.1.
    assert_eq!(Shaft::new().along(&way, &inputs), [0, 0, 1, 1, 1, 0, 0, 0, 1, 1, 1, 0, 0, 1]);
}

/// From 0.9 m over the zero to 0.1 m.
#[test]
fn a_window_goes_over_the_zero_of_a_modulo_axis() {
    let switches = [window(0.9, 0.1), CamSwitch { track: 1, ..window(0.2, 0.4) }];
    let expected = |x: f64| {
        let place = x.rem_euclid(1.0);
        u32::from(!(0.1..0.9).contains(&place)) | u32::from((0.2..0.4).contains(&place)) << 1
    };
    let mut shaft = Shaft::round();
    // 10 mm steps beside the edges; the drive counts on, three turns up and five down.
    let up: Vec<f64> = (0..300).map(|i| 0.005 + 0.01 * f64::from(i)).collect();
    let down: Vec<f64> = (0..500).map(|i| 2.995 - 0.01 * f64::from(i)).collect();
    for x in up.iter().chain(&down) {
        assert_eq!(shaft.at(*x, 0.0, &actual(&switches)), expected(*x), "{x}");
    }
    for (x, is_on) in [(0.9, true), (0.1, true), (1.9, true), (-0.9, true), (0.0, true), (0.899, false), (2.101, false)]
    {
        assert_eq!(Shaft::round().at(x, 0.0, &actual(&switches)) & 1, u32::from(is_on), "{x}");
    }
    // Up to the end of the turn, and the whole of it.
    for (x, expected) in [(0.0, 0b11), (0.4, 0b10), (0.6, 0b11), (0.999, 0b11), (-7.0, 0b11), (3.0 - 1e-9, 0b11)] {
        let switches = [window(0.5, 1.0), CamSwitch { track: 1, ..window(0.0, 1.0) }];
        assert_eq!(Shaft::round().at(x, 0.0, &actual(&switches)), expected, "{x}");
    }
    // Passed between two cycles, over the zero, both ways; and not on the far side.
    let narrow = [window(0.99, 0.01)];
    assert_eq!(Shaft::round().along(&[0.9, 0.95, 1.05, 1.1], &actual(&narrow)), [0, 0, 1, 0]);
    assert_eq!(Shaft::round().along(&[1.1, 1.05, 0.95, 0.9], &actual(&narrow)), [0, 0, 1, 0]);
    assert_eq!(Shaft::round().along(&[0.3, 0.45, 0.55, 0.7], &actual(&narrow)), [0; 4]);
    assert_eq!(Shaft::round().along(&[0.95, 1.05, 1.1, 1.5, 1.6], &actual(&[timed(0.0, 2e-3)])), [0, 1, 1, 0, 0]);
}

/// A compensation of half a turn, at 10 m/s: 50 ms. The window of 0.2 to 0.3 m is TRUE from 0.7 to 0.8 m.
#[test]
fn compensation_goes_over_the_zero_too() {
    let options = [TrackOptions { on_compensation: 0.05, off_compensation: 0.05, ..NONE }];
    let switches = [window(0.2, 0.3)];
    let inputs = DigitalCamSwitchInputs { track_options: &options, ..actual(&switches) };
    let mut shaft = Shaft::round();
    for i in 0..400 {
        let x = 0.005 + 0.01 * f64::from(i);
        assert_eq!(shaft.at(x, 10.0, &inputs) == 1, (0.7..0.8).contains(&x.rem_euclid(1.0)), "{x}");
    }
}

#[test]
fn a_track_that_is_masked_out_is_false_and_nobody_elses_output_is_touched() {
    let switches = [window(0.0, 1.0), CamSwitch { track: 2, ..window(0.0, 1.0) }];
    let mut shaft = Shaft::new();
    let write = |axis: &mut Axis| {
        let inputs = WriteDigitalOutputInputs { execute: true, output_number: 7, value: true };
        WriteDigitalOutput::default().step(axis, &inputs)
    };
    shaft.bench.cycle(write);
    let inputs = actual(&switches);
    let lamp = 1 << 7;
    for (enable_mask, expected) in [(u32::MAX, 0b101), (0b100, 0b100), (!0b100, 1), (0, 0), (0b101, 0b101)] {
        assert_eq!(shaft.at(0.5, 0.0, &DigitalCamSwitchInputs { enable_mask, ..inputs }), expected | lamp);
        assert!(shaft.outputs.in_operation);
    }
    // Other switches: the track that has none is FALSE.
    assert_eq!(shaft.at(0.5, 0.0, &actual(&switches[1..])), 0b100 | lamp);
    assert_eq!(shaft.at(0.5, 0.0, &DigitalCamSwitchInputs { enable: false, ..inputs }), lamp);
    assert_eq!(shaft.outputs, DigitalCamSwitchOutputs::default());
    // A value written to an output that belonged to a track stays then.
    let inputs = DigitalCamSwitchInputs { enable: false, ..inputs };
    shaft.bench.cycle(|axis| {
        let inputs = WriteDigitalOutputInputs { execute: true, output_number: 2, value: true };
        WriteDigitalOutput::default().step(axis, &inputs)
    });
    assert_eq!(shaft.at(0.5, 0.0, &inputs), 0b100 | lamp);
}

/// A new Enable restores none of the old state: no running time, no direction, no held edge.
#[test]
fn a_new_enable_begins_anew() {
    let switches = [timed(0.1, 1.0), CamSwitch { track: 1, direction: CamDirection::Positive, ..window(0.0, 1.0) }];
    let inputs = actual(&switches);
    let mut shaft = Shaft::new();
    assert_eq!(shaft.along(&[0.09, 0.11, 0.12], &inputs), [0, 3, 3]);
    assert_eq!(shaft.at(0.12, 0.0, &DigitalCamSwitchInputs { enable: false, ..inputs }), 0);
    assert_eq!(shaft.along(&[0.12, 0.12, 0.13], &inputs), [0, 0, 2]);
}

#[test]
fn the_set_point_switches_unless_the_actual_position_is_asked_for() {
    let (mut bench, mut block, mut go) =
        (Bench::standstill(), DigitalCamSwitch::new([CamState::default(); 1]), MoveAbsolute::default());
    let switches = [window(0.1, 0.2)];
    let inputs = DigitalCamSwitchInputs { enable: true, ..DigitalCamSwitchInputs::of(&switches) };
    let mut on = 0;
    for _ in 0..2000 {
        let (outputs, x) = bench.cycle(|axis| {
            go.step(axis, &to(0.3));
            (block.step(axis, &inputs), axis.commanded().x)
        });
        // A drive that stands still.
        bench.feedback.position = 0.0;
        let is_in = (0.1..=0.2).contains(&x);
        on += usize::from(is_in);
        assert!(outputs.in_operation);
        assert_eq!(bench.command.map(|command: AxisCommand| command.digital_outputs == 1), Some(is_in), "{x}");
    }
    assert!(on > 50, "{on}");
}

/// From 0 to 0.5 m at once, over a window at 0.1 m, by MC_SetPosition and by nothing else.
#[test]
fn a_position_that_is_given_passes_nothing() {
    let switches = [window(0.1, 0.11), CamSwitch { track: 1, ..timed(0.3, 1.0) }];
    for source in [ValueSource::SetPoint, ValueSource::Actual] {
        let inputs = DigitalCamSwitchInputs { value_source: source, ..actual(&switches) };
        let mut shaft = Shaft::new();
        assert_eq!(shaft.along(&[0.0, 0.0], &inputs), [0, 0]);
        let set = SetPositionInputs { execute: true, position: 0.5, relative: true };
        shaft.bench.cycle(|axis| SetPosition::default().step(axis, &set));
        for _ in 0..3 {
            assert_eq!(shaft.at(0.0, 0.0, &inputs), 0, "{source:?}");
        }
    }
}

#[test]
fn it_works_in_every_state_of_the_axis() {
    let switches = [window(0.1, 0.2)];
    let mut shaft = Shaft::new();
    shaft.bench.enable = false;
    shaft.at(0.0, 0.0, &actual(&switches));
    shaft.at(0.0, 0.0, &actual(&switches));
    assert_eq!(shaft.bench.axis.state(), AxisState::Disabled);
    assert_eq!(shaft.along(&[0.05, 0.15, 0.25], &actual(&switches)), [0, 1, 0]);
    let mut shaft = Shaft::new();
    shaft.bench.feedback.fault = Some(servobench_fieldbus::Fault::Drive(0x2310));
    shaft.at(0.0, 0.0, &actual(&switches));
    assert_eq!((shaft.bench.axis.state(), shaft.bench.feedback.power), (AxisState::ErrorStop, Power::Off));
    assert_eq!(shaft.along(&[0.05, 0.15, 0.25], &actual(&switches)), [0, 1, 0]);
}

#[test]
fn what_cannot_be_is_an_error_and_the_outputs_are_false() {
    let good = window(0.0, 1.0);
    let of = |switches: &[CamSwitch], options: &[TrackOptions], params| {
        let mut shaft = Shaft::of(params);
        assert_eq!(shaft.at(0.5, 0.0, &actual(&[good])), 1);
        let inputs = DigitalCamSwitchInputs { track_options: options, ..actual(switches) };
        assert_eq!(shaft.at(0.5, 0.0, &inputs), 0, "the output is FALSE");
        let said = shaft.block.error().map(ToString::to_string);
        let DigitalCamSwitchOutputs { in_operation, busy, error, error_id } = shaft.outputs;
        assert_eq!((in_operation, busy, error, error_id), (false, true, true, shaft.block.error().unwrap().id()));
        // An error is over with its cause, without a new edge.
        assert_eq!((shaft.at(0.5, 0.0, &actual(&[good])), shaft.outputs.error), (1, false));
        assert_eq!(shaft.block.error(), None);
        said.unwrap()
    };
    let (ends, round) = (Bench::params(), AxisParams { modulo: Some(2.0), ..Bench::params() });
    let (nan, inf) = (f64::NAN, f64::INFINITY);
    let tracks: Vec<CamSwitch> = (0..33).map(|track| CamSwitch { track, ..good }).collect();
    for (switches, params, said) in [
        (&[][..], ends, "`Switches` must be a table of one switch at least, got 0"),
        (&tracks, ends, "`TrackNumber` must be a track from 0 to 31, got 32"),
        (&[window(nan, 0.2)], ends, "`FirstOnPosition` must be a number within ±1e15, got NaN"),
        (&[good, window(0.1, inf)], ends, "`LastOnPosition` must be a number within ±1e15, got inf"),
        (
            &[window(0.2, 0.1)],
            ends,
            "`LastOnPosition` must be at FirstOnPosition or above it, but on a modulo axis, got 0.1",
        ),
        (&[window(0.2, 2.1)], round, "`LastOnPosition` must be within the modulo period, from 0 up to it, got 2.1"),
        (&[window(2.0, 0.1)], round, "`FirstOnPosition` must be within the modulo period, from 0 on, got 2"),
        (&[window(-0.2, 0.1)], round, "`FirstOnPosition` must be within the modulo period, from 0 on, got -0.2"),
        (&[timed(0.1, 0.0)], ends, "`Duration` must be positive, from 1e-15 to 1e15, got 0"),
        (&[timed(0.1, -1.0)], ends, "`Duration` must be positive, from 1e-15 to 1e15, got -1"),
        (&[timed(0.1, nan)], ends, "`Duration` must be positive, from 1e-15 to 1e15, got NaN"),
    ] {
        assert_eq!(of(switches, &[], params), format!("MC_DigitalCamSwitch: {said}: correct the input"));
    }
    for (options, params, said) in [
        (&[TrackOptions { track: 32, ..NONE }][..], ends, "`TrackNumber` must be a track from 0 to 31, got 32"),
        (&[NONE, NONE], ends, "`TrackOptions` must be given once for a track, got 0"),
        (
            &[TrackOptions { on_compensation: nan, ..NONE }],
            ends,
            "`OnCompensation` must be a number within ±1e15, got NaN",
        ),
        (
            &[TrackOptions { off_compensation: inf, ..NONE }],
            ends,
            "`OffCompensation` must be a number within ±1e15, got inf",
        ),
        (&[TrackOptions { hysteresis: -1e-3, ..NONE }], ends, "`Hysteresis` must be 0 or more, up to 1e15, got -0.001"),
        (
            &[TrackOptions { hysteresis: 1.0, ..NONE }],
            round,
            "`Hysteresis` must be less than half of the modulo period, got 1",
        ),
    ] {
        assert_eq!(of(&[good], options, params), format!("MC_DigitalCamSwitch: {said}: correct the input"));
    }
    let mut short = DigitalCamSwitch::new([CamState::default(); 1]);
    let outputs = Bench::standstill().cycle(|axis| short.step(axis, &actual(&[good, good])));
    assert_eq!(outputs.error_id, ErrorId::Plan);
}

/// A NaN as position or velocity switches nothing on, and has no effect afterwards.
#[test]
fn a_position_that_is_no_number_is_in_no_window() {
    let options = [TrackOptions { on_compensation: -1e-3, hysteresis: 1e-3, ..NONE }];
    let switches = [window(0.1, 0.2), CamSwitch { direction: CamDirection::Positive, track: 1, ..window(0.0, 0.9) }];
    for new in [Shaft::new, Shaft::round] {
        let mut shaft = new();
        let inputs = DigitalCamSwitchInputs { track_options: &options, ..actual(&switches[..2]) };
        shaft.along(&[0.05, 0.08], &inputs);
        for (x, v) in [(f64::NAN, 0.0), (f64::INFINITY, 0.0), (f64::NEG_INFINITY, 1.0)] {
            assert_eq!(shaft.at(x, v, &inputs), 0, "{x} {v}");
        }
        assert_eq!(shaft.along(&[0.15, 0.16, 0.17, 0.3], &inputs), [3, 3, 3, 2]);
    }
}
