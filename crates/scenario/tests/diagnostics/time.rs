//! Endless runs, actions without effect, and lack of time.
use crate::{AXIS, after, mistakes, warnings};

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
    let said = ["47:12: no tick is between its start and its end: ticks are 0.0000625 s apart"];
    assert_eq!(during("duration = \"10 us\"\nstart = \"1.00001 s\""), said);
    assert_eq!(during("duration = \"62.5 us\"\nstart = \"0.1 s\""), [""; 0]);
    let ends = AXIS
        .replace("base_rate = \"16 kHz\"", "base_rate = \"16 kHz\"\nduration = \"2 s\"")
        .replace("force = \"100 N\"", "force = \"100 N\"\nstart = \"2 s\"");
    assert_eq!(mistakes(&ends), ["48:9: the run is over by then: it lasts 2 s"]);
}

/// An axis whose motor follows the set-point exactly.
fn prescribed(load: &str) -> String {
    format!("[run]\nbase_rate = \"4 kHz\"\n[axis]\nmotion = \"linear\"\n[motor]\nkind = \"prescribed\"\n{load}\n")
}

#[test]
fn what_cannot_move_by_itself_cannot_be_disturbed() {
    let (rigid, elastic) = ("[axis.load]\nmass = \"1 kg\"", "[axis.load]\nmass = \"1 kg\"\nstiffness = \"1 N/um\"");
    let help = "give `stiffness` in `[axis.load]`, or a motor that is not prescribed";
    let pushed = |load: &str, on: &str| {
        mistakes(&prescribed(&format!("{load}\n[[disturbance]]\nforce = \"1 N\"\non = \"{on}\"")))
    };
    let motor = "the motor follows the set-point exactly and takes no disturbance";
    let load =
        format!("the load is rigid with a motor that follows the set-point exactly and takes no disturbance; {help}");
    assert_eq!(pushed(elastic, "motor"), [format!("12:6: {motor}")]);
    assert_eq!(pushed(rigid, "motor"), [format!("11:6: {motor}")]);
    assert_eq!(pushed(rigid, "load"), [format!("11:6: {load}")]);
    assert_eq!(pushed(elastic, "load"), [""; 0]);

    let stopped = |load: &str| {
        mistakes(&prescribed(&format!("{load}\n[axis.end_stops]\npositive = \"1 mm\"\nstiffness = \"1 N/um\"")))
    };
    let through = "the load is rigid with a motor that follows the set-point exactly, through any end stop";
    assert_eq!(stopped(rigid), [format!("9:1: {through}; {help}")]);
    assert_eq!(stopped(elastic), [""; 0]);

    let starts = |load: &str| {
        mistakes(&prescribed(&format!("{load}\n[initial]\nload_position = \"1 mm\"\nload_velocity = \"1 mm/s\"")))
    };
    let said = format!("the load is rigid with a motor that follows the set-point exactly, from zero; {help}");
    assert_eq!(starts(rigid), [format!("10:17: {said}"), format!("11:17: {said}")]);
    assert_eq!(starts(elastic), [""; 0]);
}

/// Oracle: 250 mm at 0.5 m/s and 6 m/s² take 0.5 s + 0.5/6 s = 0.5833 s in second order, and no less with a limit of jerk;
/// 10 mm back never reach 0.5 m/s and take 2·√(0.01/6) s = 81.6 ms.
#[test]
fn a_run_that_ends_within_its_program_is_doubtful() {
    let run = |duration: &str, steps: &str| {
        let text =
            AXIS.replace("base_rate = \"16 kHz\"", &format!("base_rate = \"16 kHz\"\nduration = \"{duration}\""));
        warnings(&text.replace("move_to = \"250 mm\"", steps))
    };
    let said = |ends: &str, least: &str| {
        format!(
            "5:12: the run ends after {ends} s, within its program, which takes {least} s at least; moves are judged as far \
             as they are recorded"
        )
    };
    assert_eq!(run("300 ms", "move_to = \"250 mm\""), [said("0.3", "0.5833")]);
    assert_eq!(run("583.4 ms", "move_to = \"250 mm\""), [""; 0]);
    let back = "move_to = \"250 mm\"\n[[program]]\nmove_to = \"240 mm\"";
    assert_eq!(run("660 ms", back), [said("0.66", "0.6650")]);
    let slow = "move_to = \"250 mm\"\nduration = \"1 s\"\n[[program]]\nwait = \"1.1 s\"";
    assert_eq!(run("2 s", slow), [said("2", "2.1000")]);
}

