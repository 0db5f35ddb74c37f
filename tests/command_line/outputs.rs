//! What is written where: never over what is read, never outside the folder that was named, never half.
use crate::{SLIDE, code, command, folder, on_a_bus, repository, said, servobench};
use std::fs::{self, File};
use std::os::unix::fs::{FileTypeExt, symlink};
use std::path::{Path, PathBuf};
use std::process::{Command, Output, Stdio};

const TABLE: &str = "time [ms],position [mm]\n0,0\n10,1\n20,5\n30,10\n40,11\n";
/// Names that lead elsewhere, that no file system takes, or that become the same.
const HOSTILE: [&str; 9] =
    ["../../outside/x", "..", ".", "/outside/x", "~/x", "-rf", "a\\u0000b", "a/../b", "\\u001B]0;x\\u0007"];

/// `servobench` in `folder`.
fn within(folder: &Path, arguments: &[&str]) -> Output {
    command(arguments).current_dir(folder).output().unwrap()
}

/// Every file below `folder` with what it holds.
fn contents(folder: &Path) -> Vec<(PathBuf, Vec<u8>)> {
    let mut all = Vec::new();
    let mut folders = vec![folder.to_owned()];
    while let Some(folder) = folders.pop() {
        for entry in fs::read_dir(folder).unwrap() {
            let path = entry.unwrap().path();
            if path.is_dir() && !path.is_symlink() {
                folders.push(path);
            } else {
                let content = fs::read(&path).unwrap_or_default();
                all.push((path, content));
            }
        }
    }
    all.sort();
    all
}

/// That `arguments` are refused with 2 and the words `says`, and nothing in `folder` is other than before.
fn refused(folder: &Path, arguments: &[&str], says: &[&str]) {
    let before = contents(folder);
    let output = within(folder, arguments);
    assert_eq!(code(&output), 2, "{arguments:?}: {}", said(&output));
    for words in says {
        assert!(said(&output).contains(words), "{arguments:?}: {words} in {}", said(&output));
    }
    assert!(contents(folder) == before, "{arguments:?} changed something: {}", said(&output));
}

/// A folder with `file` under its own name, by two kinds of links and by a detour; the names.
fn names_of(folder: &Path, file: &str) -> Vec<String> {
    fs::create_dir(folder.join("sub")).unwrap();
    symlink(folder.join(file), folder.join("symbolic")).unwrap();
    fs::hard_link(folder.join(file), folder.join("hard")).unwrap();
    let there = folder.join(file).display().to_string();
    vec![file.into(), format!("./{file}"), format!("sub/../{file}"), there, "symbolic".into(), "hard".into()]
}

#[test]
fn a_plan_is_not_written_over_its_table() {
    let work = folder(&[("t.csv", TABLE)]);
    for name in names_of(work.path(), "t.csv") {
        let pvt = ["plan", "pvt", "--points", "t.csv"];
        for option in ["--csv", "--svg", "--pvt", "--words"] {
            let arguments = [&pvt[..], &[option, &name, "--counts", "1000/mm"]].concat();
            refused(work.path(), &arguments, &[&format!("{option}: `{name}` is the table of --points")]);
        }
        let position = ["plan", "position", "--points", "t.csv", "--plateau", "0.25", "--commands", &name];
        refused(work.path(), &position, &["--commands: ", "the table of --points and would be lost"]);
    }
    // The table itself by a link.
    refused(work.path(), &["plan", "pvt", "--points", "symbolic", "--csv", "t.csv"], &["--csv", "--points"]);
}

