//! Contents of an MJCF file of the subset, resolved: links with their joints, tendons, motors.
use super::contact::possible_contacts;
use super::depth;
use super::mass::mass_properties;
use super::refusal::{MjcfRefusal, names as names_listed};
use super::scan::{line, scan};
use mjcf_rs::Model;
use mjcf_rs::body::{Joint as MjcfJoint, JointType};
use mjcf_rs::extras::ActuatorKind;
use mjcf_rs::glam::{DQuat, DVec3};
use rapier3d_f64::math::Pose;
use rapier3d_f64::prelude::{MassProperties, Vector};
use roxmltree::{Document, Node};
use servobench_base::Coordinate;
use servobench_files::with_short_quotes;
use servobench_plant::{LoadCoordinate, MjcfModel, PosedJoint, Refusal, RefusedAt};
use std::path::Path;

/// A mechanism.
#[derive(Debug, Clone)]
pub(crate) struct Mechanism {
    /// Gravity (m/s²).
    pub(crate) gravity: Vector,
    /// Links in the order of the file: a parent before its children.
    pub(crate) links: Vec<Link>,
    pub(crate) tendons: Vec<Tendon>,
    motors: Vec<Motor>,
}

/// A body and its attachment to its parent.
#[derive(Debug, Clone)]
pub(crate) struct Link {
    /// Index of the parent; `None` for the world.
    pub(crate) parent: Option<usize>,
    /// Pose in the parent when the joint is at zero.
    pub(crate) pose: Pose,
    pub(crate) mass: MassProperties,
    /// Joint; `None` if rigid.
    pub(crate) joint: Option<Joint>,
}

/// Degree of freedom of a joint.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Freedom {
    /// Translation (m, N).
    Slide,
    /// Rotation (rad, N·m).
    Hinge,
}

/// A joint with one degree of freedom.
#[derive(Debug, Clone)]
pub(crate) struct Joint {
    name: Option<String>,
    pub(crate) freedom: Freedom,
    /// Frame in the link, with the axis as x, and the pivot of a hinge as origin.
    pub(crate) frame: Pose,
    /// Damping (N·s/m or N·m·s/rad).
    pub(crate) damping: f64,
    /// Stiffness (N/m or N·m/rad).
    pub(crate) stiffness: f64,
    /// Rest position of the spring (m or rad).
    pub(crate) spring_rest: f64,
    /// Dry friction (N or N·m).
    pub(crate) friction: f64,
    /// Additional inertia of the joint (kg or kg·m²).
    pub(crate) armature: f64,
}

/// Spring and damper along `Σ coefficient·coordinate`.
#[derive(Debug, Clone)]
pub(crate) struct Tendon {
    /// Index of the joint, and coefficient.
    pub(crate) terms: Vec<(usize, f64)>,
    pub(crate) stiffness: f64,
    pub(crate) damping: f64,
    /// Rest length of the spring.
    pub(crate) rest: f64,
}

/// A `<motor>`.
#[derive(Debug, Clone)]
struct Motor {
    name: Option<String>,
    joint: Option<String>,
    gear: f64,
}

/// The joints of the axis, by index.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Axis {
    pub(crate) motor: usize,
    pub(crate) load: LoadCoordinate,
    /// Load coordinate per coordinate of the load joint: the transmission when one joint is both motor and load.
    pub(crate) load_per_joint: f64,
}

impl Mechanism {
    /// Reads the text of a file.
    pub(crate) fn read(xml: &str) -> Result<Self, Vec<MjcfRefusal>> {
        let unreadable = |error: &dyn std::fmt::Display| {
            vec![MjcfRefusal::Unreadable { message: with_short_quotes(&error.to_string()) }]
        };
        depth::check(xml).map_err(|refusal| vec![refusal])?;
        let document = Document::parse(xml).map_err(|error| unreadable(&error))?;
        let refusals = scan(&document);
        if !refusals.is_empty() {
            return Err(refusals);
        }
        // Included files would come from this folder, and <include> is not in the subset.
        let model = Model::from_str(xml, Path::new("")).map_err(|error| unreadable(&error))?;
        Self::resolve(&model, document.root_element())
    }

