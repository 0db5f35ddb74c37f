//! States of drive and link, recorded when they change.
use servobench_base::Stateful;
use servobench_cia402::interpolated::BufferError;
use servobench_cia402::{Mode, PowerState};
use servobench_drive::device;
use servobench_fieldbus::link;
use servobench_fieldbus::{Fault, Interpolation};
use servobench_trace::{Recorder, SignalId};

/// A state that is recorded only when it changes.
#[derive(Debug, Stateful)]
pub(super) struct Watched<T> {
    #[state(constant)]
    id: SignalId,
    last: Option<T>,
}

impl<T: Copy + PartialEq> Watched<T> {
    pub(super) fn new(source: &str, name: &str, recorder: &mut Recorder) -> Self {
        Self { id: recorder.add_signal(source, name), last: None }
    }

    /// Records `value` if it has changed, and returns true if it has.
    #[inline]
    pub(super) fn note(&mut self, t: f64, value: T, recorder: &mut Recorder, words: impl FnOnce(T) -> String) -> bool {
        let is_other = self.last != Some(value);
        if is_other {
            self.last = Some(value);
            recorder.note_value(self.id, t, &words(value));
        }
        is_other
    }
}

/// Text of a BOOL in a recording.
pub(super) fn word(value: bool) -> String {
    if value { "TRUE" } else { "FALSE" }.into()
}

/// The errors that a trajectory buffer latches, in the highest byte of its status (2012h).
const ERRORS: u32 = BufferError::Sequence as u32 | BufferError::Overflow as u32 | BufferError::Underflow as u32;

/// Latched errors of the buffer.
fn latched(errors: u32) -> String {
    let names = [
        (BufferError::Sequence, "point missing"),
        (BufferError::Overflow, "Overflow"),
        (BufferError::Underflow, "Underflow"),
    ];
    let found: Vec<_> = names.iter().filter(|(error, _)| errors & *error as u32 != 0).map(|(_, name)| *name).collect();
    if found.is_empty() { "none".into() } else { found.join(", ") }
}

/// Recorded signals of drive and link.
#[derive(Debug, Stateful)]
#[state(fixed)]
pub(super) struct Signals {
    power: Watched<PowerState>,
    mode: Watched<Option<Mode>>,
    drive_fault: Watched<Option<device::Fault>>,
    internal_limit: Watched<bool>,
    buffer: Watched<u32>,
    /// The words through which a master reads the buffer, if it sends points: 2011h and 2012h.
    #[state(fixed)]
    words: Option<(Watched<usize>, Watched<u32>)>,
    interpolation: Watched<Interpolation>,
    link_fault: Watched<Option<Fault>>,
}

impl Signals {
    /// Signals with the words of the trajectory buffer if the master `sends_points`.
    pub(super) fn new(sends_points: bool, recorder: &mut Recorder) -> Self {
        Self {
            power: Watched::new("drive", "state", recorder),
            mode: Watched::new("drive", "mode", recorder),
            drive_fault: Watched::new("drive", "fault", recorder),
            internal_limit: Watched::new("drive", "internal_limit", recorder),
            buffer: Watched::new("drive", "buffer", recorder),
            words: sends_points.then(|| {
                (Watched::new("drive", "buffer_free", recorder), Watched::new("drive", "buffer_status", recorder))
            }),
            interpolation: Watched::new("link", "interpolation", recorder),
            link_fault: Watched::new("link", "fault", recorder),
        }
    }

    pub(super) fn of_drive(&mut self, t: f64, drive: &device::State, recorder: &mut Recorder) {
        self.power.note(t, drive.power(), recorder, |state| state.to_string());
        self.mode.note(t, drive.mode(), recorder, |mode| mode.map_or("none", Mode::abbreviation).into());
        self.drive_fault.note(t, drive.fault(), recorder, |fault| {
            fault.map_or("none".into(), |fault| format!("{:04X}h", fault.code()))
        });
        self.internal_limit.note(t, drive.is_limited(), recorder, word);
        self.buffer.note(t, drive.buffer_status() >> 24 & ERRORS, recorder, latched);
        if let Some((free, status)) = &mut self.words {
            free.note(t, drive.buffer_free(), recorder, |points| points.to_string());
            status.note(t, drive.buffer_status(), recorder, |status| format!("{status:08X}h"));
        }
    }

    pub(super) fn of_link(&mut self, t: f64, link: &link::State, recorder: &mut Recorder) {
        self.interpolation.note(t, link.interpolation(), recorder, |state| state.name().into());
        self.link_fault.note(t, link.fault(), recorder, |fault| fault.map_or("none".into(), |fault| fault.to_string()));
    }
}