#[test]
fn a_report_is_not_written_over_a_scenario_or_a_file_of_one() {
    let model = fs::read_to_string(repository().join("models/motors/emps.toml")).unwrap();
    let text = SLIDE.replace("kind = \"ideal-source\"", "model = \"own\"");
    let points = SLIDE.replace("move_to = \"50 mm\"", "table = { file = \"t.csv\", velocities = \"average\" }");
    assert_ne!(points, SLIDE);
    let work = folder(&[("a.toml", SLIDE), ("wrong.toml", "x = 1\n"), ("t.csv", TABLE), ("b.toml", &text)]);
    fs::write(work.path().join("points.toml"), points).unwrap();
    fs::create_dir_all(work.path().join("models/motors")).unwrap();
    fs::write(work.path().join("models/motors/own.toml"), model).unwrap();
    for name in names_of(work.path(), "a.toml") {
        let says = format!("--junit: `{name}` is the scenario a.toml and would be lost");
        refused(work.path(), &["run", "a.toml", "--junit", &name, "--quiet"], &[&says]);
        refused(work.path(), &["objects", "a.toml", "-o", &name], &["has no `[bus]`"]);
    }
    refused(work.path(), &["run", "wrong.toml", "--junit", "wrong.toml"], &["--junit: ", "the scenario wrong.toml"]);
    refused(work.path(), &["run", ".", "--junit", "b.toml"], &["--junit: ", "would be lost"]);
    let model = ["run", "b.toml", "--junit", "models/motors/own.toml"];
    refused(work.path(), &model, &["is a file of the scenario b.toml and would be lost"]);
    let table = ["run", "points.toml", "--junit", "t.csv"];
    refused(work.path(), &table, &["--junit: `t.csv` is a file of the scenario points.toml and would be lost"]);
    // What comes in on standard input is a file all the same.
    let input = File::open(work.path().join("a.toml")).unwrap();
    let output = command(&["run", "-", "--junit", "a.toml"]).current_dir(work.path()).stdin(input).output().unwrap();
    assert_eq!(code(&output), 2, "{}", said(&output));
    assert!(
        said(&output).contains("`a.toml` is what comes in on standard input and would be lost"),
        "{}",
        said(&output)
    );
    assert_eq!(fs::read_to_string(work.path().join("a.toml")).unwrap(), SLIDE);
}

#[test]
fn no_other_command_writes_over_what_it_reads() {
    let work = folder(&[("bus.toml", &on_a_bus(""))]);
    for (arguments, says) in [
        (&["objects", "bus.toml", "-o", "bus.toml"][..], "-o: `bus.toml` is the scenario bus.toml"),
        (&["objects", "bus.toml", "--format", "eds", "-o", "./bus.toml"], "-o: `./bus.toml` is the scenario bus.toml"),
        (&["fmu", "export", "bus.toml", "-o", "bus.toml"], "-o: `bus.toml` is the scenario bus.toml"),
    ] {
        refused(work.path(), arguments, &[says, "would be lost"]);
    }
    // By a link, so that the library stays whatever comes of it: where cargo has it, or where it is distributed.
    let program = Path::new(env!("CARGO_BIN_EXE_servobench")).parent().unwrap();
    let places = ["../lib", "deps", ""].map(|folder| program.join(folder).join("libservobench_fmu.so"));
    symlink(places.iter().find(|place| place.is_file()).unwrap(), work.path().join("library")).unwrap();
    refused(work.path(), &["fmu", "export", "bus.toml", "-o", "library"], &["is the library that goes into FMUs"]);
    let output = within(work.path(), &["run", "bus.toml", "--out", "out", "--quiet"]);
    assert_eq!(code(&output), 0, "{}", said(&output));
    let recording = "out/bus.exact.parquet";
    refused(work.path(), &["timing", recording, "-o", recording], &["-o: `out/bus.exact.parquet` is the recording"]);
    // What is in the way of the results: a scenario by another name, and the results of two commands.
    fs::remove_file(work.path().join("out/results.json")).unwrap();
    symlink(work.path().join("bus.toml"), work.path().join("out/results.json")).unwrap();
    refused(work.path(), &["run", "bus.toml", "--out", "out"], &["--out: `out/results.json` is the scenario bus.toml"]);
}

