//! The fastest set-point that meets its limits on every machine within given tolerances.
//!
//! A profile is a step of distance through moving averages: d through T₀, T₁, T₂, T₃ has v = d/T₀, a = v/T₁, j = a/T₂, s = j/T₃ and the sum
//! of their lengths as its duration. The search varies these lengths in each family (order, shaper).
//!
//! ```text
//! seeds    lengths of averages from those at the ceiling upwards, the shortest moves first, on the hardest machine, until they take longer
//!          than one within its limits on all machines
//! first    the Pareto front of these in time and excess over the limits, on all machines
//! refine   step by step to the optimum of a linear model of all uses of all limits, from any point
//! hops     from the best to other lobes of the mode and to other families, and refinement from there
//! verify   corners, a grid in frequency finer than a tenth of a lobe, draws: the machines on which it fails join the search
//! ```
//!
//! [`Bench`] defines a run and its evaluation: this crate does not depend on scenarios.

mod best;
mod explore;
mod hops;
mod machines;
mod merit;
mod prices;
mod refine;
mod search;
mod seeds;
mod set_point;
mod verify;

pub use best::{Advice, AdviseError, Price, Question, advise, refuse_impossible};
pub use machines::{Machines, Range, Stretch};
pub use search::{Bench, Reading, Worst};
pub use set_point::{Family, SetPoint};
pub use verify::Verification;
