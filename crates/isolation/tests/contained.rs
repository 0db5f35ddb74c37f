#![cfg(target_os = "linux")]
#![expect(unsafe_code, reason = "what foreign code does needs more than Rust lets happen")]
//! A contained process and all its child processes end as intended, whichever is killed first, and the end is reported.
//!
//! The contained process is this test program, with a task in an environment variable. Each test runs with and without a PID namespace,
//! where the system gives one.
use servobench_isolation::{Contained, Ending, Limits, Program, Stopwatch, contain};
use std::io::{BufRead, BufReader, Write};
use std::path::Path;
use std::process::{Command, Stdio};
use std::time::{Duration, Instant};

const DOES: &str = "ISOLATION_TEST_DOES";
const LONG: Duration = Duration::from_secs(30);

/// Not a test: the process that the others start. It prints its id and those of its child processes, as in `/proc`.
#[test]
#[ignore = "the process that the other tests start"]
fn contained() {
    // Somebody runs all tests that are ignored.
    if contain().is_err() {
        return;
    }
    say_own_id();
    match std::env::var(DOES).unwrap().as_str() {
        "end" => {}
        "fail" => std::process::exit(3),
        "crash" => std::process::abort(),
        "hang" => hang(),
        "daemon" => {
            daemon();
            // Until it has said its id.
            std::thread::sleep(Duration::from_millis(300));
        }
        "daemon and hang" => {
            daemon();
            hang();
        }
        "signal its group" => {
            // SAFETY: a system call.
            unsafe { libc::kill(0, libc::SIGKILL) };
        }
        "take memory" => {
            let much: Vec<Vec<u8>> = (0..10_000).map(|_| vec![1; 1 << 20]).collect();
            std::hint::black_box(much);
        }
        other => panic!("{other}"),
    }
    std::process::exit(0);
}

fn say_own_id() {
    let line = format!("id {}\n", std::fs::read_link("/proc/self").unwrap().display());
    // In one piece: the reader takes what is there.
    std::io::stderr().write_all(line.as_bytes()).unwrap();
}

fn hang() -> ! {
    loop {
        std::thread::sleep(Duration::from_hours(1));
    }
}

/// A process that leaves parent, group and session, and ignores all signals that request its end.
fn daemon() {
    // SAFETY: the only thread forks.
    unsafe {
        if libc::fork() == 0 {
            if libc::fork() == 0 {
                libc::setsid();
                for signal in [libc::SIGTERM, libc::SIGHUP, libc::SIGINT] {
                    libc::signal(signal, libc::SIG_IGN);
                }
                say_own_id();
                hang();
            }
            libc::_exit(0);
        }
    }
}

fn start(does: &str, limits: Limits) -> Contained {
    let args = ["--exact", "contained", "--ignored", "--nocapture"].map(Into::into).to_vec();
    let env = vec![(DOES.into(), does.into())];
    let program = Program { program: std::env::current_exe().unwrap(), args, env };
    Contained::start(&program, Stdio::null(), None, limits, || ()).unwrap()
}

/// With and without a namespace.
fn both() -> [Limits; 2] {
    [false, true].map(|is_foreign| Limits { memory: 300_000_000, is_foreign })
}

fn ending(does: &str, limits: Limits) -> Ending {
    let process = start(does, limits);
    process.wait_for_end(LONG);
    process.ending().unwrap().clone()
}

/// The ids that the processes have printed, once there are `count` of them.
fn ids(process: &Contained, count: usize) -> Vec<u32> {
    let (start, mut said) = (Instant::now(), String::new());
    loop {
        said += &process.output().stderr.take().unwrap_or_default().0;
        said.push('\n');
        let ids: Vec<u32> = said.lines().filter_map(|line| line.strip_prefix("id ")?.parse().ok()).collect();
        if ids.len() == count {
            return ids;
        }
        assert!(start.elapsed() < LONG, "{said}");
        std::thread::sleep(Duration::from_millis(5));
    }
}

/// Entry of a process in `/proc`: its state and its parent; `None` for one that has ended.
fn stat(id: u32) -> Option<(String, u32)> {
    let stat = std::fs::read_to_string(format!("/proc/{id}/stat")).ok()?;
    let mut words = stat.rsplit_once(") ")?.1.split(' ');
    let state = words.next()?.to_owned();
    Some((state, words.next()?.parse().ok()?)).filter(|(state, _)| !matches!(state.as_str(), "Z" | "X"))
}

fn wait_for_end_of(ids: &[u32]) {
    let start = Instant::now();
    while ids.iter().any(|id| stat(*id).is_some()) {
        assert!(start.elapsed() < LONG, "{:?}", ids.iter().map(|id| stat(*id)).collect::<Vec<_>>());
        std::thread::sleep(Duration::from_millis(5));
    }
}

#[test]
fn how_it_ended_is_said() {
    for limits in both() {
        let end = ending("end", limits);
        assert!(end.is_orderly() && end.left == 0 && end.process.is_some(), "{end:?}");
        assert_eq!(ending("fail", limits).status.and_then(|status| status.code()), Some(3));
        let how = ending("crash", limits).how();
        assert!(how.starts_with("signal 6 (SIGABRT"), "{how}");
        let how = ending("take memory", limits).how();
        assert!(how.starts_with("it asked for more memory than the 300 MB that it may have"), "{how}");
    }
}