    fn resolve(model: &Model, root: Node) -> Result<Self, Vec<MjcfRefusal>> {
        let mut refusals = vec![];
        let off = |node: Node| node.has_tag_name("flag") && node.attribute("contact") == Some("disable");
        if !root.descendants().any(off) {
            refusals.extend(possible_contacts(model));
        }
        let mut links = vec![];
        for (_, entry) in model.bodies_iter() {
            let body = &entry.body;
            let name = || body.name.clone().unwrap_or_else(|| "(without a name)".into());
            if body.joints.len() > 1 {
                refusals.push(MjcfRefusal::SeveralJoints { body: name(), joints: body.joints.len() });
            }
            let mass = mass_properties(body, &model.compiler).unwrap_or_else(|refusal| {
                refusals.push(refusal);
                MassProperties::default()
            });
            links.push(Link {
                parent: entry.parent.and_then(|parent| parent.checked_sub(1)),
                pose: body.pose,
                mass,
                joint: body.joints.first().map(|joint| Joint::new(joint, root, &mut refusals)),
            });
        }
        let names: Vec<Option<&str>> =
            links.iter().filter_map(|link| link.joint.as_ref()).map(|joint| joint.name.as_deref()).collect();
        let tendons = root
            .descendants()
            .filter(|node| node.has_tag_name("fixed"))
            .filter_map(|node| Tendon::new(node, &names, &mut refusals))
            .collect();
        let motors = model
            .actuators
            .iter()
            .filter(|actuator| actuator.kind == ActuatorKind::Motor)
            .map(|motor| Motor { name: motor.name.clone(), joint: motor.joint.clone(), gear: motor.gear[0] })
            .collect();
        let gravity = Vector::from_array(model.option.gravity);
        if refusals.is_empty() { Ok(Self { gravity, links, tendons, motors }) } else { Err(refusals) }
    }

    /// The joints in order, each with the index of its link.
    pub(crate) fn joints(&self) -> impl Iterator<Item = (usize, &Joint)> {
        self.links.iter().enumerate().filter_map(|(i, link)| link.joint.as_ref().map(|joint| (i, joint)))
    }

    /// Finds the joints and the motor of the axis.
    pub(crate) fn axis(&self, file: &MjcfModel) -> Result<Axis, Vec<MjcfRefusal>> {
        let mut refusals = vec![];
        let names = || self.joints().filter_map(|(_, joint)| joint.name.as_deref());
        let mut joint = |name: &str| {
            let found = self.joints().position(|(_, joint)| joint.name.as_deref() == Some(name));
            if found.is_none() {
                refusals.push(MjcfRefusal::Unknown { what: "joint", name: name.into(), known: names_listed(names()) });
            }
            found
        };
        let (motor, load) = (joint(&file.motor_joint), joint(&file.load_joint));
        let named = |motor: &&Motor| motor.name.as_deref() == Some(&file.actuator);
        let wrong = match self.motors.iter().find(named) {
            None => {
                let known = names_listed(self.motors.iter().filter_map(|motor| motor.name.as_deref()));
                refusals.push(MjcfRefusal::Unknown { what: "motor", name: file.actuator.clone(), known });
                None
            }
            Some(motor) if motor.joint.as_deref() != Some(&file.motor_joint) => {
                Some(format!("acts on joint {}", names_listed(motor.joint.as_deref())))
            }
            Some(motor) if motor.gear == 0.0 => Some("has no gear".into()),
            Some(_) => None,
        };
        if let Some(what) = wrong {
            let (actuator, joint) = (file.actuator.clone(), file.motor_joint.clone());
            refusals.push(MjcfRefusal::Actuator { actuator, what, joint });
        }
        if let (Some(motor), Some(load)) = (motor, load) {
            refusals.extend(self.misfits(file, motor, load));
        }
        match (motor, load) {
            (Some(motor), Some(load)) if refusals.is_empty() => {
                let load_per_joint = if motor == load { file.transmission } else { 1.0 };
                Ok(Axis { motor, load: self.load_coordinate(motor, load), load_per_joint })
            }
            _ => Err(refusals),
        }
    }

    /// Mismatches between the kinds of motor and load joint and those of the axis.
    fn misfits(&self, file: &MjcfModel, motor: usize, load: usize) -> Vec<MjcfRefusal> {
        let kinds: Vec<Coordinate> = self.joints().map(|(_, joint)| joint.freedom.coordinate()).collect();
        let all = file.misfits(kinds[motor], kinds[load]);
        let named = all.into_iter().filter_map(|Refusal { place, message }| match place {
            RefusedAt::Joint { name: joint, is_motor } => Some(MjcfRefusal::Misfit { joint, is_motor, message }),
            RefusedAt::Line(_) | RefusedAt::Name(_) | RefusedAt::File => None,
        });
        named.collect()
    }

