//! Rapier scenes of this engine: bodies and joints, no colliders, no substeps.
use crate::NAME;
use rapier3d_f64::prelude::{IntegrationParameters, PhysicsWorld, Vector};
use servobench_plant::MechanicsError;

/// An empty scene without gravity, with ticks of `step` seconds.
pub(crate) fn empty(step: f64) -> PhysicsWorld {
    let integration_parameters = IntegrationParameters {
        dt: step,
        // With more, Rapier applies the force of the tick's start in every substep: a spring then gains energy.
        num_solver_iterations: 1,
        // These settings only concern contacts, which do not occur.
        num_internal_stabilization_iterations: 0,
        max_ccd_substeps: 0,
        warmstart_coefficient: 0.0,
        // The default is 400 m/s: a coordinate in radians can be faster.
        normalized_max_linear_velocity: f64::MAX,
        ..IntegrationParameters::default()
    };
    PhysicsWorld { gravity: Vector::ZERO, integration_parameters, ..PhysicsWorld::default() }
}

/// Runs one tick.
///
/// Rapier does not report a body that went to infinity: it stops the body where it was and quarantines it.
pub(crate) fn step(scene: &mut PhysicsWorld) -> Result<(), MechanicsError> {
    scene.step();
    if scene.quarantine().is_empty() { Ok(()) } else { Err(diverged()) }
}

/// Lets Rapier process additions (mass properties, joints); no time passes.
pub(crate) fn take_in(scene: &mut PhysicsWorld) -> Result<(), MechanicsError> {
    let tick = std::mem::replace(&mut scene.integration_parameters.dt, 0.0);
    step(scene)?;
    scene.integration_parameters.dt = tick;
    Ok(())
}

/// Error of a state that is no longer finite.
pub(crate) fn diverged() -> MechanicsError {
    MechanicsError::Diverged { engine: NAME, message: "a position or velocity is not finite".into() }
}
