//! A user's own MJCF file: some joints and one motor of it are the axis, the rest is simulated along with them.
use crate::simulation::{self, Data};
use crate::{NAME, wrong_actuation};
use mujoco_rs::prelude::{MjModel, MjtBias, MjtDisableBit, MjtDyn, MjtGain, MjtJoint, MjtObjBase, MjtTrn};
use servobench_plant::{
    Actuation, BodyState, Coordinate, Drive, Input, LoadCoordinate, Mechanics, MechanicsError, MechanicsSetup,
    MjcfModel, PosedJoint,
};
use std::iter::successors;

/// A model with a motor joint and a load joint.
pub(crate) struct MujocoMjcf {
    data: Data,
    actuator: Motor,
    /// Every joint of the model, by its id.
    joints: Vec<Joint>,
    /// Id of the motor joint.
    motor: usize,
    load: LoadCoordinate,
    /// Motor, then load; one body when one joint is both.
    bodies: Vec<BodyState>,
}

/// Where a joint is in the arrays; of one with several degrees of freedom, its first.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
struct Joint {
    /// Index of its position.
    qpos: usize,
    /// Index of its velocity and of forces on it.
    dof: usize,
}

/// The actuator.
#[derive(Debug, Clone, PartialEq)]
struct Motor {
    name: String,
    /// Index of its control.
    ctrl: usize,
    /// Effort on the joint per unit of control: gain times gear.
    effort_per_ctrl: f64,
    /// Efforts that no limit of the model clips (N or N·m).
    range: [f64; 2],
}

impl MujocoMjcf {
    pub(crate) fn new(file: &MjcfModel, setup: &MechanicsSetup) -> Result<Self, MechanicsError> {
        if setup.drive == Drive::Prescribed {
            return Err(MechanicsError::Unsupported {
                engine: NAME,
                what: "a prescribed motion of an MJCF model".into(),
                way_out: "drive it by efforts, or describe the axis by its bodies".into(),
            });
        }
        let model = simulation::compile(&file.xml, &file.path)?;
        let named = |kind, what, name: &str| find(&model, kind, what, name, file);
        let motor = named(MjtObjBase::mjOBJ_JOINT, "joint", &file.motor_joint)?;
        let load = named(MjtObjBase::mjOBJ_JOINT, "joint", &file.load_joint)?;
        single(&model, motor)?;
        let load = (load, single(&model, load)?);
        let actuator = named(MjtObjBase::mjOBJ_ACTUATOR, "actuator", &file.actuator)?;
        let actuator = plain_motor(&model, actuator, motor)?;
        let addresses = model.jnt_qposadr().iter().zip(model.jnt_dofadr());
        let joints = addresses.map(|(qpos, dof)| Joint { qpos: index(*qpos), dof: index(*dof) }).collect();

        let mut data = simulation::start(model, setup.step, &[])?;
        let load = load_coordinate(&mut data, motor, load);
        let mut bodies = vec![BodyState::default(); if load.joint() == motor { 1 } else { 2 }];
        bodies.iter_mut().zip(&setup.initial).for_each(|(body, initial)| *body = *initial);
        let mut mechanics = Self { data, actuator, joints, motor, load, bodies };
        mechanics.start();
        mechanics.read();
        Ok(mechanics)
    }

    /// Puts the model into the states of the bodies; what is neither motor nor load stays where it is.
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
    }
}

impl Mechanics for MujocoMjcf {
    fn bodies(&self) -> &[BodyState] {
        &self.bodies
    }

    fn advance(&mut self, input: &Input) -> Result<(), MechanicsError> {
        simulation::check_input(input)?;
        let Actuation::Effort(effort) = input.actuation else { return Err(wrong_actuation()) };
        self.data.ctrl_mut()[self.actuator.ctrl] = self.actuator.ctrl(effort)?;
        let forces = self.data.qfrc_applied_mut();
        forces[self.joints[self.motor].dof] = 0.0;
        for (id, share) in self.load.terms() {
            forces[self.joints[id].dof] = share * input.load_disturbance;
        }
        forces[self.joints[self.motor].dof] += input.motor_disturbance;
        simulation::step(&mut self.data)?;
        self.read();
        simulation::check_states(&self.bodies)
    }
}

impl Motor {
    /// The control that makes `effort` at the joint.
    fn ctrl(&self, effort: f64) -> Result<f64, MechanicsError> {
        let [low, high] = self.range;
        if (low..=high).contains(&effort) {
            return Ok(effort / self.effort_per_ctrl);
        }
        let name = &self.name;
        Err(MechanicsError::Unsupported {
            engine: NAME,
            what: format!("an effort of {effort} on actuator `{name}`, which the model limits to {low} … {high}"),
            way_out: "lower the limit of the drive, or widen the range in the model".into(),
        })
    }
}

