//! Scenarios as files have them.
use crate::deviation::{Deviation, growth};
use servobench_scenario::{Scenario, parse};
use servobench_sim::{Analysis, NotAnalysed, Speeds, analyse_stability};
use servobench_stability::{Depth, LoopName, Report};

pub(crate) fn scenario(text: &str) -> Scenario {
    parse("stability", text, None).unwrap_or_else(|error| panic!("{error}")).scenario
}

pub(crate) fn report(scenario: &Scenario, depth: Depth) -> Report {
    let speeds = Speeds::planned(scenario).unwrap_or_else(|error| panic!("{error}"));
    match analyse_stability(scenario, depth, speeds.as_ref(), None).unwrap_or_else(|error| panic!("{error}")) {
        Analysis::Done { report, .. } => *report,
        Analysis::NotPossible(why) => panic!("{why}"),
    }
}

const ROTOR: &str = r#"
[run]
base_rate = "16 kHz"
[axis]
motion = "rotary"
[motor]
kind = "pmsm"
pole_pairs = 4
resistance = "1.615 Ohm"
inductance = "3.485 mH"
flux_linkage = "60.6 mV s"
inertia = "1e-3 kg m2"
max_current = "10 Apk"
[drive]
dc_link = "320 V"
[drive.current]
rate = "16 kHz"
bandwidth = "1.2 kHz"
[drive.velocity]
rate = "8 kHz"
integral_time = "10 ms"
gain = "GAIN"
[drive.position]
rate = "4 kHz"
gain = "30 1/s"
[initial]
load_velocity = "1e-9 rad/s"
"#;

/// Oracle: the run itself, also where it fades: the largest pole is what is left after a while.
#[test]
fn a_deviation_grows_or_fades_as_the_largest_pole_says() {
    for (gain, is_stable) in
        [("9 Nm s/rad", false), ("7.26 Nm s/rad", false), ("7.2 Nm s/rad", true), ("0.3 Nm s/rad", true)]
    {
        let scenario = scenario(&ROTOR.replace("GAIN", gain));
        let report = report(&scenario, Depth::Boundaries);
        assert_eq!(report.is_stable(), is_stable, "{gain}: {report:?}");
        if let Some(found) = &report.instability {
            let gain = gain.replace("Nm s", "N·m·s");
            let said = format!("the loop is unstable: velocity loop, gain {gain}: a pole of |λ| ");
            assert!(found.to_string().starts_with(&said), "{found}");
            assert_eq!(found.name, LoopName::Velocity);
            let boundary = found.boundaries.below.unwrap().gain;
            assert!((7.2..7.26).contains(&boundary), "{boundary}");
        }
        if gain != "9 Nm s/rad" {
            assert_follows_the_pole(&scenario, &report, 8);
        }
    }
}

/// Oracle: the run itself. An encoder whose increment is far below the deviation gives differences of positions, and they move
/// the boundary.
#[test]
fn differences_of_positions_are_what_the_run_has_too() {
    let stepped = ROTOR.replace("max_current", "encoder = { step = \"1e-15 rad\" }\nmax_current");
    let stepped = stepped.replace("1e-9 rad/s", "1e-5 rad/s");
    let at = |gain: f64| scenario(&stepped.replace("GAIN", &format!("{gain} Nm s/rad")));
    let boundary = report(&at(3.0), Depth::Boundaries).loops[1].boundaries.unwrap().above.unwrap().gain;
    assert!((4.0..6.8).contains(&boundary), "half a period of the velocity loop later than 7.23: {boundary}");
    for factor in [0.998, 1.002] {
        let scenario = at(factor * boundary);
        let report = report(&scenario, Depth::Verdict);
        assert_eq!(report.is_stable(), factor < 1.0);
        assert_follows_the_pole(&scenario, &report, 8);
    }
}

/// Oracle: the run itself. An encoder that is late by so many ticks and a half: up to a latency the axis is stable, and a tick further
/// its deviation grows.
#[test]
fn a_late_encoder_is_stable_to_the_tick_to_which_its_run_is() {
    let late = |encoder: &str, gain: f64, ticks: f64| {
        let encoder = format!("encoder = {{ {encoder}latency = \"{} us\" }}\nmax_current", ticks * 1e6 / 16e3);
        scenario(&ROTOR.replace("max_current", &encoder).replace("GAIN", &format!("{gain} Nm s/rad")))
    };
    for (encoder, gain) in [("", 0.6), ("", 1.3), ("commutation_offset = \"20 deg\", ", 0.9)] {
        let is_stable = |ticks: f64| report(&late(encoder, gain, ticks), Depth::Verdict).is_stable();
        let last = (0..160).map(|k| f64::from(k) + 0.5).take_while(|ticks| is_stable(*ticks)).last().unwrap();
        println!("{encoder}{gain}: stable to {last} ticks");
        assert!((4.0..100.0).contains(&last), "{last}");
        for ticks in [last, last + 1.0] {
            let growth = growth(&late(encoder, gain, ticks)).unwrap_or_else(|not_told| panic!("{not_told:?}"));
            assert_eq!(growth > 0.0, ticks > last, "{encoder}{gain}: {ticks} of {last}: {growth}");
        }
    }
}

