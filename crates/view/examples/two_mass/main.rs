//! Writes three recordings to look at: `cargo run --release -p servobench-view --example two_mass [FOLDER]`, then
//! `rerun FOLDER/compare.rrd`.
mod axis;

use axis::{Case, run};
use servobench_view::{ViewOptions, comparison_rrd, run_rrd};
use std::fs;
use std::path::PathBuf;
use std::time::Instant;

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let folder = PathBuf::from(std::env::args().nth(1).unwrap_or_else(|| ".".into()));
    let case = |name, order, rotary, duration| run(Case { name, order, rotary, duration });
    let (jerk, snap) = (case("two-mass-jerk", 3, false, 1.8), case("two-mass-snap", 4, false, 1.8));
    let options = ViewOptions {
        limits: vec![("current.q".into(), 8.0), ("effort.motor".into(), 900.0)],
        window: Some(5e-6),
        ..ViewOptions::default()
    };
    let start = Instant::now();
    fs::write(folder.join("run.rrd"), run_rrd(&jerk, &options)?)?;
    fs::write(folder.join("rotary.rrd"), run_rrd(&case("turntable", 4, true, 1.8), &options)?)?;
    fs::write(folder.join("compare.rrd"), comparison_rrd(&[("jerk", &jerk), ("snap", &snap)], &options)?)?;
    println!("three recordings in {} written in {:.2} s", folder.display(), start.elapsed().as_secs_f64());
    Ok(())
}
