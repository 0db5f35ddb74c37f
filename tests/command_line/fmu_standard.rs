//! FMUs that take the standard at its word (`strict.c`): stop times, discrete signals between different steps, inputs of the
//! initialization, ends, and what becomes of one that misbehaves before the first tick or after the last.
use crate::{SLIDE, code, command, json, said};
use serde_json::Value;
use servobench_trace::Recording;
use std::fs::{self, File};
use std::io::Write as _;
use std::path::Path;
use std::process::{Command, Output};
use std::sync::OnceLock;
use tempfile::TempDir;
use zip::ZipWriter;
use zip::write::SimpleFileOptions;

pub(crate) const DESCRIPTION: &str = r#"<?xml version="1.0"?>
<fmiModelDescription fmiVersion="2.0" modelName="strict" guid="{s}" variableNamingConvention="flat">
<CoSimulation modelIdentifier="strict" canHandleVariableCommunicationStepSize="true" canGetAndSetFMUstate="true"/>
<UnitDefinitions><Unit name="N"><BaseUnit kg="1" m="1" s="-2"/></Unit></UnitDefinitions>
<TypeDefinitions>
<SimpleType name="Mischief"><Enumeration>
<Item name="none" value="1"/><Item name="crash" value="2"/><Item name="hang" value="3"/><Item name="hoard" value="4"/>
<Item name="fail" value="5"/><Item name="escapes" value="6"/>
</Enumeration></SimpleType>
<SimpleType name="Where"><Enumeration>
<Item name="setup" value="1"/><Item name="enter" value="2"/><Item name="exit" value="3"/><Item name="get" value="4"/>
<Item name="step" value="5"/><Item name="terminate" value="6"/><Item name="free" value="7"/>
</Enumeration></SimpleType>
</TypeDefinitions>
<ModelVariables>
<ScalarVariable name="u" valueReference="0" causality="input"><Real start="0" unit="N"/></ScalarVariable>
<ScalarVariable name="x" valueReference="1" causality="output" initial="calculated"><Real unit="N"/></ScalarVariable>
<ScalarVariable name="y" valueReference="2" causality="output" initial="calculated"><Real unit="N"/></ScalarVariable>
<ScalarVariable name="level" valueReference="3" causality="parameter" variability="fixed"><Real start="0" unit="N"/></ScalarVariable>
<ScalarVariable name="gain" valueReference="4" causality="parameter" variability="fixed"><Real start="0"/></ScalarVariable>
<ScalarVariable name="end" valueReference="5" causality="parameter" variability="fixed"><Real start="0"/></ScalarVariable>
<ScalarVariable name="clock" valueReference="6" causality="local"><Real/></ScalarVariable>
<ScalarVariable name="echo" valueReference="7" causality="output" variability="discrete" initial="calculated"><Real unit="N"/></ScalarVariable>
<ScalarVariable name="mischief" valueReference="0" causality="parameter" variability="fixed"><Enumeration declaredType="Mischief" start="1"/></ScalarVariable>
<ScalarVariable name="where" valueReference="1" causality="parameter" variability="fixed"><Enumeration declaredType="Where" start="5"/></ScalarVariable>
<ScalarVariable name="n" valueReference="2" causality="input" variability="discrete"><Integer start="0"/></ScalarVariable>
<ScalarVariable name="count" valueReference="3" causality="output" variability="discrete" initial="calculated"><Integer/></ScalarVariable>
<ScalarVariable name="flag" valueReference="0" causality="input" variability="discrete"><Boolean start="false"/></ScalarVariable>
<ScalarVariable name="odd" valueReference="1" causality="output" variability="discrete" initial="calculated"><Boolean/></ScalarVariable>
</ModelVariables>
<ModelStructure>
<Outputs><Unknown index="2" dependencies=""/><Unknown index="3" dependencies="1"/><Unknown index="8" dependencies=""/>
<Unknown index="12" dependencies=""/><Unknown index="14" dependencies=""/></Outputs>
<InitialUnknowns><Unknown index="2" dependencies="1"/><Unknown index="3" dependencies="1 4 5"/><Unknown index="8" dependencies=""/>
<Unknown index="12" dependencies=""/><Unknown index="14" dependencies=""/></InitialUnknowns>
</ModelStructure>
</fmiModelDescription>"#;

