//! Whether the exchange itself drives an oscillation that it resolves.
//!
//! Through a power bond an effort f goes to block A and the flow v back to block B. With signals that are extrapolated, A gets f + ε_f
//! and B gets v + ε_v, so A receives another energy than B gives:
//!
//! ```text
//! δE = ∫ (ε_f·v − f·ε_v) dt
//! ```
//!
//! For an extrapolation of order k the error within a step is −e·σ(σ+1)…(σ+k)/(k+1)! to leading order, with the defect e at its end
//! and σ from 0 to 1, whose mean is c = 1/2, 5/12, 3/8 (the coefficients of Adams and Moulton). So in a step
//!
//! ```text
//! flow a velocity:       δE = −c·H·(e_f·v̄ − f̄·e_v)
//! flow a displacement:   δE = −c·(e_f·Δx + e_x·Δf)        (∫f·dε_x by parts: ε_x is 0 after each exchange)
//! ```
//!
//! with means and differences over the step; a signal that is interpolated has no defect. A spring's force that is held (k = 0) gives
//! its mass c·Δx² in each step whichever way it goes: an undamped oscillator coupled so grows at every step, however small.
//!
//! The energy W = ∫f·v dt that has gone through the bond swings with the oscillation; S is its greatest less its least value over a
//! cycle (four changes of the power's sign), averaged over [`CYCLES`] of them. S goes with the square of the amplitude, and at most all
//! energy of the oscillation goes through the bond, so ΔE ≥ ΔS. When S rises through three or more windows, [`GROWTH`]-fold in all,
//! and the exchange has put in at least half of what it rose by meanwhile, the exchange drives it. A growth that has its reason in the
//! model is resolved when H is small enough, and then δE is O(H^(k+1)) of what swings.
//!
//! Source of the residual: Sadjina, Kyllingstad, Skjong & Pedersen, "Energy conservation and power bonds in co-simulations", Eng.
//! Comput. 33 (2017) 607, eq. 6; the means over the step and the criterion are derived here.
use crate::network::{Flow, NetworkError, PowerBond, Wiring};
use crate::rise::{Rise, Risen};
use crate::schedule::Schedule;
use crate::signals::Signals;

/// Cycles to a window.
const CYCLES: u32 = 4;
/// By how much the energy that swings has to grow: twice the amplitude, twice over.
const GROWTH: f64 = 16.0;
/// Part of its growth that the exchange has to have put in.
const SHARE: f64 = 0.5;
/// Mean over a step of σ(σ+1)…(σ+k)/(k+1)!.
const MEANS: [f64; 3] = [1.0 / 2.0, 5.0 / 12.0, 3.0 / 8.0];

/// A power bond and what has gone through it.
pub(crate) struct BondWatch {
    /// Index of the connection that carries the effort.
    pub(crate) effort: usize,
    kind: Flow,
    /// 1, or −1 where a positive effort works against a positive flow.
    sign: f64,
    force: Signal,
    flow: Signal,
    /// Step of both blocks (s).
    length: f64,
    energy: Energy,
}

/// One of its connections.
struct Signal {
    block: usize,
    output: usize,
    gain: f64,
    offset: f64,
    /// Whether it is extrapolated where it goes to.
    extrapolated: bool,
}

#[derive(Default)]
struct Energy {
    through: f64,
    least: f64,
    most: f64,
    power: f64,
    turns: u32,
    cycles: u32,
    swings: f64,
    injected: f64,
    rise: Rise,
}

/// An oscillation that the exchange drives.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Drive {
    pub(crate) growth: f64,
    pub(crate) swing: f64,
    pub(crate) injected: f64,
}

impl BondWatch {
    pub(crate) fn new(wiring: &Wiring, schedule: &Schedule, bond: &PowerBond, step: f64) -> Result<Self, NetworkError> {
        let connections = wiring.connections.len();
        let refused = |why| NetworkError::NoBond { effort: bond.effort, flow: bond.flow, connections, why };
        let (Some(effort), Some(flow)) = (wiring.connections.get(bond.effort), wiring.connections.get(bond.flow))
        else {
            return Err(refused("one of them does not exist"));
        };
        if effort.from.block != flow.to.block || effort.to.block != flow.from.block {
            return Err(refused(
                "the flow has to go back from the block that takes the effort to the one that gives it",
            ));
        }
        let every = wiring.shapes[effort.from.block].every;
        if every != wiring.shapes[effort.to.block].every {
            return Err(refused("its blocks have different steps"));
        }
        let signal = |connection: &crate::network::Connection| Signal {
            block: connection.from.block,
            output: wiring.shapes[connection.from.block].first_output + connection.from.port,
            gain: connection.gain,
            offset: connection.offset,
            extrapolated: !schedule.is_known(connection.from.block, connection.to.block),
        };
        Ok(Self {
            effort: bond.effort,
            kind: bond.kind,
            sign: if bond.opposes { -1.0 } else { 1.0 },
            force: signal(effort),
            // The flow as its own block gives it: that is the velocity of the point where the effort acts.
            flow: Signal { gain: 1.0, offset: 0.0, ..signal(flow) },
            length: f64::from(every) * step,
            energy: Energy::default(),
        })
    }

