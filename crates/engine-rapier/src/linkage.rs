//! A mechanism from an MJCF file as a Rapier multibody: reduced coordinates, so that joints neither drift nor yield.
//!
//! ```text
//! (M + h/2·D)·v(k+½) = (M − h/2·D)·v(k−½) + h·Q(k)       Rapier's: M(q), gravity, Coriolis forces; ours are in Q
//! q(k+1) = q(k) + h·v(k+½)                               Rapier's
//! v(k+1) = v(k+½) + h/2·a(k+1)                           ours, for readers: a(k+1) = a(k) + M⁻¹·ΔQ
//! ```
//! This is half kick – drift – half kick with the two half kicks between drifts combined: `Q(k)` holds springs and
//! tendons at q(k) and the mean of the efforts before and after tick k; the first kick is half as strong. Joint dampers
//! are D. Rapier's own joint damping is that of backward Euler, of first order, but half of it there and half of it in Q
//! is the trapezoidal rule. A tendon's damper uses the velocity v(k) and is explicit.
//!
//! Second order, but Coriolis forces are taken at v(k−½): of first order. Dry friction (`frictionloss`) is Rapier's own,
//! a bound on the effort that stops the joint.
//!
//! Rapier takes forces on bodies only, and every changed body costs it a rebuilt active set. Its joint springs act like
//! `Q` and cost nothing: one of stiffness 2⁻¹⁰⁰ that is at rest at 2¹⁰⁰·Q pulls with Q, exactly.
mod assembly;

use crate::mjcf::{Axis, Mechanism, MjcfRefusal, Tendon};
use crate::scene::{self, diverged};
use assembly::assemble;
use nalgebra::DVector;
use rapier3d_f64::prelude::{Multibody, MultibodyIndex, MultibodyJointSet, PhysicsWorld, Vector};
use servobench_base::state::Stateful;
use servobench_plant::{
    Actuation, BodyState, Identity, Input, Mechanics, MechanicsError, MechanicsSetup, check_states,
};
use std::f64::consts::TAU;

/// 2¹⁰⁰: distance of a spring's rest position per unit of effort.
const FAR: f64 = 1_267_650_600_228_229_401_496_703_205_376.0;
/// A joint with dry friction that is slower than this is at rest (m/s or rad/s): the remainder of zero in Rapier's solver.
const REST: f64 = 1e-12;

/// A mechanism simulated in Rapier.
#[derive(Stateful)]
pub(crate) struct Linkage {
    identity: Identity,
    #[state(recomputed)]
    world: PhysicsWorld,
    #[state(constant)]
    multibody: MultibodyIndex,
    /// Gravity (m/s²).
    #[state(constant)]
    gravity: Vector,
    /// Tick length (s).
    #[state(constant)]
    step: f64,
    #[state(fixed)]
    joints: Vec<Coordinate>,
    #[state(constant)]
    tendons: Vec<Tendon>,
    #[state(constant)]
    axis: Axis,
    /// Efforts of the last tick on motor joint and load (N or N·m).
    last: [f64; 2],
    /// True before the first tick.
    fresh: bool,
    /// Scratch: one number for each joint, within the current tick.
    #[state(recomputed)]
    work: DVector<f64>,
    #[state(recomputed)]
    bodies: Vec<BodyState>,
}

/// A joint with its coordinate.
#[derive(Debug, Clone, Copy, Stateful)]
struct Coordinate {
    /// Number of its link in the multibody.
    #[state(constant)]
    link: usize,
    /// Rapier's number of its axis: 0 for a slide along x, 3 for a hinge about x.
    #[state(constant)]
    axis: usize,
    /// Stiffness (N/m or N·m/rad).
    #[state(constant)]
    stiffness: f64,
    /// Rest position of the spring (m or rad).
    #[state(constant)]
    spring_rest: f64,
    /// Damping (N·s/m or N·m·s/rad).
    #[state(constant)]
    damping: f64,
    /// Dry friction (N or N·m).
    #[state(constant)]
    friction: f64,
    /// Rapier's coordinate (m or rad).
    position: f64,
    /// Whole turns removed from Rapier's coordinate, which alone varies continuously.
    #[state(derived)]
    turns: f64,
    /// Velocity at the tick (m/s or rad/s).
    velocity: f64,
    /// Rapier's velocity: that of the last drift (m/s or rad/s).
    drift: f64,
    /// Effort in the last kick, without that of the damper (N or N·m).
    #[state(derived)]
    effort: f64,
}

/// Reasons why a mechanism cannot be put into Rapier.
#[derive(Debug)]
pub(crate) enum LinkageError {
    /// The file has unsupported parts.
    Refused(Vec<MjcfRefusal>),
    /// Rapier failed.
    Engine(MechanicsError),
}