/// Official FMUs have a file twice: the run says so and goes on.
#[test]
fn identical_duplicates_are_a_warning_of_the_run() {
    let work = work(&[("twice", format!("{SLIDE}{}", fmu("strict", "outputs = { x = \"disturbance.load\" }")))]);
    let path = work.path().join("strict.fmu");
    let mut zip = ZipWriter::new(File::create(&path).unwrap());
    for (name, content) in [
        ("modelDescription.xml", DESCRIPTION.as_bytes()),
        ("binaries/linux64/strict.so", library()),
        ("resources/table.txt", b"1 2 3"),
        ("resources/tablE.txt", b"1 2 3"),
    ] {
        zip.start_file(name, SimpleFileOptions::default()).unwrap();
        zip.write_all(content).unwrap();
    }
    zip.finish().unwrap();
    let mut bytes = fs::read(&path).unwrap();
    let name = b"resources/tablE.txt";
    for at in 0..bytes.len() - name.len() {
        if bytes[at..].starts_with(name) {
            bytes[at..at + name.len()].copy_from_slice(b"resources/table.txt");
        }
    }
    fs::write(&path, bytes).unwrap();
    let (output, results) = run(&work);
    assert_eq!(code(&output), 0, "{}", said(&output));
    let warning = "\"warning\": `resources/table.txt` is in the archive 2 times, always with the same bytes";
    let said_by_it = log(of(&results, "twice"));
    assert!(said_by_it.iter().any(|line| line == warning), "{said_by_it:?}");
    let info = command(&["fmu", "info"]).arg(&path).output().unwrap();
    assert!(code(&info) == 0 && said(&info).contains("is in the archive 2 times"), "{}", said(&info));
}

/// The compiled library, once for all tests of this process.
fn library() -> &'static [u8] {
    static LIBRARY: OnceLock<Vec<u8>> = OnceLock::new();
    LIBRARY.get_or_init(|| {
        let folder = tempfile::tempdir().unwrap();
        let library = folder.path().join("strict.so");
        let source = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../tests/command_line/strict.c");
        let compiled = Command::new("cc").args(["-O1", "-shared", "-fPIC", "-o"]).arg(&library).arg(source).status();
        assert!(compiled.unwrap().success(), "the C compiler that the workspace is built with anyway");
        fs::read(library).unwrap()
    })
}

/// A folder with `strict.fmu` and scenarios by name.
pub(crate) fn work(scenarios: &[(&str, String)]) -> TempDir {
    let work = tempfile::tempdir().unwrap();
    let mut zip = ZipWriter::new(File::create(work.path().join("strict.fmu")).unwrap());
    for (name, content) in [("modelDescription.xml", DESCRIPTION.as_bytes()), ("binaries/linux64/strict.so", library())]
    {
        zip.start_file(name, SimpleFileOptions::default()).unwrap();
        zip.write_all(content).unwrap();
    }
    zip.finish().unwrap();
    for (name, text) in scenarios {
        fs::write(work.path().join(format!("{name}.toml")), text).unwrap();
    }
    work
}

/// An FMU of this name with these keys.
pub(crate) fn fmu(name: &str, keys: &str) -> String {
    format!("[[fmu]]\nname = \"{name}\"\nfile = \"strict.fmu\"\n{keys}\n")
}

/// The results of a run of all scenarios in `work`.
fn run(work: &TempDir) -> (Output, Value) {
    let (folder, out) = (work.path(), work.path().join("out"));
    let junit = folder.join("junit.xml");
    let output = command(&["run", "--allow-unisolated-fmus"])
        .args([folder, "--out".as_ref(), &out, "--junit".as_ref(), &junit])
        .output()
        .unwrap();
    let results =
        json(&fs::read(out.join("results.json")).unwrap_or_else(|error| panic!("{error}: {}", said(&output))));
    (output, results)
}

fn of<'a>(results: &'a Value, name: &str) -> &'a Value {
    let all = results["scenarios"].as_array().unwrap();
    all.iter().find(|run| run["name"] == name).unwrap_or_else(|| panic!("{name} in {results}"))
}

