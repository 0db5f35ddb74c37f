//! Values are read as they were written, by every interface.
use crate::object;
use servobench_cia402::objects::{
    Access, Contents, DataType, Dictionary, OBJECTS, ObjectDescription, Value, entry_of, parameter, signal,
};
use servobench_cia402::units::{FactorGroup, Object};
use servobench_cia402::{
    AbortCode, Actuals, Commands, Controlword, HaltOption, Mode, PowerParams, PowerState, QuickStopOption, StatusBit,
    Statusword,
};

const DISABLED: PowerState = PowerState::SwitchedOn;

fn write(dictionary: &mut Dictionary, at: Object, value: impl Into<Value>) {
    dictionary.write(at, value.into(), DISABLED).unwrap();
}

#[test]
fn a_new_dictionary_has_the_defaults_of_the_table() {
    let dictionary = Dictionary::new();
    for known in &OBJECTS {
        for (subindex, entry) in (known.first_subindex()..).zip(known.entries()) {
            let read = dictionary.read(object(known.index, subindex));
            if entry.access == Access::WriteOnly {
                assert!(read.is_err());
            } else {
                let value = read.unwrap();
                assert_eq!((value.number(), value.data_type()), (entry.default.into(), entry.data_type));
            }
        }
        if known.first_subindex() == 1 {
            let highest = u8::try_from(known.entries().len()).unwrap();
            assert_eq!(dictionary.read(object(known.index, 0)), Ok(Value::Unsigned8(highest)));
        }
    }
    assert_eq!(dictionary.power_params(), PowerParams::default());
    assert_eq!(dictionary.factor_group(), FactorGroup::default());
    assert_eq!(dictionary.mode(), None);
    assert_eq!(dictionary.position_range().length(), 1 << 32);
}

#[test]
fn each_value_has_its_own_place() {
    let mut dictionary = Dictionary::new();
    // A different number in each object, if the object accepts it.
    let mut written = vec![];
    for known in &OBJECTS {
        for (subindex, entry) in (known.first_subindex()..).zip(known.entries()) {
            let at = object(known.index, subindex);
            let own = i128::from(known.index) - 0x6000 + i128::from(subindex);
            let next = i128::from(entry.default) + 1;
            let taken = [own, next, next - 2, 0x40, 3].into_iter().find(|number| {
                dictionary.download(at, &number.to_le_bytes()[..entry.data_type.size()], DISABLED).is_ok()
            });
            written.extend(taken.filter(|_| entry.access.is_read()).map(|number| (at, number, entry.data_type)));
        }
    }
    // All but 2010h, which is not read, and 6088h, which has one value.
    let writable = OBJECTS.iter().flat_map(ObjectDescription::entries).filter(|entry| entry.access.is_written());
    assert_eq!(written.len(), writable.count() - 2, "{written:?}");
    for (at, number, data_type) in written {
        let bytes = &number.to_le_bytes()[..data_type.size()];
        assert_eq!(dictionary.read(at).ok(), Value::of_bytes(data_type, bytes), "{at}");
    }
}

/// A string is read as bytes, in full; it is not a number and cannot be written.
#[test]
fn a_string_is_read_as_bytes() {
    let mut dictionary = Dictionary::new();
    let name = object(0x1008, 0);
    assert_eq!(dictionary.upload(name).unwrap().as_ref(), b"servobench servo drive");
    let message = dictionary.read(name).unwrap_err().to_string();
    assert_eq!(message, "`Manufacturer device name` (1008h:00h) is a string, not a number: upload its bytes");
    assert_eq!(dictionary.download(name, b"other", DISABLED).unwrap_err().abort_code(), AbortCode::ReadOnly);
    assert_eq!(dictionary.upload(object(0x1008, 1)).unwrap_err().abort_code(), AbortCode::NoSubindex);
    for known in &OBJECTS {
        if let Contents::Text(text) = known.contents {
            let read = dictionary.upload(object(known.index, 0)).unwrap();
            assert!(read.as_ref() == text.as_bytes() && text.is_ascii() && !text.contains('"'), "{text}");
        }
    }
}

