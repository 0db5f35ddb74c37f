//! Points in every form that a master can write.
use servobench_cia402::interpolated::SegmentCommand;
use servobench_cia402::interpolated::serial::Record;
use servobench_fuzz::{check, fuzz, produce};

/// Half of the words without reserved bits, so that many are points.
#[test]
fn records() {
    let values = produce::<Vec<i32>>().with().len(0..4_usize);
    fuzz(check!(), 20_000, (produce::<u16>(), produce::<bool>(), values), |(word, plain, values)| {
        let word = if *plain { word & 0x10FF } else { *word };
        match Record::decode(word, values) {
            Ok(record) => {
                let words = record.encode().expect("whole milliseconds");
                assert_eq!((words.word(), words.values()), (word, &values[..]), "{record:?}");
            }
            Err(error) => assert!(error.to_string().len() > 20, "{error}"),
        }
    });
}

/// A decoded command encodes to bytes of the same meaning, though they may differ.
#[test]
fn move_segment_commands() {
    fuzz(check!(), 20_000, produce::<[u8; 8]>(), |bytes| match SegmentCommand::decode(*bytes) {
        Ok(command) => {
            let bytes = command.encode().expect("what eight bytes said");
            assert_eq!(SegmentCommand::decode(bytes), Ok(command));
        }
        Err(error) => assert!(error.to_string().len() > 20, "{error}"),
    });
}
