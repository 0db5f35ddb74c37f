//! The suite that things happen to, and what must hold afterwards.
use crate::attached::make_fmu;
use crate::fault::Fault;
use crate::processes;
use rustix::process::Pid;
use serde_json::Value;
use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Child, Command, ExitStatus, Stdio};
use std::time::{Duration, Instant};
use tempfile::TempDir;

/// A slide of 20 kg that moves by 0.1 m and waits.
const SLIDE: &str = r#"
[run]
base_rate = "4 kHz"
duration = "DURATION"
[axis]
motion = "linear"
[axis.motor_side]
mass = "20 kg"
[motor]
kind = "ideal-source"
[drive.velocity]
rate = "4 kHz"
bandwidth = "80 Hz"
[drive.position]
rate = "4 kHz"
bandwidth = "10 Hz"
[setpoint]
order = 3
velocity = "1 m/s"
acceleration = "5 m/s2"
jerk = "50 m/s3"
[record]
channels = ["load.position", "following_error.load"]
rate = "1 kHz"
[[program]]
move_to = "100 mm"
[limits]
following_error_peak_load = "LIMIT"
"#;
/// A mass on a spring beside it, as an FMU that does what `ATTACHED_MISCHIEF` says.
const FMU: &str = r#"
[[fmu]]
file = "attached.fmu"
call_timeout = "20 s"
memory = 300
inputs = { x = "load.position", v = "load.velocity" }
outputs = { force = "disturbance.load" }
"#;
/// How long one that hangs is waited for.
const PATIENCE: Duration = Duration::from_mins(2);

/// The slide on these engines, whose following error is to keep `limit`.
pub(crate) fn slide(engines: &[&str], duration: &str, limit: &str) -> String {
    format!("engine = {engines:?}{}", SLIDE.replace("DURATION", duration).replace("LIMIT", limit))
}

/// Scenarios, and what comes of them when nothing happens.
pub(crate) struct Suite {
    work: TempDir,
    whole: Whole,
    usual_time: Duration,
}

/// All that a suite leaves.
#[derive(PartialEq)]
struct Whole {
    code: Option<i32>,
    files: BTreeMap<String, Vec<u8>>,
    junit: String,
}

impl Suite {
    pub(crate) fn new() -> Self {
        let work = tempfile::tempdir().unwrap();
        make_fmu(work.path());
        let scenario = |engine: &str, duration: &str, limit: &str| slide(&[engine], duration, limit);
        let files = [
            ("a-exact", scenario("exact", "20 s", "1 m")),
            ("b-rapier", scenario("rapier", "5 s", "1 m")),
            ("c-too-tight", scenario("exact", "0.5 s", "1 nm")),
            ("d-fmu", scenario("exact", "1 s", "1 m") + FMU),
            ("e-invalid", "[run]\nbase_rat = 1\n".to_owned()),
            ("f-mujoco", scenario("mujoco", "5 s", "1 m")),
            ("g-exact", scenario("exact", "60 s", "1 m")),
            ("h-fmu", scenario("exact", "0.8 s", "1 m") + FMU),
        ];
        for (name, text) in files {
            if name != "f-mujoco" || cfg!(feature = "mujoco") {
                fs::write(work.path().join(format!("{name}.toml")), text).unwrap();
            }
        }
        for folder in ["tmp", "outs"] {
            fs::create_dir(work.path().join(folder)).unwrap();
        }
        let clock = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../tests/drill/clock.c");
        let mut compiler = Command::new("cc");
        compiler.args(["-O1", "-shared", "-fPIC", "-o"]).arg(work.path().join("clock.so")).arg(clock).arg("-ldl");
        assert!(compiler.status().unwrap().success(), "the C compiler that the workspace is built with anyway");
        let mut suite = Self {
            work,
            whole: Whole { code: None, files: BTreeMap::new(), junit: String::new() },
            usual_time: Duration::ZERO,
        };
        let start = Instant::now();
        let (status, said) = finished(start_of(suite.run("whole")), "nothing");
        suite.usual_time = start.elapsed();
        assert_eq!(status.code(), Some(2), "{said}");
        suite.whole = suite.left("whole", status);
        assert!(!suite.whole.files.contains_key("results.journal") && suite.whole.files.len() >= 7, "{said}");
        suite
    }

