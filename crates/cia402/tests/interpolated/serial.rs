//! The words of 115h, by the bit tables of the source.
use crate::{cubic, linear, relative};
use servobench_cia402::interpolated::Point;
use servobench_cia402::interpolated::serial::{Message, Record, RecordError};

/// The words by hand: bits 0–7 time, bit 12 relative, bit 15 command, bit 8 the command code.
#[test]
fn words_are_those_of_the_source() {
    let cases: [(Record, u16, &[i32]); 6] = [
        (Record::Point(cubic(5000, 1234, 10)), 0x000A, &[5000, 1234]),
        (Record::Point(relative(linear(-7, 255))), 0x10FF, &[-7]),
        (Record::Point(cubic(i32::MIN, i32::MAX, 0)), 0x0000, &[i32::MIN, i32::MAX]),
        (Record::Clear, 0x8000, &[]),
        (Record::Remove(3), 0x8103, &[]),
        (Record::Remove(0), 0x8100, &[]),
    ];
    for (record, word, values) in cases {
        let words = record.encode().unwrap();
        assert_eq!((words.word(), words.values()), (word, values));
        assert_eq!(Record::decode(word, values), Ok(record));
        assert_eq!(Message::of(record), Some(Message::Write { parameter: 0x115, words }));
    }
}

#[test]
fn the_mode_is_selected_and_the_move_started_by_the_words_of_the_source() {
    let Message::Write { parameter, words } = Message::SELECT_PVT else { panic!("{:?}", Message::SELECT_PVT) };
    assert_eq!((parameter, words.word(), words.values()), (0xC8, 3, &[][..]));
    assert_eq!(Message::START_MOVE, Message::Command { op_code: 17 });
}

#[test]
fn times_that_no_word_holds_are_not_encoded() {
    for time in [1, 999, 1500, 255_001, 256_000, u32::MAX] {
        assert_eq!(Record::Point(Point { time, ..linear(0, 0) }).encode(), None, "{time} µs");
    }
    assert!(Record::Point(linear(0, 255)).encode().is_some());
}

/// Every possible word is refused for its reserved bits, or encoding reproduces it.
#[test]
fn every_word_is_understood_or_refused() {
    let mut understood = 0;
    for word in 0..=u16::MAX {
        for values in [&[][..], &[-1], &[7, -8], &[1, 2, 3]] {
            match Record::decode(word, values) {
                Ok(record) => {
                    understood += 1;
                    let words = record.encode().unwrap();
                    assert_eq!((words.word(), words.values()), (word, values));
                }
                Err(RecordError::ReservedBits { word: named, bits }) => {
                    assert_eq!((named & bits, bits != 0), (bits, true));
                }
                Err(RecordError::BehindCommand { values: count }) => {
                    assert_eq!((count, word >> 15, count > 0), (values.len(), 1, true));
                }
                Err(RecordError::OfPoint { values: count }) => {
                    assert_eq!((count, word >> 15, [1, 2].contains(&count)), (values.len(), 0, false));
                }
            }
        }
    }
    // 256 times, relative or not, with or without a velocity; 256 removals and one clearing.
    assert_eq!(understood, 256 * 2 * 2 + 256 + 1);
    assert_eq!(
        Record::decode(0x0900, &[0]).unwrap_err().to_string(),
        "bits 0x0900 of the word 0x0900 are reserved: send them as zero"
    );
    assert_eq!(
        Record::decode(0x8000, &[5]).unwrap_err().to_string(),
        "`values` must be none behind a command, got 1: send the command as a separate word"
    );
    assert_eq!(
        Record::decode(0x000A, &[]).unwrap_err().to_string(),
        "`values` must be 1 or 2, got 0: send the position and, for a cubic approach, the velocity"
    );
}
