//! Which variables of an FMU are the axis, and how their numbers become SI numbers.
use servobench_fmi::{BaseUnit, Causality, Exponents, ModelDescription, Port};
use servobench_plant::{Coordinate, FmuBody, FmuModel, FmuPort};
use thiserror::Error;

/// What a variable is to be.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Quantity {
    /// N.
    Force,
    /// N·m.
    Torque,
    /// m.
    Length,
    /// rad.
    Angle,
    /// m/s.
    Velocity,
    /// rad/s.
    AngularVelocity,
}

impl Quantity {
    fn effort(coordinate: Coordinate) -> Self {
        match coordinate {
            Coordinate::Linear => Self::Force,
            Coordinate::Rotary => Self::Torque,
        }
    }

    fn position(coordinate: Coordinate) -> Self {
        match coordinate {
            Coordinate::Linear => Self::Length,
            Coordinate::Rotary => Self::Angle,
        }
    }

    fn velocity(coordinate: Coordinate) -> Self {
        match coordinate {
            Coordinate::Linear => Self::Velocity,
            Coordinate::Rotary => Self::AngularVelocity,
        }
    }

    /// As people say it.
    fn words(self) -> &'static str {
        match self {
            Self::Force => "a force",
            Self::Torque => "a torque",
            Self::Length => "a length",
            Self::Angle => "an angle",
            Self::Velocity => "a velocity",
            Self::AngularVelocity => "an angular velocity",
        }
    }

    /// Whether `exponents` are its own. The radian, which some count and some do not, is one.
    fn has(self, exponents: Exponents) -> bool {
        let (kg, m, s) = match self {
            Self::Force => (1, 1, -2),
            Self::Torque => (1, 2, -2),
            Self::Length => (0, 1, 0),
            Self::Angle => (0, 0, 0),
            Self::Velocity => (0, 1, -1),
            Self::AngularVelocity => (0, 0, -1),
        };
        exponents == Exponents { kg, m, s, rad: exponents.rad, ..Exponents::default() }
    }

    /// Names of its SI unit that need no definition: those that tools write.
    fn si_names(self) -> &'static [&'static str] {
        match self {
            Self::Force => &["N"],
            Self::Torque => &["N.m", "N*m", "N·m", "Nm"],
            Self::Length => &["m"],
            Self::Angle => &["rad", "1"],
            Self::Velocity => &["m/s", "m.s-1"],
            Self::AngularVelocity => &["rad/s", "1/s", "rad.s-1"],
        }
    }
}

/// Why a variable cannot be what it is to be.
#[derive(Debug, Clone, PartialEq, Eq, Error)]
#[error("`{role}`: variable `{variable}` {problem}")]
pub struct PortError {
    /// What it is to be, as scenario files have it.
    pub role: &'static str,
    /// Its name.
    pub variable: String,
    /// What is wrong.
    pub problem: PortProblem,
}

/// What is wrong with a variable.
#[derive(Debug, Clone, PartialEq, Eq, Error)]
pub enum PortProblem {
    /// There is none of this name.
    #[error("is not in the FMU{}", similar(.like))]
    Unknown {
        /// Names that are like it.
        like: Vec<String>,
    },
    /// It has another causality.
    #[error("is not {needed} of the FMU")]
    Causality {
        /// What it has to be.
        needed: &'static str,
    },
    /// It is no floating-point number.
    #[error("is no floating-point number")]
    Type,
    /// It has not so many elements.
    #[error("has no element {element}: it has {count}, counted from 0")]
    Element {
        /// What was asked for.
        element: usize,
        /// How many it has.
        count: u64,
    },
    /// Its unit is not that of the quantity.
    #[error("counts in `{unit}`, which is not {}", needed.words())]
    Unit {
        /// Name of the unit.
        unit: String,
        /// What it has to be.
        needed: Quantity,
    },
    /// The FMU does not say what its unit is.
    #[error("counts in `{unit}`, of which the FMU does not say what it is (no `BaseUnit`)")]
    Undefined {
        /// Name of the unit.
        unit: String,
    },
}

fn similar(like: &[String]) -> String {
    match like {
        [] => String::new(),
        like => format!("; it has `{}`", like.join("`, `")),
    }
}

/// A scalar and its unit.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Wire {
    pub(crate) port: Port,
    unit: Option<BaseUnit>,
    is_relative: bool,
}

impl Wire {
    pub(crate) fn to_si(&self, value: f64) -> f64 {
        self.unit.map_or(value, |unit| unit.to_si(value, self.is_relative))
    }

    pub(crate) fn of_si(&self, si: f64) -> f64 {
        self.unit.map_or(si, |unit| unit.from_si(si, self.is_relative))
    }
}

/// A body's outputs.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct BodyWires {
    pub(crate) position: Wire,
    pub(crate) velocity: Option<Wire>,
}

/// All that is exchanged with an FMU that is the mechanics.
#[derive(Debug, Clone, PartialEq)]
pub struct MechanicsPorts {
    pub(crate) effort: Wire,
    pub(crate) motor_disturbance: Option<Wire>,
    pub(crate) load_disturbance: Option<Wire>,
    pub(crate) bodies: Vec<BodyWires>,
}

