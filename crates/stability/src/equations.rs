//! The matrices of a loop's ticks with some of its loops closed and its gains by factors.
use crate::error::StabilityError;
use crate::model::Loop;
use servobench_drive::Stage;
use servobench_linear::{CONTROLLERS, Factors, MECHANICS, Matrices, Running, TickMatrix};
use std::rc::Rc;

/// Names of velocities of the bodies, from the motor on.
const VELOCITY: &str = "mechanics.velocity";
/// Name of the effort of the motor, by which the controllers act on the bodies.
const EFFORT: &str = "controllers.effort";
/// Ends of the names of the motor's currents.
const CURRENTS: [&str; 2] = [".state.current.d", ".state.current.q"];

/// Which loops have their turn at a tick.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct Due {
    pub(crate) position: bool,
    pub(crate) velocity: bool,
    pub(crate) current: bool,
}

/// Which loops are closed; the current loop always is.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct Closed {
    pub(crate) position: bool,
    pub(crate) velocity: bool,
    /// Whether the shaft turns; a current loop by itself is looked at with the shaft held.
    pub(crate) shaft: bool,
}

/// The matrices of a loop that runs, and which of it is closed.
pub(crate) struct Equations<'a> {
    model: &'a Loop,
    matrices: Matrices<'a>,
    kinds: Vec<Due>,
    names: Vec<String>,
    closed: Closed,
    factors: Factors,
    scheduled: (f64, f64),
    /// The loops of what was closed last: no gain changes what acts on what.
    loops: Option<(Closed, Rc<Vec<Vec<usize>>>)>,
}

impl<'a> Equations<'a> {
    pub(crate) fn new(model: &'a Loop, running: Box<dyn Running + 'a>) -> Result<Self, StabilityError> {
        let drive = &model.drive;
        let current = current_every(model);
        let (velocity, position) = (drive.velocity_every.ticks(), drive.position_every.ticks());
        let mut kinds = Vec::new();
        let mut ticks: Vec<u32> = Vec::new();
        for tick in [position, velocity, current, 1] {
            if !ticks.contains(&tick) {
                ticks.push(tick);
                kinds.push(Due { position: tick == position, velocity: tick >= velocity, current: tick >= current });
            }
        }
        let matrices = Matrices::new(running, &ticks)?;
        let names = matrices.names().map(str::to_owned).collect();
        let closed = Closed { position: model.closes_position, velocity: true, shaft: true };
        Ok(Self { model, matrices, kinds, names, closed, factors: Factors::ONE, scheduled: (1.0, 1.0), loops: None })
    }

    /// The matrix of a tick at the end of which the loops `due` turn.
    pub(crate) fn matrix(&mut self, due: Due) -> Result<TickMatrix, StabilityError> {
        // Where a loop that is open turns with the one below it, there is no tick without it.
        let is_it = |kind: &&Due| kind.current == due.current && kind.velocity == due.velocity;
        let found = self.kinds.iter().find(|kind| **kind == due).or_else(|| self.kinds.iter().find(is_it));
        let found = found.or_else(|| self.kinds.iter().rfind(|kind| kind.current == due.current));
        let kind = found.copied().unwrap_or(due);
        let index = self.kinds.iter().position(|other| *other == kind).unwrap_or(0);
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
        if !closed.shaft {
            // Bodies that are held do not move, whatever acts on them.
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

    /// The same loop with these loops closed and gains so much larger.
    pub(crate) const fn with(&mut self, closed: Closed, factors: Factors) {
        (self.closed, self.factors) = (closed, factors);
    }

    /// The same loop with the gains of position and velocity loop by these factors of a gain schedule.
    pub(crate) const fn schedule(&mut self, factors: (f64, f64)) {
        self.scheduled = factors;
    }

    pub(crate) const fn closed(&self) -> Closed {
        self.closed
    }

    pub(crate) const fn model(&self) -> &'a Loop {
        self.model
    }

    /// Ticks from turn to turn of the current loop, or of what takes its place.
    pub(crate) fn current_every(&self) -> u32 {
        current_every(self.model)
    }

    /// Number of states.
    pub(crate) const fn states(&self) -> usize {
        self.names.len()
    }

    /// Which states are of the controllers.
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

    /// States of the loops, where they are known.
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

    /// Whether there is one pole at 1 within the current loop, because physics wants it: without viscous friction and without a
    /// velocity loop the axis keeps any constant speed, since the integrators hold the current at its reference whatever the
    /// back-EMF. A current that is held over several ticks while the rotor turns is not quite at its reference.
    pub(crate) fn turns_freely(&self) -> bool {
        let (closed, model) = (self.closed, self.model);
        let is_open = !closed.velocity || model.drive.velocity.k_p == 0.0;
        let holds_current = match &model.drive.stage {
            Stage::Current { every, .. } => model.d_current == 0.0 || every.ticks() == 1,
            Stage::Direct { .. } => false,
        };
        let bodies = model.mechanics.bodies();
        closed.shaft && is_open && holds_current && bodies.iter().all(|body| body.friction.linear() == 0.0)
    }
}

fn current_every(model: &Loop) -> u32 {
    match &model.drive.stage {
        Stage::Current { every, .. } => every.ticks(),
        Stage::Direct { .. } => model.drive.velocity_every.ticks(),
    }
}
