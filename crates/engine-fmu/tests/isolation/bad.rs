#![expect(unsafe_code, reason = "real crashes need what Rust does not let happen")]
//! Slaves that do what native code does by mistake.
use serde::{Deserialize, Serialize};
use servobench_fmi::{Capabilities, LogLine, Severity, Slave, SlaveError, StepEnd};
use std::hint::black_box;
use std::io::{Read, Write};
use std::time::Duration;

/// The defect; in its steps, except where noted.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub(crate) enum Bad {
    /// Nothing: an integrator of its input; the second output is the time.
    Nothing,
    /// Cannot be loaded.
    Refused(String),
    /// Writes to address zero while it is loaded.
    CrashInLoading,
    /// Never returns from loading.
    HangInLoading,
    /// Writes to address zero.
    NullWrite,
    /// Recurses for ever.
    StackOverflow,
    /// Aborts after a message on standard error.
    Abort,
    /// Ends the process.
    Exit(i32),
    /// Panics.
    Panic,
    /// Sends itself a signal.
    Signal(i32),
    /// Ends the process from another thread while the step continues.
    ExitInThread,
    /// Computes for ever.
    Loop,
    /// Stops itself: not even a signal other than SIGKILL reaches it.
    Stop,
    /// Does not return from its end.
    HangInEnd,
    /// Allocates blocks of this many bytes, writes to them, and dies at the limit like a C program.
    Hoard { block: usize },
    /// Allocates more memory at once than the limit, as Rust code does.
    HugeVector,
    /// Allocates memory up to the limit, then waits for ever.
    HoardAndHang,
    /// Prints this many bytes on each of standard output and error in a step.
    Print(usize),
    /// Logs this many lines in a step.
    Log(usize),
    /// Logs a line in its first step and crashes in the second.
    LogThenCrash,
    /// Reads standard input.
    ReadInput,
    /// Closes all files and continues.
    CloseFiles,
    /// Handles all signals itself, then writes to address zero.
    HandleSignals,
    /// Forks a process that waits for ever, then crashes; prints its id.
    ForkThenCrash,
    /// Starts a process that leaves its session and its parent (a daemon), and continues; prints its id.
    Daemon,
    /// The same, then crashes.
    DaemonThenCrash,
    /// Sends SIGKILL to this process, to its parent and to the group of that.
    Kill(i32),
    /// Writes this much to memory that it shares with processes that it could start, in blocks.
    ShareMemory(usize),
    /// Writes this much to an unmapped memory file, in blocks.
    FillMemoryFile(usize),
    /// Starts processes that write to their own memory, this much each.
    Spread { processes: usize, each: usize },
    /// Forks a process that continues as if it were the host.
    ForkTwin,
    /// Overwrites all memory shared with another process.
    Overwrite(u8),
    /// An output is not a number.
    NaN,
    /// Fails like an FMU.
    Fails,
    /// Discards every second step.
    Discards,
    /// Returns early, then wants the end.
    Early,
}

impl Bad {
    pub(crate) fn load(self) -> Result<Box<dyn Slave>, String> {
        match &self {
            Self::Refused(why) => return Err(why.clone()),
            Self::CrashInLoading => null_write(),
            Self::HangInLoading => hang(),
            _ => {}
        }
        Ok(Box::new(BadSlave { bad: self, steps: 0, x: 0.0, time: 0.0, saved: None, log: Vec::new() }))
    }
}

struct BadSlave {
    bad: Bad,
    steps: u32,
    x: f64,
    time: f64,
    saved: Option<(f64, f64)>,
    log: Vec<LogLine>,
}

impl Slave for BadSlave {
    fn capabilities(&self) -> Capabilities {
        Capabilities { saves_state: true, interpolates_inputs: false, variable_step: true }
    }

    fn step(&mut self, time: f64, length: f64, inputs: &[[f64; 3]]) -> Result<StepEnd, SlaveError> {
        self.steps += 1;
        self.time = time + length;
        self.x += length * inputs[0].iter().sum::<f64>();
        self.misbehave(time, length)
    }

    fn read(&mut self, inputs: Option<&[f64]>, outputs: &mut [f64]) -> Result<(), SlaveError> {
        if self.bad == Bad::NaN {
            return Err(SlaveError::NotFinite { variable: "x".into(), value: f64::NAN, time: self.time });
        }
        outputs[0] = self.x + inputs.map_or(0.0, |inputs| inputs[0]);
        outputs[1] = self.time;
        Ok(())
    }

    fn save(&mut self) -> Result<(), SlaveError> {
        self.saved = Some((self.x, self.time));
        Ok(())
    }

    fn restore(&mut self) -> Result<(), SlaveError> {
        let unable =
            SlaveError::Unable { what: "go back to a state".into(), capability: "canGetAndSetFMUState".into() };
        (self.x, self.time) = self.saved.ok_or(unable)?;
        Ok(())
    }