/// Checks that the mechanism can be put into Rapier.
pub(crate) fn check(mechanism: &Mechanism) -> Result<(), Vec<MjcfRefusal>> {
    match assemble(mechanism, 1.0) {
        Err(LinkageError::Refused(refusals)) => Err(refusals),
        Err(LinkageError::Engine(error)) => Err(vec![MjcfRefusal::Unreadable { message: error.to_string() }]),
        Ok(_) => Ok(()),
    }
}

impl Linkage {
    /// The mechanism with motor and load in the given states; the rest of it at rest at zero.
    pub(crate) fn new(mechanism: &Mechanism, axis: Axis, setup: &MechanicsSetup) -> Result<Self, LinkageError> {
        let (step, initial) = (setup.step, &setup.initial);
        let (world, multibody, mut joints) = assemble(mechanism, step)?;
        let mut bodies = vec![BodyState::default(); if axis.motor == axis.load.joint() { 1 } else { 2 }];
        bodies.iter_mut().zip(initial).for_each(|(body, initial)| *body = *initial);
        joints[axis.motor].start(bodies[0]);
        if let Some(load) = bodies.get(1) {
            let position = axis.load.own(load.position, |joint| joints[joint].position);
            let velocity = axis.load.own(load.velocity, |joint| joints[joint].velocity);
            joints[axis.load.joint()].start(BodyState { position, velocity });
        }
        let mut linkage = Self {
            world,
            multibody,
            gravity: mechanism.gravity,
            step,
            work: DVector::zeros(joints.len()),
            joints,
            tendons: mechanism.tendons.clone(),
            last: [0.0; 2],
            fresh: true,
            axis,
            bodies,
            identity: Identity::new(crate::NAME, setup),
        };
        linkage.put().and_then(|()| scene::take_in(&mut linkage.world)).map_err(LinkageError::Engine)?;
        linkage.publish();
        Ok(linkage)
    }

    /// Sets Rapier's joints to our coordinates; Rapier recomputes the rest in each tick.
    fn put(&mut self) -> Result<(), MechanicsError> {
        let links = links(&mut self.world.multibody_joints, self.multibody)?;
        // Rapier adds to its coordinate. The first sum may be rounded; the second one is of neighbouring numbers, and exact.
        for _ in 0..2 {
            for (way, joint) in self.work.iter_mut().zip(&self.joints) {
                let now = links.link(joint.link).map_or(0.0, |link| link.joint().coords()[joint.axis]);
                *way = joint.position - now;
            }
            links.apply_displacements(self.work.as_slice());
        }
        for (velocity, joint) in links.generalized_velocity_mut().iter_mut().zip(&self.joints) {
            *velocity = joint.drift;
        }
        Ok(())
    }

    /// Efforts of springs and of tendons' dampers on each joint, into `work`.
    fn passive(&mut self) {
        for (effort, joint) in self.work.iter_mut().zip(&self.joints) {
            *effort = -joint.stiffness * (joint.coordinate() - joint.spring_rest);
        }
        for tendon in &self.tendons {
            let (mut stretch, mut rate) = (-tendon.rest, 0.0);
            for &(joint, coefficient) in &tendon.terms {
                stretch += coefficient * self.joints[joint].coordinate();
                rate += coefficient * self.joints[joint].velocity;
            }
            let force = tendon.stiffness * stretch + tendon.damping * rate;
            for &(joint, coefficient) in &tendon.terms {
                self.work[joint] -= coefficient * force;
            }
        }
    }

    /// Kick and drift by Rapier; `share` is the fraction of a kick.
    fn kick_and_drift(&mut self, share: f64) -> Result<(), MechanicsError> {
        let links = links(&mut self.world.multibody_joints, self.multibody)?;
        for (i, joint) in self.joints.iter().enumerate() {
            let damping = share * joint.damping / 2.0;
            links.damping_mut()[i] = damping;
            links.frictions_mut()[i] = share * joint.friction;
            let effort = joint.effort - damping * joint.drift;
            if let Some(link) = links.link_mut(joint.link) {
                link.joint.set_spring(joint.axis, 1.0 / FAR, effort * FAR);
            }
        }
        self.world.gravity = self.gravity * share;
        scene::step(&mut self.world)
    }