/// The number of the element called `name`; the error lists the names that there are.
fn find(model: &MjModel, kind: MjtObjBase, what: &str, name: &str, file: &MjcfModel) -> Result<usize, MechanicsError> {
    let count = match kind {
        MjtObjBase::mjOBJ_JOINT => model.jnt_type().len(),
        _ => model.actuator_trntype().len(),
    };
    let names: Vec<&str> = (0..count).filter_map(|id| model.id_to_name(kind, id)).collect();
    if let Some(id) = (0..count).find(|&id| model.id_to_name(kind, id) == Some(name)) {
        return Ok(id);
    }
    let list = names.iter().map(|name| format!("`{name}`")).collect::<Vec<_>>().join(", ");
    let list = if list.is_empty() { "none with a name".into() } else { list };
    let path = file.path.display();
    let message = format!("{path} has no {what} `{name}`; there is {list}");
    Err(MechanicsError::Model { engine: NAME, message })
}

/// Slide or hinge; `None` for a joint with several degrees of freedom.
fn kind(model: &MjModel, joint: usize) -> Option<Coordinate> {
    match model.jnt_type()[joint] {
        MjtJoint::mjJNT_SLIDE => Some(Coordinate::Linear),
        MjtJoint::mjJNT_HINGE => Some(Coordinate::Rotary),
        MjtJoint::mjJNT_FREE | MjtJoint::mjJNT_BALL => None,
    }
}

/// What kind of joint it is, when it has one degree of freedom.
fn single(model: &MjModel, joint: usize) -> Result<Coordinate, MechanicsError> {
    kind(model, joint).ok_or_else(|| MechanicsError::Unsupported {
        engine: NAME,
        what: format!(
            "joint `{}`, which has several degrees of freedom",
            model.id_to_name(MjtObjBase::mjOBJ_JOINT, joint).unwrap_or_default()
        ),
        way_out: "name a slide or a hinge".into(),
    })
}

/// The load's coordinate, from the id of the motor joint and id and kind of the load joint; `data` is in the reference
/// pose.
fn load_coordinate(data: &mut Data, motor: usize, load: (usize, Coordinate)) -> LoadCoordinate {
    data.kinematics();
    let (model, axes) = (data.model(), data.xaxis());
    let posed = |id: usize, kind| PosedJoint { number: id, kind, axis: axes[id] };
    // Ids go up the tree, and within a body from the joint next to the parent to the one next to the body.
    let below = |joint: usize| {
        let parent = |body: &usize| (*body > 0).then(|| index(model.body_parentid()[*body]));
        let bodies: Vec<usize> = successors(Some(index(model.jnt_bodyid()[joint])), parent).collect();
        let carries = |id: &usize| bodies.contains(&index(model.jnt_bodyid()[*id]));
        (0..joint).filter(carries).filter_map(|id| Some(posed(id, kind(model, id)?))).collect::<Vec<_>>()
    };
    LoadCoordinate::new(posed(load.0, load.1), &below(load.0), &below(motor))
}

/// Actuator `id`, when it is a motor on `joint` without dynamics of its own.
fn plain_motor(model: &MjModel, id: usize, joint: usize) -> Result<Motor, MechanicsError> {
    let name = model.id_to_name(MjtObjBase::mjOBJ_ACTUATOR, id).unwrap_or_default().to_owned();
    let unsupported = |what: String| MechanicsError::Unsupported {
        engine: NAME,
        what: format!("actuator `{name}`, which {what}"),
        way_out: "use a `<motor>` on the motor joint".into(),
    };
    let on_joint = matches!(model.actuator_trntype()[id], MjtTrn::mjTRN_JOINT | MjtTrn::mjTRN_JOINTINPARENT);
    if !on_joint || index(model.actuator_trnid()[id][0]) != joint {
        return Err(unsupported("does not act on the motor joint".into()));
    }
    if model.actuator_dyntype()[id] != MjtDyn::mjDYN_NONE
        || model.actuator_gaintype()[id] != MjtGain::mjGAIN_FIXED
        || model.actuator_biastype()[id] != MjtBias::mjBIAS_NONE
    {
        return Err(unsupported("is more than a motor".into()));
    }
    let gear = model.actuator_gear()[index(model.actuator_outadr()[id])][0];
    let gain = model.actuator_gainprm()[id][0];
    let effort_per_ctrl = gain * gear;
    if effort_per_ctrl == 0.0 {
        return Err(unsupported("has no effect: its gear or gain is zero".into()));
    }
    let ctrl = index(model.actuator_ctrladr()[id]);
    let clamps = model.opt().disableflags & MjtDisableBit::mjDSBL_CLAMPCTRL as i32 == 0;
    let limits = [
        (clamps && model.actuator_ctrllimited()[ctrl], model.actuator_ctrlrange()[ctrl], effort_per_ctrl),
        (model.actuator_forcelimited()[id], model.actuator_forcerange()[id], gear),
        (model.jnt_actfrclimited()[joint], model.jnt_actfrcrange()[joint], 1.0),
    ];
    let mut range = [f64::NEG_INFINITY, f64::INFINITY];
    for (_, [a, b], scale) in limits.into_iter().filter(|(limited, ..)| *limited) {
        let (low, high) = ((a * scale).min(b * scale), (a * scale).max(b * scale));
        range = [range[0].max(low), range[1].min(high)];
    }
    Ok(Motor { name, ctrl, effort_per_ctrl, range })
}

/// An address in `MuJoCo`'s arrays; those of existing joints and motors are never negative.
fn index(address: i32) -> usize {
    usize::try_from(address).unwrap_or(usize::MAX)
}
