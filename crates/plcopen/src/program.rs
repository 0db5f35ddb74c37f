//! Programs: calls of function blocks by name, the conditions of their execution, and their results.
//!
//! An [`Executor`] calls the blocks once per cycle, in the order of the program, and reports events to a [`Listener`]. Calls are kept on
//! the heap.
mod condition;
mod executor;
mod instance;
mod motion_tracker;
mod running;

pub use condition::Condition;
pub use executor::{Executor, Listener};
pub use motion_tracker::Motion;
pub use running::{Fate, Overdue};

pub(crate) use instance::{Instance, New, called};

use crate::blocks::{BlockName, CamSwitch, Input, Pair, TrackOptions};
use crate::interface::{Table, Tables, Values};
use alloc::string::String;
use alloc::vec::Vec;
use servobench_motion::Limits;

/// Table of an input: by default in the types of blocks, in a file in those of the file.
#[derive(Debug, Clone, PartialEq)]
pub enum Rows<P = Table<Vec<Pair>>, S = Vec<CamSwitch>, T = Vec<TrackOptions>> {
    /// The rows of a profile.
    Profile(P),
    /// The switches of MC_DigitalCamSwitch.
    Switches(S),
    /// The options of tracks of MC_DigitalCamSwitch.
    Tracks(T),
}

impl Tables for Rows {
    fn profile(&self) -> Option<Table<&[Pair]>> {
        if let Self::Profile(table) = self { table.profile() } else { None }
    }

    fn switches(&self) -> &[CamSwitch] {
        if let Self::Switches(switches) = self { switches } else { &[] }
    }

    fn tracks(&self) -> &[TrackOptions] {
        if let Self::Tracks(tracks) = self { tracks } else { &[] }
    }
}

/// Inputs of a call.
pub type Inputs = Values<Rows>;

/// A call of a function block, with a separate instance.
#[derive(Debug, Clone, PartialEq)]
pub struct Call {
    /// Name of the instance, unique.
    pub name: String,
    /// The block.
    pub block: BlockName,
    /// Its inputs.
    pub inputs: Inputs,
    /// Condition at which `Execute` or `Enable` becomes TRUE.
    pub start: Condition,
    /// Condition at which it becomes FALSE; `None`: `Execute` a cycle after the block has ended, `Enable` never.
    pub stop: Option<Condition>,
    /// Longest wait for `start`, from the beginning of the run (s); infinite to wait until the end of the run.
    pub timeout: f64,
    /// True if the run may succeed without the call.
    pub is_optional: bool,
    /// Inputs that change while `Execute` is TRUE, in their order.
    pub updates: Vec<Update>,
}

/// New inputs of a block.
#[derive(Debug, Clone, PartialEq)]
pub struct Update {
    /// Condition of the update.
    pub when: Condition,
    /// All inputs from then on.
    pub inputs: Inputs,
}

/// Limits of an axis: `limits` of |velocity|, |acceleration|, |jerk| and |snap|, and in place of an infinite one the most that any of
/// `calls` requests.
#[must_use]
pub fn limits(limits: &[f64; 4], calls: &[Call]) -> Limits {
    let demands = || calls.iter().flat_map(|call| all_inputs(call).map(|inputs| demand(call.block, inputs)));
    let most = |k: usize| demands().map(|demand| demand[k]).fold(0.0, f64::max);
    let or = |value: f64, otherwise: f64| if value > 0.0 { value } else { otherwise };
    let velocity = or(most(0), 1.0);
    let acceleration = or(most(1), 10.0 * velocity);
    let most = [velocity, acceleration, or(most(2), f64::INFINITY), or(most(3), f64::INFINITY)];
    let [velocity, acceleration, jerk, snap] =
        core::array::from_fn(|k| if limits[k].is_finite() { limits[k] } else { most[k] });
    Limits { velocity, acceleration, jerk, snap }
}

/// Inputs of a call and of its updates.
fn all_inputs(call: &Call) -> impl Iterator<Item = &Inputs> {
    core::iter::once(&call.inputs).chain(call.updates.iter().map(|update| &update.inputs))
}

/// Velocity, acceleration, jerk and snap that a block requests of its axis; zero for quantities that it does not request, infinite for
/// those that it does not limit.
fn demand(block: BlockName, inputs: &Inputs) -> [f64; 4] {
    let of = |input: Input| inputs.number(input).map_or(0.0, f64::abs);
    let free = |input: Input| match block.input(input) {
        Some(_) => inputs.number(input).unwrap_or(f64::INFINITY),
        None => 0.0,
    };
    let velocity = of(Input::Velocity).max(of(Input::VelocityDifference));
    let acceleration = of(Input::Acceleration).max(of(Input::Deceleration));
    [velocity, acceleration, free(Input::Jerk), free(Input::Snap)]
}
