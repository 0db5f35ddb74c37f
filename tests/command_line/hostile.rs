//! Files by somebody else that want what is not theirs: other files, time without end, memory without end.
use crate::{SLIDE, code, command, folder, json, repository, said, servobench};
use std::fs;
use std::os::unix::fs::symlink;
use std::path::Path;
use std::process::{Command, Output};

/// A scenario that follows a table.
fn follows(table: &str) -> String {
    let program = "[[program]]\nmove_to = \"50 mm\"\n";
    assert!(SLIDE.contains(program));
    SLIDE.replace(program, &format!("[[program]]\ntable = {{ file = \"{table}\" }}\n"))
}

/// A scenario whose mechanics are in an MJCF file.
fn of_mjcf(engine: &str, file: &str) -> String {
    let body = "[axis.motor_side]\nmass = \"20 kg\"\n";
    let text = format!(
        "engine = [\"{engine}\"]\n{SLIDE}[drive.estimate]\nmotor_inertia = \"20 kg\"\nload_inertia = \"10 kg\"\nstiffness = \"6e5 N/m\"\n\
         motor_viscous = \"0 N s/m\"\nload_viscous = \"0 N s/m\"\n"
    );
    assert!(text.contains(body));
    text.replace(
        body,
        &format!(
            "[axis.mjcf]\nfile = \"{file}\"\nmotor_joint = \"carriage\"\nload_joint = \"load\"\nactuator = \"force\"\n"
        ),
    )
}

/// `check` of a file, with a secret in its environment. One that waits would not come back.
fn checked(file: &Path) -> Output {
    command(&["check", file.to_str().unwrap()]).env("TOKEN", "ghp_0123456789abcdefghij").output().unwrap()
}

fn refused(file: &Path, words: &[&str]) {
    let output = checked(file);
    assert_eq!(code(&output), 2, "{}", said(&output));
    let said = said(&output).split_whitespace().collect::<Vec<_>>().join(" ");
    for word in words {
        assert!(said.contains(word), "{word}: {said}");
    }
}

/// What is printed of a file that is none of the scenario's business, whatever it is named as.
#[test]
fn no_file_outside_of_the_project_is_read_or_shown() {
    let work = folder(&[("secret.csv", "time [s],position [m]\n0,0\n1,1\n")]);
    let project = work.path().join("project");
    fs::create_dir_all(project.join(".git")).unwrap();
    let write = |name: &str, text: &str| {
        let path = project.join(name);
        fs::write(&path, text).unwrap();
        path
    };
    symlink("/proc/self/environ", project.join("link")).unwrap();
    symlink("../secret.csv", project.join("inner.csv")).unwrap();
    for name in ["/etc/passwd", "/proc/self/environ", "link", "../secret.csv", "inner.csv", "../nothing"] {
        let path = write("table.toml", &follows(name));
        let output = checked(&path);
        let said = said(&output);
        assert_eq!(code(&output), 2, "{name}: {said}");
        assert!(said.contains("outside of the root") && said.contains("--root"), "{name}: {said}");
        assert!(!said.contains("ghp_") && !said.contains("root:"), "{name}: {said}");
        for engine in ["rapier", "mujoco"] {
            refused(&write("mjcf.toml", &of_mjcf(engine, name)), &["outside of the root"]);
        }
        let fmu = format!("{SLIDE}[[fmu]]\nfile = \"{name}\"\nname = \"other\"\n");
        refused(&write("fmu.toml", &fmu), &["outside of the root"]);
    }
    // What both are in is allowed by the one who calls.
    let path = write("table.toml", &follows("../secret.csv"));
    let output = servobench(&["check", path.to_str().unwrap(), "--root", work.path().to_str().unwrap()]);
    assert_eq!(code(&output), 0, "{}", said(&output));
    let output = servobench(&["check", path.to_str().unwrap(), "--root", project.join("nothing").to_str().unwrap()]);
    assert_eq!(code(&output), 2, "{}", said(&output));
}

/// Found by a search of folders.
#[test]
fn a_scenario_that_is_a_link_to_something_else_is_not_shown() {
    let work = folder(&[]);
    let project = work.path().join("project");
    fs::create_dir_all(&project).unwrap();
    fs::write(work.path().join("other"), "token = \"ghp_0123456789abcdefghij\"\n").unwrap();
    symlink("../other", project.join("a.toml")).unwrap();
    let output = checked(&project);
    let said = said(&output);
    assert_eq!(code(&output), 2, "{said}");
    assert!(said.contains("outside of the root") && !said.contains("ghp_"), "{said}");
}

