//! Interpolated position through the drive: points of the master, free places and the status of the buffer.
use crate::axis::Axis;
use servobench_cia402::interpolated::{Point, SegmentCommand, SubMode, TimePeriod};
use servobench_cia402::{ControlBit, InterpolationData, Mode, StatusBit};
use servobench_drive::device::Params;
use servobench_drive::modes::interpolated::serial::Port;
use servobench_drive::modes::interpolated::{Buffer, DataRecord};

impl Axis {
    fn send(&mut self, command: SegmentCommand) {
        self.frame.trajectory_point = command.encode();
        assert!(self.frame.trajectory_point.is_some(), "{command:?}");
        self.cycle();
        self.frame.trajectory_point = None;
    }
}

/// Oracle: 50 µm in 10 ms from rest to rest and back by cubics; in the middle of each the axis has covered half the distance, at 1.5 times
/// the mean velocity.
#[test]
fn points_of_the_master_are_followed_and_an_empty_buffer_is_an_underflow() {
    let params = Params { sub_mode: SubMode::Cubic, ..Params::default() };
    let mut axis = Axis::enabled(&params, Mode::InterpolatedPosition);
    assert_eq!(axis.actuals().buffer_free, 32);
    for (counter, position) in (0..).zip([0, 50, 0, 50]) {
        let point = Point { position, velocity: Some(0), time: 10_000, is_relative: false };
        axis.send(SegmentCommand::Point { counter, point });
    }
    assert_eq!((axis.actuals().buffer_free, axis.actuals().buffer_status), (28, 28 << 16 | 4));
    axis.frame.controlword = axis.frame.controlword.with(ControlBit::ModeSpecific4, true);
    let mut way = Vec::new();
    for k in 0..140 {
        axis.step(k % 4 == 0);
        way.push((axis.position * 1e6, axis.has(StatusBit::ModeSpecific12)));
    }
    // The axis has done a step at the end of it.
    for (k, x) in [(19, 25.0), (39, 50.0), (59, 25.0), (79, 0.0), (99, 25.0), (119, 50.0)] {
        assert!((way[k].0 - x).abs() < 1e-9, "step {k}: {:?}", way[k]);
    }
    assert!(way[100].1 && !way[130].1, "bit 12 as long as the axis moves by points");
    assert_eq!(axis.actuals().buffer_status >> 24, 0x84, "underflow, empty");
}

#[test]
fn a_point_that_cannot_be_read_is_a_warning_until_a_good_one_comes() {
    let mut axis = Axis::enabled(&Params::default(), Mode::InterpolatedPosition);
    axis.frame.trajectory_point = Some([0x7F; 8]);
    axis.cycle();
    assert!(axis.has(StatusBit::Warning));
    axis.send(SegmentCommand::NoOperation);
    assert!(!axis.has(StatusBit::Warning));
}

/// Oracle: 100 µm per 10 ms, on a line from the present position.
#[test]
fn points_come_through_the_data_record_too() {
    let period = TimePeriod::new(10, -3).unwrap();
    let params = Params { sub_mode: SubMode::Linear, segment: period, ..Params::default() };
    let mut axis = Axis::enabled(&params, Mode::InterpolatedPosition);
    let mut record = DataRecord::default();
    for position in [100, 200, 300] {
        record.write(SubMode::Linear, period, axis.state.trajectory_buffer(), 1, position).unwrap();
    }
    axis.frame.controlword = axis.frame.controlword.with(ControlBit::ModeSpecific4, true);
    for k in 1..=100 {
        axis.step(k % 4 == 1);
        assert!((axis.position - 2.5e-6 * f64::from(k)).abs() < 1e-15, "step {k}: {}", axis.position);
    }
}

/// Oracle: the data record itself. Parts of a frame that the sub-mode does not use are refused, and the drive warns.
#[test]
fn a_frame_carries_the_data_record() {
    let period = TimePeriod::new(10, -3).unwrap();
    for sub_mode in SubMode::ALL {
        let params = Params { sub_mode, segment: period, ..Params::default() };
        let mut axis = Axis::enabled(&params, Mode::InterpolatedPosition);
        let time = (!sub_mode.has_constant_time()).then_some(20_u8);
        let velocity = (sub_mode == SubMode::Cubic).then_some(-5);
        let data = InterpolationData { position: 70, time, velocity };
        axis.frame.interpolation_data = Some(data);
        axis.cycle();
        let (mut record, mut expected) = (DataRecord::default(), Buffer::default());
        for (sub_index, value) in [(1, Some(70)), (2, time.map(i32::from)), (3, velocity)] {
            if let Some(value) = value {
                record.write(sub_mode, period, &mut expected, sub_index, value).unwrap();
            }
        }
        assert_eq!((*axis.state.trajectory_buffer(), axis.has(StatusBit::Warning)), (expected, false), "{sub_mode:?}");
        if sub_mode != SubMode::Cubic {
            axis.frame.interpolation_data = Some(InterpolationData { time: Some(20), velocity: Some(-5), ..data });
            axis.cycle();
            assert!(axis.has(StatusBit::Warning), "{sub_mode:?}");
        }
    }
}

/// Oracle: a cubic of 1 mm in 100 ms from rest to rest is half way after half the time; bit 4 stays cleared.
#[test]
fn a_move_through_the_serial_interface_needs_no_bit() {
    let mut axis = Axis::enabled(&Params::default(), Mode::InterpolatedPosition);
    let (mut port, buffer) = (Port::default(), axis.state.trajectory_buffer());
    port.write(buffer, 0xC8, 3, &[]).unwrap();
    port.write(buffer, 0x115, 100, &[0, 0]).unwrap();
    port.write(buffer, 0x115, 0, &[1000, 0]).unwrap();
    port.command(buffer, 17).unwrap();
    assert_eq!(buffer.free(), 30);
    for k in 1..=400 {
        axis.step(k % 4 == 1);
        if k == 200 {
            assert!((axis.position - 5e-4).abs() < 1e-15 && axis.has(StatusBit::ModeSpecific12), "{}", axis.position);
        }
    }
    assert!((axis.position - 1e-3).abs() < 1e-15);
    axis.cycle();
    assert!(!axis.has(StatusBit::ModeSpecific12) && axis.has(StatusBit::TargetReached));
}

/// Halted and released, with bit 4 set all the time: the trajectory has ended and is not resumed.
#[test]
fn a_halt_ends_the_move_and_nothing_jumps() {
    let params = Params { sub_mode: SubMode::Cubic, ..Params::default() };
    let mut axis = Axis::enabled(&params, Mode::InterpolatedPosition);
    for (counter, position) in (0..).zip([0, 500, 1500, 2000, 2500]) {
        let point = Point { position, velocity: Some(500_000), time: 10_000, is_relative: false };
        axis.send(SegmentCommand::Point { counter, point });
    }
    let run = axis.frame.controlword.with(ControlBit::ModeSpecific4, true);
    let mut last = axis.position;
    for k in 0..1000 {
        axis.frame.controlword = run.with(ControlBit::Halt, (60..400).contains(&k));
        axis.step(k % 4 == 0);
        // The cubics do not exceed 0.125 m/s: 31.25 µm per period.
        assert!((axis.position - last).abs() < 32e-6, "step {k}: {last} {}", axis.position);
        last = axis.position;
        assert_eq!(axis.has(StatusBit::ModeSpecific12), k < 60, "step {k}");
    }
    assert!(axis.velocity == 0.0 && axis.actuals().buffer_status >> 24 == 0, "neither a move nor an underflow");
}
