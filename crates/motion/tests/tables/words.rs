//! The drive's words, by the bit tables of the source.
use servobench_motion::PlanError;
use servobench_motion::pvt::{Knot, Point, Record, to_knots, to_points};

fn point(position: i32, velocity: Option<i32>, time_ms: u8, relative: bool) -> Point {
    Point { position, velocity, time_ms, relative }
}

/// The words by hand: bits 0–7 time, bit 12 relative, bit 15 command, bit 8 the command code.
#[test]
fn words_are_those_of_the_source() {
    let cases: [(Record, u16, &[i32]); 6] = [
        (Record::Point(point(5000, Some(1234), 10, false)), 0x000A, &[5000, 1234]),
        (Record::Point(point(-7, None, 255, true)), 0x10FF, &[-7]),
        (Record::Point(point(i32::MIN, Some(i32::MAX), 0, false)), 0x0000, &[i32::MIN, i32::MAX]),
        (Record::Clear, 0x8000, &[]),
        (Record::Remove(3), 0x8103, &[]),
        (Record::Remove(0), 0x8100, &[]),
    ];
    for (record, word, values) in cases {
        let words = record.encode();
        assert_eq!((words.word(), words.values()), (word, values));
        assert_eq!(Record::decode(0, word, values), Ok(record));
    }
}

/// Every word there is: it is refused for its reserved bits, or encoding gives it back.
#[test]
fn every_word_is_understood_or_refused() {
    let mut understood = 0;
    for word in 0..=u16::MAX {
        for values in [&[][..], &[-1], &[7, -8], &[1, 2, 3]] {
            match Record::decode(4, word, values) {
                Ok(record) => {
                    understood += 1;
                    assert_eq!((record.encode().word(), record.encode().values()), (word, values));
                }
                Err(PlanError::ReservedBits { point: 4, word: named, bits }) => {
                    assert_eq!((named & bits, bits != 0), (bits, true));
                }
                Err(e) => assert!(matches!(e, PlanError::Point { point: 4, name: "values", .. }), "{e}"),
            }
        }
    }
    // 256 times, relative or not, with or without a velocity; 256 removals and one clearing.
    assert_eq!(understood, 256 * 2 * 2 + 256 + 1);
    let reserved = Record::decode(2, 0x0900, &[0]).unwrap_err();
    assert_eq!(reserved.to_string(), "point 2: bits 0x0900 of the word 0x0900 are reserved: send them as zero");
    assert_eq!(
        Record::decode(1, 0x8000, &[5]).unwrap_err().to_string(),
        "point 1: `values` must be none behind a command, got 1: send the command as a word of its own"
    );
    assert_eq!(
        Record::decode(1, 0x000A, &[]).unwrap_err().to_string(),
        "point 1: `values` must be 1 or 2, got 0: send the position and, for a cubic approach, the velocity"
    );
}

/// 1234 is 123.4 counts/s; relative points add up from the position at the start.
#[test]
fn points_become_absolute_si() {
    let points = [
        point(10, Some(0), 255, true),
        point(-5, Some(1234), 1, true),
        point(100, None, 2, false),
        point(1, None, 0, true),
    ];
    let mut knots = [Knot::default(); 5];
    let knots = to_knots(&points, 1000, 0.5, &mut knots).unwrap();
    let expected = [(0.0, 505.0, Some(0.0)), (0.255, 502.5, Some(61.7)), (0.256, 50.0, None), (0.258, 50.5, None)];
    assert_eq!(knots.len(), 4);
    for (knot, (t, x, v)) in knots.iter().zip(expected) {
        assert_eq!((knot.t, knot.x), (t, x));
        assert_eq!(knot.v.map(|v| (v * 1e9).round()), v.map(|v: f64| (v * 1e9).round()), "one rounding of 61.7");
    }
}

#[test]
fn si_becomes_points_and_comes_back() {
    let unit = 1e-6;
    let sent: Vec<Point> = (0..2000)
        .map(|k: i32| {
            point(k * k * 100 - 7, (k % 5 != 0).then_some(k * 1000 - 9), u8::try_from(k % 255 + 1).unwrap(), false)
        })
        .chain([point(3, Some(0), 0, false)])
        .collect();
    let mut knots = vec![Knot::default(); sent.len()];
    to_knots(&sent, 0, unit, &mut knots).unwrap();
    let mut back = vec![Point::default(); sent.len()];
    assert_eq!(to_points(&knots, unit, &mut back).unwrap(), sent);
}

#[test]
fn refusals_name_the_point_and_the_way_out() {
    let mut knots = [Knot::default(); 3];
    let mut refusal = |points: &[Point], origin| to_knots(points, origin, 1e-6, &mut knots).unwrap_err().to_string();
    let (go, end) = (point(1, None, 10, true), point(1, None, 0, true));
    assert_eq!(refusal(&[end], 0), "a table needs at least 2 points, got 1: add the point where the move ends");
    assert_eq!(refusal(&[], 0), "a table needs at least 2 points, got 0: add the point where the move ends");
    assert_eq!(
        refusal(&[go, end, end], 0),
        "point 1: `time_ms` must be 1 to 255 before the last point, got 0: 0 ends the move: drop the points behind it"
    );
    assert_eq!(
        refusal(&[go, go], 0),
        "point 1: `time_ms` must be 0 at the last point, got 10: end the move there, or add the points that follow"
    );
    assert_eq!(
        refusal(&[go, go, end], i32::MAX - 1),
        "point 1: `position` must be within the 32 bits of the drive's counter once it is made absolute, got \
         2147483648: shorten the relative way, or start the move nearer to zero"
    );
    assert_eq!(
        refusal(&[go; 4], 0),
        "`knots` must hold a value for each of 4 points, got room for 3: pass a longer slice"
    );
    assert!(to_knots(&[go, end], 0, 0.0, &mut knots).is_err());

    let mut points = [Point::default(); 2];
    let mut refusal =
        |t: f64, x: f64| to_points(&[Knot::new(0.0, 0.0), Knot::new(t, x)], 1e-6, &mut points).unwrap_err().to_string();
    assert_eq!(
        refusal(0.256, 0.0),
        "point 0: `time_ms` must be a whole number from 1 to 255 ms, got 256: divide a longer segment, or put the points \
         on milliseconds"
    );
    assert!(refusal(0.0105, 0.0).starts_with("point 0: `time_ms` must be a whole number"));
    assert!(refusal(0.01, 3000.0).starts_with("point 1: `position` must be within 32 bits in the unit of the drive"));
}
