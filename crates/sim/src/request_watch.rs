//! Records the kind of request of the task when it changes.
#![expect(clippy::inline_always, reason = "what is inlined is compiled for the registers of its caller")]
use servobench_base::{RequestKind, Stateful};
use servobench_metrics::REQUEST_KIND;
use servobench_trace::{Recorder, SignalId};

/// The kind of request recorded last.
#[derive(Debug, Clone, Stateful)]
pub(crate) struct RequestWatch {
    #[state(constant)]
    id: SignalId,
    noted: Option<RequestKind>,
}

impl RequestWatch {
    /// A watch without a recorded kind.
    pub(crate) fn new(recorder: &mut Recorder) -> Self {
        let (source, name) = REQUEST_KIND;
        Self { id: recorder.add_signal(source, name), noted: None }
    }

    /// Updates the watch with the kind of request at `t` (s).
    #[inline(always)]
    pub(crate) fn tick(&mut self, t: f64, kind: RequestKind, recorder: &mut Recorder) {
        if self.noted != Some(kind) {
            self.note(t, kind, recorder);
        }
    }

    #[cold]
    fn note(&mut self, t: f64, kind: RequestKind, recorder: &mut Recorder) {
        self.noted = Some(kind);
        recorder.note_value(self.id, t, kind.name());
    }
}
