//! What happens to a suite.
use crate::processes;
use crate::suite::Suite;
use rustix::process::{Pid, Signal, geteuid};
use servobench_testkit::Random;
use std::fs;
use std::os::unix::fs::PermissionsExt as _;
use std::os::unix::process::ExitStatusExt as _;
use std::process::{Child, Command, ExitStatus, Stdio};
use std::time::Duration;

/// What happens to a suite; times are those from its start.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum Fault {
    /// The program gets these signals one after the other.
    Signals(&'static [Signal], Duration),
    /// One of its processes, if it has one then, gets a signal.
    WorkerSignal(Signal, Duration),
    /// An FMU does what it should not, by its number in `attached.c`.
    Fmu(u32),
    /// The program and all its processes stand still for a while.
    Stopped(Duration, Duration),
    /// No file may be longer than so many blocks of `ulimit`.
    FileSize(u64),
    /// No more descriptors than these.
    Descriptors(u64),
    /// No more address space than this (kB).
    Memory(u64),
    /// No more processes and threads than these beside those that its user has.
    Processes(u64),
    /// Its output folder is read-only.
    ReadOnly,
    /// Its output folder is on a disk of so many kB.
    FullDisk(u64),
    /// What it writes for the continuous integration goes to a device that is full.
    FullDevice,
    /// The clock is set while it runs.
    Clock,
}

/// User and group without rights (`nobody` where there is one).
const NOBODY: u32 = 65534;

impl Fault {
    /// The fault of suite `number`: each kind in turn, all else at random. `usual` is how long the suite takes.
    pub(crate) fn drawn(number: u64, random: &mut Random, usual: Duration) -> Self {
        let mut any_time = || usual.mul_f64(random.between(0.0, 1.1));
        match number % 12 {
            0 => Self::Signals(&[Signal::KILL], any_time()),
            1 => {
                let at = any_time();
                let ends: [&[Signal]; 7] = [
                    &[Signal::TERM],
                    &[Signal::INT],
                    &[Signal::INT, Signal::INT],
                    &[Signal::INT, Signal::TERM],
                    &[Signal::ABORT],
                    &[Signal::SEGV],
                    &[Signal::QUIT],
                ];
                Self::Signals(random.one_of(&ends), at)
            }
            2 => {
                let at = any_time();
                Self::WorkerSignal(random.one_of(&[Signal::KILL, Signal::SEGV, Signal::ABORT, Signal::TERM]), at)
            }
            // Crash, unlimited memory, exit, abort, stack overflow.
            3 => Self::Fmu(random.one_of(&[2, 4, 7, 13, 14])),
            4 => {
                let at = any_time();
                Self::Stopped(at, usual.mul_f64(random.between(0.0, 2.0)))
            }
            5 => Self::FileSize(random.below(200)),
            6 => Self::Descriptors(4 + random.below(40)),
            7 => Self::Memory(20_000 + random.below(3_000_000)),
            8 => Self::Processes(1 + random.below(12)),
            9 => {
                if random.once_in(2) {
                    Self::ReadOnly
                } else {
                    Self::FullDevice
                }
            }
            10 => Self::FullDisk(8 + random.below(600)),
            _ => Self::Clock,
        }
    }

    /// Its kind, for counting.
    pub(crate) fn name(&self) -> String {
        let text = match self {
            Self::Fmu(mischief) => return format!("FMU, mischief {mischief}"),
            Self::Signals(signals, _) => return format!("signals {signals:?}"),
            Self::WorkerSignal(signal, _) => return format!("signal {signal:?} to a worker"),
            other => format!("{other:?}"),
        };
        text.split('(').next().unwrap_or_default().to_owned()
    }

    /// Why this machine cannot do it.
    pub(crate) fn cannot(&self, suite: &Suite) -> Option<String> {
        let works = |command: &mut Command| {
            command.stdout(Stdio::null()).stderr(Stdio::null()).status().is_ok_and(|status| status.success())
        };
        let is_root = geteuid().is_root();
        match self {
            Self::Processes(_) if is_root => {
                let mut version = as_nobody(env!("CARGO_BIN_EXE_servobench"));
                (!works(version.arg("--version"))).then(|| {
                    "root has no limit of processes, and the program cannot be run as another user here".to_owned()
                })
            }
            Self::FullDisk(_) => {
                let folder = suite.out("probe");
                fs::create_dir_all(&folder).unwrap();
                let can = works(mount(64).arg(&folder)) && works(Command::new("umount").arg(&folder));
                fs::remove_dir(&folder).ok();
                (!can).then(|| "a file system cannot be mounted here (it takes root)".to_owned())
            }
            Self::ReadOnly if is_root => {
                let can = works(Command::new("unshare").args(["-m", "true"]));
                (!can).then(|| "root may write everywhere, and `unshare -m` is not permitted here".to_owned())
            }
            _ => None,
        }
    }

    /// Before the suite is begun.
    pub(crate) fn prepare(&self, suite: &Suite, name: &str) {
        let out = suite.out(name);
        match self {
            Self::ReadOnly => {
                fs::create_dir(&out).unwrap();
                fs::set_permissions(&out, fs::Permissions::from_mode(0o555)).unwrap();
            }
            Self::FullDisk(size) => {
                fs::create_dir(&out).unwrap();
                assert!(mount(*size).arg(&out).status().unwrap().success());
            }
            Self::Processes(_) if geteuid().is_root() => {
                for folder in [suite.folder().to_owned(), suite.folder().join("tmp"), suite.folder().join("outs")] {
                    fs::set_permissions(folder, fs::Permissions::from_mode(0o777)).unwrap();
                }
            }
            _ => {}
        }
    }