    /// The load's coordinate, from the indices of the motor joint and the load joint.
    fn load_coordinate(&self, motor: usize, load: usize) -> LoadCoordinate {
        // For each link its rotation in the world and the joints that move it; for each joint the joints below it.
        let mut ways: Vec<(DQuat, Vec<PosedJoint>)> = vec![];
        let mut joints: Vec<(PosedJoint, Vec<PosedJoint>)> = vec![];
        for link in &self.links {
            let (turn, mut way) = link.parent.map_or_else(Default::default, |parent| ways[parent].clone());
            let turn = turn * link.pose.rotation;
            if let Some(joint) = &link.joint {
                let axis = turn * joint.frame.rotation * DVec3::X;
                let kind = joint.freedom.coordinate();
                let posed = PosedJoint { number: joints.len(), kind, axis: axis.to_array() };
                joints.push((posed, way.clone()));
                way.push(posed);
            }
            ways.push((turn, way));
        }
        LoadCoordinate::new(joints[load].0, &joints[load].1, &joints[motor].1)
    }

    /// Name of joint `i`, for messages.
    pub(crate) fn joint_name(&self, i: usize) -> String {
        let named = self.joints().nth(i).and_then(|(_, joint)| joint.name.clone());
        named.unwrap_or_else(|| "(without a name)".into())
    }
}

impl Freedom {
    const fn coordinate(self) -> Coordinate {
        match self {
            Self::Slide => Coordinate::Linear,
            Self::Hinge => Coordinate::Rotary,
        }
    }
}

impl Joint {
    fn new(joint: &MjcfJoint, root: Node, refusals: &mut Vec<MjcfRefusal>) -> Self {
        let axis = DVec3::from_array(joint.axis);
        if axis.length() < 1e-10 {
            let zero = |node: &Node| node.has_tag_name("joint") && node.attribute("name") == joint.name.as_deref();
            refusals.push(MjcfRefusal::Value {
                line: root.descendants().find(zero).map_or(1, line),
                element: "joint",
                attribute: "axis".into(),
                value: format!("{} {} {}", axis.x, axis.y, axis.z),
                supported: "a direction".into(),
            });
        }
        let turn = DQuat::from_rotation_arc(DVec3::X, axis.normalize_or(DVec3::X));
        Self {
            name: joint.name.clone(),
            freedom: if joint.type_ == JointType::Slide { Freedom::Slide } else { Freedom::Hinge },
            frame: Pose::from_parts(DVec3::from_array(joint.pos), turn),
            damping: joint.damping,
            stiffness: joint.stiffness,
            spring_rest: joint.springref,
            friction: joint.frictionloss,
            armature: joint.armature,
        }
    }
}

impl Tendon {
    /// mjcf-rs keeps the terms of a tendon but not its spring and damper; both are read here.
    fn new(node: Node, joints: &[Option<&str>], refusals: &mut Vec<MjcfRefusal>) -> Option<Self> {
        let number = |attribute: &str| node.attribute(attribute).and_then(|value| value.trim().parse::<f64>().ok());
        let (stiffness, damping) = (number("stiffness").unwrap_or(0.0), number("damping").unwrap_or(0.0));
        let rest = number("springlength");
        if stiffness > 0.0 && rest.is_none() {
            let attribute = "springlength";
            refusals.push(MjcfRefusal::Missing { line: line(node), element: "fixed", attribute });
            return None;
        }
        // In MuJoCo this one value means: the length at the start.
        if rest == Some(-1.0) {
            refusals.push(MjcfRefusal::Value {
                line: line(node),
                element: "fixed",
                attribute: "springlength".into(),
                value: "-1".into(),
                supported: "a length other than -1".into(),
            });
            return None;
        }
        let mut terms = vec![];
        for term in node.children().filter(Node::is_element) {
            let name = term.attribute("joint").unwrap_or_default();
            let coefficient = term.attribute("coef").map_or(Some(1.0), |value| value.trim().parse().ok());
            if let (Some(joint), Some(coefficient)) =
                (joints.iter().position(|joint| *joint == Some(name)), coefficient)
            {
                terms.push((joint, coefficient));
            } else {
                let known = names_listed(joints.iter().copied().flatten());
                refusals.push(MjcfRefusal::Unknown { what: "joint", name: name.into(), known });
            }
        }
        Some(Self { terms, stiffness, damping, rest: rest.unwrap_or(0.0) })
    }
}
