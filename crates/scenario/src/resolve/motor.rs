//! `[motor]`: one set of parameters from the values given in a data sheet.
use crate::diagnostic::Report;
use crate::field::{Either, Reported, Slot};
use servobench_base::{Coordinate, Dq};
use servobench_plant::{Encoder, IdealSource, SourceOutput, Wiring, pmsm};

use crate::file;
use crate::file::MotorKind;
use crate::resolve::{Alternative, motor_effects, need, one_of, refuse, sensors};
use crate::source::{Sources, Span};
use std::f64::consts::PI;

const SQRT_3: f64 = 1.732_050_807_568_877_2;

/// The motor or source of the axis, without a drive.
pub(super) enum Motor {
    /// A synchronous motor and its largest phase current, peak (A).
    Pmsm {
        motor: pmsm::Params,
        effects: Box<pmsm::Effects>,
        wiring: Wiring,
        encoder: Encoder,
        max_current: f64,
    },
    IdealSource {
        source: IdealSource,
        encoder: Encoder,
    },
    Prescribed,
}

type Keys<'a> = [(&'a str, Option<Span>)];

pub(super) fn resolve(motor: &file::Motor, sources: &Sources, report: &mut Report) -> Option<Motor> {
    let kind = need(&motor.kind, "motor", "kind", motor.span, report)?;
    let electrical: &Keys<'_> = &[
        ("pole_pairs", motor.pole_pairs.span()),
        ("pole_pitch", motor.pole_pitch.span()),
        ("resistance", motor.resistance.span()),
        ("inductance", motor.inductance.span()),
        ("inductance_d", motor.inductance_d.span()),
        ("inductance_q", motor.inductance_q.span()),
        ("flux_linkage", motor.flux_linkage.span()),
        ("torque_constant", motor.torque_constant.span()),
        ("force_constant", motor.force_constant.span()),
        ("back_emf", motor.back_emf.span()),
        ("max_current", motor.max_current.span()),
        ("cogging", motor.cogging.span()),
        ("flux_harmonic", motor.flux_harmonic.span()),
        ("iron_loss", motor.iron_loss.span()),
        ("phase_resistance", motor.phase_resistance.span()),
        ("temperature", motor.temperature.span()),
        ("thermal", motor.thermal.span()),
        ("saturation", motor.saturation.span()),
        ("flux_map", motor.flux_map.span()),
        ("connection", motor.connection.span()),
    ];
    let ideal: &Keys<'_> = &[("gain", motor.gain.span()), ("limit", motor.limit.span())];
    let encoder = encoder(&motor.encoder, report);
    match kind {
        MotorKind::Pmsm => {
            refuse(ideal, "belongs to an ideal source, this is a synchronous motor", "", report);
            pmsm(motor, encoder, sources, report)
        }
        MotorKind::IdealSource => {
            refuse(electrical, "belongs to a synchronous motor, this is an ideal source", "", report);
            sensors::refuse_commutation(&motor.encoder, report);
            Some(Motor::IdealSource { source: ideal_source(motor, report)?, encoder: encoder? })
        }
        MotorKind::Prescribed => {
            let why = "has no effect on a motor that follows the set-point exactly";
            refuse(electrical, why, "", report);
            refuse(ideal, why, "", report);
            refuse(&[("encoder", motor.encoder.span())], why, "", report);
            Some(Motor::Prescribed)
        }
    }
}

fn pmsm(motor: &file::Motor, encoder: Option<Encoder>, sources: &Sources, report: &mut Report) -> Option<Motor> {
    let header = motor.span;
    let electrical_ratio = electrical_ratio(motor, report);
    let resistance = need(&motor.resistance, "motor", "resistance", header, report);
    let inductances = inductances(motor, report);
    let flux_linkage = flux_linkage(motor, electrical_ratio, report);
    let max_current = need(&motor.max_current, "motor", "max_current", header, report);
    let params = pmsm::Params {
        inductance: inductances?,
        electrical_ratio: electrical_ratio?,
        resistance: resistance?,
        flux_linkage: flux_linkage?,
    };
    if params.has_no_torque() {
        let span = motor.flux_linkage.span().unwrap_or(header);
        let message = format!(
            "a `flux_linkage` of 0 V s and equal inductances of {} H leave the motor no torque",
            params.inductance.d
        );
        let help = "a reluctance motor has an `inductance_d` and an `inductance_q` that differ, any other a `flux_linkage` above 0";
        report.error(span, message, help);
        return None;
    }
    let effects = Box::new(motor_effects::resolve(motor, &params, sources, report).ok()?);
    let encoder = sensors::with_commutation(encoder?, &motor.encoder, params.electrical_ratio).ok()?;
    let wiring = wiring(motor, report).ok()?;
    Some(Motor::Pmsm { motor: params, effects, wiring, encoder, max_current: max_current? })
}

