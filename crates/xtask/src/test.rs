//! `cargo xtask test`: everything that CI runs, in order, up to the first failure.
use crate::bare_metal::BareMetal;
use crate::drill::verdicts;
use crate::failure::Failure;
use crate::outside::Outside;
use crate::systems::Systems;
use crate::wheel;
use crate::workspace::{Workspace, run as run_command, shown};
use std::collections::BTreeSet;
use std::ffi::OsStr;
use std::fs;
use std::process::{Command, Stdio};
use std::time::Instant;

/// Engines that are built and tested.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Engines {
    /// All, with those that need a foreign library.
    All,
    /// Only those without a foreign library.
    Embedded,
}

/// Scenarios and suites that the finished binary runs: arguments and expected exit code. Each writes into a separate folder, see
/// [`scenarios`].
const SCENARIOS: [(&[&str], i32); 4] = [
    (&["run", "scenarios/", "--quiet"], 0),
    (&["run", WITH_FMUS, "--quiet"], 0),
    (&["run", "tests/peers/", "--quiet"], 0),
    (&["run", "tests/scenarios/", "--quiet"], 4),
];

/// The same for a build without MuJoCo, which some scenarios name: the demo runs on the available engines.
const EMBEDDED_SCENARIOS: [(&[&str], i32); 4] = [
    (&["run", "--quiet"], 0),
    (&["run", WITH_FMUS, "--quiet"], 0),
    (&["run", "tests/peers/", "--quiet"], 0),
    (&["run", "tests/scenarios/", "--quiet"], 4),
];

/// Scenarios whose FMUs are made before, by the commands of the program in the comment at each head.
const WITH_FMUS: &str = "scenarios-fmu";
/// Beginning of such a command in a scenario.
const COMMAND: &str = "#     servobench ";

/// One step.
struct Step {
    name: &'static str,
    command: Command,
    /// Expected exit code.
    expected: i32,
}

impl Step {
    fn new(name: &'static str, command: Command) -> Self {
        Self { name, command, expected: 0 }
    }
}

/// Sets up, then runs every step.
///
/// # Errors
/// [`Failure::Fetch`] when the library of an engine cannot be fetched, [`Failure::Steps`] when a step fails.
pub(crate) fn run(workspace: &Workspace, engines: Engines) -> Result<(), Failure> {
    if engines == Engines::All {
        wheel::MUJOCO.ensure(workspace)?;
    }
    let (bare_metal, systems, outside) =
        (BareMetal::prepare(), Systems::prepare(workspace), Outside::prepare(workspace));
    let mut steps = steps(workspace, engines)?;
    steps.extend(bare_metal.command(workspace).map(|command| Step::new("bare metal", command)));
    steps.extend(systems.commands(workspace)?.into_iter().map(|(name, command)| Step::new(name, command)));
    steps.extend(twins(&outside, workspace, engines));
    steps.extend(outside_clients(&outside, workspace));
    let report = || {
        bare_metal.report();
        systems.report();
        outside.report();
    };
    report();
    run_steps(steps)?;
    // Repeated at the end, where it is not scrolled away.
    report();
    Ok(())
}

/// Runs the outside clients alone.
///
/// # Errors
/// [`Failure::Fetch`] when their packages cannot be fetched, [`Failure::Steps`] when one fails.
pub(crate) fn run_outside(workspace: &Workspace) -> Result<(), Failure> {
    let outside = Outside::prepare(workspace);
    outside.report();
    run_steps(outside_clients(&outside, workspace).collect())?;
    outside.failure().map_or(Ok(()), Err)
}

fn outside_clients(outside: &Outside, workspace: &Workspace) -> impl Iterator<Item = Step> + use<> {
    outside.commands(workspace).into_iter().map(|command| Step::new("outside clients", command))
}

/// Verdicts on sabotaged twins: the example that runs them, and the pairs. Left out without a Python for the outside clients.
fn twins(outside: &Outside, workspace: &Workspace, engines: Engines) -> Vec<Step> {
    let Some(python) = outside.common() else { return Vec::new() };
    let build = on_all_crates(workspace, engines, &["build", "--example", "twin"]);
    let [pairs, cables] = verdicts::tested(workspace, &python, engines == Engines::All);
    vec![
        Step::new("build of twins", build),
        Step::new("verdicts on twins", pairs),
        Step::new("verdicts on wrong cables", cables),
    ]
}

/// A command of Cargo for the whole workspace. Always in release: the binary, the tests and the documentation share compiled crates.
fn on_all_crates(workspace: &Workspace, engines: Engines, subcommand: &[&str]) -> Command {
    let mut command = workspace.cargo(subcommand);
    command.args(["--release", "--workspace"]);
    command.args(match engines {
        Engines::All => ["--features", "servobench-cli/mujoco,servobench-tests/mujoco"],
        Engines::Embedded => ["--exclude", "servobench-engine-mujoco"],
    });
    command
}

fn steps(workspace: &Workspace, engines: Engines) -> Result<Vec<Step>, Failure> {
    let cargo = |subcommand: &[&str]| on_all_crates(workspace, engines, subcommand);
    let itself = std::env::current_exe().map_err(Failure::file("find", "xtask"))?;
    let mut lints = cargo(&["clippy", "--all-targets"]);
    lints.args(["--", "-D", "warnings"]);
    let mut documentation = cargo(&["doc", "--no-deps"]);
    documentation.env("RUSTDOCFLAGS", "-D warnings");
    let tests: &[&str] = if has_nextest(workspace) {
        &["nextest", "run", "--no-fail-fast"]
    } else {
        &["test", "--no-fail-fast", "--lib", "--bins", "--tests"]
    };
    let mut steps = vec![
        Step::new("format", workspace.cargo(["fmt", "--all", "--check"])),
        Step::new("checks", workspace.command(itself, ["checks"])),
        Step::new("lints", lints),
        // Builds the program too, which the scenarios run. A separate build step would choose other features for some dependencies, without
        // those of the tests, and compile Rerun twice.
        Step::new("tests", cargo(tests)),
        Step::new("documentation tests", cargo(&["test", "--doc"])),
        Step::new("documentation", documentation),
    ];
    steps.extend(exports(workspace)?);
    steps.extend(scenarios(workspace, engines));
    Ok(steps)
}

