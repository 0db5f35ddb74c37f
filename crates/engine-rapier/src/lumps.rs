//! The bodies of a chain in Rapier, each sliding along a separate axis.
//!
//! Rapier takes a force on a body only through a changed body, and a changed body makes it rebuild its active set, half
//! as long again as the whole step. Gravity is free. So three lumps share a scene, each free along
//! one of its axes, and the scene's gravity holds the acceleration of each along its axis. A rotary lump slides too, one
//! metre for each radian, with its inertia as mass: nothing wraps, and no quaternion has to be normalised.
//!
//! Rapier's coordinate of a lump is relative to a whole number, its centre, which follows the lump in steps of about
//! [`SPAN`]. At 3000 rpm a coordinate that grew without bound would lose 1e-8 rad in ten seconds to rounding.
use crate::scene;
use rapier3d_f64::prelude::{LockedAxes, MassProperties, PhysicsWorld, RigidBodyBuilder, RigidBodyHandle, Vector};
use servobench_base::state::Stateful;
use servobench_plant::{BodyState, Chain, MechanicsError};

/// Lumps per scene: one for each axis.
const PER_SCENE: usize = 3;
/// Distance from its centre at which a lump gets a new one (m or rad).
const SPAN: f64 = 4.0;

/// Positions of the bodies, each in its own coordinate.
#[derive(Debug, Clone, Copy, Stateful)]
pub(crate) struct Positions<const N: usize> {
    /// Whole numbers to which Rapier's coordinates are relative (m or rad), which alone vary continuously.
    #[state(derived)]
    pub(crate) centre: [f64; N],
    /// Rapier's coordinates (m or rad).
    pub(crate) from_centre: [f64; N],
}

/// The lumps of one chain.
#[derive(Stateful)]
pub(crate) struct Lumps {
    #[state(constant)]
    scenes: Vec<PhysicsWorld>,
    #[state(fixed)]
    members: Vec<Lump>,
    /// Ticks per second (Hz).
    #[state(constant)]
    rate: f64,
}

/// One lump.
#[derive(Stateful)]
struct Lump {
    /// Index in the chain.
    #[state(constant)]
    body: usize,
    #[state(constant)]
    scene: usize,
    /// Axis of the scene: 0, 1, 2.
    #[state(constant)]
    axis: usize,
    #[state(constant)]
    handle: RigidBodyHandle,
    /// Velocity in Rapier (m/s or rad/s) after the last drift; the next one replaces it except for roundings.
    velocity: f64,
}

impl Lumps {
    /// The lumps of bodies `first` and up of `chain`, in these states.
    pub(crate) fn new<const N: usize>(
        chain: &Chain,
        first: usize,
        initial: &[BodyState; N],
        step: f64,
    ) -> Result<(Self, Positions<N>), MechanicsError> {
        let count = N - first;
        let mut scenes: Vec<PhysicsWorld> = (0..count.div_ceil(PER_SCENE)).map(|_| scene::empty(step)).collect();
        let mut positions = Positions { centre: [0.0; N], from_centre: [0.0; N] };
        let mut members = Vec::with_capacity(count);
        for (i, body) in (first..N).enumerate() {
            let (scene, axis) = (i / PER_SCENE, i % PER_SCENE);
            let BodyState { position, velocity } = initial[body];
            positions.centre[body] = position.round();
            positions.from_centre[body] = position - position.round();
            let inertia = chain.bodies()[body].inertia;
            let rigid = RigidBodyBuilder::dynamic()
                .locked_axes(LockedAxes::all() ^ LockedAxes::from_bits_truncate(1 << axis))
                .additional_mass_properties(MassProperties::new(Vector::ZERO, inertia, Vector::splat(inertia)))
                .translation(along(axis, positions.from_centre[body]))
                .linvel(along(axis, velocity))
                .can_sleep(false);
            let handle = scenes[scene].bodies.insert(rigid);
            members.push(Lump { body, scene, axis, handle, velocity });
        }
        for scene in &mut scenes {
            scene::take_in(scene)?;
        }
        Ok((Self { scenes, members, rate: 1.0 / step }, positions))
    }

    /// One tick of Rapier in which the lumps move with `velocities`; updates these and `positions` from Rapier. Returns true if
    /// a lump got a new centre.
    #[inline]
    pub(crate) fn drift<const N: usize>(
        &mut self,
        velocities: &mut [f64; N],
        positions: &mut Positions<N>,
    ) -> Result<bool, MechanicsError> {
        for lump in &self.members {
            let acceleration = (velocities[lump.body] - lump.velocity) * self.rate;
            self.scenes[lump.scene].gravity[lump.axis] = acceleration;
        }
        for scene in &mut self.scenes {
            scene::step(scene)?;
        }
        let mut recentred = false;
        for lump in &mut self.members {
            let rigid = &self.scenes[lump.scene].bodies[lump.handle];
            lump.velocity = rigid.linvel()[lump.axis];
            velocities[lump.body] = lump.velocity;
            let position = rigid.translation()[lump.axis];
            positions.from_centre[lump.body] = position;
            if position.abs() > SPAN {
                // Both sums are exact: whole numbers, and a difference from the nearest one.
                positions.centre[lump.body] += position.round();
                positions.from_centre[lump.body] = position - position.round();
                let translation = along(lump.axis, positions.from_centre[lump.body]);
                self.scenes[lump.scene].bodies[lump.handle].set_translation(translation, false);
                recentred = true;
            }
        }
        Ok(recentred)
    }

    /// Moves the lumps in Rapier to `positions`, with their velocities there.
    pub(crate) fn put<const N: usize>(&mut self, positions: &Positions<N>) {
        for lump in &self.members {
            let rigid = &mut self.scenes[lump.scene].bodies[lump.handle];
            rigid.set_translation(along(lump.axis, positions.from_centre[lump.body]), false);
            rigid.set_linvel(along(lump.axis, lump.velocity), false);
        }
    }

    /// Stops a body in Rapier, if it moves there.
    pub(crate) fn stop(&mut self, body: usize) {
        if let Some(lump) = self.members.iter_mut().find(|lump| lump.body == body && lump.velocity != 0.0) {
            lump.velocity = 0.0;
            self.scenes[lump.scene].bodies[lump.handle].set_linvel(Vector::ZERO, false);
        }
    }
}

/// A vector along one axis of a scene.
fn along(axis: usize, value: f64) -> Vector {
    let mut vector = Vector::ZERO;
    vector[axis] = value;
    vector
}
