//! Which part of an axis an FMU is.
use servobench_scenario::{Actuator, AxisMechanics, Scenario};

/// Which part of an axis an FMU is.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Part {
    /// Program, drive, motor and mechanics.
    Axis,
    /// Program, drive and motor: measurements in, effort out.
    Drive,
    /// The mechanics: effort in, motion out.
    Mechanics,
}

impl Part {
    /// All parts.
    pub const ALL: [Self; 3] = [Self::Axis, Self::Drive, Self::Mechanics];

    /// Its name on the command line and in the FMU.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Axis => "axis",
            Self::Drive => "drive",
            Self::Mechanics => "mechanics",
        }
    }

    /// The part of this name.
    #[must_use]
    pub fn from_name(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|part| part.name() == name)
    }

    /// What of `scenario` this part is, with every channel.
    pub(crate) fn of(self, scenario: &Scenario) -> Scenario {
        let mut own = scenario.clone();
        own.record.channels.clear();
        if self == Self::Mechanics {
            // All that acts on the mechanics comes in from outside.
            own.actuator = Actuator::Off;
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
