//! `[axis.fmu]`: an FMU as the mechanics.
use super::{Known, Port, fmu};
use crate::argument::si_unit;
use crate::diagnostic::Report;
use crate::field::Slot;
use crate::file::File;
use crate::scenario::{Fmu, InputSource};
use crate::source::At;
use servobench_base::Coordinate;
use servobench_config::{Choice as _, choices};
use servobench_fmu_file::SiPort;
use servobench_plant::{FmuBody, FmuModel, ModelKind};
use servobench_signals::Signal;

choices! {
    /// Roles of the outputs of an FMU that simulates the mechanics.
    enum BodySignal {
        /// the motor's position in the motor coordinate
        ShaftPosition = "shaft.position",
        /// the motor's velocity in the motor coordinate
        ShaftVelocity = "shaft.velocity",
        /// the load's position in the axis coordinate
        LoadPosition = "load.position",
        /// the load's velocity in the axis coordinate
        LoadVelocity = "load.velocity",
    }
}

impl Port for BodySignal {
    fn all() -> impl Iterator<Item = Self> + Clone {
        Self::ALL.iter().map(|(_, signal, _)| *signal)
    }

    fn name(self) -> &'static str {
        servobench_config::Choice::name(self)
    }
}

/// Signals that act on mechanics.
const ON_MECHANICS: [Signal; 3] = [Signal::EffortMotor, Signal::DisturbanceMotor, Signal::DisturbanceLoad];
/// Position and velocity of the two bodies that mechanics can have; a velocity needs its position.
const BODIES: [[BodySignal; 2]; 2] =
    [[BodySignal::ShaftPosition, BodySignal::ShaftVelocity], [BodySignal::LoadPosition, BodySignal::LoadVelocity]];

/// The mechanics as an FMU, according to its own table.
pub(in crate::resolve) struct Mechanics {
    fmu: Fmu,
    outputs: Vec<(String, BodySignal)>,
}

impl Mechanics {
    /// The model with its variables assigned, for these coordinates of motor and load and this transmission.
    pub(in crate::resolve) fn model(self, [motor, axis]: [Coordinate; 2], transmission: f64) -> Option<FmuModel> {
        let Self { fmu, outputs } = self;
        let input = |signal, unit| {
            let given = fmu.inputs.iter().find(|(_, source)| *source == InputSource::Signal(signal));
            given.map(|(variable, _)| port(variable, unit))
        };
        let body = |motion: Coordinate, position, velocity| {
            let output = |signal, unit: &str| {
                outputs.iter().find(|(_, to)| *to == signal).map(|(variable, _)| port(variable, unit))
            };
            let unit = motion.unit();
            Some(FmuBody { position: output(position, unit)?, velocity: output(velocity, &format!("{unit}/s")) })
        };
        let [[shaft, shaft_velocity], [load, load_velocity]] = BODIES;
        Some(FmuModel {
            effort: input(Signal::EffortMotor, motor.effort_unit())?,
            motor: body(motor, shaft, shaft_velocity)?,
            load: body(axis, load, load_velocity),
            motor_disturbance: input(Signal::DisturbanceMotor, motor.effort_unit()),
            load_disturbance: input(Signal::DisturbanceLoad, axis.effort_unit()),
            transmission,
            ticks: fmu.every,
            file: fmu.file,
        })
    }
}

fn port(variable: &str, unit: &str) -> SiPort {
    SiPort { variable: variable.to_owned(), unit: si_unit(unit) }
}

/// The mechanics as an FMU, if there is one.
#[expect(clippy::option_option, reason = "a wrong table is not the same as none")]
pub(in crate::resolve) fn mechanics(file: &File, known: Known<'_>, report: &mut Report) -> Option<Option<Mechanics>> {
    let slot = file.axis.given().map_or(&Slot::Absent, |axis| &axis.fmu);
    let engines = file.engine.given().map_or(&[][..], |engines| &engines.0);
    let asked = engines.iter().find(|engine| engine.value.simulates(ModelKind::Fmu));
    if let (Some(engine), Slot::Absent) = (asked, slot) {
        report.error(engine.span, format!("the engine \"{}\" has no FMU", engine.value), "give `[axis.fmu]`");
    }
    let Some(At { value: given, span }) = slot.at() else { return slot.optional().ok().map(|_| None) };
    if asked.is_none() {
        report.warning(*span, "`fmu` is not used", "add \"fmu\" to `engine`");
    }
    let signals = |text: &str| {
        ON_MECHANICS.iter().find(|signal| signal.name() == text).map(|signal| InputSource::Signal(*signal))
    };
    if let Some(span) = given.excites.span() {
        report.error(span, "`excites` is for an FMU beside the axis", "leave it out");
    }
    let fmu = fmu(given, 1, known, report, &signals, &ON_MECHANICS.map(Signal::name));
    if let Some((fmu, outputs)) = &fmu {
        let gives = |port: BodySignal| outputs.iter().any(|(_, to)| *to == port);
        let at = |port: BodySignal| outputs.iter().position(|(_, to)| *to == port);
        let [[shaft, _], [load, load_velocity]] = BODIES;
        let place = |port| {
            given.outputs.given().zip(at(port)).and_then(|(table, at)| table.0.get(at)).map(|one| one.value.span)
        };
        if !gives(shaft) {
            let help =
                "mechanics give the motor's position in the motor coordinate, and the load's unless they are one body";
            report.error(given.outputs.span().unwrap_or(*span), "no output is `shaft.position`", help);
            return None;
        }
        if gives(load_velocity) && !gives(load) {
            let span = place(load_velocity).unwrap_or(*span);
            report.error(span, "a load with a velocity needs a position", "connect `load.position` too");
            return None;
        }
        let effort = fmu.inputs.iter().any(|(_, signal)| *signal == InputSource::Signal(Signal::EffortMotor));
        if !effort {
            let help = "write inputs = { variable = \"effort.motor\" }";
            report.error(given.inputs.span().unwrap_or(*span), "no input is given `effort.motor`", help);
            return None;
        }
    }
    fmu.map(|(fmu, outputs)| Some(Mechanics { fmu, outputs }))
}
