//! `MC_DigitalCamSwitch`: digital outputs (60FEh) switched by the position of the axis, like the cams on a shaft.
//!
//! A switch is on one of 32 tracks, and track k is bit k of the outputs; several switches of a track are ORed. A switch is TRUE from
//! FirstOnPosition to LastOnPosition, both included, or for a time after the axis passes FirstOnPosition. Choices where the standard
//! (PLCopen part 1, version 2.0, section 3.25) leaves the behaviour open:
//!
//! - **Direction** is that of the last motion: an axis that has stopped keeps it. Before the first motion there is none, and a switch for
//!   one direction is FALSE.
//! - **Compensation** moves an edge by velocity × time, against the motion if it is negative: the output switches when the position at t −
//!   compensation passes the edge, at the velocity of this cycle. If it shrinks a window to less than nothing, the output stays FALSE.
//! - **Hysteresis** holds an output that has switched while the axis is within that distance of the edge, and the direction until the axis
//!   has moved back by that distance.
//! - A window passed between two cycles is TRUE for one.
//! - Position jumps (MC_SetPosition, homing) pass no edge.
mod cam;
use servobench_base::Stateful;

use super::outputs::FunctionBlock;
use super::profile::{Memory, check_room};
use crate::axis::Axis;
use crate::blocks::{BlockName, Input};
use crate::command::finite_input;
use crate::error::{BlockError, ErrorId};
use crate::interface::{
    BlockInput, BlockInputs, FromValues as _, Tables, Trigger, Values, optional, or, outputs, required,
};
use cam::Place;

pub use cam::CamState;

servobench_config::choices! {
    /// Direction of the axis in which a switch acts.
    pub enum CamDirection default Both {
        /// upwards and downwards
        Both = "both",
        /// upwards
        Positive = "positive",
        /// downwards
        Negative = "negative",
    }
}

servobench_config::choices! {
    /// Source of the position and velocity (MC_SOURCE).
    pub enum ValueSource default SetPoint {
        /// those of the set-point
        SetPoint = "set-point",
        /// the actual ones
        Actual = "actual",
    }
}

/// End of a switch: CamSwitchMode, with LastOnPosition or Duration.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum CamEnd {
    /// At LastOnPosition (m or rad), the upper end of the window; below FirstOnPosition if the window crosses zero.
    Position(f64),
    /// Duration after the axis has passed FirstOnPosition (s).
    Duration(f64),
}

/// A switch (MC_CAMSWITCH_REF).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct CamSwitch {
    /// TrackNumber, from 0 to 31.
    pub track: u32,
    /// FirstOnPosition (m or rad): the lower end of the window.
    pub first: f64,
    /// CamSwitchMode, with LastOnPosition or Duration.
    pub end: CamEnd,
    /// AxisDirection.
    pub direction: CamDirection,
}

/// Options of all switches of a track (MC_TRACK_REF).
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct TrackOptions {
    /// Track number, from 0 to 31.
    pub track: u32,
    /// OnCompensation (s): delay of switching on, negative for earlier.
    pub on_compensation: f64,
    /// OffCompensation (s): delay of switching off, negative for earlier.
    pub off_compensation: f64,
    /// Hysteresis (m or rad).
    pub hysteresis: f64,
}

/// Switches digital outputs by the position; `M` is the memory for the switches.
#[derive(Debug, Clone, PartialEq, Stateful)]
pub struct DigitalCamSwitch<M> {
    memory: M,
    /// Outputs that the block switches.
    outputs: u32,
    before: Option<Place>,
    error: Option<BlockError>,
}

/// Inputs of [`DigitalCamSwitch`].
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct DigitalCamSwitchInputs<'a> {
    /// Enable.
    pub enable: bool,
    /// Switches.
    pub switches: &'a [CamSwitch],
    /// TrackOptions, at most once for a track.
    pub track_options: &'a [TrackOptions],
    /// EnableMask: track k is enabled by bit k.
    pub enable_mask: u32,
    /// ValueSource.
    pub value_source: ValueSource,
}

