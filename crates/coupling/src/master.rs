//! The master: sets up the run of a network, and advances it from exchange to exchange.
use crate::cycles::{components, is_cycle};
use crate::delay::Delay;
use crate::error::CouplingError;
use crate::estimate::{EstimatedError, Estimates};
use crate::network::{Network, NetworkError, Port, Wiring};
use crate::polynomial::Order;
use crate::schedule::{Schedule, Turn, successors};
use crate::settings::{Method, Settings};
use crate::settle::{Plan, Reading};
use crate::signals::Signals;
use crate::watch::Watch;
use crate::{Block, Input};
use servobench_base::{Rate, Tick};

/// Result of a communication step.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Advance {
    /// Completed.
    Done,
    /// A block ends the simulation, possibly within an iteration; there are no more exchanges.
    Terminated {
        /// Index of the block.
        block: usize,
        /// Time (s).
        time: f64,
    },
}

/// A running coupled simulation.
pub struct Master<B> {
    pub(crate) blocks: Vec<B>,
    pub(crate) wiring: Wiring,
    pub(crate) signals: Signals,
    schedule: Schedule,
    plan: Plan,
    delays: Vec<Delay>,
    pub(crate) clock: Clock,
    /// Communication step that each block has reached.
    pub(crate) reached: Vec<u64>,
    /// True for blocks whose outputs have been read since their step.
    pub(crate) fresh: Vec<bool>,
    /// True for blocks that returned early in their last step.
    pub(crate) is_interrupted: Vec<bool>,
    watches: Vec<Watched>,
    pub(crate) estimates: Estimates,
    pub(crate) inputs: Vec<Input>,
    pub(crate) present: Vec<f64>,
    pub(crate) outputs: Vec<f64>,
    ended: Option<Advance>,
    /// Possible remedy for an unstable coupling.
    help: &'static str,
}

/// An output of a loop.
struct Watched {
    block: usize,
    output: usize,
    connection: usize,
    watch: Watch,
}

/// Counter of communication steps; seconds are computed from base ticks.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Clock {
    rate: Rate,
    ticks: u64,
    pub(crate) now: u64,
}

impl Clock {
    pub(crate) fn tick(self, step: u64) -> Tick {
        Tick(step * self.ticks)
    }

    pub(crate) fn time(self, step: u64) -> f64 {
        self.rate.time(self.tick(step))
    }
}

impl<B: Block> Master<B> {
    /// Couples the blocks of `network`, which are at time 0, and makes their first exchange.
    ///
    /// # Errors
    /// [`CouplingError::Network`] for a network that cannot be run this way; the others if the first exchange fails.
    pub fn new(network: Network<B>, settings: &Settings) -> Result<Self, CouplingError<B::Error>> {
        let wiring = Wiring::new(&network)?;
        let blocks: Vec<B> = network.members.into_iter().map(|member| member.block).collect();
        let schedule = Schedule::new(&wiring, &blocks, &settings.method)?;
        let plan = Plan::new(&wiring, &blocks, settings.algebraic)?;
        let clock = Clock { rate: settings.base_rate, ticks: u64::from(settings.step.ticks()), now: 0 };
        let length = clock.time(1);
        let delays = schedule.delays(&wiring, settings);
        let most = |ports: fn(&crate::network::Shape) -> usize| wiring.shapes.iter().map(ports).max().unwrap_or(0);
        let mut master = Self {
            signals: Signals::new(&wiring, settings.order, length),
            estimates: Estimates::new(&wiring, &delays, settings.order),
            delays,
            reached: vec![0; blocks.len()],
            fresh: vec![false; blocks.len()],
            is_interrupted: vec![false; blocks.len()],
            watches: if settings.watch { watched(&wiring) } else { Vec::new() },
            inputs: vec![[0.0; 3]; most(|shape| shape.inputs)],
            present: vec![0.0; most(|shape| shape.inputs)],
            outputs: vec![0.0; most(|shape| shape.outputs)],
            ended: None,
            help: help(settings),
            blocks,
            wiring,
            schedule,
            plan,
            clock,
        };
        master.start(settings)?;
        Ok(master)
    }

