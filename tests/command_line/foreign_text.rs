//! Foreign texts that mean harm, from every place that a text can come from, through every command: none steers the terminal, forges a
//! line of a log or commands a runner of continuous integration.
use crate::fmu_standard::{PATIENT, mischief, work};
use crate::{SLIDE, code, command, on_a_bus, repository, said};
use std::fmt::Write as _;
use std::fs;
use std::io::Write as _;
use std::path::Path;
use std::process::{Command, Output, Stdio};
use tempfile::TempDir;
use zip::ZipWriter;
use zip::write::SimpleFileOptions;

/// A title and colours of the terminal, its screen cleared by either way to write that; a bell; back over what was written; the
/// direction of writing turned; what has no width; every end of a line with a command to a runner behind it; what stands for colours
/// in here.
const HOSTILE: &str = "x\u{1b}]0;OWNED\u{7}\u{1b}[31mRED\u{1b}[2J\u{9b}2J\u{7f}\u{8}\u{85}::error::a\u{202e}evil\u{200b}\u{2028}\
                       ::error file=a.rs,line=1::merged\n::stop-commands::tok\r\n  ::error::b\r##[error]c\u{fdd1}d\u{feff}";
/// The same without what XML does not allow.
const IN_XML: &str =
    "x\u{9b}2J\u{7f}\u{85}::error::a\u{202e}evil\u{200b}\u{2028}::error::b&#10;::stop-commands::t&#10;&#9;##[error]c";

/// `text` in a basic string of TOML.
fn toml(text: &str) -> String {
    let mut quoted = String::from("\"");
    for c in text.chars() {
        match c {
            '"' | '\\' => quoted.extend(['\\', c]),
            c if c.is_control() => write!(quoted, "\\u{:04X}", u32::from(c)).unwrap(),
            c => quoted.push(c),
        }
    }
    quoted + "\""
}

/// That nothing in `text` does harm; tabs and ends of lines do not.
fn is_harmless(text: &str, where_it_is: &str) {
    for c in text.chars() {
        let is_hidden = matches!(c, '\u{61c}' | '\u{ad}' | '\u{200b}'..='\u{200f}' | '\u{2028}'..='\u{202e}'
            | '\u{2060}'..='\u{206f}' | '\u{feff}' | '\u{fff9}'..='\u{fffb}' | '\u{fdd0}'..='\u{fdef}' | '\u{e0000}'..='\u{e0fff}');
        assert!(!is_hidden && (!c.is_control() || c == '\n' || c == '\t'), "{where_it_is}: {c:?} in {text:?}");
    }
    for line in text.split('\n') {
        assert!(!line.trim_start().starts_with("::"), "{where_it_is}: {line:?}");
        assert!(!line.contains("##["), "{where_it_is}: {line:?}");
    }
}

/// What a terminal was sent, without what the program itself sends one: colours, and the bar of its progress.
fn without_our_own(text: &str) -> String {
    let mut bare = String::new();
    let mut parts = text.split("\u{1b}[");
    bare.push_str(parts.next().unwrap_or_default());
    for part in parts {
        let end = part.find(|c: char| !c.is_ascii_digit() && c != ';' && c != '?').unwrap_or(part.len());
        let (numbers, rest) = part.split_at(end);
        let is_ours = match rest.chars().next() {
            Some('m') => !rest.starts_with("mRED"),
            // The bar: columns, lines, cursor; the screen is never cleared.
            Some('K' | 'A' | 'B' | 'G' | 'h' | 'l') => true,
            _ => false,
        };
        assert!(is_ours, "ESC [{numbers}{} in {text:?}", rest.chars().take(3).collect::<String>());
        bare.push_str(&rest[1..]);
    }
    bare.replace('\r', "")
}

/// One command, with its folder.
struct Try {
    arguments: Vec<String>,
    expected: i32,
}

fn a_try(expected: i32, arguments: &[&str]) -> Try {
    Try { arguments: arguments.iter().map(ToString::to_string).collect(), expected }
}

/// Runs them all in `folder`, with pipes and as on a terminal.
fn all_are_harmless(folder: &Path, tries: &[Try]) {
    for Try { arguments, expected } in tries {
        let words: Vec<&str> = arguments.iter().map(String::as_str).collect();
        let output = command(&words).current_dir(folder).env("VIEWED", folder.join("viewed")).output().unwrap();
        assert_eq!(code(&output), *expected, "{words:?}: {}", said(&output));
        for (stream, name) in [(&output.stdout, "stdout"), (&output.stderr, "stderr")] {
            let text = str::from_utf8(stream).unwrap_or_else(|_| panic!("{words:?}: {name}"));
            is_harmless(text, &format!("{words:?} on {name}"));
        }
        let Some(output) = on_a_terminal(folder, &words) else { continue };
        let text = String::from_utf8(output.stdout).unwrap();
        is_harmless(&without_our_own(&text), &format!("{words:?} on a terminal"));
        assert_eq!(output.status.code(), Some(*expected), "{words:?} on a terminal: {text}");
    }
}