fn assert_follows_the_pole(scenario: &Scenario, report: &Report, windows: u32) {
    let pole = report.largest.unwrap();
    let mut deviation = Deviation::new(scenario);
    for _ in 0..windows {
        deviation.window();
    }
    let growth = deviation.slope() / deviation.seconds();
    // The largest of a window is found up to half a tick off, of 12 in a swing: 1 − cos(π/12) = 3.4 % over the 0.375 s
    // between the first and the last of four windows.
    assert!((growth - pole.growth).abs() < 0.034 / 0.375, "{growth} {pole:?}");
}

/// Files of which a run shows that they are unstable (or not), and the loop by whose settings they are.
#[test]
fn files_are_judged_as_their_runs_are() {
    let file = |load: &str, encoder: &str, drive: &str, current: &str, velocity: &str, position: &str| {
        format!(
            r#"
[run]
base_rate = "16 kHz"
[axis]
motion = "rotary"
load = {{ inertia = "0.005 kg m2", stiffness = "{load}", damping = "0.01 Nm s/rad" }}
[motor]
kind = "pmsm"
pole_pairs = 4
resistance = "1.615 Ohm"
inductance = "3.485 mH"
flux_linkage = "60.6 mV s"
inertia = "0.005 kg m2"
max_current = "13 Arms"
{encoder}
[drive]
dc_link = "320 V"
{drive}
[drive.current]
rate = "16 kHz"
bandwidth = "{current}"
[drive.velocity]
rate = "8 kHz"
{velocity}
[drive.position]
rate = "4 kHz"
bandwidth = "{position}"
"#
        )
    };
    let on_load = "position_feedback = \"load\"\nload_encoder = { step = \"1e-5 rad\" }";
    let heavy = "estimate = { load_inertia = \"0.5 kg m2\" }";
    let (stiff, soft) = ("7e5 Nm/rad", "700 Nm/rad");
    let filtered = "bandwidth = \"100 Hz\"\nfilter_time = \"5 ms\"";
    for (what, text, unstable) in [
        ("U1", file(stiff, "", "", "40 Hz", "bandwidth = \"200 Hz\"", "10 Hz"), Some(LoopName::Velocity)),
        ("U2", file(stiff, "", "", "1.2 kHz", "bandwidth = \"60 Hz\"", "80 Hz"), Some(LoopName::Velocity)),
        ("U3", file(soft, "", on_load, "1.2 kHz", "bandwidth = \"60 Hz\"", "20 Hz"), None),
        ("U4", file(stiff, "", "", "1.2 kHz", filtered, "12 Hz"), Some(LoopName::Position)),
        ("U5", file(stiff, "", heavy, "1.2 kHz", "bandwidth = \"60 Hz\"", "12 Hz"), Some(LoopName::Velocity)),
        ("U6", file(soft, "", "", "1.2 kHz", "bandwidth = \"400 Hz\"", "12 Hz"), None),
        ("U7", file(stiff, "", "", "2.2 kHz", "bandwidth = \"60 Hz\"", "12 Hz"), Some(LoopName::Velocity)),
        ("U8", file(stiff, "", "", "3.5 kHz", "bandwidth = \"60 Hz\"", "12 Hz"), Some(LoopName::Current)),
    ] {
        let report = report(&scenario(&text), Depth::Verdict);
        println!("{what}: {}", report.instability.as_ref().map_or("stable".into(), ToString::to_string));
        for warning in &report.warnings {
            println!("    {warning}");
        }
        assert_eq!(report.instability.as_ref().map(|found| found.name), unstable, "{what}: {report:?}");
    }
}

#[test]
fn a_mass_beyond_its_boundary_is_unstable_whatever_limits_it() {
    for (gain, limit) in [("330000 N s/m", ""), ("400000 N s/m", ""), ("400000 N s/m", "limit = \"100 N\"")] {
        let text = format!(
            "[run]\nbase_rate = \"16 kHz\"\n[axis]\nmotion = \"linear\"\nmotor_side.mass = \"10 kg\"\n[motor]\nkind = \
             \"ideal-source\"\n{limit}\n[drive.velocity]\nrate = \"16 kHz\"\nkind = \"p\"\ngain = \"{gain}\"\n\
             [drive.position]\nrate = \"16 kHz\"\ngain = \"20 1/s\"\n"
        );
        let found = report(&scenario(&text), Depth::Verdict).instability.unwrap();
        assert_eq!(found.name, LoopName::Velocity);
        assert!((found.boundaries.below.unwrap().gain / 320e3 - 1.0).abs() < 1e-3, "2·m/h: {found:?}");
    }
}

#[test]
fn what_is_not_analysed_is_said() {
    let axis = "[run]\nbase_rate = \"16 kHz\"\n[axis]\nmotion = \"linear\"\n";
    let prescribed = scenario(&format!("{axis}[motor]\nkind = \"prescribed\"\n"));
    let analysis = analyse_stability(&prescribed, Depth::Verdict, None, None).unwrap();
    assert_eq!(analysis, Analysis::NotPossible(NotAnalysed::NoDrive));
}
