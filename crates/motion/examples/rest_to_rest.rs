//! A move of 1 m under a snap limit, and what jerk it reaches: `cargo run --example rest_to_rest`.
use servobench_motion::{Limits, Order, PlanError, Profile};

fn main() -> Result<(), PlanError> {
    let limits = Limits { velocity: 1.0, acceleration: 5.0, jerk: 50.0, snap: 1000.0 };
    for (name, plan) in [
        ("published", Profile::plan(Order::Fourth, 1.0, &limits)?),
        ("shortest", Profile::plan_optimal(Order::Fourth, 1.0, &limits)?),
    ] {
        println!("{name}: {:.1} ms", 1e3 * plan.duration());
    }
    let plan = Profile::plan(Order::Fourth, 1.0, &limits)?;
    println!("time (s)  position (m)  velocity (m/s)  acceleration (m/s²)");
    for step in 0..=10 {
        let time = plan.duration() * f64::from(step) / 10.0;
        let point = plan.at(time);
        println!("{time:8.3}  {:12.4}  {:14.4}  {:19.4}", point.x, point.v, point.a);
    }
    Ok(())
}
