//! Blocks and their connections.
use crate::Block;
use std::collections::HashSet;
use std::num::NonZeroU32;
use thiserror::Error;

/// An input of a member.
#[derive(Debug, Clone, PartialEq)]
pub struct InputPort {
    /// Name for messages.
    pub name: String,
    /// Value while nothing is connected.
    pub held: f64,
}

/// A block in a network.
#[derive(Debug, Clone)]
pub struct Member<B> {
    /// Name for messages.
    pub name: String,
    /// Inputs, in the block's order.
    pub inputs: Vec<InputPort>,
    /// Names of the outputs, in the block's order.
    pub outputs: Vec<String>,
    /// Communication steps per step of the block.
    pub every: NonZeroU32,
    /// The block, initialised.
    pub block: B,
}

/// An input or an output.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub struct Port {
    /// Index of the member.
    pub block: usize,
    /// Index among its inputs or its outputs.
    pub port: usize,
}

/// A signal from an output to an input, which gets `gain·output + offset`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Connection {
    /// The output.
    pub from: Port,
    /// The input, to which only one connection may lead.
    pub to: Port,
    /// Factor, for units and signs; finite.
    pub gain: f64,
    /// Summand in the input's unit; finite.
    pub offset: f64,
    /// True if it changes only at exchanges, as the inputs and outputs of a controller do: the newest value holds through a step, even one
    /// that lies ahead. An output that its block declares discrete is held in any case.
    pub is_discrete: bool,
}

/// Blocks and connections.
#[derive(Debug, Clone)]
pub struct Network<B> {
    /// The blocks.
    pub members: Vec<Member<B>>,
    /// The connections.
    pub connections: Vec<Connection>,
}

/// Reasons why a network cannot be run as requested.
#[derive(Debug, Clone, PartialEq, Error)]
pub enum NetworkError {
    /// A connection or a held input names a missing port.
    #[error("{what} {port} of block {block} does not exist: there are {blocks} blocks, and it has {ports} of them")]
    NoPort {
        /// `input` or `output`.
        what: &'static str,
        /// Index of the block.
        block: usize,
        /// Index of the port.
        port: usize,
        /// Number of blocks.
        blocks: usize,
        /// Number of its ports of this kind.
        ports: usize,
    },
    /// Two connections lead to one input.
    #[error("`{input}` has two connections; one can lead to it: add the signals in a block")]
    Occupied {
        /// The input.
        input: String,
    },
    /// A gain, an offset or a held value is not finite.
    #[error("`{field}` of `{of}` must be finite, got {value}")]
    NotFinite {
        /// Field that is not finite.
        field: &'static str,
        /// Connection or input.
        of: String,
        /// Its value.
        value: f64,
    },
    /// A setting of the iteration is out of its range.
    #[error("`{field}` of the iteration must be {bound}, got {value}")]
    Setting {
        /// Field.
        field: &'static str,
        /// Required range.
        bound: &'static str,
        /// Its value.
        value: f64,
    },
    /// The order of blocks does not name each of them once.
    #[error("the order of blocks must name each of the {blocks} blocks once, got {order:?}")]
    BadOrder {
        /// Number of blocks.
        blocks: usize,
        /// The requested order.
        order: Vec<usize>,
    },
    /// A block in an iterated loop cannot repeat a step.
    #[error(
        "`{block}` cannot save its state, so the loop {cycle} cannot be iterated: couple by Gauss-Seidel, or cut the loop at a block that can"
    )]
    CannotRepeat {
        /// The block.
        block: String,
        /// The blocks of the loop.
        cycle: String,
    },
    /// Blocks with different steps in an iterated loop.
    #[error(
        "the blocks of the loop {cycle} have different steps, so it cannot be iterated: give them one, or couple by Gauss-Seidel"
    )]
    MixedSteps {
        /// The blocks of the loop.
        cycle: String,
    },
    /// Outputs that follow each other without a step.
    #[error(
        "algebraic loop {cycle}: each follows the one before without a step; solve the loop, or put a block with a state into it"
    )]
    AlgebraicLoop {
        /// The outputs of the loop.
        cycle: String,
    },
}

/// Places of the ports of a block among those of all blocks.
#[derive(Debug, Clone)]
pub(crate) struct Shape {
    pub(crate) first_input: usize,
    pub(crate) inputs: usize,
    pub(crate) first_output: usize,
    pub(crate) outputs: usize,
    /// Communication steps per step.
    pub(crate) every: u32,
}

/// Source of an input's value.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Wire {
    /// Block of the output and number among those of all blocks; `None` for a constant.
    pub(crate) source: Option<Source>,
    pub(crate) gain: f64,
    /// The constant, if there is no source.
    pub(crate) offset: f64,
    /// True if the newest value holds.
    pub(crate) is_discrete: bool,
}

#[derive(Debug, Clone, Copy)]
pub(crate) struct Source {
    pub(crate) block: usize,
    pub(crate) output: usize,
}

/// The network without its blocks.
#[derive(Debug, Clone)]
pub(crate) struct Wiring {
    pub(crate) shapes: Vec<Shape>,
    /// Wires by input.
    pub(crate) wires: Vec<Wire>,
    pub(crate) connections: Vec<Connection>,
    /// True for outputs that change only at events.
    pub(crate) discrete: Vec<bool>,
    block_names: Vec<String>,
    input_names: Vec<String>,
    output_names: Vec<String>,
}