impl MechanicsPorts {
    /// Looks the variables up.
    ///
    /// # Errors
    /// [`PortError`] for each variable that cannot be what it is to be.
    pub fn new(model: &FmuModel, description: &ModelDescription) -> Result<Self, Vec<PortError>> {
        let mut look = Look { description, errors: Vec::new() };
        let (motor, load) = (model.motor.coordinate, model.load.as_ref().unwrap_or(&model.motor).coordinate);
        let ports = Self {
            effort: look.input("effort", &model.effort, Quantity::effort(motor)),
            motor_disturbance: model
                .motor_disturbance
                .as_ref()
                .map(|port| look.input("motor_disturbance", port, Quantity::effort(motor))),
            load_disturbance: model
                .load_disturbance
                .as_ref()
                .map(|port| look.input("load_disturbance", port, Quantity::effort(load))),
            bodies: [
                (["motor_position", "motor_velocity"], Some(&model.motor)),
                (["load_position", "load_velocity"], model.load.as_ref()),
            ]
            .into_iter()
            .filter_map(|(roles, body)| Some(look.body(roles, body?)))
            .collect(),
        };
        if look.errors.is_empty() { Ok(ports) } else { Err(look.errors) }
    }

    /// Inputs in the order in which they are exchanged.
    pub fn inputs(&self) -> impl Iterator<Item = &Port> {
        self.input_wires().map(|wire| &wire.port)
    }

    pub(crate) fn input_wires(&self) -> impl Iterator<Item = &Wire> {
        std::iter::once(&self.effort).chain(&self.motor_disturbance).chain(&self.load_disturbance)
    }

    /// Outputs in the order in which they are exchanged.
    pub fn outputs(&self) -> impl Iterator<Item = &Port> {
        self.bodies.iter().flat_map(|body| std::iter::once(&body.position).chain(&body.velocity)).map(|wire| &wire.port)
    }
}

struct Look<'a> {
    description: &'a ModelDescription,
    errors: Vec<PortError>,
}

impl Look<'_> {
    fn input(&mut self, role: &'static str, port: &FmuPort, quantity: Quantity) -> Wire {
        let is_input = |causality| causality == Causality::Input;
        self.wire(role, port, quantity, "an input", is_input)
    }

    fn output(&mut self, role: &'static str, port: &FmuPort, quantity: Quantity) -> Wire {
        let is_output = |causality| matches!(causality, Causality::Output | Causality::Local);
        self.wire(role, port, quantity, "an output", is_output)
    }

    fn body(&mut self, [position, velocity]: [&'static str; 2], body: &FmuBody) -> BodyWires {
        BodyWires {
            position: self.output(position, &body.position, Quantity::position(body.coordinate)),
            velocity: (body.velocity.as_ref())
                .map(|port| self.output(velocity, port, Quantity::velocity(body.coordinate))),
        }
    }

    /// The variable; what is wrong with it is noted.
    fn wire(
        &mut self,
        role: &'static str,
        port: &FmuPort,
        quantity: Quantity,
        needed: &'static str,
        fits: impl Fn(Causality) -> bool,
    ) -> Wire {
        self.find(port, quantity, needed, fits).unwrap_or_else(|problem| {
            self.errors.push(PortError { role, variable: port.variable.clone(), problem });
            let port = Port { variable: port.variable.clone(), element: port.element };
            Wire { port, unit: None, is_relative: false }
        })
    }

    fn find(
        &self,
        port: &FmuPort,
        quantity: Quantity,
        needed: &'static str,
        fits: impl Fn(Causality) -> bool,
    ) -> Result<Wire, PortProblem> {
        let Some(variable) = self.description.variable(&port.variable) else {
            let like = self.like(&port.variable, fits);
            return Err(PortProblem::Unknown { like });
        };
        if !fits(variable.causality) {
            return Err(PortProblem::Causality { needed });
        }
        if !variable.data_type.is_float() {
            return Err(PortProblem::Type);
        }
        let count = self.description.shape(variable).iter().product();
        if port.element as u64 >= count {
            return Err(PortProblem::Element { element: port.element, count });
        }
        let unit = match self.description.unit(variable) {
            None => None,
            Some(unit) => match unit.base {
                Some(base) if quantity.has(base.exponents) => Some(base),
                None if quantity.si_names().contains(&unit.name.as_str()) => None,
                Some(_) => return Err(PortProblem::Unit { unit: unit.name.clone(), needed: quantity }),
                None => return Err(PortProblem::Undefined { unit: unit.name.clone() }),
            },
        };
        let port = Port { variable: variable.name.clone(), element: port.element };
        Ok(Wire { port, unit, is_relative: variable.is_relative })
    }

    /// Names of the variables that it could have been.
    fn like(&self, name: &str, fits: impl Fn(Causality) -> bool) -> Vec<String> {
        const MOST: usize = 5;
        let name = name.to_lowercase();
        let is_like = |other: &str| other.contains(&name) || name.contains(other);
        let fitting: Vec<&str> =
            self.description.variables.iter().filter(|one| fits(one.causality)).map(|one| one.name.as_str()).collect();
        let close: Vec<&str> = fitting.iter().copied().filter(|one| is_like(&one.to_lowercase())).collect();
        let shown = if close.is_empty() { fitting } else { close };
        shown.into_iter().take(MOST).map(String::from).collect()
    }
}