outputs! {
    /// Outputs of [`DigitalCamSwitch`].
    #[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
    pub struct DigitalCamSwitchOutputs {
        /// InOperation: the enabled tracks are switched.
        in_operation: bool = InOperation,
        /// Busy: the block continues, also after an error.
        busy: bool = Busy,
        /// Error.
        error: bool = Error,
        /// ErrorID.
        error_id: ErrorId = ErrorId,
    }
}

const BLOCK: BlockName = BlockName::DigitalCamSwitch;
const TRACKS: u32 = u32::BITS;

const SWITCHES: BlockInput = required(Input::Switches);
const TRACK_OPTIONS: BlockInput = optional(Input::TrackOptions);
const ENABLE_MASK: BlockInput = or(Input::EnableMask, u32::MAX as f64);
const VALUE_SOURCE: BlockInput = optional(Input::ValueSource);

impl<'i> BlockInputs<'i> for DigitalCamSwitchInputs<'i> {
    const TRIGGER: Trigger = Trigger::Enable;
    const INPUTS: &'static [BlockInput] = &[SWITCHES, TRACK_OPTIONS, ENABLE_MASK, VALUE_SOURCE];

    fn read<T: Tables>(values: &'i Values<T>, enable: bool) -> Self {
        Self {
            enable,
            switches: values.table(Input::Switches).map_or(&[], Tables::switches),
            track_options: values.table(Input::TrackOptions).map_or(&[], Tables::tracks),
            enable_mask: u32::read(values, &ENABLE_MASK),
            value_source: ValueSource::read(values, &VALUE_SOURCE),
        }
    }
}

fn wrong(input: &'static str, value: f64, bound: &'static str) -> Result<(), BlockError> {
    Err(BlockError::Input { block: BLOCK, input, value, bound })
}

fn check_track(track: u32) -> Result<(), BlockError> {
    if track < TRACKS { Ok(()) } else { wrong("TrackNumber", track.into(), "a track from 0 to 31") }
}

impl CamSwitch {
    /// Checks the switch for an axis with the period `modulo`, or with ends.
    ///
    /// # Errors
    /// [`BlockError::Input`] with the first wrong part, by its name in the standard.
    pub fn check(&self, modulo: Option<f64>) -> Result<(), BlockError> {
        check_track(self.track)?;
        finite_input(BLOCK, "FirstOnPosition", self.first)?;
        let last = if let CamEnd::Position(last) = self.end { last } else { self.first };
        finite_input(BLOCK, "LastOnPosition", last)?;
        if let Some(period) = modulo {
            if !(0.0..period).contains(&self.first) {
                return wrong("FirstOnPosition", self.first, "within the modulo period, from 0 on");
            }
            if !(0.0..=period).contains(&last) {
                return wrong("LastOnPosition", last, "within the modulo period, from 0 up to it");
            }
        }
        if let CamEnd::Duration(duration) = self.end
            && !(1e-15..=1e15).contains(&duration)
        {
            return wrong("Duration", duration, "positive, from 1e-15 to 1e15");
        }
        if last < self.first && modulo.is_none() {
            return wrong("LastOnPosition", last, "at FirstOnPosition or above it, but on a modulo axis");
        }
        Ok(())
    }
}

impl TrackOptions {
    /// Checks the options for an axis with the period `modulo`, or with ends.
    ///
    /// # Errors
    /// [`BlockError::Input`] with the first wrong part, by its name in the standard.
    pub fn check(&self, modulo: Option<f64>) -> Result<(), BlockError> {
        check_track(self.track)?;
        finite_input(BLOCK, "OnCompensation", self.on_compensation)?;
        finite_input(BLOCK, "OffCompensation", self.off_compensation)?;
        if !(0.0..=1e15).contains(&self.hysteresis) {
            return wrong("Hysteresis", self.hysteresis, "0 or more, up to 1e15");
        }
        if modulo.is_some_and(|period| self.hysteresis >= 0.5 * period) {
            return wrong("Hysteresis", self.hysteresis, "less than half of the modulo period");
        }
        Ok(())
    }
}

