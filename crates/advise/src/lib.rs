//! Which set-point is the fastest that keeps its limits on every machine of a box.
//!
//! ```text
//! families (order, shaper) × limits (v, a, a/j, j/s)  = set-points, sorted by the duration of their moves
//! box of the machine: its middle and corners           = machines
//!
//! search   the first set-points whose moves are short, on all machines; one is given up on the machine that it fails on. What no run can
//!          beat any more is not run: move and settling take at least as long as the move.
//! refine   the neighbours of the best ones, nearer and nearer
//! verify   corners, a grid in frequency finer than a tenth of a lobe, draws: the machines on which it fails join the search
//! ```
//!
//! What a run is, and how it is judged, is for [`Bench`] to say: nothing here knows a scenario.

mod best;
mod machines;
mod refine;
mod search;
mod set_point;
mod verify;

pub use best::{Advice, AdviseError, Price, Question, advise, refuse_impossible};
pub use machines::{Machines, Range, Stretch};
pub use search::{Bench, Reading, Worst};
pub use set_point::{Family, SetPoint};
pub use verify::Verification;
