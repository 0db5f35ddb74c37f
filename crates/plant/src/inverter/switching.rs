//! A switching inverter, and the winding on it: solved from edge to edge, as precisely as the winding can be. That of an ideal
//! motor is solved to the rounding.
//!
//! ```text
//! carrier    middle of vector 111 ─ leg x goes down at d_x·T/2 ─ T/2, middle of 000 ─ leg x goes up at T − d_x·T/2 ─ T
//! edge       both devices off: the leg is at the rail of its current, up for i_x ≤ 0, down for i_x > 0; t_d later at its new one
//! between    u = U_dc·(levels) − U_T·sgn(i_x) − r·i_x, the signs of when it begins      solved by the motor's winding
//! ```
//! Duties come from [`modulation`](super::modulation) at every middle of the carrier, so a drive may renew its voltage twice in a period.
//! A tick begins in a middle, or one tick in several does: there the ripple of the current is zero, and a sample of the drive is its
//! mean. A pulse shorter than the dead time is lost, or becomes longer, as on the real bridge: an edge within the dead time of the one
//! before replaces it.
//!
//! The [`Ripple`] of a tick comes from the same segments: its mean square is the integral over each, its peak the largest length at their
//! ends. Between two edges the current vector moves along a line that resistance and rotation bend little, and a line is longest at one
//! of its ends.
//!
//! Left out: a current that reaches zero within a dead time blocks its diode in a real leg, and stays zero until the device turns on;
//! here it continues through zero for the rest of t_d, by at most t_d·U_dc/L. A threshold keeps its sign from edge to edge.
#![expect(clippy::inline_always, reason = "what is inlined is compiled for the registers of its caller")]
use super::legs::{Legs, legs, vector};
use super::modulation::duties;
use super::params::Params;
use super::tick::{Input, Ripple, Tick};
use crate::pmsm::{self, Equations, Span, Sums, Winding};
use servobench_base::{AlphaBeta, Dq, ParamError, Rotation, Stateful, wide_registers};

/// Ratio of the carrier to the base tick.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Meshing {
    /// Periods per tick.
    Periods(u32),
    /// Ticks per period, two at least.
    Ticks(u32),
}

/// Constants of a run.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Switching {
    equations: Equations,
    meshing: Meshing,
    /// Half a period of the carrier (s).
    half: f64,
    /// Length of a tick (s).
    h: f64,
    dead_time: f64,
    drop: f64,
    resistance: f64,
}

/// State of the bridge from tick to tick, beside the current.
#[derive(Debug, Clone, Copy, PartialEq, Stateful)]
pub(crate) struct Bridge {
    /// Ticks since the period began.
    tick: u32,
    /// True for each leg at the upper rail.
    up: [bool; 3],
    /// Last command of each leg: true for up.
    told: [bool; 3],
    /// Times of the next command and of the turn-on of the new device, from the start of the half period (s); infinite: not in this half.
    edge: Legs,
    on: Legs,
}

impl Default for Bridge {
    /// In the middle of vector 111.
    fn default() -> Self {
        Self { tick: 0, up: [true; 3], told: [true; 3], edge: [f64::INFINITY; 3], on: [f64::INFINITY; 3] }
    }
}

impl Meshing {
    /// Ratio for a carrier of `carrier` (Hz) with ticks of `h` (s), `None` if neither is a whole multiple of the other.
    fn of(carrier: f64, h: f64) -> Option<Self> {
        // Within the rounding of a period.
        #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "a whole number up to a million")]
        let whole =
            |ratio: f64| ((ratio - ratio.round()).abs() < 1e-9 * ratio && ratio < 1e6).then(|| ratio.round() as u32);
        let ratio = carrier * h;
        if ratio > 0.5 { whole(ratio).map(Self::Periods) } else { whole(1.0 / ratio).map(Self::Ticks) }
    }
}

