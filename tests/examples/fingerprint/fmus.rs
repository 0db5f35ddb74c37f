//! What is in exported FMUs, and what they put out.
use crate::{call, hash, repository, said};
use servobench_fmi::{Causality, DataType, Loaded, Port, Setup, Slave, Unpacked, Values, Variable};
use std::fmt::Write as _;
use std::fs::File;
use std::io::Read as _;
use std::path::Path;
use zip::ZipArchive;

const SCENARIOS: [&str; 5] =
    ["demo/snap.toml", "two-mass.toml", "linear-stage-move.toml", "feed-axis-stick-slip.toml", "plc/figure-3a.toml"];

/// Steps, and the length of each (s).
const STEPS: u32 = 500;
const STEP: f64 = 1e-3;

pub(crate) struct Export {
    scenario: &'static str,
    part: &'static str,
    version: &'static str,
}

/// Everything that is exported.
pub(crate) fn exports() -> Vec<Export> {
    let mut all = Vec::new();
    for scenario in SCENARIOS {
        for part in ["axis", "drive", "mechanics"] {
            all.extend(["2", "3"].map(|version| Export { scenario, part, version }));
        }
    }
    all
}

impl Export {
    pub(crate) fn fingerprint(&self, program: &Path) -> String {
        let Self { scenario, part, version } = self;
        let work = tempfile::tempdir().unwrap();
        let file = work.path().join("exported.fmu");
        let path = format!("scenarios/{scenario}");
        let arguments = ["fmu", "export", &path, "--part", part, "--fmi", version, "-o", &file.to_string_lossy()];
        let output = call(program, &repository(), &arguments);
        let mut lines = format!("== {scenario}, {part}, FMI {version}: {}\n", output.status);
        if output.status.success() {
            lines += &contents(&file);
            lines += &outputs(&file);
        } else {
            lines += &said(&output);
        }
        lines
    }
}

/// A line for each file but the libraries.
fn contents(file: &Path) -> String {
    let mut zip = ZipArchive::new(File::open(file).unwrap()).unwrap();
    let mut lines = String::new();
    for index in 0..zip.len() {
        let mut entry = zip.by_index(index).unwrap();
        let name = entry.name().unwrap().into_owned();
        if !name.starts_with("binaries/") {
            let mut content = Vec::new();
            entry.read_to_end(&mut content).unwrap();
            writeln!(lines, "  {name}: {:016x}", hash::of_bytes(content)).unwrap();
        }
    }
    lines
}

/// What it puts out while its inputs swing.
fn outputs(file: &Path) -> String {
    let unpacked = Unpacked::new(file).unwrap();
    let variables = |causality: Causality| -> Vec<&Variable> {
        let all = unpacked.description().variables.iter();
        all.filter(|variable| variable.causality == causality && is_number(variable)).collect()
    };
    let ports = |causality: Causality| -> Vec<Port> {
        variables(causality).into_iter().map(|one| Port { variable: one.name.clone(), element: 0 }).collect()
    };
    let inputs = variables(Causality::Input);
    let setup = Setup { inputs: ports(Causality::Input), outputs: ports(Causality::Output), ..Setup::default() };
    let mut fmu = match Loaded::new(&unpacked, &setup) {
        Ok(fmu) => fmu,
        Err(error) => return format!("  {error}\n"),
    };
    let mut series = vec![Vec::new(); setup.outputs.len()];
    let mut values = vec![0.0; setup.outputs.len()];
    for step in 0..STEPS {
        let time = f64::from(step) * STEP;
        // Each input at a frequency of its own, so that none hides another.
        let swing = |(index, input): (usize, &&Variable)| {
            let swing = (time * 10.0 * (index + 1) as f64).sin();
            let value = match &input.start {
                Some(Values::Float(start)) => start[0] + 1e-3 * swing,
                _ => f64::from(u8::from(swing > 0.5)),
            };
            [value, 0.0, 0.0]
        };
        let inputs: Vec<[f64; 3]> = inputs.iter().enumerate().map(swing).collect();
        if let Err(error) = fmu.step(time, STEP, &inputs).and_then(|_| fmu.read(None, &mut values)) {
            return format!("  step {step}: {error}\n");
        }
        for (series, value) in series.iter_mut().zip(&values) {
            series.push(*value);
        }
    }
    let line = |(port, series): (&Port, &Vec<f64>)| format!("  {}: {:016x}\n", port.variable, hash::of_numbers(series));
    setup.outputs.iter().zip(&series).map(line).collect()
}

/// Whether it can be exchanged as a number.
fn is_number(variable: &Variable) -> bool {
    variable.data_type.is_float() || variable.data_type.integers().is_some() || variable.data_type == DataType::Boolean
}
