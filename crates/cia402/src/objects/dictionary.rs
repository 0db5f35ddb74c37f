//! Values of the objects.
use super::entry::{Admitted, Entry};
use super::place::{Found, PLACES, Parameter, Signal, find, parameter as p, signal};
use super::table::OBJECTS;
use super::value::{Stored, Value};
use crate::modulo::PositionRange;
use crate::sdo::{SdoError, Side};
use crate::units::{AxisUnit, FactorGroup, Object, Ratio};
use crate::{
    Actuals, Commands, DisableOperationOption, ErrorCode, FaultReactionOption, HaltOption, Mode, OptionCodeError,
    PowerParams, PowerState, QuickStopOption, ShutdownOption, StatusBit, Statusword,
};

/// Every value of the object dictionary.
///
/// A write of the master is refused unless its object takes the value, so the values of parameters are always in range. The drive reads its
/// parameters again when [`generation`](Self::generation) has changed.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Dictionary {
    /// Bits of each value.
    bits: [u64; PLACES],
    /// True for each value that the master has written.
    is_written: [bool; PLACES],
    generation: u32,
}

impl Default for Dictionary {
    fn default() -> Self {
        Self::new()
    }
}

impl Dictionary {
    /// Values after power-on.
    #[must_use]
    pub const fn new() -> Self {
        const DEFAULTS: [u64; PLACES] = {
            let mut bits = [0; PLACES];
            let (mut object, mut place) = (0, 0);
            while object < OBJECTS.len() {
                let entries = OBJECTS[object].entries();
                let mut number = 0;
                while number < entries.len() {
                    bits[place] = entries[number].default_value().bits();
                    (number, place) = (number + 1, place + 1);
                }
                object += 1;
            }
            bits
        };
        Self { bits: DEFAULTS, is_written: [false; PLACES], generation: 0 }
    }

    /// Reads a value for the master.
    ///
    /// # Errors
    /// [`SdoError`] if the object does not exist, is write-only, or is a string, whose bytes [`upload`](Self::upload) returns.
    pub fn read(&self, object: Object) -> Result<Value, SdoError> {
        match find(object)? {
            Found::HighestSubindex(highest) => Ok(Value::Unsigned8(highest)),
            Found::Entry(entry, place) if entry.access.is_read() => Ok(entry.data_type.value(self.bits[place])),
            Found::Entry(Entry { name, .. }, _) => Err(SdoError::WriteOnly { object, name }),
            Found::Text(known) => Err(SdoError::NoNumber { object, name: known.name }),
        }
    }

    /// Writes a value of the master, with the drive in `state`.
    ///
    /// # Errors
    /// [`SdoError`] with the refused value and the reason; nothing changes then.
    pub fn write(&mut self, object: Object, value: Value, state: PowerState) -> Result<(), SdoError> {
        let (entry, place) = writable(object)?;
        let (name, data_type) = (entry.name, entry.data_type);
        if value.data_type() != data_type {
            return Err(SdoError::Type { object, name, data_type, value });
        }
        self.store(object, entry, place, value, state)
    }

    /// Bytes of a number, the lowest first, or of a string.
    ///
    /// # Errors
    /// [`SdoError`] if the object does not exist or is write-only.
    pub fn upload(&self, object: Object) -> Result<Bytes, SdoError> {
        if let Found::Text(known) = find(object)? {
            return Ok(Bytes::of(known.text().unwrap_or_default().as_bytes()));
        }
        self.read(object).map(|value| Bytes::of(&value.bytes()[..value.data_type().size()]))
    }

    /// [`write`](Self::write) of bytes, the lowest first.
    ///
    /// # Errors
    /// As [`write`](Self::write).
    pub fn download(&mut self, object: Object, bytes: &[u8], state: PowerState) -> Result<(), SdoError> {
        let (entry, place) = writable(object)?;
        let (name, data_type) = (entry.name, entry.data_type);
        let value = Value::of_bytes(data_type, bytes).ok_or(SdoError::Length {
            object,
            name,
            data_type,
            length: bytes.len(),
        })?;
        self.store(object, entry, place, value, state)
    }

