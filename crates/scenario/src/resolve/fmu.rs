//! `[axis.fmu]`, `[[fmu]]` and `[coupling]`: which files, what they are connected to, and how often.
use crate::diagnostic::Report;
use crate::field::Slot;
use crate::file::{self, File};
use crate::name_table::Named;
use crate::nearest::suggestion;
use crate::resolve::{refuse, whole};
use crate::scenario::{Actuator, BodySignal, CoSimulation, CouplingMethod, Fmu, InputSource, Isolation, LoopSignal};
use crate::source::{At, Place, Sources, Span};
use servobench_base::Rate;
use servobench_plant::ModelKind;
use servobench_signals::Signal;
use std::path::{Path, PathBuf};

/// How long a call of an FMU may take, unless given (s).
const PATIENCE: f64 = 10.0;
/// Memory of its process, unless given (MB).
const MEMORY: u32 = 2048;
/// Agreement of inputs and outputs that are iterated, unless given.
const TOLERANCE: f64 = 1e-9;
/// Repetitions of a step, unless given.
const ITERATIONS: u32 = 50;

/// What the outputs of an FMU can be.
trait Port: Copy + PartialEq + 'static {
    const ALL: &'static [Self];

    /// The name that files write.
    fn name(self) -> &'static str;
}

impl Port for BodySignal {
    const ALL: &'static [Self] = &[Self::ShaftPosition, Self::ShaftVelocity, Self::LoadPosition, Self::LoadVelocity];

    fn name(self) -> &'static str {
        self.name()
    }
}

impl Port for LoopSignal {
    const ALL: &'static [Self] = Self::ALL;

    fn name(self) -> &'static str {
        self.signal().name()
    }
}

/// What acts on mechanics.
const ON_MECHANICS: [Signal; 3] = [Signal::EffortMotor, Signal::DisturbanceMotor, Signal::DisturbanceLoad];
/// Position and velocity of the two bodies that mechanics can have; a velocity needs its position.
const BODIES: [[BodySignal; 2]; 2] =
    [[BodySignal::ShaftPosition, BodySignal::ShaftVelocity], [BodySignal::LoadPosition, BodySignal::LoadVelocity]];

/// Where files are, and how long a tick is.
#[derive(Clone, Copy)]
pub(super) struct Known<'a> {
    pub(super) base_rate: Option<Rate>,
    pub(super) sources: &'a Sources,
    pub(super) actuator: Option<&'a Actuator>,
}

/// The mechanics as an FMU, where there are such.
#[expect(clippy::option_option, reason = "a wrong table is not the same as none")]
pub(super) fn mechanics(file: &File, known: Known<'_>, report: &mut Report) -> Option<Option<Fmu<BodySignal>>> {
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
    let fmu = fmu(given, 1, known, report, &signals, &ON_MECHANICS.map(Signal::name));
    if let Some(fmu) = &fmu {
        let gives = |port: BodySignal| fmu.outputs.iter().any(|(_, to)| *to == port);
        let at = |port: BodySignal| fmu.outputs.iter().position(|(_, to)| *to == port);
        let [[shaft, _], [load, load_velocity]] = BODIES;
        let place = |port| {
            given.outputs.given().zip(at(port)).and_then(|(table, at)| table.0.get(at)).map(|one| one.value.span)
        };
        if !gives(shaft) {
            let help =
                "mechanics give the motor's position in its own coordinate, and the load's unless they are one body";
            report.error(given.outputs.span().unwrap_or(*span), "no output is `shaft.position`", help);
            return None;
        }
        if gives(load_velocity) && !gives(load) {
            let span = place(load_velocity).unwrap_or(*span);
            report.error(span, "a load with a velocity has a position", "connect `load.position` too");
            return None;
        }
        let effort = fmu.inputs.iter().any(|(_, signal)| *signal == InputSource::Signal(Signal::EffortMotor));
        if !effort {
            let help = "write inputs = { variable = \"effort.motor\" }";
            report.error(given.inputs.span().unwrap_or(*span), "no input is given `effort.motor`", help);
            return None;
        }
    }
    fmu.map(Some)
}

