//! The matrices of a loop's ticks with some of its loops closed and its gains scaled.
use crate::error::StabilityError;
use crate::model::Loop;
use servobench_base::Divider;
use servobench_drive::Stage;
use servobench_linear::{CONTROLLERS, Factors, MECHANICS, Matrices, Running, TickMatrix};
use std::rc::Rc;

/// Names of velocities of the bodies, from the motor on.
const VELOCITY: &str = "mechanics.velocity";
/// Name of the effort of the motor, through which the controllers act on the bodies.
const EFFORT: &str = "controllers.effort";
/// Ends of the names of the motor's currents.
const CURRENTS: [&str; 2] = [".state.current.d", ".state.current.q"];

/// Ticks with the same matrix.
#[derive(Debug, Clone, Copy)]
struct Kind {
    /// Number of the first of these ticks.
    tick: u32,
    turns: Turns,
}

/// Gains that act at a tick.
#[derive(Debug, Clone, Copy)]
struct Turns {
    position: bool,
    velocity: bool,
    current: bool,
}

/// The order of kinds in a period.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) struct Order {
    /// Cycles of the tasks in ticks, from 1 on: each is a whole number of the one before.
    pub(crate) every: Vec<u32>,
    /// Kinds of the last ticks of the longest of these cycles, as many as there are in a period. Shorter cycles end with the kinds
    /// 0, 1, ….
    pub(crate) ends: Vec<usize>,
}

impl Order {
    /// The kind of each tick of a period.
    pub(crate) fn ticks(&self) -> Vec<usize> {
        let Some((cycle, below)) = self.every.split_last() else { return Vec::new() };
        let kind = |tick: u32| below.iter().rposition(|every| tick.is_multiple_of(*every)).unwrap_or(0);
        self.ends.iter().flat_map(|&end| (1..*cycle).map(kind).chain([end])).collect()
    }
}

/// Closed loops; the current loop is always closed.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct Closed {
    pub(crate) position: bool,
    pub(crate) velocity: bool,
    /// True if the shaft turns; a current loop by itself is analysed with the shaft held.
    pub(crate) shaft: bool,
}

/// The matrices of a running loop, with its closed loops and gains.
pub(crate) struct Equations<'a> {
    model: &'a Loop,
    matrices: Matrices<'a>,
    /// Kinds of ticks: those of tasks faster than a step of the position loop, from every tick on, then those of the steps in a period.
    kinds: Vec<Kind>,
    /// Ticks from step to step of the position loop, or of the interpolation between its cycles.
    step: u32,
    names: Vec<String>,
    closed: Closed,
    factors: Factors,
    scheduled: (f64, f64),
    /// States of the loops for the last closed loops: gains do not change which states act on which.
    loops: Option<(Closed, Rc<Vec<Vec<usize>>>)>,
}

impl<'a> Equations<'a> {
    pub(crate) fn new(model: &'a Loop, running: Box<dyn Running + 'a>) -> Result<Self, StabilityError> {
        let drive = &model.drive;
        let (current, velocity, step) =
            (current_every(model), drive.velocity_every.ticks(), drive.position_every.ticks());
        let position = model.master_cycle.map_or(step, Divider::ticks);
        let mut faster = vec![1, current, velocity];
        faster.retain(|&every| every < step);
        faster.dedup();
        // The drive interpolates between the velocities of a master, so that each of its steps differs.
        let ticks: Vec<u32> = faster.into_iter().chain((1..=position / step).map(|number| number * step)).collect();
        let of = |&tick: &u32| Kind {
            tick,
            turns: Turns { position: tick == position, velocity: tick >= velocity, current: tick >= current },
        };
        let kinds = ticks.iter().map(of).collect();
        let matrices = Matrices::new(running, &ticks)?;
        let names = matrices.names().map(str::to_owned).collect();
        let closed = Closed { position: model.has_position_loop(), velocity: true, shaft: true };
        Ok(Self {
            model,
            matrices,
            kinds,
            step,
            names,
            closed,
            factors: Factors::ONE,
            scheduled: (1.0, 1.0),
            loops: None,
        })
    }