    /// How long it takes when nothing happens.
    pub(crate) const fn usual_time(&self) -> Duration {
        self.usual_time
    }

    /// Its folder.
    pub(crate) fn folder(&self) -> &Path {
        self.work.path()
    }

    /// The folder of one of its runs.
    pub(crate) fn out(&self, name: &str) -> PathBuf {
        self.work.path().join("outs").join(name)
    }

    fn junit(&self, name: &str) -> PathBuf {
        self.work.path().join("outs").join(format!("{name}.xml"))
    }

    fn program(&self) -> Command {
        let mut program = Command::new(env!("CARGO_BIN_EXE_servobench"));
        // What marks its processes, too.
        program.current_dir(self.folder()).env("TMPDIR", self.folder().join("tmp"));
        program
    }

    /// The command that begins it.
    pub(crate) fn run(&self, name: &str) -> Command {
        let mut run = self.program();
        run.args(["run", ".", "--jobs", "2", "--out"]).arg(self.out(name)).arg("--junit").arg(self.junit(name));
        run
    }

    /// Begins it, lets `fault` happen, looks at what is left, and runs the rest; says how it ended.
    pub(crate) fn befall(&self, fault: &Fault, name: &str) -> String {
        let place = format!("{fault:?}, suite {name}");
        fault.prepare(self, name);
        let child = start_of(fault.command(self, name));
        fault.happen(self, &child);
        let (status, said) = finished(child, &place);
        assert!(fault.explains(status), "{place}: {status}\n{said}");
        assert!(
            processes::have_ended(&self.folder().join("tmp"), Duration::from_secs(10)),
            "{place}: a process is left"
        );
        fault.lift(self, name);
        let known = self.known_by_journal(name, &place);
        let had_ended =
            known.map_or_else(|| "nothing is left to run".into(), |known| format!("{known} runs had a verdict"));
        let how = format!("{status}, {had_ended}");
        self.go_on(fault, name, known, &place);
        fault.clean(self, name);
        how
    }

    /// How many runs have a verdict by the journal, or by the results when they say that they are complete.
    fn known_by_journal(&self, name: &str, place: &str) -> Option<usize> {
        if let Ok(text) = fs::read(self.out(name).join("results.json")) {
            let results: Value =
                serde_json::from_slice(&text).unwrap_or_else(|error| panic!("{place}: results.json: {error}"));
            assert!(["complete", "incomplete"].contains(&results["status"].as_str().unwrap()), "{place}: {results}");
        }
        let text = fs::read_to_string(self.out(name).join("results.journal")).ok()?;
        let mut verdicts = BTreeMap::new();
        for line in text.lines().filter(|line| line.len() > 17) {
            // A line that is torn is a run that has not ended.
            let Ok(record) = serde_json::from_str::<Value>(&line[17..]) else { continue };
            let finished = &record["finished"];
            if let Some(index) = finished["index"].as_u64() {
                verdicts.insert(index, finished["result"]["verdict"] != "error");
            }
        }
        Some(verdicts.into_values().filter(|has_verdict| *has_verdict).count())
    }

