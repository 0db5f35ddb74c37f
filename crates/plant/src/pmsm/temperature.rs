//! Temperature of winding and magnets: its effect on resistance and flux linkage, and two bodies that the losses heat.
//!
//! ```text
//! R = R_ref·(1 + α_R·(T_w − T_ref))          ψ = ψ_ref·(1 + α_ψ·(T_h − T_ref))
//! C_w·dT_w/dt = P_copper − (T_w − T_h)/R_wh
//! C_h·dT_h/dt = P_iron + (T_w − T_h)/R_wh − (T_h − T_a)/R_ha
//! ```
//! Copper: α_R = 0.00393 1/K at 20 °C (IEC 60028). Magnets are as warm as the housing: assumed, data sheets give no third body. The copper
//! loss heats the winding, the iron loss the housing. The step of the model is a tick: under the mean losses of the tick both bodies are
//! advanced exactly, and resistance and flux linkage follow at the next tick. Their delay, h relative to
//! a thermal time constant of seconds, is below 1e-4 of their change. The voltage induced by a change of the flux linkage is left out.
use super::Params;
use servobench_base::{ParamError, Stateful};
use servobench_config::Bound::Within;
use servobench_config::Kind::Plain;
use servobench_config::quantities::{HEAT_CAPACITY, PER_KELVIN, TEMPERATURE, THERMAL_RESISTANCE};
use servobench_config::{Measure, not_negative, positive};

const fn temperature(example: &'static str) -> Measure {
    Measure { kind: Plain(&TEMPERATURE), bound: Within(-100.0, 500.0), example }
}

servobench_config::parameters! {
    /// A parameter of the temperature of a motor.
    pub enum TemperatureParameter {
        /// Temperature for which resistance and flux linkage are given
        REFERENCE "reference temperature" = temperature("20 degC");
        /// Temperature of the winding; with a thermal model at time 0
        WINDING "winding temperature" = temperature("80 degC");
        /// Temperature of housing and magnets; with a thermal model at time 0
        HOUSING "housing temperature" = temperature("50 degC");
        /// Change of the resistance per kelvin, as a part of it
        RESISTANCE_COEFFICIENT "temperature coefficient of the resistance" = not_negative(Plain(&PER_KELVIN), "0.00393 1/K");
        /// Change of the flux linkage per kelvin, as a part of it: from −0.001 to −0.0012 1/K of neodymium, −0.002 1/K of ferrite
        FLUX_COEFFICIENT "temperature coefficient of the flux linkage" = servobench_config::any(Plain(&PER_KELVIN), "-0.0011 1/K");
        /// Temperature of the housing's surroundings
        AMBIENT "ambient temperature" = temperature("40 degC");
        /// Thermal resistance from the winding to the housing
        TO_HOUSING "thermal resistance to the housing" = positive(Plain(&THERMAL_RESISTANCE), "0.6 K/W");
        /// Thermal resistance from the housing to the surroundings
        TO_AMBIENT "thermal resistance to the surroundings" = positive(Plain(&THERMAL_RESISTANCE), "1.1 K/W");
        /// Heat capacity of the winding
        WINDING_CAPACITY "heat capacity of the winding" = positive(Plain(&HEAT_CAPACITY), "120 J/K");
        /// Heat capacity of the housing, with the iron
        HOUSING_CAPACITY "heat capacity of the housing" = positive(Plain(&HEAT_CAPACITY), "1.6 kJ/K");
        /// Highest temperature that the insulation of the winding withstands: a hotter winding is damaged
        LIMIT "temperature limit of the winding" = temperature("130 degC");
    }
}

/// Highest temperature of a winding of insulation class F (°C): IEC 60085, thermal class 155.
pub const CLASS_F: f64 = 155.0;
/// Temperature coefficient of copper at 20 °C (1/K).
pub const COPPER: f64 = 0.003_93;

/// Temperatures in °C.
#[derive(Debug, Clone, Copy, PartialEq, Default, Stateful)]
pub struct Temperatures {
    /// Winding.
    pub winding: f64,
    /// Housing and magnets.
    pub housing: f64,
}

/// Temperature of a motor and its effects.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Temperature {
    /// Temperature at which resistance and flux linkage are given (°C).
    pub reference: f64,
    /// Change of the resistance (1/K).
    pub resistance_coefficient: f64,
    /// Change of the flux linkage (1/K).
    pub flux_coefficient: f64,
    /// Temperatures at time 0.
    pub start: Temperatures,
    /// The heated bodies; `None` for constant temperatures.
    pub network: Option<ThermalNetwork>,
}

/// Two bodies and their surroundings.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ThermalNetwork {
    /// Surroundings (°C).
    pub ambient: f64,
    /// From winding to housing (K/W).
    pub to_housing: f64,
    /// From housing to surroundings (K/W).
    pub to_ambient: f64,
    /// Heat capacity of the winding (J/K).
    pub winding_capacity: f64,
    /// Heat capacity of the housing (J/K).
    pub housing_capacity: f64,
    /// Highest permissible temperature of the winding (°C); it has no effect on the motor.
    pub winding_limit: f64,
}

