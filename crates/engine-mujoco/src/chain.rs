//! A chain of lumped bodies in `MuJoCo`.
//!
//! `MuJoCo` holds bodies, springs and dampers; everything else that acts is one generalised force per body, held over
//! the tick. Behind a prescribed base its coordinates are relative to the base, else the base rests at zero.
use crate::base::BaseTick;
use crate::simulation::{self, Data};
use crate::wrong_actuation;
use mujoco_rs::prelude::MjtDisableBit;
use servobench_plant::{
    Actuation, BodyState, Chain, Drive, Grip, Input, Mechanics, MechanicsError, MechanicsSetup, chain_to_mjcf,
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
    /// First body that `MuJoCo` moves: 1 behind a prescribed base, else 0.
    first: usize,
    /// Tick length (s).
    step: f64,
    bodies: Vec<BodyState>,
}

impl MujocoChain {
    pub(crate) fn new(chain: Chain, setup: &MechanicsSetup) -> Result<Self, MechanicsError> {
        let first = usize::from(setup.drive == Drive::Prescribed);
        let xml = chain_to_mjcf(&chain, setup.drive, setup.step);
        let model = simulation::compile(&xml, Path::new("chain.xml"))?;
        let mut data = simulation::start(model, setup.step, &UNUSED)?;
        let bodies: Vec<BodyState> =
            (0..chain.bodies().len()).map(|i| setup.initial.get(i).copied().unwrap_or_default()).collect();
        let base = if first == 1 { chain.bodies()[0].transmission * bodies[0].position } else { 0.0 };
        for (i, q) in (first..).zip(data.qpos_mut()) {
            *q = bodies[i].position - base / chain.bodies()[i].transmission;
        }
        Ok(Self { chain, data, first, step: setup.step, bodies })
    }

    /// How the base moves in this tick.
    fn base(&self, actuation: Actuation) -> Result<BaseTick, MechanicsError> {
        match (actuation, self.first) {
            (Actuation::Effort(_), 0) => Ok(BaseTick::default()),
            (Actuation::Motion(now), 1) => Ok(BaseTick::new(now, self.step)),
            _ => Err(wrong_actuation()),
        }
    }

    /// What drive and disturbances do to body `i`, in its own coordinate (N or N·m).
    fn external_effort(&self, i: usize, input: &Input) -> f64 {
        let mut effort = 0.0;
        if i == 0 {
            effort += input.motor_disturbance;
            if let Actuation::Effort(drive) = input.actuation {
                effort += drive;
            }
        }
        if i + 1 == self.bodies.len() {
            effort += self.chain.bodies()[i].transmission * input.load_disturbance;
        }
        effort
    }

    /// Sets forces, velocities and positions of the tick; returns the set of bodies that friction holds, body i being
    /// bit i.
    fn apply(&mut self, input: &Input, base: &BaseTick) -> u32 {
        let mut held = 0;
        for i in self.first..self.bodies.len() {
            let (body, dof, velocity) = (&self.chain.bodies()[i], i - self.first, self.bodies[i].velocity);
            let external = self.external_effort(i, input);
            let mut effort = external - body.bias;
            if !body.dry.is_none() {
                let others = self.chain.passive_effort(i, &self.bodies) + external;
                match body.dry.grip(velocity, others) {
                    Grip::Held => {
                        // No net effort: the body stays where it is during the step but for what its neighbours'
                        // motion within the tick adds, which `read` takes back.
                        effort -= others;
                        held |= 1 << i;
                    }
                    Grip::Force(friction) => effort += friction,
                }
            }
            let (m, b, r) = (body.inertia, body.viscous, body.transmission);
            self.data.qfrc_applied_mut()[dof] = effort + base.mean_force(m, b, r);
            self.data.qvel_mut()[dof] = velocity - base.start.v / r;
            self.data.qpos_mut()[dof] += base.half_shift(m, b, r);
        }
        held
    }

    /// Takes over the state at the end of the tick.
    fn read(&mut self, held: u32, base: &BaseTick) {
        if self.first == 1 {
            let r = self.chain.bodies()[0].transmission;
            self.bodies[0] = BodyState { position: base.end.x / r, velocity: base.end.v / r };
        }
        for i in self.first..self.bodies.len() {
            let (body, dof) = (&self.chain.bodies()[i], i - self.first);
            let (m, b, r) = (body.inertia, body.viscous, body.transmission);
            let state = &mut self.bodies[i];
            let q = &mut self.data.qpos_mut()[dof];
            if held & (1 << i) != 0 {
                *q = state.position - base.end.x / r;
                continue;
            }
            *q += base.half_shift(m, b, r);
            state.position = *q + base.end.x / r;
            let velocity = self.data.qvel()[dof] + base.end.v / r;
            let stopped = body.dry.settle(state.velocity, velocity);
            state.velocity = if stopped { 0.0 } else { velocity };
        }
    }
}

impl Mechanics for MujocoChain {
    fn bodies(&self) -> &[BodyState] {
        &self.bodies
    }

    fn advance(&mut self, input: &Input) -> Result<(), MechanicsError> {
        simulation::check_input(input)?;
        let base = self.base(input.actuation)?;
        let held = self.apply(input, &base);
        simulation::step(&mut self.data)?;
        self.read(held, &base);
        simulation::check_states(&self.bodies)
    }
}