/// It came to its end; whether the axis arrives beside such a force is another matter.
fn assert_whole(run: &Value) {
    assert!(["passed", "unjudged", "failed"].contains(&run["verdict"].as_str().unwrap()), "{run}");
    assert_eq!(run["duration"], 0.4, "{run}");
}

/// What a run has recorded of the disturbance of the load.
fn force(work: &TempDir, results: &Value, name: &str) -> Vec<f64> {
    let run = of(results, name);
    assert_whole(run);
    let path = work.path().join("out").join(run["recording"].as_str().unwrap());
    Recording::read_parquet(path).unwrap().channel("disturbance.load").unwrap().to_vec()
}

/// All that FMUs have said in a run.
fn log(run: &Value) -> Vec<String> {
    let events = run["log"].as_array().into_iter().flatten();
    events.map(|event| format!("{}: {}", event["severity"], event["text"].as_str().unwrap_or_default())).collect()
}

/// The run has 1600 ticks, which neither 7 nor 14 ticks divide: the last step of the FMU ends at tick 1610, and it is told so. With
/// steps of a tick it ends with the run.
#[test]
fn no_step_goes_beyond_the_stop_time_that_was_told() {
    let keys = |step: &str| fmu("strict", &format!("{step}outputs = {{ x = \"disturbance.load\" }}"));
    let coupling = |method: &str| format!("[coupling]\nstep = \"1.75 ms\"\nmethod = \"{method}\"\n");
    let mut scenarios = vec![("each-tick", format!("{SLIDE}{}", keys("")))];
    for method in ["jacobi", "gauss-seidel", "iterated"] {
        scenarios.push((method, format!("{SLIDE}{}{}", keys("step = \"3.5 ms\"\n"), coupling(method))));
    }
    let work = work(&scenarios);
    let (output, results) = run(&work);
    assert!([0, 4].contains(&code(&output)), "{}", said(&output));
    for (name, stop) in [("each-tick", 0.4), ("jacobi", 0.4025), ("gauss-seidel", 0.4025), ("iterated", 0.4025)] {
        let said = log(of(&results, name));
        let told = said.iter().find_map(|line| line.split_once("the stop time is ")?.1.strip_suffix(" s"));
        let told: f64 = told.unwrap_or_else(|| panic!("{name}: {said:?}")).parse().unwrap();
        // A sum of two times is a rounding away from the third.
        assert!((told - stop).abs() < 1e-15, "{name}: {told}");
        assert_eq!(of(&results, name)["duration"], 0.4, "{name}");
    }
}

/// Oracle: by hand. `slow` counts its steps of 4 ticks, `fast` has a tick and is given the number and whether it is odd; its sum goes
/// to the axis, a tick later. Drawn as lines the numbers would be broken, which no integer takes.
#[test]
fn discrete_outputs_are_held_between_different_steps() {
    let slow = fmu("slow", "step = \"1 ms\"");
    let fast =
        fmu("fast", "inputs = { n = \"slow.count\", flag = \"slow.odd\" }\noutputs = { echo = \"disturbance.load\" }");
    let mut scenarios = Vec::new();
    for method in ["jacobi", "gauss-seidel", "iterated"] {
        for order in 0..3 {
            let coupling = format!("[coupling]\nmethod = \"{method}\"\nextrapolation = {order}\n");
            scenarios.push((format!("{method}-{order}"), format!("{SLIDE}{slow}{fast}{coupling}")));
        }
    }
    // The one that is given comes first in the file, and so in the sequence.
    scenarios.push(("turned".to_owned(), format!("{SLIDE}{fast}{slow}")));
    let scenarios: Vec<_> = scenarios.iter().map(|(name, text)| (name.as_str(), text.clone())).collect();
    let work = work(&scenarios);
    let (output, results) = run(&work);
    assert!([0, 4].contains(&code(&output)), "{}", said(&output));
    for (name, _) in &scenarios {
        // An orderly end is no crash, however late it is looked at.
        let said = log(of(&results, name));
        assert!(said.iter().all(|line| !line.starts_with("\"warning\"")), "{name}: {said:?}");
        let force = force(&work, &results, name);
        for (tick, force) in force.iter().enumerate().skip(1).take(1599) {
            let count = (tick - 1) / 4;
            let expected = 10.0 * count as f64 + f64::from(u8::from(count % 2 == 1));
            assert_eq!(force.to_bits(), expected.to_bits(), "{name} at tick {tick}: {force}, not {expected}");
        }
    }
}

