//! Doorbells: one process signals another that it is its turn.
//!
//! The waiting process polls the word for a moment, then sleeps in the kernel (a futex that both processes see) until the other side rings.
//! Polling pays only while the other side runs on another core: it lasts as long as a sleep and a wake-up cost, so that it never costs more
//! than twice the optimum, and is skipped for a while after it was in vain. On two cores that both have other work, processes that only
//! poll delay each other by milliseconds.
use crate::sys;
use std::hint::spin_loop;
use std::sync::atomic::{AtomicU32, Ordering::SeqCst};
use std::time::{Duration, Instant};

/// Approximate cost of going to sleep and being woken.
const LOOK: Duration = Duration::from_micros(5);
/// Polls between two readings of the clock.
const GLANCES: usize = 16;
/// Turns without polling after it was in vain.
const PAUSE: u32 = 256;

/// A word in shared memory.
#[repr(C, align(64))]
#[derive(Debug, Default)]
pub struct Doorbell {
    number: AtomicU32,
    /// Not zero: the other side sleeps until it rings.
    asleep: AtomicU32,
}

impl Doorbell {
    /// Rings with `number`. Earlier writes are visible to the side that receives it.
    #[inline]
    pub fn ring(&self, number: u32) {
        self.number.store(number, SeqCst);
        // Either the sleeper's note is seen here, or the sleeper sees the new number before it sleeps.
        if self.asleep.load(SeqCst) != 0 {
            self.wake();
        }
    }

    /// Wakes the waiting side, with a number that no order has: the other side will not ring any more.
    #[inline]
    pub fn give_up(&self) {
        self.number.fetch_xor(1 << 31, SeqCst);
        self.wake();
    }

    fn wake(&self) {
        sys::wake(&self.number);
    }

    /// `true` when it has rung with `number`, also where the other side has given up after that.
    #[must_use]
    #[inline]
    pub fn has_rung(&self, number: u32) -> bool {
        self.number.load(SeqCst) & (u32::MAX >> 1) == number
    }

    fn rings(&self, number: u32) -> bool {
        self.number.load(SeqCst) == number
    }
}

/// The waiting side of a doorbell; learns whether polling pays.
#[derive(Debug, Default)]
pub struct Listener {
    /// Turns until it polls again.
    pause: u32,
}

impl Listener {
    /// Waits until `doorbell` rings with `number`. Meanwhile calls `go_on` at least every `glance`, and before each sleep; returns `false`
    /// when that returned `false` first.
    #[inline]
    pub fn wait(
        &mut self,
        doorbell: &Doorbell,
        number: u32,
        glance: Duration,
        mut go_on: impl FnMut() -> bool,
    ) -> bool {
        if self.look(doorbell, number) {
            return true;
        }
        doorbell.asleep.store(1, SeqCst);
        let rung = loop {
            // Read before `go_on` is called: a later change of the number then prevents the sleep.
            let present = doorbell.number.load(SeqCst);
            if present == number {
                break true;
            }
            if !go_on() {
                break false;
            }
            sys::sleep_while(&doorbell.number, present, glance);
        };
        doorbell.asleep.store(0, SeqCst);
        rung
    }

    fn look(&mut self, doorbell: &Doorbell, number: u32) -> bool {
        if self.pause > 0 {
            self.pause -= 1;
            return doorbell.rings(number);
        }
        let start = Instant::now();
        loop {
            for _ in 0..GLANCES {
                if doorbell.rings(number) {
                    return true;
                }
                spin_loop();
            }
            if start.elapsed() > LOOK {
                self.pause = PAUSE;
                return false;
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::thread;

    const GLANCE: Duration = Duration::from_mins(1);

    /// Both sides count the rings they receive: no ring is lost, whether received awake or asleep. A lost one would cost a minute.
    #[test]
    fn no_ring_is_lost() {
        const TURNS: u32 = 20_000;
        let (there, back) = (Doorbell::default(), Doorbell::default());
        thread::scope(|scope| {
            scope.spawn(|| {
                let mut listener = Listener::default();
                for turn in 1..=TURNS {
                    assert!(listener.wait(&there, turn, GLANCE, || true));
                    back.ring(turn);
                }
            });
            let mut listener = Listener::default();
            for turn in 1..=TURNS {
                there.ring(turn);
                assert!(listener.wait(&back, turn, GLANCE, || true));
            }
        });
    }

    /// A side that looks late finds both: that it has rung, and that it will not again.
    #[test]
    fn what_has_rung_is_known_after_it_has_given_up() {
        let doorbell = Doorbell::default();
        doorbell.ring(7);
        doorbell.give_up();
        assert!(doorbell.has_rung(7) && !doorbell.rings(7));
        assert!(!doorbell.has_rung(6));
    }

    #[test]
    fn one_that_gives_up_wakes_who_waits() {
        let doorbell = Doorbell::default();
        let over = std::sync::atomic::AtomicBool::new(false);
        thread::scope(|scope| {
            let waits = scope.spawn(|| Listener::default().wait(&doorbell, 7, GLANCE, || !over.load(SeqCst)));
            over.store(true, SeqCst);
            doorbell.give_up();
            assert!(!waits.join().unwrap());
        });
    }

    #[test]
    fn who_waits_in_vain_is_asked_again_and_again() {
        let mut left = 3;
        let go_on = || {
            left -= 1;
            left > 0
        };
        assert!(!Listener::default().wait(&Doorbell::default(), 7, Duration::from_micros(1), go_on));
        assert_eq!(left, 0);
    }
}
