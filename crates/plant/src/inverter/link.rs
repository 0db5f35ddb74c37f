//! The DC link: rectified mains behind a resistance and diodes, a capacitor, a brake resistor.
//!
//! ```text
//! C·du/dt = max(0, U_s − u)/R_s − P/u − u/R_b·(brake is on)        U_s = U·(1 − sag)·cos φ,  |φ| ≤ π/6, six pulses in a period of the mains
//! ```
//! P is the power of inverter and motor, devices included; below zero they give it back, and the diodes block it from the mains. Without
//! a mains frequency the source is stiff, cos φ = 1. The brake switches on above one voltage and off below another, at the beginning of
//! a tick.
//!
//! A tick is the implicit midpoint rule: with u_m = (u(k) + u(k+1))/2 for every u on the right it is a quadratic equation of u_m, solved in
//! closed form, of second order and stable for every R_s·C. It closes the energy of the capacitor to the rounding,
//!
//! ```text
//! C/2·(u(k+1)² − u(k)²) = h·(P_source − P − P_brake)        P_source = u_m·max(0, U_s − u_m)/R_s        P_brake = u_m²/R_b
//! ```
//! and with P alone it is exact: u² falls linearly. Inverter and motor have u(k) during the tick. Source: Mohan, Undeland & Robbins, *Power
//! Electronics*, ch. 5 (rectifier with a capacitor), ch. 14 (dissipation of regenerated energy).
use servobench_base::{ParamError, Stateful};
use servobench_config::Kind::Plain;
use servobench_config::quantities::{CAPACITANCE, FREQUENCY, RATIO, RESISTANCE, TIME, VOLTAGE};
use servobench_config::{Bound, Measure, not_negative, positive};

servobench_config::parameters! {
    /// A parameter of the DC link.
    pub enum LinkParameter {
        /// Capacitance of the link
        CAPACITANCE "capacitance of the link" = positive(Plain(&CAPACITANCE), "470 uF");
        /// Resistance between the rectified mains and the capacitor
        SOURCE_RESISTANCE "resistance of the mains" = positive(Plain(&RESISTANCE), "0.5 Ohm");
        /// Frequency of the three-phase mains, rectified by a bridge to six pulses a period
        MAINS_FREQUENCY "frequency of the mains" = positive(Plain(&FREQUENCY), "50 Hz");
        /// Start of the mains sag
        SAG_START "start of the sag" = not_negative(Plain(&TIME), "0.2 s");
        /// Duration of the sag
        SAG_DURATION "duration of the sag" = positive(Plain(&TIME), "60 ms");
        /// Depth of the sag, as a share of the mains voltage
        SAG_DEPTH "depth of the sag" = Measure { kind: Plain(&RATIO), bound: Bound::Within(0.0, 1.0), example: "0.4" };
        /// Resistance of the brake resistor
        BRAKE_RESISTANCE "brake resistance" = positive(Plain(&RESISTANCE), "47 Ohm");
        /// Voltage of the link above which the brake resistor is switched on
        BRAKE_ON "voltage that switches the brake on" = positive(Plain(&VOLTAGE), "390 V");
        /// Voltage of the link below which it is switched off
        BRAKE_OFF "voltage that switches the brake off" = positive(Plain(&VOLTAGE), "375 V");
    }
}

/// A link; constant during a run.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct LinkParams {
    /// Voltage of the rectified mains without load, the crest of their pulses, and initial voltage of the capacitor (V).
    pub voltage: f64,
    /// Capacitance (F).
    pub capacitance: f64,
    /// Resistance between mains and capacitor (Ω).
    pub source_resistance: f64,
    /// Frequency of the mains (Hz); `None`: a stiff source.
    pub mains_frequency: Option<f64>,
    /// Sag of the mains.
    pub sag: Option<Sag>,
    /// Brake resistor.
    pub brake: Option<Brake>,
}

/// A temporary sag of the mains voltage.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Sag {
    /// Start (s).
    pub start: f64,
    /// Duration (s).
    pub duration: f64,
    /// Share of the voltage that is missing, 0 to 1.
    pub depth: f64,
}

/// A resistor that is switched to the link.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Brake {
    /// Resistance (Ω).
    pub resistance: f64,
    /// Voltage above which it switches on (V).
    pub on: f64,
    /// Voltage below which it switches off (V).
    pub off: f64,
}

/// State from tick to tick.
#[derive(Debug, Clone, Copy, PartialEq, Stateful)]
pub struct LinkState {
    /// Voltage of the capacitor (V).
    pub voltage: f64,
    /// True if the brake resistor is on.
    pub is_braking: bool,
    /// Ticks since the beginning.
    tick: u64,
}

/// Mean powers over a tick (W).
#[derive(Debug, Clone, Copy, PartialEq, Default, Stateful)]
pub struct LinkPower {
    /// From the mains.
    pub source: f64,
    /// Into the brake resistor.
    pub brake: f64,
}

