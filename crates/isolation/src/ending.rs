//! The end of a process, in words.
use crate::memory::in_words;
use crate::sys;
use std::process::ExitStatus;

/// Messages of libraries that get no memory: Rust's allocator, C++'s `new`, Python, and the system's own words (ENOMEM).
const NO_MEMORY: [&str; 4] = ["memory allocation of ", "std::bad_alloc", "MemoryError", "Cannot allocate memory"];

/// End of a contained process, with the memory that it held and the processes that it left behind.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Ending {
    /// Its exit status, unless it was killed for its memory.
    pub status: Option<ExitStatus>,
    /// Private memory that it held when it crashed or was killed (B); 0 if unknown.
    pub held: u64,
    /// Its memory limit (B).
    pub bound: u64,
    /// True if it was killed for exceeding the limit, private and shared memory together.
    pub exceeded: bool,
    /// The end of its output on standard error.
    pub last_words: String,
    /// Number of processes that it had started and left behind; they were killed.
    pub left: usize,
    /// Names of the first few of them.
    pub names: Vec<String>,
    /// Its process id; `None` if unknown.
    pub process: Option<u32>,
}

impl Ending {
    /// True if it ended by itself with exit code 0.
    #[must_use]
    pub fn is_orderly(&self) -> bool {
        self.status.is_some_and(|status| status.success())
    }

    /// True if it ran out of memory, as far as this can be detected from outside.
    ///
    /// A buffer that grows by doubling requests twice its size, and holds both while it copies: a process that crashes with a third of its
    /// limit may have been refused more.
    #[must_use]
    pub fn of_memory(&self) -> bool {
        self.refused() || self.held >= self.bound / 3
    }

    /// True if it was refused memory: its output contains such a message, or it held all but the size of a usual request.
    fn refused(&self) -> bool {
        self.held >= self.bound / 10 * 9 || NO_MEMORY.iter().any(|words| self.last_words.contains(words))
    }

    /// The complete description.
    #[must_use]
    pub fn how(&self) -> String {
        let bound = in_words(self.bound);
        if self.exceeded {
            let held = in_words(self.held);
            return self.with_last_words(format!(
                "it took {held} of memory, private and shared, of the {bound} that it may have"
            ));
        }
        let memory = match (self.refused(), self.of_memory()) {
            (true, _) => Some(format!("it asked for more memory than the {bound} that it may have")),
            (_, true) => Some(format!(
                "it held {} of the {bound} of memory that it may have and probably asked for more",
                in_words(self.held)
            )),
            _ => None,
        };
        let parts = memory.into_iter().chain(self.status.map(status_in_words)).collect::<Vec<_>>().join(", then ");
        self.with_last_words(parts)
    }

    fn with_last_words(&self, how: String) -> String {
        let how = how + &self.left_in_words().map_or_else(String::new, |left| format!("; {left}"));
        if self.last_words.is_empty() { how } else { format!("{how}; its last words: {}", self.last_words) }
    }

    /// Processes that it had started and left behind, in words; `None` if there were none.
    #[must_use]
    pub fn left_in_words(&self) -> Option<String> {
        let named: Vec<String> = self.names.iter().map(|name| format!("`{}`", name.escape_debug())).collect();
        let named = if named.is_empty() { String::new() } else { format!(" ({})", named.join(", ")) };
        match self.left {
            0 => None,
            1 => Some(format!("it left a process{named}, which was ended")),
            left => Some(format!("it left {left} processes{named}, which were ended")),
        }
    }
}

fn status_in_words(status: ExitStatus) -> String {
    match (status.code(), sys::signal_of(status)) {
        (Some(code), _) => format!("exit code {code}"),
        (None, Some(number)) => match name(number) {
            Some(name) => format!("signal {number} ({name})"),
            None => format!("signal {number}"),
        },
        (None, None) => status.to_string(),
    }
}

/// Names of the signals that end processes, by their numbers on all kinds of machine that Linux names alike (POSIX.1-2017,
/// `signal.h`; signal(7)).
fn name(number: i32) -> Option<&'static str> {
    Some(match number {
        4 => "SIGILL: an illegal instruction",
        5 => "SIGTRAP",
        6 => "SIGABRT: it gave up itself",
        7 => "SIGBUS: an address without memory",
        8 => "SIGFPE: an integer division by zero or the like",
        9 => "SIGKILL: ended from outside, which the system does when memory runs out",
        11 => "SIGSEGV: an address that is not its own",
        13 => "SIGPIPE",
        14 => "SIGALRM",
        15 => "SIGTERM: ended from outside",
        24 => "SIGXCPU",
        25 => "SIGXFSZ",
        31 => "SIGSYS: a call of the system that it may not make",
        _ => return None,
    })
}

#[cfg(all(test, unix))]
mod tests {
    use super::*;
    use std::os::unix::process::ExitStatusExt as _;

    fn ending(raw: i32, held: u64, last_words: &str) -> Ending {
        Ending {
            status: Some(ExitStatus::from_raw(raw)),
            held,
            bound: 3_000_000_000,
            exceeded: false,
            last_words: last_words.into(),
            left: 0,
            names: Vec::new(),
            process: None,
        }
    }

    /// A wait status: the signal, or the exit code times 256 (wait(2)).
    #[test]
    fn signals_and_codes_are_named() {
        assert_eq!(ending(11, 0, "").how(), "signal 11 (SIGSEGV: an address that is not its own)");
        assert_eq!(ending(3 << 8, 0, "no licence").how(), "exit code 3; its last words: no licence");
        assert_eq!(ending(40, 0, "").how(), "signal 40");
    }

    #[test]
    fn one_that_ran_out_of_its_memory_is_called_so() {
        let said = "it asked for more memory than the 3.0 GB that it may have";
        assert!(ending(11, 2_700_000_000, "").how().starts_with(said));
        let how = ending(11, 1_000_000_000, "").how();
        assert!(
            how.starts_with("it held 1.0 GB of the 3.0 GB of memory that it may have and probably asked for more"),
            "{how}"
        );
        assert!(!ending(11, 999_999_999, "").of_memory());
        let how = ending(6, 0, "memory allocation of 8 bytes failed").how();
        assert!(how.starts_with(said) && how.contains("signal 6") && how.ends_with("8 bytes failed"), "{how}");
        let ended = Ending { status: None, ..ending(9, 3_000_000_000, "") };
        assert_eq!(ended.how(), said);
        let shared = Ending { exceeded: true, ..ending(9, 3_100_000_000, "") };
        assert_eq!(shared.how(), "it took 3.1 GB of memory, private and shared, of the 3.0 GB that it may have");
    }

    #[test]
    fn what_it_left_is_named() {
        let left = |names: &[&str], left| Ending {
            left,
            names: names.iter().map(ToString::to_string).collect(),
            ..ending(0, 0, "")
        };
        assert_eq!(left(&[], 0).left_in_words(), None);
        assert_eq!(left(&["sleep"], 1).left_in_words().unwrap(), "it left a process (`sleep`), which was ended");
        assert_eq!(left(&["sleep"], 1).how(), "exit code 0; it left a process (`sleep`), which was ended");
        let three = left(&["a", "\u{1b}[2J"], 3).left_in_words().unwrap();
        assert_eq!(three, "it left 3 processes (`a`, `\\u{1b}[2J`), which were ended");
    }
}
