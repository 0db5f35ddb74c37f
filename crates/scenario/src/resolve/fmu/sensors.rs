//! The sensors of an axis whose drive an FMU replaces: only signals connected to an FMU are measured.
use crate::diagnostic::Report;
use crate::file::{Encoder, File};
use crate::resolve::refuse;
use crate::scenario::{Fmu, InputSource};
use crate::source::Authority;
use crate::table::Keys as _;
use servobench_signals::Signal;

/// Refuses errors of sensors that no FMU reads, and warns of an unused resolution.
pub(super) fn check(file: &File, all: &[Fmu], by_voltage: bool, report: &mut Report) {
    let given = |signal| all.iter().flat_map(|fmu| &fmu.inputs).any(|(_, one)| *one == InputSource::Signal(signal));
    let motor = file.motor.given().and_then(|motor| motor.encoder.given());
    if let Some(encoder) = motor {
        if !given(Signal::MeasuredMotorPosition) {
            encoder_is_idle(encoder, Signal::MeasuredMotorPosition, report);
        }
        let commutation = [("commutation_offset", encoder.commutation.offset.span())];
        let why = "is not used: the voltage of an FMU in place of the drive is in the frame of the rotor itself";
        refuse(&commutation, why, "leave it out", report);
    }
    let drive = file.drive.given();
    if let Some(encoder) = drive.and_then(|drive| drive.load_encoder.given())
        && !given(Signal::MeasuredLoadPosition)
    {
        encoder_is_idle(encoder, Signal::MeasuredLoadPosition, report);
    }
    let sensor = drive.and_then(|drive| drive.current.given()?.sensor.given());
    if let Some(sensor) = sensor
        && !(by_voltage && (given(Signal::MeasuredCurrentD) || given(Signal::MeasuredCurrentQ)))
    {
        let help = if by_voltage {
            "connect an input to `measured.current.d` or `measured.current.q`, or leave it out"
        } else {
            "leave it out: an FMU that gives `effort.motor` replaces the motor, too"
        };
        refuse(&sensor.spans(), "is not used: no FMU is given the measured current", help, report);
    }
}

/// Reports keys of an encoder that have no effect, as no FMU reads `signal`.
fn encoder_is_idle(encoder: &Encoder, signal: Signal, report: &mut Report) {
    let why = format!("is not used: an FMU replaces the drive, and none is given `{}`", signal.name());
    let help = format!("connect an input to `{}`, or leave it out", signal.name());
    let resolution = ["counts_per_rev", "step", "interpolation", "signal_period", "lines_per_rev"];
    let (of_resolution, errors): (Vec<_>, Vec<_>) =
        encoder.spans().into_iter().partition(|(key, _)| resolution.contains(key));
    refuse(&errors, &why, &help, report);
    // An FMU that stands for a drive with its encoder counts by itself.
    for (key, span) in of_resolution {
        if let Some(span) = span.filter(|span| span.source.authority() != Authority::Model) {
            report.warning(span, format!("`{key}` {why}"), help.as_str());
        }
    }
}