    /// Reads the coordinates from Rapier, and removes whole turns from them.
    fn read(&mut self, share: f64) -> Result<(), MechanicsError> {
        let links = links(&mut self.world.multibody_joints, self.multibody)?;
        self.work.fill(0.0);
        let mut turned = false;
        for (i, joint) in self.joints.iter_mut().enumerate() {
            let Some(link) = links.link(joint.link) else { continue };
            joint.position = link.joint().coords()[joint.axis];
            let drift = links.generalized_velocity()[i];
            let acceleration = (drift - joint.drift) / (share * self.step);
            joint.drift = drift;
            joint.velocity = drift + self.step / 2.0 * acceleration;
            if joint.axis != 0 && joint.position.abs() > TAU {
                let turns = (joint.position / TAU).round();
                joint.turns += turns;
                joint.position -= turns * TAU;
                self.work[i] = -turns * TAU;
                turned = true;
            }
        }
        if turned {
            links.apply_displacements(self.work.as_slice());
            for joint in &mut self.joints {
                if let Some(link) = links.link(joint.link) {
                    joint.position = link.joint().coords()[joint.axis];
                }
            }
        }
        Ok(())
    }

    /// Velocities at the tick: `read` assumed constant acceleration; this adds the effect of the efforts that have changed since.
    fn correct_velocities(&mut self, now: [f64; 2], share: f64) -> Result<(), MechanicsError> {
        self.passive();
        self.work[self.axis.motor] += now[0];
        for (joint, share) in self.axis.load.terms() {
            self.work[joint] += share * now[1];
        }
        for (change, joint) in self.work.iter_mut().zip(&self.joints) {
            let rise = 2.0 * (joint.velocity - joint.drift);
            *change -= joint.effort / share + joint.damping * rise;
        }
        let links = links(&mut self.world.multibody_joints, self.multibody)?;
        if !links.inv_augmented_mass().solve_mut(&mut self.work) {
            return Err(diverged());
        }
        for (i, (change, joint)) in self.work.iter().zip(&mut self.joints).enumerate() {
            if joint.friction > 0.0 && joint.drift.abs() < REST {
                (joint.velocity, joint.drift) = (0.0, 0.0);
                links.generalized_velocity_mut()[i] = 0.0;
            } else {
                joint.velocity += self.step / 2.0 * change;
            }
        }
        Ok(())
    }

    fn publish(&mut self) {
        let (joints, load) = (&self.joints, &self.axis.load);
        let motor = &joints[self.axis.motor];
        self.bodies[0] = BodyState { position: motor.coordinate(), velocity: motor.velocity };
        if let Some(body) = self.bodies.get_mut(1) {
            body.position = load.of(|joint| joints[joint].coordinate());
            body.velocity = load.of(|joint| joints[joint].velocity);
        }
    }
}

impl Mechanics for Linkage {
    fn state(&mut self) -> Option<&mut dyn Stateful> {
        Some(self)
    }

    fn restored(&mut self) -> Result<(), MechanicsError> {
        self.put()?;
        self.publish();
        Ok(())
    }

    fn bodies(&self) -> &[BodyState] {
        &self.bodies
    }

    fn advance(&mut self, input: &Input) -> Result<(), MechanicsError> {
        let Actuation::Effort(effort) = input.actuation else {
            return Err(MechanicsError::wrong_actuation(crate::NAME));
        };
        let now = [effort + input.motor_disturbance, self.axis.load_per_joint * input.load_disturbance];
        let share = if std::mem::take(&mut self.fresh) { 0.5 } else { 1.0 };
        self.passive();
        for (effort, joint) in self.work.iter().zip(&mut self.joints) {
            joint.effort = share * effort;
        }
        let [motor, load] = std::array::from_fn(|i| f64::midpoint(self.last[i], now[i]));
        self.joints[self.axis.motor].effort += motor;
        for (joint, share) in self.axis.load.terms() {
            self.joints[joint].effort += share * load;
        }
        self.last = now;
        self.kick_and_drift(share)?;
        self.read(share)?;
        self.correct_velocities(now, share)?;
        self.publish();
        let state = |joint: &Coordinate| BodyState { position: joint.position, velocity: joint.velocity };
        check_states(crate::NAME, self.joints.iter().map(state))
    }
}

impl Coordinate {
    /// Sets the state at tick 0.
    fn start(&mut self, state: BodyState) {
        (self.position, self.velocity, self.drift) = (state.position, state.velocity, state.velocity);
    }

    /// Coordinate (m or rad).
    fn coordinate(&self) -> f64 {
        self.turns * TAU + self.position
    }
}

/// The multibody, which Rapier keeps as long as no joint is removed.
fn links(joints: &mut MultibodyJointSet, multibody: MultibodyIndex) -> Result<&mut Multibody, MechanicsError> {
    joints
        .get_multibody_mut(multibody)
        .ok_or_else(|| MechanicsError::Native { engine: crate::NAME, message: "the multibody is gone".into() })
}
