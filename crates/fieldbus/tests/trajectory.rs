//! A move as points for a drive, and their transfer. Oracle: the sums of the points sent.
use servobench_base::Setpoint;
use servobench_cia402::interpolated::serial::{Message, Record};
use servobench_cia402::interpolated::{CAPACITY, Point, SegmentCommand, SubMode, TimePeriod};
use servobench_config::Choice as _;
use servobench_fieldbus::trajectory::{PointEncoding, PointTransfer, Stream, Timing, points};
use servobench_fieldbus::{ProfileCommand, ProfileFeedback, TrajectoryPoint};
use std::collections::VecDeque;

const COUNTS: f64 = 1.7e6;
const START: f64 = 0.123_456_7;

/// Cubics of 7, 13 and 10 ms in turn, from rest to rest: their lengths and beginnings, and the end.
fn wave(number: usize) -> (Vec<(f64, Setpoint)>, Setpoint) {
    let at = |k: usize| {
        let phase = core::f64::consts::TAU * k as f64 / number as f64;
        Setpoint { x: 0.03 * (1.0 - phase.cos()), v: 0.2 * phase.sin(), a: 1.0, j: 1.0, s: 0.0 }
    };
    ((0..number).map(|k| ([0.007, 0.013, 0.010][k % 3], at(k))).collect(), at(number))
}

fn encoding(transfer: PointTransfer, sub_mode: SubMode) -> PointEncoding {
    PointEncoding::new(transfer, sub_mode, TimePeriod::new(10, -3).unwrap()).unwrap()
}

#[test]
fn rounding_does_not_add_up() {
    let (polynomials, end) = wave(500);
    for (name, transfer, _) in PointTransfer::ALL {
        let sent = points(polynomials.clone(), end, START, COUNTS, encoding(*transfer, SubMode::Cubic)).unwrap();
        assert_eq!(sent.len(), 501, "{name}");
        let mut position = (START * COUNTS).round();
        for (point, (time, state)) in sent.iter().zip(polynomials.iter().copied().chain([(0.0, end)])) {
            let from = if point.is_relative { position } else { 0.0 };
            position = from + f64::from(point.position);
            assert!((position - COUNTS * (START + state.x)).abs() <= 0.5 + 1e-9, "{name}: {point:?}");
            let velocity = f64::from(point.velocity.unwrap());
            assert!((velocity - 10.0 * COUNTS * state.v).abs() <= 0.5 + 1e-9, "{name}: {point:?}");
            assert!((f64::from(point.time) - 1e6 * time).abs() < 1e-6, "{name}: {point:?}");
        }
        assert_eq!((sent[0].velocity, sent[500].time), (Some(0), 0), "{name}");
    }
}

/// The point that a drive reads from a command or a message.
fn received(command: &ProfileCommand, message: Option<Message>) -> Option<Point> {
    let by_frame = match command {
        ProfileCommand::Points { point: Some(TrajectoryPoint::MoveSegment(bytes)), .. } => {
            let Ok(SegmentCommand::Point { point, .. }) = SegmentCommand::decode(*bytes) else {
                panic!("{bytes:02X?} is no point")
            };
            Some(point)
        }
        ProfileCommand::Points { point: Some(TrajectoryPoint::DataRecord(data)), .. } => {
            let time = 1000 * u32::from(data.time.unwrap());
            Some(Point { position: data.position, is_relative: false, velocity: data.velocity, time })
        }
        _ => None,
    };
    let by_message = match message {
        Some(Message::Write { parameter: 0x115, words }) => match Record::decode(words.word(), words.values()) {
            Ok(Record::Point(point)) => Some(point),
            other => panic!("{other:?} is no point"),
        },
        _ => None,
    };
    assert!(by_frame.is_none() || by_message.is_none());
    by_frame.or(by_message)
}

/// A drive that takes a point out of its buffer every third cycle, behind a bus of any delay: all points arrive, in order, and none without
/// room for it.
#[test]
fn every_point_arrives_once_and_only_where_there_is_room() {
    let (polynomials, end) = wave(200);
    for (name, transfer, _) in PointTransfer::ALL {
        for delay in [0, 1, 2, 3, 7, 15] {
            let encoding = encoding(*transfer, SubMode::Cubic);
            let sent = points(polynomials.clone(), end, START, COUNTS, encoding).unwrap();
            let timing = Timing { task: 1e-3, bus: 1e-3, frame: 1e-3 * delay as f64 };
            let mut stream = Stream::new(encoding, vec![(0.0, sent.clone())], timing);
            let (mut arrived, mut waiting, mut fewest) = (Vec::new(), 0_usize, CAPACITY);
            let mut to_drive = VecDeque::from(vec![None; delay]);
            let mut answers = VecDeque::from(vec![(0, 0); delay]);
            for cycle in 0..1000 {
                answers.push_back((waiting, arrived.len()));
                let (told, known) = answers.pop_front().unwrap();
                let drive = ProfileFeedback {
                    is_active: told > 0,
                    buffer_free: u16::try_from(CAPACITY - told).unwrap(),
                    buffer_status: u32::try_from(known).unwrap(),
                    ..ProfileFeedback::default()
                };
                let command = stream.cycle(f64::from(cycle) * 1e-3, &drive);
                to_drive.push_back(received(&command, stream.message()));
                if let Some(point) = to_drive.pop_front().flatten() {
                    arrived.push(point);
                    waiting += 1;
                }
                fewest = fewest.min(CAPACITY.checked_sub(waiting).expect("room for every point"));
                if cycle % 3 == 2 {
                    waiting = waiting.saturating_sub(1);
                }
            }
            assert_eq!(arrived, sent, "{name}, {delay} cycles");
            assert!(
                fewest < CAPACITY / 4 || delay > 3,
                "{name}: the buffer is kept full, but {fewest} places stayed free"
            );
        }
    }
}