/// x(0) = u(0) through a wire, through two wires, and in a ring whose gain of -1.5 no plain iteration bears.
/// Oracle: y_a = 4 + y_b/2 and y_b = 1 - 3·y_a have y_a = 1.8 and y_b = -4.4.
#[test]
fn wired_inputs_are_there_in_the_initialization() {
    let source = fmu("source", "parameters = { level = \"7 N\" }");
    let to_axis = "outputs = { x = \"disturbance.load\" }";
    let wire = fmu("follower", &format!("inputs = {{ u = \"source.y\" }}\n{to_axis}"));
    let second = fmu("second", &format!("inputs = {{ u = \"first.x\" }}\n{to_axis}"));
    let first = fmu("first", "inputs = { u = \"source.y\" }");
    let a = fmu("a", "parameters = { level = 4, gain = 0.5 }\ninputs = { u = \"b.y\" }");
    let b = fmu("b", "parameters = { level = 1, gain = -3 }\ninputs = { u = \"a.y\" }");
    let ring = fmu("ring", &format!("inputs = {{ u = \"b.y\" }}\n{to_axis}"));
    let work = work(&[
        ("one", format!("{SLIDE}{source}{wire}")),
        ("two", format!("{SLIDE}{second}{first}{source}")),
        ("ring", format!("{SLIDE}{ring}{a}{b}")),
    ]);
    let (output, results) = run(&work);
    assert!([0, 4].contains(&code(&output)), "{}", said(&output));
    for (name, expected) in [("one", 7.0), ("two", 7.0), ("ring", -4.4)] {
        let force = force(&work, &results, name);
        assert!(force.iter().all(|force| (force - expected).abs() < 1e-8), "{name}: {:?}", &force[..3]);
    }
}

/// The slide with one of these FMUs, which ends at `end` (s).
fn ends_at(end: f64, keys: &str) -> String {
    let outputs = "outputs = { x = \"disturbance.load\" }";
    format!("{SLIDE}{}", fmu("strict", &format!("parameters = {{ end = {end} }}\n{outputs}\n{keys}")))
}

#[test]
fn one_that_ends_with_the_run_has_not_ended_it() {
    let work = work(&[
        ("with-the-run", ends_at(0.4, "")),
        ("in-the-last-step", ends_at(0.401, "step = \"3.5 ms\"")),
        ("a-tick-before", ends_at(0.4 - 0.25e-3, "")),
    ]);
    let (output, results) = run(&work);
    assert_eq!(code(&output), 3, "{}", said(&output));
    for name in ["with-the-run", "in-the-last-step"] {
        assert_whole(of(&results, name));
    }
    let run = of(&results, "a-tick-before");
    let reason = run["reasons"][0].as_str().unwrap();
    assert!(run["verdict"] == "error" && reason.contains("`strict` ended the simulation"), "{run}");
}

/// An FMU that does `mischief` in the function `where`.
pub(crate) fn mischief(name: &str, mischief: &str, place: &str, keys: &str) -> String {
    let outputs = "outputs = { x = \"disturbance.load\" }";
    let parameters = format!("parameters = {{ mischief = \"{mischief}\", where = \"{place}\" }}");
    format!("{SLIDE}{}", fmu(name, &format!("{parameters}\n{outputs}\n{keys}")))
}

pub(crate) const PATIENT: &str = "call_timeout = \"2 min\"";
/// For what hangs for good.
const IMPATIENT: &str = "call_timeout = \"3 s\"";
const SMALL: &str = "call_timeout = \"2 min\"\nmemory = 300";