#[test]
fn what_is_measured_after_the_end_is_refused() {
    let late = AXIS
        .replace("base_rate = \"16 kHz\"", "base_rate = \"16 kHz\"\nduration = \"2 s\"")
        .replace("[measure]", "[measure]\nfrom = \"100 s\"");
    assert_eq!(mistakes(&late), ["49:8: the run is over by then: it lasts 2 s"]);
    assert_eq!(mistakes(&late.replace("100 s", "1.9 s")), [""; 0]);
}

/// Sampled at twice its frequency from its start a sine is zero at every tick.
#[test]
fn a_sine_that_the_ticks_cannot_show_is_refused() {
    let of = |frequency: &str| after("force = \"100 N\"", &format!("force = \"100 N\"\nfrequency = \"{frequency}\""));
    let said = "needs more than two ticks per period: less than 8000 Hz; lower it or raise `run.base_rate`";
    assert_eq!(of("16 kHz"), [format!("47:13: a sine of 16000 Hz {said}")]);
    assert_eq!(of("8 kHz"), [format!("47:13: a sine of 8000 Hz {said}")]);
    assert_eq!(of("7.9 kHz"), [""; 0]);
}

#[test]
fn end_stops_are_around_where_the_load_begins() {
    let with = |keys: &str, rest: &str| {
        let stops = format!("[axis.end_stops]\n{keys}\n{rest}[motor]\nkind = \"pmsm\"");
        after("[motor]\nkind = \"pmsm\"", &stops)
    };
    let stiff = "stiffness = \"10 N/um\"";
    assert_eq!(
        with(&format!("negative = \"-1 mm\"\npositive = \"1 mm\"\n{stiff}\ndamping = \"3 kN s/m\""), ""),
        [""; 0]
    );
    for (keys, rest, expected) in [
        ("positive = \"1 mm\"", "", "15:1: missing `stiffness` in `axis.end_stops`"),
        (stiff, "", "15:1: the table has no end stop; give `negative`, `positive` or both"),
        (
            &format!("{stiff}\nnegative = \"-1 mm\"\npositive = \"-1 mm\""),
            "[initial]\nload_position = \"-1 mm\"\n",
            "18:12: the positive end is not above the negative one; swap them",
        ),
        (
            &format!("{stiff}\nnegative = \"1 mm\""),
            "",
            "17:12: the load begins in the end stop; it begins at 0, or at `load_position` of `[initial]`",
        ),
        (
            &format!("{stiff}\npositive = \"1 mm\""),
            "[initial]\nload_position = \"2 mm\"\n",
            "19:17: the load begins in the end stop; it begins at 0, or at `load_position` of `[initial]`",
        ),
        ("positive = \"1 mm\"\nstiffness = \"-1 N/um\"", "", "17:13: `stiffness` must be above zero, got \"-1 N/um\""),
    ] {
        assert_eq!(with(keys, rest), [expected]);
    }
    let turning = after(
        "lead = \"10 mm\"\n",
        &format!("lead = \"10 mm\"\nmodulo = \"100 mm\"\nend_stops = {{ positive = \"1 mm\", {stiff} }}\n"),
    );
    assert_eq!(turning[0], "8:10: a modulo axis has no end stops; leave out `modulo` or `[axis.end_stops]`");
}
