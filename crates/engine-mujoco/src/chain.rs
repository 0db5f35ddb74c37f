//! A chain of lumped bodies in `MuJoCo`.
//!
//! `MuJoCo` contains bodies, springs and dampers; all other efforts are one generalised force per body, held over
//! the tick. Behind a prescribed base its coordinates are relative to the base, else the base rests at zero.
use crate::base::BaseTick;
use crate::simulation::{self, Data};
use crate::stability;
use mujoco_rs::prelude::MjtDisableBit;
use servobench_base::Setpoint;
use servobench_base::state::{Damaged, FixedForm as _, Part, Reader, Stateful, Writer};
use servobench_plant::{
    Actuation, BodyState, Chain, Drive, Grips, GroundFriction, Identity, Input, Mechanics, MechanicsError,
    MechanicsSetup, chain_to_mjcf, check_states,
};
use std::path::Path;

/// Stages that a chain does not need: its efforts are generalised forces, and nothing collides.
const UNUSED: [MjtDisableBit; 5] = [
    MjtDisableBit::mjDSBL_CONSTRAINT,
    MjtDisableBit::mjDSBL_CONTACT,
    MjtDisableBit::mjDSBL_GRAVITY,
    MjtDisableBit::mjDSBL_ACTUATION,
    MjtDisableBit::mjDSBL_SENSOR,
];

/// A chain of bodies; `bodies` is its state, except for the positions relative to a moving base, which are `MuJoCo`'s.
pub(crate) struct MujocoChain {
    chain: Chain,
    data: Data,
    friction: GroundFriction<{ Chain::MAX_BODIES }>,
    /// First body that `MuJoCo` moves: 1 behind a prescribed base, else 0.
    first: usize,
    /// Tick length (s).
    step: f64,
    bodies: Vec<BodyState>,
    identity: Identity,
}

impl MujocoChain {
    pub(crate) fn new(chain: Chain, setup: &MechanicsSetup) -> Result<Self, MechanicsError> {
        let first = usize::from(setup.drive == Drive::Prescribed);
        stability::check(&chain, setup)?;
        let xml = chain_to_mjcf(&chain, setup.drive, setup.step);
        let model = simulation::compile(&xml, Path::new("chain.xml"))?;
        let mut data = simulation::start(model, setup.step, &UNUSED)?;
        let bodies: Vec<BodyState> =
            (0..chain.bodies().len()).map(|i| setup.initial.get(i).copied().unwrap_or_default()).collect();
        let base = if first == 1 { chain.bodies()[0].transmission * bodies[0].position } else { 0.0 };
        for (i, q) in (first..).zip(data.qpos_mut()) {
            *q = bodies[i].position - base / chain.bodies()[i].transmission;
        }
        for (body, v) in bodies[first..].iter().zip(data.qvel_mut()) {
            *v = body.velocity;
        }
        let friction = GroundFriction::new(&chain, setup.drive, setup.step);
        let identity = Identity::new(crate::NAME, setup);
        Ok(Self { chain, data, friction, first, step: setup.step, bodies, identity })
    }

    /// Motion of the base in this tick; `None` for a resting base.
    fn base(&self, actuation: Actuation) -> Result<Option<BaseTick>, MechanicsError> {
        match (actuation, self.first) {
            (Actuation::Effort(_), 0) => Ok(None),
            (Actuation::Motion(now), 1) => Ok(Some(BaseTick::new(now, self.step))),
            _ => Err(MechanicsError::wrong_actuation(crate::NAME)),
        }
    }

    /// Efforts of drive and disturbances on each body in its own coordinate (N or N·m).
    fn external_efforts(&self, input: &Input) -> [f64; Chain::MAX_BODIES] {
        let mut efforts = [0.0; Chain::MAX_BODIES];
        let last = self.bodies.len() - 1;
        efforts[0] = input.motor_disturbance;
        if let Actuation::Effort(drive) = input.actuation {
            efforts[0] += drive;
        }
        efforts[last] += self.chain.bodies()[last].transmission * input.load_disturbance;
        efforts
    }

    /// Sets the forces of the tick; returns the set of bodies that friction holds, body i being bit i.
    fn apply(&mut self, input: &Input) -> usize {
        let external = self.external_efforts(input);
        let bodies = external.iter().zip(self.chain.bodies()).skip(self.first);
        for ((external, body), force) in bodies.zip(self.data.qfrc_applied_mut()) {
            *force = external - body.bias;
        }
        if self.friction.is_linear() {
            return 0;
        }
        let mut others = external;
        for (i, other) in others.iter_mut().enumerate().take(self.bodies.len()) {
            *other += self.chain.passive_effort(i, &self.bodies);
        }
        let Grips { held, forces } = self.friction.before_tick(self.velocities(), others);
        for (i, force) in (self.first..).zip(self.data.qfrc_applied_mut()) {
            // A held body has no net effort: it stays where it is during the step except for the effect of its neighbours' motion
            // within the tick, which `read` reverts.
            *force += if held & (1 << i) == 0 { forces[i] } else { -others[i] };
        }
        held
    }