    /// [`write`](Self::write) of a number, converted to the type of the object.
    ///
    /// # Errors
    /// As [`write`](Self::write); also [`SdoError::TooHigh`] and [`SdoError::TooLow`] for numbers outside the range of the type.
    pub fn write_number(&mut self, object: Object, number: i64, state: PowerState) -> Result<(), SdoError> {
        let (entry, place) = writable(object)?;
        let bounds = [entry.data_type.lowest(), entry.data_type.highest()];
        within(object, entry.name, number.into(), bounds)?;
        self.store(object, entry, place, entry.data_type.value(number.cast_unsigned()), state)
    }

    fn store(
        &mut self,
        object: Object,
        entry: &'static Entry,
        place: usize,
        value: Value,
        state: PowerState,
    ) -> Result<(), SdoError> {
        if entry.disabled_only && state.is_drive_function_enabled() {
            return Err(SdoError::State { object, name: entry.name, state });
        }
        if let Some(mode) = entry.governs.filter(|mode| self.is_under_way(*mode, state)) {
            return Err(SdoError::UnderWay { object, name: entry.name, mode });
        }
        self.replace(object, entry, place, value)?;
        self.is_written[place] = true;
        self.generation = self.generation.wrapping_add(1);
        Ok(())
    }

    /// True if the axis is in a motion that `mode` generates itself, by the statusword (6041h) and the mode (6061h) last sent to the
    /// master: a search of homing that is neither over (bits 12, 13) nor at rest (bit 10), or points of interpolated position being
    /// followed (bit 12).
    fn is_under_way(&self, mode: Mode, state: PowerState) -> bool {
        let statusword = Statusword::from_bits(self.signal(signal::STATUSWORD));
        let says = |bit| statusword.has(bit);
        state == PowerState::OperationEnabled
            && Mode::from_code(self.signal(signal::MODES_OF_OPERATION_DISPLAY)) == Some(mode)
            && match mode {
                Mode::Homing => {
                    !(says(StatusBit::TargetReached)
                        || says(StatusBit::ModeSpecific12)
                        || says(StatusBit::ModeSpecific13))
                }
                Mode::InterpolatedPosition => says(StatusBit::ModeSpecific12),
                _ => false,
            }
    }

    /// Sets the value that the object has in this drive from power-on, if the object takes it. It is not a write of the master: the
    /// generation stays.
    ///
    /// # Errors
    /// [`SdoError`] if the object does not exist or is read-only for the master, or refuses the value.
    pub fn preset(&mut self, object: Object, value: Value) -> Result<(), SdoError> {
        let (entry, place) = writable(object)?;
        let (name, data_type) = (entry.name, entry.data_type);
        if value.data_type() != data_type {
            return Err(SdoError::Type { object, name, data_type, value });
        }
        self.replace(object, entry, place, value)?;
        self.is_written[place] = false;
        Ok(())
    }

    /// True if the master has written the object since power-on, or since the drive preset it.
    #[must_use]
    pub fn is_written(&self, object: Object) -> bool {
        matches!(find(object), Ok(Found::Entry(_, place)) if self.is_written[place])
    }

    fn replace(&mut self, object: Object, entry: &'static Entry, place: usize, value: Value) -> Result<(), SdoError> {
        admit(object, entry, value)?;
        let before = core::mem::replace(&mut self.bits[place], value.bits());
        if let Err(refused) = self.fits_the_others(object, entry.name, value) {
            self.bits[place] = before;
            return Err(refused);
        }
        Ok(())
    }

    /// Checks the value, which is already stored, against those of related objects.
    fn fits_the_others(&self, object: Object, name: &'static str, value: Value) -> Result<(), SdoError> {
        let apart = |min: i32, max: i32| match object.subindex {
            _ if min < max => Ok(()),
            1 => Err(SdoError::CrossedBounds { object, name, value, side: Side::Below, bound: max }),
            _ => Err(SdoError::CrossedBounds { object, name, value, side: Side::Above, bound: min }),
        };
        match object.index {
            0x607B => apart(self.get(p::MIN_POSITION_RANGE_LIMIT), self.get(p::MAX_POSITION_RANGE_LIMIT)),
            0x607D => apart(self.get(p::MIN_POSITION_LIMIT), self.get(p::MAX_POSITION_LIMIT)),
            0x608F | 0x6091 | 0x6092 | 0x6096 => self
                .factor_group()
                .scaling(AxisUnit::Metre(Ratio::ONE))
                .map(|_| ())
                .map_err(|reason| SdoError::FactorGroup { object, value, reason }),
            _ => Ok(()),
        }
    }

