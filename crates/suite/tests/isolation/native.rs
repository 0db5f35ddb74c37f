#![expect(unsafe_code, reason = "real crashes need what Rust does not let happen")]
//! An engine with faults of native code, selected by [`MISCHIEF`]; without it, it is `exact`.
use servobench_plant::{Engine, EngineName, Exact, Mechanics, MechanicsError, MechanicsSetup};
use std::hint::black_box;
use std::process::{Command, Stdio};
use std::time::Duration;

/// Environment variable that selects the fault of the next engine.
pub(crate) const MISCHIEF: &str = "SUITE_TEST_MISCHIEF";

pub(crate) struct Native;

impl Engine for Native {
    fn name(&self) -> EngineName {
        EngineName::Mujoco
    }

    fn build(&self, setup: &MechanicsSetup) -> Result<Box<dyn Mechanics>, MechanicsError> {
        match std::env::var(MISCHIEF).unwrap_or_default().as_str() {
            "crash" => null_write(),
            "abort" => std::process::abort(),
            "exit" => std::process::exit(7),
            "overflow" => {
                black_box(deeper(1));
            }
            "hoard" => {
                let much: Vec<Vec<u8>> = (0..100_000).map(|_| vec![1; 1 << 20]).collect();
                black_box(much);
            }
            "hang" => loop {
                std::thread::sleep(Duration::from_hours(1));
            },
            // It leaves session and group.
            "daemon" => {
                start_a_daemon();
                println!("a library speaks on standard output");
                null_write();
            }
            "quiet-daemon" => start_a_daemon(),
            _ => {}
        }
        Exact.build(setup)
    }
}

fn start_a_daemon() {
    // The shell ends at once, without waiting for the process that it has started.
    let mut shell = Command::new("sh");
    shell.args(["-c", "setsid sleep 3601 &"]).stdin(Stdio::null()).stdout(Stdio::null()).stderr(Stdio::null());
    assert!(shell.status().unwrap().success());
}

fn null_write() {
    // SAFETY: none; it is a crash.
    unsafe { std::arch::asm!("mov byte ptr [{0}], 1", in(reg) 0_u64) };
}

fn deeper(depth: u64) -> u64 {
    let frame = black_box([depth; 512]);
    if black_box(true) { deeper(frame[7] + 1) + frame[511] } else { 0 }
}
