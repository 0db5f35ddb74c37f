//! Demand of the set-point on motor and inverter, and the available effort and voltage.
//!
//! ```text
//! i_q = τ/(1.5·p·(ψ + (L_d − L_q)·i_d))        i_d = `drive.current.d_reference`, or as the drive's strategy has it
//! u_d = R·i_d − ω_e·L_q·i_q                    u_q = R·i_q + ω_e·(L_d·i_d + ψ)
//! |u| ≤ U_dc/√3                                at constant current: L·di/dt is left out
//! ```
//! Source: Pillay, Krishnan, *IEEE Trans. Industry Applications* 25(2), 1989. The set-point is sampled at the base rate, a long program at
//! [`MOST_SAMPLES`] instants.
use super::resistance::Resistance;
use super::{Doubt, Units};
use servobench_drive::Params;
use servobench_drive::current::operating_point::{Envelope, State, Strategy};
use servobench_drive::current::{self, MotorEstimate};
use servobench_metrics::Quantity;
use servobench_plant::{Chain, inverter, pmsm};
use servobench_scenario::{Actuator, Scenario, Step};
use servobench_sim::{BuildError, Program};

/// Instants at which a program is sampled at most.
const MOST_SAMPLES: f64 = 1e6;
/// Electrical angle per period of the current loop (rad) above which its dead time and its decoupling no longer hold: the voltage computed
/// for one angle is applied a period and a half later, at this bound three quarters of a radian on.
const MOST_ANGLE: f64 = std::f64::consts::PI / 6.0;
/// A demand equal to the available value may exceed it by rounding.
const ROUNDING: f64 = 1e-9;

/// Demand of the set-point.
#[derive(Debug, Clone, PartialEq)]
pub struct Demand {
    /// Torque or force of the motor; `None` without a drive, or where the resistance of the axis is unknown here.
    pub effort: Option<EffortDemand>,
    /// Voltage of the inverter; `None` without one.
    pub voltage: Option<VoltageDemand>,
    /// Largest speed of the motor (rad/s or m/s).
    pub speed: f64,
    /// Units of speed and effort.
    pub speed_unit: &'static str,
    /// Unit of the effort.
    pub effort_unit: &'static str,
}

/// Torque or force of the motor (N·m or N).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct EffortDemand {
    /// Largest.
    pub peak: f64,
    /// Time of the peak (s).
    pub at: f64,
    /// Root mean square over the run.
    pub rms: f64,
    /// Largest effort of drive and motor.
    pub available: f64,
    /// True if computed from the drive's estimate of the axis, because the axis itself is unknown here.
    pub is_believed: bool,
}

/// Voltage of the inverter (V, peak) and the other quantities that grow with speed.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct VoltageDemand {
    /// Largest |u|.
    pub peak: f64,
    /// Time of the peak (s).
    pub at: f64,
    /// Back-EMF at the largest speed.
    pub back_emf: f64,
    /// Largest voltage of the DC link.
    pub available: f64,
    /// Largest electrical angle per period of the current loop (rad).
    pub angle_per_period: f64,
}

/// The largest value of a sequence, and its time.
#[derive(Debug, Clone, Copy, Default)]
struct Largest {
    value: f64,
    at: f64,
}

impl Largest {
    fn note(&mut self, value: f64, at: f64) {
        if value > self.value {
            *self = Self { value, at };
        }
    }
}

