//! Nothing is left behind.
use super::*;
use std::process::{Command, Stdio};

/// State of a process as `/proc` has it; `None` if there is none of that id.
fn state(pid: &str) -> Option<char> {
    let stat = std::fs::read_to_string(format!("/proc/{pid}/stat")).ok()?;
    stat.rsplit_once(") ")?.1.chars().next()
}

/// Ids of the processes that this thread group has started and not yet reaped.
fn children() -> Vec<String> {
    let tasks = std::fs::read_dir("/proc/self/task").unwrap();
    let of_task = |task: std::fs::DirEntry| std::fs::read_to_string(task.path().join("children")).unwrap_or_default();
    tasks.flat_map(|task| of_task(task.unwrap()).split_whitespace().map(String::from).collect::<Vec<_>>()).collect()
}

/// Waits until `done`, which comes: how long it takes is not what is tested. Less than the minute after which the harness of a
/// host complains of its length, and ends because nobody listens.
fn until(done: impl Fn() -> bool) {
    let call_timeout = std::time::Instant::now() + Duration::from_secs(30);
    while !done() {
        assert!(std::time::Instant::now() < call_timeout, "it does not come");
        std::thread::sleep(Duration::from_millis(1));
    }
}

/// In a process of its own, since other tests have children too.
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
        // How they end is tested elsewhere.
        slave.step(0.0, 0.1, &[[0.0; 3]]).ok();
        drop(slave);
        assert_eq!(children(), [""; 0], "{bad:?}");
    }
    start(&Bad::HangInLoading, impatient()).unwrap_err();
    start(&Bad::Refused("so".into()), impatient()).unwrap_err();
    assert_eq!(children(), [""; 0]);
}

/// It answers and is gone: on some turns it ends before its answer is looked at.
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
    let how = crash_of_step(&Bad::ForkThenCrash, Bounds::default());
    let pid = how.split("child ").nth(1).and_then(|rest| rest.split_whitespace().next()).unwrap().to_owned();
    // Whoever inherits it reaps it, or leaves it a zombie (Z), which is ended too.
    until(|| matches!(state(&pid), None | Some('Z' | 'X')));
}

/// A simulation that is killed takes its FMUs along.
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
    assert!(state(&pid).is_some());
    simulation.kill().unwrap();
    simulation.wait().unwrap();
    until(|| matches!(state(&pid), None | Some('Z' | 'X')));
}

/// Not a test: has an FMU that hangs, and says its id.
#[test]
#[ignore = "the process that another test starts"]
fn waits() {
    // Its call_timeout is longer than anybody's: what ends it is the end of this process.
    let mut slave = start(&Bad::Loop, Bounds::default()).unwrap();
    let [pid] = children().try_into().unwrap();
    println!("host of {pid}");
    assert!(slave.step(0.0, 0.1, &[[0.0; 3]]).is_err());
}
