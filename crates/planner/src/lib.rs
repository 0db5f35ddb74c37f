//! From a move as it was asked for to a set-point over time: every generator of `servobench-motion` behind one door.
//!
//! A [`Request`] says what is wanted: from rest to rest, from a state of motion, by Rockwell's words, through a table. Planned, it is a
//! [`Plan`]: the set-point at any time, its polynomials, its peaks against the limits and what the planner has to tell. A plan may be
//! stretched and shaped; it stays a plan.
//!
//! ```
//! use servobench_motion::{Limits, Order};
//! use servobench_planner::{Method, PointToPoint, Request, Way};
//! let limits = Limits { velocity: 1.0, acceleration: 5.0, jerk: 50.0, snap: 1000.0 };
//! let order = Order::Fourth;
//! let way = PointToPoint { distance: 0.1, order, limits, method: Method::Optimal, grid: None };
//! let plan = Request::new(Way::PointToPoint(way)).plan()?;
//! assert!((plan.at(plan.duration()).x - 0.1).abs() < 1e-15);
//! let told = plan.published_duration().expect("what the published profile takes");
//! assert!(plan.duration() < 0.97 * told);
//! # Ok::<(), servobench_motion::PlanError>(())
//! ```
mod analysis;
mod cascade;
mod clocked;
mod filter;
mod plan;
mod polynomials;
mod reader;
mod request;
mod slowed;
mod table;

pub use analysis::{Binding, Peak, Span};
pub use clocked::CommandCycle;
pub use filter::{Averages, Filter};
pub use plan::{Plan, Told};
pub use reader::Reader;
pub use request::{Execution, Grid, Method, PointToPoint, Replanning, Request, Rockwell, Sampling, Way};
pub use table::{Follow, TableMove, Velocities};
