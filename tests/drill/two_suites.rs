//! Two suites that are begun at once with one output folder.
use crate::count;
use crate::suite::{finished, slide};
use serde_json::Value;
use std::fs;
use std::path::Path;
use std::process::{Command, Stdio};

/// The first one passes, the second one fails; their runs have the same names. Each in a PID namespace of its own where the machine
/// allows it, so that both have the same numbers for their processes.
#[test]
fn two_suites_in_one_folder_never_have_a_verdict_of_each_other() {
    let work = tempfile::tempdir().unwrap();
    for (folder, limit) in [("passes", "1 m"), ("fails", "1 nm")] {
        fs::create_dir(work.path().join(folder)).unwrap();
        fs::write(work.path().join(folder).join("same.toml"), slide(&["exact", "rapier"], "0.6 s", limit)).unwrap();
    }
    let isolates = ["-p", "-f", "--mount-proc"];
    let probe = Command::new("unshare").args(isolates).arg("true").stderr(Stdio::null()).status();
    let isolated = probe.is_ok_and(|status| status.success());
    if !isolated {
        println!("SKIPPED: PID namespaces are not permitted here; the suites share that of the test");
    }
    let mut refused = 0;
    for pair in 0..count(6) {
        let out = work.path().join(format!("out{pair}"));
        let start = |folder: &str| {
            let program = env!("CARGO_BIN_EXE_servobench");
            let mut command = if isolated { Command::new("unshare") } else { Command::new(program) };
            if isolated {
                command.args(isolates).arg(program);
            }
            command.args(["run", folder, "--out"]).arg(&out).current_dir(work.path()).stdin(Stdio::null());
            command.stdout(Stdio::piped()).stderr(Stdio::piped()).spawn().unwrap()
        };
        let children = [start("passes"), start("fails")];
        let ends = children.map(|child| finished(child, &format!("pair {pair}")));
        for ((status, said), own) in ends.iter().zip([0, 4]) {
            assert!([Some(own), Some(3)].contains(&status.code()), "{status}: {said}");
            if status.code() == Some(3) {
                assert!(said.contains("another servobench writes into"), "{said}");
                refused += 1;
            }
        }
        let verdict = verdict_in(&out);
        let wrote = ends.iter().zip(["passed", "failed"]).filter(|((status, _), _)| status.code() != Some(3));
        // Where one ended before the other began, both have written, and the results are those of the second one.
        let possible: Vec<_> = wrote.map(|(_, verdict)| verdict).collect();
        assert!(possible.contains(&verdict.as_str()), "{verdict}, {possible:?}");
        fs::remove_dir_all(out).unwrap();
    }
    println!("{refused} of {} pairs: the second one was refused", count(6));
}

/// That of both runs, which is one; each has its recording.
fn verdict_in(out: &Path) -> String {
    let results: Value = serde_json::from_slice(&fs::read(out.join("results.json")).unwrap()).unwrap();
    assert_eq!(results["status"], "complete");
    let runs = results["scenarios"].as_array().unwrap();
    assert_eq!(runs.len(), 2);
    for run in runs {
        let (name, seal) = (run["recording"].as_str().unwrap(), run["recording_seal"].as_str());
        assert_eq!(servobench_trace::verified_seal_of(out.join(name)).unwrap().as_deref(), seal);
    }
    assert_eq!(runs[0]["verdict"], runs[1]["verdict"], "{results}");
    runs[0]["verdict"].as_str().unwrap().to_owned()
}
