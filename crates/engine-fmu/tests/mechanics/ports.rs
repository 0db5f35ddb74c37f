//! Names and units of the variables that are exchanged.
use super::*;
use servobench_engine_fmu::{PortError, PortProblem, Quantity};
use servobench_fmi::Port;

/// Passes on to an FMU in SI units what comes in others, the other way round for what comes out: what a tool does that counts
/// in them.
struct InOtherUnits(ExactFmu);

impl Toy for InOtherUnits {
    fn step(&mut self, time: f64, length: f64, inputs: &[[f64; 3]]) -> Result<Progress, SlaveError> {
        // 1 N·m is 1000 N·mm, 1 kN is 1000 N.
        self.0.step(time, length, &[inputs[0].map(|torque| torque / 1000.0), inputs[1].map(|force| force * 1000.0)])
    }

    fn read(&mut self, outputs: &mut [f64]) {
        self.0.read(outputs);
        // rad → rev, rad/s → rpm, m → mm, m/s → m/min.
        let factors = [0.15915494309189535, 9.549296585513721, 1000.0, 60.0];
        outputs.iter_mut().zip(factors).for_each(|(output, factor)| *output *= factor);
    }
}

/// Oracle: the same FMU in SI units. Tolerance: a few roundings each way at every tick, relative to what there is; the axis is
/// an oscillator with damping, in which they do not grow.
#[test]
fn units_are_those_of_the_description() {
    let others = [
        ("torque", "input", "N.mm"),
        ("force", "input", "kN"),
        ("angle", "output", "rev"),
        ("speed", "output", "rpm"),
        ("x", "output", "mm"),
        ("v", "output", "m/min"),
    ];
    let mut fmu = mechanics(InOtherUnits(ExactFmu::new(TICK)), &model(1, Extrapolation::Linear), &others);
    let mut here = exact(TICK);
    for tick in 0..500 {
        let all = input((f64::from(tick) * 0.1).sin(), 50.0);
        fmu.advance(&all).unwrap();
        here.advance(&all).unwrap();
        for (body, at) in fmu.bodies().iter().zip(here.bodies()) {
            assert!((body.position - at.position).abs() <= 1e-12 * at.position.abs().max(1e-3), "{body:?} {at:?}");
            assert!((body.velocity - at.velocity).abs() <= 1e-12 * at.velocity.abs().max(1.0), "{body:?} {at:?}");
        }
    }
}

fn problems(model: &FmuModel, variables: &[(&str, &str, &str)]) -> Vec<PortError> {
    MechanicsPorts::new(model, &description(variables)).err().unwrap_or_default()
}

#[test]
fn ports_are_in_the_order_in_which_they_are_exchanged() {
    let ports = MechanicsPorts::new(&model(1, Extrapolation::Linear), &description(&IN_SI)).unwrap();
    let names = |ports: Vec<&Port>| ports.iter().map(|port| port.variable.clone()).collect::<Vec<_>>();
    assert_eq!(names(ports.inputs().collect()), ["torque", "force"]);
    assert_eq!(names(ports.outputs().collect()), ["angle", "speed", "x", "v"]);
}

/// All of it at once, so that a file is mended in one go.
#[test]
fn everything_that_is_wrong_is_said() {
    let wrong = [
        ("torque", "input", "N.mm"),
        ("force", "output", "kN"),
        ("angle", "output", "mm"),
        ("speed", "output", "inch"),
        ("x_1", "output", "m"),
        ("v", "output", ""),
    ];
    let said = problems(&model(1, Extrapolation::Linear), &wrong);
    let said: Vec<String> = said.iter().map(ToString::to_string).collect();
    assert_eq!(
        said,
        [
            "`load_disturbance`: variable `force` is not an input of the FMU",
            "`motor_position`: variable `angle` counts in `mm`, which is not an angle",
            "`motor_velocity`: variable `speed` counts in `inch`, of which the FMU does not say what it is (no `BaseUnit`)",
            "`load_position`: variable `x` is not in the FMU; it has `x_1`",
        ]
    );
}

/// A unit without a definition is what its name says, if that is the SI unit.
#[test]
fn si_units_need_no_definition() {
    let mut variables = IN_SI;
    variables[4].2 = "m";
    assert_eq!(problems(&model(1, Extrapolation::Linear), &variables), []);
    variables[2].2 = "m";
    let undefined = PortProblem::Undefined { unit: "m".into() };
    assert_eq!(problems(&model(1, Extrapolation::Linear), &variables)[0].problem, undefined);
}

#[test]
fn elements_are_counted() {
    let mut model = model(1, Extrapolation::Linear);
    model.effort.element = 1;
    let problem = PortProblem::Element { element: 1, count: 1 };
    assert_eq!(problems(&model, &IN_SI), [PortError { role: "effort", variable: "torque".into(), problem }]);
}

/// A rotary axis needs a torque where a linear one needs a force.
#[test]
fn quantities_are_those_of_the_coordinates() {
    let mut model = model(1, Extrapolation::Linear);
    model.motor.coordinate = Coordinate::Linear;
    let variables = [("torque", "input", "N.mm"), IN_SI[1], IN_SI[2], IN_SI[3], IN_SI[4], IN_SI[5]];
    let problem = PortProblem::Unit { unit: "N.mm".into(), needed: Quantity::Force };
    assert_eq!(problems(&model, &variables), [PortError { role: "effort", variable: "torque".into(), problem }]);
}
