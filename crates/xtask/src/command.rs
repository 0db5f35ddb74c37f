//! Selection of a command by the arguments.
use crate::failure::Failure;
use crate::workspace::Workspace;
use crate::{bench, checks, demo, dist, drill, peers, systems, test, wheel};

/// Every command: arguments and purpose.
const COMMANDS: [(&str, &str); 18] = [
    ("setup", "fetch the MuJoCo library, once"),
    ("demo", "build, run the demo, set up, build the rest and compare its two moves"),
    ("test [--without-mujoco]", "set up, then run every check and test that CI runs"),
    ("outside", "run the outside clients alone: what others wrote against ours"),
    ("bench [--json]", "measure a tick of the closed loop on every engine"),
    ("bench peers [--json]", "simulate one loop here and in simulators for Python, and compare the speeds"),
    ("drill faults", "end and starve 200 suites at random, and compare what --resume makes of them"),
    ("checks", "check dependency arrows, licences, text and the size of the program"),
    ("systems", "check that the program compiles for Windows and macOS"),
    ("viewer", "fetch the Rerun viewer that `servobench view` opens, once"),
    ("drill inputs", "hold the program against mutated files of every kind (SERVOBENCH_SWEEP: how many)"),
    ("drill many", "run suites of up to 20 000 runs (SERVOBENCH_SWEEP: how many), and say what each costs"),
    ("drill long", "run ten minutes and 1e8 ticks, and say what memory they take"),
    (
        "drill several",
        "compare and sweep axes of which one is bad (SERVOBENCH_SWEEP: how many), and read the conclusions",
    ),
    ("drill sweep", "sweep 20 000 runs (SERVOBENCH_SWEEP: how many), and say how fast and with what memory"),
    (
        "drill advise",
        "hold an advice against 20 000 set-points and fresh draws (SERVOBENCH_SWEEP: so many times fewer levels)",
    ),
    (
        "drill verdicts [--healthy | --proof | --cables]",
        "hold verdicts on 20 000 sabotaged machines, on healthy ones alone, that each rule is needed, or on wrong cables, \
         against an oracle (SERVOBENCH_SWEEP: how many)",
    ),
    ("dist", "pack binary, library, models and scenarios into one archive"),
];

/// Runs the command that `arguments` name.
///
/// # Errors
/// [`Failure::Usage`] for an unknown command, else the failure of the command.
pub(crate) fn run(arguments: &[String]) -> Result<(), Failure> {
    let arguments: Vec<&str> = arguments.iter().map(String::as_str).collect();
    match arguments.as_slice() {
        ["setup"] => {
            let library = wheel::MUJOCO.ensure(&Workspace::find()?)?;
            println!("{}", library.display());
            Ok(())
        }
        ["demo"] => demo::run(&Workspace::find()?),
        ["test"] => test::run(&Workspace::find()?, test::Engines::All),
        ["test", "--without-mujoco"] => test::run(&Workspace::find()?, test::Engines::Embedded),
        ["outside"] => test::run_outside(&Workspace::find()?),
        ["bench"] => bench::run(&Workspace::find()?, false),
        ["bench", "--json"] => bench::run(&Workspace::find()?, true),
        ["bench", "peers"] => peers::run(&Workspace::find()?, false),
        ["bench", "peers", "--json"] => peers::run(&Workspace::find()?, true),
        ["drill", "faults"] => drill::faults(&Workspace::find()?),
        ["systems"] => systems::check(&Workspace::find()?),
        ["checks"] => checks::run(&Workspace::find()?),
        ["viewer"] => {
            let viewer = wheel::RERUN.ensure(&Workspace::find()?)?;
            println!("{}", viewer.display());
            Ok(())
        }
        ["drill", "inputs"] => drill::inputs(&Workspace::find()?),
        ["drill", "many"] => drill::many(&Workspace::find()?),
        ["drill", "long"] => drill::long(&Workspace::find()?),
        ["drill", "sweep"] => drill::sweep(&Workspace::find()?),
        ["drill", "several"] => drill::several(&Workspace::find()?),
        ["drill", "advise"] => drill::advise(&Workspace::find()?),
        ["drill", "verdicts"] => drill::verdicts(&Workspace::find()?, drill::Verdicts::Pairs),
        ["drill", "verdicts", "--healthy"] => drill::verdicts(&Workspace::find()?, drill::Verdicts::Healthy),
        ["drill", "verdicts", "--proof"] => drill::verdicts(&Workspace::find()?, drill::Verdicts::Proof),
        ["drill", "verdicts", "--cables"] => drill::verdicts(&Workspace::find()?, drill::Verdicts::Cables),
        ["dist"] => dist::run(&Workspace::find()?),
        other => Err(Failure::Usage { given: other.join(" "), commands: listing() }),
    }
}

fn listing() -> String {
    COMMANDS.map(|(usage, meaning)| format!("  {usage:24} {meaning}")).join("\n")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn wrong_usage_lists_every_command() {
        for wrong in [vec![], vec!["tset".to_owned()], vec!["test".to_owned(), "--fast".to_owned()]] {
            let message = run(&wrong).unwrap_err().to_string();
            for (usage, _) in COMMANDS {
                assert!(message.contains(usage), "{message}");
            }
        }
    }
}
