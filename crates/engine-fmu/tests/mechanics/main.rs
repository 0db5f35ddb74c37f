//! An FMU as the mechanics. The FMUs of these tests are built-in engines behind the FMU interface.
mod allocation;
mod exchange;
mod ports;
mod saved;

use servobench_base::Coordinate;
use servobench_engine_fmu::{FmuMechanics, InSi, Ports};
use servobench_fmi::{FmuFile, FmuMistake, Isolation, ModelDescription, SiPort, SiUnit, Slave, SlaveError, StepEnd};
use servobench_plant::{
    Actuation, Body, Chain, Drive, Engine, Exact, FmuBody, FmuModel, Friction, Input, Link, Mechanics, MechanicsSetup,
    Model,
};

/// Base tick (s).
const TICK: f64 = 1.0 / 8_000.0;

fn two_mass() -> Chain {
    let friction = Friction { viscous: 0.01, ..Friction::NONE };
    let body =
        |name, coordinate, inertia, transmission| Body { name, coordinate, inertia, transmission, friction, bias: 0.0 };
    let bodies = vec![body("motor", Coordinate::Rotary, 1e-3, 5e-3), body("table", Coordinate::Linear, 30.0, 1.0)];
    Chain::new(bodies, vec![Link { stiffness: 2e6, damping: 300.0 }]).unwrap()
}

fn exact(step: f64) -> Box<dyn Mechanics> {
    Exact
        .build(&MechanicsSetup { model: Model::Chain(two_mass()), drive: Drive::Effort, step, initial: Vec::new() })
        .unwrap()
}

/// The engine `exact` as an FMU: torque of the motor and, if it is wired, force on the table in; positions and velocities out.
struct ExactFmu(Box<dyn Mechanics>);

impl ExactFmu {
    fn new(step: f64) -> Self {
        Self(exact(step))
    }
}

impl Slave for ExactFmu {
    fn step(&mut self, _: f64, _: f64, inputs: &[[f64; 3]]) -> Result<StepEnd, SlaveError> {
        let force = inputs.get(1).map_or(0.0, |force| force[0]);
        self.0.advance(&input(inputs[0][0], force)).unwrap();
        Ok(StepEnd::Done)
    }

    fn read(&mut self, _: Option<&[f64]>, outputs: &mut [f64]) -> Result<(), SlaveError> {
        let states = self.0.bodies().iter().flat_map(|body| [body.position, body.velocity]);
        outputs.iter_mut().zip(states).for_each(|(output, state)| *output = state);
        Ok(())
    }
}

fn input(torque: f64, load_disturbance: f64) -> Input {
    Input { actuation: Actuation::Effort(torque), motor_disturbance: 0.0, load_disturbance }
}

/// A description of FMI 2.0 with these variables: name, causality, unit (empty for none).
fn description(variables: &[(&str, &str, &str)]) -> ModelDescription {
    let scalar = |(k, (name, causality, unit)): (usize, &(&str, &str, &str))| {
        let start = if *causality == "input" { " start=\"0\"" } else { "" };
        let unit = if unit.is_empty() { String::new() } else { format!(" unit=\"{unit}\"") };
        format!(
            "<ScalarVariable name=\"{name}\" valueReference=\"{k}\" causality=\"{causality}\"><Real{start}{unit}/></ScalarVariable>"
        )
    };
    let outputs = variables.iter().enumerate().filter(|(_, (_, causality, _))| *causality == "output");
    let outputs: Vec<_> = outputs.map(|(k, _)| format!("<Unknown index=\"{}\"/>", k + 1)).collect();
    let variables: Vec<_> = variables.iter().enumerate().map(scalar).collect();
    let (outputs, variables) = (outputs.concat(), variables.concat());
    let text = format!(
        r#"<fmiModelDescription fmiVersion="2.0" modelName="table" guid="{{1}}">
<CoSimulation modelIdentifier="table"/>
<UnitDefinitions>
<Unit name="N.mm"><BaseUnit kg="1" m="2" s="-2" factor="0.001"/></Unit>
<Unit name="kN"><BaseUnit kg="1" m="1" s="-2" factor="1000"/></Unit>
<Unit name="rev"><BaseUnit rad="1" factor="6.283185307179586"/></Unit>
<Unit name="rpm"><BaseUnit s="-1" factor="0.10471975511965977"/></Unit>
<Unit name="mm"><BaseUnit m="1" factor="0.001"/></Unit>
<Unit name="m/min"><BaseUnit m="1" s="-1" factor="0.016666666666666666"/></Unit>
<Unit name="m"/><Unit name="inch"/>
</UnitDefinitions>
<ModelVariables>{variables}</ModelVariables>
<ModelStructure><Outputs>{outputs}</Outputs></ModelStructure>
</fmiModelDescription>"#
    );
    ModelDescription::read(&text, "table.fmu").unwrap_or_else(|error| panic!("{error}"))
}

const IN_SI: [(&str, &str, &str); 6] = [
    ("torque", "input", ""),
    ("force", "input", ""),
    ("angle", "output", ""),
    ("speed", "output", ""),
    ("x", "output", ""),
    ("v", "output", ""),
];

const NEWTON: (&str, [i32; 4]) = ("N", [1, 1, -2, 0]);
const NEWTON_METRE: (&str, [i32; 4]) = ("N m", [1, 2, -2, 0]);
const RADIAN: (&str, [i32; 4]) = ("rad", [0; 4]);
const METRE: (&str, [i32; 4]) = ("m", [0, 1, 0, 0]);
const RADIAN_PER_SECOND: (&str, [i32; 4]) = ("rad/s", [0, 0, -1, 0]);
const METRE_PER_SECOND: (&str, [i32; 4]) = ("m/s", [0, 1, -1, 0]);

fn port(variable: &str, (name, exponents): (&str, [i32; 4])) -> SiPort {
    SiPort { variable: variable.into(), unit: Some(SiUnit { name: name.into(), exponents }) }
}

fn model(ticks: u32) -> FmuModel {
    FmuModel {
        file: FmuFile { path: "table.fmu".into(), start: Vec::new(), isolation: Isolation::None, event_mode: true },
        effort: port("torque", NEWTON_METRE),
        motor: FmuBody { position: port("angle", RADIAN), velocity: Some(port("speed", RADIAN_PER_SECOND)) },
        load: Some(FmuBody { position: port("x", METRE), velocity: Some(port("v", METRE_PER_SECOND)) }),
        motor_disturbance: None,
        load_disturbance: Some(port("force", NEWTON)),
        transmission: 5e-3,
        ticks,
    }
}

fn ports(model: &FmuModel, variables: &[(&str, &str, &str)]) -> Result<Ports, Vec<FmuMistake>> {
    Ports::new(model.inputs(), model.outputs(), &description(variables))
}

fn mechanics(slave: impl Slave + 'static, model: &FmuModel, variables: &[(&str, &str, &str)]) -> FmuMechanics {
    let slave = InSi::new(Box::new(slave), ports(model, variables).unwrap());
    FmuMechanics::new(Box::new(slave), model, TICK).unwrap()
}
