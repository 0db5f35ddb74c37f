//! The engine `fmu` with real libraries in C, compiled and packed by the test as a tool would.
mod leaving;
mod oscillator;

use servobench_base::Severity;
use servobench_engine_fmu::{Code, Fmu, FmuMechanics, HostCommand, HostError, host as serve};
use servobench_fmi::{Bounds, FmuFile, Isolation, SiPort, Value};
use servobench_plant::{
    Actuation, Drive, Engine, EngineName, FmuBody, FmuModel, Input, LogMessage, Mechanics, MechanicsError,
    MechanicsSetup, Model,
};
use std::io::Write;
use std::path::{Path, PathBuf};
use std::process::Command;
use std::time::Duration;
use tempfile::TempDir;

/// Base tick (s).
const TICK: f64 = 1e-3;
/// Mass (kg) and force (N).
const MASS: f64 = 20.0;
const FORCE: f64 = 7.0;

const DESCRIPTION: &str = r#"<?xml version="1.0"?>
<fmiModelDescription fmiVersion="2.0" modelName="mass" guid="{m}" variableNamingConvention="flat">
<CoSimulation modelIdentifier="mass" canHandleVariableCommunicationStepSize="true"/>
<UnitDefinitions>
<Unit name="N"><BaseUnit kg="1" m="1" s="-2"/></Unit>
<Unit name="mm"><BaseUnit m="1" factor="0.001"/></Unit>
<Unit name="m/s"><BaseUnit m="1" s="-1"/></Unit>
<Unit name="kg"><BaseUnit kg="1"/></Unit>
</UnitDefinitions>
<ModelVariables>
<ScalarVariable name="force" valueReference="0" causality="input"><Real start="0" unit="N"/></ScalarVariable>
<ScalarVariable name="x" valueReference="1" causality="output" initial="exact"><Real start="0" unit="mm"/></ScalarVariable>
<ScalarVariable name="v" valueReference="2" causality="output"><Real unit="m/s"/></ScalarVariable>
<ScalarVariable name="mass" valueReference="3" causality="parameter" variability="fixed"><Real start="1" unit="kg"/></ScalarVariable>
<ScalarVariable name="mischief" valueReference="0" causality="parameter" variability="fixed"><Integer start="0"/></ScalarVariable>
</ModelVariables>
<ModelStructure><Outputs><Unknown index="2"/><Unknown index="3"/></Outputs>
<InitialUnknowns><Unknown index="3"/></InitialUnknowns></ModelStructure>
</fmiModelDescription>"#;

/// Misbehaviour of the library.
#[derive(Clone, Copy)]
#[repr(u8)]
enum Mischief {
    Nothing,
    Crash,
    Hang,
    Hoard,
    Print,
    Fail,
    NanOutput,
    CrashInStart,
    SayThenCrash,
    Say,
}

/// Not a test: the process that runs an FMU of these tests.
#[test]
#[ignore = "the process that the other tests start"]
fn host() {
    match serve() {
        // A run of all ignored tests.
        Ok(()) | Err(HostError::NoPage) => {}
        Err(error) => panic!("{error}"),
    }
}

const ENGINE: Fmu = Fmu {
    host: || {
        let args = ["--exact", "host", "--ignored", "--nocapture"];
        Ok(HostCommand { program: std::env::current_exe()?, args: args.map(Into::into).to_vec(), env: Vec::new() })
    },
    code: Code::Anywhere,
};

/// The FMU's file, which exists as long as this value.
struct File {
    _folder: TempDir,
    path: PathBuf,
}

impl File {
    fn new() -> Self {
        Self::compiled_with(&[])
    }

    fn compiled_with(options: &[&str]) -> Self {
        let folder = tempfile::tempdir().unwrap();
        let path = packed(folder.path(), "mass", DESCRIPTION, "mass.c", options);
        Self { _folder: folder, path }
    }
}

/// Compiles `source` of this folder and packs it with `description` into the FMU `name` in `folder`.
fn packed(folder: &Path, name: &str, description: &str, source: &str, options: &[&str]) -> PathBuf {
    let library = folder.join(name).with_extension("so");
    let source = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/native").join(source);
    let mut compiler = Command::new("cc");
    compiler.args(["-O2", "-shared", "-fPIC"]).args(options).arg("-o").args([&library, &source]).arg("-lm");
    assert!(compiler.status().unwrap().success(), "the C compiler that the workspace is built with anyway");
    let path = folder.join(name).with_extension("fmu");
    let mut zip = zip::ZipWriter::new(std::fs::File::create(&path).unwrap());
    let stored = zip::write::SimpleFileOptions::default().compression_method(zip::CompressionMethod::Stored);
    let binary = (format!("binaries/linux64/{name}.so"), std::fs::read(&library).unwrap());
    for (name, content) in [("modelDescription.xml".into(), description.as_bytes().to_vec()), binary] {
        zip.start_file(name, stored).unwrap();
        zip.write_all(&content).unwrap();
    }
    zip.finish().unwrap();
    path
}