    fn take_log(&mut self) -> Vec<LogLine> {
        std::mem::take(&mut self.log)
    }
}

impl BadSlave {
    fn misbehave(&mut self, time: f64, length: f64) -> Result<StepEnd, SlaveError> {
        match self.bad {
            Bad::StackOverflow => {
                black_box(deeper(1));
            }
            Bad::Abort => {
                eprintln!("solver: the Jacobian is singular");
                std::process::abort();
            }
            Bad::Exit(code) => std::process::exit(code),
            Bad::Panic => panic!("index out of bounds, as it were"),
            // SAFETY: the default action of the signal.
            Bad::Signal(number) => unsafe {
                libc::signal(number, libc::SIG_DFL);
                libc::raise(number);
            },
            Bad::ExitInThread => {
                std::thread::spawn(|| std::process::exit(5));
                hang();
            }
            Bad::Loop => loop {
                black_box(self.steps);
            },
            // SAFETY: a system call.
            Bad::Stop => unsafe {
                libc::raise(libc::SIGSTOP);
            },
            Bad::Hoard { block } => {
                while hoard(block, block) {}
                null_write();
            }
            Bad::HugeVector => {
                black_box(vec![1_u8; 1 << 40]);
            }
            Bad::HoardAndHang => {
                while hoard(1 << 20, 0) {}
                hang();
            }
            Bad::Print(bytes) => {
                let line = [b'x'; 4096];
                for _ in 0..bytes / line.len() {
                    std::io::stdout().write_all(&line).unwrap();
                    std::io::stderr().write_all(&line).unwrap();
                }
                println!("the end of the output");
                eprintln!("the end of the errors");
            }
            Bad::Log(lines) => self.log.extend((0..lines).map(|k| line(time, &format!("line {k}")))),
            Bad::LogThenCrash if self.steps == 1 => self.log.push(line(time, "stiff")),
            Bad::NullWrite | Bad::LogThenCrash => null_write(),
            Bad::ReadInput => {
                let mut all = Vec::new();
                let count = std::io::stdin().read_to_end(&mut all).unwrap();
                self.log.push(line(time, &format!("{count} bytes on standard input")));
            }
            Bad::CloseFiles => {
                // SAFETY: the closed files are not used any more, or only this process suffers.
                (0..1000).for_each(|file| unsafe {
                    libc::close(file);
                });
            }
            Bad::HandleSignals => {
                extern "C" fn nothing(_: i32) {
                    // SAFETY: ends the process.
                    unsafe { libc::_exit(77) }
                }
                let nothing: extern "C" fn(i32) = nothing;
                for signal in 1..32 {
                    // SAFETY: the handler does nothing but end the process.
                    unsafe { libc::signal(signal, nothing as *const () as libc::sighandler_t) };
                }
                null_write();
            }
            Bad::ForkThenCrash | Bad::Daemon | Bad::DaemonThenCrash | Bad::Kill(_) => self.meddle(time),
            Bad::ShareMemory(_) | Bad::FillMemoryFile(_) | Bad::Spread { .. } => self.share(),
            // SAFETY: the child continues like its parent and allocates nothing; the parent waits for its end.
            Bad::ForkTwin => unsafe {
                let twin = libc::fork();
                if twin == 0 {
                    self.x += 1e6;
                } else {
                    libc::waitpid(twin, std::ptr::null_mut(), 0);
                }
            },
            Bad::Overwrite(byte) => overwrite(byte),
            Bad::Fails => {
                let message = "x".repeat(100_000);
                return Err(failed(time, message));
            }
            Bad::Discards if self.steps.is_multiple_of(2) => {
                return Err(SlaveError::Discarded { call: "fmi3DoStep".into(), time, shortest: None });
            }
            Bad::Early if self.steps == 1 => return Ok(StepEnd::Until(time + length / 4.0)),
            Bad::Early => return Ok(StepEnd::Terminated(time + length / 2.0)),
            _ => {}
        }
        Ok(StepEnd::Done)
    }
}

impl BadSlave {
    /// Defects that concern other processes.
    fn meddle(&mut self, time: f64) {
        match self.bad {
            Bad::ForkThenCrash => {
                eprintln!("child {}", fork(wait_for_better_times));
                null_write();
            }
            Bad::Daemon => self.log.push(line(time, &format!("child {}", fork(become_a_daemon)))),
            Bad::DaemonThenCrash => {
                eprintln!("child {}", fork(become_a_daemon));
                null_write();
            }
            // SAFETY: system calls.
            Bad::Kill(process) => unsafe {
                let killed = libc::kill(process, libc::SIGKILL) == 0;
                libc::kill(libc::getppid(), libc::SIGKILL);
                self.log.push(line(time, if killed { "killed" } else { "spared" }));
            },
            _ => {}
        }
    }

