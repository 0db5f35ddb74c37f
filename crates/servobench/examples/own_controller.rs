//! A controller outside of the bench, tick by tick, in place of the drive: `cargo run --release -p servobench --example own_controller`.
use servobench::{Bench, Controller, Error, External, Metric, Scenario};

/// Stiffness (N·m/rad) and damping (N·m·s/rad) of the controller at the motor.
const GAINS: [f64; 2] = [60.0, 0.6];

fn main() -> Result<(), Error> {
    for scenario in Scenario::demo()? {
        // Metres per radian of the motor.
        let lead = scenario.resolved().axis.transmission;
        let mut bench = Bench::new(&scenario)?;
        while bench.is_under_way() {
            let (wanted, motor) = (bench.setpoint(), bench.motor());
            let error = [wanted.x / lead - motor.position, wanted.v / lead - motor.velocity];
            let torque = GAINS[0] * error[0] + GAINS[1] * error[1];
            bench.step(&External { controller: Some(Controller::Effort(torque)), ..External::default() })?;
        }
        let run = bench.finish()?;
        let error = run.metric(Metric::FollowingErrorPeakLoad).map_or(f64::NAN, |error| 1e6 * error);
        println!("{}: passed {}, peak following error {error:.0} µm", scenario.name(), run.passed());
        for reason in run.verdict.reasons() {
            println!("  {reason}");
        }
    }
    Ok(())
}