impl LinkParams {
    /// # Errors
    /// [`ParamError`] names the first parameter out of its bound.
    pub fn check(&self) -> Result<(), ParamError> {
        LinkParameter::CAPACITANCE.check_in_words(self.capacitance)?;
        LinkParameter::SOURCE_RESISTANCE.check_in_words(self.source_resistance)?;
        self.mains_frequency.map_or(Ok(0.0), |mains| LinkParameter::MAINS_FREQUENCY.check_in_words(mains))?;
        if let Some(Sag { start, duration, depth }) = self.sag {
            LinkParameter::SAG_START.check_in_words(start)?;
            LinkParameter::SAG_DURATION.check_in_words(duration)?;
            LinkParameter::SAG_DEPTH.check_in_words(depth)?;
        }
        if let Some(Brake { resistance, on, off }) = self.brake {
            LinkParameter::BRAKE_RESISTANCE.check_in_words(resistance)?;
            LinkParameter::BRAKE_ON.check_in_words(on)?;
            LinkParameter::BRAKE_OFF.check_in_words(off)?;
            if off >= on || off <= self.voltage {
                let bound = "between the voltage of the link and that which switches the brake on";
                return Err(ParamError { name: LinkParameter::BRAKE_OFF.name, value: off, bound });
            }
        }
        Ok(())
    }

    /// The capacitor at the voltage of the mains.
    #[must_use]
    pub const fn at_first(&self) -> LinkState {
        LinkState { voltage: self.voltage, is_braking: false, tick: 0 }
    }

    /// Voltage of the rectified mains at `t` (s).
    fn source(&self, t: f64) -> f64 {
        use core::f64::consts::{FRAC_PI_3, FRAC_PI_6, TAU};
        let pulse = self.mains_frequency.map_or(1.0, |mains| {
            let angle = TAU * mains * t;
            libm::cos(angle - FRAC_PI_3 * libm::floor(angle / FRAC_PI_3) - FRAC_PI_6)
        });
        let sag = self.sag.filter(|sag| t >= sag.start && t < sag.start + sag.duration).map_or(0.0, |sag| sag.depth);
        self.voltage * (1.0 - sag) * pulse
    }