    /// The first exchange: the search for a loop's solution starts from its outputs without inputs.
    fn start(&mut self, settings: &Settings) -> Result<(), CouplingError<B::Error>> {
        if self.blocks.iter().any(Block::has_initial_equations) {
            self.initialise(settings)?;
        }
        self.read_all()?;
        self.settle(0)
    }

    /// Reads all outputs without inputs.
    fn read_all(&mut self) -> Result<(), CouplingError<B::Error>> {
        for block in 0..self.blocks.len() {
            self.signals.open(block, 0);
            self.read(block, None)?;
        }
        Ok(())
    }

    /// Solves the initial equations of all blocks together, and starts the blocks that have them with the result.
    fn initialise(&mut self, settings: &Settings) -> Result<(), CouplingError<B::Error>> {
        let start = Plan::of_start(&self.wiring, &self.blocks, settings.algebraic)?;
        let plan = std::mem::replace(&mut self.plan, start);
        self.read_all()?;
        self.settle(0)?;
        self.plan = plan;
        for block in 0..self.blocks.len() {
            if self.blocks[block].has_initial_equations() {
                self.begin(block)?;
            }
        }
        self.fresh.fill(false);
        Ok(())
    }

    /// Performs one communication step, up to the next exchange. Does nothing once a block has ended the simulation.
    ///
    /// # Errors
    /// [`CouplingError`]; the simulation cannot continue then.
    pub fn advance(&mut self) -> Result<Advance, CouplingError<B::Error>> {
        if let Some(ended) = self.ended {
            return Ok(ended);
        }
        let mut turns = std::mem::take(&mut self.schedule.turns);
        let outcome = self.take(&mut turns);
        self.schedule.turns = turns;
        if let Some(ended) = outcome? {
            self.ended = Some(ended);
            return Ok(ended);
        }
        let now = self.clock.now + 1;
        self.settle(now)?;
        self.judge(now)?;
        self.clock.now = now;
        Ok(Advance::Done)
    }

    /// Steps all blocks that are due.
    fn take(&mut self, turns: &mut [Turn]) -> Result<Option<Advance>, CouplingError<B::Error>> {
        for turn in turns {
            let ended = match turn {
                Turn::Single(block) => self.single(*block)?,
                Turn::Loop(fixed_point) => self.repeat(fixed_point)?,
            };
            if ended.is_some() {
                return Ok(ended);
            }
        }
        Ok(None)
    }

    fn single(&mut self, block: usize) -> Result<Option<Advance>, CouplingError<B::Error>> {
        if self.reached[block] > self.clock.now {
            return Ok(None);
        }
        let ended = self.step(block)?;
        if ended.is_none() && self.schedule.announced {
            self.announce(block, self.plan.follows[block])?;
        }
        Ok(ended)
    }

    /// True if outputs of `block` follow inputs without a step.
    pub(crate) fn follows(&self, block: usize) -> bool {
        self.plan.follows[block]
    }

    /// Reads the outputs that are due at the exchange `now`, in the order of the plan.
    fn settle(&mut self, now: u64) -> Result<(), CouplingError<B::Error>> {
        let mut readings = std::mem::take(&mut self.plan.readings);
        let outcome = readings.iter_mut().try_for_each(|reading| match reading {
            Reading::Plain(block) if self.reached[*block] == now && !self.fresh[*block] => {
                self.signals.open(*block, now);
                self.read(*block, None)
            }
            Reading::Following(block) if self.reached[*block] == now => self.follow(*block, now),
            Reading::Loop(fixed_point) => self.solve(fixed_point, now),
            Reading::Plain(_) | Reading::Following(_) => Ok(()),
        });
        self.plan.readings = readings;
        outcome
    }