impl Wiring {
    pub(crate) fn new<B: Block>(network: &Network<B>) -> Result<Self, NetworkError> {
        let mut wiring = Self {
            shapes: Vec::new(),
            wires: Vec::new(),
            connections: network.connections.clone(),
            discrete: Vec::new(),
            block_names: Vec::new(),
            input_names: Vec::new(),
            output_names: Vec::new(),
        };
        for member in &network.members {
            wiring.shapes.push(Shape {
                first_input: wiring.input_names.len(),
                inputs: member.inputs.len(),
                first_output: wiring.output_names.len(),
                outputs: member.outputs.len(),
                every: member.every.get(),
            });
            wiring.block_names.push(member.name.clone());
            wiring.input_names.extend(member.inputs.iter().map(|input| format!("{}.{}", member.name, input.name)));
            wiring.discrete.extend((0..member.outputs.len()).map(|output| member.block.is_discrete(output)));
            wiring.output_names.extend(member.outputs.iter().map(|output| format!("{}.{output}", member.name)));
            wiring.wires.extend(member.inputs.iter().map(|i| Wire {
                source: None,
                gain: 0.0,
                offset: i.held,
                is_discrete: false,
            }));
        }
        for (wire, name) in wiring.wires.iter().zip(&wiring.input_names) {
            finite("held", wire.offset, || name.clone())?;
        }
        wiring.connect()?;
        Ok(wiring)
    }

    fn connect(&mut self) -> Result<(), NetworkError> {
        let mut occupied = HashSet::new();
        for index in 0..self.connections.len() {
            let Connection { from, to, gain, offset, is_discrete } = self.connections[index];
            let (output, input) = (self.output(from)?, self.input(to)?);
            finite("gain", gain, || self.connection_name(index))?;
            finite("offset", offset, || self.connection_name(index))?;
            if !occupied.insert(input) {
                return Err(NetworkError::Occupied { input: self.input_names[input].clone() });
            }
            self.wires[input] = Wire { source: Some(Source { block: from.block, output }), gain, offset, is_discrete };
        }
        Ok(())
    }

    /// Number of an input among those of all blocks.
    pub(crate) fn input(&self, at: Port) -> Result<usize, NetworkError> {
        let inputs = self.shapes.get(at.block).map_or(0, |shape| shape.inputs);
        let no_port = || self.no_port("input", at, inputs);
        if at.port < inputs { Ok(self.shapes[at.block].first_input + at.port) } else { Err(no_port()) }
    }

    /// Number of an output among those of all blocks.
    pub(crate) fn output(&self, at: Port) -> Result<usize, NetworkError> {
        let outputs = self.shapes.get(at.block).map_or(0, |shape| shape.outputs);
        let no_port = || self.no_port("output", at, outputs);
        if at.port < outputs { Ok(self.shapes[at.block].first_output + at.port) } else { Err(no_port()) }
    }

    fn no_port(&self, what: &'static str, at: Port, ports: usize) -> NetworkError {
        NetworkError::NoPort { what, block: at.block, port: at.port, blocks: self.shapes.len(), ports }
    }

    /// Number of all outputs.
    pub(crate) fn outputs(&self) -> usize {
        self.output_names.len()
    }

    pub(crate) fn block_name(&self, block: usize) -> String {
        self.block_names[block].clone()
    }

    pub(crate) fn output_name(&self, output: usize) -> String {
        self.output_names[output].clone()
    }

    /// `a.x -> b.u`
    pub(crate) fn connection_name(&self, index: usize) -> String {
        let Connection { from, to, .. } = self.connections[index];
        let (output, input) = (self.shapes[from.block].first_output, self.shapes[to.block].first_input);
        format!("{} -> {}", self.output_names[output + from.port], self.input_names[input + to.port])
    }

    /// Block of an output.
    pub(crate) fn block_of(&self, output: usize) -> usize {
        self.shapes.partition_point(|shape| shape.first_output + shape.outputs <= output)
    }

    /// The blocks as `a -> b -> a`.
    pub(crate) fn cycle_of_blocks(&self, blocks: &[usize]) -> String {
        cycle(blocks.iter().map(|block| self.block_names[*block].as_str()))
    }

    /// The outputs as `a.y -> b.y -> a.y`.
    pub(crate) fn cycle_of_outputs(&self, outputs: &[usize]) -> String {
        cycle(outputs.iter().map(|output| self.output_names[*output].as_str()))
    }
}

fn cycle<'a>(mut names: impl Iterator<Item = &'a str> + Clone) -> String {
    let first = names.clone().next().unwrap_or_default();
    let mut text = names.by_ref().collect::<Vec<_>>().join(" -> ");
    text.push_str(" -> ");
    text.push_str(first);
    text
}

fn finite(field: &'static str, value: f64, of: impl Fn() -> String) -> Result<(), NetworkError> {
    if value.is_finite() { Ok(()) } else { Err(NetworkError::NotFinite { field, of: of(), value }) }
}