impl<'a> DigitalCamSwitchInputs<'a> {
    /// Inputs for `switches` by the set-point, with all tracks enabled and without options; not enabled.
    #[must_use]
    pub const fn of(switches: &'a [CamSwitch]) -> Self {
        let value_source = ValueSource::SetPoint;
        Self { enable: false, switches, track_options: &[], enable_mask: u32::MAX, value_source }
    }

    fn check(&self, modulo: Option<f64>, memory: &[CamState]) -> Result<(), BlockError> {
        if self.switches.is_empty() {
            return wrong("Switches", 0.0, "a table of one switch at least");
        }
        self.switches.iter().try_for_each(|switch| switch.check(modulo))?;
        let mut tracks = 0;
        for options in self.track_options {
            options.check(modulo)?;
            if tracks & 1 << options.track != 0 {
                return wrong("TrackOptions", options.track.into(), "given once for a track");
            }
            tracks |= 1 << options.track;
        }
        check_room(BLOCK, "memory", memory, self.switches.len())
    }

    fn options(&self, track: u32) -> TrackOptions {
        self.track_options.iter().find(|options| options.track == track).copied().unwrap_or_default()
    }
}

impl<M: Memory<CamState>> DigitalCamSwitch<M> {
    /// A block with memory for as many switches as `memory` holds.
    #[must_use]
    pub const fn new(memory: M) -> Self {
        Self { memory, outputs: 0, before: None, error: None }
    }

    /// Computes the outputs of all tracks.
    fn switch(&mut self, axis: &Axis, inputs: &DigitalCamSwitchInputs<'_>) -> u32 {
        let place = Place::of(axis, inputs.value_source);
        if self.before.is_none() {
            let v = axis.commanded().v;
            let direction = if v == 0.0 { 0.0 } else { v.signum() };
            self.memory.as_mut().fill(CamState::going(direction));
        }
        let before = self.before.replace(place).filter(|before| place.continues(before));
        let states = inputs.switches.iter().zip(self.memory.as_mut());
        states.fold(0, |bits, (switch, state)| {
            let is_on = state.step(switch, inputs.options(switch.track), (before.as_ref(), &place), axis);
            bits | u32::from(is_on) << switch.track
        })
    }
}

impl<M: Memory<CamState>> FunctionBlock for DigitalCamSwitch<M> {
    const NAME: BlockName = BLOCK;
    type Inputs<'i> = DigitalCamSwitchInputs<'i>;
    type Outputs = DigitalCamSwitchOutputs;

    fn step(&mut self, axis: &mut Axis, inputs: &DigitalCamSwitchInputs<'_>) -> DigitalCamSwitchOutputs {
        let checked = if inputs.enable { inputs.check(axis.params().modulo, self.memory.as_ref()) } else { Ok(()) };
        self.error = checked.err();
        let in_operation = inputs.enable && self.error.is_none();
        let bits = if in_operation {
            self.switch(axis, inputs) & inputs.enable_mask
        } else {
            self.before = None;
            0
        };
        // Outputs without a track are left to other blocks; an output whose track is gone is reset to FALSE.
        let outputs = if in_operation { inputs.switches.iter().fold(0, |all, one| all | 1 << one.track) } else { 0 };
        axis.set_digital_output(self.outputs | outputs, false);
        axis.set_digital_output(bits, true);
        self.outputs = outputs;
        DigitalCamSwitchOutputs {
            in_operation,
            busy: inputs.enable,
            error: self.error.is_some(),
            error_id: self.error.as_ref().map_or(ErrorId::None, BlockError::id),
        }
    }

    fn error(&self) -> Option<&BlockError> {
        self.error.as_ref()
    }
}

#[cfg(feature = "program")]
impl crate::program::New for DigitalCamSwitch<alloc::vec::Vec<CamState>> {
    fn new_for(inputs: &crate::program::Inputs) -> Self {
        let switches = inputs.table(Input::Switches).map_or(0, |switches| switches.switches().len());
        Self::new(alloc::vec![CamState::default(); switches])
    }
}
