//! Permanent-magnet synchronous motor in the rotor frame.
//!
//! ```text
//! L_d·di_d/dt = u_d − R·i_d + ω·L_q·i_q
//! L_q·di_q/dt = u_q − R·i_q − ω·(L_d·i_d + ψ)        ω electrical
//! T = 3/2·p·(ψ·i_q + (L_d − L_q)·i_d·i_q)
//! ```
//! Amplitude-invariant: currents are phase peaks, R and L phase to neutral, ψ the peak flux linkage.
//! Source: Krause, *Analysis of Electric Machinery*, 3rd ed., §4.10 (PMSM in rotor reference frame).
//!
//! The inverter holds its voltage in the stator frame, so in the rotor frame it turns backwards during a tick. At constant
//! speed the equations are linear with that input, and a tick is solved exactly, to the rounding: currents at its end,
//! mean torque, and the means of products that are its powers ([`step_with_power`]), for every tick, however large ω·h and
//! R·h/L are. If the speed changes in a tick, its mean is used: second order.
//!
//! ```text
//! P_electrical = 3/2·mean(u_d·i_d + u_q·i_q)    P_copper = 3/2·R·mean(i_d² + i_q²)    P_air-gap = ω/p·mean(T)
//! P_stored     = 3/2·(L_d·Δ(i_d²) + L_q·Δ(i_q²))/2h
//! P_electrical = P_copper + P_stored + P_air-gap
//! ```
#![expect(clippy::inline_always, reason = "what is inlined is compiled for the registers of its caller")]
mod cogging;
mod effects;
mod envelope;
mod flux_harmonics;
mod flux_map;
mod gauss;
mod iron;
mod maps;
mod open_phase;
mod phases;
mod saturated;
mod segment;
mod table;
mod temperature;
mod varying;
mod winding;

pub use cogging::{Cogging, CoggingParameter};
pub use effects::{Effects, RealMotor, Travel};
pub use envelope::{Bounds, MostEffort};
pub use flux_harmonics::{FluxHarmonic, FluxHarmonicParameter};
pub use flux_map::{FluxData, FluxMap, FluxMapError, FluxPart, Saturation, SaturationParameter};
pub use iron::{IronLoss, IronLossParameter};
use maps::{Forms, Maps};
pub(crate) use open_phase::OpenPhase;
pub use phases::PhaseParameter;
pub(crate) use segment::Equations;
use servobench_base::{AlphaBeta, Dq, ParamError, Rotation, Stateful, wide_registers};
use servobench_config::Kind::Plain;
use servobench_config::quantities::{FLUX_LINKAGE, INDUCTANCE, RATIO, RESISTANCE};
use servobench_config::{not_negative, positive};
use table::{Solution, Tables};
pub use temperature::{CLASS_F, COPPER, Temperature, TemperatureParameter, Temperatures, ThermalNetwork};
pub(crate) use winding::{Span, Sums, Winding};

servobench_config::parameters! {
    /// A parameter of a synchronous motor.
    pub enum Parameter {
        /// Electrical angle per motor coordinate
        ELECTRICAL_RATIO "electrical ratio" = positive(Plain(&RATIO), "4");
        /// Stator resistance, phase to neutral
        RESISTANCE "resistance" = positive(Plain(&RESISTANCE), "0.36 Ohm");
        /// Inductance of the d axis, phase to neutral
        INDUCTANCE_D "inductance, d axis" = positive(Plain(&INDUCTANCE), "36 mH");
        /// Inductance of the q axis, phase to neutral
        INDUCTANCE_Q "inductance, q axis" = positive(Plain(&INDUCTANCE), "51 mH");
        /// Flux linkage of the magnets, amplitude; 0 for a reluctance motor, whose inductances differ
        FLUX_LINKAGE "flux linkage" = not_negative(Plain(&FLUX_LINKAGE), "0.545 V s");
    }
}

/// Parameters of the motor; constant during a run.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Params {
    /// Electrical angle per motor coordinate: the pole pairs `p` of a motor that turns (rad/rad), π/τ_p of a linear motor with the pole
    /// pitch τ_p (rad/m).
    pub electrical_ratio: f64,
    /// Stator resistance, phase to neutral (Ω).
    pub resistance: f64,
    /// Inductances, phase to neutral (H).
    pub inductance: Dq,
    /// Flux linkage of the magnets, peak (V·s); 0 for a reluctance motor.
    pub flux_linkage: f64,
}

/// State from tick to tick.
#[derive(Debug, Clone, Copy, PartialEq, Default, Stateful)]
pub struct State {
    /// Stator current in the rotor frame (A, peak).
    pub current: Dq,
}

/// Inputs of the motor from tick k to k+1.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Input {
    /// Stator voltage, held over the tick (V, peak, phase to neutral).
    pub voltage: AlphaBeta,
    /// Rotor at tick k.
    pub rotor: Rotation,
    /// Mean electrical speed over the tick (rad/s).
    pub omega_e: f64,
}