/// Within the project, too, any file may be named.
#[test]
fn of_a_file_that_is_named_a_few_characters_are_quoted() {
    let secret = "AWS_SECRET_ACCESS_KEY=ghp_0123456789abcdefghij";
    let work = folder(&[(".env", &format!("{secret}\nOTHER=1\n")), ("table.toml", &follows(".env"))]);
    let path = |name: &str| work.path().join(name);
    fs::create_dir_all(path("models/motors")).unwrap();
    symlink("../../.env", path("models/motors/env.toml")).unwrap();
    fs::write(path("model.toml"), SLIDE.replace("kind = \"ideal-source\"", "model = \"env\"")).unwrap();
    fs::write(path("rapier.toml"), of_mjcf("rapier", ".env")).unwrap();
    fs::write(path("mujoco.toml"), of_mjcf("mujoco", ".env")).unwrap();
    fs::write(path("fmu.toml"), format!("{SLIDE}[[fmu]]\nfile = \".env\"\nname = \"other\"\n")).unwrap();
    for name in ["table.toml", "model.toml", "rapier.toml", "mujoco.toml", "fmu.toml"] {
        let output = checked(&path(name));
        let said = said(&output);
        assert_eq!(code(&output), 2, "{name}: {said}");
        assert!(!said.contains("ghp_") && !said.contains("AWS_SECRET_ACC"), "{name}: {said}");
    }
    let recording = path("a.parquet");
    fs::copy(path(".env"), &recording).unwrap();
    fs::copy(path(".env"), path("results.json")).unwrap();
    for arguments in [["timing", recording.to_str().unwrap()], ["fmu", "info"], ["view", work.path().to_str().unwrap()]]
    {
        let mut arguments = arguments.to_vec();
        if arguments[1] == "info" {
            arguments.push(recording.to_str().unwrap());
        }
        let output = servobench(&arguments);
        let said = said(&output);
        assert!(matches!(code(&output), 2 | 3) && !said.contains("ghp_"), "{arguments:?}: {said}");
    }
}

#[test]
fn what_an_mjcf_file_names_stays_in_the_project_too() {
    let body = "<worldbody><body><joint name='carriage' type='slide'/><geom type='mesh' mesh='m'/></body></worldbody>";
    let with = |inner: &str| format!("<mujoco>{inner}{body}</mujoco>");
    let work = folder(&[]);
    let project = work.path().join("project");
    fs::create_dir_all(project.join("meshes")).unwrap();
    fs::write(work.path().join("secret"), "solid\nendsolid\n").unwrap();
    fs::write(project.join("a.toml"), of_mjcf("mujoco", "a.xml")).unwrap();
    symlink("../../secret", project.join("meshes/link.stl")).unwrap();
    for inner in [
        "<asset><mesh name='m' file='/etc/passwd'/></asset>",
        "<asset><mesh name='m' file='../secret'/></asset>",
        "<compiler meshdir='meshes'/><asset><mesh name='m' file='link.stl'/></asset>",
        "<compiler assetdir='/etc'/><asset><texture type='cube' fileright='passwd'/></asset>",
        "<include file='../secret'/>",
        "<asset><model name='m' file='/etc/passwd'/></asset>",
    ] {
        fs::write(project.join("a.xml"), with(inner)).unwrap();
        refused(&project.join("a.toml"), &["outside of the root"]);
    }
    // One that is included names it.
    fs::write(project.join("b.xml"), "<mujoco><asset><mesh name='m' file='../secret'/></asset></mujoco>").unwrap();
    fs::write(project.join("a.xml"), with("<include file='b.xml'/>")).unwrap();
    refused(&project.join("a.toml"), &["outside of the root"]);
    let fifo = project.join("meshes/fifo.stl");
    assert!(Command::new("mkfifo").arg(&fifo).status().unwrap().success());
    fs::write(project.join("a.xml"), with("<asset><mesh name='m' file='meshes/fifo.stl'/></asset>")).unwrap();
    refused(&project.join("a.toml"), &["is a FIFO"]);
}

