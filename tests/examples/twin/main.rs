//! Runs machines that are not those of their files, and judges them by files that are not theirs:
//!
//! ```sh
//! cargo run --release -p servobench-tests --example twin < JOBS > RESULTS
//! ```
//!
//! A job is a line of JSON ([`job::Job`]), its result another one ([`job::Outcome`]), in the order in which the runs end. The healthy
//! twin of a machine gives the requirements with their tolerances; what is sabotaged in the other one the verdict is not told. Who draws
//! the pairs, and judges the verdicts, is `tests/twin` (`cargo xtask drill verdicts`).
mod fmus;
mod job;
mod sabotage;

use job::Job;
use servobench_metrics::Requirement;
use std::io::{BufRead as _, BufReader, Write as _};
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::Mutex;
use std::{io, thread};

fn main() {
    if std::env::args().nth(1).as_deref() == Some("--requirements") {
        for name in Requirement::ALL {
            println!("{name}");
        }
        return;
    }
    let workers = thread::available_parallelism().map_or(1, usize::from);
    let lines = Mutex::new(BufReader::new(io::stdin()).lines());
    let written = Mutex::new(io::stdout());
    // A panic of a run is its result; the others go on.
    std::panic::set_hook(Box::new(|_| ()));
    thread::scope(|scope| {
        for _ in 0..workers {
            scope.spawn(|| {
                loop {
                    let next = lines.lock().expect("nobody panics with it").next();
                    let Some(Ok(line)) = next else { return };
                    let outcome = outcome(&line);
                    let mut out = written.lock().expect("nobody panics with it");
                    writeln!(out, "{outcome}").and_then(|()| out.flush()).expect("who asks for a run reads its result");
                }
            });
        }
    });
}

/// The result of the job in `line`, as JSON.
fn outcome(line: &str) -> serde_json::Value {
    let job: Job = match serde_json::from_str(line) {
        Ok(job) => job,
        Err(error) => return serde_json::json!({ "error": format!("not a job: {error}") }),
    };
    let outcome = catch_unwind(AssertUnwindSafe(|| job.run()));
    let outcome = outcome.unwrap_or_else(|panic| {
        let text = panic.downcast_ref::<String>().cloned();
        Err(text.or_else(|| panic.downcast_ref::<&str>().map(|text| (*text).to_owned())).unwrap_or_default())
    });
    match outcome {
        Ok(outcome) => serde_json::json!({ "id": job.id, "outcome": outcome }),
        Err(error) => serde_json::json!({ "id": job.id, "error": error }),
    }
}