/// Nobody's input is wrong where an FMU crashes, hangs or takes all memory before the first tick: such a run was not carried out, and
/// the call is named. What an FMU refuses by a status is.
#[test]
fn before_the_first_tick_the_run_is_to_blame_and_the_call_is_named() {
    let crash = "signal 6 (SIGABRT";
    let cases = [
        ("a", mischief("crashes", "none", "step", PATIENT), "in fmi2Instantiate at 0 s: signal 6 (SIGABRT"),
        ("b", mischief("hangs", "none", "step", IMPATIENT), "did not come back from fmi2Instantiate at 0 s"),
        ("c", mischief("hoards", "none", "step", SMALL), "in fmi2Instantiate at 0 s: it asked for more memory"),
        ("e", mischief("m", "crash", "enter", PATIENT), "in fmi2EnterInitializationMode at 0 s: signal 6"),
        ("f", mischief("m", "hang", "exit", IMPATIENT), "did not come back from fmi2ExitInitializationMode at 0 s"),
        ("g", mischief("m", "crash", "exit", PATIENT), "in fmi2ExitInitializationMode at 0 s: signal 6"),
        ("h", mischief("m", "crash", "get", PATIENT), "in fmi2GetReal at 0 s: signal 6"),
        ("i", mischief("m", "hoard", "get", SMALL), "in fmi2GetReal at 0 s: it asked for more memory"),
        (
            "j",
            mischief("m", "fail", "get", PATIENT),
            "failed in fmi2GetReal at 0 s (fmi2Error): the table has no such row",
        ),
    ];
    let scenarios: Vec<_> = cases.iter().map(|(name, text, _)| (*name, text.clone())).collect();
    let folder = work(&scenarios);
    let (output, results) = run(&folder);
    assert_eq!(code(&output), 3, "{}", said(&output));
    for (name, _, says) in &cases {
        let run = of(&results, name);
        let reason = run["reasons"][0].as_str().unwrap_or_default();
        assert!(run["verdict"] == "error" && reason.contains(says), "{name}: {run}");
        assert!(!says.contains(crash) || reason.contains("its last words: strict: no such table"), "{name}: {reason}");
    }
    // `check` opens FMUs too, where it may.
    for name in ["a", "e", "h"] {
        let scenario = folder.path().join(format!("{name}.toml"));
        let output = command(&["check", "--load-fmus"]).arg(scenario).output().unwrap();
        assert_eq!(code(&output), 3, "{name}: {}", said(&output));
        assert!(said(&output).contains("signal 6"), "{}", said(&output));
    }
    let refused = work(&[("refused", mischief("m", "fail", "enter", PATIENT))]);
    let output = command(&["run"]).arg(refused.path().join("refused.toml")).output().unwrap();
    assert_eq!(code(&output), 2, "{}", said(&output));
}

/// The results are complete by then.
#[test]
fn what_goes_wrong_at_the_end_is_a_warning() {
    let cases = [
        ("a", mischief("m", "crash", "terminate", PATIENT), "in fmi2Terminate at 0.4 s: signal 6"),
        ("b", mischief("m", "crash", "free", PATIENT), "in fmi2FreeInstance at 0.4 s: signal 6"),
        ("c", mischief("m", "hang", "terminate", IMPATIENT), "did not come back from fmi2Terminate at 0.4 s"),
        ("d", mischief("m", "fail", "terminate", PATIENT), "fmi2Terminate returned fmi2Error"),
        ("e", mischief("m", "fail", "terminate", "isolation = \"none\""), "fmi2Terminate returned fmi2Error"),
    ];
    let scenarios: Vec<_> = cases.iter().map(|(name, text, _)| (*name, text.clone())).collect();
    let work = work(&scenarios);
    let (output, results) = run(&work);
    assert!([0, 4].contains(&code(&output)), "{}", said(&output));
    for (name, _, says) in &cases {
        let run = of(&results, name);
        assert_whole(run);
        let said = log(run);
        let warning = said.iter().find(|line| line.contains(says));
        let warning = warning.unwrap_or_else(|| panic!("{name}: {said:?}"));
        assert!(warning.starts_with("\"warning\""), "{warning}");
        let words = if says.contains("signal") { "its last words: strict: no such table" } else { says };
        assert!(warning.contains(words), "{warning}");
        assert!(!says.contains("fmi2Error") || said.iter().any(|line| line.contains("no such row")), "{said:?}");
    }
}

