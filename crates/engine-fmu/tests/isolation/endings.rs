//! Nothing is left behind by an FMU.
use super::*;
use std::process::{Command, Stdio};

/// State of a process according to `/proc`; `None` without a process of that id.
fn state(pid: &str) -> Option<char> {
    let stat = std::fs::read_to_string(format!("/proc/{pid}/stat")).ok()?;
    stat.rsplit_once(") ")?.1.chars().next()
}

/// Ids of the processes that this one has started and not yet reaped.
fn children() -> Vec<String> {
    children_of(&std::process::id().to_string())
}

/// The same of another process: the fourth word of its children's `stat` (proc_pid_stat(5)).
fn children_of(parent: &str) -> Vec<String> {
    let ids = std::fs::read_dir("/proc").unwrap().filter_map(|entry| entry.unwrap().file_name().into_string().ok());
    let is_child = |id: &String| {
        let stat = std::fs::read_to_string(format!("/proc/{id}/stat")).unwrap_or_default();
        stat.rsplit_once(") ").is_some_and(|(_, rest)| rest.split(' ').nth(1) == Some(parent))
    };
    ids.filter(is_child).collect()
}

/// Waits until `done`, which is certain: the time it takes is not tested. The limit is below the minute after which the test harness of a
/// host complains of its length, and ends for lack of a listener.
fn until(mut done: impl FnMut() -> bool) {
    let call_timeout = std::time::Instant::now() + Duration::from_secs(30);
    while !done() {
        assert!(std::time::Instant::now() < call_timeout, "it does not come");
        std::thread::sleep(Duration::from_millis(1));
    }
}

/// In a separate process, since other tests have children too.
#[test]
fn no_process_stays_behind() {
    let this = std::env::current_exe().unwrap();
    let output = Command::new(this).args(["--exact", "endings::lives", "--ignored", "--nocapture"]).output().unwrap();
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stdout));
}

/// Not a test: some FMUs live and die.
#[test]
#[ignore = "the process that another test starts"]
fn lives() {
    for bad in [Bad::Nothing, Bad::NullWrite, Bad::Exit(0), Bad::Loop, Bad::HangInEnd, Bad::Overwrite(0xff)] {
        let mut slave = start(&bad, impatient()).unwrap();
        assert_eq!(children().len(), 1);
        // Their end is tested elsewhere.
        slave.step(0.0, 0.1, &[[0.0; 3]]).ok();
        drop(slave);
        assert_eq!(children(), [""; 0], "{bad:?}");
    }
    start(&Bad::HangInLoading, impatient()).unwrap_err();
    start(&Bad::Refused("so".into()), impatient()).unwrap_err();
    assert_eq!(children(), [""; 0]);
}

/// An orderly end: on some turns the process has ended before its answer is read.
#[test]
fn an_orderly_end_is_no_crash() {
    for turn in 0..100 {
        let mut slave = start(&Bad::Nothing, Bounds::default()).unwrap();
        slave.step(0.0, 0.1, &[[0.0; 3]]).unwrap();
        slave.end();
        let said = slave.take_log();
        assert!(said.iter().all(|line| line.severity < Severity::Warning), "turn {turn}: {said:?}");
    }
    let mut slave = start(&Bad::HangInEnd, impatient()).unwrap();
    slave.end();
    let said = slave.take_log();
    assert!(said.iter().any(|line| line.severity == Severity::Warning), "{said:?}");
}

#[test]
fn what_it_has_started_ends_with_it() {
    for bad in [Bad::ForkThenCrash, Bad::DaemonThenCrash] {
        let how = crash_of_step(&bad, Bounds::default());
        assert_eq!(state(&started(&how)), None, "{bad:?}: {how}");
    }
}

/// The process that an FMU reports to have started.
fn started(says: &str) -> String {
    says.split("child ").nth(1).and_then(|rest| rest.split_whitespace().next()).unwrap().to_owned()
}

/// A process that has left group, session and parent is found all the same, and reported to the run.
#[test]
fn what_it_leaves_behind_is_ended_and_named() {
    let mut slave = start(&Bad::Daemon, Bounds::default()).unwrap();
    slave.step(0.0, 0.1, &[[0.0; 3]]).unwrap();
    let daemon = slave.take_log().iter().find(|line| line.message.starts_with("child ")).unwrap().message.clone();
    assert!(state(&started(&daemon)).is_some());
    slave.end();
    let said = slave.take_log();
    let warning = said.iter().find(|line| line.severity == Severity::Warning).unwrap();
    let (before, after) = ("its results are complete, but it left a process (`", "`), which was ended");
    assert!(warning.message.starts_with(before) && warning.message.ends_with(after), "{}", warning.message);
    assert_eq!(state(&started(&daemon)), None);
}

/// The bench, its keeper and other processes of the user are out of reach if the system gives the FMU a namespace.
#[test]
fn it_reaches_no_other_process() {
    // Possible for root, or for all others with a user namespace, which a test with its threads cannot have.
    if !Command::new("unshare").args(["--pid", "--fork", "true"]).status().is_ok_and(|status| status.success()) {
        eprintln!("skipped: it_reaches_no_other_process needs a PID namespace, which this system does not allow here");
        return;
    }
    let mut other = Command::new("sleep").arg("60").spawn().unwrap();
    let mut slave = start(&Bad::Kill(other.id().cast_signed()), Bounds::default()).unwrap();
    slave.step(0.0, 0.1, &[[0.0; 3]]).unwrap();
    slave.step(0.1, 0.1, &[[0.0; 3]]).unwrap();
    assert!(slave.take_log().iter().any(|line| line.message == "spared"));
    assert!(other.try_wait().unwrap().is_none());
    other.kill().unwrap();
    other.wait().unwrap();
}

/// Killing a simulation ends its FMUs.
#[test]
fn it_ends_with_the_simulation() {
    let this = std::env::current_exe().unwrap();
    let mut simulation = Command::new(this)
        .args(["--exact", "endings::waits", "--ignored", "--nocapture"])
        .stdin(Stdio::piped())
        .stdout(Stdio::piped())
        .spawn()
        .unwrap();
    let lines = std::io::BufRead::lines(std::io::BufReader::new(simulation.stdout.take().unwrap()));
    let pid = lines.map(Result::unwrap).find_map(|line| Some(line.split_once("host of ")?.1.to_owned())).unwrap();
    // The keeper, the first process of the namespace if there is one, and the host.
    let mut family = vec![pid];
    until(|| {
        family.truncate(1);
        while let Some(child) = children_of(family.last().unwrap()).pop() {
            family.push(child);
        }
        family.len() > 1
    });
    simulation.kill().unwrap();
    simulation.wait().unwrap();
    // The process that inherits the keeper reaps it, or leaves it a zombie (Z), which has ended too.
    until(|| family.iter().all(|pid| matches!(state(pid), None | Some('Z' | 'X'))));
}

/// Not a test: runs an FMU that hangs, and prints its id.
#[test]
#[ignore = "the process that another test starts"]
fn waits() {
    // Its call_timeout is very long: only the end of this process ends it.
    let mut slave = start(&Bad::Loop, Bounds::default()).unwrap();
    let [pid] = children().try_into().unwrap();
    println!("host of {pid}");
    assert!(slave.step(0.0, 0.1, &[[0.0; 3]]).is_err());
}
