//! Places of the values of entries, which the drive's side knows by name, found at compile time.
use super::entry::{Access, Admitted, Entry, ObjectDescription};
use super::table::OBJECTS;
use super::value::Stored;
use crate::SdoError;
use crate::units::Object;
use core::marker::PhantomData;

/// Number of values; sub-indices 00h of arrays and records are not among them, as they follow from the table.
pub(super) const PLACES: usize = FIRST_PLACES[OBJECTS.len()];

/// Place of the first entry of each object, and the number of places.
const FIRST_PLACES: [usize; OBJECTS.len() + 1] = {
    let mut places = [0; OBJECTS.len() + 1];
    let mut at = 0;
    while at < OBJECTS.len() {
        places[at + 1] = places[at] + OBJECTS[at].entries().len();
        at += 1;
    }
    places
};

/// Result of looking up an index and sub-index.
#[derive(Debug, Clone, Copy)]
pub(super) enum Found {
    /// Sub-index 00h of an array or record, and its value.
    HighestSubindex(u8),
    /// An entry, and its place.
    Entry(&'static Entry, usize),
    /// A string.
    Text(&'static ObjectDescription),
}

/// Looks up an object by its index and sub-index.
pub(super) fn find(object: Object) -> Result<Found, SdoError> {
    let at = OBJECTS
        .binary_search_by_key(&object.index, |known| known.index)
        .map_err(|_| SdoError::NoObject { index: object.index })?;
    let known = &OBJECTS[at];
    if known.text().is_some() && object.subindex == 0 {
        return Ok(Found::Text(known));
    }
    let first = known.first_subindex();
    let Some(number) = object.subindex.checked_sub(first) else {
        return Ok(Found::HighestSubindex(known.highest_subindex()));
    };
    match known.entries().get(usize::from(number)) {
        Some(entry) => Ok(Found::Entry(entry, FIRST_PLACES[at] + usize::from(number))),
        None => Err(SdoError::NoSubindex { object, name: known.name, highest: known.highest_subindex() }),
    }
}

/// Entry of an object; `None` if the object does not exist, is a string, or is the sub-index 00h of several.
#[must_use]
pub fn entry_of(object: Object) -> Option<&'static Entry> {
    match find(object) {
        Ok(Found::Entry(entry, _)) => Some(entry),
        _ => None,
    }
}

/// Entry with its place, at compile time.
///
/// # Panics
/// If there is no such entry, so that it does not compile.
const fn place(index: u16, subindex: u8) -> (&'static Entry, usize) {
    let mut at = 0;
    while at < OBJECTS.len() {
        let known = &OBJECTS[at];
        if known.index == index {
            let number = (subindex - known.first_subindex()) as usize;
            return (&known.entries()[number], FIRST_PLACES[at] + number);
        }
        at += 1;
    }
    panic!("no such object")
}

/// A value that the master sets and the drive reads.
#[derive(Debug, Clone, Copy)]
pub struct Parameter<T> {
    pub(super) place: usize,
    holds: PhantomData<T>,
}

/// A value that the drive may set to any value of the type: measurements, and received process data.
#[derive(Debug, Clone, Copy)]
pub struct Signal<T> {
    pub(super) place: usize,
    holds: PhantomData<T>,
}

impl<T: Stored> Parameter<T> {
    /// Parameter at this index and sub-index; it does not compile unless there is an entry of this type.
    const fn at(index: u16, subindex: u8) -> Self {
        let (entry, place) = place(index, subindex);
        assert!(entry.data_type as u16 == T::DATA_TYPE as u16, "the object has another type");
        Self { place, holds: PhantomData }
    }
}

impl<T: Stored> Signal<T> {
    /// Like [`Parameter::at`], for entries that change and take every value of their type.
    const fn at(index: u16, subindex: u8) -> Self {
        let Parameter { place: place_of_entry, holds } = Parameter::<T>::at(index, subindex);
        let (entry, _) = place(index, subindex);
        assert!(!matches!(entry.access, Access::Constant), "a constant is not set");
        assert!(matches!(entry.admitted, Admitted::Any), "the object does not take every value");
        Self { place: place_of_entry, holds }
    }
}

/// Declares places by name.
macro_rules! places {
    ($kind:ident: $($name:ident: $type:ty = $index:literal $(: $subindex:literal)?;)*) => {
        $(
            #[doc = concat!("`", stringify!($index), $(":", stringify!($subindex),)? "`.")]
            pub const $name: $kind<$type> = $kind::at($index, 0 $(+ $subindex)?);
        )*
    };
}

/// Values that the master sets and the drive reads.
pub mod parameter {
    use super::Parameter;

