//! Random writes to the object dictionary.
use servobench_cia402::objects::{Admitted, Dictionary, Entry, OBJECTS, Value};
use servobench_cia402::units::{AxisUnit, Object, Ratio};
use servobench_cia402::{AbortCode, PowerState};
use servobench_fuzz::{ValueGenerator, check, fuzz, produce};

/// One write: mostly to an object that exists, mostly as long as its type.
#[derive(Debug, Clone)]
struct Write {
    object: Object,
    bytes: Vec<u8>,
    state: PowerState,
}

/// Makes a write of random numbers.
fn write((index, subindex, is_known, number, length, state): (u16, u8, bool, i64, u8, u8)) -> Write {
    let known = &OBJECTS[usize::from(index) % OBJECTS.len()];
    let first = known.first_subindex();
    let known_subindex = subindex % (known.highest_subindex() + 1);
    let object =
        if is_known { Object { index: known.index, subindex: known_subindex } } else { Object { index, subindex } };
    // Small numbers are more often in a range than large ones.
    let number = number >> (length & 63);
    let size = match known.entries().get(usize::from(known_subindex.saturating_sub(first))) {
        Some(entry) if length < 200 => entry.data_type.size(),
        _ => usize::from(length % 10),
    };
    let bytes = i128::from(number).to_le_bytes()[..size].to_vec();
    Write { object, bytes, state: PowerState::ALL[usize::from(state) % PowerState::ALL.len()] }
}

#[test]
fn writes() {
    let sequences = produce::<Vec<_>>().map_gen(|numbers| numbers.into_iter().map(write).collect::<Vec<_>>());
    fuzz(check!(), 2_000, sequences, |writes: &Vec<Write>| {
        let mut dictionary = Dictionary::new();
        for Write { object, bytes, state } in writes {
            let before = dictionary.clone();
            match dictionary.download(*object, bytes, *state) {
                Ok(()) => {
                    assert_ne!(dictionary.generation(), before.generation());
                    match dictionary.upload(*object) {
                        Ok(read) => assert_eq!(read.as_ref(), bytes.as_slice()),
                        Err(refused) => assert_eq!(refused.abort_code(), AbortCode::WriteOnly),
                    }
                }
                Err(refused) => {
                    assert_eq!(dictionary, before);
                    assert!(!refused.to_string().is_empty());
                }
            }
        }
        assert_sound(&dictionary);
    });
}

/// Checks that every object accepts its value, and that the views read by the drive are valid.
fn assert_sound(dictionary: &Dictionary) {
    for known in &OBJECTS {
        for (subindex, entry) in (known.first_subindex()..).zip(known.entries()) {
            if let Ok(value) = dictionary.read(Object { index: known.index, subindex }) {
                assert!(is_taken(entry, value), "{:04X}h:{subindex} = {value}", known.index);
            }
        }
    }
    let bounds = |index| [1, 2].map(|subindex| dictionary.read(Object { index, subindex }).unwrap().number());
    let ([min, max], [lowest, highest]) = (bounds(0x607B), bounds(0x607D));
    assert!(min < max && lowest < highest);
    assert_eq!(i128::from(dictionary.position_range().length()), max - min + 1);
    assert!(dictionary.factor_group().scaling(AxisUnit::Metre(Ratio::ONE)).is_ok());
    let codes = dictionary.power_params();
    let told = [0x605A, 0x605B, 0x605C, 0x605D, 0x605E]
        .map(|index| dictionary.read(Object { index, subindex: 0 }).unwrap().number());
    let taken = [
        codes.quick_stop.code(),
        codes.shutdown.code(),
        codes.disable_operation.code(),
        codes.halt.code(),
        codes.fault_reaction.code(),
    ];
    assert_eq!(taken.map(i128::from), told);
}

/// The table read a second time.
fn is_taken(entry: &Entry, value: Value) -> bool {
    let number = value.number();
    value.data_type() == entry.data_type
        && match entry.admitted {
            Admitted::Any => true,
            Admitted::Range(lowest, highest) => i128::from(lowest) <= number && number <= i128::from(highest),
            Admitted::OneOf(accepted) => accepted.iter().any(|one| i128::from(*one) == number),
            Admitted::Bits(bits) => number >= 0 && number <= i128::from(bits) && number & i128::from(bits) == number,
        }
}
