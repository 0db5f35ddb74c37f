//! The `servobench` command: arguments, printing, exit codes. It computes nothing.

mod args;
mod build_id;
mod commands;
mod console;
mod diagnostics;
mod engines;
mod error;
mod exit;
#[cfg(feature = "fmu")]
mod fmu_opener;
mod fmu_trust;
mod interrupt;
mod output;
mod outputs;
mod progress;
mod ready;
mod resources;
mod sources;
mod suite;
mod view_program;
mod workers;

use args::Command;
use exit::Exit;
use fmu_trust::FmuTrust;
use std::panic::catch_unwind;
use std::process::ExitCode;

fn main() -> ExitCode {
    resources::take();
    console::say_panics();
    let cli = args::parse();
    if let Err(error) = interrupt::refuse_large_files() {
        console::say(&format!("servobench: {error}\n"));
        return error.exit().into();
    }
    // A panic is a defect of this program; it must not end with a code that means something else.
    catch_unwind(|| dispatch(&cli.command)).unwrap_or(Exit::Run).into()
}

fn dispatch(command: &Command) -> Exit {
    FmuTrust::of(command).settle();
    let done = match command {
        Command::Init(args) => commands::init(args),
        Command::Examples(args) => commands::examples(args),
        Command::Explain(args) => commands::explain(args),
        Command::Models(args) => commands::models(args),
        Command::Run(args) => commands::run(args),
        Command::Sweep(args) => commands::sweep(args),
        Command::Advise(args) => commands::advise(args),
        Command::Check(args) => commands::check(args),
        Command::Schema(args) => commands::schema(args),
        Command::Plan(args) => commands::plan(args),
        Command::Compare(args) => commands::compare(args),
        Command::View(args) => commands::view(args),
        Command::Timing(args) => commands::timing(args),
        Command::Objects(args) => commands::objects(args),
        Command::Plc(command) => commands::plc(command),
        #[cfg(feature = "fmu")]
        Command::Fmu(command) => commands::fmu(command),
        #[cfg(feature = "fmu")]
        Command::FmuHost => commands::fmu_host(),
        Command::Completions(args) => commands::completions(args),
        Command::Man(args) => commands::man(args),
        Command::Worker => commands::worker(),
    };
    interrupt::end_if_ending();
    done.unwrap_or_else(|error| {
        console::say(&format!("servobench: {error}\n"));
        error.exit()
    })
}