#[test]
fn bytes_and_values_are_one() {
    let mut dictionary = Dictionary::new();
    dictionary.download(object(0x607A, 0), &[0xFE, 0xFF, 0xFF, 0xFF], DISABLED).unwrap();
    assert_eq!(dictionary.signal(signal::TARGET_POSITION), -2);
    assert_eq!(dictionary.read(object(0x607A, 0)), Ok(Value::Integer32(-2)));
    assert_eq!(dictionary.upload(object(0x607A, 0)).unwrap().as_ref(), [0xFE, 0xFF, 0xFF, 0xFF]);
    assert_eq!(dictionary.upload(object(0x6091, 0)).unwrap().as_ref(), [2]);
    dictionary.download(object(0x2010, 0), &[1, 2, 3, 4, 5, 6, 7, 0x80], DISABLED).unwrap();
    assert_eq!(dictionary.signal(signal::IP_MOVE_SEGMENT_COMMAND).to_le_bytes(), [1, 2, 3, 4, 5, 6, 7, 0x80]);
}

#[test]
fn numbers_are_written_as_their_object_has_them() {
    let mut dictionary = Dictionary::new();
    let mut write =
        |index, number| dictionary.write_number(object(index, 0), number, DISABLED).map_err(|r| r.to_string());
    assert_eq!(write(0x607A, -7), Ok(()));
    assert_eq!(write(0x6065, 4_294_967_295), Ok(()));
    let message = "`Following error window` (6065h:00h) must be at most 4294967295, got 4294967296";
    assert_eq!(write(0x6065, 4_294_967_296).unwrap_err(), message);
    assert_eq!(write(0x6040, -1).unwrap_err(), "`Controlword` (6040h:00h) must be at least 0, got -1");
    assert_eq!(write(0x605A, 9).unwrap_err(), "`Quick stop option code` (605Ah:00h) must be at most 8, got 9");
    assert_eq!(dictionary.signal(signal::TARGET_POSITION), -7);
    assert_eq!(entry_of(object(0x6091, 2)).unwrap().name, "Driving shaft revolutions");
    assert!(entry_of(object(0x6091, 0)).is_none() && entry_of(object(0x6091, 3)).is_none());
}

#[test]
fn the_drive_sees_what_the_master_wrote() {
    let mut dictionary = Dictionary::new();
    write(&mut dictionary, object(0x605A, 0), 6_i16);
    write(&mut dictionary, object(0x605D, 0), 2_i16);
    write(&mut dictionary, object(0x6060, 0), 8_i8);
    write(&mut dictionary, object(0x608F, 1), 1_u32 << 20);
    write(&mut dictionary, object(0x6091, 1), 7_u32);
    write(&mut dictionary, object(0x6091, 2), 2_u32);
    write(&mut dictionary, object(0x6092, 1), 5_000_u32);
    write(&mut dictionary, object(0x6096, 1), 60_u32);
    write(&mut dictionary, object(0x607E, 0), 0xC0_u8);
    write(&mut dictionary, object(0x607B, 1), 0_i32);
    write(&mut dictionary, object(0x607B, 2), 359_i32);
    let params = dictionary.power_params();
    assert_eq!((params.quick_stop, params.halt), (QuickStopOption::QuickStopRampAndStay, HaltOption::QuickStopRamp));
    assert_eq!(dictionary.mode(), Some(Mode::CyclicSynchronousPosition));
    let group = dictionary.factor_group();
    assert_eq!((group.position_encoder_resolution, group.gear_ratio), ([1 << 20, 1], [7, 2]));
    assert_eq!((group.feed_constant, group.velocity_factor, group.polarity), ([5_000, 1], [60, 1], 0xC0));
    assert_eq!((dictionary.position_range().min(), dictionary.position_range().length()), (0, 360));
}

#[test]
fn the_generation_counts_what_the_master_wrote_and_nothing_else() {
    let mut dictionary = Dictionary::new();
    let start = dictionary.generation();
    dictionary.set(signal::STATUSWORD, 0x0237);
    dictionary.mirror(&Commands::default(), &Actuals::default());
    assert!(dictionary.write(object(0x6041, 0), Value::Unsigned16(0), DISABLED).is_err());
    assert!(dictionary.write(object(0x605B, 0), Value::Integer16(7), DISABLED).is_err());
    assert_eq!(dictionary.generation(), start);
    write(&mut dictionary, object(0x6065, 0), 1_u32);
    assert_ne!(dictionary.generation(), start);
    assert_eq!(dictionary.get(parameter::FOLLOWING_ERROR_WINDOW), 1);
}