fn isolated(call_timeout: Duration) -> Isolation {
    Isolation::Process { bounds: Bounds { call_timeout, memory: 300_000_000 } }
}

fn setup(file: &File, mischief: Mischief, isolation: Isolation) -> MechanicsSetup {
    let port = |variable: &str| SiPort { variable: variable.into(), unit: None };
    let model = FmuModel {
        file: FmuFile {
            event_mode: true,
            path: file.path.clone(),
            start: vec![
                ("mass".into(), Value::Number(MASS)),
                ("x".into(), Value::Quantity { text: "0.25 m".into(), si: 0.25, exponents: [0, 1, 0, 0] }),
                ("mischief".into(), Value::Number(f64::from(mischief as u8))),
            ],
            isolation,
        },
        effort: port("force"),
        motor: FmuBody { position: port("x"), velocity: Some(port("v")) },
        load: None,
        motor_disturbance: None,
        load_disturbance: None,
        transmission: 1.0,
        ticks: 1,
    };
    MechanicsSetup { model: Model::Fmu(Box::new(model)), drive: Drive::Effort, step: TICK, initial: Vec::new() }
}

fn build(mischief: Mischief, isolation: Isolation) -> FmuMechanics {
    // The FMU keeps its unpacked files itself.
    ENGINE.mechanics(&setup(&File::new(), mischief, isolation)).unwrap_or_else(|error| panic!("{error}"))
}

fn push() -> Input {
    Input { actuation: Actuation::Effort(FORCE), motor_disturbance: 0.0, load_disturbance: 0.0 }
}

/// Position and velocity of the mass at each tick.
fn way(mut mass: FmuMechanics) -> Vec<(f64, f64)> {
    (0..1000)
        .map(|_| {
            let [body] = *mass.bodies() else { panic!("one body") };
            mass.advance(&push()).unwrap();
            (body.position, body.velocity)
        })
        .collect()
}

/// Oracle: x = x0 + F·t²/2m, v = F·t/m. Tolerance: a thousand additions, each rounded to 2^-53 of at most 0.5.
#[test]
fn a_mass_goes_as_newton_says_here_and_in_a_process_of_its_own() {
    let here = way(build(Mischief::Nothing, Isolation::None));
    let there = way(build(Mischief::Nothing, isolated(Duration::from_mins(1))));
    assert_eq!(here, there, "bit for bit");
    for (k, (x, v)) in here.into_iter().enumerate() {
        let t = k as f64 * TICK;
        assert!((x - 0.25 - FORCE * t * t / (2.0 * MASS)).abs() < 1e-13, "{k}: {x}");
        assert!((v - FORCE * t / MASS).abs() < 1e-13, "{k}: {v}");
    }
}

/// The error of its second step.
fn second_step(mischief: Mischief, call_timeout: Duration) -> MechanicsError {
    let mut mass = build(mischief, isolated(call_timeout));
    mass.advance(&push()).unwrap();
    mass.advance(&push()).unwrap_err()
}

#[test]
fn what_a_library_does_wrong_is_reported_as_what_it_is() {
    let call_timeout = Duration::from_mins(1);
    for (mischief, says) in [
        (Mischief::Crash, "the FMU's process ended at 0.001 s: signal 11 (SIGSEGV"),
        (Mischief::Fail, "the FMU failed in fmi2DoStep at 0.001 s (fmi2Error): the mass is 20 kg"),
        (Mischief::Hoard, "it asked for more memory than the 300 MB that it may have, then signal 11"),
    ] {
        let error = second_step(mischief, call_timeout);
        assert!(matches!(error, MechanicsError::Native { engine: EngineName::Fmu, .. }), "{error}");
        assert!(error.to_string().contains(says), "{error}");
    }
    let error = second_step(Mischief::Hang, Duration::from_secs(1));
    assert!(error.to_string().contains("did not come back from its step at 0.001 s within 1 s"), "{error}");
    let mut mass = build(Mischief::NanOutput, isolated(call_timeout));
    let error = mass.advance(&push()).unwrap_err();
    assert!(matches!(&error, MechanicsError::Native { .. }), "{error}");
    let error = ENGINE.build(&setup(&File::new(), Mischief::CrashInStart, isolated(call_timeout))).err().unwrap();
    assert!(
        error.to_string().contains("the FMU's process ended in fmi2ExitInitializationMode at 0 s: signal 11"),
        "{error}"
    );
}

