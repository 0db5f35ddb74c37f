//! A user's MJCF file: some of its joints and one motor are the axis, the rest is simulated along with them.
mod limits;
mod parts;

use crate::NAME;
use crate::simulation::{self, Data};
use limits::Limits;
use mujoco_rs::prelude::{MjtDisableBit, MjtEnableBit, MjtState};
use parts::{Joint, Motor, Parts, joints, load_coordinate};
use servobench_base::state::{Damaged, Part, Reader, Stateful, Writer};
use servobench_plant::{
    Actuation, BodyState, Drive, Identity, Input, JointLimit, LoadCoordinate, Mechanics, MechanicsError,
    MechanicsSetup, MjcfModel, check_states,
};

/// A model with a motor joint and a load joint.
pub(crate) struct MujocoMjcf {
    data: Data,
    actuator: Motor,
    /// Every joint of the model, by its id.
    joints: Vec<Joint>,
    /// Id of the motor joint.
    motor: usize,
    load: LoadCoordinate,
    /// Load coordinate per coordinate of the load joint: the transmission when one joint is both motor and load.
    load_per_joint: f64,
    limits: Limits,
    /// Motor, then load; one body when one joint is both.
    bodies: Vec<BodyState>,
    identity: Identity,
}

/// Parts of `MuJoCo`'s state from which a step continues, in the order in which it writes them. Those after `act` are set in each tick, or
/// only start an iteration.
const PARTS: [(u32, Part); 5] = [
    (MjtState::mjSTATE_TIME as u32, Part::derived("time")),
    (MjtState::mjSTATE_QPOS as u32, Part::field("qpos")),
    (MjtState::mjSTATE_QVEL as u32, Part::field("qvel")),
    (MjtState::mjSTATE_ACT as u32, Part::field("act")),
    (REST, Part::derived("rest")),
];
/// Parts whose forces are not proportional to small deviations.
const NOT_SMOOTH: [MjtDisableBit; 3] =
    [MjtDisableBit::mjDSBL_FRICTIONLOSS, MjtDisableBit::mjDSBL_LIMIT, MjtDisableBit::mjDSBL_CONTACT];
const ALL: u32 = MjtState::mjSTATE_INTEGRATION as u32;
const REST: u32 = ALL
    & !(MjtState::mjSTATE_TIME as u32 | MjtState::mjSTATE_QPOS as u32)
    & !(MjtState::mjSTATE_QVEL as u32 | MjtState::mjSTATE_ACT as u32);

impl MujocoMjcf {
    pub(crate) fn new(file: &MjcfModel, setup: &MechanicsSetup) -> Result<Self, MechanicsError> {
        if setup.drive == Drive::Prescribed {
            return Err(MechanicsError::Unsupported {
                engine: NAME,
                what: "a prescribed motion of an MJCF model".into(),
                help: "drive it by efforts, or describe the axis by its bodies".into(),
            });
        }
        let model = simulation::compile(&file.xml, &file.path)?;
        let Parts { motor, load, actuator } = Parts::find(&model, file)?;
        let (joints, limits) = (joints(&model), Limits::of(&model));
        let left_out = if file.is_smooth { &NOT_SMOOTH[..] } else { &[] };
        let mut data = simulation::start(model, setup.step, left_out)?;
        let load = load_coordinate(&mut data, motor, load);
        let mut bodies = vec![BodyState::default(); if load.joint() == motor { 1 } else { 2 }];
        bodies.iter_mut().zip(&setup.initial).for_each(|(body, initial)| *body = *initial);
        let load_per_joint = if bodies.len() == 1 { file.transmission } else { 1.0 };
        let identity = Identity::new(NAME, setup);
        let mut mechanics = Self { data, actuator, joints, motor, load, load_per_joint, limits, bodies, identity };
        mechanics.start();
        mechanics.read();
        Ok(mechanics)
    }

    /// Sets the model to the states of the bodies; joints other than motor and load stay where they are.
    fn start(&mut self) {
        let [motor, load] = [self.motor, self.load.joint()].map(|id| self.joints[id]);
        let (data, joints) = (&mut self.data, &self.joints);
        data.qpos_mut()[motor.qpos] = self.bodies[0].position;
        data.qvel_mut()[motor.dof] = self.bodies[0].velocity;
        if let Some(body) = self.bodies.get(1) {
            let position = self.load.own(body.position, |id| data.qpos()[joints[id].qpos]);
            let velocity = self.load.own(body.velocity, |id| data.qvel()[joints[id].dof]);
            data.qpos_mut()[load.qpos] = position;
            data.qvel_mut()[load.dof] = velocity;
        }
    }

    fn read(&mut self) {
        let (positions, velocities, joints) = (self.data.qpos(), self.data.qvel(), &self.joints);
        let position = |id: usize| positions[joints[id].qpos];
        let velocity = |id: usize| velocities[joints[id].dof];
        self.bodies[0] = BodyState { position: position(self.motor), velocity: velocity(self.motor) };
        if let Some(body) = self.bodies.get_mut(1) {
            *body = BodyState { position: self.load.of(position), velocity: self.load.of(velocity) };
        }
        self.limits.watch(positions);
    }
}

impl Stateful for MujocoMjcf {
    fn save(&self, to: &mut dyn Writer) {
        self.identity.save(to);
        let mut state = vec![0.0; self.data.model().state_size(ALL)];
        self.data.read_state_into(ALL, &mut state);
        let mut numbers = state.into_iter();
        for (spec, part) in PARTS {
            to.enter(part);
            numbers.by_ref().take(self.data.model().state_size(spec)).for_each(|number| to.number(number));
            to.leave();
        }
    }

    fn restore(&mut self, from: &mut Reader<'_>) -> Result<(), Damaged> {
        self.identity.restore(from)?;
        let numbers = (0..self.data.model().state_size(ALL)).map(|_| from.number());
        let state = numbers.collect::<Result<Vec<f64>, Damaged>>()?;
        // `MuJoCo` only refuses numbers that are an index into a history.
        self.data.set_state(&state, ALL).map_err(|_| Damaged)
    }
}

impl Mechanics for MujocoMjcf {
    /// Unsupported with sleeping, because the set of sleeping bodies is not in `MuJoCo`'s state.
    fn state(&mut self) -> Option<&mut dyn Stateful> {
        let sleeps = self.data.model().opt().enableflags & MjtEnableBit::mjENBL_SLEEP as i32 != 0;
        if sleeps { None } else { Some(self) }
    }

    fn restored(&mut self) -> Result<(), MechanicsError> {
        self.read();
        Ok(())
    }

    fn bodies(&self) -> &[BodyState] {
        &self.bodies
    }

    fn advance(&mut self, input: &Input) -> Result<(), MechanicsError> {
        // MuJoCo replaces NaN by 0.
        input.check(NAME)?;
        let Actuation::Effort(effort) = input.actuation else { return Err(MechanicsError::wrong_actuation(NAME)) };
        self.data.ctrl_mut()[self.actuator.ctrl] = self.actuator.ctrl(effort)?;
        let forces = self.data.qfrc_applied_mut();
        forces[self.joints[self.motor].dof] = 0.0;
        for (id, share) in self.load.terms() {
            forces[self.joints[id].dof] = share * self.load_per_joint * input.load_disturbance;
        }
        forces[self.joints[self.motor].dof] += input.motor_disturbance;
        simulation::step(&mut self.data)?;
        self.read();
        // `MuJoCo` itself checks only before the next step.
        check_states(NAME, self.bodies.iter().copied())
    }

    fn joint_limits(&self) -> &[JointLimit] {
        self.limits.all()
    }
}