impl Demand {
    /// Demand in a run of `length` (s).
    ///
    /// # Errors
    /// [`BuildError`] of a program that cannot be planned.
    pub(super) fn of(scenario: &Scenario, chain: Option<&Chain>, length: f64) -> Result<Self, BuildError> {
        let units = Units::of(scenario);
        // The motion that function blocks make of their program is known only in a run.
        let is_planned = scenario.plc.is_none();
        let resistance = resistance(scenario, chain).filter(|_| is_planned);
        let motor = match &scenario.actuator {
            Actuator::Pmsm { motor, drive, .. } => Some((motor, &drive.params)),
            _ => None,
        };
        let (mut effort, mut voltage, mut speed, mut squares) = (Largest::default(), Largest::default(), 0.0_f64, 0.0);
        // An interpolated set-point comes later and is less smooth; the demand is that of the planned one.
        let planned = Scenario { interpolation: None, ..scenario.clone() };
        let mut program = Program::new(&planned)?;
        let base_rate = f64::from(scenario.base_rate.hertz());
        let ticks = (length * base_rate).floor();
        let stride = (ticks / MOST_SAMPLES).ceil().max(1.0);
        let mut tick = 0.0;
        let mut samples = 0.0;
        while tick <= ticks {
            let t = tick / base_rate;
            let now = program.at(t);
            let motor_speed = now.v / scenario.axis.transmission;
            speed = speed.max(motor_speed.abs());
            let torque = resistance.as_ref().map(|resistance| resistance.effort(t, now));
            if let Some(torque) = torque {
                effort.note(torque.abs(), t);
                squares += torque * torque;
            }
            if let Some((motor, drive)) = motor {
                voltage.note(voltage_for(motor, drive, torque.unwrap_or(0.0), motor_speed), t);
            }
            samples += 1.0;
            tick += stride;
        }
        let is_believed = chain.is_none();
        let effort = resistance.map(|_| EffortDemand {
            peak: effort.value,
            at: effort.at,
            rms: (squares / samples).sqrt(),
            available: available(&scenario.actuator),
            is_believed,
        });
        let voltage = match &scenario.actuator {
            Actuator::Pmsm { motor, dc_link, drive, .. } if is_planned => Some(VoltageDemand {
                peak: voltage.value,
                at: voltage.at,
                back_emf: motor.electrical_ratio * speed * motor.flux_linkage,
                available: inverter::voltage_limit(*dc_link),
                angle_per_period: motor.electrical_ratio * speed / current_rate(&drive.params),
            }),
            _ => None,
        };
        Ok(Self { effort, voltage, speed, speed_unit: speed_unit(units), effort_unit: units.effort })
    }

    pub(super) fn doubts(&self, scenario: &Scenario) -> Vec<Doubt> {
        let mut doubts = Vec::new();
        let show = |value, unit| format!("{:.4}", Quantity::new(value, unit));
        if let Some(EffortDemand { peak, at, available, is_believed, .. }) = self.effort
            && peak > available * (1.0 + ROUNDING)
        {
            let [needed, given] = [peak, available].map(|effort| show(effort, self.effort_unit));
            let by = if is_believed { ", by the drive's estimate," } else { "" };
            let message = format!(
                "to follow its set-point the axis needs {needed}{by} at {}; the drive gives {given} at most",
                show(at, "s")
            );
            let help = "lower acceleration or velocity of the set-point, or choose a stronger motor";
            doubts.push(Doubt::new(key_at(scenario, at), message, help));
        }
        let Some(VoltageDemand { peak, at, available, angle_per_period, back_emf }) = self.voltage else {
            return doubts;
        };
        if peak > available * (1.0 + ROUNDING) {
            let [needed, given, own] = [peak, available, back_emf].map(|volts| show(volts, "V"));
            let message = format!(
                "to follow its set-point the motor needs {needed} at {}, {own} of that its back-EMF at full speed; the DC link \
                 gives U_dc/√3 = {given} at most",
                show(at, "s")
            );
            let help = "lower the velocity of the set-point, or raise `drive.dc_link`";
            doubts.push(Doubt::new(key_at(scenario, at), message, help));
        }
        if angle_per_period > MOST_ANGLE {
            let (degrees, most) = (angle_per_period.to_degrees(), MOST_ANGLE.to_degrees());
            let message = format!(
                "the rotor turns by {degrees:.0}° electrical in a period of the current loop: above {most:.0}° its compensation of \
                 the dead time and its decoupling no longer hold"
            );
            let help = "raise `drive.current.rate`, or lower the velocity of the set-point";
            doubts.push(Doubt::new("drive.current.rate", message, help));
        }
        doubts
    }
}

/// Resistance of the axis to its motion; `None` where it is unknown here.
fn resistance(scenario: &Scenario, chain: Option<&Chain>) -> Option<Resistance> {
    let drive = scenario.actuator.drive()?;
    // The efforts of an FMU are unknown.
    if !scenario.fmus.is_empty() {
        return None;
    }
    match chain {
        Some(chain) => Some(Resistance::of_chain(scenario, chain)),
        None => Resistance::believed(scenario, &drive.estimate),
    }
}