impl Switching {
    /// An inverter for `motor`, in ticks of `h` (s).
    ///
    /// # Errors
    /// [`ParamError`] if carrier and ticks do not fit together.
    pub(crate) fn new(p: &Params, motor: &pmsm::Params, h: f64) -> Result<Self, ParamError> {
        let Some(meshing) = Meshing::of(p.carrier, h) else {
            let bound = "a whole number of times the base rate, or the base rate one of it";
            return Err(ParamError { name: super::Parameter::CARRIER.name, value: p.carrier, bound });
        };
        let half = match meshing {
            Meshing::Periods(periods) => 0.5 * h / f64::from(periods),
            Meshing::Ticks(ticks) => 0.5 * h * f64::from(ticks),
        };
        Ok(Self {
            equations: Equations::new(motor, p.on_resistance),
            meshing,
            half,
            h,
            dead_time: p.dead_time,
            drop: p.device_drop,
            resistance: p.on_resistance,
        })
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
    pub(crate) fn step<const POWER: bool, W: Winding>(
        &self,
        winding: &W,
        bridge: &mut Bridge,
        current: &mut Dq,
        u: &Input,
    ) -> Tick {
        wide_registers!(
            self.solved::<POWER, W>(winding, bridge, current, u),
            Self::in_wide_registers::<POWER, W>,
            self,
            winding,
            bridge,
            current,
            u
        )
    }

    #[cfg(target_arch = "x86_64")]
    #[target_feature(enable = "avx2")]
    fn in_wide_registers<const POWER: bool, W: Winding>(
        &self,
        winding: &W,
        bridge: &mut Bridge,
        current: &mut Dq,
        u: &Input,
    ) -> Tick {
        self.solved::<POWER, W>(winding, bridge, current, u)
    }

    #[inline(always)]
    fn solved<const POWER: bool, W: Winding>(
        &self,
        winding: &W,
        bridge: &mut Bridge,
        current: &mut Dq,
        u: &Input,
    ) -> Tick {
        let before = *current;
        let duties = duties(u.wanted, u.u_dc);
        let mut way = Way::<POWER, W> {
            on: self,
            winding,
            u,
            duties: duties.of,
            bridge,
            i: before,
            rotor: u.rotor,
            sums: Sums::default(),
            fluxes: [0.0; 2],
            peak: square(before),
        };
        for k in 0..self.pieces(way.bridge.tick) {
            way.go(self.piece(way.bridge.tick, k));
        }
        way.bridge.tick = self.next(way.bridge.tick);
        let Way { i, sums, fluxes, peak, .. } = way;
        *current = i;
        let stored = if POWER { winding.stored(before, i) } else { 0.0 };
        let per = 1.0 / self.h;
        let voltage = AlphaBeta { alpha: fluxes[0] * per, beta: fluxes[1] * per };
        let over = (self.resistance, u.omega_e, self.h);
        let ripple = Ripple { peak: libm::sqrt(peak), rms: libm::sqrt(sums.square * per) };
        Tick { ripple, ..Tick::of::<POWER, W>(winding, &sums, stored, over, (voltage, duties.shortened)) }
    }

    /// Advances by the same time without current or voltage: the carrier continues.
    pub(crate) fn rest(&self, bridge: &mut Bridge) {
        *bridge = Bridge { tick: self.next(bridge.tick), ..Bridge::default() };
    }

    /// Number, within its period, of the tick that follows `at`.
    #[inline(always)]
    const fn next(&self, at: u32) -> u32 {
        match self.meshing {
            Meshing::Periods(_) => 0,
            Meshing::Ticks(ticks) => (at + 1) % ticks,
        }
    }

    /// Number of parts of half periods in the tick `at` of a period.
    #[inline(always)]
    const fn pieces(&self, at: u32) -> u32 {
        match self.meshing {
            Meshing::Periods(periods) => 2 * periods,
            Meshing::Ticks(ticks) => 1 + (2 * at < ticks && 2 * at + 2 > ticks) as u32,
        }
    }

    /// The `k`-th of these parts.
    #[inline(always)]
    fn piece(&self, at: u32, k: u32) -> Piece {
        let (h, half) = (self.h, self.half);
        let Meshing::Ticks(ticks) = self.meshing else {
            return Piece { second: k % 2 == 1, begins: true, ends: true, from: 0.0, to: half };
        };
        let is_last = at + 1 == ticks;
        let (from, to) = (h * f64::from(at), if is_last { 2.0 * half } else { h * f64::from(at + 1) });
        if 2 * at < ticks && k == 0 {
            let ends = 2 * at + 2 >= ticks;
            return Piece { second: false, begins: at == 0, ends, from, to: if ends { half } else { to } };
        }
        let begins = 2 * at <= ticks;
        Piece { second: true, begins, ends: is_last, from: if begins { 0.0 } else { from - half }, to: to - half }
    }
}

/// A part of a half period: `second` is false for the half in which legs go down; `begins` and `ends` tell that the half begins and
/// ends with it; `from` and `to` are times in the half (s).
#[derive(Debug, Clone, Copy, PartialEq)]
struct Piece {
    second: bool,
    begins: bool,
    ends: bool,
    from: f64,
    to: f64,
}

/// State within a tick.
struct Way<'a, const POWER: bool, W> {
    on: &'a Switching,
    winding: &'a W,
    u: &'a Input,
    duties: Legs,
    bridge: &'a mut Bridge,
    i: Dq,
    rotor: Rotation,
    sums: Sums,
    /// ∫ u dt in the stator frame (V·s).
    fluxes: [f64; 2],
    /// Largest square of the current so far (A²).
    peak: f64,
}

