//! Writes three recordings to look at: `cargo run --release -p servobench-view --example two_mass [FOLDER]`, then
//! `rerun FOLDER/compare.rrd`.
mod axis;

use axis::{Case, run};
use servobench_view::{ViewOptions, write_comparison_rrd, write_rrd};
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
    write_rrd(&jerk, folder.join("run.rrd"), &options)?;
    write_rrd(&case("turntable", 4, true, 1.8), folder.join("rotary.rrd"), &options)?;
    write_comparison_rrd(&[("jerk", &jerk), ("snap", &snap)], folder.join("compare.rrd"), &options)?;
    println!("three recordings in {} written in {:.2} s", folder.display(), start.elapsed().as_secs_f64());
    Ok(())
}
