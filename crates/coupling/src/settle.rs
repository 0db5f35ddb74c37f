//! Order in which outputs are read at an exchange, if some of them follow inputs without a step.
//!
//! The outputs are nodes of a graph; an edge leads from an output to each output that follows it through a connection and the
//! feedthrough of a block. Outputs that follow nothing are read first, the others after their sources; a cycle is an algebraic
//! loop and is solved as a whole, or refused. Breaking it by a delay instead would make the coupled simulation unstable wherever
//! the loop's gain exceeds 1, whatever the step (Kübler & Schiehlen 2000, §4; Arnold & Günther, BIT 41 (2001) 1).
use crate::Block;
use crate::cycles::{components, is_cycle, shortest_way_round};
use crate::fixed_point::FixedPoint;
use crate::network::{NetworkError, Wiring};
use crate::settings::Iteration;

/// One reading.
pub(crate) enum Reading {
    /// Outputs that follow no input.
    Plain(usize),
    /// Outputs that follow inputs, which are then known.
    Following(usize),
    /// Outputs that follow each other.
    Loop(Box<FixedPoint>),
}

/// The readings of an exchange. `follows` is true for blocks with outputs that follow inputs.
pub(crate) struct Plan {
    pub(crate) readings: Vec<Reading>,
    pub(crate) follows: Vec<bool>,
}

/// Level of an output in the plan; true if it is in a loop.
#[derive(Clone, Copy, Default)]
struct Level {
    level: usize,
    in_loop: bool,
}

impl Plan {
    /// The plan of an exchange.
    pub(crate) fn new<B: Block>(wiring: &Wiring, blocks: &[B], solve: Option<Iteration>) -> Result<Self, NetworkError> {
        Self::of(wiring, blocks, solve, B::feeds_through)
    }

    /// The plan of the initialisation.
    pub(crate) fn of_start<B: Block>(
        wiring: &Wiring,
        blocks: &[B],
        solve: Option<Iteration>,
    ) -> Result<Self, NetworkError> {
        Self::of(wiring, blocks, solve, B::follows_at_start)
    }

    fn of<B: Block>(
        wiring: &Wiring,
        blocks: &[B],
        solve: Option<Iteration>,
        follows: impl Fn(&B, usize, usize) -> bool,
    ) -> Result<Self, NetworkError> {
        solve.map_or(Ok(()), |iteration| iteration.check())?;
        let through = Feedthrough::new(wiring, blocks, follows);
        let mut levels = vec![Level::default(); wiring.outputs()];
        let mut loops = Vec::new();
        for component in components(&through.successors) {
            let sources = component.iter().flat_map(|output| &through.predecessors[*output]);
            let after = sources.filter(|source| !component.contains(source)).map(|source| levels[*source].level).max();
            let follows = component.iter().any(|output| through.follows[*output]);
            let level = after.map_or(usize::from(follows), |level| level + 1);
            let in_loop = is_cycle(&component, &through.successors);
            for output in &component {
                levels[*output] = Level { level, in_loop };
            }
            if in_loop {
                let cycle = wiring.cycle_of_outputs(&shortest_way_round(&component, &through.successors));
                let Some(iteration) = solve else { return Err(NetworkError::AlgebraicLoop { cycle }) };
                loops.push((level, through.fixed_point((wiring, blocks), &component, iteration, cycle)));
            }
        }
        Ok(Self { readings: readings(wiring, &levels, loops), follows: through.by_block(wiring) })
    }
}

/// Readings by level; several outputs of a block on a level are one reading.
fn readings(wiring: &Wiring, levels: &[Level], loops: Vec<(usize, FixedPoint)>) -> Vec<Reading> {
    let mut readings: Vec<(usize, Reading)> =
        loops.into_iter().map(|(level, fixed_point)| (level, Reading::Loop(Box::new(fixed_point)))).collect();
    for (block, shape) in wiring.shapes.iter().enumerate() {
        let own = &levels[shape.first_output..shape.first_output + shape.outputs];
        let mut needed: Vec<usize> = own.iter().filter(|level| !level.in_loop).map(|level| level.level).collect();
        needed.sort_unstable();
        needed.dedup();
        readings.extend(
            needed
                .into_iter()
                .map(|level| (level, if level == 0 { Reading::Plain(block) } else { Reading::Following(block) })),
        );
    }
    readings.sort_by_key(|(level, _)| *level);
    readings.into_iter().map(|(_, reading)| reading).collect()
}

/// Outputs that follow each other without a step.
struct Feedthrough {
    successors: Vec<Vec<usize>>,
    predecessors: Vec<Vec<usize>>,
    /// True for outputs that follow any input of their block.
    follows: Vec<bool>,
}

impl Feedthrough {
    fn new<B: Block>(wiring: &Wiring, blocks: &[B], follows: impl Fn(&B, usize, usize) -> bool) -> Self {
        let outputs = wiring.outputs();
        let mut found = Self {
            successors: vec![Vec::new(); outputs],
            predecessors: vec![Vec::new(); outputs],
            follows: vec![false; outputs],
        };
        for (block, shape) in blocks.iter().zip(&wiring.shapes) {
            for output in 0..shape.outputs {
                for input in (0..shape.inputs).filter(|input| follows(block, output, *input)) {
                    let to = shape.first_output + output;
                    found.follows[to] = true;
                    if let Some(source) = wiring.wires[shape.first_input + input].source {
                        found.successors[source.output].push(to);
                        found.predecessors[to].push(source.output);
                    }
                }
            }
        }
        found
    }

    /// The loop of the outputs `component`: its blocks ascending, the outputs to the same block or an earlier one unknown.
    fn fixed_point<B: Block>(
        &self,
        (wiring, all): (&Wiring, &[B]),
        component: &[usize],
        iteration: Iteration,
        cycle: String,
    ) -> FixedPoint {
        let mut blocks: Vec<usize> = component.iter().map(|output| wiring.block_of(*output)).collect();
        blocks.dedup();
        let goes_back = |output: &usize| {
            let next = self.successors[*output].iter().filter(|next| component.contains(next));
            next.into_iter().any(|next| wiring.block_of(*output) >= wiring.block_of(*next))
        };
        let unknowns: Vec<usize> = component.iter().copied().filter(goes_back).collect();
        FixedPoint::new(wiring, (all, blocks), &unknowns, iteration, cycle)
    }

    fn by_block(&self, wiring: &Wiring) -> Vec<bool> {
        let of = |shape: &crate::network::Shape| {
            self.follows[shape.first_output..shape.first_output + shape.outputs].contains(&true)
        };
        wiring.shapes.iter().map(of).collect()
    }
}