    /// Checks the exchange for growth, and updates the estimates.
    fn judge(&mut self, now: u64) -> Result<(), CouplingError<B::Error>> {
        for Watched { block, output, connection, watch } in &mut self.watches {
            if self.reached[*block] == now
                && let Some(growth) = watch.push(self.signals.newest(*output), self.signals.defect(*output))
            {
                return Err(CouplingError::Unstable {
                    connection: self.wiring.connection_name(*connection),
                    step: now,
                    time: self.clock.time(now),
                    growth: growth.factor,
                    exchanges: growth.exchanges,
                    length: self.clock.time(1),
                    help: self.help,
                });
            }
        }
        self.estimates.judge(now, &self.reached, &self.wiring.wires, |output| self.signals.newest(output));
        for block in 0..self.blocks.len() {
            if self.reached[block] == now && std::mem::take(&mut self.is_interrupted[block]) {
                self.signals.restart(block);
            }
        }
        Ok(())
    }

    /// Time of the last exchange.
    #[must_use]
    pub fn tick(&self) -> Tick {
        self.clock.tick(self.clock.now)
    }

    /// Time of the last exchange (s).
    #[must_use]
    pub fn time(&self) -> f64 {
        self.clock.time(self.clock.now)
    }

    /// An output at the last exchange; between two steps of its block its polynomial there.
    ///
    /// # Errors
    /// [`NetworkError::NoPort`]
    pub fn value(&self, output: Port) -> Result<f64, NetworkError> {
        let number = self.wiring.output(output)?;
        Ok(self.signals.value(output.block, number, self.clock.now))
    }

    /// The delay of each connection, in the order of the connections.
    #[must_use]
    pub fn delays(&self) -> &[Delay] {
        &self.delays
    }

    /// Error of the inputs within a step, estimated from the exchanges so far, for the connection with the largest; `None` if no
    /// continuous signal was exchanged often enough.
    #[must_use]
    pub fn estimated_error(&self) -> Option<EstimatedError> {
        self.estimates.largest()
    }

    /// A block.
    #[must_use]
    pub fn block(&self, block: usize) -> &B {
        &self.blocks[block]
    }

    /// A block, for inspection; only the master may step it.
    #[must_use]
    pub fn block_mut(&mut self, block: usize) -> &mut B {
        &mut self.blocks[block]
    }

    /// The blocks in their last state.
    #[must_use]
    pub fn into_blocks(self) -> Vec<B> {
        self.blocks
    }
}

/// Possible remedies for an unstable coupling, besides a smaller step.
fn help(settings: &Settings) -> &'static str {
    match (&settings.method, settings.order) {
        (Method::Iterated(_), Order::Quadratic) => "a lower order, or cut the loop elsewhere",
        (Method::Iterated(_), _) => "or cut the loop elsewhere",
        _ => "iterate the loop, or cut it elsewhere",
    }
}

/// The outputs that lead from a loop of blocks back into it, each by one of its connections. A signal that changes only at exchanges
/// is left out: sampling and holding there is the task of a controller, not an approximation of it.
fn watched(wiring: &Wiring) -> Vec<Watched> {
    let successors = successors(wiring);
    let mut found: Vec<Watched> = Vec::new();
    for component in components(&successors).iter().filter(|component| is_cycle(component, &successors)) {
        for (connection, wire) in wiring.connections.iter().enumerate() {
            let output = wiring.shapes[wire.from.block].first_output + wire.from.port;
            let inside = component.contains(&wire.from.block) && component.contains(&wire.to.block);
            let inside = inside && !wire.is_discrete && !wiring.discrete[output];
            if inside && found.iter().all(|watched| watched.output != output) {
                found.push(Watched { block: wire.from.block, output, connection, watch: Watch::default() });
            }
        }
    }
    found
}
