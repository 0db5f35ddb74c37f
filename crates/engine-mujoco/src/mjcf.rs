//! A user's own MJCF file: two joints and one motor of it are the axis, the rest is simulated along with them.
use crate::simulation::{self, Data};
use crate::{NAME, wrong_actuation};
use mujoco_rs::prelude::{MjModel, MjtBias, MjtDisableBit, MjtDyn, MjtGain, MjtJoint, MjtObjBase, MjtTrn};
use servobench_plant::{Actuation, BodyState, Drive, Input, Mechanics, MechanicsError, MechanicsSetup, MjcfModel};

/// A model with a motor joint and a load joint.
pub(crate) struct MujocoMjcf {
    data: Data,
    motor: Motor,
    /// Motor joint, then load joint; one joint can be both.
    joints: Vec<Joint>,
    bodies: Vec<BodyState>,
}

/// A joint with one degree of freedom.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
struct Joint {
    id: usize,
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
        let motor = joint(&model, named(MjtObjBase::mjOBJ_JOINT, "joint", &file.motor_joint)?)?;
        let load = joint(&model, named(MjtObjBase::mjOBJ_JOINT, "joint", &file.load_joint)?)?;
        let actuator = named(MjtObjBase::mjOBJ_ACTUATOR, "actuator", &file.actuator)?;
        let actuator = plain_motor(&model, actuator, motor)?;

        let mut joints = vec![motor, load];
        joints.dedup();
        let mut data = simulation::start(model, setup.step, &[])?;
        for (joint, state) in joints.iter().zip(&setup.initial) {
            data.qpos_mut()[joint.qpos] = state.position;
            data.qvel_mut()[joint.dof] = state.velocity;
        }
        let bodies = vec![BodyState::default(); joints.len()];
        let mut mechanics = Self { data, motor: actuator, joints, bodies };
        mechanics.read();
        Ok(mechanics)
    }

    fn read(&mut self) {
        for (joint, body) in self.joints.iter().zip(&mut self.bodies) {
            body.position = self.data.qpos()[joint.qpos];
            body.velocity = self.data.qvel()[joint.dof];
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
        self.data.ctrl_mut()[self.motor.ctrl] = self.motor.ctrl(effort)?;
        let forces = self.data.qfrc_applied_mut();
        for joint in &self.joints {
            forces[joint.dof] = 0.0;
        }
        let (first, last) = (self.joints[0], self.joints[self.joints.len() - 1]);
        forces[first.dof] += input.motor_disturbance;
        forces[last.dof] += input.load_disturbance;
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

fn joint(model: &MjModel, id: usize) -> Result<Joint, MechanicsError> {
    if !matches!(model.jnt_type()[id], MjtJoint::mjJNT_SLIDE | MjtJoint::mjJNT_HINGE) {
        let name = model.id_to_name(MjtObjBase::mjOBJ_JOINT, id).unwrap_or_default();
        return Err(MechanicsError::Unsupported {
            engine: NAME,
            what: format!("joint `{name}`, which has several degrees of freedom"),
            way_out: "name a slide or a hinge".into(),
        });
    }
    Ok(Joint { id, qpos: index(model.jnt_qposadr()[id]), dof: index(model.jnt_dofadr()[id]) })
}

/// Actuator `id`, when it is a motor on `joint` without dynamics of its own.
fn plain_motor(model: &MjModel, id: usize, joint: Joint) -> Result<Motor, MechanicsError> {
    let name = model.id_to_name(MjtObjBase::mjOBJ_ACTUATOR, id).unwrap_or_default().to_owned();
    let unsupported = |what: String| MechanicsError::Unsupported {
        engine: NAME,
        what: format!("actuator `{name}`, which {what}"),
        way_out: "use a `<motor>` on the motor joint".into(),
    };
    let on_joint = matches!(model.actuator_trntype()[id], MjtTrn::mjTRN_JOINT | MjtTrn::mjTRN_JOINTINPARENT);
    if !on_joint || index(model.actuator_trnid()[id][0]) != joint.id {
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
        (model.jnt_actfrclimited()[joint.id], model.jnt_actfrcrange()[joint.id], 1.0),
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