impl Params {
    /// # Errors
    /// [`ParamError`] names the first parameter out of its bound, also a flux linkage of 0 without saliency, which leaves no torque.
    pub fn check(&self) -> Result<(), ParamError> {
        Parameter::ELECTRICAL_RATIO.check_in_words(self.electrical_ratio)?;
        Parameter::RESISTANCE.check_in_words(self.resistance)?;
        Parameter::INDUCTANCE_D.check_in_words(self.inductance.d)?;
        Parameter::INDUCTANCE_Q.check_in_words(self.inductance.q)?;
        Parameter::FLUX_LINKAGE.check_in_words(self.flux_linkage)?;
        if self.has_no_torque() {
            let bound = "positive where both inductances are equal";
            return Err(ParamError { name: Parameter::FLUX_LINKAGE.name, value: self.flux_linkage, bound });
        }
        Ok(())
    }

    /// True if neither magnets nor a difference of the inductances make torque.
    #[must_use]
    pub fn has_no_torque(&self) -> bool {
        self.flux_linkage == 0.0 && self.inductance.d - self.inductance.q == 0.0
    }

    /// Torque or force per q-axis current at the d-axis current `i_d` (N·m/A or N/A, peak): 1.5·p·(ψ + (L_d − L_q)·i_d).
    #[must_use]
    pub fn effort_constant(&self, i_d: f64) -> f64 {
        let reluctance = if i_d == 0.0 { 0.0 } else { (self.inductance.d - self.inductance.q) * i_d };
        1.5 * self.electrical_ratio * (self.flux_linkage + reluctance)
    }

    /// Torque at `current` (N·m).
    #[must_use]
    pub fn torque(&self, current: Dq) -> f64 {
        let reluctance = (self.inductance.d - self.inductance.q) * current.d;
        self.torque_factor() * (self.flux_linkage + reluctance) * current.q
    }

    /// Energy in the field of the inductances at `current` (J).
    #[must_use]
    pub fn stored_energy(&self, current: Dq) -> f64 {
        0.75 * (self.inductance.d * current.d * current.d + self.inductance.q * current.q * current.q)
    }

    /// Voltage that keeps `current` constant at the electrical speed `omega_e` (V).
    #[must_use]
    pub fn steady_voltage(&self, current: Dq, omega_e: f64) -> Dq {
        let Self { resistance, inductance, flux_linkage, .. } = self;
        Dq {
            d: resistance * current.d - omega_e * inductance.q * current.q,
            q: resistance * current.q + omega_e * (inductance.d * current.d + flux_linkage),
        }
    }
}

impl Input {
    /// The voltage in the frame of the rotor in the middle of a tick of `h` (s). Its mean over the tick is shorter by
    /// sin(ωh/2)/(ωh/2).
    #[inline(always)]
    #[must_use]
    pub fn voltage_at_middle(&self, h: f64) -> Dq {
        self.voltage.to_dq(self.rotor.ahead(self.omega_e * h / 2.0))
    }
}

/// Mean powers over a tick (W): `electrical = copper + iron + stored + air_gap`.
#[derive(Debug, Clone, Copy, PartialEq, Default, Stateful)]
pub struct Power {
    /// Into the terminals.
    pub electrical: f64,
    /// Lost in the resistance.
    pub copper: f64,
    /// Lost in the iron; zero unless the motor has such a loss ([`IronLoss`]).
    pub iron: f64,
    /// Into the field of the inductances, and with cogging of the magnets.
    pub stored: f64,
    /// Over the air gap: torque times the speed in the motor's equations.
    pub air_gap: f64,
}

/// Mean torque (N·m) and powers over a tick.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Output {
    /// Torque (N·m), or force (N) of a linear motor.
    pub torque: f64,
    /// Powers.
    pub power: Power,
}

/// A motor with ticks of constant length: terms that do not depend on the speed are computed once.
#[derive(Debug, Clone)]
pub struct Ticks {
    params: Params,
    tables: Tables,
    /// Length of a tick (s).
    h: f64,
}

impl Ticks {
    /// Ticks of `h` (s).
    #[must_use]
    pub fn new(params: Params, h: f64) -> Self {
        Self { params, tables: Tables::new(&params, h), h }
    }

    /// The motor.
    #[must_use]
    pub const fn params(&self) -> &Params {
        &self.params
    }

    /// Advances the currents to tick k+1 and returns the mean torque over the tick (N·m).
    #[inline]
    pub fn step(&self, x: &mut State, u: &Input) -> f64 {
        wide_registers!(self.solved_without_power(x, u), Self::in_wide_registers_without_power, self, x, u)
    }