    /// Block whose steps are the bond's.
    pub(crate) fn block(&self) -> usize {
        self.force.block
    }

    /// The exchange at the end of a step.
    pub(crate) fn exchange(&mut self, signals: &Signals) -> Option<Drive> {
        let [f0, f1] = self.force.ends(signals);
        let [x0, x1] = self.flow.ends(signals);
        let (e_f, e_x) = (self.force.defect(signals), self.flow.defect(signals));
        let (mean_f, mean_x) = (0.5 * (f0 + f1), 0.5 * (x0 + x1));
        let (work, residual) = match self.kind {
            Flow::Velocity => (mean_f * mean_x * self.length, self.length * (e_f * mean_x - mean_f * e_x)),
            Flow::Displacement => (mean_f * (x1 - x0), e_f * (x1 - x0) + e_x * (f1 - f0)),
        };
        self.energy.add(self.sign * work, self.sign * residual)
    }
}

impl Signal {
    /// Values at the beginning and at the end of the step.
    fn ends(&self, signals: &Signals) -> [f64; 2] {
        [signals.before(self.output), signals.newest(self.output)].map(|value| self.gain * value + self.offset)
    }

    /// Minus the energy's factor: what it was short of at the end of the step, by the mean over the step.
    fn defect(&self, signals: &Signals) -> f64 {
        let mean = MEANS[usize::from(signals.degree(self.block))];
        if self.extrapolated { -mean * self.gain * signals.defect(self.output) } else { 0.0 }
    }
}

impl Energy {
    fn add(&mut self, work: f64, injected: f64) -> Option<Drive> {
        self.through += work;
        self.injected += injected;
        self.least = self.least.min(self.through);
        self.most = self.most.max(self.through);
        if work * self.power < 0.0 {
            self.turns += 1;
        }
        self.power = if work == 0.0 { self.power } else { work };
        if self.turns < 4 {
            return None;
        }
        self.swings += self.most - self.least;
        (self.turns, self.least, self.most) = (0, self.through, self.through);
        self.cycles += 1;
        if self.cycles < CYCLES {
            return None;
        }
        let swing = std::mem::take(&mut self.swings) / f64::from(std::mem::take(&mut self.cycles));
        match self.rise.push(swing, true) {
            Risen::Anew => self.injected = 0.0,
            Risen::For { growth, .. } if growth >= GROWTH => {
                let grown = swing - self.rise.first();
                if self.injected >= SHARE * grown {
                    return Some(Drive { growth, swing: grown, injected: self.injected });
                }
                self.rise.restart();
                self.injected = 0.0;
            }
            Risen::On | Risen::For { .. } => {}
        }
        None
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Exchanges of a spring: f and x are cos φ, both growing by `rate` in each, so that S = ½·e^(2·rate·n) swings through the bond. The
    /// exchange puts in `share` of what S grows by.
    fn oscillation(rate: f64, share: f64, exchanges: u32) -> Option<Drive> {
        let mut energy = Energy::default();
        let at = |n: f64| {
            let (size, angle) = ((rate * n).exp(), 0.2 * n);
            (size * angle.cos(), size * angle.cos())
        };
        (1..exchanges).find_map(|n| {
            let ((f0, x0), (f1, x1)) = (at(f64::from(n) - 1.0), at(f64::from(n)));
            let grown = rate * (2.0 * rate * f64::from(n)).exp();
            energy.add(0.5 * (f0 + f1) * (x1 - x0), share * grown)
        })
    }

    /// The bound is half of the growth; the means over four cycles of 31 exchanges lag behind it by less than half.
    #[test]
    fn a_growth_that_the_exchange_put_in_is_found() {
        let found = oscillation(0.005, 1.0, 2000).unwrap();
        assert!(found.growth >= GROWTH && found.injected >= 0.5 * found.swing, "{found:?}");
        assert_eq!(oscillation(0.005, 0.2, 20_000), None);
        assert_eq!(oscillation(0.0, 1.0, 20_000), None);
        assert_eq!(oscillation(-0.005, 1.0, 20_000), None);
    }

    /// Noise of one level in both signals, the force against the displacement as a spring's, so that every exchange puts energy in
    /// (which the blocks' dampers take out). A million values from a generator of Knuth (TAOCP vol. 2, §3.3.4, table 1, line 26).
    #[test]
    fn noise_is_not() {
        let mut seed = 1_u64;
        let mut noise = move || {
            seed = seed.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
            (seed >> 11) as f64 / (1_u64 << 53) as f64 - 0.5
        };
        for spring in [0.0, 0.5, 1.0] {
            let mut energy = Energy::default();
            let (mut f0, mut x0) = (0.0, 0.0);
            for n in 0..1_000_000 {
                let x1 = noise() + noise();
                let f1 = noise() - spring * x1;
                let found = energy.add(0.5 * (f0 + f1) * (x1 - x0), -(f1 - f0) * (x1 - x0));
                assert_eq!(found, None, "spring {spring}, exchange {n}");
                (f0, x0) = (f1, x1);
            }
        }
    }
}
