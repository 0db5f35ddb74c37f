//! Sensors that are late: what is under way from a body, or from the motor's current, to the drive.
//!
//! An encoder with a latency τ reads y(t) = x(t − τ). A loop with the period T that samples it takes τ = m·T + d·h + s·h apart: m
//! cycles of its own, d base ticks, a share s of a tick. Travels go through, not positions, so that a loop that no position closes
//! does not depend on where the axis is:
//!
//! ```text
//! p = x(t) − x(t − s·h)      ζ = Δx + p_before − p      d ticks of ζ      their sum from sample to sample      m samples of that
//! ```
//! Between two ticks x is the cubic of Hermite, as the encoder's own (`plant::sensor::latency`).
//!
//! A current sensor tells samples of some cycles of the current loop ago, taken a share of a tick before theirs. Told in the frame
//! of the rotor as it is by then, they have turned by as much as the rotor since.
use servobench_base::{Dq, ParamError, finite, non_negative};

/// Where the drive has its positions and currents from.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Sensors {
    /// Latency of the motor's encoder (s).
    pub motor_latency: f64,
    /// Latency of the load's encoder (s).
    pub load_latency: f64,
    /// By how much the drive takes the rotor to be further than it is (rad, electrical).
    pub commutation: f64,
    /// Cycles of the current loop after which a sample of the current is told.
    pub current_delay: u32,
    /// How long before its tick it is taken (s), less than a tick.
    pub current_shift: f64,
    /// Shares by which the sensors of the phases a and b read too much.
    pub current_gain_error: [f64; 2],
}

impl Sensors {
    /// Neither late nor wrong.
    pub const IDEAL: Self = Self {
        motor_latency: 0.0,
        load_latency: 0.0,
        commutation: 0.0,
        current_delay: 0,
        current_shift: 0.0,
        current_gain_error: [0.0; 2],
    };

    /// # Errors
    /// [`ParamError`] names the first number that none can be.
    pub(crate) fn check(&self) -> Result<(), ParamError> {
        non_negative("latency of the motor's encoder", self.motor_latency)?;
        non_negative("latency of the load's encoder", self.load_latency)?;
        finite("error of the commutation", self.commutation)?;
        non_negative("sampling shift of the current sensors", self.current_shift)?;
        self.current_gain_error
            .into_iter()
            .try_for_each(|error| finite("gain error of the current sensors", error).map(|_| ()))
    }

    /// Current as the drive takes it, per true current, as a mean over a turn of the rotor: real and imaginary part.
    ///
    /// Of unequal sensors the phases a and b make (1 + g)·i + j·c·i, g = (g_a + g_b)/2 and c = (g_a − g_b)/(2·√3), and a part that
    /// turns against the rotor, which is left out.
    pub(crate) fn current_ratio(&self) -> Dq {
        let [a, b] = self.current_gain_error;
        let (gain, cross) = (1.0 + f64::midpoint(a, b), (a - b) / (2.0 * 3.0_f64.sqrt()));
        rotated(Dq { d: gain, q: cross }, -self.commutation)
    }
}

impl Default for Sensors {
    fn default() -> Self {
        Self::IDEAL
    }
}

/// `vector` times e^{j·angle}; by no angle the very same.
pub(crate) fn rotated(vector: Dq, angle: f64) -> Dq {
    times(vector, Dq { d: angle.cos(), q: angle.sin() })
}

/// The product of two complex numbers.
pub(crate) fn times(a: Dq, b: Dq) -> Dq {
    Dq { d: a.d * b.d - a.q * b.q, q: a.d * b.q + a.q * b.d }
}

/// The travel of a body on its way through a late encoder, in states from `first` on: p, ticks, the travel since the last sample,
/// cycles, position that is read.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Line {
    first: usize,
    share: f64,
    ticks: usize,
    cycles: usize,
}

/// A tick of a body: travel, and velocities per tick before and after it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Passage {
    pub(crate) travel: f64,
    pub(crate) before: f64,
    pub(crate) after: f64,
}

impl Line {
    /// For a `latency` (s) and samples every `every` ticks of `h` (s), in states from `first` on; `None` without a latency.
    pub(crate) fn new(latency: f64, every: u32, h: f64, first: usize) -> Option<Self> {
        if latency <= 0.0 {
            return None;
        }
        let ticks = (latency / h).floor();
        let share = latency / h - ticks;
        #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "a latency is 10 ms at most")]
        let (ticks, every) = (ticks as usize, every as usize);
        Some(Self { first, share, ticks: ticks % every, cycles: ticks / every })
    }

    /// Number of states.
    pub(crate) const fn states(&self) -> usize {
        3 + self.ticks + self.cycles
    }

    /// A tick of the body goes in.
    pub(crate) fn tick(&self, late: &mut [f64], Passage { travel, before, after }: Passage) {
        let line = &mut late[self.first..];
        let s = self.share;
        let part = s * travel - s * (1.0 - s) * ((before - travel) * s - (after - travel) * (1.0 - s));
        let fresh = travel + std::mem::replace(&mut line[0], part) - part;
        line[1 + self.ticks] += through(&mut line[1..=self.ticks], fresh);
    }

    /// A sample: travel from the one before to this one, as it is read. It moves the position that is read.
    pub(crate) fn sample(&self, late: &mut [f64]) -> f64 {
        let line = &mut late[self.first + 1 + self.ticks..];
        let travelled = std::mem::take(&mut line[0]);
        let read = through(&mut line[1..=self.cycles], travelled);
        line[1 + self.cycles] += read;
        read
    }

