//! The joints and the motor of a model that form the axis.
use crate::NAME;
use crate::simulation::Data;
use mujoco_rs::prelude::{MjModel, MjtBias, MjtDisableBit, MjtDyn, MjtGain, MjtJoint, MjtObjBase, MjtTrn};
use servobench_base::Coordinate;
use servobench_files::listed;
use servobench_plant::{LoadCoordinate, MechanicsError, MjcfModel, PosedJoint, Refusal, RefusedAt};
use std::iter::successors;

/// Parts of a model that form the axis.
pub(super) struct Parts {
    /// Id of the motor joint.
    pub(super) motor: usize,
    pub(super) load: LoadJoint,
    pub(super) actuator: Motor,
}

/// The load joint.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct LoadJoint {
    id: usize,
    kind: Coordinate,
}

/// Place of a joint in the arrays; the first one for a joint with several degrees of freedom.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Joint {
    /// Index of its position.
    pub(super) qpos: usize,
    /// Index of its velocity and of forces on it.
    pub(super) dof: usize,
}

/// The actuator.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Motor {
    name: String,
    /// Index of its control.
    pub(super) ctrl: usize,
    /// Effort on the joint per unit of control: gain times gear.
    effort_per_ctrl: f64,
    /// Efforts within all limits of the model (N or N·m).
    range: [f64; 2],
}

impl Parts {
    /// Finds the parts named by `file`.
    ///
    /// # Errors
    /// [`MechanicsError::Refused`] with everything that is missing or unsuitable.
    pub(super) fn find(model: &MjModel, file: &MjcfModel) -> Result<Self, MechanicsError> {
        let motor = joint(model, &file.motor_joint);
        let load = joint(model, &file.load_joint);
        let actuator = actuator(model, file, motor.as_ref().ok().map(|(id, _)| *id));
        match (motor, load, actuator) {
            (Ok((motor, own_kind)), Ok((id, kind)), Ok(actuator)) => {
                let mut refusals = file.misfits(own_kind, kind);
                refusals.extend(file.too_strong(actuator.range));
                if refusals.is_empty() {
                    Ok(Self { motor, load: LoadJoint { id, kind }, actuator })
                } else {
                    Err(refused(file, refusals))
                }
            }
            (motor, load, actuator) => {
                let mut refusals: Vec<Refusal> =
                    [motor.err(), load.err(), actuator.err()].into_iter().flatten().collect();
                refusals.dedup();
                Err(refused(file, refusals))
            }
        }
    }
}

fn refused(file: &MjcfModel, refusals: Vec<Refusal>) -> MechanicsError {
    let help = "change the file or the names of its parts";
    MechanicsError::Refused { engine: NAME, path: file.path.clone(), refusals, help }
}

impl Motor {
    /// The control that produces `effort` at the joint.
    pub(super) fn ctrl(&self, effort: f64) -> Result<f64, MechanicsError> {
        let [low, high] = self.range;
        if (low..=high).contains(&effort) {
            return Ok(effort / self.effort_per_ctrl);
        }
        let name = &self.name;
        Err(MechanicsError::Unsupported {
            engine: NAME,
            what: format!("an effort of {effort} on actuator `{name}`, which the model limits to {low} … {high}"),
            help: "lower the limit of the drive, or widen the range in the model".into(),
        })
    }
}

/// Every joint of the model, by its id.
pub(super) fn joints(model: &MjModel) -> Vec<Joint> {
    let addresses = model.jnt_qposadr().iter().zip(model.jnt_dofadr());
    addresses.map(|(qpos, dof)| Joint { qpos: index(*qpos), dof: index(*dof) }).collect()
}

fn refusal(name: &str, message: String) -> Refusal {
    Refusal { place: RefusedAt::Name(name.to_owned()), message }
}

/// The id of the element called `name`; the refusal lists the existing names.
fn find(model: &MjModel, kind: MjtObjBase, what: &str, name: &str) -> Result<usize, Refusal> {
    let count = match kind {
        MjtObjBase::mjOBJ_JOINT => model.jnt_type().len(),
        _ => model.actuator_trntype().len(),
    };
    (0..count).find(|&id| model.id_to_name(kind, id) == Some(name)).ok_or_else(|| {
        let names = (0..count).filter_map(|id| model.id_to_name(kind, id));
        let list = listed(names, "none with a name");
        refusal(name, format!("there is no {what} `{name}`; there is {list}"))
    })
}

