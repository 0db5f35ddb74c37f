//! A servo axis in closed loop: load a scenario, set its keys, check it, run it, read the measurements.
//!
//! ```
//! use servobench::{Metric, Scenario};
//!
//! # fn main() -> Result<(), servobench::Error> {
//! # let path = concat!(env!("CARGO_MANIFEST_DIR"), "/../../scenarios/flexible-axis.toml");
//! let mut scenario = Scenario::load(path)?;
//! scenario.set("setpoint.jerk", (40.0, "m/s3"))?;
//! for warning in scenario.check()? {
//!     eprintln!("{warning}");
//! }
//! let run = scenario.run()?;
//! println!("passed: {}, vibration {:?} m", run.passed(), run.metric(Metric::ResidualVibrationPp));
//! let highest = run.signal("load.position").unwrap().iter().copied().fold(0.0, f64::max);
//! # assert!(highest > 0.0);
//! # Ok(())
//! # }
//! ```
//!
//! Every value is in SI, every unit is in its name or its documentation; the keys are those of a scenario file
//! (`servobench explain KEY`, or `docs/scenario.md`).
//!
//! # A sweep
//!
//! The file is read once; a point of the sweep is the scenario with other values. Runs share nothing, so that threads may divide them.
//!
//! ```
//! use servobench::{Metric, Scenario};
//!
//! # fn main() -> Result<(), servobench::Error> {
//! let demo = Scenario::demo()?.swap_remove(0);
//! let mut best: Option<(f64, f64)> = None;
//! for step in 0..100 {
//!     let jerk = 20.0 + f64::from(step);
//!     let run = demo.with([("setpoint.jerk", (jerk, "m/s3").into()), ("record.rate", "1 kHz".into())])?.run()?;
//!     let vibration = run.metric(Metric::ResidualVibrationPp).unwrap_or(f64::INFINITY);
//!     if best.is_none_or(|(least, _)| vibration < least) {
//!         best = Some((vibration, jerk));
//!     }
//! }
//! let (vibration, jerk) = best.unwrap();
//! println!("least vibration, {:.1} µm, at {jerk} m/s³", 1e6 * vibration);
//! # Ok(())
//! # }
//! ```
//!
//! # A controller of your own
//!
//! [`Bench`] advances tick by tick. The inputs of a tick are given as [`External`]: efforts, a set-point, or the output of a controller
//! that takes the place of the drive.
//!
//! ```
//! use servobench::{Bench, Controller, External, Metric, Scenario, Signal};
//!
//! # fn main() -> Result<(), servobench::Error> {
//! let scenario = Scenario::demo()?.swap_remove(0);
//! let mut bench = Bench::new(&scenario)?;
//! let (stiffness, damping) = (60.0, 0.6); // N·m/rad, N·m·s/rad
//! let lead = scenario.resolved().axis.transmission; // m/rad
//! while bench.is_under_way() {
//!     let (wanted, motor) = (bench.setpoint(), bench.motor());
//!     let torque = stiffness * (wanted.x / lead - motor.position) + damping * (wanted.v / lead - motor.velocity);
//!     bench.step(&External { controller: Some(Controller::Effort(torque)), ..External::default() })?;
//! }
//! let load = bench.value(Signal::LoadPosition);
//! let run = bench.finish()?;
//! println!("the load is at {load:?} m, its largest error was {:?} m", run.metric(Metric::FollowingErrorPeakLoad));
//! # assert!((load.unwrap() - 0.25).abs() < 1e-3, "{load:?} {:?}", run.verdict.reasons().collect::<Vec<_>>());
//! # Ok(())
//! # }
//! ```
//!
//! # Features
//!
//! | feature | default | brings |
//! |---|---|---|
//! | `rapier` | yes | the engine `rapier` beside `exact` |
//!
//! `mujoco` and FMUs are engines of the program `servobench`, which runs them in processes of their own; [`Scenario::run_on`] takes any
//! engine all the same.
//!
//! # Parts
//!
//! The program's suites, reports and FMUs use the same parts: [`check`] (objections), [`preview`], [`run`](mod@run) (measuring and
//! judging), [`size`] (memory), [`usage`].

mod bench;
pub mod check;
mod engines;
mod error;
mod limits;
mod linear;
pub mod panicked;
pub mod preview;
mod question;
mod requirements;
pub mod run;
mod scenario;
pub mod size;
pub mod usage;

pub use bench::Bench;
pub use engines::{EngineMissing, Engines};
pub use error::Error;
pub use limits::channel_limits;
pub use linear::Linear;
pub use requirements::{increment, instability};
pub use run::Run;
pub use scenario::Scenario;
pub use servobench_metrics::Name as Metric;
pub use servobench_signals::Signal;
pub use servobench_sim::{Controller, External};
pub use servobench_sweep::Value;
