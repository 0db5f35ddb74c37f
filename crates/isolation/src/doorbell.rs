//! Doorbells: one process tells another that it is its turn.
//!
//! Whoever waits looks at the word for a moment, then sleeps in the kernel (a futex that both processes see) until the other
//! side rings. Looking pays only while the other side runs on another core: for as long as a sleep and a waking cost, so that
//! it never costs more than twice what would have been best, and not for a while after it was in vain. On two cores that both
//! have other work, processes that only look get milliseconds in each other's way.
use crate::sys;
use std::hint::spin_loop;
use std::sync::atomic::{AtomicU32, Ordering::SeqCst};
use std::time::{Duration, Instant};

/// About what going to sleep and being woken costs.
const LOOK: Duration = Duration::from_micros(5);
/// Looks between two glances at the clock.
const GLANCES: usize = 16;
/// Turns without looking after it was in vain.
const PAUSE: u32 = 256;

/// A word in memory that both see.
#[repr(C, align(64))]
#[derive(Debug, Default)]
pub struct Doorbell {
    number: AtomicU32,
    /// Not zero: somebody sleeps until it rings.
    asleep: AtomicU32,
}

impl Doorbell {
    /// Rings with `number`. What was written before is seen by who hears it.
    #[inline]
    pub fn ring(&self, number: u32) {
        self.number.store(number, SeqCst);
        // Either the sleeper's note is seen here, or the sleeper sees the new number before it sleeps.
        if self.asleep.load(SeqCst) != 0 {
            self.wake();
        }
    }

    /// Wakes who waits, with a number that is no order's: the other side will not ring any more.
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

/// One that waits for a doorbell, and learns whether looking pays.
#[derive(Debug, Default)]
pub struct Listener {
    /// Turns until it looks again.
    pause: u32,
}

impl Listener {
    /// Waits until `doorbell` rings with `number`. Meanwhile `go_on` is asked at least every `glance`, and before each sleep;
    /// `false` when it said so first.
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
            // Read before `go_on` is asked: what happens after that changes it, and nobody falls asleep over it.
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

    /// Both sides count what they hear: no ring is lost, whether it is heard awake or asleep. A lost one would cost a minute.
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

    /// Who looks late finds both: that it has rung, and that it will not again.
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
