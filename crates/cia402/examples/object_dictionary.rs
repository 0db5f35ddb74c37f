//! Prints the object dictionary: `eds [NAME DATE TIME]` as an electronic data sheet, `json` with the values after power-on.
//!
//! ```text
//! cargo run --release -p servobench-cia402 --example object_dictionary eds drive.eds 11-21-2026 08:00AM > drive.eds
//! ```
use servobench_cia402::objects::{Dictionary, Eds, FileInfo, Json};
use std::process::ExitCode;

fn main() -> ExitCode {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let words: Vec<&str> = arguments.iter().map(String::as_str).collect();
    match words.as_slice() {
        ["eds"] => print!("{}", Eds(FileInfo { name: "drive.eds", date: "01-01-2026", time: "12:00AM" })),
        ["eds", name, date, time] => print!("{}", Eds(FileInfo { name, date, time })),
        ["json"] => print!("{}", Json(&Dictionary::new())),
        _ => {
            eprintln!("usage: object_dictionary eds [NAME MM-DD-YYYY HH:MMAM] | json");
            return ExitCode::from(2);
        }
    }
    ExitCode::SUCCESS
}
