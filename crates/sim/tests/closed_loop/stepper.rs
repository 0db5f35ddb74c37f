//! The loop stepped from outside is the loop that runs, bit for bit.
use crate::rig::{SCREW, bench, lasting, run, scenario};
use servobench_base::Setpoint;
use servobench_base::state::{Reader, words};
use servobench_sim::{External, Program, Stepper};
use servobench_trace::Recording;

pub(crate) const MOVE: &str = "[[program]]\nmove_to = \"50 mm\"\n";
pub(crate) const BUS: &str = "[bus]\ncycle = \"1 ms\"\nvelocity_offset = true\n";
/// A program of function blocks, in place of a move.
pub(crate) const BLOCKS: &str = "[plc]\nhoming_required = false\n[[call]]\nblock = \"MC_Power\"\nname = \"power\"\n\
                      [[call]]\nblock = \"MC_MoveAbsolute\"\nname = \"move\"\nstart = \"power.Status\"\nposition = \"50 mm\"\n";

/// The axis for 0.3 s; a program is to be given.
pub(crate) fn axis() -> String {
    lasting(SCREW, "0.3 s")
}

fn bits(values: &[f64]) -> Vec<u64> {
    values.iter().map(|value| value.to_bits()).collect()
}

/// The values from tick to tick, the present one first.
fn stepped(stepper: &mut Stepper, ticks: usize, external: impl Fn(u64) -> External) -> Vec<Vec<u64>> {
    let mut rows = vec![bits(stepper.values())];
    for _ in 0..ticks {
        stepper.step(&external(stepper.tick().0)).unwrap_or_else(|failure| panic!("{failure}"));
        rows.push(bits(stepper.values()));
    }
    rows
}

/// Whether a channel is of the bodies, and so of the present tick; shares of ticks are of a row.
fn is_body(name: &str) -> bool {
    ["motor.position", "motor.velocity", "load.position", "load.velocity"].contains(&name)
}

/// Compares with a recording of a run, from `shift` ticks on.
fn assert_same(rows: &[Vec<u64>], recording: &Recording, shift: usize, what: &str) {
    for (c, channel) in recording.channels.iter().enumerate() {
        let name = channel.spec.name.as_str();
        if name.starts_with("saturation") {
            continue;
        }
        let late = usize::from(!is_body(name));
        for k in 1..rows.len() - shift {
            let (found, expected) = (rows[k + shift][c], channel.values[k - late].to_bits());
            assert_eq!(found, expected, "{what}: {name} at tick {k}");
        }
    }
}

#[test]
fn a_stepped_loop_is_a_run_to_the_bit() {
    let axis = axis();
    for (what, text) in [
        ("direct", format!("{axis}{MOVE}")),
        ("over a bus", format!("{axis}{BUS}{MOVE}")),
        ("by function blocks", format!("{axis}{BUS}{BLOCKS}")),
    ] {
        let recording = run(&text);
        let mut stepper = bench(&text).into_stepper();
        let ticks = recording.channels[0].values.len() - 1;
        let rows = stepped(&mut stepper, ticks, |_| External::default());
        assert_same(&rows, &recording, 0, what);
        let moved = recording.channel("load.position").and_then(<[f64]>::last).copied().unwrap_or_default();
        assert!(moved > 0.045, "{what}: {moved}");
    }
}

#[test]
fn it_goes_back_to_where_it_was_as_often_as_asked() {
    let axis = axis();
    for (what, text) in [("direct", format!("{axis}{MOVE}")), ("by function blocks", format!("{axis}{BUS}{BLOCKS}"))] {
        let mut stepper = bench(&text).into_stepper();
        stepped(&mut stepper, 1_500, |_| External::default());
        let mut saved = Vec::new();
        stepper.save(&mut words(|word| saved.push(word))).unwrap();
        let states = stepper.states();
        let pushed = |_| External { load_effort: 30.0, ..External::default() };
        let disturbed = stepped(&mut stepper, 800, pushed);
        let mut other = bench(&text).into_stepper();
        for stepper in [&mut stepper, &mut other] {
            let mut from = Reader::new(&saved);
            stepper.restore(&mut from).unwrap();
            from.end().unwrap();
            assert_eq!((stepper.tick().0, stepper.states()), (1_500, states), "{what}");
            assert_eq!(stepped(stepper, 800, pushed), disturbed, "{what}");
        }
    }
}

/// Over a bus a start within a cycle waits for the next one.
#[test]
fn a_program_that_starts_later_is_the_same_later() {
    let axis = axis();
    let shift = 160;
    let start = |k| External { start: k >= shift as u64, ..External::default() };
    let text = format!("{axis}{MOVE}");
    let rows = stepped(&mut bench(&text).into_stepper(), 3_000, start);
    assert_same(&rows, &run(&text), shift, "later");
}

/// Oracle: the same effort as a disturbance of the scenario.
#[test]
fn efforts_from_outside_are_disturbances() {
    let axis = axis();
    let push = "[[disturbance]]\non = \"load\"\nstart = \"50 ms\"\nduration = \"100 ms\"\nforce = \"40 N\"\n\
                [[disturbance]]\non = \"motor\"\nstart = \"50 ms\"\nduration = \"100 ms\"\ntorque = \"0.3 Nm\"\n";
    let recording = run(&format!("{axis}{MOVE}{push}"));
    let mut stepper = bench(&format!("{axis}{MOVE}")).into_stepper();
    let push = |k| match k {
        800..2400 => External { motor_effort: 0.3, load_effort: 40.0, ..External::default() },
        _ => External::default(),
    };
    let rows = stepped(&mut stepper, 4_800, push);
    for (c, spec) in stepper.channels().iter().enumerate().filter(|(_, spec)| is_body(&spec.name)) {
        let expected = recording.channel(&spec.name).unwrap_or_default();
        assert!(rows.iter().zip(expected).all(|(row, value)| row[c] == value.to_bits()), "{}", spec.name);
    }
}

/// Oracle: the program, whose set-points are given from outside.
#[test]
fn set_points_from_outside_are_followed_like_those_of_the_program() {
    let axis = axis();
    let text = format!("{axis}{MOVE}");
    let mut program = Program::new(&scenario(&text)).unwrap_or_else(|error| panic!("{error}"));
    let setpoints: Vec<_> = (0..4_800_u32).map(|k| program.at(f64::from(k) / 16e3)).collect();
    let mut stepper = bench(&axis).into_stepper();
    let at = |k: u64| usize::try_from(k).map_or(Setpoint::default(), |k| setpoints[k]);
    let given = |k| External { setpoint: Some(at(k)), ..External::default() };
    let rows = stepped(&mut stepper, 4_800, given);
    assert_same(&rows, &run(&text), 0, "from outside");
    // Over a bus too: the motion task sends them.
    let mut stepper = bench(&format!("{axis}{BUS}")).into_stepper();
    let waits = |k: u64| at(k.saturating_sub(240));
    stepped(&mut stepper, 4_800, |k| External { setpoint: Some(waits(k)), ..External::default() });
    let there = stepper.channels().iter().position(|spec| spec.name == "setpoint.position").unwrap_or_default();
    let end = stepper.values()[there];
    // The link counts in increments of the encoder: 10 mm in 2²⁰.
    assert!((end - 0.05).abs() < 0.01 / 1_048_576.0, "{end}");
}