    /// The matrix of a tick of kind `index`.
    pub(crate) fn matrix(&mut self, index: usize) -> Result<TickMatrix, StabilityError> {
        let kind = self.kinds[index].turns;
        let (closed, factors, one) = (self.closed, self.factors, Factors::ONE);
        let by = |is_due: bool, is_closed: bool, factor: f64| match (is_due, is_closed) {
            (false, _) => 1.0,
            (true, false) => 0.0,
            (true, true) => factor,
        };
        let is_velocity_due = kind.velocity && closed.shaft;
        let factors = Factors {
            position: by(kind.position, closed.position, factors.position * self.scheduled.0),
            velocity: by(is_velocity_due, closed.velocity, factors.velocity * self.scheduled.1),
            compensation: by(is_velocity_due, closed.velocity, 1.0),
            current: if kind.current { factors.current } else { one.current },
        };
        let mut found = self.matrices.matrix(index, &factors)?;
        let uncertainty = self.model.mechanics.uncertainty();
        if uncertainty > 0.0 {
            let magnitude = found.magnitude.get_or_insert_with(|| found.matrix.abs());
            for (row, _) in self.names.iter().enumerate().filter(|(_, name)| name.starts_with(MECHANICS)) {
                let error = magnitude.row(row).amax() * uncertainty / f64::EPSILON;
                magnitude.row_mut(row).add_scalar_mut(error);
            }
        }
        if !closed.shaft {
            // Bodies that are held do not move, no matter what acts on them.
            for (index, name) in self.names.iter().enumerate() {
                if name.starts_with(MECHANICS) {
                    found.matrix.row_mut(index).fill(0.0);
                }
                if name.starts_with(MECHANICS) || name == EFFORT {
                    found.matrix.column_mut(index).fill(0.0);
                }
            }
        }
        Ok(found)
    }

    /// Sets the closed loops and the factors on the gains.
    pub(crate) const fn with(&mut self, closed: Closed, factors: Factors) {
        (self.closed, self.factors) = (closed, factors);
    }

    /// Sets the factors of a gain schedule on the gains of position and velocity loop.
    pub(crate) const fn schedule(&mut self, factors: (f64, f64)) {
        self.scheduled = factors;
    }

    pub(crate) const fn model(&self) -> &'a Loop {
        self.model
    }

    /// The order of ticks in the period of the closed loops: an open one does not lengthen it, because the loops below it repeat
    /// faster.
    pub(crate) fn order(&self) -> Order {
        let Closed { position, shaft, .. } = self.closed;
        let faster: Vec<u32> = self.kinds.iter().map(|kind| kind.tick).take_while(|tick| *tick < self.step).collect();
        let is_slowest = |kind: &Kind| if shaft { kind.turns.velocity } else { kind.turns.current };
        let slowest = self.kinds.iter().position(is_slowest).unwrap_or(0);
        if let Some(every) = faster.get(..=slowest).filter(|_| !position) {
            return Order { every: every.to_vec(), ends: vec![slowest] };
        }
        let steps = faster.len()..if position { self.kinds.len() } else { faster.len() + 1 };
        Order { every: faster.into_iter().chain([self.step]).collect(), ends: steps.collect() }
    }

    /// Number of states.
    pub(crate) const fn states(&self) -> usize {
        self.names.len()
    }

    /// True for states of the controllers.
    pub(crate) fn controllers(&self) -> Vec<bool> {
        self.names.iter().map(|name| name.starts_with(CONTROLLERS)).collect()
    }

    /// Index of the motor's velocity.
    pub(crate) fn motor_velocity(&self) -> Option<usize> {
        self.velocities().next()
    }

    /// Velocities of the bodies, from the motor on.
    pub(crate) fn velocities(&self) -> impl Iterator<Item = usize> {
        self.indices(|name| name == VELOCITY)
    }

    /// Currents of the motor.
    pub(crate) fn currents(&self) -> [Option<usize>; 2] {
        CURRENTS.map(|end| self.indices(|name| name.ends_with(end)).next())
    }

    fn indices(&self, is_one: impl Fn(&str) -> bool) -> impl Iterator<Item = usize> {
        self.names.iter().enumerate().filter(move |(_, name)| is_one(name)).map(|(index, _)| index)
    }

    /// States of the loops, if they are known.
    pub(crate) fn known_loops(&self) -> Option<Rc<Vec<Vec<usize>>>> {
        self.loops.as_ref().filter(|(closed, _)| *closed == self.closed).map(|(_, loops)| Rc::clone(loops))
    }

    pub(crate) fn keep_loops(&mut self, loops: &Rc<Vec<Vec<usize>>>) {
        self.loops = Some((self.closed, Rc::clone(loops)));
    }

    /// Base tick (s).
    pub(crate) fn h(&self) -> f64 {
        self.model.drive.base_rate.period()
    }

    /// True if there is one pole at 1 within the current loop for physical reasons: without viscous friction and without a
    /// velocity loop the axis keeps any constant speed, because the integrators hold the current at its reference at any
    /// back-EMF. A current that is held over several ticks while the rotor turns is not quite at its reference.
    pub(crate) fn turns_freely(&self) -> bool {
        let (closed, model) = (self.closed, self.model);
        let is_open = !closed.velocity || model.drive.velocity.k_p == 0.0;
        let holds_current = match &model.drive.stage {
            Stage::Current { every, .. } => model.d_current == 0.0 || every.ticks() == 1,
            Stage::Direct { .. } => false,
        };
        closed.shaft && is_open && holds_current && model.mechanics.is_free()
    }
}

fn current_every(model: &Loop) -> u32 {
    match &model.drive.stage {
        Stage::Current { every, .. } => every.ticks(),
        Stage::Direct { .. } => model.drive.velocity_every.ticks(),
    }
}
