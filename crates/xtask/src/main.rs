//! The developer commands, run as `cargo xtask <command>`.

mod bare_metal;
mod bench;
mod checks;
mod command;
mod demo;
mod dist;
mod drill;
mod environment;
mod failure;
mod outside;
mod peers;
mod program;
mod python;
mod systems;
mod test;
mod toolchain;
mod wheel;
mod workspace;

use std::process::ExitCode;

fn main() -> ExitCode {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    match command::run(&arguments) {
        Ok(()) => ExitCode::SUCCESS,
        Err(failure) => {
            eprintln!("{failure}");
            failure.exit_code()
        }
    }
}