/// What an FMU says goes to terminals and into XML: no control character, and nothing that XML 1.0 has no place for (§2.2).
#[test]
fn what_an_fmu_says_is_clean_wherever_it_is_shown() {
    let work = work(&[
        ("beside", mischief("m", "escapes", "step", PATIENT)),
        ("before", mischief("m", "escapes", "get", PATIENT)),
    ]);
    let (output, results) = run(&work);
    assert_eq!(code(&output), 3, "{}", said(&output));
    let is_clean = |text: &str| !text.chars().any(|c| (c.is_control() && c != '\n') || "\u{fffe}\u{ffff}".contains(c));
    assert!(is_clean(&said(&output)), "{:?}", said(&output));
    for name in ["beside", "before"] {
        let reason = of(&results, name)["reasons"][0].as_str().unwrap();
        // A program gets it as it was said.
        assert!(reason.contains("\u{1b}[31mred\u{1b}[0m") && reason.contains('8'), "{reason:?}");
    }
    let junit = fs::read_to_string(work.path().join("junit.xml")).unwrap();
    assert!(is_clean(&junit), "{junit:?}");
    let references = junit.split("&#").skip(1).filter_map(|rest| rest.split_once(';'));
    let numbers = references
        .map(|(number, _)| number.strip_prefix('x').map_or(number.parse(), |hex| u32::from_str_radix(hex, 16)));
    assert!(
        numbers.into_iter().all(|number| !matches!(number, Ok(0..9 | 11..32 | 127..160 | 0xfffe | 0xffff))),
        "{junit}"
    );
    assert!(junit.contains("red"), "{junit}");
}

/// Ctrl-C is SIGINT; SIGTERM is what a runner of continuous integration sends. The FMU hangs, in a step or before the first one.
#[cfg(unix)]
#[test]
fn an_interrupted_program_leaves_nothing_unpacked() {
    let patient = "call_timeout = \"10 min\"";
    let folder =
        work(&[("step", mischief("m", "hang", "step", patient)), ("enter", mischief("m", "hang", "enter", patient))]);
    for (program, scenario, signal) in
        [("run", "step", "INT"), ("run", "step", "TERM"), ("run", "enter", "TERM"), ("check", "enter", "INT")]
    {
        let temporary = tempfile::tempdir().unwrap();
        let mut command = command(&[program]);
        if program == "check" {
            command.arg("--load-fmus");
        }
        command.arg(folder.path().join(format!("{scenario}.toml"))).env("TMPDIR", temporary.path());
        if program == "run" {
            command.arg("--out").arg(folder.path().join("interrupted"));
        }
        let mut child = command.spawn().unwrap();
        let unpacked = || {
            let all = fs::read_dir(temporary.path()).unwrap().map(|entry| entry.unwrap().path());
            all.filter(|path| path.join("binaries/linux64/strict.so").is_file()).count()
        };
        let call_timeout = std::time::Instant::now() + std::time::Duration::from_mins(1);
        while unpacked() == 0 {
            assert!(std::time::Instant::now() < call_timeout, "nothing is unpacked");
            std::thread::sleep(std::time::Duration::from_millis(5));
        }
        // A suite comes to the end of what is under way on the first SIGINT.
        for k in 0..if (program, signal) == ("run", "INT") { 2 } else { 1 } {
            // Two of one kind that wait at once are one (signal(7)).
            std::thread::sleep(std::time::Duration::from_millis(100 * k));
            let sent = Command::new("kill").args([&format!("-{signal}"), &child.id().to_string()]).status().unwrap();
            assert!(sent.success());
        }
        let status = child.wait().unwrap();
        let number = std::os::unix::process::ExitStatusExt::signal(&status);
        assert_eq!(number, Some(if signal == "INT" { 2 } else { 15 }), "{program} {scenario}: {status}");
        let left: Vec<_> = fs::read_dir(temporary.path()).unwrap().map(|entry| entry.unwrap().file_name()).collect();
        assert_eq!(left, [""; 0], "{program} {scenario} after {signal}");
    }
}