#[test]
fn two_options_do_not_name_one_file() {
    let work = folder(&[("t.csv", TABLE), ("a.toml", SLIDE)]);
    fs::create_dir(work.path().join("there")).unwrap();
    let plan = ["plan", "pvt", "--points", "t.csv", "--csv", "new", "--svg"];
    for name in ["new", "./new", "there/../new"] {
        refused(work.path(), &[&plan[..], &[name]].concat(), &["--svg: ", "is written by --csv too"]);
    }
    for out in ["out", "there"] {
        for name in ["results.json", "results.journal", "a.exact.parquet", "a.exact.timing.svg", "../out/results.json"]
        {
            let junit = format!("{out}/{name}");
            if name.starts_with("..") && out == "out" {
                continue;
            }
            let out = if name.starts_with("..") { "out" } else { out };
            let arguments = ["run", "a.toml", "--out", out, "--junit", &junit];
            refused(work.path(), &arguments, &[&format!("--junit: `{junit}` is written by --out too")]);
        }
    }
    // A device has room for both.
    let both = ["plan", "pvt", "--points", "t.csv", "--csv", "/dev/null", "--svg", "/dev/null"];
    assert_eq!(code(&within(work.path(), &both)), 0);
    assert!(fs::metadata("/dev/null").unwrap().file_type().is_char_device());
}

#[test]
fn a_folder_is_no_file_and_a_file_no_folder() {
    let work = folder(&[("t.csv", TABLE), ("a.toml", SLIDE)]);
    fs::create_dir_all(work.path().join("there/results.json")).unwrap();
    let plan = ["plan", "pvt", "--points", "t.csv", "--csv", "there"];
    refused(work.path(), &plan, &["--csv: `there` is a folder; name a file in it"]);
    let arguments = ["run", "a.toml", "--out", "out", "--junit", "there"];
    refused(work.path(), &arguments, &["--junit: `there` is a folder"]);
    for arguments in [&["run", "a.toml", "--out", "t.csv"][..], &["man", "--out", "t.csv"]] {
        refused(work.path(), arguments, &["--out: `t.csv` is no folder"]);
    }
    refused(work.path(), &["run", "a.toml", "--out", "there"], &["--out: `there/results.json` is a folder"]);
}

/// What was there before is replaced as every tool does it.
#[test]
fn an_older_output_is_replaced() {
    let work = folder(&[("t.csv", TABLE), ("old.csv", "old"), ("a.toml", SLIDE), ("junit.xml", "old")]);
    let output = within(work.path(), &["plan", "pvt", "--points", "t.csv", "--csv", "old.csv"]);
    assert_eq!(code(&output), 0, "{}", said(&output));
    assert!(fs::read_to_string(work.path().join("old.csv")).unwrap().starts_with("time"));
    for _ in 0..2 {
        let output = within(work.path(), &["run", "a.toml", "--out", "out", "--junit", "junit.xml"]);
        assert_eq!(code(&output), 0, "{}", said(&output));
    }
    assert!(fs::read_to_string(work.path().join("junit.xml")).unwrap().contains("<testsuites"));
    // A copy of an input is none.
    fs::copy(work.path().join("t.csv"), work.path().join("copy.csv")).unwrap();
    assert_eq!(code(&within(work.path(), &["plan", "pvt", "--points", "t.csv", "--csv", "copy.csv"])), 0);
}

