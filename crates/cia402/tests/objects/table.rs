//! The table against lists copied from published data sheets.
use servobench_cia402::objects::{Access, Admitted, Contents, DataType, Entry, HOMING_METHODS, Mapping, OBJECTS};
use servobench_cia402::{
    DisableOperationOption, FaultReactionOption, HaltOption, Mode, QuickStopOption, ShutdownOption,
};

fn entries() -> impl Iterator<Item = (u16, &'static Entry)> {
    OBJECTS.iter().flat_map(|object| object.entries().iter().map(|entry| (object.index, entry)))
}

fn entry(index: u16) -> &'static Entry {
    entries().find(|(known, _)| *known == index).unwrap().1
}

#[test]
fn objects_are_in_the_order_of_their_index() {
    assert!(OBJECTS.is_sorted_by(|before, after| before.index < after.index));
}

#[test]
fn every_object_that_a_master_needs_is_there() {
    let needed = [
        0x1000, 0x1001, 0x1018, 0x2010, 0x2011, 0x2012, 0x603F, 0x6040, 0x6041, 0x60A4, 0x60B0, 0x60B1, 0x60B2, 0x60C0,
        0x60C1, 0x60C2, 0x60C5, 0x60C6, 0x60E0, 0x60E1, 0x60E3, 0x60F2, 0x60F4, 0x60FD, 0x60FE, 0x60FF, 0x6502,
    ];
    let ranges = [
        0x605A..=0x605E,
        0x6060..=0x6068,
        0x606B..=0x6077,
        0x607A..=0x607F,
        0x6080..=0x6088,
        0x608F..=0x608F,
        0x6091..=0x6092,
        0x6096..=0x6096,
        0x6098..=0x609A,
    ];
    for index in needed.into_iter().chain(ranges.into_iter().flatten()) {
        assert!(OBJECTS.iter().any(|object| object.index == index), "{index:04X}h");
    }
}

#[test]
fn option_codes_are_those_of_the_power_state_machine() {
    let accepted = [
        (0x605A, QuickStopOption::CODES, QuickStopOption::default().code()),
        (0x605B, ShutdownOption::CODES, ShutdownOption::default().code()),
        (0x605C, DisableOperationOption::CODES, DisableOperationOption::default().code()),
        (0x605D, HaltOption::CODES, HaltOption::default().code()),
        (0x605E, FaultReactionOption::CODES, FaultReactionOption::default().code()),
    ];
    for (index, codes, default) in accepted {
        let taken: Vec<i16> = (i16::MIN..=i16::MAX)
            .filter(|code| {
                entry(index).range().is_some_and(|(lowest, highest)| (lowest..=highest).contains(&i64::from(*code)))
            })
            .collect();
        assert_eq!(taken, codes, "{index:04X}h");
        assert_eq!(entry(index).default, i64::from(default), "{index:04X}h");
    }
}

#[test]
fn modes_are_taken_and_told_as_the_profile_numbers_them() {
    let Admitted::OneOf(accepted) = entry(0x6060).admitted else { panic!("6060h takes a list") };
    assert_eq!(accepted, [0, 1, 3, 4, 6, 7, 8, 9, 10]);
    // pp, pv, tq, hm, ip, csp, csv, cst in bits 0, 2, 3, 5, 6, 7, 8, 9: CiA 402-2, 6502h.
    assert_eq!(entry(0x6502).default, 0b11_1110_1101);
    assert_eq!(accepted.len(), Mode::ALL.len() + 1);
}

#[test]
fn homing_methods_told_are_those_taken() {
    let told: Vec<i64> = entries().filter(|(index, _)| *index == 0x60E3).map(|(_, entry)| entry.default).collect();
    assert_eq!(told, HOMING_METHODS);
    assert_eq!(entry(0x6098).admitted, Admitted::OneOf(HOMING_METHODS));
    // 15, 16, 31, 32 and 36 are reserved.
    assert!([15, 16, 31, 32, 36].iter().all(|reserved| !HOMING_METHODS.contains(reserved)));
}

/// Types as in the data sheets of drives: index, number of sub-indices above 00h, types.
const TYPES: [(u16, &[DataType]); 30] = {
    use DataType::{Integer8, Integer16, Integer32, Unsigned8, Unsigned16, Unsigned32, Unsigned64};
    [
        (0x1000, &[Unsigned32]),
        (0x1001, &[Unsigned8]),
        (0x1018, &[Unsigned32; 4]),
        (0x2010, &[Unsigned64]),
        (0x2011, &[Unsigned16]),
        (0x603F, &[Unsigned16]),
        (0x6040, &[Unsigned16]),
        (0x605A, &[Integer16]),
        (0x6060, &[Integer8]),
        (0x6064, &[Integer32]),
        (0x6065, &[Unsigned32]),
        (0x6066, &[Unsigned16]),
        (0x606C, &[Integer32]),
        (0x606D, &[Unsigned16]),
        (0x6071, &[Integer16]),
        (0x6072, &[Unsigned16]),
        (0x6076, &[Unsigned32]),
        (0x6077, &[Integer16]),
        (0x607B, &[Integer32; 2]),
        (0x607E, &[Unsigned8]),
        (0x6085, &[Unsigned32]),
        (0x6086, &[Integer16]),
        (0x6091, &[Unsigned32; 2]),
        (0x6098, &[Integer8]),
        (0x6099, &[Unsigned32; 2]),
        (0x60B2, &[Integer16]),
        (0x60C1, &[Integer32, Unsigned8, Integer32]),
        (0x60C2, &[Unsigned8, Integer8]),
        (0x60E0, &[Unsigned16]),
        (0x60FD, &[Unsigned32]),
    ]
};

