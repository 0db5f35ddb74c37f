//! Measured run of a program: exit code, processor time, memory.
use std::io;
use std::process::{Command, Stdio};
use std::time::{Duration, Instant};

/// Wall-clock time after which a program counts as hung, unless it is known to be long.
pub(super) const PATIENCE: Duration = Duration::from_mins(1);

/// Exit code and resources of a program, with all processes that it started and waited for.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Measured {
    /// Its exit code; `None` when a signal ended it.
    pub(super) code: Option<i32>,
    /// Processor time, user and system (s).
    pub(super) seconds: f64,
    /// Largest resident memory of one process (MB).
    pub(super) megabytes: f64,
}

/// Runs `command` without input and output. It is killed after `patience`.
pub(super) fn measured(command: &mut Command, patience: Duration) -> io::Result<Measured> {
    let child = command.stdin(Stdio::null()).stdout(Stdio::null()).stderr(Stdio::null()).spawn()?;
    let id = libc::pid_t::try_from(child.id()).map_err(io::Error::other)?;
    let begun = Instant::now();
    let mut is_killed = false;
    loop {
        if let Some(ended) = ended(id)? {
            return Ok(ended);
        }
        if begun.elapsed() > patience && !is_killed {
            kill(id)?;
            is_killed = true;
        }
        std::thread::sleep(Duration::from_micros(500));
    }
}

#[expect(unsafe_code, reason = "the standard library does not tell what a child took")]
fn ended(id: libc::pid_t) -> io::Result<Option<Measured>> {
    let mut status = 0;
    // SAFETY: the structure is plain numbers, for which zeros are values.
    let mut usage: libc::rusage = unsafe { std::mem::zeroed() };
    // SAFETY: both pointers are to variables that live as long as the call; this is the only wait for this child.
    match unsafe { libc::wait4(id, &raw mut status, libc::WNOHANG, &raw mut usage) } {
        0 => Ok(None),
        -1 => Err(io::Error::last_os_error()),
        _ => {
            let seconds = |time: libc::timeval| time.tv_sec as f64 + time.tv_usec as f64 * 1e-6;
            Ok(Some(Measured {
                code: libc::WIFEXITED(status).then(|| libc::WEXITSTATUS(status)),
                seconds: seconds(usage.ru_utime) + seconds(usage.ru_stime),
                megabytes: usage.ru_maxrss as f64 / 1024.0,
            }))
        }
    }
}

#[expect(
    unsafe_code,
    reason = "the child is waited for here and not by the standard library, which would kill it otherwise"
)]
fn kill(id: libc::pid_t) -> io::Result<()> {
    // SAFETY: no memory is touched; the child has not been waited for, so that its id is its own.
    if unsafe { libc::kill(id, libc::SIGKILL) } == 0 { Ok(()) } else { Err(io::Error::last_os_error()) }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn codes_and_signals_are_told_apart() {
        let of = |script: &str| measured(Command::new("sh").args(["-c", script]), PATIENCE).unwrap();
        assert_eq!(of("exit 4").code, Some(4));
        assert_eq!(of("kill -SEGV $$").code, None);
        let busy = of("i=0; while [ $i -lt 200000 ]; do i=$((i+1)); done");
        assert!(busy.seconds > 0.01 && busy.megabytes > 0.5, "{busy:?}");
    }
}