/// Whatever a scenario is called: its files are in the folder of `--out`, and as many as there are runs.
#[test]
fn no_name_of_a_scenario_leads_out_of_the_folder() {
    let work = tempfile::tempdir().unwrap();
    let inner = work.path().join("a/b/c");
    fs::create_dir_all(&inner).unwrap();
    fs::create_dir(work.path().join("outside")).unwrap();
    let long = "µ".repeat(3000);
    let names: Vec<&str> = HOSTILE.into_iter().chain([&*long, "a b", "a/b", "a:b"]).collect();
    for (k, name) in names.iter().enumerate() {
        fs::write(inner.join(format!("{k:02}.toml")), format!("name = \"{name}\"\n{SLIDE}")).unwrap();
    }
    let before = contents(work.path()).len();
    let output = within(&inner, &["run", ".", "--out", "out", "--rrd", "--quiet"]);
    assert_eq!(code(&output), 0, "{}", said(&output));
    let mut files = 0;
    for entry in fs::read_dir(inner.join("out")).unwrap() {
        let entry = entry.unwrap();
        let name = entry.file_name().into_string().unwrap();
        assert!(entry.path().is_file() && !name.starts_with('.'), "{name}");
        assert!(name.chars().all(|c| c.is_alphanumeric() || "._-".contains(c)), "{name}");
        let kind = entry.path().extension().unwrap_or_default().to_owned();
        files += usize::from(kind == "parquet" || kind == "rrd");
    }
    assert_eq!(files, 2 * names.len());
    let others = contents(work.path()).iter().filter(|(path, _)| !path.starts_with(inner.join("out"))).count();
    assert_eq!(others, before, "nothing is written elsewhere");
    for (k, name) in names.iter().enumerate() {
        let (one, other) = (format!("{k:02}.toml"), format!("{:02}.toml", (k + 1) % names.len()));
        let out = format!("compare-{k}");
        let output = within(&inner, &["compare", &one, &other, "--out", &out]);
        // Two runs of the same: there is something to compare all the same.
        assert_eq!(code(&output), 0, "{name}: {}", said(&output));
        let mut left: Vec<_> =
            fs::read_dir(inner.join(&out)).unwrap().map(|entry| entry.unwrap().file_name()).collect();
        left.sort();
        assert_eq!(left.len(), 2, "{left:?}");
        fs::remove_dir_all(inner.join(out)).unwrap();
    }
    let others = contents(work.path()).iter().filter(|(path, _)| !path.starts_with(inner.join("out"))).count();
    assert_eq!(others, before, "nothing is written elsewhere");
}

#[test]
fn an_exported_fmu_is_beside_whoever_exports_it() {
    let work = tempfile::tempdir().unwrap();
    let inner = work.path().join("a/b/c");
    fs::create_dir_all(&inner).unwrap();
    for (k, name) in HOSTILE.iter().enumerate() {
        let text = format!("name = \"{name}\"\n{SLIDE}");
        fs::write(inner.join("a.toml"), text).unwrap();
        let output = within(&inner, &["fmu", "export", "a.toml"]);
        assert_eq!(code(&output), 0, "{}", said(&output));
        let files = contents(work.path());
        assert!(files.iter().all(|(path, _)| path.parent() == Some(&inner)), "{name}: {files:?}", files = files.len());
        assert!(files.len() <= k + 2);
    }
}

/// `results.json` may come from anywhere: what it names is beside it.
#[test]
fn view_opens_nothing_outside_the_folder() {
    let work = folder(&[("a.toml", SLIDE)]);
    let output = within(work.path(), &["run", "a.toml", "--out", "out/in", "--quiet"]);
    assert_eq!(code(&output), 0, "{}", said(&output));
    let results = work.path().join("out/in/results.json");
    let text = fs::read_to_string(&results).unwrap();
    for name in ["../a.exact.parquet", "/tmp/a.exact.parquet", "..", "", "in/../../a.exact.parquet"] {
        fs::copy(work.path().join("out/in/a.exact.parquet"), work.path().join("out/a.exact.parquet")).unwrap();
        let changed = text.replace("\"recording\": \"a.exact.parquet\"", &format!("\"recording\": \"{name}\""));
        assert_ne!(changed, text);
        fs::write(&results, changed).unwrap();
        let viewer = repository().join("tests/viewer");
        let list = work.path().join("viewed");
        let output =
            command(&["view", "out/in"]).current_dir(work.path()).env("PATH", viewer).env("VIEWED", &list).output();
        let output = output.unwrap();
        assert_eq!(code(&output), 2, "{name}: {}", said(&output));
        assert!(said(&output).contains("is no name of a file beside the results"), "{name}: {}", said(&output));
        assert!(!list.exists() && !work.path().join("out/a.exact.rrd").exists(), "{name}");
    }
}

