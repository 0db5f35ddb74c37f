//! Order in which blocks are stepped, and the values known to each at its turn.
use crate::Block;
use crate::cycles::{components, is_cycle, shortest_way_round};
use crate::delay::{Delay, oldest};
use crate::fixed_point::FixedPoint;
use crate::network::{NetworkError, Wiring};
use crate::polynomial::Order;
use crate::settings::{Iteration, Method, Settings};
use servobench_base::Divider;

/// One turn.
pub(crate) enum Turn {
    /// A block is stepped once.
    Single(usize),
    /// Blocks are stepped until they agree.
    Loop(Box<FixedPoint>),
}

/// The turns of a communication step.
pub(crate) struct Schedule {
    pub(crate) turns: Vec<Turn>,
    /// True if a block's new values count as soon as it has been stepped.
    pub(crate) announced: bool,
    /// Number of each block's turn.
    place: Vec<usize>,
    /// True if the block's turn is that of a loop.
    repeated: Vec<bool>,
}

impl Schedule {
    pub(crate) fn new<B: Block>(wiring: &Wiring, blocks: &[B], method: &Method) -> Result<Self, NetworkError> {
        let turns = match method {
            Method::Jacobi => (0..blocks.len()).map(Turn::Single).collect(),
            Method::GaussSeidel(order) => {
                let mut sorted = order.clone();
                sorted.sort_unstable();
                if !sorted.iter().copied().eq(0..blocks.len()) {
                    return Err(NetworkError::BadOrder { blocks: blocks.len(), order: order.clone() });
                }
                order.iter().copied().map(Turn::Single).collect()
            }
            Method::Iterated(iteration) => {
                iteration.check()?;
                loops(wiring, blocks, *iteration)?
            }
        };
        let (mut place, mut repeated) = (vec![0; blocks.len()], vec![false; blocks.len()]);
        for (number, turn) in turns.iter().enumerate() {
            match turn {
                Turn::Single(block) => place[*block] = number,
                Turn::Loop(fixed_point) => {
                    for block in &fixed_point.blocks {
                        (place[*block], repeated[*block]) = (number, true);
                    }
                }
            }
        }
        Ok(Self { turns, announced: *method != Method::Jacobi, place, repeated })
    }

    /// True if `to` knows the end of its step from `from`, if both have the same step.
    fn is_known(&self, from: usize, to: usize) -> bool {
        let together = self.place[from] == self.place[to] && self.repeated[from];
        self.announced && (self.place[from] < self.place[to] || together)
    }

    /// The delay of each connection.
    pub(crate) fn delays(&self, wiring: &Wiring, settings: &Settings) -> Vec<Delay> {
        let delay = |(connection, wire): (usize, &crate::network::Connection)| {
            let (from, to) = (wire.from.block, wire.to.block);
            // A signal that changes at events is not known before its time, whichever block is stepped first.
            let is_held = wiring.discrete[wiring.shapes[from].first_output + wire.from.port] && !wire.is_discrete;
            let ahead = self.is_known(from, to) && !is_held;
            let steps = oldest(wiring.shapes[from].every, wiring.shapes[to].every, ahead, !self.announced || is_held);
            let ticks = steps * u64::from(Divider::ticks(settings.step));
            // A signal that lies partly ahead is at least a line.
            let order = match (is_held, ahead) {
                _ if wire.is_discrete => Order::Constant,
                (true, _) => Order::Constant,
                (_, true) => settings.order.max(Order::Linear),
                (_, false) => settings.order,
            };
            Delay { connection, ticks, steps, extrapolated: (steps > 0).then_some(order) }
        };
        wiring.connections.iter().enumerate().map(delay).collect()
    }
}

/// Successors of each block.
pub(crate) fn successors(wiring: &Wiring) -> Vec<Vec<usize>> {
    let mut successors = vec![Vec::new(); wiring.shapes.len()];
    for connection in &wiring.connections {
        successors[connection.from.block].push(connection.to.block);
    }
    successors
}

/// Turns: blocks outside of loops by themselves, the others in their loops, each after its sources.
fn loops<B: Block>(wiring: &Wiring, blocks: &[B], iteration: Iteration) -> Result<Vec<Turn>, NetworkError> {
    let successors = successors(wiring);
    let mut turns = Vec::new();
    for component in components(&successors) {
        if !is_cycle(&component, &successors) {
            turns.push(Turn::Single(component[0]));
            continue;
        }
        let cycle = || wiring.cycle_of_blocks(&shortest_way_round(&component, &successors));
        if let Some(block) = component.iter().find(|block| !blocks[**block].saves_state()) {
            return Err(NetworkError::CannotRepeat { block: wiring.block_name(*block), cycle: cycle() });
        }
        if component.iter().any(|block| wiring.shapes[*block].every != wiring.shapes[component[0]].every) {
            return Err(NetworkError::MixedSteps { cycle: cycle() });
        }
        // The component is ascending, and so is its evaluation.
        let back = |connection: &&crate::network::Connection| {
            let (from, to) = (connection.from.block, connection.to.block);
            from >= to && component.contains(&from) && component.contains(&to)
        };
        let mut unknowns: Vec<usize> = wiring
            .connections
            .iter()
            .filter(back)
            .map(|connection| wiring.shapes[connection.from.block].first_output + connection.from.port)
            .collect();
        unknowns.sort_unstable();
        unknowns.dedup();
        let cycle = cycle();
        turns.push(Turn::Loop(Box::new(FixedPoint::new(wiring, (blocks, component), &unknowns, iteration, cycle))));
    }
    Ok(turns)
}
