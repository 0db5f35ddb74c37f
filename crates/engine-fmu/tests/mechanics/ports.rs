//! Names and units of exchanged variables.
use super::*;
use servobench_fmi::FmuEntry;

/// Wraps an FMU in SI units as one in other units, converting both inputs and outputs, like a tool that uses these units.
struct InOtherUnits(ExactFmu);

impl Slave for InOtherUnits {
    fn step(&mut self, time: f64, length: f64, inputs: &[[f64; 3]]) -> Result<StepEnd, SlaveError> {
        // 1 N·m is 1000 N·mm, 1 kN is 1000 N.
        self.0.step(time, length, &[inputs[0].map(|torque| torque / 1000.0), inputs[1].map(|force| force * 1000.0)])
    }

    fn read(&mut self, _: Option<&[f64]>, outputs: &mut [f64]) -> Result<(), SlaveError> {
        self.0.read(None, outputs)?;
        // rad → rev, rad/s → rpm, m → mm, m/s → m/min.
        let factors = [0.15915494309189535, 9.549296585513721, 1000.0, 60.0];
        outputs.iter_mut().zip(factors).for_each(|(output, factor)| *output *= factor);
        Ok(())
    }
}

/// Oracle: the same FMU in SI units. Tolerance: a few roundings each way at every tick, relative to the value; the axis is a damped
/// oscillator, in which they do not grow.
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
    let mut fmu = mechanics(InOtherUnits(ExactFmu::new(TICK)), &model(1), &others);
    let mut here = exact(TICK);
    for tick in 0..500 {
        let all = super::input((f64::from(tick) * 0.1).sin(), 50.0);
        fmu.advance(&all).unwrap();
        here.advance(&all).unwrap();
        for (body, at) in fmu.bodies().iter().zip(here.bodies()) {
            assert!((body.position - at.position).abs() <= 1e-12 * at.position.abs().max(1e-3), "{body:?} {at:?}");
            assert!((body.velocity - at.velocity).abs() <= 1e-12 * at.velocity.abs().max(1.0), "{body:?} {at:?}");
        }
    }
}

fn mistakes(model: &FmuModel, variables: &[(&str, &str, &str)]) -> Vec<(FmuEntry, String)> {
    let mistakes = ports(model, variables).err().unwrap_or_default();
    mistakes.into_iter().map(|mistake| (mistake.at.clone(), mistake.to_string())).collect()
}

fn input(name: &str, what: &str) -> (FmuEntry, String) {
    (FmuEntry::Input(name.into()), what.into())
}

fn output(name: &str, what: &str) -> (FmuEntry, String) {
    (FmuEntry::Output(name.into()), what.into())
}

#[test]
fn ports_are_in_the_order_in_which_they_are_exchanged() {
    let model = model(1);
    let names = |ports: Vec<&SiPort>| ports.iter().map(|port| port.variable.clone()).collect::<Vec<_>>();
    assert_eq!(names(model.inputs().collect()), ["torque", "force"]);
    assert_eq!(names(model.outputs().collect()), ["angle", "speed", "x", "v"]);
}

/// All mistakes at once, so that a file is mended in one go.
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
    let said = mistakes(&model(1), &wrong);
    assert_eq!(
        said,
        [
            input("force", "`force` of the FMU is an output, not an input or a tunable parameter; it has `torque`"),
            output(
                "angle",
                "`angle` of the FMU counts in `mm`, which cannot be turned into rad; connect what it is a measure of"
            ),
            output(
                "speed",
                "`speed` of the FMU counts in `inch`, of which it does not say what that is; the model description lacks its \
                 `BaseUnit`: export it with one"
            ),
            output("x", "the FMU has no variable `x`; it has `x_1`"),
        ]
    );
}

/// A unit without a definition is the SI unit of that name, if there is one.
#[test]
fn si_units_need_no_definition() {
    let mut variables = IN_SI;
    variables[4].2 = "m";
    assert_eq!(mistakes(&model(1), &variables), []);
    variables[2].2 = "m";
    let what = "`angle` of the FMU counts in `m`, which cannot be turned into rad; connect what it is a measure of";
    assert_eq!(mistakes(&model(1), &variables), [output("angle", what)]);
}

#[test]
fn elements_are_counted() {
    let mut model = model(1);
    model.effort.variable = "torque[2]".into();
    let what =
        "`torque[2]`: `torque` has the dimensions []; name an element like `x[2]` or `x[2,1]`; indices count from 1";
    assert_eq!(mistakes(&model, &IN_SI), [input("torque[2]", what)]);
}

/// A rotary axis needs a torque where a linear one needs a force.
#[test]
fn quantities_are_those_of_the_coordinates() {
    let mut model = model(1);
    model.effort = port("torque", NEWTON);
    let variables = [("torque", "input", "N.mm"), IN_SI[1], IN_SI[2], IN_SI[3], IN_SI[4], IN_SI[5]];
    let what = "`torque` of the FMU counts in `N.mm`, which cannot be turned into N; connect what it is a measure of";
    assert_eq!(mistakes(&model, &variables), [input("torque", what)]);
}