/// Nobody writes to the FIFO: `info` would wait for ever.
#[cfg(unix)]
#[test]
fn info_does_not_wait_for_a_fifo() {
    let folder = tempfile::tempdir().unwrap();
    let fifo = folder.path().join("fifo.fmu");
    assert!(Command::new("mkfifo").arg(&fifo).status().unwrap().success());
    let output = command(&["fmu", "info"]).arg(&fifo).output().unwrap();
    assert_eq!(code(&output), 2, "{}", said(&output));
    assert!(said(&output).contains("it is a FIFO, and no file"), "{}", said(&output));
}

#[test]
fn a_unit_that_nobody_knows_is_said_to_be_unknown() {
    let scenario = |level: &str| {
        let keys = format!("parameters = {{ level = \"{level}\" }}\noutputs = {{ x = \"disturbance.load\" }}");
        format!("{SLIDE}{}", fmu("strict", &keys))
    };
    let work = work(&[("unknown", scenario("3 furlongs")), ("another", scenario("3 V")), ("none", scenario("three"))]);
    for (name, says) in [
        ("unknown", "\"3 furlongs\": `furlongs` is an unknown unit"),
        ("another", "`level` of the FMU is in `N`, which \"3 V\" cannot be turned into"),
        ("none", "it is a `Float64`, got the text `three`"),
    ] {
        let output = command(&["check"]).arg(work.path().join(format!("{name}.toml"))).output().unwrap();
        assert_eq!(code(&output), 2, "{name}: {}", said(&output));
        let text = said(&output).split_whitespace().collect::<Vec<_>>().join(" ");
        assert!(text.contains(says), "{name}: {text}");
    }
}

/// `fixedInternalStepSize` and the event mode are of FMI 3.0; nothing of the library is called for them.
#[test]
fn a_step_that_is_not_a_multiple_of_the_internal_step_is_a_warning() {
    const THREE: &str = r#"<fmiModelDescription fmiVersion="3.0" modelName="strict" instantiationToken="{s}">
<CoSimulation modelIdentifier="strict" canHandleVariableCommunicationStepSize="true" fixedInternalStepSize="1e-3"/>
<ModelVariables><Float64 name="time" valueReference="0" causality="independent"/>
<Float64 name="x" valueReference="1" causality="output"/></ModelVariables>
<ModelStructure><Output valueReference="1"/></ModelStructure></fmiModelDescription>"#;
    let work = work(&[]);
    let mut zip = ZipWriter::new(File::create(work.path().join("strict.fmu")).unwrap());
    for (name, content) in [("modelDescription.xml", THREE.as_bytes()), ("binaries/x86_64-linux/strict.so", &[])] {
        zip.start_file(name, SimpleFileOptions::default()).unwrap();
        zip.write_all(content).unwrap();
    }
    zip.finish().unwrap();
    let check = |keys: &str, expected: i32| {
        let text = format!("{SLIDE}{}", fmu("strict", &format!("{keys}\noutputs = {{ x = \"disturbance.load\" }}")));
        fs::write(work.path().join("steps.toml"), text).unwrap();
        let output = command(&["check"]).arg(work.path().join("steps.toml")).output().unwrap();
        assert_eq!(code(&output), expected, "{keys}: {}", said(&output));
        said(&output).split_whitespace().collect::<Vec<_>>().join(" ")
    };
    // A tick of 0.25 ms unless given; none of them is whole.
    for keys in ["", "step = \"0.5 ms\"", "step = \"1.5 ms\"", "step = \"2.25 ms\""] {
        let text = check(keys, 0);
        assert!(text.contains("(`fixedInternalStepSize`)") && text.contains("a multiple of 0.001 s"), "{keys}: {text}");
    }
    for keys in ["step = \"1 ms\"", "step = \"3 ms\""] {
        let text = check(keys, 0);
        assert!(!text.contains("fixedInternalStepSize"), "{keys}: {text}");
    }
    let text = check("step = \"1 ms\"\nevent_mode = false", 2);
    assert!(text.contains("no event mode that could be switched off"), "{text}");
}