/// Whoever may write into the folder of the results can plant links there: they are replaced, what they lead to stays.
#[test]
fn a_link_in_the_folder_is_replaced_and_not_followed() {
    let work = folder(&[("a.toml", SLIDE), ("victim", "victim"), ("b.toml", SLIDE), ("t.csv", TABLE)]);
    fs::create_dir(work.path().join("out")).unwrap();
    let plant = |name: &str| {
        let link = work.path().join(name);
        fs::remove_file(&link).ok();
        symlink(work.path().join("victim"), link).unwrap();
    };
    let is_whole = || assert_eq!(fs::read_to_string(work.path().join("victim")).unwrap(), "victim");
    // Results behind a link are those of a suite; anything else there is refused.
    let (results, list) = (work.path().join("results.json"), work.path().join("out/results.json"));
    let output = within(work.path(), &["run", "a.toml", "--out", "."]);
    assert_eq!(code(&output), 0, "{}", said(&output));
    let of_a_suite = fs::read(&results).unwrap();
    symlink(&results, &list).unwrap();
    let names = ["out/results.journal", "out/a.exact.parquet", "out/a.exact.rrd", "junit.xml"];
    for name in names {
        plant(name);
    }
    let arguments = ["run", "a.toml", "--out", "out", "--rrd", "--junit", "junit.xml"];
    let output = within(work.path(), &arguments);
    assert_eq!(code(&output), 0, "{}", said(&output));
    is_whole();
    assert!(names.iter().all(|name| !work.path().join(name).is_symlink()) && !list.is_symlink());
    assert_eq!(fs::read(&results).unwrap(), of_a_suite);
    for name in ["out/a-against-b.rrd", "plan.csv", "new.csv"] {
        plant(name);
    }
    let output = within(work.path(), &["compare", "a.toml", "b.toml", "--out", "out"]);
    assert_eq!(code(&output), 0, "{}", said(&output));
    let output = within(work.path(), &["plan", "pvt", "--points", "t.csv", "--csv", "plan.csv", "--pvt", "new.csv"]);
    assert_eq!(code(&output), 0, "{}", said(&output));
    is_whole();
    assert!(!work.path().join("out/a-against-b.rrd").is_symlink());
}

const PLAN: [&str; 11] = [
    "plan",
    "--order",
    "2",
    "--distance",
    "1 m",
    "--velocity",
    "1 m/s",
    "--acceleration",
    "1 m/s2",
    "--csv-step",
    "1 ms",
];

#[cfg(target_os = "linux")]
#[test]
fn devices_pipes_and_descriptors_are_written_as_they_are() {
    let work = tempfile::tempdir().unwrap();
    let table = || {
        let output = within(work.path(), &[&PLAN[..], &["--csv", "plan.csv"]].concat());
        assert_eq!(code(&output), 0, "{}", said(&output));
        fs::read_to_string(work.path().join("plan.csv")).unwrap()
    };
    let table = table();
    symlink("/dev/stdout", work.path().join("link")).unwrap();
    for name in ["/dev/stdout", "/dev/fd/1", "/proc/self/fd/1", "link"] {
        let arguments = [&PLAN[..], &["--csv", name, "--json"]].concat();
        let output = within(work.path(), &arguments);
        assert_eq!(code(&output), 0, "{}", said(&output));
        let out = String::from_utf8(output.stdout).unwrap();
        assert!(out.starts_with(&table) && out[table.len()..].starts_with('{'), "{name}: {out}");
        // A file that standard output is: the one after the other, none over the other.
        let both = File::create(work.path().join("both")).unwrap();
        let status = command(&arguments).current_dir(work.path()).stdout(both).status().unwrap();
        assert_eq!(status.code(), Some(0));
        assert_eq!(fs::read_to_string(work.path().join("both")).unwrap(), out, "{name}");
    }
    assert!(work.path().join("link").is_symlink());
    let output = within(work.path(), &[&PLAN[..], &["--csv", "/dev/stderr"]].concat());
    assert_eq!(String::from_utf8(output.stderr).unwrap(), table);
    let fifo = work.path().join("fifo");
    assert!(Command::new("mkfifo").arg(&fifo).status().unwrap().success());
    let reader = Command::new("cat").arg(&fifo).stdout(Stdio::piped()).spawn().unwrap();
    let output = within(work.path(), &[&PLAN[..], &["--csv", "fifo"]].concat());
    assert_eq!(code(&output), 0, "{}", said(&output));
    assert_eq!(String::from_utf8(reader.wait_with_output().unwrap().stdout).unwrap(), table);
    assert!(fs::metadata(&fifo).unwrap().file_type().is_fifo());
    // One that has had enough.
    let mut reader = Command::new("head").args(["-c", "10"]).arg(&fifo).stdout(Stdio::null()).spawn().unwrap();
    let fine = [&PLAN[..9], &["--csv-step", "1 us", "--csv", "fifo"]].concat();
    assert_eq!(code(&within(work.path(), &fine)), 0);
    reader.wait().unwrap();
    // Nobody is at its end: `--output -` and standard output stay what they were.
    let output = within(work.path(), &["objects", "-o", "-", "--format", "json"]);
    assert!(output.stdout.starts_with(b"["), "{}", said(&output));
}