/// The d-axis current that the drive requests (A, peak).
fn d_current(drive: &Params) -> f64 {
    drive.current_loop().map_or(0.0, |(current, _)| current.d_reference)
}

/// Rate of the current loop (Hz).
fn current_rate(drive: &Params) -> f64 {
    drive.current_loop().map_or(f64::INFINITY, |(_, rate)| rate.hertz().into())
}

/// Largest effort of drive and motor.
fn available(actuator: &Actuator) -> f64 {
    let motor = match actuator {
        Actuator::Prescribed | Actuator::Off(_) => f64::INFINITY,
        Actuator::Pmsm { motor, drive, .. } => {
            drive.params.current_loop().map_or(f64::INFINITY, |(current, _)| match current.operation.strategy {
                Strategy::DReference => motor.effort_constant(current.d_reference) * current.max_q_current(),
                Strategy::Mtpa => with_the_motor(motor, current).max_effort(),
            })
        }
        Actuator::IdealSource { source, .. } => source.gain * source.limit,
    };
    motor.min(actuator.max_effort())
}

/// The current loop of a drive that knows the motor.
const fn with_the_motor(motor: &pmsm::Params, current: &current::Params) -> current::Params {
    let pmsm::Params { electrical_ratio, resistance, inductance, flux_linkage } = *motor;
    current::Params { motor: MotorEstimate { electrical_ratio, resistance, inductance, flux_linkage }, ..*current }
}

/// |u| for `torque` at `speed`, both in the motor's coordinate, with the currents that `drive` chooses, even beyond its envelope.
fn voltage_for(motor: &pmsm::Params, drive: &Params, torque: f64, speed: f64) -> f64 {
    let omega_e = motor.electrical_ratio * speed;
    let mut i_d = d_current(drive);
    if let Some((current, _)) = drive.current_loop().filter(|(current, _)| !current.operation.is_plain()) {
        let current = with_the_motor(motor, current);
        i_d = Envelope::new(&current, &State::default(), omega_e).currents(&current, torque).d;
    }
    // A motor without magnets has no current in d where it has no torque.
    let i_q = if torque == 0.0 { 0.0 } else { torque / motor.effort_constant(i_d) };
    let u_d = motor.resistance * i_d - omega_e * motor.inductance.q * i_q;
    let u_q = motor.resistance * i_q + omega_e * (motor.inductance.d * i_d + motor.flux_linkage);
    u_d.hypot(u_q)
}

/// Key of the step that runs at `t` (s), or of the limits that all steps share.
fn key_at(scenario: &Scenario, t: f64) -> String {
    let Ok(program) = Program::new(scenario) else { return "setpoint".into() };
    let moves = scenario.program.iter().enumerate().filter(|(_, step)| matches!(step, Step::Move(_)));
    let running = moves.zip(program.moves()).filter(|(_, made)| (made.start..=made.end).contains(&t)).last();
    running.map_or_else(|| "disturbance".into(), |((index, _), _)| format!("program.{index}"))
}

