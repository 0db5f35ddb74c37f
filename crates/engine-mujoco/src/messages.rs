//! Handling of messages from `MuJoCo`, which it would otherwise write to a file `MUJOCO_LOG.TXT` in the working folder.
use mujoco_rs::prelude::{MjLogMessage, MjtLogLevel, log_config, set_log_config, set_log_handler};
use servobench_files::with_short_quotes;
use std::cell::RefCell;
use std::io::Write as _;
use std::sync::Once;

thread_local! {
    /// The last warning on this thread.
    static WARNING: RefCell<Option<String>> = const { RefCell::new(None) };
}

static INSTALL: Once = Once::new();

/// Installs the handler; must be called before anything else of `MuJoCo`, and may be repeated.
pub(crate) fn install() {
    #[expect(unsafe_code, reason = "the crate asks that no other thread uses MuJoCo meanwhile")]
    // SAFETY: everything in this crate that calls MuJoCo comes through here first, and `call_once` blocks every other
    // thread until the handler is in place.
    INSTALL.call_once(|| unsafe {
        set_log_handler(receive);
        // The crate enables messages about the timing of every step.
        set_log_config(log_config().with_topics(0));
    });
}

/// The last warning on this thread, if there was one since the last call.
pub(crate) fn take_warning() -> Option<String> {
    WARNING.take()
}

fn receive(message: &MjLogMessage) {
    match message.level() {
        MjtLogLevel::mjLOG_ERROR => {
            // MuJoCo ends the process when this returns. If the line cannot be written, nothing else can be done.
            drop(writeln!(std::io::stderr(), "mujoco: {}", with_short_quotes(message.subject())));
        }
        MjtLogLevel::mjLOG_WARNING => {
            WARNING.set(Some(with_short_quotes(message.subject().trim())));
        }
        MjtLogLevel::mjLOG_INFO | MjtLogLevel::mjLOG_DEBUG => {}
    }
}