/// The FMUs beside the axis.
pub(super) fn others(
    file: &File,
    coupling: Option<CoSimulation>,
    known: Known<'_>,
    report: &mut Report,
) -> Option<Vec<Fmu<LoopSignal>>> {
    let given = match &file.fmu {
        Slot::Absent => return Some(Vec::new()),
        Slot::Wrong(_) => return None,
        Slot::Given(given) => &given.value.0,
    };
    let names: Vec<String> = given.iter().map(|one| name(&one.value)).collect();
    let mut all = Vec::new();
    for (index, one) in given.iter().enumerate() {
        check_name(&names, index, &one.value, report);
        let signals = |text: &str| signal(text, &names);
        let every = coupling.map_or(1, |coupling| coupling.every);
        let offered: Vec<&str> = Signal::ALL
            .iter()
            .map(|signal| signal.name())
            .chain(["shaft.position", "shaft.velocity", "time"])
            .collect();
        all.push(fmu(&one.value, every, known, report, &signals, &offered));
    }
    let all: Vec<_> = all.into_iter().collect::<Option<_>>()?;
    check_ports(file, given, &all, known, report);
    Some(all)
}

/// Exchange of all FMUs with the axis.
pub(super) fn coupling(file: &File, base_rate: Option<Rate>, report: &mut Report) -> Option<CoSimulation> {
    let held = CoSimulation {
        every: 1,
        method: CouplingMethod::default(),
        extrapolation: 0,
        tolerance: TOLERANCE,
        iterations: ITERATIONS,
    };
    let given = match &file.coupling {
        Slot::Absent => return Some(held),
        Slot::Wrong(_) => return None,
        Slot::Given(given) => given,
    };
    if matches!(file.fmu, Slot::Absent) {
        report.error(given.span, "there is nothing to couple", "give `[[fmu]]`; `[axis.fmu]` has a `step` of its own");
    }
    let given = &given.value;
    let every = match &given.step {
        Slot::Absent => Some(1),
        Slot::Wrong(_) => None,
        Slot::Given(at) => whole::ticks("step", *at, base_rate, report),
    };
    let method = given.method.optional().ok()?.copied().unwrap_or_default();
    if method != CouplingMethod::Iterated {
        let keys = [("tolerance", given.tolerance.span()), ("iterations", given.iterations.span())];
        refuse(&keys, "is for the method \"iterated\"", "leave it out, or iterate", report);
    }
    Some(CoSimulation {
        every: every?,
        method,
        extrapolation: given.extrapolation.optional().ok()?.copied().unwrap_or(held.extrapolation),
        tolerance: given.tolerance.optional().ok()?.copied().unwrap_or(held.tolerance),
        iterations: given.iterations.optional().ok()?.copied().unwrap_or(held.iterations),
    })
}