/// What cannot be written is an error that names the file; nothing is half there, and what was there stays.
#[cfg(target_os = "linux")]
#[test]
fn what_cannot_be_written_is_named() {
    let is_whole = || fs::metadata("/dev/full").unwrap().file_type().is_char_device();
    assert!(is_whole(), "something else has replaced /dev/full; `mknod -m 666 /dev/full c 1 7` makes it anew");
    let work = folder(&[("a.toml", SLIDE), ("bus.toml", &on_a_bus(""))]);
    let fails = |arguments: &[&str], name: &str| {
        let output = within(work.path(), arguments);
        assert_eq!(code(&output), 3, "{arguments:?}: {}", said(&output));
        assert!(said(&output).contains(&format!("`{name}`")), "{arguments:?}: {}", said(&output));
    };
    for (name, arguments) in [
        ("/dev/full", &[&PLAN[..], &["--csv", "/dev/full"]].concat()[..]),
        ("/dev/full", &[&PLAN[..9], &["--svg", "/dev/full"]].concat()),
        ("/dev/full", &["objects", "bus.toml", "-o", "/dev/full"]),
        ("/dev/full", &["plc", "export", "-o", "/dev/full"]),
        ("/dev/full", &["fmu", "export", "a.toml", "-o", "/dev/full"]),
        ("/dev/full", &["run", "a.toml", "--out", "out", "--junit", "/dev/full"]),
        // Nobody makes a file there, not even root.
        ("/proc/x.csv", &[&PLAN[..], &["--csv", "/proc/x.csv"]].concat()),
        ("/proc/x.xml", &["run", "a.toml", "--out", "out", "--junit", "/proc/x.xml"]),
        ("/proc/out", &["run", "a.toml", "--out", "/proc/out"]),
        ("/proc/out", &["compare", "a.toml", "bus.toml", "--out", "/proc/out"]),
        ("/proc/out", &["man", "--out", "/proc/out"]),
        ("no/such/x.csv", &[&PLAN[..], &["--csv", "no/such/x.csv"]].concat()),
    ] {
        fails(arguments, name);
        assert!(is_whole(), "{arguments:?}");
    }
}