fn wiring(motor: &file::Motor, report: &mut Report) -> Result<Wiring, Reported> {
    let Some(given) = motor.connection.optional()? else { return Ok(Wiring::default()) };
    if let (Some(span), None) = (given.open_at.span(), given.open.span()) {
        report.error(span, "`open_at` is when a phase is lost, and none is", "give `open`, or leave it out");
        return Err(Reported);
    }
    let saturates = motor.saturation.span().is_some() || motor.flux_map.span().is_some();
    if let (Some(span), true) = (given.open.span(), saturates) {
        let help = "leave out one of `connection.open`, `saturation` and `flux_map`";
        report.error(span, "a motor that saturates is not simulated with a lost phase", help);
        return Err(Reported);
    }
    let at = given.open_at.optional()?.copied().unwrap_or(0.0);
    Ok(Wiring { swapped: given.swapped.optional()?.copied(), open: given.open.optional()?.map(|phase| (*phase, at)) })
}

/// Electrical angle per motor coordinate: pole pairs of a rotary motor, π/τ_p of a linear one.
fn electrical_ratio(motor: &file::Motor, report: &mut Report) -> Option<f64> {
    if let (Some(pairs), Some(pitch)) = (motor.pole_pairs.span(), motor.pole_pitch.span())
        && pairs.source == pitch.source
    {
        let help = "a motor that turns has `pole_pairs`, a linear motor has `pole_pitch`";
        report.error(pairs.max(pitch), "`pole_pairs` and `pole_pitch` of one motor", help);
        return None;
    }
    let (of_another, constant, turns) = match report.motor? {
        Coordinate::Rotary => (&motor.force_constant, "torque_constant", "turns"),
        Coordinate::Linear => (&motor.torque_constant, "force_constant", "moves along a line"),
    };
    if let Some(span) = of_another.span() {
        let other = if constant == "torque_constant" { "force_constant" } else { "torque_constant" };
        report.error(span, format!("the motor {turns} and has no `{other}`"), format!("give its `{constant}`"));
    }
    if report.motor == Some(Coordinate::Rotary) {
        return need(&motor.pole_pairs, "motor", "pole_pairs", motor.span, report).map(f64::from);
    }
    if matches!(motor.pole_pitch, Slot::Absent) {
        let help = "a motor that turns has `pole_pairs`, and a linear axis then a `lead`";
        report.missing_with_help("motor", "pole_pitch", motor.span, help);
    }
    motor.pole_pitch.given().map(|pitch| PI / pitch)
}

fn inductances(motor: &file::Motor, report: &mut Report) -> Option<Dq> {
    let per_axis = motor.inductance_d.span().or(motor.inductance_q.span());
    match one_of(&[("inductance", motor.inductance.span()), ("inductance_d", per_axis)], report) {
        Alternative::Use(0) => motor.inductance.given().map(|both| Dq { d: *both, q: *both }),
        Alternative::Contradiction => None,
        Alternative::Use(_) => {
            let d = need(&motor.inductance_d, "motor", "inductance_d", motor.span, report);
            let q = need(&motor.inductance_q, "motor", "inductance_q", motor.span, report);
            d.zip(q).map(|(d, q)| Dq { d, q })
        }
        Alternative::None => {
            let help = "or `inductance_d` and `inductance_q`";
            report.missing_with_help("motor", "inductance", motor.span, help);
            None
        }
    }
}

/// ψ from the given key: itself, or per ampere of amplitude `K_t = 1.5·p·ψ`, or line to line `K_e = √3·p·ψ`; with π/τ_p
/// for p in a linear motor.
fn flux_linkage(motor: &file::Motor, electrical_ratio: Option<f64>, report: &mut Report) -> Option<f64> {
    let constant = match report.motor? {
        Coordinate::Rotary => ("torque_constant", &motor.torque_constant),
        Coordinate::Linear => ("force_constant", &motor.force_constant),
    };
    let ways = [
        ("flux_linkage", motor.flux_linkage.span()),
        (constant.0, constant.1.span()),
        ("back_emf", motor.back_emf.span()),
    ];
    match one_of(&ways, report) {
        Alternative::Use(0) => motor.flux_linkage.given().copied(),
        Alternative::Use(1) => Some(constant.1.given()? / (1.5 * electrical_ratio?)),
        Alternative::Use(_) => Some(motor.back_emf.given()? / (SQRT_3 * electrical_ratio?)),
        Alternative::Contradiction => None,
        Alternative::None => {
            let help = format!("or `{}`, or `back_emf`", constant.0);
            report.missing_with_help("motor", "flux_linkage", motor.span, &help);
            None
        }
    }
}

fn ideal_source(motor: &file::Motor, report: &mut Report) -> Option<IdealSource> {
    let gain = motor.gain.optional().ok()?.copied();
    let limit = match (&motor.limit, gain) {
        (Slot::Absent, _) => f64::INFINITY,
        (Slot::Wrong(_), _) => return None,
        (Slot::Given(limit), _) => match (limit.value, gain) {
            (Either::First(volts), Some(_)) => volts,
            (Either::Second(effort), gain) => effort / gain.unwrap_or(1.0),
            (Either::First(_), None) => {
                report.error(limit.span, "a `limit` in volts needs a `gain`", "give force or torque per volt");
                return None;
            }
        },
    };
    let output = if gain.is_some() { SourceOutput::Voltage } else { SourceOutput::Effort };
    Some(IdealSource { gain: gain.unwrap_or(1.0), output, limit })
}

fn encoder(slot: &Slot<file::Encoder>, report: &mut Report) -> Option<Encoder> {
    let Some(encoder) = slot.optional().ok()? else { return Some(Encoder::default()) };
    sensors::encoder(encoder, report.motor, report).ok()
}