/// The same with a terminal for all three streams, by script(1); `None` where there is none.
fn on_a_terminal(folder: &Path, words: &[&str]) -> Option<Output> {
    let quoted = |word: &str| format!("'{}'", word.replace('\'', "'\\''"));
    let line: Vec<_> = words.iter().map(|word| quoted(word)).collect();
    let script = folder.join(".line.sh");
    fs::write(&script, format!("exec {} {}\n", quoted(env!("CARGO_BIN_EXE_servobench")), line.join(" "))).unwrap();
    let mut terminal = Command::new("script");
    terminal.args(["-qec", "sh .line.sh", "/dev/null"]).current_dir(folder).stdin(Stdio::null());
    let output = terminal.env("VIEWED", folder.join("viewed")).env_remove("NO_COLOR").env("TERM", "xterm").output();
    if output.is_err() {
        println!("SKIPPED: there is no script(1), so nothing was run on a terminal");
    }
    output.ok()
}

/// A scenario with these keys before its tables.
fn with(keys: &str) -> String {
    format!("{keys}\n{SLIDE}")
}

fn folder(files: &[(&str, String)]) -> TempDir {
    let folder = tempfile::tempdir().unwrap();
    for (name, text) in files {
        fs::write(folder.path().join(name), text).unwrap();
    }
    folder
}

#[test]
fn names_of_scenarios_and_of_their_files() {
    let limit = "\n[limits]\nfollowing_error_peak_load = \"1 nm\"\n";
    let file = format!("{HOSTILE}.toml");
    let work = folder(&[
        ("named.toml", with(&format!("name = {}\ndescription = {}", toml(HOSTILE), toml(HOSTILE))) + limit),
        (&file, SLIDE.to_owned() + limit),
        ("bus.toml", format!("name = {}\n{}", toml(HOSTILE), on_a_bus(""))),
        ("wrong.toml", with("nonsense = 1")),
    ]);
    let out = format!("out{HOSTILE}");
    let mut tries = vec![
        a_try(4, &["run", "named.toml", &file, "--junit", "junit.xml", "--rrd"]),
        a_try(4, &["run", "named.toml", "--verbose", "--out", &out]),
        a_try(4, &["run", "named.toml", &file, "-q", "--keep", "none", "--out", &out]),
        a_try(4, &["compare", "named.toml", &file, "--out", &out]),
        a_try(0, &["check", "named.toml"]),
        a_try(0, &["check", "named.toml", &file]),
        a_try(0, &["run", "bus.toml", "--out", "bus"]),
        a_try(0, &["objects", "bus.toml"]),
        a_try(2, &["objects", &file]),
        a_try(0, &["fmu", "export", &file, "-o", "x.fmu"]),
        a_try(0, &["fmu", "export", "named.toml"]),
        a_try(0, &["fmu", "info", "x.fmu"]),
        a_try(2, &["timing", &file]),
        a_try(2, &["view", &format!("no{file}")]),
        a_try(2, &["run", "--resume", &file]),
        a_try(2, &["run", "wrong.toml", "--junit", &format!("junit{HOSTILE}")]),
        a_try(2, &["run", &format!("{HOSTILE}/no-such-file")]),
        a_try(2, &["run", "named.toml", "--junit", "named.toml"]),
        a_try(
            3,
            &[
                "plan",
                "--order",
                "2",
                "--distance",
                "1m",
                "--velocity",
                "1m/s",
                "--acceleration",
                "1m/s2",
                "--csv",
                &format!("no/{HOSTILE}"),
            ],
        ),
    ];
    tries.push(a_try(0, &["timing", "bus/bus.parquet"]));
    // The recording of the scenario on a bus, by a name that is known.
    let made = tries.pop().unwrap();
    all_are_harmless(work.path(), &tries);
    let recording = fs::read_dir(work.path().join("bus")).unwrap().map(|entry| entry.unwrap().path());
    let recording = recording.into_iter().find(|path| path.extension().is_some_and(|kind| kind == "parquet")).unwrap();
    fs::copy(recording, work.path().join("bus/bus.parquet")).unwrap();
    all_are_harmless(work.path(), &[made, a_try(2, &["timing", "bus/bus.parquet", "--source", HOSTILE])]);
    let viewer = repository().join("tests/viewer");
    let output = command(&["view", "servobench-out"]).current_dir(work.path()).env("PATH", viewer).output().unwrap();
    is_harmless(&said(&output), "view");
    for (name, path) in [("JUnit", "junit.xml".into()), ("JUnit", format!("junit{HOSTILE}"))] {
        let junit = fs::read_to_string(work.path().join(path)).unwrap();
        is_harmless(&junit, name);
        let references = junit.split("&#").skip(1).filter_map(|rest| rest.split_once(';'));
        assert!(references.into_iter().all(|(number, _)| ["10", "xA", "9", "x9"].contains(&number)), "{junit}");
    }
    let drawn = fs::read_dir(work.path().join("bus")).unwrap().map(|entry| entry.unwrap().path());
    for svg in drawn.filter(|path| path.extension().is_some_and(|kind| kind == "svg")) {
        is_harmless(&fs::read_to_string(svg).unwrap(), "the timing diagram");
    }
    // A program reads what was written.
    let results = crate::json(&fs::read(work.path().join("servobench-out/results.json")).unwrap());
    assert_eq!(results["scenarios"][0]["name"], HOSTILE);
}