#[inline(always)]
fn square(i: Dq) -> f64 {
    i.d * i.d + i.q * i.q
}

impl<const POWER: bool, W: Winding> Way<'_, POWER, W> {
    #[inline(always)]
    fn go(&mut self, piece: Piece) {
        if piece.begins {
            self.begin(piece.second);
        }
        self.until(piece.from, piece.to);
        if piece.ends {
            // Times to come are counted from the end of the half period.
            self.bridge.on = self.bridge.on.map(|on| on - self.on.half);
        }
    }

    /// Takes the duties for a half period: the first, in which legs go down, or the second, in which they go up.
    #[inline(always)]
    fn begin(&mut self, second: bool) {
        for x in 0..3 {
            let d = self.duties[x];
            let (first, share) = if second { (d >= 1.0, 1.0 - d) } else { (d > 0.0, d) };
            let changes = d > 0.0 && d < 1.0;
            if self.bridge.told[x] != first {
                self.tell(x, first, 0.0);
            }
            self.bridge.edge[x] = if changes { share * self.on.half } else { f64::INFINITY };
        }
    }

    /// Advances from `from` to `to` of a half period (s).
    #[inline(always)]
    fn until(&mut self, from: f64, to: f64) {
        let mut at = from;
        loop {
            let Bridge { edge, on, .. } = &*self.bridge;
            let next = edge[0].min(edge[1]).min(edge[2]).min(on[0].min(on[1]).min(on[2]));
            let end = next.min(to);
            if end > at {
                self.segment(end - at);
                at = end;
            }
            if next > to {
                return;
            }
            for x in 0..3 {
                if self.bridge.on[x] <= at {
                    self.bridge.up[x] = self.bridge.told[x];
                    self.bridge.on[x] = f64::INFINITY;
                }
                if self.bridge.edge[x] <= at {
                    self.bridge.edge[x] = f64::INFINITY;
                    let told = !self.bridge.told[x];
                    self.tell(x, told, at);
                }
            }
        }
    }

    /// Commands leg `x` to go `up`, or down, at `at` (s).
    #[inline(always)]
    fn tell(&mut self, x: usize, up: bool, at: f64) {
        self.bridge.told[x] = up;
        if self.on.dead_time > 0.0 {
            self.bridge.up[x] = self.currents()[x] <= 0.0;
            self.bridge.on[x] = at + self.on.dead_time;
        } else {
            self.bridge.up[x] = up;
        }
    }

    #[inline(always)]
    fn currents(&self) -> Legs {
        legs(self.i.to_alpha_beta(self.rotor))
    }

    /// Advances for `time` (s) without an edge.
    #[inline(always)]
    fn segment(&mut self, time: f64) {
        let u_dc = self.u.u_dc;
        let mut voltage = vector(self.bridge.up.map(|up| if up { u_dc } else { 0.0 }));
        let mut drop = AlphaBeta::default();
        if self.on.drop > 0.0 {
            drop = vector(self.currents().map(|i| if i == 0.0 { 0.0 } else { self.on.drop.copysign(i) }));
            voltage = AlphaBeta { alpha: voltage.alpha - drop.alpha, beta: voltage.beta - drop.beta };
        }
        self.fluxes = [self.fluxes[0] + time * voltage.alpha, self.fluxes[1] + time * voltage.beta];
        let omega = self.u.omega_e;
        let over = Span { voltage, drop, rotor: self.rotor, omega, time };
        self.i = self.winding.advance::<POWER>(self.i, &over, &mut self.sums);
        self.peak = self.peak.max(square(self.i));
        self.rotor = self.rotor.ahead(omega * time);
    }
}

#[cfg(test)]
mod tests;
