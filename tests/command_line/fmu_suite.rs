//! Suites in which FMUs misbehave: each costs its own run, and is reported as what it is.
use crate::attached::make_fmu;
use crate::{SLIDE, code, command, json, said, servobench};
use serde_json::Value;
use std::fs;
use tempfile::TempDir;

/// Kept with the attached mass and without it: its force of some 5 N is nothing to a drive that yields 1 µm to half a newton.
const LIMIT: &str = "\n[limits]\nfollowing_error_peak_load = \"1 mm\"\n";

/// The slide with a mass on a spring that hangs on it. The call_timeout is real time: long, so that no slow machine fails.
fn beside(mischief: &str, keys: &str) -> String {
    format!(
        r#"{SLIDE}{LIMIT}
[[fmu]]
file = "attached.fmu"
call_timeout = "2 min"
parameters = {{ mischief = "{mischief}" }}
inputs = {{ x = "load.position", v = "load.velocity" }}
outputs = {{ force = "disturbance.load" }}
{keys}
"#
    )
}

/// The slide's mechanics as an FMU.
fn mechanics(mischief: &str) -> String {
    format!(
        r#"engine = "fmu"
{SLIDE}{LIMIT}
[axis.fmu]
file = "attached.fmu"
call_timeout = "2 min"
parameters = {{ mischief = "{mischief}", mass = "20 kg" }}
inputs = {{ effort = "effort.motor" }}
outputs = {{ position = "shaft.position", velocity = "shaft.velocity" }}
"#
    )
}

/// Processes that `marker` is in the environment of.
fn processes_of(marker: &str) -> Vec<String> {
    let mut all = Vec::new();
    for entry in fs::read_dir("/proc").unwrap() {
        let process = entry.unwrap().path();
        // Those that end meanwhile, and those of others, cannot be read.
        let environment = fs::read(process.join("environ")).unwrap_or_default();
        if String::from_utf8_lossy(&environment).contains(marker) {
            all.push(fs::read_to_string(process.join("cmdline")).unwrap_or_default());
        }
    }
    all
}

/// What is said of a run that does not come to its end.
const BAD: [(&str, &str); 11] = [
    ("crash", "signal 11 (SIGSEGV"),
    ("crash-in-mechanics", "signal 11 (SIGSEGV"),
    ("hang", "did not come back from its step at 0.1 s within 5 s of real time; it was ended"),
    ("hoard", "it asked for more memory than the 300 MB that it may have"),
    ("exit", "exit code 7; its last words: attached: the licence has expired"),
    ("not-a-number", "`force` is NaN at 0.1"),
    ("not-a-number-in-mechanics", "`position` is NaN at 0.1"),
    ("error", "(fmi2Error): the spring of 10000 N/m broke"),
    ("fatal", "(fmi2Fatal): the spring of 10000 N/m broke"),
    ("discard", "discarded fmi2DoStep at 0.1 s"),
    ("end", "`attached` ended the simulation"),
];
const GOOD: [&str; 4] = ["good", "good-mechanics", "print", "log"];

/// A folder with all of them.
fn suite() -> TempDir {
    let work = tempfile::tempdir().unwrap();
    make_fmu(work.path());
    let write = |name: &str, text: String| fs::write(work.path().join(format!("{name}.toml")), text).unwrap();
    for mischief in ["crash", "exit", "error", "fatal", "discard", "end", "print", "log"] {
        write(mischief, beside(mischief, ""));
    }
    write("good", beside("none", ""));
    write("good-mechanics", mechanics("none"));
    write("crash-in-mechanics", mechanics("crash"));
    write("not-a-number", beside("not a number", ""));
    write("not-a-number-in-mechanics", mechanics("not a number"));
    write("hoard", beside("hoard", "memory = 300"));
    write("hang", beside("hang", "").replace("\"2 min\"", "\"5 s\""));
    work
}

