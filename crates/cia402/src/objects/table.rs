//! The table of the objects.
use super::entry::{Access, Admitted, Contents, Entry, Mapping, ObjectDescription};
use super::pdo::{RPDO_MAPPINGS, RPDO_PARAMETERS, TPDO_MAPPINGS, TPDO_PARAMETERS, identifier};
use super::value::DataType::{self, Integer8, Integer16, Integer32, Unsigned8, Unsigned16, Unsigned32, Unsigned64};
use crate::Mode;
use crate::modulo::POSITIONING_OPTION_BITS;
use crate::units::POLARITY_BITS;

/// User-defined units of the factor group.
const POSITION: &str = "position unit";
const VELOCITY: &str = "velocity unit";
const ACCELERATION: &str = "acceleration unit";
const JERK: &str = "jerk unit";
/// Thousandths of the rated torque (6076h) and current (6075h).
const TORQUE: &str = "‰ of rated torque";
const CURRENT: &str = "‰ of rated current";
const MILLISECOND: &str = "ms";

/// Servo drive (bit 17) by the profile 402 (192h).
const DEVICE_TYPE: i64 = 0x0002_0192;

/// Values of 6060h: no mode yet, or a supported mode.
const MODES: [i64; Mode::ALL.len() + 1] = {
    let mut modes = [0; Mode::ALL.len() + 1];
    let mut at = 0;
    while at < Mode::ALL.len() {
        modes[at + 1] = Mode::ALL[at].code() as i64;
        at += 1;
    }
    modes
};

/// 6502h: bit n − 1 for the mode with code n.
const SUPPORTED_MODES: i64 = {
    let (mut bits, mut at) = (0, 0);
    while at < Mode::ALL.len() {
        bits |= 1 << (Mode::ALL[at].code() - 1);
        at += 1;
    }
    bits
};

/// Homing methods that 6098h takes and 60E3h lists.
///
/// 1 and 2: limit switch and index pulse; 3 to 6: home switch and index pulse; 7 to 14: home switch, limit switch and index pulse; 17 to
/// 30: the same without index pulse; 33 and 34: index pulse; 35 and 37: present position.
pub const HOMING_METHODS: &[i64] = &[
    1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 17, 18, 19, 20, 21, 22, 23, 24, 25, 26, 27, 28, 29, 30, 33, 34, 35,
    37,
];

/// 60E3h.
const SUPPORTED_METHODS: [Entry; HOMING_METHODS.len()] = {
    let mut entries = [constant(Integer8, 0).named("Supported homing method"); HOMING_METHODS.len()];
    let mut at = 0;
    while at < entries.len() {
        entries[at].default = HOMING_METHODS[at];
        at += 1;
    }
    entries
};