fn fmu<P: Port>(
    given: &file::Fmu,
    every: u32,
    known: Known<'_>,
    report: &mut Report,
    signal: &dyn Fn(&str) -> Option<InputSource>,
    signals: &[&str],
) -> Option<Fmu<P>> {
    let path = path(&given.file, known.sources, report);
    let every = match &given.step {
        Slot::Absent => Some(every),
        Slot::Wrong(_) => None,
        Slot::Given(at) => whole::ticks("step", *at, known.base_rate, report).and_then(|ticks| {
            if ticks.is_multiple_of(every) {
                return Some(ticks);
            }
            let message = format!("`step` is {ticks} base ticks, no whole number of steps of `[coupling]`, {every}");
            report.error(at.span, message, "");
            None
        }),
    };
    let isolation = given.isolation.optional().ok().map(|isolation| isolation.copied().unwrap_or_default());
    if isolation == Some(Isolation::None) {
        let keys = [("patience", given.patience.span()), ("memory", given.memory.span())];
        refuse(&keys, "is for an FMU in a process of its own", "leave `isolation` out", report);
    }
    let read = |text: &str| signal(text).ok_or_else(|| suggestion(text, signals.iter().copied()));
    let inputs = given
        .inputs
        .optional()
        .ok()
        .and_then(|table| connections(table.map_or(&[][..], |table| &table.0), "no signal", report, read));
    let outputs = given.outputs.optional().ok().and_then(|table| {
        let port = |text: &str| {
            let found = P::ALL.iter().find(|port| port.name() == text).copied();
            found.ok_or_else(|| suggestion(text, P::ALL.iter().map(|port| port.name())))
        };
        connections(table.map_or(&[][..], |table| &table.0), "nothing that an FMU can give here", report, port)
    });
    let start =
        given.parameters.optional().ok()?.map_or_else(Vec::new, |table| {
            table.0.iter().map(|one| (one.name.clone(), one.value.value.clone())).collect()
        });
    let outputs = outputs?;
    for (index, (_, port)) in outputs.iter().enumerate() {
        if outputs[..index].iter().any(|(_, before)| before == port) {
            twice(given, index, *port, report);
            return None;
        }
    }
    Some(Fmu {
        name: name(given),
        path: path?,
        every: every?,
        isolation: isolation?,
        event_mode: given.event_mode.optional().ok()?.copied().unwrap_or(true),
        patience: given.patience.optional().ok()?.copied().unwrap_or(PATIENCE),
        memory: given.memory.optional().ok()?.copied().unwrap_or(MEMORY),
        start,
        inputs: inputs?,
        outputs,
    })
}

fn connections<T>(
    given: &[Named<String>],
    what: &str,
    report: &mut Report,
    read: impl Fn(&str) -> Result<T, String>,
) -> Option<Vec<(String, T)>> {
    let all: Vec<_> = given
        .iter()
        .map(|Named { name, value, .. }| match read(&value.value) {
            Ok(found) => Some((name.clone(), found)),
            Err(help) => {
                report.error(value.span, format!("`{}` is {what}", value.value), help);
                None
            }
        })
        .collect();
    all.into_iter().collect()
}

fn twice(given: &file::Fmu, index: usize, port: impl Port, report: &mut Report) {
    let span = given.outputs.given().and_then(|table| table.0.get(index)).map(|one| one.value.span);
    report.error(span.unwrap_or(given.span), format!("`{}` is given twice", port.name()), "one output is one signal");
}

/// A channel, or the output of an FMU.
fn signal(text: &str, names: &[String]) -> Option<InputSource> {
    match text {
        "time" => return Some(InputSource::Time),
        "shaft.position" => return Some(InputSource::ShaftPosition),
        "shaft.velocity" => return Some(InputSource::ShaftVelocity),
        _ => {}
    }
    if let Ok(signal) = text.parse() {
        return Some(InputSource::Signal(signal));
    }
    let (name, variable) = text.split_once('.')?;
    let fmu = names.iter().position(|one| one == name)?;
    Some(InputSource::Fmu { fmu, variable: variable.to_owned() })
}

fn name(given: &file::Fmu) -> String {
    let of_file = || {
        given.file.given().and_then(|file| Path::new(file).file_stem()).map(|stem| stem.to_string_lossy().into_owned())
    };
    given.name.given().cloned().or_else(of_file).unwrap_or_default()
}

fn check_name(names: &[String], index: usize, given: &file::Fmu, report: &mut Report) {
    let name = names[index].as_str();
    let span = given.name.span().unwrap_or(given.span);
    let is_of_signals =
        Signal::ALL.iter().any(|signal| signal.name().split_once('.').is_some_and(|(group, _)| group == name));
    if names[..index].iter().any(|before| before == name) {
        report.error(span, format!("a second FMU is called `{name}`"), "give each its own `name`");
    } else if name.is_empty() || name.contains('.') || is_of_signals || name == "time" || name == "shaft" {
        let message = format!("`{name}` cannot name an FMU");
        report.error(
            span,
            message,
            "signals are called `name.variable`: give a `name` without a point that begins no channel's",
        );
    }
}