    /// Number of writes of the master, modulo 2³².
    #[must_use]
    pub const fn generation(&self) -> u32 {
        self.generation
    }

    /// Value of a parameter, in constant time.
    #[must_use]
    pub fn get<T: Stored>(&self, parameter: Parameter<T>) -> T {
        T::of_bits(self.bits[parameter.place])
    }

    /// Value of a signal, in constant time.
    #[must_use]
    pub fn signal<T: Stored>(&self, signal: Signal<T>) -> T {
        T::of_bits(self.bits[signal.place])
    }

    /// Sets a signal, in constant time. It is not a write of the master: the generation stays.
    pub fn set<T: Stored>(&mut self, signal: Signal<T>, value: T) {
        self.bits[signal.place] = value.value().bits();
    }

    /// Copies the received and the sent process data, so that the master reads the same by SDO.
    ///
    /// Profile velocity, accelerations and home offset are parameters: the master writes them.
    pub fn mirror(&mut self, commands: &Commands, actuals: &Actuals) {
        self.set(signal::CONTROLWORD, commands.controlword.bits());
        self.set(signal::TARGET_POSITION, commands.target_position);
        self.set(signal::TARGET_VELOCITY, commands.target_velocity);
        self.set(signal::TARGET_TORQUE, commands.target_torque);
        self.set(signal::POSITION_OFFSET, commands.position_offset);
        self.set(signal::VELOCITY_OFFSET, commands.velocity_offset);
        self.set(signal::TORQUE_OFFSET, commands.torque_offset);
        if let Some(mode) = Mode::from_code(commands.mode) {
            self.bits[p::MODES_OF_OPERATION.place] = Value::Integer8(mode.code()).bits();
        }
        self.set(signal::STATUSWORD, actuals.statusword.bits());
        self.set(signal::MODES_OF_OPERATION_DISPLAY, actuals.mode);
        self.set(signal::POSITION_DEMAND_VALUE, actuals.position_demand);
        self.set(signal::POSITION_ACTUAL_VALUE, actuals.position);
        self.set(signal::VELOCITY_ACTUAL_VALUE, actuals.velocity);
        self.set(signal::TORQUE_ACTUAL_VALUE, actuals.torque);
        self.set(signal::FOLLOWING_ERROR_ACTUAL_VALUE, actuals.following_error);
        self.set(signal::ERROR_CODE, actuals.error_code);
        self.set(signal::ERROR_REGISTER, ErrorCode::register(actuals.error_code));
        self.set(signal::DIGITAL_INPUTS, actuals.digital_inputs);
        self.set(signal::TRAJECTORY_BUFFER_FREE_COUNT, actuals.buffer_free);
        self.set(signal::TRAJECTORY_BUFFER_STATUS, actuals.buffer_status);
        self.bits[p::TOUCH_PROBE_FUNCTION.place] = Value::from(commands.touch_probe_function).bits();
        self.bits[p::DIGITAL_OUTPUTS.place] = Value::from(commands.digital_outputs).bits();
        if let Some(max_torque) = commands.max_torque {
            self.bits[p::MAX_TORQUE.place] = Value::from(max_torque).bits();
        }
        let [positive, negative] = actuals.touch_probe_positions;
        self.set(signal::TOUCH_PROBE_STATUS, actuals.touch_probe_status);
        self.set(signal::TOUCH_PROBE_POSITIVE_EDGE, positive);
        self.set(signal::TOUCH_PROBE_NEGATIVE_EDGE, negative);
    }

    /// Option codes (605Ah to 605Eh).
    #[must_use]
    pub fn power_params(&self) -> PowerParams {
        PowerParams {
            quick_stop: self.option(p::QUICK_STOP_OPTION_CODE, QuickStopOption::try_from),
            shutdown: self.option(p::SHUTDOWN_OPTION_CODE, ShutdownOption::try_from),
            disable_operation: self.option(p::DISABLE_OPERATION_OPTION_CODE, DisableOperationOption::try_from),
            halt: self.option(p::HALT_OPTION_CODE, HaltOption::try_from),
            fault_reaction: self.option(p::FAULT_REACTION_OPTION_CODE, FaultReactionOption::try_from),
        }
    }

