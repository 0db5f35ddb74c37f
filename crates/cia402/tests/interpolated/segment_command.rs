//! The eight bytes of 2010h.
use crate::{cubic, linear, relative};
use servobench_cia402::interpolated::{Point, SegmentCommand, SegmentError};

/// Bytes put together by hand from the tables of the programmer's manual.
#[test]
fn bytes_are_those_of_the_manual() {
    let point = |counter, point| SegmentCommand::Point { counter, point };
    let rows: [([u8; 8], SegmentCommand); 13] = [
        ([0x05, 10, 0x56, 0x34, 0x12, 0xFF, 0xFF, 0x7F], point(5, cubic(0x12_3456, 0x7F_FFFF, 10))),
        ([0x00, 0, 0xFF, 0xFF, 0xFF, 0x00, 0x00, 0x80], point(0, cubic(-1, -0x80_0000, 0))),
        ([0x09, 255, 0x00, 0x00, 0x80, 0x00, 0x00, 0x10], point(1, cubic(-0x80_0000, 0x10_0000 * 100, 255))),
        ([0x12, 1, 0x9C, 0xFF, 0xFF, 0x01, 0x00, 0x00], point(2, relative(cubic(-100, 1, 1)))),
        ([0x1B, 1, 0x64, 0x00, 0x00, 0x00, 0x00, 0x80], point(3, relative(cubic(100, -0x80_0000 * 100, 1)))),
        ([0x24, 0x78, 0x56, 0x34, 0x92, 0, 0, 0], SegmentCommand::Base { counter: 4, position: -0x6DCB_A988 }),
        ([0x2F, 20, 0x78, 0x56, 0x34, 0x12, 0, 0], point(7, linear(0x1234_5678, 20))),
        ([0x36, 20, 0xFF, 0xFF, 0xFF, 0xFF, 0, 0], point(6, relative(linear(-1, 20)))),
        ([0x80, 0, 0, 0, 0, 0, 0, 0], SegmentCommand::Clear),
        ([0x81, 7, 0, 0, 0, 0, 0, 0], SegmentCommand::Remove(7)),
        ([0x82, 6, 0, 0, 0, 0, 0, 0], SegmentCommand::ClearErrors(6)),
        ([0x83, 0, 0, 0, 0, 0, 0, 0], SegmentCommand::ResetSegment),
        ([0x84, 0, 0, 0, 0, 0, 0, 0], SegmentCommand::NoOperation),
    ];
    for (bytes, command) in rows {
        assert_eq!(SegmentCommand::decode(bytes), Ok(command), "{bytes:02X?}");
        assert_eq!(command.encode(), Some(bytes), "{command:?}");
    }
}

#[test]
fn what_is_reserved_is_refused_with_what_is_known() {
    for byte in 0..=u8::MAX {
        let decoded = SegmentCommand::decode([byte, 0, 0, 0, 0, 0, 0, 0]);
        let expected = match byte {
            0x00..0x38 | 0x80..=0x84 => None,
            0x38..0x80 => Some(SegmentError::Format { byte, format: byte >> 3 }),
            0x85.. => Some(SegmentError::Command { byte, command: byte - 0x80 }),
        };
        assert_eq!(decoded.err(), expected, "{byte:#04x}");
    }
    assert_eq!(
        SegmentCommand::decode([0x7A; 8]).unwrap_err().to_string(),
        "byte 0 of the move segment command is 0x7a: format 15 is reserved, formats 0 to 6 are known"
    );
    assert_eq!(
        SegmentCommand::decode([0x90; 8]).unwrap_err().to_string(),
        "byte 0 of the move segment command is 0x90: command 16 is reserved, commands 0 to 4 are known"
    );
}

#[test]
fn points_that_no_format_holds_are_not_encoded() {
    let encode = |point| SegmentCommand::Point { counter: 0, point }.encode();
    assert_eq!(encode(cubic(0x80_0000, 0, 1)), None, "position beyond 24 bits");
    assert_eq!(encode(cubic(0, 0x80_0001, 1)), None, "velocity beyond 24 bits that is no multiple of 10 counts/s");
    assert_eq!(encode(cubic(0, 0, 256)), None, "time beyond 8 bits");
    assert_eq!(encode(Point { time: 1500, ..cubic(0, 0, 0) }), None, "time between milliseconds");
    assert!(encode(linear(i32::MIN, 255)).is_some());
}
