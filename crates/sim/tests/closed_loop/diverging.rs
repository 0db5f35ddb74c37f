//! A run that leaves every machine ends as diverged, whatever motor and inverter make of speeds that nothing has.
use crate::rig::bench;
use crate::stepper::{BLOCKS, BUS, MOVE, axis};
use servobench_plant::MechanicsError;
use servobench_sim::{External, Failure, Reason};

/// Effects that make a winding vary, or its voltage.
const REAL: [&str; 6] = [
    "",
    "[motor.thermal]\nambient = \"40 degC\"\nto_housing = \"3.8 K/W\"\nto_ambient = \"1.9 K/W\"\n\
     winding_capacity = \"0.9 J/K\"\nhousing_capacity = \"18 J/K\"\n",
    "[motor.saturation]\ncurrent = \"13.3 Arms\"\nshare = 0.891\n",
    "[drive.inverter]\ncarrier = \"16 kHz\"\ndead_time = \"2 us\"\n",
    "[drive.inverter]\nmodulation = \"switching\"\ncarrier = \"16 kHz\"\n",
    "[drive.link]\ncapacitance = \"470 uF\"\nsource_resistance = \"0.7 Ohm\"\n",
];

/// Where a load ends that is pushed by `damping` (N·s/m) times its velocity.
fn pushed(text: &str, damping: f64) -> (Failure, f64) {
    let mut stepper = bench(text).into_stepper();
    let name = "load.velocity";
    let at = stepper.channels().iter().position(|channel| channel.name.as_str() == name).unwrap();
    loop {
        let velocity = stepper.values()[at];
        let external = External { load_effort: damping * velocity + 1.0, ..External::default() };
        if let Err(failure) = stepper.step(&external) {
            return (failure, velocity);
        }
        assert!(stepper.tick().0 < 16_000, "{text}");
    }
}

/// Negative damping that multiplies the speed by 1.1 and by 1e30 in a tick: no speed comes to the drive that no machine has.
#[test]
fn a_load_that_runs_away_ends_the_run_as_diverged() {
    let axis = axis();
    for real in REAL {
        for program in [MOVE.to_owned(), format!("{BUS}{MOVE}"), format!("{BUS}{BLOCKS}")] {
            for damping in [1e6, 1e36] {
                let text = format!("{axis}{real}{program}");
                let (failure, velocity) = pushed(&text, damping);
                println!("{real:?} {damping:e}: {failure}, {velocity:e} m/s");
                assert!(matches!(failure.reason, Reason::Mechanics(MechanicsError::Diverged { .. })), "{failure}");
                assert!(velocity.abs() < 1e10, "{velocity} in {text}");
            }
        }
    }
}