    /// What begins the suite.
    pub(crate) fn command(&self, suite: &Suite, name: &str) -> Command {
        let mut run = suite.run(name);
        let limited = |limits: &str| {
            let mut shell = Command::new("sh");
            shell.args(["-c", &format!("ulimit {limits} && exec \"$0\" \"$@\"")]);
            within(shell, &run)
        };
        match self {
            Self::FileSize(blocks) => limited(&format!("-f {blocks}")),
            Self::Descriptors(count) => limited(&format!("-n {count}")),
            Self::Memory(size) => limited(&format!("-v {size}")),
            Self::Processes(count) if geteuid().is_root() => {
                let mut shell = as_nobody("sh");
                shell.args(["-c", &format!("ulimit -u {count} && exec \"$0\" \"$@\"")]);
                within(shell, &run)
            }
            Self::Processes(count) => limited(&format!("-u {count}")),
            Self::ReadOnly if geteuid().is_root() => {
                let mut shell = Command::new("unshare");
                let out = suite.out(name).display().to_string();
                let line =
                    format!("mount --bind '{out}' '{out}' && mount -o remount,bind,ro '{out}' && exec \"$0\" \"$@\"");
                shell.args(["-m", "sh", "-c", &line]);
                within(shell, &run)
            }
            Self::Fmu(mischief) => {
                run.env("ATTACHED_MISCHIEF", mischief.to_string());
                run
            }
            Self::Clock => {
                run.env("LD_PRELOAD", suite.folder().join("clock.so"));
                run
            }
            Self::FullDevice => {
                let mut full = Command::new(run.get_program());
                let words: Vec<_> = run.get_args().collect();
                let (_, before) = words.split_last().unwrap();
                full.args(before)
                    .arg("/dev/full")
                    .current_dir(suite.folder())
                    .env("TMPDIR", suite.folder().join("tmp"));
                full
            }
            _ => run,
        }
    }

    /// While it runs.
    pub(crate) fn happen(&self, suite: &Suite, child: &Child) {
        let pid = Pid::from_child(child);
        let marker = suite.folder().join("tmp");
        match *self {
            Self::Signals(signals, at) => {
                std::thread::sleep(at);
                for signal in signals {
                    processes::send(pid, *signal);
                    // Two of one kind that wait at once are one (signal(7)).
                    std::thread::sleep(Duration::from_millis(20));
                }
            }
            Self::WorkerSignal(signal, at) => {
                std::thread::sleep(at);
                if let Some(worker) = processes::below(&marker, pid).first() {
                    processes::send(*worker, signal);
                }
            }
            Self::Stopped(at, length) => {
                std::thread::sleep(at);
                let all = processes::of(&marker);
                for pid in &all {
                    processes::send(*pid, Signal::STOP);
                }
                std::thread::sleep(length);
                for pid in &all {
                    processes::send(*pid, Signal::CONT);
                }
            }
            _ => {}
        }
    }

    /// Whether a suite may end so. 127 and 126 are those of a shell that cannot start the program at all.
    pub(crate) fn explains(&self, status: ExitStatus) -> bool {
        let is_ours = matches!(status.code(), Some(0 | 2 | 3 | 4 | 130));
        match self {
            Self::Signals(signals, _) => {
                is_ours || status.signal().is_some_and(|found| signals.iter().any(|s| s.as_raw() == found))
            }
            // The loader, the shell or the run-time library give up before the program is begun, and an allocation that fails ends it.
            Self::Memory(_) | Self::Descriptors(_) | Self::Processes(_) => {
                is_ours || matches!(status.code(), Some(126 | 127 | 1)) || status.signal() == Some(6)
            }
            _ => is_ours,
        }
    }

    /// When the suite has ended, and before the rest of it is run: the fault is mended.
    pub(crate) fn lift(&self, suite: &Suite, name: &str) {
        let out = suite.out(name);
        match self {
            Self::ReadOnly => fs::set_permissions(out, fs::Permissions::from_mode(0o755)).unwrap(),
            Self::FullDisk(_) => {
                let larger = Command::new("mount").args(["-o", "remount,size=64m"]).arg(out).status();
                assert!(larger.unwrap().success());
            }
            _ => {}
        }
    }

    /// Whether the report for the continuous integration cannot be written to the end: `--resume` writes it to the same device.
    pub(crate) fn keeps_junit_away(&self) -> bool {
        matches!(self, Self::FullDevice)
    }

    /// When the rest was run.
    pub(crate) fn clean(&self, suite: &Suite, name: &str) {
        if matches!(self, Self::FullDisk(_)) {
            assert!(Command::new("umount").arg(suite.out(name)).status().unwrap().success());
        }
        fs::remove_dir_all(suite.out(name)).unwrap();
    }
}

fn mount(size: u64) -> Command {
    let mut mount = Command::new("mount");
    mount.args(["-t", "tmpfs", "-o", &format!("size={size}k"), "tmpfs"]);
    mount
}

fn as_nobody(program: &str) -> Command {
    let mut command = Command::new("setpriv");
    command.args([&format!("--reuid={NOBODY}"), &format!("--regid={NOBODY}"), "--clear-groups", program]);
    command
}

/// `run`, by way of `shell`.
fn within(mut shell: Command, run: &Command) -> Command {
    shell.arg(run.get_program()).args(run.get_args());
    shell.envs(run.get_envs().filter_map(|(name, value)| Some((name, value?))));
    if let Some(folder) = run.get_current_dir() {
        shell.current_dir(folder);
    }
    shell
}
