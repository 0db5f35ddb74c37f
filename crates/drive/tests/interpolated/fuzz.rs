//! Random words and bytes into every object and parameter that takes points, and random controlwords.
use crate::axis::Axis;
use servobench_cia402::Controlword;
use servobench_cia402::interpolated::{CAPACITY, SegmentCommand, SubMode, TimePeriod};
use servobench_drive::modes::interpolated::DataRecord;
use servobench_drive::modes::interpolated::serial::Port;
use servobench_fuzz::{ValueGenerator, check, fuzz, produce};

/// Action of a master between two steps.
#[derive(Debug, Clone)]
enum Act {
    Segment([u8; 8]),
    Record(u8, i32),
    Write(u16, u16, Vec<i32>),
    Command(u8),
    Controlword(u16),
    Steps(u8),
}

type Raw = (u8, [u8; 8], [i32; 2], u16);

fn acts() -> impl ValueGenerator<Output = Vec<Act>> {
    produce::<Vec<Raw>>().with().len(0..60_usize).map_gen(|raw| raw.into_iter().map(act).collect())
}

/// Makes an action of random numbers, half of them sensible, so that moves happen.
fn act((kind, bytes, values, word): Raw) -> Act {
    match kind % 10 {
        0 => Act::Segment(bytes),
        1 => Act::Segment([bytes[0] & 0x17, 1 + bytes[1] % 20, bytes[2], bytes[3], 0, bytes[4], bytes[5], 0]),
        2 => Act::Record(bytes[0] % 5, values[0]),
        3 => Act::Record(1 + bytes[0] % 3, values[0] >> 20),
        4 => Act::Write(word, bytes[0].into(), values.to_vec()),
        5 => Act::Write(0x115, word & 0x910F, values[..usize::from(bytes[0] % 3)].to_vec()),
        6 => Act::Command(17 + bytes[0] % 2),
        7 => Act::Controlword(word),
        8 => Act::Controlword(if bytes[0].is_multiple_of(2) { 0x0F } else { 0x1F }),
        _ => Act::Steps(bytes[0]),
    }
}

#[test]
fn trajectory_buffer() {
    let requests = (0..4_usize, 1..=255_u8, -6..=-3_i8, acts());
    fuzz(check!(), 2_000, requests, |(sub_mode, units, index, acts)| {
        let (sub_mode, period) = (SubMode::ALL[*sub_mode], TimePeriod::new(*units, *index).unwrap());
        let mut axis = Axis::at(0, sub_mode);
        axis.params.period = period;
        let (mut record, mut port, mut word) = (DataRecord::default(), Port::default(), Controlword::default());
        port.write(&mut axis.buffer, 0xC8, 3, &[]).unwrap();
        for act in acts {
            let refused = match act {
                Act::Segment(bytes) => match SegmentCommand::decode(*bytes) {
                    Ok(command) => axis.buffer.apply(command).err().map(|error| error.to_string()),
                    Err(error) => Some(error.to_string()),
                },
                Act::Record(sub_index, value) => {
                    let written = record.write(sub_mode, period, &mut axis.buffer, *sub_index, *value);
                    written.err().map(|error| error.to_string())
                }
                Act::Write(parameter, word, values) => {
                    let written = port.write(&mut axis.buffer, *parameter, *word, values);
                    written.err().map(|error| error.to_string())
                }
                Act::Command(op_code) => port.command(&mut axis.buffer, *op_code).err().map(|error| error.to_string()),
                Act::Controlword(bits) => {
                    word = Controlword::from_bits(*bits);
                    None
                }
                Act::Steps(steps) => {
                    for _ in 0..*steps {
                        let now = axis.step(word);
                        assert!([now.x, now.v, now.a, now.j, now.s].iter().all(|value| value.is_finite()), "{now:?}");
                    }
                    None
                }
            };
            assert!(refused.is_none_or(|words| words.len() > 20));
            let status = axis.buffer.status();
            let free = usize::try_from(status >> 16 & 0xFF).unwrap();
            assert!(free <= CAPACITY && (free == CAPACITY) == (status >> 31 == 1));
        }
    });
}
