//! What would never end, and what would never act.
use crate::{AXIS, after, mistakes};

/// Beyond 2⁶⁴ ticks a counter would start again: such a run once passed with no tick at all.
#[test]
fn what_never_ends_is_refused_where_it_is_written() {
    let run = after("base_rate = \"16 kHz\"", "base_rate = \"16 kHz\"\nduration = \"1e16 s\"");
    assert_eq!(run, ["5:12: a run lasts 1000000 s at most, got 10000000000000000 s"]);
    let said = "a run lasts 1000000 s at most";
    for (steps, place) in [
        ("move_to = \"250 mm\"\n[[program]]\nwait = \"1e16 s\"", "45:8: the program would last 10000000000000000 s"),
        ("move_to = \"250 mm\"\nduration = \"2e6 s\"", "44:12: the program would last 2000000 s"),
        (
            "wait = \"6e5 s\"\n[[program]]\nwait = \"7e5 s\"\n[[program]]\nwait = \"1e9 s\"",
            "45:8: the program would last 1300000 s",
        ),
    ] {
        assert_eq!(after("move_to = \"250 mm\"", steps), [format!("{place} at least, {said}")]);
    }
    let long = "base_rate = \"16 kHz\"\nduration = \"1e6 s\"";
    assert_eq!(after("base_rate = \"16 kHz\"", long), [""; 0], "11 days are a run");
}

#[test]
fn a_disturbance_that_acts_on_no_tick_is_refused() {
    let during = |keys: &str| after("force = \"100 N\"", &format!("force = \"100 N\"\n{keys}"));
    let said = ["47:12: there is no tick between its start and its end, ticks are 0.0000625 s apart"];
    assert_eq!(during("duration = \"10 us\"\nstart = \"1.00001 s\""), said);
    assert_eq!(during("duration = \"62.5 us\"\nstart = \"0.1 s\""), [""; 0]);
    let ends = AXIS
        .replace("base_rate = \"16 kHz\"", "base_rate = \"16 kHz\"\nduration = \"2 s\"")
        .replace("force = \"100 N\"", "force = \"100 N\"\nstart = \"2 s\"");
    assert_eq!(mistakes(&ends), ["48:9: the run is over by then: it lasts 2 s"]);
}

/// An axis whose motor follows the set-point whatever acts on it.
fn prescribed(load: &str) -> String {
    format!("[run]\nbase_rate = \"4 kHz\"\n[axis]\nmotion = \"linear\"\n[motor]\nkind = \"prescribed\"\n{load}\n")
}

#[test]
fn what_cannot_move_by_itself_cannot_be_disturbed() {
    let (rigid, elastic) = ("[axis.load]\nmass = \"1 kg\"", "[axis.load]\nmass = \"1 kg\"\nstiffness = \"1 N/um\"");
    let way_out = "give `stiffness` in `[axis.load]`, or a motor that is not prescribed";
    let pushed = |load: &str, on: &str| {
        mistakes(&prescribed(&format!("{load}\n[[disturbance]]\nforce = \"1 N\"\non = \"{on}\"")))
    };
    let motor = "the motor follows the set-point exactly and feels no disturbance";
    let load = format!(
        "the load is rigid with a motor that follows the set-point exactly and feels no disturbance; {way_out}"
    );
    assert_eq!(pushed(elastic, "motor"), [format!("12:6: {motor}")]);
    assert_eq!(pushed(rigid, "motor"), [format!("11:6: {motor}")]);
    assert_eq!(pushed(rigid, "load"), [format!("11:6: {load}")]);
    assert_eq!(pushed(elastic, "load"), [""; 0]);

    let starts = |load: &str| {
        mistakes(&prescribed(&format!("{load}\n[initial]\nload_position = \"1 mm\"\nload_velocity = \"1 mm/s\"")))
    };
    let said = format!("the load is rigid with a motor that follows the set-point exactly, from zero; {way_out}");
    assert_eq!(starts(rigid), [format!("10:17: {said}"), format!("11:17: {said}")]);
    assert_eq!(starts(elastic), [""; 0]);
}