#[test]
fn what_it_leaves_is_ended_and_named() {
    for limits in both() {
        let process = start("daemon", limits);
        let family = ids(&process, 2);
        process.wait_for_end(LONG);
        let end = process.ending().unwrap();
        assert!(end.is_orderly() && end.left == 1 && end.names.len() == 1, "{end:?}");
        assert!(family.iter().all(|id| stat(*id).is_none()), "{end:?}");
    }
}

#[test]
fn it_ends_when_it_is_to_with_all_that_it_has_started() {
    for limits in both() {
        let mut process = start("daemon and hang", limits);
        let family = ids(&process, 2);
        process.end();
        assert!(family.iter().all(|id| stat(*id).is_none()));
    }
}

/// A signal to its own group does not reach its keeper.
#[test]
fn its_group_is_its_own() {
    for limits in both() {
        let end = ending("signal its group", limits);
        assert!(end.how().starts_with("signal 9") && end.process.is_some(), "{end:?}");
    }
}

/// Its keeper is killed: the process ends with it. A mere request to end does not suffice.
#[test]
fn it_ends_with_its_keeper() {
    for limits in both() {
        let process = start("hang", limits);
        let family = ids(&process, 1);
        let mut keeper = stat(family[0]).unwrap().1;
        while let Some((_, above)) = stat(keeper).filter(|(_, above)| *above != std::process::id()) {
            keeper = above;
        }
        let send = |signal: &str| Command::new("kill").args([signal, &keeper.to_string()]).status().unwrap();
        assert!(send("-TERM").success() && send("-INT").success() && send("-HUP").success());
        process.wait_for_end(Duration::from_millis(300));
        assert!(process.ending().is_none() && family.iter().all(|id| stat(*id).is_some()));
        assert!(send("-KILL").success());
        process.wait_for_end(LONG);
        assert!(process.ending().unwrap().how().starts_with("signal 9"), "{:?}", process.ending());
        wait_for_end_of(&family);
    }
}

/// Its parent is killed, and cannot react any more.
#[test]
fn it_ends_with_who_has_started_it() {
    for kind in ["0", "1"] {
        let this = std::env::current_exe().unwrap();
        let mut bench = Command::new(this)
            .args(["--exact", "bench", "--ignored", "--nocapture"])
            .env("ISOLATION_TEST_KIND", kind)
            .stdout(Stdio::piped())
            .spawn()
            .unwrap();
        let lines = BufReader::new(bench.stdout.take().unwrap()).lines().map(Result::unwrap);
        let family: Vec<u32> = lines.filter_map(|line| line.split_once("family ")?.1.parse().ok()).take(2).collect();
        assert!(family.iter().all(|id| stat(*id).is_some()), "{family:?}");
        bench.kill().unwrap();
        bench.wait().unwrap();
        wait_for_end_of(&family);
    }
}

/// Not a test: has started something, and waits for its own end.
#[test]
#[ignore = "the process that another test starts"]
fn bench() {
    let Ok(kind) = std::env::var("ISOLATION_TEST_KIND") else { return };
    let process = start("daemon and hang", both()[usize::from(kind == "1")]);
    for id in ids(&process, 2) {
        println!("family {id}");
    }
    hang();
}

/// A process that is stopped does not see time pass.
#[test]
fn a_stopwatch_stands_still_while_its_process_does() {
    let this = std::env::current_exe().unwrap();
    let mut stopped = Command::new(this)
        .args(["--exact", "watches", "--ignored", "--nocapture"])
        .stdout(Stdio::piped())
        .stdin(Stdio::piped())
        .spawn()
        .unwrap();
    let mut lines = BufReader::new(stopped.stdout.take().unwrap()).lines().map(Result::unwrap);
    assert!(lines.any(|line| line.ends_with("begins")));
    let send = |signal: &str| Command::new("kill").args([signal, &stopped.id().to_string()]).status().unwrap();
    assert!(send("-STOP").success());
    std::thread::sleep(Duration::from_secs(3));
    assert!(send("-CONT").success());
    let elapsed: f64 = lines.find_map(|line| line.strip_prefix("elapsed ")?.parse().ok()).unwrap();
    stopped.wait().unwrap();
    // It takes 0.5 s where it runs; the three seconds are not among it.
    assert!((0.0..2.5).contains(&elapsed), "{elapsed} s");
}

/// Not a test: half a second, by its own clock.
#[test]
#[ignore = "the process that another test starts"]
fn watches() {
    let watch = Stopwatch::start();
    println!("\nbegins");
    let clock = Instant::now();
    while clock.elapsed() < Duration::from_secs(1) {
        std::thread::sleep(Duration::from_millis(10));
    }
    println!("elapsed {}", watch.elapsed().as_secs_f64());
}

#[test]
fn a_program_that_is_not_there_is_an_error() {
    let program = Program { program: Path::new("/no/such/program").into(), args: vec![], env: vec![] };
    assert!(Contained::start(&program, Stdio::null(), None, both()[0], || ()).is_err());
}