#[test]
fn one_that_prints_ten_megabytes_in_a_step_goes_on() {
    let mut mass = build(Mischief::Print, isolated(Duration::from_mins(1)));
    for _ in 0..3 {
        mass.advance(&push()).unwrap();
    }
    let log = mass.take_log();
    let printed = log.iter().find(|line| line.text.starts_with("standard output: (")).unwrap();
    assert_eq!(printed.text, "standard output: (20 MB before this were dropped)");
}

/// Its last message in a call that did not return.
#[test]
fn the_last_that_it_said_is_in_the_report() {
    let error = second_step(Mischief::SayThenCrash, Duration::from_mins(1));
    assert!(error.to_string().contains("the mass is 20 kg"), "{error}");
}

/// Isolation makes no difference: a message has its time and can be read after the end.
#[test]
fn what_it_says_is_the_same_here_and_in_a_process_of_its_own() {
    let said = |isolation, mischief| {
        let mut mass = build(mischief, isolation);
        let mut said = mass.take_log();
        for _ in 0..4 {
            // Its end is tested elsewhere.
            let went = mass.advance(&push());
            said.extend(mass.take_log());
            if went.is_err() {
                break;
            }
        }
        // The harness of these tests writes there.
        said.retain(|line| !line.text.starts_with("standard output: "));
        said
    };
    let line = |time: f64, severity, text: String| LogMessage { time, severity, text };
    let steps = [1e-3, 2e-3, 3e-3].map(|time| line(time, Severity::Info, format!("logEvents: at {time} s")));
    let failure = [line(1e-3, Severity::Error, "the mass is 20 kg".into())];
    for isolation in [Isolation::None, isolated(Duration::from_mins(1))] {
        assert_eq!(said(isolation, Mischief::Say), steps);
        assert_eq!(said(isolation, Mischief::Fail), failure);
    }
    let cry = [line(1e-3, Severity::Warning, "the mass is 20 kg".into())];
    assert_eq!(said(isolated(Duration::from_mins(1)), Mischief::SayThenCrash), cry);
}

/// Its unpacked files are removed with it, even if it crashes.
#[test]
fn nothing_stays_in_the_folder_for_temporary_files() {
    let this = std::env::current_exe().unwrap();
    let folder = tempfile::tempdir().unwrap();
    let mut alone = Command::new(this);
    alone.args(["--exact", "crashes_alone", "--ignored", "--nocapture"]).env("TMPDIR", folder.path());
    let output = alone.output().unwrap();
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stdout));
    let left: Vec<_> = std::fs::read_dir(folder.path()).unwrap().map(|entry| entry.unwrap().file_name()).collect();
    assert_eq!(left, [""; 0]);
}

/// Not a test: the process that the test above starts.
#[test]
#[ignore = "the process that another test starts"]
fn crashes_alone() {
    for mischief in [Mischief::Nothing, Mischief::Crash] {
        let mut mass = build(mischief, isolated(Duration::from_mins(1)));
        mass.advance(&push()).unwrap();
        // Its end is tested elsewhere.
        mass.advance(&push()).ok();
    }
}

#[test]
fn what_the_engine_cannot_do_is_refused() {
    let says = |setup: &MechanicsSetup| ENGINE.build(setup).err().unwrap().to_string();
    let file = File::new();
    let good = setup(&file, Mischief::Nothing, Isolation::None);
    let prescribed = MechanicsSetup { drive: Drive::Prescribed, ..good.clone() };
    assert!(says(&prescribed).contains("does not support a prescribed motion"));
    let Model::Fmu(model) = &good.model else { panic!("an FMU") };
    let with = |model: FmuModel| MechanicsSetup { model: Model::Fmu(Box::new(model)), ..good.clone() };
    assert!(says(&with(FmuModel { ticks: 0, ..FmuModel::clone(model) })).contains("`ticks`"));
    let of = |file: FmuFile| with(FmuModel { file, ..FmuModel::clone(model) });
    assert!(says(&of(FmuFile { path: "none.fmu".into(), ..model.file.clone() })).contains("none.fmu"));
    let starts = vec![("mas".into(), Value::Number(1.0)), ("mass".into(), Value::Text("heavy".into()))];
    let said = says(&of(FmuFile { start: starts, ..model.file.clone() }));
    assert!(said.contains("is it `mass`?") && said.contains("heavy"), "{said}");
    let began = MechanicsSetup { initial: vec![servobench_plant::BodyState::default()], ..good.clone() };
    assert!(says(&began).contains("start values of the FMU"));
}
