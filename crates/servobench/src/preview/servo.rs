//! Inertia of the axis on both sides of its first spring, and its modes.
use servobench_plant::{Chain, Mode};
use servobench_scenario::{Actuator, Scenario};

/// Inertia as the motor feels it (kg·m² or kg in its own coordinate).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Inertias {
    /// The motor with all that is rigid with it.
    pub motor: f64,
    /// Inertia behind the first spring; 0 on a rigid axis.
    pub load: f64,
    /// True if the motor is rotary.
    pub turns: bool,
}

/// Modes of the axis, the slowest first.
#[derive(Debug, Clone, PartialEq)]
pub struct Modes {
    /// With the motor free; empty where it follows its set-point exactly.
    pub free: Vec<Mode>,
    /// With the motor held: those that its set-point excites.
    pub held: Vec<Mode>,
}

impl Inertias {
    pub(super) fn of(chain: &Chain) -> Option<Self> {
        let (first, others) = chain.bodies().split_first()?;
        let r = first.transmission;
        let load = others.iter().map(|body| body.inertia * (r / body.transmission).powi(2)).sum();
        Some(Self { motor: first.inertia, load, turns: first.coordinate == servobench_base::Coordinate::Rotary })
    }
}

impl Modes {
    pub(super) fn of(scenario: &Scenario, chain: &Chain) -> Self {
        let is_prescribed = matches!(scenario.actuator, Actuator::Prescribed);
        Self { free: if is_prescribed { Vec::new() } else { chain.modes(false) }, held: chain.modes(true) }
    }

    /// The fastest of those that an engine integrates.
    #[must_use]
    pub fn fastest(&self) -> Option<Mode> {
        self.free.last().or(self.held.last()).copied()
    }
}