#[test]
fn each_fmu_that_misbehaves_costs_its_own_run_and_is_reported_as_what_it_is() {
    let (work, temporary) = (suite(), tempfile::tempdir().unwrap());
    let (folder, out, junit) = (work.path(), work.path().join("out"), work.path().join("junit.xml"));
    let output = command(&["run"])
        .args([folder, "--out".as_ref(), &out, "--junit".as_ref(), &junit])
        .env("TMPDIR", temporary.path())
        .output()
        .unwrap();
    let text = said(&output);
    println!("{text}");
    assert_eq!(code(&output), 3, "{text}");
    let table = String::from_utf8(output.stdout.clone()).unwrap();
    let wide: Vec<&str> = table.lines().filter(|line| line.chars().count() > 80).collect();
    // The last lines name a folder that a user has chosen.
    let names_a_folder =
        |line: &&str| ["results and recordings:", "to try the runs"].iter().any(|start| line.starts_with(start));
    assert!(wide.iter().all(names_a_folder), "{wide:?}");
    assert!(table.contains("15 runs: 4 passed, 11 error"), "{table}");

    let results = json(&fs::read(out.join("results.json")).unwrap());
    let of = |name: &str| -> Value {
        results["scenarios"].as_array().unwrap().iter().find(|run| run["name"] == name).unwrap().clone()
    };
    // What is broken between lines is one text again.
    let in_one_line = table.split_whitespace().collect::<Vec<_>>().join(" ");
    let junit = fs::read_to_string(junit).unwrap();
    for (name, says) in BAD {
        let run = of(name);
        assert_eq!(run["verdict"], "error", "{run}");
        let reason = run["reasons"][0].as_str().unwrap();
        assert!(reason.starts_with("at 0.1") && reason.contains(says), "{name}: {reason}");
        assert!(in_one_line.contains(&reason.split_whitespace().collect::<Vec<_>>().join(" ")), "{name}: {table}");
        assert!(junit.contains(&format!("name=\"{name} [")), "{junit}");
        // What was recorded until then is there.
        let duration = run["duration"].as_f64().unwrap();
        assert!((0.09..0.11).contains(&duration), "{name}: {duration} s");
        assert!(out.join(run["recording"].as_str().unwrap()).is_file(), "{name}");
    }
    for name in GOOD {
        let run = of(name);
        assert_eq!((&run["verdict"], &run["duration"]), (&"passed".into(), &0.4.into()), "{run}");
    }
    for (name, says) in [("print", "standard output: (1.1 GB before this were dropped)"), ("log", "were dropped")] {
        let run = of(name);
        let events = run["log"].as_array().unwrap().iter().filter(|event| event["source"] == "FMU attached");
        let said: Vec<&str> = events.map(|event| event["text"].as_str().unwrap()).collect();
        assert!(said.iter().any(|message| message.contains(says)), "{name}: {said:?}");
        let bytes: usize = said.iter().map(|message| message.len()).sum();
        assert!(bytes < 1 << 21, "{name}: {bytes} of {}", said.len());
    }

    let left: Vec<_> = fs::read_dir(temporary.path()).unwrap().map(|entry| entry.unwrap().file_name()).collect();
    assert_eq!(left, [""; 0], "in the folder for temporary files");
    assert_eq!(processes_of(temporary.path().to_str().unwrap()), [""; 0], "processes");
}

/// A stiff coupling: ω·H = √(c/m)·H = 1.4 between exchanges for the attached mass alone. What is held from one exchange to the
/// next lets it grow at every step (docs/coupling.md); iterated with lines between the exchanges it is within the bound of 2·√3.
#[test]
fn a_coupling_that_is_unstable_ends_with_the_reason_and_iterating_solves_it() {
    let work = tempfile::tempdir().unwrap();
    make_fmu(work.path());
    let stiff =
        beside("none", "").replace("mischief = \"none\"", "mass = \"20 kg\", stiffness = \"40 N/um\", damping = 0");
    for (name, coupling) in [
        ("jacobi", "[coupling]\nmethod = \"jacobi\"\nstep = \"1 ms\"\n"),
        ("iterated", "[coupling]\nmethod = \"iterated\"\nextrapolation = 1\nstep = \"1 ms\"\n"),
    ] {
        fs::write(work.path().join(format!("{name}.toml")), format!("{stiff}{coupling}")).unwrap();
    }
    let out = work.path().join("out");
    let output = servobench(&["run", work.path().to_str().unwrap(), "--out", out.to_str().unwrap()]);
    assert_eq!(code(&output), 3, "{}", said(&output));
    let results = json(&fs::read(out.join("results.json")).unwrap());
    let [iterated, jacobi] = [&results["scenarios"][0], &results["scenarios"][1]];
    assert_eq!((&iterated["name"], &iterated["verdict"]), (&"iterated".into(), &"passed".into()), "{iterated}");
    assert_eq!((&jacobi["name"], &jacobi["verdict"]), (&"jacobi".into(), &"error".into()), "{jacobi}");
    let reason = jacobi["reasons"][0].as_str().unwrap();
    assert!(reason.contains("attached.force -> axis.disturbance.load` is unstable"), "{reason}");
    assert!(reason.contains("take a smaller step than 0.001 s"), "{reason}");
}