    #[cfg(target_arch = "x86_64")]
    #[target_feature(enable = "avx2")]
    fn in_wide_registers_without_power(&self, x: &mut State, u: &Input) -> f64 {
        self.solved_without_power(x, u)
    }

    #[inline(always)]
    fn solved_without_power(&self, x: &mut State, u: &Input) -> f64 {
        let solution = self.solve::<false>(x.current, u);
        x.current = moved(x.current, solution.change);
        self.params.torque_factor() * solution.means.torque
    }

    /// The same with the powers, which are written to `power`: a copy would have to wait until they are stored.
    #[inline]
    pub fn step_with_power(&self, x: &mut State, u: &Input, power: &mut Power) -> f64 {
        wide_registers!(self.solved_with_power(x, u, power), Self::in_wide_registers, self, x, u, power)
    }

    #[cfg(target_arch = "x86_64")]
    #[target_feature(enable = "avx2")]
    fn in_wide_registers(&self, x: &mut State, u: &Input, power: &mut Power) -> f64 {
        self.solved_with_power(x, u, power)
    }

    #[inline(always)]
    fn solved_with_power(&self, x: &mut State, u: &Input, power: &mut Power) -> f64 {
        let (solution, before) = (self.solve::<true>(x.current, u), x.current);
        x.current = moved(before, solution.change);
        let output = self.params.output(&solution, before, x.current, u.omega_e, self.h);
        *power = output.power;
        output.torque
    }

    #[inline(always)]
    fn solve<const POWER: bool>(&self, i: Dq, u: &Input) -> Solution {
        let in_table = self.tables.solve::<POWER>(u.omega_e * self.h, i, u);
        in_table.unwrap_or_else(|| Solution::of_numbers(solve_in_numbers(&self.params, i, u, self.h)))
    }
}

/// Advances the currents by `h` (s) to tick k+1 and returns the mean torque over the tick (N·m). For many ticks:
/// [`Ticks`].
pub fn step(p: &Params, x: &mut State, u: Input, h: f64) -> f64 {
    step_with_power(p, x, u, h).torque
}

/// The same with the powers: mean input, losses and change of the stored energy, each computed separately.
pub fn step_with_power(p: &Params, x: &mut State, u: Input, h: f64) -> Output {
    let (solution, before) = (solve(p, x.current, &u, h), x.current);
    x.current = moved(before, solution.change);
    p.output(&solution, before, x.current, u.omega_e, h)
}

/// Returns numbers, so that a solution of the tables stays in registers.
#[cold]
fn solve_in_numbers(p: &Params, i: Dq, u: &Input, h: f64) -> [f64; 5] {
    let Solution { change: Dq { d, q }, means: Forms { torque, square, input } } = solve(p, i, u, h);
    [d, q, torque, square, input]
}

/// A tick at any speed.
#[cold]
fn solve(p: &Params, i: Dq, u: &Input, h: f64) -> Solution {
    let turn = u.omega_e * h;
    if !turn.is_finite() {
        let none = f64::NAN;
        let means = Forms { torque: none, square: none, input: none };
        return Solution { change: Dq { d: none, q: none }, means };
    }
    let doublings = maps::doublings(p, turn, h);
    let tick = (0..doublings).fold(Maps::part(p, turn, h, doublings), |maps: Maps<f64>, _| maps.doubled());
    let voltage = u.voltage.to_dq(u.rotor);
    let w = [i.d, i.q, voltage.d, voltage.q, 1.0];
    let dot = |row: &[f64; maps::N]| -> f64 { row.iter().zip(w).map(|(a, w)| a * w).sum() };
    let change = Dq { d: dot(&tick.change[0]), q: dot(&tick.change[1]) };
    Solution { change, means: tick.forms.map(|form| dot(&form.map(|row| dot(&row)))) }
}

impl Params {
    /// Torque per ψ·i_q + (L_d − L_q)·i_d·i_q.
    fn torque_factor(&self) -> f64 {
        1.5 * self.electrical_ratio
    }

    #[inline(always)]
    fn output(&self, solution: &Solution, before: Dq, after: Dq, omega_e: f64, h: f64) -> Output {
        let Forms { torque, square, input } = solution.means;
        let torque = self.torque_factor() * torque;
        // Δ(i²) = Δi·(i + i + Δi), which keeps the digits of Δi.
        let change = solution.change;
        let energy =
            self.inductance.d * change.d * (before.d + after.d) + self.inductance.q * change.q * (before.q + after.q);
        let power = Power {
            electrical: 1.5 * input,
            copper: 1.5 * self.resistance * square,
            iron: 0.0,
            stored: 0.75 * energy / h,
            air_gap: torque * omega_e / self.electrical_ratio,
        };
        Output { torque, power }
    }
}

fn moved(current: Dq, change: Dq) -> Dq {
    Dq { d: current.d + change.d, q: current.q + change.q }
}

#[cfg(test)]
mod tests;
