//! Which set-point is the fastest that keeps its limits on every machine of a box.
//!
//! A profile is a distance through moving averages, its boxes: d through T₀, T₁, T₂, T₃ has v = d/T₀, a = v/T₁, j = a/T₂, s = j/T₃ and takes as long
//! as all of them together. The search is for the boxes, in each family (order, shaper).
//!
//! ```text
//! seeds    box lengths from those that the ceiling allows upwards, the shortest moves first, on the hardest machine, until they take longer than
//!          one that keeps its limits on all machines
//! first    of these what no other is both faster than and less over its limits, on all machines
//! refine   step by step to where a linear model of all uses of all limits has the best boxes, from any point
//! hops     from the best to other lobes of the mode and to other families, and refinement from there
//! verify   corners, a grid in frequency finer than a tenth of a lobe, draws: the machines on which it fails join the search
//! ```
//!
//! What a run is, and how it is judged, is for [`Bench`] to say: nothing here knows a scenario.

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