/// Id and kind of the joint called `name`.
fn joint(model: &MjModel, name: &str) -> Result<(usize, Coordinate), Refusal> {
    let id = find(model, MjtObjBase::mjOBJ_JOINT, "joint", name)?;
    match kind(model, id) {
        Some(kind) => Ok((id, kind)),
        None => Err(refusal(name, format!("joint `{name}` has several degrees of freedom; name a slide or a hinge"))),
    }
}

/// Slide or hinge; `None` for a joint with several degrees of freedom.
fn kind(model: &MjModel, joint: usize) -> Option<Coordinate> {
    match model.jnt_type()[joint] {
        MjtJoint::mjJNT_SLIDE => Some(Coordinate::Linear),
        MjtJoint::mjJNT_HINGE => Some(Coordinate::Rotary),
        MjtJoint::mjJNT_FREE | MjtJoint::mjJNT_BALL => None,
    }
}

/// The load's coordinate, from the id of the motor joint and the load joint; `data` is in the reference pose.
pub(super) fn load_coordinate(data: &mut Data, motor: usize, load: LoadJoint) -> LoadCoordinate {
    data.kinematics();
    let (model, axes) = (data.model(), data.xaxis());
    let posed = |id: usize, kind| PosedJoint { number: id, kind, axis: axes[id] };
    // Ids ascend from the root of the tree, and within a body from the joint next to the parent to the one next to the body.
    let below = |joint: usize| {
        let parent = |body: &usize| (*body > 0).then(|| index(model.body_parentid()[*body]));
        let bodies: Vec<usize> = successors(Some(index(model.jnt_bodyid()[joint])), parent).collect();
        let carries = |id: &usize| bodies.contains(&index(model.jnt_bodyid()[*id]));
        (0..joint).filter(carries).filter_map(|id| Some(posed(id, kind(model, id)?))).collect::<Vec<_>>()
    };
    LoadCoordinate::new(posed(load.id, load.kind), &below(load.id), &below(motor))
}

/// The actuator of the axis, if it is a motor on the motor joint without internal dynamics; without a motor joint it may act on any joint.
fn actuator(model: &MjModel, file: &MjcfModel, joint: Option<usize>) -> Result<Motor, Refusal> {
    let name = &file.actuator;
    let id = find(model, MjtObjBase::mjOBJ_ACTUATOR, "actuator", name)?;
    let wrong = |what: &str| {
        refusal(name, format!("actuator `{name}` {what}; use a `<motor>` on joint `{}`", file.motor_joint))
    };
    let on_joint = matches!(model.actuator_trntype()[id], MjtTrn::mjTRN_JOINT | MjtTrn::mjTRN_JOINTINPARENT);
    let acted_on = index(model.actuator_trnid()[id][0]);
    if !on_joint || joint.is_some_and(|joint| joint != acted_on) {
        return Err(wrong("does not act on the motor joint"));
    }
    if model.actuator_dyntype()[id] != MjtDyn::mjDYN_NONE
        || model.actuator_gaintype()[id] != MjtGain::mjGAIN_FIXED
        || model.actuator_biastype()[id] != MjtBias::mjBIAS_NONE
    {
        return Err(wrong("is more than a motor"));
    }
    let gear = model.actuator_gear()[index(model.actuator_outadr()[id])][0];
    let gain = model.actuator_gainprm()[id][0];
    let effort_per_ctrl = gain * gear;
    if effort_per_ctrl == 0.0 {
        return Err(wrong("has no effect: its gear or gain is zero"));
    }
    let ctrl = index(model.actuator_ctrladr()[id]);
    let clamps = model.opt().disableflags & MjtDisableBit::mjDSBL_CLAMPCTRL as i32 == 0;
    let limits = [
        (clamps && model.actuator_ctrllimited()[ctrl], model.actuator_ctrlrange()[ctrl], effort_per_ctrl),
        (model.actuator_forcelimited()[id], model.actuator_forcerange()[id], gear),
        (model.jnt_actfrclimited()[acted_on], model.jnt_actfrcrange()[acted_on], 1.0),
    ];
    let mut range = [f64::NEG_INFINITY, f64::INFINITY];
    for (_, [a, b], scale) in limits.into_iter().filter(|(limited, ..)| *limited) {
        let (low, high) = ((a * scale).min(b * scale), (a * scale).max(b * scale));
        range = [range[0].max(low), range[1].min(high)];
    }
    Ok(Motor { name: name.clone(), ctrl, effort_per_ctrl, range })
}

/// An address in `MuJoCo`'s arrays; those of existing joints and motors are never negative.
fn index(address: i32) -> usize {
    usize::try_from(address).unwrap_or(usize::MAX)
}
