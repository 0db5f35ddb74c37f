//! `[axis.fmu]` and `[[fmu]]`: the files, their connections and the exchange period.
mod mechanics;
mod sensors;

pub(super) use mechanics::{Mechanics, mechanics};

use crate::access::Refused;
use crate::axis_name::{suggestion_on, within};
use crate::diagnostic::Report;
use crate::field::Slot;
use crate::file::{self, File};
use crate::name_table::Named;
use crate::resolve::{refuse, whole};
use crate::scenario::{Actuator, Fmu, InputSource, LoopSignal};
use crate::source::{At, Place, Sources, Span};
use servobench_base::Rate;
use servobench_coupling::Settings;
use servobench_files::FileRole;
use servobench_fmu_file::{Bounds, FmuFile, Isolation, IsolationKind};
use servobench_signals::Signal;
use std::path::{Path, PathBuf};
use std::time::Duration;

/// Default time limit of a call of an FMU (s).
const CALL_TIMEOUT: f64 = 10.0;
/// Default memory limit of its process (MB).
const MEMORY: u32 = 2048;

/// Signals that an output of an FMU can provide.
trait Port: Copy + PartialEq + 'static {
    /// All signals.
    fn all() -> impl Iterator<Item = Self> + Clone;

    /// The name in files.
    fn name(self) -> &'static str;
}

impl Port for LoopSignal {
    fn all() -> impl Iterator<Item = Self> + Clone {
        Self::ALL.iter().copied()
    }

    fn name(self) -> &'static str {
        self.signal().name()
    }
}

/// Sources of the files, and the base rate.
#[derive(Clone, Copy)]
pub(super) struct Known<'a> {
    pub(super) base_rate: Option<Rate>,
    pub(super) sources: &'a Sources,
    pub(super) actuator: Option<&'a Actuator>,
}

/// The FMUs beside the axis.
pub(super) fn others(
    file: &File,
    coupling: Option<&Settings>,
    known: Known<'_>,
    report: &mut Report,
) -> Option<Vec<Fmu>> {
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
        let every = coupling.map_or(1, |coupling| coupling.step.ticks());
        let offered: Vec<&str> = Signal::ALL
            .iter()
            .map(|signal| signal.name())
            .chain(["shaft.position", "shaft.velocity", "time"])
            .collect();
        let fmu = fmu(&one.value, every, known, report, &signals, &offered);
        let excites = one.value.excites.optional().ok().map(|excites| excites.copied().unwrap_or_default());
        let fmu = fmu.zip(excites).map(|((fmu, outputs), excites)| Fmu { outputs, excites, ..fmu });
        if let (Some(fmu), Some(span)) = (&fmu, one.value.excites.span())
            && fmu.efforts().next().is_none()
        {
            let message = "`excites` is for an FMU that gives an effort";
            report.error(
                span,
                message,
                "connect an output to `disturbance.motor` or `disturbance.load`, or leave it out",
            );
        }
        all.push(fmu);
    }
    let all: Vec<_> = all.into_iter().collect::<Option<_>>()?;
    check_ports(file, given, &all, known, report);
    Some(all)
}

