//! Assembly of the links and joints of a mechanism in a Rapier scene.
use super::{Coordinate, LinkageError, links};
use crate::mjcf::{Freedom, Joint, Mechanism, MjcfRefusal};
use crate::scene;
use rapier3d_f64::math::Pose;
use rapier3d_f64::prelude::{
    GenericJointBuilder, JointAxesMask, Multibody, MultibodyIndex, PhysicsWorld, RigidBodyBuilder, RigidBodyHandle,
    RigidBodySet, SpringCoefficients,
};
use servobench_plant::MechanicsError;

/// Stiffness of the stop of a joint by dry friction: so stiff that a joint at rest stays where it is, bit for bit.
const STOP: SpringCoefficients<f64> = SpringCoefficients { natural_frequency: 1e15, damping_ratio: 1.0 };

/// The scene, the multibody that holds all links, and the joints in order.
pub(super) fn assemble(
    mechanism: &Mechanism,
    step: f64,
) -> Result<(PhysicsWorld, MultibodyIndex, Vec<Coordinate>), LinkageError> {
    let mut world = scene::empty(step);
    let ground = world.bodies.insert(RigidBodyBuilder::fixed());
    let mut handles: Vec<RigidBodyHandle> = vec![];
    for link in &mechanism.links {
        let rigid = RigidBodyBuilder::dynamic().additional_mass_properties(link.mass).can_sleep(false);
        let handle = world.bodies.insert(rigid);
        let parent = link.parent.map_or(ground, |parent| handles[parent]);
        let (free, frame) = match &link.joint {
            Some(Joint { freedom: Freedom::Slide, frame, .. }) => (JointAxesMask::LIN_X, *frame),
            Some(Joint { freedom: Freedom::Hinge, frame, .. }) => (JointAxesMask::ANG_X, *frame),
            None => (JointAxesMask::empty(), Pose::default()),
        };
        let joint = GenericJointBuilder::new(JointAxesMask::all() ^ free)
            .local_frame1(link.pose * frame)
            .local_frame2(frame)
            .softness(STOP);
        let joined = world.multibody_joints.insert(parent, handle, joint, false);
        if joined.is_none() {
            return Err(native("a link already hangs on another"));
        }
        handles.push(handle);
    }
    let Some(multibody) = world.multibody_joints.rigid_body_link(ground).map(|link| link.multibody) else {
        return Err(native("there are no links"));
    };
    scene::take_in(&mut world).map_err(LinkageError::Engine)?;

    let joints: Vec<Coordinate> = mechanism.joints().map(|(link, joint)| Coordinate::at_rest(link, joint)).collect();
    let links = links(&mut world.multibody_joints, multibody).map_err(LinkageError::Engine)?;
    links.forward_kinematics(&world.bodies, true);
    if links.ndofs() != joints.len() {
        return Err(native("another number of degrees of freedom than of joints"));
    }
    // Rapier gives hinges a default damping.
    links.damping_mut().fill(0.0);
    for (armature, (_, joint)) in links.armature_mut().iter_mut().zip(mechanism.joints()) {
        *armature = joint.armature;
    }
    check_inertia(mechanism, links, &world.bodies).map_err(LinkageError::Refused)?;
    Ok((world, multibody, joints))
}

impl Coordinate {
    fn at_rest(link: usize, joint: &Joint) -> Self {
        Self {
            // Link 0 is the ground.
            link: link + 1,
            axis: if joint.freedom == Freedom::Slide { 0 } else { 3 },
            stiffness: joint.stiffness,
            spring_rest: joint.spring_rest,
            damping: joint.damping,
            friction: joint.friction,
            position: 0.0,
            turns: 0.0,
            velocity: 0.0,
            drift: 0.0,
            effort: 0.0,
        }
    }
}

/// Refuses joints that move no inertia: the mass matrix would be singular.
fn check_inertia(mechanism: &Mechanism, links: &mut Multibody, bodies: &RigidBodySet) -> Result<(), Vec<MjcfRefusal>> {
    // Sets up the factorised mass matrix for the current coordinates.
    links.dof_inverse_inertia(bodies);
    let (rows, lower, upper) = links.inv_augmented_mass().clone().unpack();
    let mut mass = lower * upper;
    rows.inv_permute_rows(&mut mass);

    let mut refusals = vec![];
    let whole = mass.diagonal();
    for (i, (_, joint)) in mechanism.joints().enumerate() {
        let pivot = mass[(i, i)];
        // Remaining inertia of a joint when the joints before it are free to yield; rounding leaves 1e-16.
        if !(pivot > 1e-12 * whole[i] && pivot > 0.0) {
            let what = if joint.freedom == Freedom::Slide { "mass" } else { "inertia about its axis" };
            refusals.push(MjcfRefusal::Massless { joint: mechanism.joint_name(i), what });
            continue;
        }
        let column = mass.column(i).clone_owned();
        for j in i + 1..whole.len() {
            let factor = column[j] / pivot;
            for k in i + 1..whole.len() {
                mass[(k, j)] -= factor * column[k];
            }
        }
    }
    if refusals.is_empty() { Ok(()) } else { Err(refusals) }
}

fn native(message: &str) -> LinkageError {
    LinkageError::Engine(MechanicsError::Native { engine: crate::NAME, message: message.into() })
}
