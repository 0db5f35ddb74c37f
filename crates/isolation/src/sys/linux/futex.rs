//! Sleeping until a number in memory that several processes see changes (futex(2)).
use rustix::thread::futex;
use std::sync::atomic::AtomicU32;
use std::time::Duration;

/// Wakes one thread that sleeps on `number`.
pub(crate) fn wake(number: &AtomicU32) {
    // It fails for a wrong address only, on which no thread can sleep.
    futex::wake(number, futex::Flags::empty(), 1).ok();
}

/// Sleeps while `number` is `present`, at most for `limit`; may also return earlier.
pub(crate) fn sleep_while(number: &AtomicU32, present: u32, limit: Duration) {
    // A duration that is too long for the kernel's clock is treated as elapsed: the caller comes back.
    if let Ok(limit) = futex::Timespec::try_from(limit) {
        // The number has changed, the time is over or a signal came: the caller checks.
        futex::wait(number, futex::Flags::empty(), present, Some(&limit)).ok();
    }
}