/// An FMU without its outputs, and the outputs, whose signals are of type `P`.
fn fmu<P: Port>(
    given: &file::Fmu,
    every: u32,
    known: Known<'_>,
    report: &mut Report,
    signal: &dyn Fn(&str) -> Option<InputSource>,
    signals: &[&str],
) -> Option<(Fmu, Vec<(String, P)>)> {
    let path = path(&given.file, known.sources, report);
    let every = match &given.step {
        Slot::Absent => Some(every),
        Slot::Wrong(_) => None,
        Slot::Given(at) => whole::ticks("step", *at, known.base_rate, report).and_then(|ticks| {
            if ticks.is_multiple_of(every) {
                return Some(ticks);
            }
            let message = format!("`step` is {ticks} base ticks, not a whole number of steps of `[coupling]`, {every}");
            report.error(at.span, message, "");
            None
        }),
    };
    let isolation = given.isolation.optional().ok().map(|isolation| isolation.copied().unwrap_or_default());
    if isolation == Some(IsolationKind::None) {
        let keys = [("call_timeout", given.call_timeout.span()), ("memory", given.memory.span())];
        refuse(&keys, "is for an FMU in a separate process", "leave `isolation` out", report);
    }
    let axis = report.axis_name;
    let read =
        |text: &str| signal(within(text, axis)).ok_or_else(|| suggestion_on(text, axis, signals.iter().copied()));
    let inputs = given
        .inputs
        .optional()
        .ok()
        .and_then(|table| connections(table.map_or(&[][..], |table| &table.0), "not a signal", report, read));
    let outputs = given.outputs.optional().ok().and_then(|table| {
        let port = |text: &str| {
            let found = P::all().find(|port| port.name() == within(text, axis));
            found.ok_or_else(|| suggestion_on(text, axis, P::all().map(Port::name)))
        };
        connections(table.map_or(&[][..], |table| &table.0), "not an output that an FMU can have here", report, port)
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
    let call_timeout = given.call_timeout.optional().ok()?.copied().unwrap_or(CALL_TIMEOUT);
    let memory = given.memory.optional().ok()?.copied().unwrap_or(MEMORY);
    let file = FmuFile {
        path: path?,
        start,
        isolation: match isolation? {
            IsolationKind::None => Isolation::None,
            IsolationKind::Process => Isolation::Process {
                bounds: Bounds {
                    call_timeout: Duration::try_from_secs_f64(call_timeout).unwrap_or(Duration::MAX),
                    memory: u64::from(memory) * 1_000_000,
                },
            },
        },
        event_mode: given.event_mode.optional().ok()?.copied().unwrap_or(true),
    };
    Some((
        Fmu { name: name(given), file, every: every?, inputs: inputs?, outputs: Vec::new(), excites: false },
        outputs,
    ))
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

/// A signal of the axis, or the output of an FMU.
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
    } else if report.axis_name.is_some_and(|axis| axis.as_str() == name) {
        report.error(span, format!("an FMU and the axis are called `{name}`"), "give each its own `name`");
    } else if name.is_empty() || name.contains('.') || is_of_signals || name == "time" || name == "shaft" {
        let message = format!("`{name}` cannot name an FMU");
        report.error(
            span,
            message,
            "signals are called `name.variable`: give a `name` without a point that does not begin the name of a channel",
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
    match report.files.look_through(&path, FileRole::Fmu) {
        Ok(()) => Some(path),
        Err(Refused { message, help }) => {
            report.error(file.span, message, help);
            None
        }
    }
}

/// Checks the outputs of all FMUs to the loop together.
fn check_ports(file: &File, given: &[At<file::Fmu>], all: &[Fmu], known: Known<'_>, report: &mut Report) {
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
                    "efforts are not added here: let one FMU sum them",
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
            report.error(span, "the duration of the set-point of an FMU is unknown", "give `duration` in `[run]`");
        }
    } else if let Some(span) = of(LoopSignal::SetpointVelocity).or(of(LoopSignal::SetpointAcceleration)) {
        report.error(span, "a set-point needs a position", "connect `setpoint.position` too");
    }
    let (d, q, effort) = (of(LoopSignal::VoltageD), of(LoopSignal::VoltageQ), of(LoopSignal::Effort));
    if let (Some(span), None) | (None, Some(span)) = (d, q) {
        report.error(span, "a voltage needs both parts", "connect `voltage.d` and `voltage.q`");
    }
    if let (Some(span), Some(_)) = (d.or(q), effort) {
        report.error(span, "`effort.motor` replaces drive and motor, a voltage the drive alone", "connect one of them");
    }
    if let Some(span) = d.or(q).or(effort) {
        controller(file, d.is_some(), span, known.actuator, report);
        sensors::check(file, all, d.is_some(), report);
    }
}

/// Checks an FMU that replaces the drive.
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
        Some(Actuator::IdealSource { .. } | Actuator::Off(_)) if by_voltage => {
            report.error(span, "a voltage is for a motor with currents", "connect `effort.motor`");
        }
        _ => {}
    }
}
