//! The data record and the serial interface.
use crate::axis::{Axis, COUNT, cubic, idle, linear, run};
use servobench_cia402::interpolated::{CAPACITY, Point, SubMode, TimePeriod};
use servobench_drive::modes::interpolated::serial::{Port, SerialError};
use servobench_drive::modes::interpolated::{Buffer, DataRecord, RecordError, StartRefused};

/// Positions in the buffer, found by moving an axis through it.
fn positions(buffer: &Buffer, sub_mode: SubMode) -> Vec<f64> {
    let mut axis = Axis::at(0, sub_mode);
    axis.buffer = *buffer;
    axis.until_rest(run()).iter().map(|setpoint| setpoint.x).collect()
}

#[test]
fn the_write_that_the_sub_mode_names_adds_the_point() {
    let period = TimePeriod::new(15, -3).unwrap();
    // Position 70, time 20 ms, velocity -5 are written in turn; how many points are there after each write?
    let rows = [
        (SubMode::LinearAdapted, [1, 1, 1], linear(70, 15)),
        (SubMode::Linear, [1, 1, 1], linear(70, 15)),
        (SubMode::LinearTimed, [0, 1, 1], linear(70, 20)),
        (SubMode::Cubic, [0, 0, 1], cubic(70, -5, 20)),
    ];
    for (sub_mode, counts, point) in rows {
        let (mut record, mut buffer) = (DataRecord::default(), Buffer::default());
        for (sub_index, value, count) in [(1, 70, counts[0]), (2, 20, counts[1]), (3, -5, counts[2])] {
            let written = record.write(sub_mode, period, &mut buffer, sub_index, value);
            let refused = RecordError::SubIndex { sub_index, sub_mode };
            assert_eq!(written.err(), (sub_index > sub_mode.last_sub_index()).then_some(refused));
            assert_eq!(CAPACITY - buffer.free(), count, "{sub_mode:?} {sub_index}");
        }
        let mut expected = Buffer::default();
        expected.add(point).unwrap();
        assert_eq!(buffer, expected, "{sub_mode:?}");
    }
}

#[test]
fn the_data_record_refuses_what_is_out_of_range_and_says_what_is_not() {
    let (mut record, mut buffer) = (DataRecord::default(), Buffer::default());
    let period = TimePeriod::new(1, -3).unwrap();
    let mut write = |sub_mode, sub_index, value| {
        record.write(sub_mode, period, &mut buffer, sub_index, value).map_err(|error| error.to_string())
    };
    assert_eq!(
        write(SubMode::Linear, 2, 5).unwrap_err(),
        "interpolation data record: sub-index 2 must not be written in sub-mode -1, 1 to 1 may be"
    );
    assert_eq!(
        write(SubMode::Cubic, 2, 256).unwrap_err(),
        "interpolation data record: time (60C1h.2) must be 0 to 255 ms, got 256"
    );
    for _ in 0..CAPACITY {
        write(SubMode::Linear, 1, 0).unwrap();
    }
    assert_eq!(
        write(SubMode::Linear, 1, 0).unwrap_err(),
        "the trajectory buffer holds 32 points and is full: read the free count (2011h) before sending more"
    );
}

#[test]
fn a_move_through_the_serial_interface() {
    let mut axis = Axis::at(0, SubMode::LinearAdapted);
    let mut port = Port::default();
    assert_eq!(port.command(&mut axis.buffer, 17), Err(SerialError::NoMode));
    port.write(&mut axis.buffer, 0xC8, 3, &[]).unwrap();
    // Before the mode has taken over, nothing starts.
    port.command(&mut axis.buffer, 17).unwrap();
    axis.step(idle());
    assert_eq!((axis.errors(), axis.answer.bit_12), (0, false));
    // The S-curve of the application note: 100 ms each, J = 1000/(2·0.1³) counts/s³, in four segments to 1000 counts.
    let (positions, velocities) = ([0, 83, 500, 917, 1000], [0, 25_000, 50_000, 25_000, 0]);
    for k in 0..5 {
        let word = if k == 4 { 0 } else { 100 };
        port.write(&mut axis.buffer, 0x115, word, &[positions[k], velocities[k]]).unwrap();
    }
    assert_eq!(axis.buffer.free(), 27);
    port.command(&mut axis.buffer, 17).unwrap();
    // Bit 4 plays no part in it, nor does the sub-mode.
    let mut setpoints = vec![];
    for _ in 0..1601 {
        setpoints.push(axis.step(idle()).x);
    }
    for (k, position) in positions.iter().enumerate() {
        assert!((setpoints[400 * k] - f64::from(*position) * COUNT).abs() < 1e-15, "{k}");
    }
    assert!(!axis.answer.bit_12 && axis.errors() == 0);

    // Here, clearing the buffer clears errors.
    port.command(&mut axis.buffer, 17).unwrap();
    axis.step(idle());
    assert_eq!(axis.errors(), 4);
    port.command(&mut axis.buffer, 17).unwrap();
    axis.step(idle());
    assert_eq!(axis.state.refused(), Some(StartRefused::Latched { errors: 4 }));
    port.write(&mut axis.buffer, 0x115, 0x8000, &[]).unwrap();
    assert_eq!((axis.errors(), axis.buffer.free()), (0, 32));
}

#[test]
fn a_start_while_a_move_runs_is_refused() {
    let mut axis = Axis::at(0, SubMode::Cubic);
    let mut port = Port::default();
    port.write(&mut axis.buffer, 0xC8, 3, &[]).unwrap();
    axis.add(&[cubic(0, 0, 10), cubic(100, 0, 10), cubic(0, 0, 0)]);
    axis.step(run());
    port.command(&mut axis.buffer, 17).unwrap();
    axis.step(run());
    assert_eq!(axis.state.refused(), Some(StartRefused::Running));
    axis.until_rest(run());
    assert_eq!(axis.errors(), 0);
}

#[test]
fn serial_messages_that_are_malformed_say_which_word_and_what_is_allowed() {
    let (mut port, mut buffer) = (Port::default(), Buffer::default());
    let mut refusal =
        |parameter, word, values: &[i32]| port.write(&mut buffer, parameter, word, values).unwrap_err().to_string();
    assert_eq!(refusal(0x116, 0, &[]), "parameter 0x116 is not supported: 0x0c8 and 0x115 are");
    assert_eq!(
        refusal(0xC8, 2, &[]),
        "trajectory mode (C8h) must be 3, PVT, as a word without values, got 2 and 0 values"
    );
    assert_eq!(refusal(0x115, 0x0F05, &[1]), "point 0: bits 0x0f00 of the word 0x0f05 are reserved: send them as zero");
    assert_eq!(
        refusal(0x115, 5, &[1, 2, 3]),
        "point 0: `values` must be 1 or 2, got 3: send the position and, for a cubic approach, the velocity"
    );
    assert_eq!(
        port.command(&mut buffer, 18).unwrap_err().to_string(),
        "op-code 18 is not supported: 17, start move, is"
    );
    assert_eq!(buffer, Buffer::default(), "nothing of it came through");
    port.write(&mut buffer, 0x115, 5, &[7]).unwrap();
    port.write(&mut buffer, 0x115, 0x1000, &[-7]).unwrap();
    let mut expected = Buffer::default();
    expected.add(linear(7, 5)).unwrap();
    expected.add(Point { is_relative: true, ..linear(-7, 0) }).unwrap();
    assert_eq!(buffer, expected);
    assert_eq!(positions(&buffer, SubMode::Linear).last(), Some(&0.0));
}