#[test]
fn keys_values_and_what_is_no_toml() {
    let key = toml(HOSTILE);
    let texts = [
        with(&format!("{key} = 1")),
        with(&format!("engine = [{key}]")),
        SLIDE.replace("kind = \"p\"", &format!("kind = {key}")),
        SLIDE.replace("\"20 kg\"", &format!("\"20 kg{}", &key[1..])),
        SLIDE.replace("mass = \"20 kg\"", &format!("mass = \"20 kg\"\n{key} = {key}")),
        SLIDE.replace("[axis.motor_side]\nmass = \"20 kg\"", &format!("model = {key}")),
        SLIDE.replace("kind = \"ideal-source\"", &format!("model = {key}")),
        SLIDE.replace("[measure]", &format!("[record]\nchannels = [{key}]\n[measure]")),
        SLIDE.replace("[measure]", &format!("[limits]\n{key} = \"1 s\"\n[measure]")),
        SLIDE.replace("move_to = \"50 mm\"", &format!("table = {{ file = {key} }}")),
        SLIDE
            .replace("[axis.motor_side]\nmass = \"20 kg\"", &format!("[axis.mjcf]\nfile = {key}\nmotor_joint = {key}")),
        // As they are, which TOML does not allow.
        with(&format!("name = \"{}\"", HOSTILE.replace('\n', " "))),
        with(&format!("# {HOSTILE}")),
        with(HOSTILE),
        format!("{SLIDE}\n[[fmu]]\nfile = {key}\nname = {key}\ninputs = {{ {key} = {key} }}\n"),
    ];
    let names: Vec<String> = (0..texts.len()).map(|k| format!("{k:02}.toml")).collect();
    let work = folder(&[]);
    let mut tries = vec![];
    for (name, text) in names.iter().zip(&texts) {
        fs::write(work.path().join(name), text).unwrap();
        tries.push(a_try(2, &["check", name]));
        tries.push(a_try(2, &["run", name, "-q", "--junit", "junit.xml"]));
    }
    tries.push(a_try(2, &["compare", "00.toml", "01.toml"]));
    tries.push(a_try(2, &["fmu", "export", "02.toml"]));
    tries.push(a_try(2, &["objects", "03.toml"]));
    all_are_harmless(work.path(), &tries);
    is_harmless(&fs::read_to_string(work.path().join("junit.xml")).unwrap(), "JUnit");
}

