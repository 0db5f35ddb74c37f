//! Incidents of an axis and its drive, which a scenario can expect; most of them do harm if unexpected.
//!
//! They are found after the run, in its channels and states, and noted as its events: a tick costs nothing. Those that no channel
//! shows (a joint of a user's own model at the end of its range, a fault of the bus) are noted during the run.
mod contact;
mod measured;
mod spell;
mod states;
mod warmth;

pub(crate) use measured::note;

use crate::requirement::Rules;
use servobench_config::Choice;
use servobench_trace::{Event, Recording};
use std::fmt;

servobench_config::choices! {
    /// Incidents of an axis and its drive.
    pub enum Incident {
        /// the load meets an end stop, or a joint of a user's model the end of its range
        EndStop = "end_stop",
        /// the winding is hotter than `motor.thermal.limit`
        WindingTemperature = "winding_temperature",
        /// a point is missing in the trajectory buffer of the drive
        MissingPoint = "missing_point",
        /// the trajectory buffer of the drive receives more points than it holds
        BufferOverflow = "buffer_overflow",
        /// the trajectory buffer of the drive runs out of points
        BufferUnderflow = "buffer_underflow",
        /// a limit of the drive is active (bit 11 of the statusword)
        InternalLimit = "internal_limit",
        /// a `[[bus.fault]]` of the scenario affects frames, or cycles of the motion task
        BusFault = "bus_fault",
    }
}

/// Largest number of noted incidents of one kind; the last one reports that there were others.
const MOST_NOTED: usize = 100;

impl Incident {
    /// Name in scenario files and recordings.
    #[must_use]
    pub fn name(self) -> &'static str {
        Self::ALL.iter().find(|(_, one, _)| *one == self).map_or("", |(name, ..)| name)
    }

    /// True if it does harm unless expected: a limit of the drive, or a fault that the scenario orders, does none.
    #[must_use]
    pub const fn is_harm(self) -> bool {
        !matches!(self, Self::InternalLimit | Self::BusFault)
    }

    /// The incident in `event`, if it is one.
    pub(crate) fn of(event: &Event) -> Option<Self> {
        Self::from_name(&event.incident.as_ref()?.name)
    }

    /// The incident with this name.
    #[must_use]
    pub fn from_name(name: &str) -> Option<Self> {
        Self::ALL.iter().find(|(one, ..)| *one == name).map(|(_, incident, _)| *incident)
    }
}

impl fmt::Display for Incident {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.pad(self.name())
    }
}

/// Notes the incidents that channels and states of `recording` show as its events, and the contacts that do no harm.
pub fn note_incidents(recording: &mut Recording, rules: &Rules<'_>) {
    let found: Vec<Event> = [
        contact::incidents(recording, rules),
        warmth::incidents(recording, rules),
        states::of_buffer(recording),
        states::of_internal_limit(recording),
    ]
    .into_iter()
    .flat_map(first)
    .collect();
    contact::complete_joints(recording, rules);
    recording.events.extend(found);
    recording.events.sort_by(|one, two| one.start.total_cmp(&two.start));
}

/// Limits `events` to the number that is noted.
fn first(mut events: Vec<Event>) -> Vec<Event> {
    if events.len() > MOST_NOTED {
        events.truncate(MOST_NOTED);
        if let Some(last) = events.last_mut() {
            last.message.push_str(Event::noted(true));
            if let Some(limit) = &mut last.limit {
                limit.is_last_noted = true;
            }
        }
    }
    events
}