/// A limit of the size of files is what a full disk is, for whoever has no disk to fill.
#[cfg(target_os = "linux")]
#[test]
fn of_a_file_that_has_no_room_nothing_is_left() {
    let work = folder(&[("a.toml", SLIDE), ("plan.csv", "old"), ("junit.xml", "old")]);
    let limited = |blocks: &str, arguments: &[&str]| {
        let mut shell = Command::new("sh");
        shell.args(["-c", &format!("ulimit -f {blocks}; exec \"$0\" \"$@\""), env!("CARGO_BIN_EXE_servobench")]);
        shell.args(arguments).current_dir(work.path()).output().unwrap()
    };
    let output = limited("8", &[&PLAN[..9], &["--csv-step", "100 us", "--csv", "plan.csv"]].concat());
    assert_eq!(code(&output), 3, "{}", said(&output));
    assert!(said(&output).contains("cannot write `plan.csv`"), "{}", said(&output));
    let output = limited("0", &["run", "a.toml", "--out", "out", "--junit", "junit.xml"]);
    assert_eq!(code(&output), 3, "{}", said(&output));
    let output = limited("8", &["run", "a.toml", "--out", "other", "--junit", "junit.xml"]);
    assert_eq!(code(&output), 3, "{}", said(&output));
    assert!(said(&output).contains("a.exact.parquet"), "{}", said(&output));
    assert_eq!(fs::read_to_string(work.path().join("plan.csv")).unwrap(), "old");
    for (path, content) in contents(work.path()) {
        let name = path.file_name().unwrap().to_str().unwrap();
        assert!(!name.ends_with(".partial") && !name.ends_with(".parquet"), "{name}");
        if name == "results.json" {
            serde_json::from_slice::<serde_json::Value>(&content).unwrap();
        }
    }
    assert_eq!(code(&servobench(&["schema"])), 0);
}

/// A channel of 150 s at 4 kHz does not stay in memory: it needs a file, and 5 MB in it.
#[cfg(target_os = "linux")]
#[test]
fn a_recording_that_has_no_room_ends_its_run_and_is_kept_up_to_there() {
    let long = SLIDE.replace("duration = \"0.4 s\"", "duration = \"150 s\"")
        + "[record]\nchannels = [\"load.position\", \"motor.position\"]\n";
    let work = folder(&[("long.toml", &long)]);
    let error_of = |out: &str| {
        let results = fs::read(work.path().join(out).join("results.json")).unwrap();
        let results: serde_json::Value = serde_json::from_slice(&results).unwrap();
        let run = &results["scenarios"][0];
        assert_eq!(run["verdict"], "error", "{run}");
        run["reasons"][0].as_str().unwrap().to_owned()
    };
    // Nowhere: the first block of a channel finds no file.
    let nowhere = command(&["run", "long.toml", "--out", "nowhere"])
        .current_dir(work.path())
        .env("TMPDIR", "/dev/null/none")
        .output()
        .unwrap();
    assert_eq!(code(&nowhere), 3, "{}", said(&nowhere));
    let error = error_of("nowhere");
    for words in ["the recording cannot be kept", "`/dev/null/none`", "by TMPDIR"] {
        assert!(error.contains(words), "{error}");
    }
    // Too little room: 2 MB at least, 4 MB at most, as shells count blocks.
    let line = "ulimit -f 4096; exec \"$0\" run long.toml --out little";
    let little = Command::new("sh")
        .args(["-c", line, env!("CARGO_BIN_EXE_servobench")])
        .env("TMPDIR", work.path())
        .current_dir(work.path())
        .output()
        .unwrap();
    assert_eq!(code(&little), 3, "{}", said(&little));
    assert!(error_of("little").contains("the recording cannot be kept"), "{}", error_of("little"));
    let kept = servobench_trace::Recording::read_parquet(work.path().join("little/long.exact.parquet")).unwrap();
    assert!((200_000..525_000).contains(&kept.len()), "{}", kept.len());
    // Nothing else is left in the folder for it, and with room it ends well.
    let mut left: Vec<_> = fs::read_dir(work.path()).unwrap().map(|entry| entry.unwrap().file_name()).collect();
    left.sort();
    assert_eq!(left, ["little", "long.toml", "nowhere"]);
    let output = within(work.path(), &["run", "long.toml", "--out", "room"]);
    assert_eq!(code(&output), 0, "{}", said(&output));
}