#[test]
fn the_command_line() {
    let work = folder(&[("a.toml", SLIDE.to_owned())]);
    let set = |key: &str, value: &str| format!("--set={key}={value}");
    let mut tries = vec![
        a_try(2, &[HOSTILE]),
        a_try(2, &["run", &format!("--{HOSTILE}")]),
        a_try(2, &["run", "--engine", HOSTILE]),
        a_try(2, &["run", "--jobs", HOSTILE, "--worker-timeout", HOSTILE, "--keep", HOSTILE]),
        a_try(2, &["plan", "--order", "2", "--distance", HOSTILE, "--velocity", HOSTILE, "--acceleration", "1 m/s2"]),
        a_try(2, &["plan", "--profile", HOSTILE]),
        a_try(2, &["plan", "pvt", "--points", HOSTILE]),
        a_try(2, &["completions", HOSTILE]),
        a_try(2, &["plc", "export", "--move-block", HOSTILE]),
        a_try(2, &["plc", "export", "--dialect", HOSTILE, "--sample-time", HOSTILE]),
        a_try(2, &["compare", HOSTILE]),
        a_try(2, &["view", HOSTILE]),
        a_try(2, &["fmu", "info", HOSTILE]),
        a_try(0, &["--help"]),
        a_try(0, &["run", "--help"]),
        a_try(0, &["schema"]),
    ];
    for command in [&["run"][..], &["check"], &["objects"], &["fmu", "export"]] {
        for set in
            [set(HOSTILE, "1"), set("setpoint.jerk", HOSTILE), format!("--set={HOSTILE}"), set("axis.x", HOSTILE)]
        {
            tries.push(a_try(2, &[command, &["a.toml", &set]].concat()));
        }
    }
    // What is taken: it is in the table, in the name of the case and in the recording.
    let taken = set("description", &toml(HOSTILE));
    tries.push(a_try(0, &["run", "a.toml", &taken, "--junit", "junit.xml"]));
    tries.push(a_try(0, &["run", "a.toml", &taken, "-q"]));
    tries.push(a_try(0, &["compare", "a.toml", "a.toml", &taken]));
    tries.push(a_try(0, &["fmu", "export", "a.toml", &taken]));
    all_are_harmless(work.path(), &tries);
    is_harmless(&fs::read_to_string(work.path().join("junit.xml")).unwrap(), "JUnit");
}

#[test]
fn tables_models_and_mjcf() {
    let table = |heading: &str, cell: &str| format!("time [ms],position [mm],{heading}\n0,0,0\n10,{cell},0\n20,2,0\n");
    let unused = "acceleration [mm/s2]";
    // No end of a line in it.
    let inner: String = HOSTILE.chars().filter(|c| !"\n\r,".contains(*c)).collect();
    let mjcf = |name: &str| {
        format!(
            "<mujoco><worldbody><body name=\"{name}\"><joint name=\"{name}\" type=\"slide\"/><geom size=\"1\" mass=\"1\"/>\
                 </body></worldbody><equality/><{name}/></mujoco>"
        )
    };
    let axis = |file: &str, joint: &str| {
        let own = format!("[axis.mjcf]\nfile = \"{file}\"\nmotor_joint = {}\nload_joint = \"x\"", toml(joint));
        format!("engine = [\"rapier\"]\n{}", SLIDE.replace("[axis.motor_side]\nmass = \"20 kg\"", &own))
    };
    let points = SLIDE.replace("move_to = \"50 mm\"", "table = { file = \"cell.csv\", velocities = \"average\" }");
    let work = folder(&[
        ("heading.csv", table(&inner, "1")),
        ("unit.csv", table(&format!("velocity [{inner}]"), "1")),
        ("cell.csv", table(unused, &inner)),
        ("all.csv", HOSTILE.to_owned()),
        ("points.toml", points),
        ("own.xml", mjcf("x\u{9b}2J\u{202e}&#10;::error::x")),
        ("broken.xml", mjcf(HOSTILE)),
        ("joint.toml", axis("own.xml", HOSTILE)),
        ("broken.toml", axis("broken.xml", "x")),
        ("model.toml", SLIDE.replace("kind = \"ideal-source\"", "model = \"own\"")),
        ("latin.toml", String::new()),
    ]);
    fs::create_dir_all(work.path().join("models/motors")).unwrap();
    fs::write(work.path().join("models/motors/own.toml"), format!("{} = {}\n", toml(HOSTILE), toml(HOSTILE))).unwrap();
    fs::write(work.path().join("latin.toml"), b"name = \"\xe9\x1b[2J\"").unwrap();
    let mut tries = vec![];
    for table in ["heading.csv", "unit.csv", "cell.csv", "all.csv"] {
        tries.push(a_try(2, &["plan", "pvt", "--points", table]));
    }
    for scenario in ["points.toml", "joint.toml", "broken.toml", "model.toml", "latin.toml"] {
        tries.push(a_try(2, &["check", scenario]));
        tries.push(a_try(2, &["run", scenario, "--junit", "junit.xml"]));
    }
    all_are_harmless(work.path(), &tries);
    is_harmless(&fs::read_to_string(work.path().join("junit.xml")).unwrap(), "JUnit");
}

