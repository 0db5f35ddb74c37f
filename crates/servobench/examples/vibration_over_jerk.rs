//! Residual vibration over the jerk limit, on the axis of the demo: `cargo run --release -p servobench --example vibration_over_jerk`.
use servobench::{Error, Metric, Scenario};

fn main() -> Result<(), Error> {
    let demo = Scenario::demo()?.swap_remove(0);
    println!("jerk (m/s³)  move (ms)  vibration p-p (µm)");
    for step in 0..10 {
        let jerk = 20.0 + 10.0 * f64::from(step);
        let run = demo.with([("setpoint.jerk", (jerk, "m/s3").into())])?.run()?;
        let [time, vibration] = [(Metric::MoveTime, 1e3), (Metric::ResidualVibrationPp, 1e6)]
            .map(|(metric, scale)| run.metric(metric).map_or(f64::NAN, |value| scale * value));
        println!("{jerk:11.0}  {time:9.1}  {vibration:18.1}");
    }
    Ok(())
}