impl Temperature {
    /// # Errors
    /// [`ParamError`] names the first parameter that is out of its bound, or a temperature at which no resistance or flux is left.
    pub fn check(&self) -> Result<(), ParamError> {
        use TemperatureParameter as P;
        P::REFERENCE.check_in_words(self.reference)?;
        P::WINDING.check_in_words(self.start.winding)?;
        P::HOUSING.check_in_words(self.start.housing)?;
        P::RESISTANCE_COEFFICIENT.check_in_words(self.resistance_coefficient)?;
        P::FLUX_COEFFICIENT.check_in_words(self.flux_coefficient)?;
        if let Some(network) = &self.network {
            P::AMBIENT.check_in_words(network.ambient)?;
            P::TO_HOUSING.check_in_words(network.to_housing)?;
            P::TO_AMBIENT.check_in_words(network.to_ambient)?;
            P::WINDING_CAPACITY.check_in_words(network.winding_capacity)?;
            P::HOUSING_CAPACITY.check_in_words(network.housing_capacity)?;
            P::LIMIT.check_in_words(network.winding_limit)?;
        }
        let coldest = self.network.map_or(self.start.winding, |network| network.ambient.min(self.start.winding));
        for (name, factor) in [
            (P::RESISTANCE_COEFFICIENT.name, self.factors(Temperatures { winding: coldest, ..self.start })[0]),
            (P::FLUX_COEFFICIENT.name, self.factors(self.start)[1]),
        ] {
            if factor <= 0.0 {
                return Err(ParamError {
                    name,
                    value: factor - 1.0,
                    bound: "such that something is left at that temperature",
                });
            }
        }
        Ok(())
    }

    /// Resistance and flux linkage at these temperatures, relative to the given ones.
    fn factors(&self, Temperatures { winding, housing }: Temperatures) -> [f64; 2] {
        let part = |coefficient: f64, temperature: f64| 1.0 + coefficient * (temperature - self.reference);
        [part(self.resistance_coefficient, winding), part(self.flux_coefficient, housing)]
    }

    /// The motor with the data `p` at these temperatures.
    #[must_use]
    pub fn motor(&self, p: &Params, at: Temperatures) -> Params {
        let [resistance, flux_linkage] = self.factors(at);
        Params { resistance: p.resistance * resistance, flux_linkage: p.flux_linkage * flux_linkage, ..*p }
    }
}

/// Steps of equal length of a [`ThermalNetwork`].
#[derive(Debug, Clone, Copy)]
pub(super) struct ThermalSteps {
    ambient: f64,
    /// Change of the temperatures above the surroundings (winding, housing) per temperature and per power into each (W).
    change: [[f64; 4]; 2],
}

/// Terms of the series: 0.1⁹/9! < 1e-14 of a change.
const TERMS: i32 = 8;

impl ThermalSteps {
    /// Steps of `h` (s): the series of a short part, doubled until it is the step (as in [`maps`](super::maps)).
    pub(super) fn new(network: &ThermalNetwork, h: f64) -> Self {
        let ThermalNetwork { ambient, to_housing, to_ambient, winding_capacity, housing_capacity, .. } = *network;
        let slope = [
            [-1.0 / (to_housing * winding_capacity), 1.0 / (to_housing * winding_capacity)],
            [1.0 / (to_housing * housing_capacity), -(1.0 / to_housing + 1.0 / to_ambient) / housing_capacity],
        ];
        let fastest = slope[0][0].abs().max(slope[1][1].abs());
        let (mut doublings, mut part) = (0, h);
        while part * fastest > 0.05 && part > 0.0 {
            part /= 2.0;
            doublings += 1;
        }
        // Columns: both temperatures, both powers. (A | B)·part·(1 + A·part/2·(1 + A·part/3·(…)))
        let first = [
            [slope[0][0] * part, slope[0][1] * part, part / winding_capacity, 0.0],
            [slope[1][0] * part, slope[1][1] * part, 0.0, part / housing_capacity],
        ];
        let after = |change: &[[f64; 4]; 2], row: usize, column: usize| -> f64 {
            first[row][0] * change[0][column] + first[row][1] * change[1][column]
        };
        let mut change = first;
        for n in (2..=TERMS).rev() {
            let before = change;
            for (row, entries) in change.iter_mut().enumerate() {
                for (column, entry) in entries.iter_mut().enumerate() {
                    *entry = first[row][column] + after(&before, row, column) / f64::from(n);
                }
            }
        }
        for _ in 0..doublings {
            let before = change;
            for (row, entries) in change.iter_mut().enumerate() {
                for (column, entry) in entries.iter_mut().enumerate() {
                    *entry +=
                        before[row][column] + before[row][0] * before[0][column] + before[row][1] * before[1][column];
                }
            }
        }
        Self { ambient, change }
    }

    /// The temperatures a step later, with these mean losses (W).
    pub(super) fn after(&self, now: Temperatures, copper: f64, iron: f64) -> Temperatures {
        let state = [now.winding - self.ambient, now.housing - self.ambient, copper, iron];
        let [winding, housing] =
            self.change.map(|row| row.iter().zip(state).map(|(entry, state)| entry * state).sum::<f64>());
        Temperatures { winding: now.winding + winding, housing: now.housing + housing }
    }
}

#[cfg(test)]
mod tests;
