//! Parts of `[motor]`: effects of a real motor beyond its equations.
use crate::simple::OneOf;
use crate::table::table;
use servobench_plant::pmsm::{
    CoggingParameter, FluxHarmonic as Harmonic, FluxHarmonicParameter, IronLossParameter, SaturationParameter,
    TemperatureParameter,
};
use servobench_plant::{Phase, Swap, WiringParameter};

table! {
    /// A harmonic of the cogging: torque or force F·sin(n·x + φ) on the rotor, with or without current. Give its order n in one
    /// of the two ways.
    pub(crate) struct Cogging requires ["amplitude"] {
        /// Order per revolution of a motor that turns: the slots, or the least common multiple of slots and poles.
        per_rev: u32 = 1..=100_000,
        /// Order per pair of poles; of a linear motor per two pole pitches.
        per_pole_pair: u32 = 1..=1000,
        amplitude: f64 = CoggingParameter::AMPLITUDE,
        /// default: 0.
        phase: f64 = CoggingParameter::PHASE,
    }
}

table! {
    /// A harmonic of the magnets' flux linkage in the rotor frame, which ripples torque and back-EMF:
    /// ψ_d = ψ·(1 + d·cos(n·θ + φ)), ψ_q = ψ·q·sin(n·θ + φ). Orders 5 and 7 of a phase are order 6 here.
    pub(crate) struct FluxHarmonic requires ["order"] {
        /// Its order n per electrical revolution.
        order: u32 = 1..=Harmonic::MAX_ORDER,
        /// default: 0.
        d: f64 = FluxHarmonicParameter::D,
        /// default: 0.
        q: f64 = FluxHarmonicParameter::Q,
        /// default: 0.
        phase: f64 = FluxHarmonicParameter::PHASE,
    }
}

table! {
    /// Faults of the cable between inverter and motor: docs/faults.md.
    pub(crate) struct Connection {
        /// Two exchanged phases; default: none.
        swapped: Swap = OneOf,
        /// Lost phase of the motor, which carries no current any more; default: none.
        open: Phase = OneOf,
        /// default: 0.
        open_at: f64 = WiringParameter::OPEN_AT,
    }
}

table! {
    /// Loss in the iron: it brakes the rotor, and grows with the square of the flux linkage of magnets and currents.
    pub(crate) struct IronLoss requires ["speed"] {
        speed: f64 = IronLossParameter::SPEED,
        /// default: 0.
        hysteresis: f64 = IronLossParameter::HYSTERESIS,
        /// default: 0.
        eddy: f64 = IronLossParameter::EDDY,
    }
}

table! {
    /// Temperature of the motor: it changes resistance and flux linkage without the drive's knowledge.
    pub(crate) struct Temperature {
        /// default: 20 °C.
        reference: f64 = TemperatureParameter::REFERENCE,
        /// default: `ambient` of `[motor.thermal]`, without it `reference`.
        winding: f64 = TemperatureParameter::WINDING,
        /// default: `ambient` of `[motor.thermal]`, without it `reference`.
        housing: f64 = TemperatureParameter::HOUSING,
        /// default: 0.00393 1/K, that of copper at 20 °C.
        resistance_coefficient: f64 = TemperatureParameter::RESISTANCE_COEFFICIENT,
        /// default: 0.
        flux_coefficient: f64 = TemperatureParameter::FLUX_COEFFICIENT,
    }
}

table! {
    /// Winding and housing as two bodies: copper loss heats the winding, iron loss the housing.
    pub(crate) struct Thermal requires ["ambient", "to_housing", "to_ambient", "winding_capacity", "housing_capacity"] {
        ambient: f64 = TemperatureParameter::AMBIENT,
        to_housing: f64 = TemperatureParameter::TO_HOUSING,
        to_ambient: f64 = TemperatureParameter::TO_AMBIENT,
        winding_capacity: f64 = TemperatureParameter::WINDING_CAPACITY,
        housing_capacity: f64 = TemperatureParameter::HOUSING_CAPACITY,
        /// (docs/requirements.md, `no_harm`); default: 155 °C, that of insulation class F.
        limit: f64 = TemperatureParameter::LIMIT,
    }
}

table! {
    /// Saturation of the iron by one figure of a data sheet: inductances and flux linkage are those of the motor without current, and
    /// all of them fall with the ampere-turns, of magnets and winding together.
    pub(crate) struct Saturation requires ["current", "share"] {
        current: f64 = SaturationParameter::CURRENT,
        share: f64 = SaturationParameter::SHARE,
        /// default: 0.1.
        residual: f64 = SaturationParameter::RESIDUAL,
    }
}

table! {
    /// Flux linkages over the currents, in place of inductances and flux linkage, which remain the drive's estimates.
    pub(crate) struct FluxMap requires ["file"] {
        /// A CSV file, relative to this one, with the heading `i_d [Apk],i_q [Apk],psi_d [mV s],psi_q [mV s]`: any units, and a row for
        /// each pair of currents, from 3 to 65 of either axis with 0 among them. A table that begins at i_q = 0 is mirrored. psi_d without
        /// current is the flux linkage of the magnets.
        file: String = (),
    }
}