    places! { Parameter:
        QUICK_STOP_OPTION_CODE: i16 = 0x605A;
        SHUTDOWN_OPTION_CODE: i16 = 0x605B;
        DISABLE_OPERATION_OPTION_CODE: i16 = 0x605C;
        HALT_OPTION_CODE: i16 = 0x605D;
        FAULT_REACTION_OPTION_CODE: i16 = 0x605E;
        MODES_OF_OPERATION: i8 = 0x6060;
        FOLLOWING_ERROR_WINDOW: u32 = 0x6065;
        FOLLOWING_ERROR_TIME_OUT: u16 = 0x6066;
        POSITION_WINDOW: u32 = 0x6067;
        POSITION_WINDOW_TIME: u16 = 0x6068;
        VELOCITY_WINDOW: u16 = 0x606D;
        VELOCITY_WINDOW_TIME: u16 = 0x606E;
        VELOCITY_THRESHOLD: u16 = 0x606F;
        VELOCITY_THRESHOLD_TIME: u16 = 0x6070;
        MAX_TORQUE: u16 = 0x6072;
        MAX_CURRENT: u16 = 0x6073;
        MOTOR_RATED_CURRENT: u32 = 0x6075;
        MOTOR_RATED_TORQUE: u32 = 0x6076;
        MIN_POSITION_RANGE_LIMIT: i32 = 0x607B: 1;
        MAX_POSITION_RANGE_LIMIT: i32 = 0x607B: 2;
        HOME_OFFSET: i32 = 0x607C;
        MIN_POSITION_LIMIT: i32 = 0x607D: 1;
        MAX_POSITION_LIMIT: i32 = 0x607D: 2;
        POLARITY: u8 = 0x607E;
        MAX_PROFILE_VELOCITY: u32 = 0x607F;
        MAX_MOTOR_SPEED: u32 = 0x6080;
        PROFILE_VELOCITY: u32 = 0x6081;
        END_VELOCITY: u32 = 0x6082;
        PROFILE_ACCELERATION: u32 = 0x6083;
        PROFILE_DECELERATION: u32 = 0x6084;
        QUICK_STOP_DECELERATION: u32 = 0x6085;
        MOTION_PROFILE_TYPE: i16 = 0x6086;
        TORQUE_SLOPE: u32 = 0x6087;
        ENCODER_INCREMENTS: u32 = 0x608F: 1;
        ENCODER_MOTOR_REVOLUTIONS: u32 = 0x608F: 2;
        GEAR_MOTOR_REVOLUTIONS: u32 = 0x6091: 1;
        GEAR_SHAFT_REVOLUTIONS: u32 = 0x6091: 2;
        FEED: u32 = 0x6092: 1;
        FEED_SHAFT_REVOLUTIONS: u32 = 0x6092: 2;
        VELOCITY_FACTOR_NUMERATOR: u32 = 0x6096: 1;
        VELOCITY_FACTOR_DIVISOR: u32 = 0x6096: 2;
        HOMING_METHOD: i8 = 0x6098;
        HOMING_SPEED_FOR_SWITCH: u32 = 0x6099: 1;
        HOMING_SPEED_FOR_ZERO: u32 = 0x6099: 2;
        HOMING_ACCELERATION: u32 = 0x609A;
        PROFILE_JERK: u32 = 0x60A4: 1;
        INTERPOLATION_SUB_MODE: i16 = 0x60C0;
        INTERPOLATION_POSITION: i32 = 0x60C1: 1;
        INTERPOLATION_TIME: u8 = 0x60C1: 2;
        INTERPOLATION_VELOCITY: i32 = 0x60C1: 3;
        INTERPOLATION_TIME_PERIOD: u8 = 0x60C2: 1;
        INTERPOLATION_TIME_INDEX: i8 = 0x60C2: 2;
        MAX_ACCELERATION: u32 = 0x60C5;
        MAX_DECELERATION: u32 = 0x60C6;
        POSITIVE_TORQUE_LIMIT: u16 = 0x60E0;
        NEGATIVE_TORQUE_LIMIT: u16 = 0x60E1;
        POSITIONING_OPTION_CODE: u16 = 0x60F2;
        TOUCH_PROBE_FUNCTION: u16 = 0x60B8;
        DIGITAL_OUTPUTS: u32 = 0x60FE: 1;
        DIGITAL_OUTPUT_MASK: u32 = 0x60FE: 2;
    }
}

/// Values from the drive, and set-points that come as process data.
pub mod signal {
    use super::Signal;

    places! { Signal:
        ERROR_REGISTER: u8 = 0x1001;
        IP_MOVE_SEGMENT_COMMAND: u64 = 0x2010;
        TRAJECTORY_BUFFER_FREE_COUNT: u16 = 0x2011;
        TRAJECTORY_BUFFER_STATUS: u32 = 0x2012;
        ERROR_CODE: u16 = 0x603F;
        CONTROLWORD: u16 = 0x6040;
        STATUSWORD: u16 = 0x6041;
        MODES_OF_OPERATION_DISPLAY: i8 = 0x6061;
        POSITION_DEMAND_VALUE: i32 = 0x6062;
        POSITION_ACTUAL_INTERNAL_VALUE: i32 = 0x6063;
        POSITION_ACTUAL_VALUE: i32 = 0x6064;
        VELOCITY_DEMAND_VALUE: i32 = 0x606B;
        VELOCITY_ACTUAL_VALUE: i32 = 0x606C;
        TARGET_TORQUE: i16 = 0x6071;
        TORQUE_DEMAND: i16 = 0x6074;
        TORQUE_ACTUAL_VALUE: i16 = 0x6077;
        CURRENT_ACTUAL_VALUE: i16 = 0x6078;
        DC_LINK_CIRCUIT_VOLTAGE: u32 = 0x6079;
        TARGET_POSITION: i32 = 0x607A;
        POSITION_OFFSET: i32 = 0x60B0;
        VELOCITY_OFFSET: i32 = 0x60B1;
        TORQUE_OFFSET: i16 = 0x60B2;
        TOUCH_PROBE_STATUS: u16 = 0x60B9;
        TOUCH_PROBE_POSITIVE_EDGE: i32 = 0x60BA;
        TOUCH_PROBE_NEGATIVE_EDGE: i32 = 0x60BB;
        FOLLOWING_ERROR_ACTUAL_VALUE: i32 = 0x60F4;
        POSITION_DEMAND_INTERNAL_VALUE: i32 = 0x60FC;
        DIGITAL_INPUTS: u32 = 0x60FD;
        TARGET_VELOCITY: i32 = 0x60FF;
    }
}
