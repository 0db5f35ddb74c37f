//! Plans the requests on standard input, one a line, and prints each plan on a line: a way for programs in other languages to
//! request many plans at once.
//!
//! ```text
//! profile ORDER published|optimal  DISTANCE  VELOCITY ACCELERATION JERK SNAP
//! transition ORDER fast|refined  X V A J  TARGET_X TARGET_V  V_BELOW V_ABOVE  A_BELOW A_ABOVE  JERK SNAP
//! ```
//!
//! Numbers are SI, `inf` means unlimited. The answer is the duration, and for each segment its highest derivative and its
//! length, every number to the last bit. A request that cannot be read or planned ends the program.
use servobench_base::Setpoint;
use servobench_motion::online::{DirectionalLimits, Effort, Sides, Target, Transition};
use servobench_motion::{Limits, Order, Profile, Segment};
use std::error::Error;
use std::fmt::Write as _;
use std::io::{self, BufWriter, Write as _};

fn main() -> Result<(), Box<dyn Error>> {
    let mut out = BufWriter::new(io::stdout().lock());
    for (number, line) in io::stdin().lines().enumerate() {
        let line = line?;
        let answer = answer(&line).map_err(|error| format!("line {}, `{line}`: {error}", number + 1))?;
        writeln!(out, "{answer}")?;
    }
    Ok(out.flush()?)
}

fn answer(line: &str) -> Result<String, Box<dyn Error>> {
    let words: Vec<&str> = line.split_whitespace().collect();
    let [planner, order, method, numbers @ ..] = words.as_slice() else {
        return Err("a request is a planner, an order, a method and numbers".into());
    };
    let order = Order::from_derivative(order.parse()?).ok_or("the order is 2, 3 or 4")?;
    let numbers = numbers.iter().map(|word| word.parse()).collect::<Result<Vec<f64>, _>>()?;
    match (*planner, numbers.as_slice()) {
        ("profile", &[distance, velocity, acceleration, jerk, snap]) => {
            let limits = Limits { velocity, acceleration, jerk, snap };
            let plan = match *method {
                "published" => Profile::plan(order, distance, &limits)?,
                "optimal" => Profile::plan_optimal(order, distance, &limits)?,
                _ => return Err("a profile is `published` or `optimal`".into()),
            };
            written(plan.duration(), plan.segments())
        }
        ("transition", &[x, v, a, j, to_x, to_v, v_below, v_above, a_below, a_above, jerk, snap]) => {
            let from = Setpoint { x, v, a, j, s: 0.0 };
            let target = Target::Position { x: to_x, v: to_v };
            let limits = DirectionalLimits {
                velocity: Sides { below: v_below, above: v_above },
                acceleration: Sides { below: a_below, above: a_above },
                jerk,
                snap,
            };
            let effort = match *method {
                "fast" => Effort::Fast,
                "refined" => Effort::Refined,
                _ => return Err("a transition is `fast` or `refined`".into()),
            };
            let plan = Transition::plan(order, &from, &target, &limits, effort)?;
            written(plan.duration(), plan.segments())
        }
        _ => Err("`profile` takes 5 numbers, `transition` 12".into()),
    }
}

fn written(duration: f64, segments: impl Iterator<Item = Segment>) -> Result<String, Box<dyn Error>> {
    let mut line = format!("{duration:e}");
    for Segment { value, length, .. } in segments {
        write!(line, " {value:e} {length:e}")?;
    }
    Ok(line)
}
