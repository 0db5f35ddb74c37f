//! The process data objects (PDO) of a drive on CANopen: the pairs that CiA 402 defines for the kinds of modes.
//!
//! | PDO | received | transmitted |
//! |---|---|---|
//! | 1 | controlword | statusword |
//! | 2 | and mode of operation | and its display |
//! | 3 | and target position | and position |
//! | 4 | and target velocity | and velocity |
//! | 5 | and target torque | and torque |
//!
//! The mapping is static. PDO 1 to 4 have the identifiers of the predefined connection set (CiA 301, section 7.3.5); the fifth pair has
//! none there and is not valid until it gets one.
use super::entry::{Entry, ObjectDescription};
use super::table::{constant, parameter, record};
use super::value::DataType::{self, Integer8, Integer16, Integer32, Unsigned8, Unsigned16, Unsigned32};

/// Node-ID of the drive: that of a single device with its master. A data sheet leaves it open.
pub const NODE_ID: u8 = 1;

/// Bits of an identifier (CiA 301, 1400h:01h and 1800h:01h): the PDO does not exist, and cannot be requested by a remote frame.
const NOT_VALID: i64 = 1 << 31;
const NO_REMOTE_FRAME: i64 = 1 << 30;
/// Transmitted and accepted at every event (device profile).
const EVENT_DRIVEN: i64 = 255;

/// Declares the two objects of each PDO: its number, its identifier, its mapped objects.
macro_rules! pdos {
    ($kind:literal, $parameters:ident at $first_parameters:literal, $mappings:ident at $first_mapping:literal;
     $($number:literal: $identifier:expr, [$($index:literal $data_type:ident),*];)*) => {
        /// Communication parameters.
        pub(super) static $parameters: [ObjectDescription; 5] = [$(record(
            $first_parameters + $number - 1,
            concat!($kind, " ", $number, " communication parameter"),
            &[
                parameter(Unsigned32, $identifier).named(concat!("COB-ID used by ", $kind)),
                constant(Unsigned8, EVENT_DRIVEN).named("Transmission type"),
            ],
        )),*];

        /// Mapping parameters.
        pub(super) static $mappings: [ObjectDescription; 5] = [$(record(
            $first_mapping + $number - 1,
            concat!($kind, " ", $number, " mapping parameter"),
            &[$(mapped($index, $data_type)),*],
        )),*];
    };
}

pdos! { "RPDO", RPDO_PARAMETERS at 0x1400, RPDO_MAPPINGS at 0x1600;
    1: identifier(0x200), [0x6040 Unsigned16];
    2: identifier(0x300), [0x6040 Unsigned16, 0x6060 Integer8];
    3: identifier(0x400), [0x6040 Unsigned16, 0x607A Integer32];
    4: identifier(0x500), [0x6040 Unsigned16, 0x60FF Integer32];
    5: NOT_VALID, [0x6040 Unsigned16, 0x6071 Integer16];
}

pdos! { "TPDO", TPDO_PARAMETERS at 0x1800, TPDO_MAPPINGS at 0x1A00;
    1: NO_REMOTE_FRAME | identifier(0x180), [0x6041 Unsigned16];
    2: NO_REMOTE_FRAME | identifier(0x280), [0x6041 Unsigned16, 0x6061 Integer8];
    3: NO_REMOTE_FRAME | identifier(0x380), [0x6041 Unsigned16, 0x6064 Integer32];
    4: NO_REMOTE_FRAME | identifier(0x480), [0x6041 Unsigned16, 0x606C Integer32];
    5: NO_REMOTE_FRAME | NOT_VALID, [0x6041 Unsigned16, 0x6077 Integer16];
}

/// Identifier of the predefined connection set.
pub(super) const fn identifier(base: i64) -> i64 {
    base + NODE_ID as i64
}

/// An object in a mapping: index, sub-index 00h, and length in bits.
const fn mapped(index: i64, data_type: DataType) -> Entry {
    #[expect(clippy::cast_possible_wrap, reason = "8 at most")]
    let bits = 8 * data_type.size() as i64;
    constant(Unsigned32, (index << 16) | bits).named("Application object")
}

/// Number that a data sheet adds to the node-ID of a device for the identifier of a PDO, of EMCY or of SDO, if `index` and `subindex` are
/// one and `value` includes a node-ID.
pub(super) const fn without_node_id(index: u16, subindex: u8, value: i64) -> Option<i64> {
    let is_identifier = matches!(
        (index, subindex),
        (0x1014, 0) | (0x1200, 1 | 2) | (0x1400..=0x15FF | 0x1800..=0x19FF, 1)
    );
    if is_identifier && value & NOT_VALID == 0 { Some(value - NODE_ID as i64) } else { None }
}