/// The commands at the heads of the scenarios with FMUs, as a user would type them.
fn exports(workspace: &Workspace) -> Result<Vec<Step>, Failure> {
    let folder = workspace.root.join(WITH_FMUS);
    let unreadable = || Failure::file("read", &folder);
    let mut commands = BTreeSet::new();
    for entry in fs::read_dir(&folder).map_err(unreadable())? {
        let path = entry.map_err(unreadable())?.path();
        if path.extension() == Some(OsStr::new("toml")) {
            let text = fs::read_to_string(&path).map_err(Failure::file("read", &path))?;
            commands.extend(text.lines().filter_map(|line| line.strip_prefix(COMMAND)).map(str::to_owned));
        }
    }
    let step = |command: &String| Step::new("FMUs of scenarios", workspace.servobench(command.split_whitespace()));
    Ok(commands.iter().map(step).collect())
}

/// The scenarios and suites, each writing into `<target>/scenarios/<number>`.
fn scenarios(workspace: &Workspace, engines: Engines) -> impl Iterator<Item = Step> {
    let all = match engines {
        Engines::All => SCENARIOS,
        Engines::Embedded => EMBEDDED_SCENARIOS,
    };
    all.into_iter().enumerate().map(|(number, (arguments, expected))| {
        let mut command = workspace.servobench(arguments);
        command.arg("--out").arg(workspace.target.join("scenarios").join(number.to_string()));
        Step { name: "scenarios", command, expected }
    })
}

fn has_nextest(workspace: &Workspace) -> bool {
    let mut command = workspace.cargo(["nextest", "--version"]);
    command.stdout(Stdio::null()).stderr(Stdio::null());
    command.status().is_ok_and(|status| status.success())
}

fn run_steps(steps: Vec<Step>) -> Result<(), Failure> {
    let count = steps.len();
    let mut steps = steps.into_iter().enumerate();
    while let Some((passed, Step { name, mut command, expected })) = steps.next() {
        let place = format!("[{}/{count}] {name}", passed + 1);
        println!("{place}: {}", shown(&command));
        let start = Instant::now();
        let result = run_command(&mut command, expected);
        let seconds = start.elapsed().as_secs_f64();
        if let Err(failure) = result {
            println!("{place} failed after {seconds:.1} s: {failure}");
            let left: Vec<&str> = steps.map(|(_, step)| step.name).collect();
            if !left.is_empty() {
                println!("not run: {}", left.join(", "));
            }
            return Err(Failure::Steps { passed, not_run: left.len() });
        }
        println!("{place} passed in {seconds:.1} s");
    }
    println!("{count} passed, 0 failed");
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::path::Path;

    fn step(name: &'static str, program: &str) -> Step {
        Step::new(name, Command::new(program))
    }

    #[test]
    fn the_first_failure_ends_the_run_and_is_counted() {
        let steps = vec![step("a", "true"), step("b", "false"), step("c", "true"), step("d", "true")];
        let failure = run_steps(steps).unwrap_err();
        assert_eq!(failure.to_string(), "1 passed, 1 failed, 2 not run");
    }

    #[test]
    fn a_scenario_that_must_fail_has_to_end_with_its_exit_code() {
        let ends_with = |code| {
            let mut shell = Command::new("sh");
            shell.args(["-c", "exit 4"]);
            vec![Step { name: "limit", command: shell, expected: code }]
        };
        assert!(run_steps(ends_with(4)).is_ok());
        assert!(run_steps(ends_with(0)).is_err());
    }

    /// Command line of each step.
    fn commands(engines: Engines) -> Vec<String> {
        let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("../..");
        let here = Workspace { root, target: "target".into() };
        steps(&here, engines).unwrap().iter().map(|step| shown(&step.command)).collect()
    }

    /// A file that two scenarios share is made once, and before any of them runs.
    #[test]
    fn the_fmus_of_scenarios_are_made_before_they_run() {
        for engines in [Engines::All, Engines::Embedded] {
            let commands = commands(engines);
            let run = commands.iter().position(|command| command.starts_with("servobench run scenarios-fmu")).unwrap();
            let is_export = |command: &&String| command.starts_with("servobench fmu export scenarios/");
            let made: Vec<&String> = commands[..run].iter().filter(is_export).collect();
            assert_eq!(made.len(), commands.iter().filter(is_export).count(), "{commands:?}");
            assert!(made.len() >= 4 && made.is_sorted() && made.windows(2).all(|pair| pair[0] != pair[1]), "{made:?}");
        }
    }

    #[test]
    fn without_mujoco_no_step_names_its_feature() {
        for (engines, named) in [(Engines::All, true), (Engines::Embedded, false)] {
            let commands = commands(engines);
            assert_eq!(commands.iter().any(|c| c.contains("servobench-cli/mujoco,servobench-tests/mujoco")), named);
            assert_eq!(commands.iter().any(|c| c.contains("--exclude")), !named);
        }
    }
}