    fn option<T: Default>(&self, code: Parameter<i16>, option: impl Fn(i16) -> Result<T, OptionCodeError>) -> T {
        // The object takes no other code: a test checks its range against the existing codes.
        option(self.get(code)).unwrap_or_default()
    }

    /// Requested mode of operation (6060h); `None` before the first request.
    #[must_use]
    pub fn mode(&self) -> Option<Mode> {
        Mode::from_code(self.get(p::MODES_OF_OPERATION))
    }

    /// Factor group (608Fh, 6091h, 6092h, 6096h, 607Eh).
    #[must_use]
    pub fn factor_group(&self) -> FactorGroup {
        FactorGroup {
            position_encoder_resolution: [self.get(p::ENCODER_INCREMENTS), self.get(p::ENCODER_MOTOR_REVOLUTIONS)],
            gear_ratio: [self.get(p::GEAR_MOTOR_REVOLUTIONS), self.get(p::GEAR_SHAFT_REVOLUTIONS)],
            feed_constant: [self.get(p::FEED), self.get(p::FEED_SHAFT_REVOLUTIONS)],
            velocity_factor: [self.get(p::VELOCITY_FACTOR_NUMERATOR), self.get(p::VELOCITY_FACTOR_DIVISOR)],
            polarity: self.get(p::POLARITY),
        }
    }

    /// Position range limit (607Bh).
    #[must_use]
    pub fn position_range(&self) -> PositionRange {
        let (min, max) = (self.get(p::MIN_POSITION_RANGE_LIMIT), self.get(p::MAX_POSITION_RANGE_LIMIT));
        // Never empty: a write that would make it so was refused.
        PositionRange::new(min, max).unwrap_or_default()
    }
}

/// Bytes of a value, as sent over the bus.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Bytes {
    bytes: [u8; LONGEST],
    length: usize,
}

/// Longest string of the table (bytes); longer ones would be cut.
const LONGEST: usize = 32;

impl Bytes {
    fn of(bytes: &[u8]) -> Self {
        let length = bytes.len().min(LONGEST);
        let mut own = [0; LONGEST];
        own[..length].copy_from_slice(&bytes[..length]);
        Self { bytes: own, length }
    }
}

impl AsRef<[u8]> for Bytes {
    fn as_ref(&self) -> &[u8] {
        &self.bytes[..self.length]
    }
}

/// Entry that a master may write.
fn writable(object: Object) -> Result<(&'static Entry, usize), SdoError> {
    match find(object)? {
        Found::Entry(entry, place) if entry.access.is_written() => Ok((entry, place)),
        Found::Entry(Entry { name, .. }, _) => Err(SdoError::ReadOnly { object, name }),
        Found::HighestSubindex(_) => Err(SdoError::ReadOnly { object, name: super::entry::HIGHEST_SUBINDEX }),
        Found::Text(known) => Err(SdoError::ReadOnly { object, name: known.name }),
    }
}

/// Refuses values that the entry does not take.
fn admit(object: Object, entry: &'static Entry, value: Value) -> Result<(), SdoError> {
    let (name, number) = (entry.name, value.number());
    match entry.admitted {
        Admitted::Range(lowest, highest) => within(object, name, number, [lowest.into(), highest.into()]),
        Admitted::OneOf(accepted) if !accepted.iter().any(|one| i128::from(*one) == number) => {
            Err(SdoError::NotListed { object, name, value, accepted })
        }
        Admitted::Bits(bits) if number & !i128::from(bits) != 0 => {
            Err(SdoError::ReservedBits { object, name, value, bits })
        }
        Admitted::Any | Admitted::OneOf(_) | Admitted::Bits(_) => Ok(()),
    }
}

fn within(object: Object, name: &'static str, value: i128, [lowest, highest]: [i128; 2]) -> Result<(), SdoError> {
    if value > highest {
        Err(SdoError::TooHigh { object, name, value, highest })
    } else if value < lowest {
        Err(SdoError::TooLow { object, name, value, lowest })
    } else {
        Ok(())
    }
}
