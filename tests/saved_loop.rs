//! Every ready scenario saved at a tick, on every engine that simulates it: what is restored goes on with the same bits, and a saved state is
//! small whatever the length of the run.
use servobench_base::state::{Reader, words};
use servobench_plant::Engine;
use servobench_scenario::{AxisMechanics, Scenario, load};
use servobench_sim::{Bench, External, Stepper};
use servobench_tests::{engines, faults, ready_scenarios};
use std::path::Path;

/// Ticks after which the state is saved, unless the environment gives another number: `SERVOBENCH_TICKS=1000000`.
const TICKS: u32 = 1_000;
/// Ticks that are run twice from there.
const AGAIN: u32 = 700;
/// Most bytes of a state.
const MOST: usize = 1 << 16;

fn stepper(scenario: &Scenario, engine: &dyn Engine) -> Result<Stepper, String> {
    Ok(Bench::new(scenario, engine).map_err(|error| error.to_string())?.into_stepper())
}

/// Steps as far as the run goes, and shows every channel after each tick.
fn run(stepper: &mut Stepper, ticks: u32, mut see: impl FnMut(&[f64])) {
    for _ in 0..ticks {
        if stepper.step(&External::default()).is_err() {
            break;
        }
        see(stepper.values());
    }
}

/// The bits of every channel in the ticks that are run twice.
fn run_again(stepper: &mut Stepper) -> Vec<u64> {
    let mut all = Vec::new();
    run(stepper, AGAIN, |values| all.extend(values.iter().map(|value| value.to_bits())));
    all
}

fn saved(stepper: &mut Stepper) -> Result<Vec<u64>, String> {
    let mut state = Vec::new();
    stepper.save(&mut words(|word| state.push(word))).map_err(|error| error.to_string())?;
    Ok(state)
}

fn restore(stepper: &mut Stepper, state: &[u64]) -> Result<(), String> {
    let mut from = Reader::new(state);
    stepper.restore(&mut from).map_err(|error| error.to_string())?;
    from.end().map_err(|error| error.to_string())
}

/// Saves at `ticks` ticks and at a tick that no task of the loop begins at, and goes on from there twice, and in a fresh loop.
fn compare(scenario: &Scenario, engine: &dyn Engine, ticks: u32) -> Result<(), String> {
    let mut one = stepper(scenario, engine)?;
    for ticks in [ticks, 337] {
        run(&mut one, ticks, |_| ());
        let state = saved(&mut one)?;
        let expected = run_again(&mut one);
        let mut fresh = stepper(scenario, engine)?;
        for (what, other) in [("the same loop", &mut one), ("a fresh loop", &mut fresh)] {
            restore(other, &state).map_err(|error| format!("{what}: {error}"))?;
            if saved(other)? != state {
                return Err(format!("{what} is saved as another state than was restored"));
            }
            if run_again(other) != expected {
                return Err(format!("{what} goes on differently"));
            }
        }
        if 8 * state.len() > MOST {
            return Err(format!("a state has {} bytes, more than {MOST}", 8 * state.len()));
        }
        if restore(&mut one, &state[..state.len() - 1]).is_ok() {
            return Err("a state without its end is restored".into());
        }
        restore(&mut one, &state)?;
    }
    Ok(())
}

fn compare_file(path: &Path) -> Option<String> {
    let ticks = std::env::var("SERVOBENCH_TICKS").map_or(TICKS, |ticks| ticks.parse().unwrap());
    let scenario = load(path).unwrap().scenario;
    let mut all = engines();
    // Every engine for a chain, those of the file for a model of its own.
    let is_chain = matches!(scenario.axis.mechanics, AxisMechanics::Bodies(_));
    all.retain(|engine| is_chain || scenario.engines.contains(&engine.name()));
    let wrong = |engine: &&dyn Engine| {
        let found = compare(&scenario, *engine, ticks).err();
        found.map(|found| format!("{} on {}: {found}", path.display(), engine.name()))
    };
    all.iter().find_map(wrong)
}

#[test]
fn every_scenario_goes_on_from_a_saved_state_with_the_same_bits() {
    let found = faults(&ready_scenarios(), |path| compare_file(path));
    assert!(found.is_empty(), "{}", found.join("\n"));
}
