//! Every ready scenario at 1, 2 and 4 times its base rate: the same verdict, and with ideal sensors the same motion, nearer by the order that
//! docs/loop.md says.
use servobench::run::judge;
use servobench_base::Rate;
use servobench_plant::Engine;
use servobench_scenario::{Actuator, Document, Feedback, Override, Scenario, load};
use servobench_sim::{Bench, Outcome};
use servobench_tests::{engines, faults, ready_scenarios};
use std::path::Path;

/// Base rates, as multiples of that of the file.
const TIMES: [u32; 3] = [1, 2, 4];
/// Keys of what begins or ends within a tick, and is seen at its end.
const OF_TICKS: [&str; 6] = ["coulomb", "end_stops.", "bus.", "connection.", "inverter.", "link."];
/// Random numbers that give a time in ticks: another fault at another base rate.
const RANDOM: &str = "jitter";

/// Ratio of the two differences of an error of order 1 or 2, less a quarter of it for terms of higher order; and the part of the way below
/// which the instants of events, or the rounding of a long run, are all that is left.
struct Order {
    ratio: f64,
    least: f64,
}

const FIRST: Order = Order { ratio: 1.5, least: 1e-6 };
const SECOND: Order = Order { ratio: 3.0, least: 1e-9 };

/// The scenario with sensors without any error.
fn ideal(mut scenario: Scenario) -> Scenario {
    if let Actuator::Pmsm { encoder, drive, .. } | Actuator::IdealSource { encoder, drive, .. } = &mut scenario.actuator
    {
        (encoder.increment, encoder.errors, drive.current_sensor) = (None, None, None);
        if let Feedback::Load(encoder) = &mut drive.position_feedback {
            (encoder.increment, encoder.errors) = (None, None);
        }
    }
    scenario
}

fn at_times(path: &Path, rate: Rate, times: u32) -> Result<Scenario, String> {
    let text = format!("run.base_rate=\"{} Hz\"", rate.hertz() * times);
    let overrides: [Override; 1] = [text.parse().map_err(|error| format!("{error}"))?];
    Document::open(path, None)
        .and_then(|document| document.scenario(&overrides))
        .map(|loaded| loaded.scenario)
        .map_err(|error| error.to_string())
}

fn outcome(scenario: &Scenario, engine: &dyn Engine) -> Result<Outcome, String> {
    let bench = Bench::new(scenario, engine).map_err(|error| error.to_string())?;
    Ok(bench.run(&mut |_| {}))
}

/// Largest difference of two ways.
fn apart(one: &[f64], other: &[f64]) -> f64 {
    one.iter().zip(other).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max)
}

fn compare(path: &Path) -> Result<(), String> {
    let scenario = load(path).map_err(|error| error.to_string())?.scenario;
    let all = engines();
    let Some(engine) = all.iter().find(|engine| scenario.engines.contains(&engine.name())) else { return Ok(()) };
    let (mut ways, mut verdicts) = (Vec::new(), Vec::new());
    for times in TIMES {
        let faster = at_times(path, scenario.base_rate, times)?;
        let Outcome { mut recording, failure } = outcome(&faster, *engine)?;
        let verdict = judge(&mut recording, failure, &faster).map_err(|error| error.to_string())?;
        verdicts.push((verdict.passed(), verdict.reasons().collect::<Vec<_>>().join("; ")));
        let Outcome { recording, failure } = outcome(&ideal(faster), *engine)?;
        let way = recording.channel("load.position").ok_or("no position of the load")?;
        if let Some(failure) = failure {
            return Err(format!("with ideal sensors at {times} times the rate: {failure}"));
        }
        if let Some(row) = way.iter().position(|x| !x.is_finite()) {
            return Err(format!("not finite in row {row} at {times} times the rate"));
        }
        ways.push(way.iter().copied().step_by(times as usize).collect::<Vec<f64>>());
    }
    // The last row of a run whose length is not a whole number of ticks is nearer to its end.
    if ways.iter().any(|way| way.len().abs_diff(ways[0].len()) > 1) {
        return Err("runs of different lengths".into());
    }
    if verdicts.iter().any(|(passed, _)| *passed != verdicts[0].0) {
        return Err(format!("verdicts {verdicts:?}"));
    }
    let says = |what: &str| scenario.parameters.iter().any(|one| one.key.contains(what) || one.value.contains(what));
    if says(RANDOM) {
        return Ok(());
    }
    let order = if OF_TICKS.iter().any(|key| says(key)) { FIRST } else { SECOND };
    let span = ways[0].iter().fold(0.0_f64, |most, x| most.max(x.abs()));
    let [first, second] = [apart(&ways[0], &ways[1]), apart(&ways[1], &ways[2])];
    if second <= order.least * span || second * order.ratio <= first {
        return Ok(());
    }
    let least = order.least;
    Err(format!(
        "differences {:.3e} and {:.3e} of the way, ratio {} or below {least}",
        first / span,
        second / span,
        order.ratio
    ))
}

#[test]
fn every_ready_scenario_at_more_ticks_moves_the_same() {
    let paths = ready_scenarios();
    let wrong = faults(&paths, |path| compare(path).err().map(|fault| format!("{}: {fault}", path.display())));
    assert!(wrong.is_empty(), "{wrong:#?}");
}
