#![expect(unsafe_code, reason = "what to do at a crash is told to the system through C")]
//! Notes of a contained process about its crash.
//!
//! The memory of a process is gone when its keeper detects its end, so the process notes how much it had. The handler does only what is
//! safe in a signal handler (signal-safety(7)): system calls and atomics. Then the crash takes its usual course: the previous action is
//! restored, and the instruction that failed fails again.
use super::memory;
use super::note::Note;
use std::ffi::c_int;
use std::mem::MaybeUninit;
use std::ptr;
use std::sync::OnceLock;
use std::sync::atomic::Ordering::Relaxed;

/// Signals that end a process after an error.
const SIGNALS: [c_int; 5] = [libc::SIGSEGV, libc::SIGABRT, libc::SIGBUS, libc::SIGILL, libc::SIGFPE];

/// Data of the signal handler.
struct Known {
    note: &'static Note,
    before: [libc::sigaction; SIGNALS.len()],
}

// SAFETY: the actions hold addresses of functions, which all threads may call; nothing changes them.
unsafe impl Send for Known {}
// SAFETY: as above.
unsafe impl Sync for Known {}

static KNOWN: OnceLock<Known> = OnceLock::new();

/// Installs handlers that note in `note` the memory of this process when it crashes.
pub(crate) fn note_in(note: &'static Note) {
    let before = SIGNALS.map(|signal| {
        let mut action = MaybeUninit::<libc::sigaction>::zeroed();
        // SAFETY: it asks only, and fills what it points to; all zeros are an action too: the default.
        unsafe {
            libc::sigaction(signal, ptr::null(), action.as_mut_ptr());
            action.assume_init()
        }
    });
    if KNOWN.set(Known { note, before }).is_ok() {
        let handler: extern "C" fn(c_int, *mut libc::siginfo_t, *mut libc::c_void) = crashed;
        for signal in SIGNALS {
            // SAFETY: all zeros are an action without flags and with an empty mask; the handler is for as long as the program.
            unsafe {
                let mut action = MaybeUninit::<libc::sigaction>::zeroed().assume_init();
                action.sa_sigaction = handler as *const () as libc::sighandler_t;
                // On a separate stack, where the thread has one: the cause may be a stack overflow.
                action.sa_flags = libc::SA_SIGINFO | libc::SA_ONSTACK;
                libc::sigaction(signal, &raw const action, ptr::null_mut());
            }
        }
    }
}

extern "C" fn crashed(signal: c_int, info: *mut libc::siginfo_t, _: *mut libc::c_void) {
    let Some(known) = KNOWN.get() else { return };
    if let Some(held) = memory::held(c"/proc/self/statm") {
        known.note.held.store(held, Relaxed);
    }
    // SAFETY: the kernel gives a valid `info`. The previous actions are restored; a signal that was sent and not caused by an instruction
    // would not come again by itself, and is sent again with the default action.
    unsafe {
        let sent = (*info).si_code <= 0;
        match SIGNALS.iter().position(|known| *known == signal) {
            Some(which) if !sent => libc::sigaction(signal, &raw const known.before[which], ptr::null_mut()),
            _ => {
                libc::signal(signal, libc::SIG_DFL);
                libc::raise(signal)
            }
        };
    }
}