#[test]
fn what_is_no_regular_file_is_refused_at_once() {
    let work = folder(&[]);
    let path = |name: &str| work.path().join(name);
    assert!(Command::new("mkfifo").arg(path("fifo.toml")).status().unwrap().success());
    fs::create_dir(path("folder.csv")).unwrap();
    refused(&path("fifo.toml"), &["it is a FIFO, and no file"]);
    for (name, words) in [("fifo.toml", "is a FIFO"), ("folder.csv", "is a folder")] {
        fs::write(path("a.toml"), follows(name)).unwrap();
        refused(&path("a.toml"), &[words]);
        fs::write(path("a.toml"), of_mjcf("rapier", name)).unwrap();
        refused(&path("a.toml"), &[words]);
        fs::write(path("a.toml"), format!("{SLIDE}[[fmu]]\nfile = \"{name}\"\nname = \"other\"\n")).unwrap();
        refused(&path("a.toml"), &[words]);
    }
    fs::create_dir_all(path("models/motors")).unwrap();
    assert!(Command::new("mkfifo").arg(path("models/motors/m.toml")).status().unwrap().success());
    fs::write(path("a.toml"), SLIDE.replace("kind = \"ideal-source\"", "model = \"m\"")).unwrap();
    refused(&path("a.toml"), &["is a FIFO"]);
    // Recordings, results, journals, FMUs.
    let fifo = path("fifo.toml");
    for arguments in [vec!["timing"], vec!["fmu", "info"]] {
        let output = servobench(&[arguments, vec![fifo.to_str().unwrap()]].concat());
        assert!(code(&output) == 2 && said(&output).contains("FIFO"), "{}", said(&output));
    }
    for name in ["results.json", "results.journal"] {
        let out = path(&format!("{name}.out"));
        fs::create_dir(&out).unwrap();
        assert!(Command::new("mkfifo").arg(out.join(name)).status().unwrap().success());
        let output = servobench(&["run", "--resume", out.to_str().unwrap()]);
        assert!(matches!(code(&output), 2 | 3), "{name}: {}", said(&output));
    }
}

/// Two links to the folder itself, one to a folder outside, and one to nothing.
#[test]
fn links_in_a_folder_lead_neither_in_circles_nor_out_of_it() {
    let work = folder(&[]);
    let suite = work.path().join("suite");
    fs::create_dir_all(&suite).unwrap();
    fs::create_dir_all(work.path().join("outside")).unwrap();
    for folder in ["suite", "outside"] {
        fs::write(work.path().join(folder).join("a.toml"), SLIDE).unwrap();
    }
    symlink(".", suite.join("x")).unwrap();
    symlink(".", suite.join("y")).unwrap();
    symlink("../outside", suite.join("z")).unwrap();
    let output = checked(&suite);
    let words = said(&output);
    assert_eq!(code(&output), 0, "{words}");
    assert!(words.contains("1 scenario is valid") && words.contains("is not searched"), "{words}");
    symlink("nothing", suite.join("broken.toml")).unwrap();
    let out = work.path().join("out");
    let output = servobench(&["run", suite.to_str().unwrap(), "--out", out.to_str().unwrap()]);
    assert_eq!(code(&output), 2, "{}", said(&output));
    let results = json(&fs::read(out.join("results.json")).unwrap());
    let verdicts: Vec<_> = results["scenarios"].as_array().unwrap().iter().map(|run| run["verdict"].clone()).collect();
    assert_eq!(verdicts, ["unjudged", "invalid"]);
}

#[test]
fn a_run_of_too_many_ticks_is_invalid() {
    let endless = SLIDE
        .replace("base_rate = \"4 kHz\"", "base_rate = \"1 MHz\"")
        .replace("duration = \"0.4 s\"", "duration = \"1e6 s\"")
        + "[record]\nrate = \"1 Hz\"\n";
    let work = folder(&[("endless.toml", &endless)]);
    refused(&work.path().join("endless.toml"), &["1000000000001 ticks", "10000000000", "to 10000 s"]);
    let out = work.path().join("out");
    let output = servobench(&["run", work.path().to_str().unwrap(), "--out", out.to_str().unwrap()]);
    assert!(code(&output) == 2 && said(&output).contains("ticks"), "{}", said(&output));
}

/// Which file the values of a model come from is said, warned of where it displaces a built-in one, and noted with its digest.
#[test]
fn what_a_scenario_is_made_of_is_said() {
    let text = follows("points.csv").replace("kind = \"ideal-source\"", "model = \"emps\"");
    let work = folder(&[("a.toml", &text), ("points.csv", "time [s],position [m]\n0,0\n0.1,0.01\n0.2,0.01\n")]);
    let path = work.path().join("a.toml");
    let output = checked(&path);
    assert_eq!(code(&output), 0, "{}", said(&output));
    assert!(said(&output).contains("motor <embedded>/models/motors/emps.toml"), "{}", said(&output));
    let own = fs::read_to_string("../../models/motors/emps.toml").unwrap() + "# changed\n";
    fs::create_dir_all(work.path().join("models/motors")).unwrap();
    fs::write(work.path().join("models/motors/emps.toml"), own).unwrap();
    let output = checked(&path);
    let words = said(&output).split_whitespace().collect::<Vec<_>>().join(" ");
    assert!(words.contains("motor models/motors/emps.toml"), "{words}");
    assert!(words.contains("differs from it"), "{words}");
    let run = |folder: &Path, out: &str| {
        let out = work.path().join(out);
        let output = servobench(&["run", folder.join("a.toml").to_str().unwrap(), "--out", out.to_str().unwrap()]);
        assert_eq!(code(&output), 0, "{}", said(&output));
        json(&fs::read(out.join("results.json")).unwrap())["scenarios"][0].clone()
    };
    let first = run(work.path(), "out");
    let made_of: Vec<_> =
        first["made_of"].as_array().unwrap().iter().map(|file| (file["role"].clone(), file["path"].clone())).collect();
    let expected = [("scenario", "a.toml"), ("motor-model", "models/motors/emps.toml"), ("table", "points.csv")];
    assert_eq!(made_of, expected.map(|(role, path)| (role.into(), path.into())));
    // Elsewhere they are the same; with another table they are not.
    let elsewhere = folder(&[]);
    let copied = Command::new("cp").arg("-r").arg(work.path().join(".")).arg(elsewhere.path()).status().unwrap();
    assert!(copied.success());
    assert_eq!(run(elsewhere.path(), "again")["inputs"], first["inputs"]);
    fs::write(elsewhere.path().join("points.csv"), "time [s],position [m]\n0,0\n0.1,0.01\n0.3,0.01\n").unwrap();
    assert_ne!(run(elsewhere.path(), "other")["inputs"], first["inputs"]);
}

