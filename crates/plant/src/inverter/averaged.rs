//! Voltage loss by dead time and devices, averaged over the carrier.
//!
//! ```text
//! ū_x = ū_x,ideal − E·sgn(i_x) − r·i_x        E = t_d·f_carrier·U_dc + U_T        x = a, b, c
//! ```
//! A leg whose devices are both off is at the rail to which its diodes lead the current: with i_x > 0, out of the leg, the lower one. That
//! takes t_d of the upper rail once in a period; with i_x < 0 it adds as much. Transistor and diode have the same threshold U_T and the
//! same resistance r. With one leg against two, the space vector of the error is 4/3·E long and turns in steps of 60°; its fundamental is
//! 4/π·E. Source: Holmes & Lipo, *Pulse Width Modulation for Power Converters* (the lost pulse); Jeong & Park, *IEEE
//! Transactions on Industrial Electronics* 38(2), 1991 (the mean over a period).
//!
//! # A tick
//!
//! r is in series with the winding and part of its equations; so it acts on the actual current, however short L/R is. As long as no
//! current changes its sign, E·sgn(i_x) is a stationary voltage, on which the winding is as exact as on any. Where a current reaches
//! zero within a tick, the tick ends there, and another one begins.
//!
//! A current that the error would reverse is held at zero (zero-current clamping): with both devices off and no current, the diodes block,
//! and the motor determines the potential of the leg. So E·sgn(0) is whatever holds the current, up to E. From a zero on, held and
//! non-zero currents are solved by the winding's own [response](super::held) to a voltage over the rest of the tick: currents at its end
//! have the sign that their error opposes, and a second zero in one tick is at its end. Below 4/3·E along a phase, a motor takes no
//! current at all.
use super::held::{self, Response, changed};
use super::legs::{Legs, legs, vector};
use super::params::Params;
use super::tick::{Input, Tick};
use crate::pmsm::{self, Equations, Span, Sums, Winding};
use servobench_base::{AlphaBeta, Dq, Rotation};

/// Precision of a zero: relative to the change of the current in the remaining time, and least time to it, relative to the same
/// time.
const AT_ZERO: f64 = 1e-9;
/// Share of the largest current below which a leg has none: the sum of the three has roundings.
const NO_CURRENT: f64 = 1e-12;
/// Maximum steps towards a zero; the false position with halved ends takes six for a decay over its own time constant.
const MOST_STEPS: u32 = 24;
/// Maximum solutions of a winding that saturates: each corrects the free current by the error of the one before.
const MOST_TRIALS: u32 = 8;
/// Largest deviation of the current from the response, relative to the effect of the error: without saturation it is only
/// rounding.
const AS_SAID: f64 = 1e-9;

/// Voltage error of each leg of an averaged inverter.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Averaged {
    equations: Equations,
    /// Dead time in periods of the carrier.
    dead: f64,
    /// Threshold of a device (V).
    drop: f64,
    /// Resistance of a device (Ω).
    resistance: f64,
    /// Length of a tick (s).
    h: f64,
}

impl Averaged {
    /// The errors for `motor`, in ticks of `h` (s).
    pub(crate) fn new(p: &Params, motor: &pmsm::Params, h: f64) -> Self {
        Self {
            equations: Equations::new(motor, p.on_resistance),
            dead: p.dead_time * p.carrier,
            drop: p.device_drop,
            resistance: p.on_resistance,
            h,
        }
    }

    /// True if there is no error.
    pub(crate) fn is_ideal(&self) -> bool {
        self.dead + self.drop + self.resistance == 0.0
    }

    /// The winding of a motor without effects.
    pub(crate) const fn equations(&self) -> &Equations {
        &self.equations
    }

    /// Resistance of the devices before each phase (Ω).
    pub(crate) const fn resistance(&self) -> f64 {
        self.resistance
    }

    /// Advances from tick k to k+1 with this winding, whose resistance includes that of the devices; without `POWER` the powers and the
    /// loss are left out.
    pub(crate) fn step<const POWER: bool, W: Winding>(&self, winding: &W, current: &mut Dq, u: &Input) -> Tick {
        let (before, ideal) = (*current, super::output(u.wanted, u.u_dc));
        let most = self.drop + self.dead * u.u_dc;
        let share = if most > 0.0 { self.drop / most } else { 0.0 };
        let mut way = Way::<POWER, W> {
            winding,
            ideal,
            omega: u.omega_e,
            share,
            i: before,
            rotor: u.rotor,
            left: self.h,
            sums: Sums::default(),
            taken: AlphaBeta::default(),
        };
        way.go(most);
        let Way { i, rotor, sums, taken, .. } = way;
        *current = i;
        let ends = [before.to_alpha_beta(u.rotor), i.to_alpha_beta(rotor)];
        let (per, ohmic) = (1.0 / self.h, 0.5 * self.resistance);
        let voltage = AlphaBeta {
            alpha: ideal.alpha - per * taken.alpha - ohmic * (ends[0].alpha + ends[1].alpha),
            beta: ideal.beta - per * taken.beta - ohmic * (ends[0].beta + ends[1].beta),
        };
        let stored = if POWER { winding.stored(before, i) } else { 0.0 };
        let over = (self.resistance, u.omega_e, self.h);
        Tick::of::<POWER, W>(winding, &sums, stored, over, (voltage, super::falls_short(ideal, u.wanted)))
    }
}

/// State within a tick.
struct Way<'a, const POWER: bool, W> {
    winding: &'a W,
    ideal: AlphaBeta,
    omega: f64,
    /// Share of the threshold in the error.
    share: f64,
    i: Dq,
    rotor: Rotation,
    /// Remaining time of the tick (s).
    left: f64,
    sums: Sums,
    /// ∫ e dt (V·s).
    taken: AlphaBeta,
}

