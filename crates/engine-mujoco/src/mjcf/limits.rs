//! Ends of the ranges of a model's joints, and detection of joints at an end.
//!
//! A limit of `MuJoCo` is a soft constraint: it pushes as soon as the joint is within the margin of its end, and lets it
//! go a little beyond.
use mujoco_rs::prelude::{MjModel, MjtDisableBit, MjtJoint, MjtObjBase};
use servobench_plant::JointLimit;

/// Ends of ranges.
pub(super) struct Limits {
    ends: Vec<End>,
    /// The limit of each end.
    said: Vec<JointLimit>,
}

/// An end of a range.
struct End {
    /// Index of the joint's position.
    qpos: usize,
    /// Position from which the limit pushes (m or rad).
    from: f64,
    is_upper: bool,
}

impl Limits {
    /// The limits of all slides and hinges of the model with a range.
    pub(super) fn of(model: &MjModel) -> Self {
        let (mut ends, mut said) = (Vec::new(), Vec::new());
        let off = MjtDisableBit::mjDSBL_CONSTRAINT as i32 | MjtDisableBit::mjDSBL_LIMIT as i32;
        let count = if model.opt().disableflags & off == 0 { model.jnt_type().len() } else { 0 };
        for joint in (0..count).filter(|joint| model.jnt_limited()[*joint]) {
            let unit = match model.jnt_type()[joint] {
                MjtJoint::mjJNT_SLIDE => "m",
                MjtJoint::mjJNT_HINGE => "rad",
                MjtJoint::mjJNT_FREE | MjtJoint::mjJNT_BALL => continue,
            };
            let ([low, high], margin) = (model.jnt_range()[joint], model.jnt_margin()[joint]);
            let name = model.id_to_name(MjtObjBase::mjOBJ_JOINT, joint).unwrap_or("(without a name)");
            let Ok(qpos) = usize::try_from(model.jnt_qposadr()[joint]) else { continue };
            for (end, from, is_upper, which) in
                [(low, low + margin, false, "lower"), (high, high - margin, true, "upper")]
            {
                ends.push(End { qpos, from, is_upper });
                let text = format!("joint `{name}` is at the {which} end of its range, {end} {unit}");
                said.push(JointLimit { text, binds: false });
            }
        }
        Self { ends, said }
    }

    /// Updates the limits from the positions of the joints.
    #[inline]
    pub(super) fn watch(&mut self, positions: &[f64]) {
        for (end, said) in self.ends.iter().zip(&mut self.said) {
            let position = positions[end.qpos];
            said.binds = if end.is_upper { position > end.from } else { position < end.from };
        }
    }

    pub(super) fn all(&self) -> &[JointLimit] {
        &self.said
    }
}