    /// Defects that concern shared memory.
    fn share(&self) {
        match self.bad {
            Bad::ShareMemory(bytes) => share_memory(bytes),
            Bad::FillMemoryFile(bytes) => fill_memory_file(bytes),
            Bad::Spread { processes, each } => {
                for _ in 0..processes {
                    fork(|| {
                        hoard(each, each);
                    });
                }
                hang();
            }
            _ => {}
        }
    }
}

impl Drop for BadSlave {
    fn drop(&mut self) {
        if self.bad == Bad::HangInEnd {
            hang();
        }
    }
}

/// Forks a process that does `work`, prints its id as `/proc` has it, and waits for ever. Only the calling thread is forked.
fn fork(work: impl FnOnce()) -> String {
    let (mut said, mut saying) = std::io::pipe().unwrap();
    // SAFETY: there is one thread.
    if unsafe { libc::fork() } == 0 {
        work();
        let own = std::fs::read_link("/proc/self").unwrap();
        saying.write_all(own.to_str().unwrap().as_bytes()).unwrap();
        drop(saying);
        hang();
    }
    drop(saying);
    let mut id = String::new();
    said.read_to_string(&mut id).unwrap();
    id
}

fn wait_for_better_times() {}

/// Leaves session, group and parent, as a daemon does.
fn become_a_daemon() {
    // SAFETY: there is one thread.
    unsafe {
        if libc::fork() != 0 {
            libc::_exit(0);
        }
        libc::setsid();
        libc::signal(libc::SIGTERM, libc::SIG_IGN);
        libc::signal(libc::SIGHUP, libc::SIG_IGN);
    }
}

/// Bytes written at a time; after each block the FMU computes for a moment, like one that fills its memory.
const BLOCK: usize = 16 << 20;

fn share_memory(bytes: usize) {
    for _ in 0..bytes / BLOCK {
        // SAFETY: a new mapping of the given length.
        unsafe {
            let (access, shared) = (libc::PROT_READ | libc::PROT_WRITE, libc::MAP_SHARED | libc::MAP_ANONYMOUS);
            let memory = libc::mmap(std::ptr::null_mut(), BLOCK, access, shared, -1, 0);
            assert_ne!(memory, libc::MAP_FAILED);
            memory.cast::<u8>().write_bytes(1, BLOCK);
        }
        std::thread::sleep(Duration::from_millis(5));
    }
}

fn fill_memory_file(bytes: usize) {
    // SAFETY: a new file, which belongs to this process alone.
    let mut file =
        unsafe { <std::fs::File as std::os::fd::FromRawFd>::from_raw_fd(libc::memfd_create(c"much".as_ptr(), 0)) };
    let block = vec![1; BLOCK];
    for _ in 0..bytes / BLOCK {
        file.write_all(&block).unwrap();
        std::thread::sleep(Duration::from_millis(5));
    }
}

fn line(time: f64, message: &str) -> LogLine {
    LogLine { time, severity: Severity::Warning, category: "logStatusWarning".into(), message: message.into() }
}

fn hang() -> ! {
    loop {
        std::thread::sleep(Duration::from_hours(1));
    }
}

fn null_write() {
    // SAFETY: none; it is a crash.
    unsafe { std::arch::asm!("mov byte ptr [{0}], 1", in(reg) 0_u64) };
}

fn deeper(depth: u64) -> u64 {
    let frame = black_box([depth; 512]);
    if black_box(true) { deeper(frame[7] + 1) + frame[511] } else { 0 }
}

/// Allocates `block` more bytes and writes to the first `used`; returns false without memory.
fn hoard(block: usize, used: usize) -> bool {
    // SAFETY: the block has the requested length and no other owner.
    unsafe {
        let memory: *mut u8 = libc::malloc(block).cast();
        if memory.is_null() {
            return false;
        }
        memory.write_bytes(1, used);
        black_box(memory);
    }
    true
}

/// Overwrites all shared memory, found in the process map as a wild pointer would hit it.
fn overwrite(byte: u8) {
    let maps = std::fs::read_to_string("/proc/self/maps").unwrap();
    let page = maps.lines().filter(|line| line.contains("servobench-fmu"));
    for line in page {
        let (from, to) = line.split_whitespace().next().unwrap().split_once('-').unwrap();
        let at = |text| usize::from_str_radix(text, 16).unwrap();
        // SAFETY: none for whoever uses it; it is mapped and writable.
        unsafe { std::ptr::with_exposed_provenance_mut::<u8>(at(from)).write_bytes(byte, at(to) - at(from)) };
    }
}

fn failed(time: f64, message: String) -> SlaveError {
    SlaveError::Failed { call: "fmi3DoStep".into(), time, status: "fmi3Error".into(), message }
}