/// Every object, by index.
pub static OBJECTS: [ObjectDescription; 111] = [
    // Communication profile (CiA 301).
    variable(0x1000, "Device type", constant(Unsigned32, DEVICE_TYPE)),
    variable(0x1001, "Error register", actual(Unsigned8)),
    variable(0x1005, "COB-ID SYNC message", parameter(Unsigned32, 0x80)),
    text(0x1008, "Manufacturer device name", "servobench servo drive"),
    text(0x1009, "Manufacturer hardware version", "simulated"),
    text(0x100A, "Manufacturer software version", env!("CARGO_PKG_VERSION")),
    variable(0x1014, "COB-ID EMCY", parameter(Unsigned32, identifier(0x80))),
    variable(0x1017, "Producer heartbeat time", parameter(Unsigned16, 0).unit(MILLISECOND)),
    record(
        0x1018,
        "Identity object",
        &[
            constant(Unsigned32, 0).named("Vendor-ID"),
            constant(Unsigned32, 0).named("Product code"),
            constant(Unsigned32, 0).named("Revision number"),
            constant(Unsigned32, 0).named("Serial number"),
        ],
    ),
    record(
        0x1200,
        "SDO server parameter",
        &[
            constant(Unsigned32, identifier(0x600)).named("COB-ID client to server"),
            constant(Unsigned32, identifier(0x580)).named("COB-ID server to client"),
        ],
    ),
    // Process data objects.
    RPDO_PARAMETERS[0],
    RPDO_PARAMETERS[1],
    RPDO_PARAMETERS[2],
    RPDO_PARAMETERS[3],
    RPDO_PARAMETERS[4],
    RPDO_MAPPINGS[0],
    RPDO_MAPPINGS[1],
    RPDO_MAPPINGS[2],
    RPDO_MAPPINGS[3],
    RPDO_MAPPINGS[4],
    TPDO_PARAMETERS[0],
    TPDO_PARAMETERS[1],
    TPDO_PARAMETERS[2],
    TPDO_PARAMETERS[3],
    TPDO_PARAMETERS[4],
    TPDO_MAPPINGS[0],
    TPDO_MAPPINGS[1],
    TPDO_MAPPINGS[2],
    TPDO_MAPPINGS[3],
    TPDO_MAPPINGS[4],
    // Trajectory buffer.
    variable(
        0x2010,
        "IP move segment command",
        Entry { access: Access::WriteOnly, ..parameter(Unsigned64, 0).received() },
    ),
    variable(0x2011, "Trajectory buffer free count", actual(Unsigned16).unit("points")),
    variable(0x2012, "Trajectory buffer status", actual(Unsigned32)),
    // Power state machine and modes of operation.
    variable(0x603F, "Error code", actual(Unsigned16)),
    variable(0x6040, "Controlword", parameter(Unsigned16, 0).received()),
    variable(0x6041, "Statusword", actual(Unsigned16)),
    variable(0x605A, "Quick stop option code", parameter(Integer16, 2).within(0, 8)),
    variable(0x605B, "Shutdown option code", parameter(Integer16, 0).within(0, 1)),
    variable(0x605C, "Disable operation option code", parameter(Integer16, 1).within(0, 1)),
    variable(0x605D, "Halt option code", parameter(Integer16, 1).within(1, 4)),
    variable(0x605E, "Fault reaction option code", parameter(Integer16, 2).within(0, 4)),
    variable(0x6060, "Modes of operation", parameter(Integer8, 0).one_of(&MODES).received()),
    variable(0x6061, "Modes of operation display", actual(Integer8)),
    // Position control.
    variable(0x6062, "Position demand value", actual(Integer32).unit(POSITION)),
    variable(0x6063, "Position actual internal value", actual(Integer32).unit("increments")),
    variable(0x6064, "Position actual value", actual(Integer32).unit(POSITION)),
    variable(0x6065, "Following error window", parameter(Unsigned32, 0xFFFF_FFFF).at_least_one().unit(POSITION)),
    variable(0x6066, "Following error time out", parameter(Unsigned16, 0).unit(MILLISECOND)),
    variable(0x6067, "Position window", parameter(Unsigned32, 0xFFFF_FFFF).at_least_one().unit(POSITION)),
    variable(0x6068, "Position window time", parameter(Unsigned16, 0).unit(MILLISECOND)),
    // Velocity.
    variable(0x606B, "Velocity demand value", actual(Integer32).unit(VELOCITY)),
    variable(0x606C, "Velocity actual value", actual(Integer32).unit(VELOCITY)),
    variable(0x606D, "Velocity window", parameter(Unsigned16, 1).at_least_one().unit(VELOCITY)),
    variable(0x606E, "Velocity window time", parameter(Unsigned16, 0).unit(MILLISECOND)),
    variable(0x606F, "Velocity threshold", parameter(Unsigned16, 1).at_least_one().unit(VELOCITY)),
    variable(0x6070, "Velocity threshold time", parameter(Unsigned16, 0).unit(MILLISECOND)),
    // Torque.
    variable(0x6071, "Target torque", parameter(Integer16, 0).unit(TORQUE).received()),
    variable(0x6072, "Max torque", parameter(Unsigned16, 3_000).at_least_one().unit(TORQUE).received()),
    variable(0x6073, "Max current", parameter(Unsigned16, 3_000).unit(CURRENT)),
    variable(0x6074, "Torque demand", actual(Integer16).unit(TORQUE)),
    variable(0x6075, "Motor rated current", parameter(Unsigned32, 1_000).at_least_one().unit("mA").disabled_only()),
    variable(0x6076, "Motor rated torque", parameter(Unsigned32, 1_000).at_least_one().unit("mN·m").disabled_only()),
    variable(0x6077, "Torque actual value", actual(Integer16).unit(TORQUE)),
    variable(0x6078, "Current actual value", actual(Integer16).unit(CURRENT)),
    variable(0x6079, "DC link circuit voltage", actual(Unsigned32).unit("mV")),
    // Set-points and limits.
    variable(0x607A, "Target position", parameter(Integer32, 0).unit(POSITION).received()),
    array(
        0x607B,
        "Position range limit",
        &[
            position_limit(i32::MIN).named("Min position range limit").disabled_only(),
            position_limit(i32::MAX).named("Max position range limit").disabled_only(),
        ],
    ),
    variable(0x607C, "Home offset", parameter(Integer32, 0).unit(POSITION).received()),
    array(
        0x607D,
        "Software position limit",
        &[position_limit(i32::MIN).named("Min position limit"), position_limit(i32::MAX).named("Max position limit")],
    ),
    variable(0x607E, "Polarity", parameter(Unsigned8, 0).bits(POLARITY_BITS as u32).disabled_only()),
    variable(
        0x607F,
        "Max profile velocity",
        parameter(Unsigned32, 0xFFFF_FFFF).at_least_one().unit(VELOCITY).received(),
    ),
    variable(0x6080, "Max motor speed", parameter(Unsigned32, 0xFFFF_FFFF).at_least_one().unit("1/min")),
    variable(0x6081, "Profile velocity", parameter(Unsigned32, 1).at_least_one().unit(VELOCITY).received()),
    variable(0x6082, "End velocity", parameter(Unsigned32, 0).unit(VELOCITY).received()),
    variable(0x6083, "Profile acceleration", acceleration().received()),
    variable(0x6084, "Profile deceleration", acceleration().received()),
    variable(0x6085, "Quick stop deceleration", acceleration()),
    // Linear ramps, or jerk-limited ones.
    variable(0x6086, "Motion profile type", parameter(Integer16, 0).one_of(&[0, 3])),
    variable(
        0x6087,
        "Torque slope",
        parameter(Unsigned32, 1_000).at_least_one().unit("‰ of rated torque/s").received(),
    ),
    variable(0x6088, "Torque profile type", parameter(Integer16, 0).within(0, 0)),
    // Factor group.
    array(
        0x608F,
        "Position encoder resolution",
        &[factor().named("Encoder increments"), factor().named("Motor revolutions")],
    ),
    array(
        0x6091,
        "Gear ratio",
        &[factor().named("Motor shaft revolutions"), factor().named("Driving shaft revolutions")],
    ),
    array(
        0x6092,
        "Feed constant",
        &[factor().named("Feed").unit(POSITION), factor().named("Driving shaft revolutions")],
    ),
    array(0x6096, "Velocity factor", &[factor().named("Numerator"), factor().named("Divisor")]),
    // Homing.
    variable(0x6098, "Homing method", parameter(Integer8, 35).one_of(HOMING_METHODS).governs(Mode::Homing)),
    array(
        0x6099,
        "Homing speeds",
        &[
            parameter(Unsigned32, 1).at_least_one().unit(VELOCITY).named("Speed during search for switch"),
            parameter(Unsigned32, 1).at_least_one().unit(VELOCITY).named("Speed during search for zero"),
        ],
    ),
    variable(0x609A, "Homing acceleration", acceleration()),
    variable(0x60A3, "Profile jerk use", constant(Unsigned8, 1)),
    array(
        0x60A4,
        "Profile jerk",
        &[parameter(Unsigned32, 0xFFFF_FFFF).at_least_one().unit(JERK).received().named("Profile jerk 1")],
    ),
    // Offsets of the cyclic synchronous modes.
    variable(0x60B0, "Position offset", parameter(Integer32, 0).unit(POSITION).received()),
    variable(0x60B1, "Velocity offset", parameter(Integer32, 0).unit(VELOCITY).received()),
    variable(0x60B2, "Torque offset", parameter(Integer16, 0).unit(TORQUE).received()),
    // Touch probe.
    variable(0x60B8, "Touch probe function", parameter(Unsigned16, 0).received()),
    variable(0x60B9, "Touch probe status", actual(Unsigned16)),
    variable(0x60BA, "Touch probe 1 positive edge", actual(Integer32).unit(POSITION)),
    variable(0x60BB, "Touch probe 1 negative edge", actual(Integer32).unit(POSITION)),
    // Interpolated position; sub-modes and the additional records are those of Copley's drives.
    variable(
        0x60C0,
        "Interpolation sub mode select",
        parameter(Integer16, 0).within(-3, 0).governs(Mode::InterpolatedPosition),
    ),
    record(
        0x60C1,
        "Interpolation data record",
        &[
            parameter(Integer32, 0).unit("increments").received().named("Position"),
            parameter(Unsigned8, 0).unit(MILLISECOND).received().named("Time"),
            parameter(Integer32, 0).unit("0.1 increments/s").received().named("Velocity"),
        ],
    ),
    record(
        0x60C2,
        "Interpolation time period",
        &[
            parameter(Unsigned8, 1).at_least_one().unit("10^index s").named("Interpolation time period value"),
            parameter(Integer8, -3).within(-6, -3).named("Interpolation time index"),
        ],
    ),
    variable(0x60C5, "Max acceleration", acceleration()),
    variable(0x60C6, "Max deceleration", acceleration()),
    variable(
        0x60E0,
        "Positive torque limit value",
        parameter(Unsigned16, 3_000).at_least_one().unit(TORQUE).received(),
    ),
    variable(
        0x60E1,
        "Negative torque limit value",
        parameter(Unsigned16, 3_000).at_least_one().unit(TORQUE).received(),
    ),
    array(0x60E3, "Supported homing methods", &SUPPORTED_METHODS),
    variable(0x60F2, "Positioning option code", parameter(Unsigned16, 0).bits(POSITIONING_OPTION_BITS).received()),
    variable(0x60F4, "Following error actual value", actual(Integer32).unit(POSITION)),
    variable(0x60FC, "Position demand internal value", actual(Integer32).unit("increments")),
    variable(0x60FD, "Digital inputs", actual(Unsigned32)),
    array(
        0x60FE,
        "Digital outputs",
        &[
            parameter(Unsigned32, 0).received().named("Physical outputs"),
            parameter(Unsigned32, 0).received().named("Bit mask"),
        ],
    ),
    variable(0x60FF, "Target velocity", parameter(Integer32, 0).unit(VELOCITY).received()),
    variable(0x6502, "Supported drive modes", constant(Unsigned32, SUPPORTED_MODES)),
];