#[test]
fn types_are_those_of_published_data_sheets() {
    for (index, types) in TYPES {
        let known: Vec<DataType> = entries().filter(|(at, _)| *at == index).map(|(_, entry)| entry.data_type).collect();
        assert_eq!(known, types, "{index:04X}h");
    }
}

#[test]
fn what_the_table_says_goes_together() {
    for (index, entry) in entries() {
        let (lowest, highest) = (entry.data_type.lowest(), entry.data_type.highest());
        let fits = |value: i64| (lowest..=highest).contains(&i128::from(value));
        assert!(fits(entry.default), "{index:04X}h");
        let takes_its_default = match entry.admitted {
            Admitted::Any => true,
            Admitted::Range(first, last) => {
                assert!(fits(first) && fits(last), "{index:04X}h");
                (first..=last).contains(&entry.default)
            }
            Admitted::OneOf(accepted) => {
                assert!(accepted.iter().all(|value| fits(*value)), "{index:04X}h");
                accepted.contains(&entry.default)
            }
            Admitted::Bits(bits) => {
                assert!(fits(i64::from(bits)), "{index:04X}h");
                entry.default & !i64::from(bits) == 0
            }
        };
        assert!(takes_its_default, "{index:04X}h");
        match entry.mapping {
            Mapping::Receive => assert!(entry.access.is_written(), "{index:04X}h"),
            Mapping::Transmit => assert!(entry.access.is_read(), "{index:04X}h"),
            Mapping::No => {}
        }
        assert!(!entry.disabled_only || entry.access == Access::ReadWrite, "{index:04X}h");
        // As JSON and EDS write them without escapes.
        assert!(!entry.name.is_empty() && !entry.name.contains(['"', '\\', '\n', '=', ';']), "{index:04X}h");
    }
}

#[test]
fn a_variable_is_named_once() {
    for object in &OBJECTS {
        if let Contents::Variable(entry) = object.contents {
            assert_eq!(entry.name, object.name);
        }
    }
}

/// Oracle: the default mapping of CiA 402 as in drives (Kollmorgen S300, *CANopen*, 5.3.1.3 and 5.3.2.3; Erl, *PDO mapping*),
/// and the identifiers of CiA 301, section 7.3.5, table 39.
#[test]
fn process_data_objects_are_those_of_the_profile() {
    let defaults = |index: u16| -> Vec<i64> {
        entries().filter(|(known, _)| *known == index).map(|(_, entry)| entry.default).collect()
    };
    let mapped = [
        ([0x201, 255], vec![0x6040_0010]),
        ([0x301, 255], vec![0x6040_0010, 0x6060_0008]),
        ([0x401, 255], vec![0x6040_0010, 0x607A_0020]),
        ([0x501, 255], vec![0x6040_0010, 0x60FF_0020]),
        ([0x8000_0000, 255], vec![0x6040_0010, 0x6071_0010]),
        ([0x4000_0181, 255], vec![0x6041_0010]),
        ([0x4000_0281, 255], vec![0x6041_0010, 0x6061_0008]),
        ([0x4000_0381, 255], vec![0x6041_0010, 0x6064_0020]),
        ([0x4000_0481, 255], vec![0x6041_0010, 0x606C_0020]),
        ([0xC000_0000, 255], vec![0x6041_0010, 0x6077_0010]),
    ];
    let indices = (0x1400..0x1405).chain(0x1800..0x1805);
    for (index, (parameters, mapping)) in indices.zip(mapped) {
        assert_eq!(defaults(index), parameters, "{index:04X}h");
        assert_eq!(defaults(index + 0x200), mapping, "{:04X}h", index + 0x200);
        let direction = if index < 0x1800 { Mapping::Receive } else { Mapping::Transmit };
        for object in mapping {
            let entry = entry(u16::try_from(object >> 16).unwrap());
            assert_eq!(
                (entry.mapping, 8 * entry.data_type.size()),
                (direction, usize::try_from(object & 0xFF).unwrap()),
                "{object:08X}h"
            );
        }
    }
}