/// Each would take minutes, gigabytes or the stack if it were read like any other.
#[test]
fn large_files_are_refused_before_they_cost_much() {
    let million = 1_000_000;
    let work = folder(&[
        ("keys.toml", &(0..million).map(|k| format!("k{k} = 1\n")).collect::<Vec<_>>().concat()),
        ("lines.toml", &"x y = 1\n".repeat(million)),
        ("few.toml", &(0..20_000).map(|k| format!("unknown_key_{k} = {k}\n")).collect::<Vec<_>>().concat()),
        ("long.toml", &format!("{SLIDE}[run]\nbase_rate = \"{}\"\n", "9".repeat(10 * million))),
        ("deep.xml", &format!("<mujoco><worldbody>{}</worldbody></mujoco>", "<body>".repeat(million))),
        ("wide.xml", &format!("<mujoco>{}</mujoco>", "<a b='c'/>".repeat(250_000))),
        (
            "attributes.xml",
            &format!("<mujoco {}/>", (0..million).map(|k| format!("a{k}='' ")).collect::<Vec<_>>().concat()),
        ),
    ]);
    let path = |name: &str| work.path().join(name);
    for name in ["keys.toml", "lines.toml", "few.toml", "long.toml"] {
        refused(&path(name), &[name]);
    }
    for name in ["deep.xml", "wide.xml", "attributes.xml"] {
        fs::write(path("mjcf.toml"), of_mjcf("rapier", name)).unwrap();
        refused(&path("mjcf.toml"), &[name]);
    }
}

/// Ten thousand moves, each with a limit of its own.
#[test]
fn a_long_program_is_checked_in_no_time() {
    let step = "[[program]]\nmove_by = \"1 um\"\nlimits.move_time = \"1 s\"\n".repeat(10_000);
    let text = SLIDE.replace("duration = \"0.4 s\"\n", "").replace("[[program]]\nmove_to = \"50 mm\"\n", &step);
    let work = folder(&[("long.toml", &text)]);
    let output = checked(&work.path().join("long.toml"));
    assert!(code(&output) == 0 && said(&output).contains("10000 moves"), "{}", said(&output));
}

/// Files that once steered a terminal, forged a line for a runner of continuous integration, wrote beside their folder, or were read to
/// the end: what a command prints of each is fit for a terminal, and what it writes is in its folder.
#[test]
fn files_that_did_harm_do_none_any_more() {
    for (name, exit) in
        [("escape", 0), ("ci-injection", 4), ("traverse1", 0), ("traverse2", 0), ("leak", 2), ("endless", 2)]
    {
        let work = folder(&[]);
        let file = repository().join("tests/hostile").join(format!("{name}.toml"));
        let out = work.path().join("out");
        for quiet in [&["--quiet"][..], &[]] {
            let output = command(&["run"]).arg(&file).arg("--out").arg(&out).args(quiet).output().unwrap();
            assert_eq!(code(&output), exit, "{name}: {}", said(&output));
            let text = said(&output);
            let steers = |c: char| c.is_control() && c != '\n';
            assert!(!text.contains(steers), "{name}: {text:?}");
            assert!(!text.lines().any(|line| line.trim_start().starts_with("::")), "{name}: {text}");
            assert!(!text.contains("root:x"), "{name}: {text}");
        }
        let outside: Vec<_> = fs::read_dir(work.path()).unwrap().map(|entry| entry.unwrap().file_name()).collect();
        assert!(outside.iter().all(|name| name == "out"), "{name}: {outside:?}");
    }
}