const fn variable(index: u16, name: &'static str, entry: Entry) -> ObjectDescription {
    ObjectDescription { index, name, contents: Contents::Variable(entry.named(name)) }
}

const fn text(index: u16, name: &'static str, text: &'static str) -> ObjectDescription {
    ObjectDescription { index, name, contents: Contents::Text(text) }
}

const fn array(index: u16, name: &'static str, entries: &'static [Entry]) -> ObjectDescription {
    ObjectDescription { index, name, contents: Contents::Array(entries) }
}

pub(super) const fn record(index: u16, name: &'static str, entries: &'static [Entry]) -> ObjectDescription {
    ObjectDescription { index, name, contents: Contents::Record(entries) }
}

/// An entry that the master reads and writes, with every value of its type.
pub(super) const fn parameter(data_type: DataType, default: i64) -> Entry {
    Entry {
        name: "",
        data_type,
        access: Access::ReadWrite,
        mapping: Mapping::No,
        default,
        admitted: Admitted::Any,
        unit: "",
        disabled_only: false,
        governs: None,
    }
}

/// An entry with a value from the drive.
const fn actual(data_type: DataType) -> Entry {
    Entry { access: Access::ReadOnly, mapping: Mapping::Transmit, ..parameter(data_type, 0) }
}

/// A constant entry.
pub(super) const fn constant(data_type: DataType, value: i64) -> Entry {
    Entry { access: Access::Constant, ..parameter(data_type, value) }
}

const fn position_limit(default: i32) -> Entry {
    parameter(Integer32, default as i64).unit(POSITION)
}

/// An acceleration, excluding zero, with which the velocity could never change.
const fn acceleration() -> Entry {
    parameter(Unsigned32, 0xFFFF_FFFF).at_least_one().unit(ACCELERATION)
}

/// Part of a fraction of the factor group.
const fn factor() -> Entry {
    parameter(Unsigned32, 1).at_least_one().disabled_only()
}