fn path(file: &Slot<String>, sources: &Sources, report: &mut Report) -> Option<PathBuf> {
    let file = file.at()?;
    let Some(Place::Folder(folder)) = sources.place(file.span.source) else {
        report.error(file.span, "a scenario without a folder cannot name files", "");
        return None;
    };
    let path = folder.join(&file.value);
    match std::fs::metadata(&path) {
        Ok(found) if found.is_file() => Some(path),
        Ok(_) => {
            report.error(file.span, format!("`{}` is no file", path.display()), "an FMU is a zip archive");
            None
        }
        Err(error) => {
            let message = format!("cannot read `{}`: {error}", path.display());
            report.error(file.span, message, "the path is relative to this file");
            None
        }
    }
}

/// What all FMUs together give to the loop.
fn check_ports(file: &File, given: &[At<file::Fmu>], all: &[Fmu<LoopSignal>], known: Known<'_>, report: &mut Report) {
    let place = |fmu: usize, output: usize| -> Span {
        let one = &given[fmu];
        let entry = one.value.outputs.given().and_then(|table| table.0.get(output));
        entry.map_or(one.span, |entry| entry.value.span)
    };
    let mut taken: Vec<(LoopSignal, Span)> = Vec::new();
    for (f, fmu) in all.iter().enumerate() {
        for (o, (_, port)) in fmu.outputs.iter().enumerate() {
            if taken.iter().any(|(before, _)| before == port) {
                report.error(
                    place(f, o),
                    format!("`{}` is given by another FMU too", port.name()),
                    "efforts do not add up here: let one FMU sum them",
                );
            } else {
                taken.push((*port, place(f, o)));
            }
        }
    }
    let of = |port: LoopSignal| taken.iter().find(|(taken, _)| *taken == port).map(|(_, span)| *span);
    if let Some(span) = of(LoopSignal::SetpointPosition) {
        let written = [("program", file.program.span()), ("call", file.call.span())];
        refuse(&written, "and a set-point from an FMU cannot be together", "give one of them", report);
        if file.run.given().is_some_and(|run| run.duration.span().is_none()) {
            report.error(span, "nobody knows how long the set-point of an FMU lasts", "give `duration` in `[run]`");
        }
    } else if let Some(span) = of(LoopSignal::SetpointVelocity).or(of(LoopSignal::SetpointAcceleration)) {
        report.error(span, "a set-point has a position", "connect `setpoint.position` too");
    }
    let (d, q, effort) = (of(LoopSignal::VoltageD), of(LoopSignal::VoltageQ), of(LoopSignal::Effort));
    if let (Some(span), None) | (None, Some(span)) = (d, q) {
        report.error(span, "a voltage has two parts", "connect `voltage.d` and `voltage.q`");
    }
    if let (Some(span), Some(_)) = (d.or(q), effort) {
        report.error(
            span,
            "`effort.motor` stands for drive and motor, a voltage for the drive alone",
            "connect one of them",
        );
    }
    if let Some(span) = d.or(q).or(effort) {
        controller(file, d.is_some(), span, known.actuator, report);
    }
}

/// An FMU in place of the drive.
fn controller(file: &File, by_voltage: bool, span: Span, actuator: Option<&Actuator>, report: &mut Report) {
    let why = "and an FMU in place of the drive cannot be together";
    refuse(&[("bus", file.bus.span()), ("call", file.call.span())], why, "the FMU is the drive", report);
    match actuator {
        Some(Actuator::Prescribed) => {
            report.error(
                span,
                "the motor follows the set-point exactly: no drive is to be replaced",
                "give another `motor`",
            );
        }
        Some(Actuator::IdealSource { .. } | Actuator::Off) if by_voltage => {
            report.error(span, "a voltage is for a motor with currents", "connect `effort.motor`");
        }
        _ => {}
    }
}
