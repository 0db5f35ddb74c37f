//! Parts of an axis that an FMU can be.
use servobench_scenario::{Actuator, AxisMechanics, Scenario};

servobench_config::choices! {
    /// Part of an axis that an FMU represents.
    pub enum Part default Axis {
        /// program, drive, motor and mechanics: set-points or targets in, motion out
        Axis = "axis",
        /// program, drive and motor: measurements in, effort out
        Drive = "drive",
        /// the mechanics: effort in, motion out
        Mechanics = "mechanics",
    }
}

impl Part {
    /// The subset of `scenario` for this part, with every channel.
    pub(crate) fn of(self, scenario: &Scenario) -> Scenario {
        let mut own = scenario.clone();
        own.record.channels.clear();
        if self == Self::Mechanics {
            // All influences on the mechanics come from outside.
            own.actuator = Actuator::Off(None);
            (own.bus, own.plc, own.interpolation) = (None, None, None);
            own.program.clear();
            own.disturbances.clear();
            own.fmus.clear();
        }
        own
    }
}

/// True if motor and load are one body.
pub(crate) fn has_one_body(scenario: &Scenario) -> bool {
    match &scenario.axis.mechanics {
        AxisMechanics::Bodies(chain) => chain.bodies().len() == 1,
        AxisMechanics::Mjcf(mjcf) => mjcf.motor_joint == mjcf.load_joint,
        AxisMechanics::InTheFmu => false,
    }
}