    fn velocities(&self) -> [f64; Chain::MAX_BODIES] {
        std::array::from_fn(|i| self.bodies.get(i).map_or(0.0, |body| body.velocity))
    }

    /// Changes to the frame of the moving base: velocities relative to it, its inertial forces, the first half of the shifts.
    fn mount(&mut self, base: &BaseTick) {
        for (dof, body) in self.chain.bodies()[1..].iter().enumerate() {
            let (m, b, r) = (body.inertia, body.friction.linear(), body.transmission);
            self.data.qfrc_applied_mut()[dof] += base.mean_force(m, b, r);
            self.data.qvel_mut()[dof] = self.bodies[dof + 1].velocity - base.start.v / r;
            self.data.qpos_mut()[dof] += base.half_shift(m, b, r);
        }
    }

    /// Applies the second half of the shifts, and moves the base itself to its end.
    fn shift(&mut self, base: &BaseTick) {
        let (motor, others) = (&self.chain.bodies()[0], &self.chain.bodies()[1..]);
        self.bodies[0] =
            BodyState { position: base.end.x / motor.transmission, velocity: base.end.v / motor.transmission };
        for (body, q) in others.iter().zip(self.data.qpos_mut()) {
            *q += base.half_shift(body.inertia, body.friction.linear(), body.transmission);
        }
    }

    /// Reads the state at the end of the tick, which in `MuJoCo` is relative to a base at `end`.
    fn read(&mut self, held: usize, end: Setpoint) {
        let moved = self.data.qpos().iter().zip(self.data.qvel());
        let bodies = self.chain.bodies().iter().zip(&mut self.bodies).enumerate().skip(self.first);
        for ((i, (body, state)), (q, v)) in bodies.zip(moved) {
            if held & (1 << i) == 0 {
                *state = BodyState { position: q + end.x / body.transmission, velocity: v + end.v / body.transmission };
            }
        }
        if self.friction.is_linear() {
            return;
        }
        // Bodies moved by `MuJoCo`, although friction holds or has stopped them.
        let at_rest = held | self.friction.after_tick(self.velocities());
        for i in (self.first..self.bodies.len()).filter(|i| at_rest & (1 << i) != 0) {
            self.bodies[i].velocity = 0.0;
            let (dof, r) = (i - self.first, self.chain.bodies()[i].transmission);
            self.data.qpos_mut()[dof] = self.bodies[i].position - end.x / r;
            self.data.qvel_mut()[dof] = self.bodies[i].velocity - end.v / r;
        }
    }
}

impl Stateful for MujocoChain {
    fn save(&self, to: &mut dyn Writer) {
        let Self { identity, bodies, data, friction, chain: _, first: _, step: _ } = self;
        identity.save(to);
        to.enter(Part::field("bodies"));
        bodies.save_fixed(to);
        to.leave();
        // Behind a moving base they keep digits that the bodies do not.
        to.enter(Part::derived("qpos"));
        data.qpos().save_fixed(to);
        to.leave();
        to.enter(Part::field("friction"));
        friction.save(to);
        to.leave();
    }

    fn restore(&mut self, from: &mut Reader<'_>) -> Result<(), Damaged> {
        self.identity.restore(from)?;
        self.bodies.restore_fixed(from)?;
        self.data.qpos_mut().restore_fixed(from)?;
        self.friction.restore(from)?;
        let bodies = &self.bodies[self.first..];
        if self.first == 0 {
            self.data.qpos_mut().iter_mut().zip(bodies).for_each(|(q, body)| *q = body.position);
        }
        // Behind a moving base they are set in each tick.
        self.data.qvel_mut().iter_mut().zip(bodies).for_each(|(v, body)| *v = body.velocity);
        Ok(())
    }
}

impl Mechanics for MujocoChain {
    fn state(&mut self) -> Option<&mut dyn Stateful> {
        Some(self)
    }

    fn bodies(&self) -> &[BodyState] {
        &self.bodies
    }

    fn advance(&mut self, input: &Input) -> Result<(), MechanicsError> {
        // MuJoCo replaces NaN by 0.
        input.check(crate::NAME)?;
        let base = self.base(input.actuation)?;
        let held = self.apply(input);
        if let Some(base) = &base {
            self.mount(base);
        }
        simulation::step(&mut self.data)?;
        if let Some(base) = &base {
            self.shift(base);
        }
        self.read(held, base.map_or(Setpoint::default(), |base| base.end));
        // `MuJoCo` itself checks only before the next step.
        check_states(crate::NAME, self.bodies.iter().copied())
    }
}