#[test]
fn process_data_are_read_by_sdo_too() {
    let mut dictionary = Dictionary::new();
    let commands = Commands {
        controlword: Controlword::from_bits(0x001F),
        mode: 9,
        target_position: -1,
        target_velocity: i32::MIN,
        target_torque: -3,
        position_offset: -2,
        velocity_offset: 4,
        torque_offset: -5,
        touch_probe_function: 0x0011,
        max_torque: Some(1_234),
        digital_outputs: 0x8000_0001,
        ..Commands::default()
    };
    let actuals = Actuals {
        statusword: Statusword::of(PowerState::Fault).with(StatusBit::Remote, true),
        mode: 9,
        position: 6,
        position_high: 0,
        position_demand: 10,
        position_demand_high: 0,
        velocity: -7,
        torque: 8,
        following_error: -9,
        error_code: 0x8611,
        digital_inputs: 5,
        buffer_free: 32,
        buffer_status: 0x8000_0000,
        touch_probe_status: 3,
        touch_probe_positions: [-11, 12],
    };
    dictionary.mirror(&commands, &actuals);
    let expected = [
        (0x6040, 0x1F),
        (0x6060, 9),
        (0x607A, -1),
        (0x60FF, i32::MIN.into()),
        (0x6071, -3),
        (0x6072, 1_234),
        (0x60B0, -2),
        (0x60B1, 4),
        (0x60B2, -5),
        (0x6041, 0x0208),
        (0x6061, 9),
        (0x6062, 10),
        (0x6064, 6),
        (0x606C, -7),
        (0x6077, 8),
        (0x60F4, -9),
        (0x603F, 0x8611),
        (0x1001, 0x21),
        (0x60FD, 5),
        (0x2011, 32),
        (0x2012, 0x8000_0000),
        (0x60B8, 0x0011),
        (0x60B9, 3),
        (0x60BA, -11),
        (0x60BB, 12),
    ];
    for (index, number) in expected {
        assert_eq!(dictionary.read(object(index, 0)).unwrap().number(), number, "{index:04X}h");
    }
    assert_eq!(dictionary.read(object(0x60FE, 1)).unwrap().number(), 0x8000_0001);
    // A mode that the drive does not support does not count as requested.
    dictionary.mirror(&Commands { mode: 2, ..commands }, &actuals);
    assert_eq!(dictionary.read(object(0x6060, 0)).unwrap(), Value::Integer8(9));
}

#[test]
fn types_are_named_as_in_the_standard() {
    let names: Vec<_> = DataType::ALL.iter().map(|data_type| (data_type.code(), data_type.name())).collect();
    assert_eq!(names[..3], [(2, "INTEGER8"), (3, "INTEGER16"), (4, "INTEGER32")]);
    assert_eq!(names[3..6], [(5, "UNSIGNED8"), (6, "UNSIGNED16"), (7, "UNSIGNED32")]);
}

#[test]
fn what_the_drive_presets_is_not_written_by_the_master() {
    let mut dictionary = Dictionary::new();
    let (window, signal) = (object(0x606D, 0), object(0x6041, 0));
    dictionary.preset(window, 40_u16.into()).unwrap();
    assert_eq!(dictionary.read(window), Ok(40_u16.into()));
    assert!(!dictionary.is_written(window) && dictionary.generation() == 0);
    assert!(dictionary.preset(window, 0_u16.into()).is_err(), "below its range");
    assert!(dictionary.preset(window, 1_u32.into()).is_err(), "of another type");
    assert!(dictionary.preset(signal, 1_u16.into()).is_err(), "read only");
    assert!(dictionary.write(window, 0_u16.into(), DISABLED).is_err() && !dictionary.is_written(window));
    write(&mut dictionary, window, 40_u16);
    assert!(dictionary.is_written(window) && !dictionary.is_written(object(0x606F, 0)));
    dictionary.preset(window, 40_u16.into()).unwrap();
    assert!(!dictionary.is_written(window));
}