const fn speed_unit(units: Units) -> &'static str {
    match units.motor.as_bytes() {
        b"m" => "m/s",
        _ => "rad/s",
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::preview::preview;

    /// 20 pole pairs at 6000 rpm and 4 kHz: π per period. The rotor alone, 1e-3 kg·m² at 3000 rad/s².
    const FAST: &str = r#"
        [run]
        base_rate = "4 kHz"
        [axis]
        motion = "rotary"
        [motor]
        kind = "pmsm"
        pole_pairs = 20
        resistance = "0.05 Ohm"
        inductance = "0.05 mH"
        flux_linkage = "2 mV s"
        inertia = "1e-3 kg m2"
        max_current = "100 Apk"
        [drive]
        dc_link = "100 V"
        current = { rate = "4 kHz", bandwidth = "200 Hz" }
        velocity = { rate = "4 kHz", bandwidth = "20 Hz" }
        position = { rate = "4 kHz", bandwidth = "4 Hz" }
        [setpoint]
        order = 3
        velocity = "6000 rpm"
        acceleration = "3000 rad/s2"
        jerk = "1e6 rad/s3"
        [[program]]
        move_to = "40 rev"
    "#;

    fn of(text: &str) -> (Demand, Vec<Doubt>) {
        let scenario =
            servobench_scenario::parse("test", text, None).unwrap_or_else(|error| panic!("{error}")).scenario;
        let preview = preview(&scenario, &scenario.engines, None).unwrap();
        (preview.demand, preview.doubts)
    }

    /// Oracle: T = J·a, K_t = 1.5·20·2 mV·s; back-EMF ψ·p·ω; u at the end of the acceleration, where speed is highest.
    #[test]
    fn effort_and_voltage_are_those_of_the_motor_equations() {
        let (demand, doubts) = of(FAST);
        let effort = demand.effort.unwrap();
        assert!((effort.peak - 3.0).abs() < 1e-9 && (effort.available - 6.0).abs() < 1e-9, "{effort:?}");
        let voltage = demand.voltage.unwrap();
        let omega = 6000.0 * std::f64::consts::TAU / 60.0;
        assert!((voltage.back_emf / (20.0 * omega * 2e-3) - 1.0).abs() < 1e-9, "{voltage:?}");
        assert!((voltage.available - 100.0 / 3.0_f64.sqrt()).abs() < 1e-9, "{voltage:?}");
        assert!((voltage.angle_per_period / (20.0 * omega / 4e3) - 1.0).abs() < 1e-9, "{voltage:?}");
        // With the torque of the constant acceleration, 50 A, short of full speed by what the jerk takes, 4.5 rad/s and a tick.
        let (w, i_q) = (20.0 * (omega - 4.5), 50.0);
        let u = (w * 0.05e-3 * i_q).hypot(0.05 * i_q + w * 2e-3);
        assert!((voltage.peak / u - 1.0).abs() < 0.01, "{voltage:?} {u}");
        let said: Vec<_> = doubts.iter().map(|doubt| (doubt.key.as_str(), doubt.message.as_str())).collect();
        let [(key, angle)] = said[..] else { panic!("{said:?}") };
        assert!(key == "drive.current.rate" && angle.contains("turns by 180° electrical"), "{angle}");
    }

    /// Oracle: by hand. Of 100 A the d axis takes 60 and leaves 80; it weakens a field of 2 mV·s by 3.
    #[test]
    fn a_current_of_the_d_axis_takes_its_share_of_current_and_voltage() {
        let (demand, _) = of(&FAST.replace("\"200 Hz\" }", "\"200 Hz\", d_reference = \"-60 Apk\" }"));
        assert!((demand.effort.unwrap().available - 4.8).abs() < 1e-9, "{demand:?}");
        let (w, i_d, i_q) = (20.0 * (6000.0 * std::f64::consts::TAU / 60.0 - 4.5), -60.0, 50.0);
        let u = (0.05 * i_d - w * 0.05e-3 * i_q).hypot(0.05 * i_q + w * (0.05e-3 * i_d + 2e-3));
        assert!((demand.voltage.unwrap().peak / u - 1.0).abs() < 0.01, "{demand:?} {u}");
    }

    #[test]
    fn what_there_is_not_is_doubted_at_the_move_that_needs_it() {
        let (_, exact) = of(&FAST.replace("max_current = \"100 Apk\"", "max_current = \"50 Apk\""));
        assert_eq!(exact.len(), 1, "3 N·m of 3 N·m: {exact:?}");
        let weak = FAST.replace("max_current = \"100 Apk\"", "max_current = \"49 Apk\"");
        let (_, doubts) = of(&weak.replace("[[program]]", "[[program]]\nwait = \"0.1 s\"\n[[program]]"));
        assert_eq!(doubts[0].key, "program.1", "{doubts:?}");
        assert!(doubts[0].message.contains("needs 3.000 N·m") && doubts[0].message.contains("2.940 N·m"), "{doubts:?}");
        let (_, doubts) = of(&FAST.replace("dc_link = \"100 V\"", "dc_link = \"40 V\""));
        assert!(doubts[0].message.contains("U_dc/√3 = 23.09 V"), "{doubts:?}");
    }

    #[test]
    fn without_a_drive_nothing_is_asked_for() {
        let text = "[run]\nbase_rate = \"5 kHz\"\nduration = \"1 s\"\n[axis]\nmotion = \"linear\"\nload = { mass = \"3 kg\", \
                    stiffness = \"1e4 N/m\" }\n[motor]\nkind = \"prescribed\"\n";
        let (demand, doubts) = of(text);
        assert_eq!((demand.effort, demand.voltage, doubts.len()), (None, None, 0));
    }
}