    /// Advances by a tick of `h` (s) in which inverter and motor take `power` (W).
    pub fn step(&self, x: &mut LinkState, power: f64, h: f64) -> LinkPower {
        let source = self.source((x.tick as f64 + 0.5) * h);
        x.tick += 1;
        let brake = self.brake.map_or(0.0, |brake| {
            let switches = if x.is_braking { x.voltage > brake.off } else { x.voltage > brake.on };
            x.is_braking = switches;
            if switches { 1.0 / brake.resistance } else { 0.0 }
        });
        // (2C/h + G)·u_m² − (2C/h·u(k) + I)·u_m + P = 0, with diodes that block, or conduct.
        let per_tick = 2.0 * self.capacitance / h;
        let middle = |conductance: f64, current: f64| {
            let (a, b) = (per_tick + conductance, per_tick * x.voltage + current);
            let square = b * b - 4.0 * a * power;
            if square < 0.0 { 0.0 } else { (b + libm::sqrt(square)) / (2.0 * a) }
        };
        let (lead, blocked) = (1.0 / self.source_resistance, middle(brake, 0.0));
        let leads = blocked < source;
        let u = if leads { middle(brake + lead, source * lead) } else { blocked };
        x.voltage = (2.0 * u - x.voltage).max(0.0);
        let current = if leads { (source - u) * lead } else { 0.0 };
        LinkPower { source: u * current, brake: brake * u * u }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    const LINK: LinkParams = LinkParams {
        voltage: 320.0,
        capacitance: 470e-6,
        source_resistance: 0.7,
        mains_frequency: None,
        sag: None,
        brake: Some(Brake { resistance: 47.0, on: 390.0, off: 375.0 }),
    };

    proptest! {
        /// Oracle: the energy of the capacitor, with mains that conduct and block, a brake on and off, taken and given back.
        #[test]
        fn the_energy_of_the_capacitor_closes(power in -3000.0..3000.0_f64, voltage in 200.0..420.0_f64, is_braking: bool) {
            let (h, mut x) = (62.5e-6, LinkState { voltage, is_braking, tick: 0 });
            for _ in 0..20 {
                let before = x.voltage;
                let LinkPower { source, brake } = LINK.step(&mut x, power, h);
                // Δ(u²) by its factors, which keep the digits of Δu.
                let stored = 0.5 * LINK.capacitance * (x.voltage - before) * (x.voltage + before) / h;
                let largest = [source, brake, power, stored].iter().fold(0.0, |most: f64, one| most.max(one.abs()));
                // Δu has the rounding of u: of 400 V·470 µF/62.5 µs that is 3 kA·400 V·1e-16.
                prop_assert!((source - brake - power - stored).abs() <= 1e-12 * largest + 1e-9, "{x:?}");
            }
        }
    }

    /// Oracle: u² = u₀² − 2·P·t/C.
    #[test]
    fn constant_power_takes_the_square_of_the_voltage_down_in_a_line() {
        let dead = LinkParams { sag: Some(Sag { start: 0.0, duration: 1.0, depth: 1.0 }), ..LINK };
        let (h, mut x) = (125e-6, dead.at_first());
        for k in 1..=300 {
            assert_eq!(dead.step(&mut x, 520.0, h), LinkPower::default());
            let expected = (320.0_f64.powi(2) - 2.0 * 520.0 * f64::from(k) * h / 470e-6).sqrt();
            assert!((x.voltage / expected - 1.0).abs() < 1e-12, "{k}: {} {expected}", x.voltage);
        }
    }

    /// Oracle: the difference from the mains falls as e^(−t/R_s·C), of second order in the tick; under load u = (U + √(U² − 4·R_s·P))/2.
    #[test]
    fn the_mains_fill_the_capacitor_and_sag_under_load() {
        let tau: f64 = 0.7 * 470e-6;
        let after = |ticks: u32| {
            let (h, mut x) = (1.3e-3 / f64::from(ticks), LinkState { voltage: 250.0, is_braking: false, tick: 0 });
            for _ in 0..ticks {
                LINK.step(&mut x, 0.0, h);
            }
            (x.voltage - (320.0 - 70.0 * (-1.3e-3 / tau).exp())).abs()
        };
        let order = (after(64) / after(128)).log2();
        assert!((order - 2.0).abs() < 0.05, "{order}");
        let mut x = LINK.at_first();
        for _ in 0..400 {
            LINK.step(&mut x, 900.0, 62.5e-6);
        }
        let expected = 320.0_f64.midpoint((320.0_f64.powi(2) - 4.0 * 0.7 * 900.0).sqrt());
        assert!((x.voltage - expected).abs() < 1e-9, "{} {expected}", x.voltage);
    }

    /// Oracle: the motor gives power back and the resistor takes it, between its two voltages; nothing flows to the mains.
    #[test]
    fn the_brake_takes_what_comes_back() {
        let (h, mut x, mut taken) = (62.5e-6, LINK.at_first(), 0.0);
        let (mut low, mut high): (f64, f64) = (f64::INFINITY, 0.0);
        for k in 0..16_000 {
            let LinkPower { source, brake } = LINK.step(&mut x, -1000.0, h);
            assert!(source.abs() < 1e-12);
            taken += brake * h;
            if k > 1_000 {
                (low, high) = (low.min(x.voltage), high.max(x.voltage));
            }
        }
        let stored = 0.5 * 470e-6 * (x.voltage * x.voltage - 320.0 * 320.0);
        assert!((taken + stored - 1000.0).abs() < 1e-9, "{taken} J, {stored} J of 1000 J");
        // A tick too late at either end.
        let late = 62.5e-6 * 390.0 * 390.0 / 47.0 / (470e-6 * 375.0);
        assert!(low > 375.0 - late && low < 375.0 && high > 390.0 && high < 390.0 + late, "{low} {high}");
    }

    /// Oracle: the mean of the crests of six pulses, 3/π, with a negligible capacitor; and a sag.
    #[test]
    fn a_bridge_makes_six_pulses() {
        let mains = LinkParams {
            mains_frequency: Some(50.0),
            sag: Some(Sag { start: 0.1, duration: 0.02, depth: 0.4 }),
            ..LINK
        };
        let mean = |from: f64| (0..20_000).map(|k| mains.source(from + 1e-6 * (f64::from(k) + 0.5))).sum::<f64>() / 2e4;
        let expected = 320.0 * 3.0 / core::f64::consts::PI;
        assert!((mean(0.0) / expected - 1.0).abs() < 1e-6 && (mean(0.1) / expected - 0.6).abs() < 1e-6);
    }

    #[test]
    fn what_is_out_of_its_bound_is_named() {
        assert_eq!(LINK.check(), Ok(()));
        let brake = |on, off| Some(Brake { resistance: 47.0, on, off });
        for (wrong, name) in [
            (LinkParams { capacitance: 0.0, ..LINK }, LinkParameter::CAPACITANCE),
            (LinkParams { source_resistance: -1.0, ..LINK }, LinkParameter::SOURCE_RESISTANCE),
            (LinkParams { mains_frequency: Some(f64::NAN), ..LINK }, LinkParameter::MAINS_FREQUENCY),
            (LinkParams { brake: brake(390.0, 310.0), ..LINK }, LinkParameter::BRAKE_OFF),
            (LinkParams { brake: brake(370.0, 375.0), ..LINK }, LinkParameter::BRAKE_OFF),
            (LinkParams { sag: Some(Sag { start: 0.0, duration: 1.0, depth: 1.1 }), ..LINK }, LinkParameter::SAG_DEPTH),
        ] {
            assert_eq!(wrong.check().unwrap_err().name, name.name);
        }
    }
}