#[test]
fn what_fmus_are_called_and_what_they_say() {
    let work = work(&[
        ("log", mischief("m", "escapes", "step", PATIENT)),
        ("early", mischief("m", "escapes", "get", PATIENT)),
        (
            "wired",
            format!("{SLIDE}\n[[fmu]]\nfile = \"hostile.fmu\"\ninputs = {{ {} = \"load.position\" }}\n", toml(HOSTILE)),
        ),
    ]);
    let description = format!(
        r#"<fmiModelDescription fmiVersion="2.0" modelName="{IN_XML}" guid="{{s}}" description="{IN_XML}" author="{IN_XML}"
generationTool="{IN_XML}"><CoSimulation modelIdentifier="x"/>
<UnitDefinitions><Unit name="{IN_XML}"/></UnitDefinitions>
<TypeDefinitions><SimpleType name="{IN_XML}"><Enumeration><Item name="{IN_XML}" value="1" description="{IN_XML}"/></Enumeration></SimpleType></TypeDefinitions>
<ModelVariables><ScalarVariable name="{IN_XML}" valueReference="1" causality="output" description="{IN_XML}"><Real unit="{IN_XML}"/></ScalarVariable></ModelVariables>
<ModelStructure/></fmiModelDescription>"#
    );
    for (name, inside) in [("names.fmu", HOSTILE.replace(['\\', ':'], "")), ("control.fmu", "a\u{9b}2J\u{7f}b".into())]
    {
        let mut zip = ZipWriter::new(fs::File::create(work.path().join(name)).unwrap());
        zip.start_file(inside, SimpleFileOptions::default()).unwrap();
        zip.finish().unwrap();
    }
    for (name, text) in [
        ("hostile.fmu", description.clone()),
        ("broken.fmu", description.replace("causality=\"output\"", &format!("causality=\"{IN_XML}\""))),
    ] {
        let mut zip = ZipWriter::new(fs::File::create(work.path().join(name)).unwrap());
        for (name, content) in [("modelDescription.xml", &*text), ("resources/x\u{202e}\u{200b}", "x")] {
            zip.start_file(name, SimpleFileOptions::default()).unwrap();
            zip.write_all(content.as_bytes()).unwrap();
        }
        zip.finish().unwrap();
    }
    all_are_harmless(
        work.path(),
        &[
            a_try(0, &["fmu", "info", "hostile.fmu"]),
            a_try(2, &["fmu", "info", "names.fmu"]),
            a_try(2, &["fmu", "info", "control.fmu"]),
            a_try(2, &["fmu", "info", "broken.fmu"]),
            a_try(2, &["check", "wired.toml"]),
            a_try(2, &["run", "wired.toml"]),
            a_try(3, &["run", "log.toml", "early.toml", "--junit", "junit.xml"]),
            a_try(3, &["run", "log.toml", "-q"]),
            a_try(3, &["compare", "log.toml", "log.toml"]),
        ],
    );
    is_harmless(&fs::read_to_string(work.path().join("junit.xml")).unwrap(), "JUnit");
}

/// Files that came with an issue: what their names did to a log.
#[test]
fn a_forged_line_of_a_log_is_none() {
    let name = "x\n::error file=a.rs,line=1::everything is fine, merged\n::stop-commands::tok\n1 run: 1 passed";
    let limit = "\n[limits]\nfollowing_error_peak_load = \"1 nm\"\n";
    let work = folder(&[("ci.toml", with(&format!("name = {}", toml(name))) + limit)]);
    for quiet in [&[][..], &["-q"]] {
        let output = command(&[&["run", "ci.toml"], quiet].concat()).current_dir(work.path()).output().unwrap();
        assert_eq!(code(&output), 4, "{}", said(&output));
        assert!(said(&output).contains("everything is fine, merged"), "{}", said(&output));
        assert!(!said(&output).lines().any(|line| line == "1 run: 1 passed"), "{}", said(&output));
    }
}

/// The gate lets our own colours through, and all of them.
#[test]
fn colours_of_our_own_are_shown() {
    let limit = "\n[limits]\nfollowing_error_peak_load = \"1 nm\"\n";
    let work = folder(&[
        ("wrong.toml", with("nonsense = 1")),
        ("fails.toml", SLIDE.to_owned() + limit),
        ("doubtful.toml", with("format = 1")),
    ]);
    for (words, says) in [
        (&["check", "wrong.toml"][..], "\u{1b}[31m"),
        (&["check", "doubtful.toml"], "\u{1b}[33m"),
        (&["run", "fails.toml"], "\u{1b}[1;31mFAILED"),
        (&["run", "--jobs", "0"], "\u{1b}[31merror:"),
        (&["--help"], "\u{1b}[1m"),
    ] {
        let Some(output) = on_a_terminal(work.path(), words) else { return };
        let text = String::from_utf8(output.stdout).unwrap();
        assert!(text.contains(says) && !text.contains('\u{fffd}'), "{words:?}: {text:?}");
        let plain = command(words).current_dir(work.path()).output().unwrap();
        assert!(!said(&plain).contains('\u{1b}'), "{words:?}");
    }
}