    /// What `--resume` makes of it is what it would have been.
    fn go_on(&self, fault: &Fault, name: &str, known: Option<usize>, place: &str) {
        let mut resume = self.program();
        resume.args(["run", "--resume"]).arg(self.out(name)).arg("--junit").arg(self.junit(name));
        let (mut status, mut said) = finished(start_of(resume), place);
        if status.code() == Some(2) && said.contains("there is no suite in") {
            // It ended before it could begin its journal, or was complete without one.
            assert_eq!(known, None, "{place}: {said}");
            (status, said) = finished(start_of(self.run(name)), place);
        } else if let Some(known) = known {
            assert!(said.contains(&format!("{known} of ")), "{place}: of {known} runs not all are known\n{said}");
        }
        let mut left = self.left(name, status);
        if fault.keeps_junit_away() {
            assert_eq!(left.junit, "", "{place}");
            left.junit.clone_from(&self.whole.junit);
        }
        assert!(left == self.whole, "{place}: {}\n{said}", left.difference(&self.whole));
        let rubbish: Vec<_> =
            fs::read_dir(self.folder().join("tmp")).unwrap().map(|entry| entry.unwrap().file_name()).collect();
        assert!(rubbish.is_empty(), "{place}: {rubbish:?} in the folder for temporary files");
        assert!(processes::of(&self.folder().join("tmp")).is_empty(), "{place}: a process is left");
    }

    fn left(&self, name: &str, status: ExitStatus) -> Whole {
        let entries = fs::read_dir(self.out(name)).unwrap().map(|entry| entry.unwrap());
        let files = entries.map(|entry| (entry.file_name().into_string().unwrap(), fs::read(entry.path()).unwrap()));
        let junit = without_times(&fs::read_to_string(self.junit(name)).unwrap_or_default());
        Whole { code: status.code(), files: files.collect(), junit }
    }
}

impl Whole {
    fn difference(&self, whole: &Self) -> String {
        let mut all = Vec::new();
        if self.code != whole.code {
            all.push(format!("exit code {:?}, not {:?}", self.code, whole.code));
        }
        for name in self.files.keys().chain(whole.files.keys()) {
            if self.files.get(name) != whole.files.get(name) {
                let size =
                    |of: &Self| of.files.get(name).map_or_else(|| "no".to_owned(), |bytes| bytes.len().to_string());
                all.push(format!("{name} has {} bytes, not {}, or others", size(self), size(whole)));
            }
        }
        if self.junit != whole.junit {
            all.push(format!("JUnit\n{}\nnot\n{}", self.junit, whole.junit));
        }
        all.join("; ")
    }
}

/// The report without what a clock has said.
fn without_times(junit: &str) -> String {
    let mut parts = junit.split(" time=\"");
    let first = parts.next().unwrap_or_default().to_owned();
    parts.fold(first, |text, part| text + part.split_once('"').map_or("", |(_, rest)| rest))
}

pub(crate) fn start_of(mut command: Command) -> Child {
    command.stdin(Stdio::null()).stdout(Stdio::piped()).stderr(Stdio::piped()).spawn().unwrap()
}

/// How `child` ended, and what it said.
pub(crate) fn finished(mut child: Child, place: &str) -> (ExitStatus, String) {
    let pid = Pid::from_child(&child);
    let (mut stdout, mut stderr) = (child.stdout.take().unwrap(), child.stderr.take().unwrap());
    let read = |stream: &mut dyn std::io::Read| {
        let mut text = Vec::new();
        stream.read_to_end(&mut text).ok();
        String::from_utf8_lossy(&text).into_owned()
    };
    let reader = std::thread::spawn(move || read(&mut stdout));
    let errors = std::thread::spawn(move || {
        let mut text = Vec::new();
        std::io::Read::read_to_end(&mut stderr, &mut text).ok();
        String::from_utf8_lossy(&text).into_owned()
    });
    let start = Instant::now();
    let status = loop {
        if let Some(status) = child.try_wait().unwrap() {
            break status;
        }
        if start.elapsed() > PATIENCE {
            processes::send(pid, rustix::process::Signal::KILL);
            panic!("{place}: it hangs");
        }
        std::thread::sleep(Duration::from_millis(1));
    };
    (status, reader.join().unwrap() + &errors.join().unwrap())
}