    /// The position that is read: the sum of all samples.
    pub(crate) fn position(&self, late: &[f64]) -> f64 {
        late[self.first + 2 + self.ticks + self.cycles]
    }
}

/// `value` goes into a row of the newest to the oldest, which comes out.
fn through(row: &mut [f64], value: f64) -> f64 {
    row.iter_mut().fold(value, |value, place| std::mem::replace(place, value))
}

/// Samples of the current on their way, in states from `first` on: the current a tick ago, if it counts, and the samples.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct CurrentLine {
    first: usize,
    /// Share of a tick before it at which a sample is taken.
    share: f64,
    delay: usize,
}

impl CurrentLine {
    /// In ticks of `h` (s) and states from `first` on; `None` where the current is told as it is.
    pub(crate) fn new(sensors: &Sensors, h: f64, first: usize) -> Option<Self> {
        let is_late = sensors.current_delay > 0 || sensors.current_shift > 0.0;
        let (share, delay) = (sensors.current_shift / h, sensors.current_delay as usize);
        is_late.then_some(Self { first, share, delay })
    }

    /// Number of states.
    pub(crate) const fn states(&self) -> usize {
        2 * (1 + self.delay)
    }

    /// A tick passes that begins with `current`, during which what is under way changes by `turned`, seen from the rotor.
    pub(crate) fn tick(&self, late: &mut [f64], current: Dq, turned: Dq) {
        let line = &mut late[self.first..self.first + self.states()];
        (line[0], line[1]) = (current.d, current.q);
        for sample in line.chunks_exact_mut(2) {
            sample[0] += turned.d;
            sample[1] += turned.q;
        }
    }

    /// A sample of `current` goes in; the one that is told comes out.
    pub(crate) fn sample(&self, late: &mut [f64], current: Dq) -> Dq {
        let line = &mut late[self.first..self.first + self.states()];
        let between = |now: f64, before: f64| now + self.share * (before - now);
        let sample = Dq { d: between(current.d, line[0]), q: between(current.q, line[1]) };
        line[2..].chunks_exact_mut(2).fold(sample, |sample, place| {
            let older = Dq { d: place[0], q: place[1] };
            place.copy_from_slice(&[sample.d, sample.q]);
            older
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Oracle: a cubic in time of which each tick is a polynomial, read at a time before: whatever the samples and the latency.
    #[test]
    fn what_is_read_is_the_position_of_then() {
        let h = 0.25;
        let at = |t: f64| (0.3 + t * (1.0 + t * (0.4 - 0.02 * t)), 1.0 + t * (0.8 - 0.06 * t));
        for (latency, every) in [(0.1, 1), (0.25, 1), (0.6, 2), (1.0, 4), (2.3, 4), (3.9, 3)] {
            let line = Line::new(latency, every, h, 2).unwrap();
            let mut late = vec![0.0; 2 + line.states()];
            let mut before = None;
            for k in 1..=48_u32 {
                let t = f64::from(k) * h;
                let ((from, v), (to, w)) = (at(t - h), at(t));
                line.tick(&mut late, Passage { travel: to - from, before: h * v, after: h * w });
                if k.is_multiple_of(every) {
                    line.sample(&mut late);
                    // What came before the first tick is not in the line.
                    let offset = at(t - latency).0 - line.position(&late);
                    if t > 6.0 {
                        assert!((offset - *before.get_or_insert(offset)).abs() < 1e-12, "{latency} {every}: {offset}");
                    }
                }
            }
        }
    }

    /// Oracle: the sensor's own equation: two cycles old, a quarter of a tick before.
    #[test]
    fn samples_of_the_current_wait_their_cycles() {
        let sensors = Sensors { current_delay: 2, current_shift: 0.25, ..Sensors::IDEAL };
        let line = CurrentLine::new(&sensors, 1.0, 0).unwrap();
        let mut late = vec![0.0; line.states()];
        for k in 0..9 {
            let told = line.sample(&mut late, Dq { d: f64::from(k), q: -f64::from(k) });
            if k > 2 {
                let then = f64::from(k) - 2.25;
                assert!((told.d - then).abs() < 1e-15 && (told.q + then).abs() < 1e-15, "{k}: {told:?}");
            }
            line.tick(&mut late, Dq { d: f64::from(k), q: -f64::from(k) }, Dq::default());
        }
        assert_eq!(CurrentLine::new(&Sensors::IDEAL, 1.0, 0), None);
    }

    /// Oracle: the phases by hand, α along a, averaged over a turn of the current: (1 + g_a)·α and what the sum of all three makes of β.
    #[test]
    fn gains_of_the_current_sensors_are_their_mean_and_a_turn() {
        let [a, b] = [0.07, -0.02];
        let ratio = Sensors { current_gain_error: [a, b], ..Sensors::IDEAL }.current_ratio();
        let mut mean = Dq::default();
        for k in 0..360 {
            let (sin, cos) = f64::from(k).to_radians().sin_cos();
            let phases = [(1.0 + a) * cos, (1.0 + b) * (3.0_f64.sqrt() * sin - cos) / 2.0];
            let (alpha, beta) = (phases[0], (phases[0] + 2.0 * phases[1]) / 3.0_f64.sqrt());
            mean.d += (alpha * cos + beta * sin) / 360.0;
            mean.q += (beta * cos - alpha * sin) / 360.0;
        }
        assert!((ratio.d - mean.d).abs() < 1e-14 && (ratio.q - mean.q).abs() < 1e-14, "{ratio:?} {mean:?}");
    }
}
