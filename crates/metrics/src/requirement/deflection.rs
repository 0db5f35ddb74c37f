//! Legitimate position errors of an axis whose loops work correctly: efforts displace it, springs give way, friction sticks.

/// Displacement by efforts of an axis that is controlled correctly. Efforts are in the motor's coordinate, positions in that of
/// the axis.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Deflection {
    /// Effort that no program requests: bias, dry friction, and effects that are not modelled.
    pub effort: f64,
    /// Largest effort of the drive; infinite without a limit. No loop holds against a larger disturbance.
    pub max_effort: f64,
    /// Position error per effort of loops without integral: r/(k_p·K).
    pub per_effort: f64,
    /// Velocity error per effort of a velocity loop without integral, r/k_p; 0 with one.
    pub velocity_per_effort: f64,
    /// True where a loop has an integral, which removes the error in time.
    pub has_integral: bool,
    /// Deflection of the springs between motor and load at rest: bias and friction behind each, by its stiffness.
    pub elastic: f64,
    /// Deflection of the springs per effort on the load, in the load's coordinate.
    pub elastic_per_effort: f64,
    /// Friction of the load's side by stiffness, within which the load sticks.
    pub stick: f64,
    /// Deviation from rest at the start.
    pub initial: f64,
}

impl Default for Deflection {
    /// A rigid axis that nothing displaces.
    fn default() -> Self {
        Self {
            effort: 0.0,
            max_effort: f64::INFINITY,
            per_effort: 0.0,
            velocity_per_effort: 0.0,
            has_integral: true,
            elastic: 0.0,
            elastic_per_effort: 0.0,
            stick: 0.0,
            initial: 0.0,
        }
    }
}

impl Deflection {
    /// Position error of loops without integral while `disturbance` acts too.
    pub(super) fn explained(&self, disturbance: f64) -> f64 {
        self.per_effort * (self.effort + disturbance).min(self.max_effort)
    }

    /// Position error of loops without integral from the `disturbance` alone.
    pub(super) fn explained_alone(&self, disturbance: f64) -> f64 {
        self.per_effort * disturbance.min(self.max_effort)
    }

    /// Position error that stays: none with an integral.
    pub(super) fn droop(&self, disturbance: f64) -> f64 {
        if self.has_integral { 0.0 } else { self.explained(disturbance) }
    }

    /// Velocity error that stays while `disturbance` acts.
    pub(super) fn velocity_droop(&self, disturbance: f64) -> f64 {
        self.velocity_per_effort * (self.effort + disturbance).min(self.max_effort)
    }
}
