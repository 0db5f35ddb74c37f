//! Which part of an axis an FMU is.
use servobench_scenario::{Actuator, AxisMechanics, Scenario};

servobench_config::choices! {
    /// Which part of an axis an FMU is.
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
    /// What of `scenario` this part is, with every channel.
    pub(crate) fn of(self, scenario: &Scenario) -> Scenario {
        let mut own = scenario.clone();
        own.record.channels.clear();
        if self == Self::Mechanics {
            // All that acts on the mechanics comes in from outside.
            own.actuator = Actuator::Off(None);
            (own.bus, own.plc, own.interpolation) = (None, None, None);
            own.program.clear();
            own.disturbances.clear();
            own.fmus.clear();
        }
        own
    }
}

/// Whether the motor is the load too.
pub(crate) fn has_one_body(scenario: &Scenario) -> bool {
    match &scenario.axis.mechanics {
        AxisMechanics::Bodies(chain) => chain.bodies().len() == 1,
        AxisMechanics::Mjcf(mjcf) => mjcf.motor_joint == mjcf.load_joint,
        AxisMechanics::InTheFmu => false,
    }
}