impl<const POWER: bool, W: Winding> Way<'_, POWER, W> {
    /// Advances to the end of the tick, with an error of `most` (V) per leg.
    fn go(&mut self, most: f64) {
        if most == 0.0 {
            self.take(AlphaBeta::default(), self.left);
            return;
        }
        let before = legs(self.i.to_alpha_beta(self.rotor));
        let largest = before.iter().fold(0.0, |most: f64, i| most.max(i.abs()));
        if !before.iter().any(|i| i.abs() <= NO_CURRENT * largest) {
            let error = vector(before.map(|i| most.copysign(i)));
            let mut sums = Sums::default();
            let end = self.winding.advance::<POWER>(self.i, &self.over(error, self.left), &mut sums);
            let after = self.after(end, self.left);
            let Some((leg, when)) = first_zero(before, after) else {
                self.accept(end, &sums, error, self.left);
                return;
            };
            if when > AT_ZERO {
                self.follow_to_zero(error, leg, [before[leg], after[leg]]);
            }
        }
        self.finish_from_zero(most);
    }

    fn over(&self, error: AlphaBeta, time: f64) -> Span {
        let voltage = AlphaBeta { alpha: self.ideal.alpha - error.alpha, beta: self.ideal.beta - error.beta };
        let drop = AlphaBeta { alpha: self.share * error.alpha, beta: self.share * error.beta };
        Span { voltage, drop, rotor: self.rotor, omega: self.omega, time }
    }

    /// Currents of the legs after `time`, with `end` in the rotor's frame.
    fn after(&self, end: Dq, time: f64) -> Legs {
        legs(end.to_alpha_beta(self.rotor.ahead(self.omega * time)))
    }

    fn take(&mut self, error: AlphaBeta, time: f64) {
        let mut sums = Sums::default();
        let end = self.winding.advance::<POWER>(self.i, &self.over(error, time), &mut sums);
        self.accept(end, &sums, error, time);
    }

    fn accept(&mut self, end: Dq, sums: &Sums, error: AlphaBeta, time: f64) {
        self.i = end;
        self.rotor = self.rotor.ahead(self.omega * time);
        self.left -= time;
        self.sums.add(sums);
        self.taken.alpha += time * error.alpha;
        self.taken.beta += time * error.beta;
    }

    /// Advances to the zero of the current of `leg`, which has these values at the `ends` of the time: by false position; an end that
    /// stays is halved.
    fn follow_to_zero(&mut self, error: AlphaBeta, leg: usize, ends: [f64; 2]) {
        let ([mut low, mut high], [mut at_low, mut at_high]) = ([0.0, self.left], ends);
        let enough = AT_ZERO * (ends[0] - ends[1]).abs();
        let (mut time, mut last) = (self.left, 0);
        for _ in 0..MOST_STEPS {
            time = (low * at_high - high * at_low) / (at_high - at_low);
            let end = self.winding.advance::<false>(self.i, &self.over(error, time), &mut Sums::default());
            let here = self.after(end, time)[leg];
            if here.abs() <= enough {
                break;
            }
            if (here > 0.0) == (ends[0] > 0.0) {
                (low, at_low) = (time, here);
                at_high *= if last == -1 { 0.5 } else { 1.0 };
                last = -1;
            } else {
                (high, at_high) = (time, here);
                at_low *= if last == 1 { 0.5 } else { 1.0 };
                last = 1;
            }
        }
        self.take(error, time);
    }

    /// Solves the rest of the tick, with a leg that has no current.
    fn finish_from_zero(&mut self, most: f64) {
        let time = self.left;
        let end_of = |way: &Self, error: AlphaBeta| {
            let end = way.winding.advance::<false>(way.i, &way.over(error, time), &mut Sums::default());
            end.to_alpha_beta(way.rotor.ahead(way.omega * time))
        };
        let mut free = end_of(self, AlphaBeta::default());
        let less = |a: AlphaBeta, b: AlphaBeta| AlphaBeta { alpha: a.alpha - b.alpha, beta: a.beta - b.beta };
        let [along_alpha, along_beta] = [AlphaBeta { alpha: most, beta: 0.0 }, AlphaBeta { alpha: 0.0, beta: most }]
            .map(|e| less(free, end_of(self, e)));
        let m: Response =
            [[along_alpha.alpha / most, along_beta.alpha / most], [along_alpha.beta / most, along_beta.beta / most]];
        let size = most * (m[0][0] + m[1][1]);
        let mut trials = 0;
        loop {
            let error = held::error(free, &m, most);
            let mut sums = Sums::default();
            let end = self.winding.advance::<POWER>(self.i, &self.over(error, time), &mut sums);
            let off = less(end.to_alpha_beta(self.rotor.ahead(self.omega * time)), less(free, changed(&m, error)));
            trials += 1;
            // A not-a-number result is not repeated.
            let is_off = off.alpha.abs().max(off.beta.abs()) > AS_SAID * size;
            if !is_off || trials == MOST_TRIALS {
                self.accept(end, &sums, error, time);
                return;
            }
            free = AlphaBeta { alpha: free.alpha + off.alpha, beta: free.beta + off.beta };
        }
    }
}

/// The leg whose current changes its sign first, and the share of the time until then if it falls evenly.
fn first_zero(before: Legs, after: Legs) -> Option<(usize, f64)> {
    let zeros = (0..3).filter(|x| before[*x] * after[*x] < 0.0).map(|x| (x, before[x] / (before[x] - after[x])));
    zeros.min_by(|a, b| a.1.total_cmp(&b.1))
}

#[cfg(test)]
mod tests;
