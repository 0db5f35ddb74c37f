//! From the request for a move to a set-point over time: every generator of `servobench-motion` behind one interface.
//!
//! A [`Request`] describes the move: from rest to rest, from a state of motion, by Rockwell's operands, through a table. Planning yields
//! a [`Plan`]: the set-point at any time, its polynomials, its peaks against the limits and the details of its generator. A plan can be
//! stretched and shaped, which yields another plan.
//!
//! ```
//! use servobench_motion::{Limits, Order};
//! use servobench_planner::{Generator, Method, PointToPoint, Request};
//! let limits = Limits { velocity: 1.0, acceleration: 5.0, jerk: 50.0, snap: 1000.0 };
//! let order = Order::Fourth;
//! let move_by = PointToPoint { distance: 0.1, order, limits, method: Method::Optimal, grid: None };
//! let plan = Request::new(Generator::PointToPoint(move_by)).plan()?;
//! assert!((plan.at(plan.duration()).x - 0.1).abs() < 1e-15);
//! let published = plan.published_duration().expect("what the published profile takes");
//! assert!(plan.duration() < 0.97 * published);
//! # Ok::<(), servobench_motion::PlanError>(())
//! ```
mod analysis;
mod cascade;
mod clocked;
mod filter;
mod plan;
mod points;
mod polynomials;
mod reader;
mod request;
mod rest;
mod slowed;
mod start;
mod table;

pub use analysis::{Binding, Peak, Span};
pub use clocked::CommandCycle;
pub use filter::{Averages, Filter, Shaping};
pub use plan::{Plan, PlanDetails, Sending};
pub use points::{Deviation, PointMove, PointTimes};
pub use reader::Reader;
pub use request::{Generator, Grid, Method, PointToPoint, Replanning, Request, Rockwell, Sampling};
pub use start::Positioning;
pub use table::{CommandRate, Follow, FollowKind, TableMove, Velocities, VelocitiesKind};
