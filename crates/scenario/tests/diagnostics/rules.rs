//! Missing, contradictory and incompatible keys; several mistakes at once.
use crate::{AXIS, after, mistakes, warnings};
use servobench_scenario::LoadError;
use std::path::Path;

#[test]
fn a_move_without_any_limit_is_told_all_that_it_needs() {
    let bare = AXIS.replace("order = 3\nvelocity = \"30 m/min\"\nacceleration = \"6 m/s2\"\njerk = \"200 m/s3\"\n", "");
    assert_eq!(
        mistakes(&bare),
        [
            "38:1: missing `order` in `setpoint`; 2, 3 or 4",
            "38:1: missing `velocity` in `setpoint`; every move needs it",
            "38:1: missing `acceleration` in `setpoint`; every move needs it",
        ]
    );
}

#[test]
fn what_is_missing_is_said_at_the_header_of_its_table() {
    let cases = [
        ("base_rate = \"16 kHz\"\n", "3:1: missing `base_rate` in `run`"),
        ("motion = \"linear\"\n", "5:1: missing `motion` in `axis`"),
        ("mass = \"40 kg\"\n", "8:1: missing `mass` in `axis.table`"),
        ("resistance = \"1.6 Ohm\"\n", "15:1: missing `resistance` in `motor`"),
        ("inductance = \"3.5 mH\"\n", "15:1: missing `inductance` in `motor`; or `inductance_d` and `inductance_q`"),
        (
            "flux_linkage = \"0.06 V s\"\n",
            "15:1: missing `flux_linkage` in `motor`; or `torque_constant`, or `back_emf`",
        ),
        ("max_current = \"13.3 Arms\"\n", "15:1: missing `max_current` in `motor`"),
        ("dc_link = \"320 V\"\n", "23:1: missing `dc_link` in `drive`"),
        ("[drive.current]\nrate = \"16 kHz\"\nbandwidth = \"1 kHz\"\n", "23:1: missing `current` in `drive`"),
        ("bandwidth = \"60 Hz\"\n", "28:1: missing `bandwidth` in `drive.velocity`; or `gain`"),
        ("rate = \"4 kHz\"\n", "31:1: missing `rate` in `drive.position`"),
        ("jerk = \"200 m/s3\"\n", "41:1: missing `jerk` in `setpoint`; a move of order 3 needs it"),
        ("order = 3\n", "41:1: missing `order` in `setpoint`; 2, 3 or 4"),
        (
            "move_to = \"250 mm\"\n",
            "42:1: this step does nothing; give `move_to`, `move_by`, `reach_velocity`, `table` or `wait`",
        ),
        ("on = \"load\"\n", "44:1: missing `on` in `disturbance`"),
        ("force = \"100 N\"\n", "44:1: missing `force` in `disturbance`"),
        ("window = \"10 um\"\n", "49:1: `settling_time` needs a settling window; give `window` in `[measure]`"),
    ];
    for (gone, said) in cases {
        assert!(after(gone, "").contains(&said.to_owned()), "{gone}: {:#?}", after(gone, ""));
    }
    assert_eq!(
        mistakes(""),
        ["1:1: missing table `[run]`", "1:1: missing table `[axis]`", "1:1: missing table `[motor]`"]
    );
}

/// A zero without homing has no place, and one on a modulo axis recurs every turn.
#[test]
fn a_place_of_the_zero_needs_homing() {
    let homeless = "49:11: `home_at` is the position of the zero after homing, and nothing homes the axis; call \"MC_Home\", or leave \
                    `home_at` out";
    let with = |more: &str| after("window = \"10 um\"\n", &format!("window = \"10 um\"\nhome_at = \"2 mm\"\n{more}"));
    assert_eq!(with(""), [homeless]);
    let home = "[bus]\ncycle = \"1 ms\"\n[[call]]\nblock = \"MC_Home\"\nname = \"home\"\n";
    assert!(with(home).iter().all(|said| !said.contains("home_at")), "{:?}", with(home));
}

/// A rotary motor needs a lead; its absence must not cause further mistakes.
#[test]
fn a_motor_turns_or_is_linear_by_its_own_keys() {
    let said = "5:1: missing `lead` in `axis`; give the travel per revolution of the motor; a linear motor has \
                `pole_pitch`, no `pole_pairs`";
    assert_eq!(after("lead = \"10 mm\"\n", ""), [said]);
    let linear = AXIS
        .replace("lead = \"10 mm\"\n", "")
        .replace("pole_pairs = 4", "pole_pitch = \"23 mm\"")
        .replace("inertia = \"1.57 kg cm2\"", "mass = \"20 kg\"");
    assert_eq!(mistakes(&linear), [""; 0]);
    let cases = [
        (
            "motion = \"linear\"",
            "motion = \"linear\"\nlead = \"10 mm\"",
            "7:8: a linear motor has no `lead`; a motor that turns has `pole_pairs`, no `pole_pitch`",
        ),
        (
            "motion = \"linear\"",
            "motion = \"linear\"\ngear_ratio = 2",
            "7:14: a linear motor has no `gear_ratio`; a motor that turns a screw or pinion has a `lead`",
        ),
        (
            "pole_pitch = \"23 mm\"",
            "pole_pitch = \"23 mm\"\npole_pairs = 4",
            "17:14: `pole_pairs` and `pole_pitch` of one motor; a motor that turns has `pole_pairs`, a linear motor has `pole_pitch`",
        ),
        (
            "flux_linkage = \"0.06 V s\"",
            "torque_constant = \"1 Nm/Arms\"",
            "19:19: the motor moves along a line and has no `torque_constant`; give its `force_constant`",
        ),
        (
            "flux_linkage = \"0.06 V s\"",
            "force_constant = \"80 N/A\"",
            "19:18: `force_constant` must be a force constant (N/Arms or N/Apk), but \"80 N/A\" is neither an amplitude nor an RMS value; write `Arms` or `Apk`, `Vrms` or `Vpk`",
        ),
        (
            "flux_linkage = \"0.06 V s\"\n",
            "",
            "14:1: missing `flux_linkage` in `motor`; or `force_constant`, or `back_emf`",
        ),
        (
            "flux_linkage = \"0.06 V s\"",
            "back_emf = \"31 Vrms/krpm\"",
            "19:12: `back_emf` must be a back-EMF constant (Vrms s/m or Vpk s/m, line to line), but \"31 Vrms/krpm\" is a back-EMF constant (Vrms/krpm or Vpk/krpm, line to line)",
        ),
        (
            "pole_pitch = \"23 mm\"\n",
            "",
            "14:1: missing `pole_pitch` in `motor`; a motor that turns has `pole_pairs`, and a linear axis then a `lead`",
        ),
        (
            "dc_link = \"320 V\"",
            "dc_link = \"320 V\"\nmax_force = \"1 kN\"",
            "24:13: `max_force` is more than the motor gives, 231.22308 N; that is 1.5·(π/τ_p)·ψ·`max_current`",
        ),
    ];
    for (old, new, said) in cases {
        let changed = mistakes(&linear.replace(old, new));
        assert!(changed.contains(&said.to_owned()), "{new}: {changed:#?}");
    }
    let turns = after("flux_linkage = \"0.06 V s\"", "force_constant = \"80 N/Arms\"");
    assert!(
        turns.contains(&"20:18: the motor turns and has no `force_constant`; give its `torque_constant`".to_owned()),
        "{turns:?}"
    );
    let rotary = linear.replace("motion = \"linear\"", "motion = \"rotary\"");
    let said = "16:14: a linear motor cannot turn a rotary axis; a motor that turns has `pole_pairs`";
    assert!(mistakes(&rotary).contains(&said.to_owned()), "{:#?}", mistakes(&rotary));
}

#[test]
fn order_four_needs_snap() {
    assert_eq!(after("order = 3", "order = 4"), ["42:1: missing `snap` in `setpoint`; a move of order 4 needs it"]);
}

#[test]
fn task_rates_that_do_not_divide_the_base_rate() {
    let said = "3000 Hz does not divide the base rate 16000 Hz; 2000 Hz and 3200 Hz do; change it or `run.base_rate`";
    assert_eq!(after("rate = \"4 kHz\"", "rate = \"3 kHz\""), [format!("32:8: {said}")]);
    assert_eq!(after("[measure]", "[record]\nrate = \"3 kHz\"\n[measure]"), [format!("48:8: {said}")]);
    let fast = "32000 Hz is faster than the base rate 16000 Hz; change it or `run.base_rate`";
    assert_eq!(after("rate = \"4 kHz\"", "rate = \"32 kHz\""), [format!("32:8: {fast}")]);
    let sample = after("jerk = \"200 m/s3\"", "jerk = \"200 m/s3\"\nsample_time = \"0.3 ms\"");
    assert_eq!(sample, ["42:15: `sample_time` is 4.8000 base ticks, not a whole number; 312.5 us fits"]);
}

/// A scenario that contradicts a model is blamed: the model is right by itself.
#[test]
fn what_contradicts_a_model_is_pointed_at_in_the_scenario() {
    let text = "[run]\nbase_rate = \"16 kHz\"\n[axis]\nmodel = \"ball-screw\"\ntable.coulomb = \"50 N\"\n[motor]\n\
                model = \"wittenstein-premo-1f\"\n[drive]\nmodel = \"servo-16khz\"\n";
    let said = "5:17: `coulomb` is 50 N, above `static`, which is 32 N; friction at rest is at least that of sliding: give both here";
    assert_eq!(mistakes(text), [said]);
    let rates = text.replace("table.coulomb = \"50 N\"\n", "").replace("16 kHz", "15 kHz");
    let said = "2:13: the base rate must be a multiple of the model's rates: 16000 Hz, 8000 Hz, 4000 Hz; write \"16000 Hz\", \
                or other rates in `[drive]`";
    assert_eq!(mistakes(&rates), [said]);
    assert_eq!(
        mistakes(&rates.replace("15 kHz", "40 kHz")),
        [said.replace("16000 Hz, 8000 Hz, 4000 Hz", "16000 Hz").replace("\"16000", "\"32000")]
    );
}

#[test]
fn loops_turn_with_the_faster_ones_below_them() {
    let velocity = "32:8: 8000 Hz is faster than the velocity loop, 2000 Hz; each turn hands its output to the velocity \
                    loop in the same tick";
    let text = AXIS.replace("rate = \"8 kHz\"", "rate = \"2 kHz\"").replace("rate = \"4 kHz\"", "rate = \"8 kHz\"");
    assert_eq!(mistakes(&text), [velocity]);
    let current = "29:8: 8000 Hz is faster than the current loop, 4000 Hz; each turn hands its output to the current \
                   loop in the same tick";
    assert_eq!(after("[drive.current]\nrate = \"16 kHz\"", "[drive.current]\nrate = \"4 kHz\""), [current]);
    let uneven = "32:8: 3200 Hz does not divide the rate of the velocity loop, 8000 Hz; 2000 Hz and 4000 Hz do; each \
                  turn hands its output to the velocity loop in the same tick";
    assert_eq!(after("rate = \"4 kHz\"", "rate = \"3.2 kHz\""), [uneven]);
}

#[test]
fn estimates_of_what_is_not_there() {
    let estimate = |key: &str| after("[measure]", &format!("[drive.estimate]\n{key}\n[measure]"));
    assert_eq!(estimate("gain = \"2 Nm/V\""), ["48:8: the axis has no ideal source whose `gain` could be estimated"]);
    assert_eq!(estimate("lead = \"5 mm\"\ngear_ratio = 3\ndc_link = \"600 V\""), [""; 0]);
    let ideal = AXIS
        .replace("lead = \"10 mm\"\n", "")
        .replace("kind = \"pmsm\"\npole_pairs = 4\nresistance = \"1.6 Ohm\"\ninductance = \"3.5 mH\"\n", "")
        .replace("flux_linkage = \"0.06 V s\"\ninertia = \"1.57 kg cm2\"\nmax_current = \"13.3 Arms\"", IDEAL);
    let estimate = |key: &str| mistakes(&ideal.replace("[measure]", &format!("[drive.estimate]\n{key}\n[measure]")));
    assert_eq!(mistakes(&ideal), [""; 0]);
    assert_eq!(
        estimate("lead = \"5 mm\"\ngain = \"3 N/V\"\ndc_link = \"600 V\"\nmotor = { resistance = \"1 Ohm\" }"),
        [
            "43:8: the axis has no `lead` to estimate",
            "44:8: the output of the source is its effort: it has no `gain` to estimate",
            "45:11: the axis has no inverter whose DC link could be estimated",
            "46:9: the axis has no synchronous motor to estimate",
        ]
    );
    assert_eq!(estimate("gear_ratio = 3"), ["43:14: the axis has no `gear_ratio` to estimate"]);
}

/// Without a gain: the output is the force itself.
const IDEAL: &str = "kind = \"ideal-source\"\nmass = \"2 kg\"\nlimit = \"500 N\"";

#[test]
fn contradictions() {
    let cases = [
        (
            "gain = \"80 1/s\"",
            "gain = \"80 1/s\"\nbandwidth = \"10 Hz\"",
            "33:8: `bandwidth` and `gain` give the same quantity; give one of them",
        ),
        (
            "move_to = \"250 mm\"",
            "move_to = \"250 mm\"\nwait = \"1 s\"",
            "44:8: `move_to` and `wait` in one step; write two steps",
        ),
        (
            "mass = \"40 kg\"",
            "inertia = \"40 kg m2\"",
            "9:11: the axis moves along a line and has no `inertia`; give its `mass`",
        ),
        ("inertia = \"1.57 kg cm2\"", "mass = \"1 kg\"", "21:8: the motor turns and has no `mass`; give its `inertia`"),
        (
            "force = \"100 N\"",
            "torque = \"1 Nm\"",
            "46:10: the load moves along a line and takes no `torque`; give a `force`",
        ),
        (
            "dc_link = \"320 V\"",
            "dc_link = \"320 V\"\nmax_force = \"9 N\"",
            "25:13: a motor that turns has no `max_force`; give `max_torque`",
        ),
        (
            "dc_link = \"320 V\"",
            "dc_link = \"320 V\"\nmax_torque = \"9 Nm\"",
            "25:14: `max_torque` is more than the motor gives, 6.77125 N m; that is 1.5·p·ψ·`max_current`",
        ),
        (
            "dc_link = \"320 V\"",
            "dc_link = \"320 V\"\nposition_feedback = \"load\"",
            "25:21: the load has no encoder; add `[drive.load_encoder]`",
        ),
        (
            "stiffness = \"43 N/um\"\n",
            "",
            "10:11: `damping` belongs to a coupling that has no `stiffness`; without one the coupling is rigid",
        ),
        (
            "rate = \"8 kHz\"",
            "rate = \"8 kHz\"\nkind = \"p\"\nintegral_time = \"1 ms\"",
            "31:17: a P loop has no `integral_time`; write `kind = \"pi\"` or leave it out",
        ),
        (
            "bandwidth = \"60 Hz\"",
            "gain = \"2 V s/rad\"",
            "30:8: a gain in volts belongs to an ideal source; give torque per velocity",
        ),
        (
            "kind = \"pmsm\"",
            "kind = \"pmsm\"\ngain = \"1 Nm/V\"",
            "17:8: `gain` belongs to an ideal source, this is a synchronous motor",
        ),
        ("engine = \"exact\"", "engine = [\"exact\", \"rapier\", \"exact\"]", "2:30: this engine is named twice"),
        (
            "settling_time = \"50 ms\"",
            "settling_time = { min = \"1 s\", max = \"50 ms\" }",
            "50:17: `settling_time` has a `min` above its `max`",
        ),
        (
            "settling_time = \"50 ms\"",
            "settling_time = {}",
            "50:17: `settling_time` has no bound; give `min`, `max` or both",
        ),
        (
            "[measure]",
            "[axis.mjcf]\nfile = \"a.xml\"\nmotor_joint = \"a\"\nload_joint = \"b\"\nactuator = \"c\"\n[measure]",
            "8:1: `table` and `mjcf` cannot be together; the MJCF file holds all bodies",
        ),
    ];
    for (old, new, said) in cases {
        assert!(after(old, new).contains(&said.to_owned()), "{new}: {:#?}", after(old, new));
    }
    let pause = after("move_to = \"250 mm\"", "wait = \"1 s\"\nvelocity = \"1 m/s\"");
    assert_eq!(pause, ["44:12: a pause has no `velocity`"]);
    let rigid = AXIS.replace("stiffness = \"43 N/um\"\ndamping = \"1659 N s/m\"\n", "");
    let said = "34:10: the axis is rigid: it is a single mass; write \"rigid\", or give `stiffness` and \
                `load_inertia` in `[drive.estimate]`";
    assert_eq!(mistakes(&rigid), [said]);
}

#[test]
fn every_mistake_of_a_file_is_reported_in_one_go_in_its_order() {
    let text = AXIS
        .replace("mass = \"40 kg\"", "mass = 40")
        .replace("damping", "dampign")
        .replace("resistance = \"1.6 Ohm\"\n", "")
        .replace("rate = \"8 kHz\"", "rate = \"7 kHz\"")
        .replace("order = 3", "order = 4")
        .replace("window", "windwo");
    let said = mistakes(&text);
    let lines: Vec<_> = said.iter().map(|line| line.split(':').next().unwrap()).collect();
    assert_eq!(lines, ["9", "11", "15", "28", "41", "47", "49"], "{said:#?}");
}

#[test]
fn wrong_syntax_is_said_without_its_consequences() {
    let text = AXIS
        .replace("mass = \"40 kg\"", "mass = 40 kg")
        .replace("dc_link", "dc link")
        .replace("order = 3", "order = 7");
    assert_eq!(
        mistakes(&text),
        [
            "9:8: string values must be quoted, expected literal string; write texts and quantities as in \"250 mm\"",
            "24:4: key with no value, expected `=`",
            "38:9: `order` must be a whole number from 2 to 4, got 7",
        ]
    );
}

/// Oracles: y ← y + ωT·(r − y) diverges from ωT = 2 on, with a period of delay from ωT = 1 on.
#[test]
fn a_loop_that_its_rate_cannot_carry() {
    let unstable = |name: &str, bandwidth: &str, rate: u32, most: &str| {
        format!(
            "the {name} loop has a bandwidth of {bandwidth} Hz at a rate of {rate} Hz: it is unstable from {most} Hz; lower \
             the bandwidth or raise the rate"
        )
    };
    let cases = [
        (
            "bandwidth = \"1 kHz\"",
            "bandwidth = \"2.6 kHz\"",
            "27:13",
            unstable("current", "2600.0", 16_000, "rate/2π on, 2546.5"),
        ),
        (
            "bandwidth = \"60 Hz\"",
            "bandwidth = \"9 kHz\"",
            "30:13",
            unstable("velocity", "9000.0", 8_000, "rate/π on, 2546.5"),
        ),
        (
            "gain = \"80 1/s\"",
            "gain = \"8000 1/s\"",
            "33:8",
            unstable("position", "1273.2", 4_000, "rate/π on, 1273.2"),
        ),
    ];
    for (old, new, place, said) in cases {
        assert_eq!(warnings(&AXIS.replace(old, new)), [format!("{place}: {said}")], "{new}");
    }
    let doubtful = AXIS
        .replace("bandwidth = \"1 kHz\"", "bandwidth = \"2.2 kHz\"")
        .replace("gain = \"80 1/s\"", "gain = \"7000 1/s\"");
    assert_eq!(
        warnings(&doubtful),
        [
            "27:13: the current loop has a bandwidth of 2200.0 Hz at a rate of 16000 Hz: 1.5 periods of delay take 74° of its \
             phase; a tenth of the rate is usual at most",
            "33:8: the position loop has a bandwidth of 1114.1 Hz at a rate of 4000 Hz: 0.5 periods of delay take 50° of its \
             phase; a tenth of the rate is usual at most",
        ]
    );
    // A drive that is off has no loop.
    let off = AXIS
        .replace("dc_link = \"320 V\"", "enabled = false")
        .replace("bandwidth = \"60 Hz\"", "bandwidth = \"9 kHz\"");
    assert_eq!(warnings(&off), [""; 0]);
}

#[test]
fn what_is_doubtful_is_a_warning() {
    let unused = AXIS.replace("order = 3", "order = 2");
    assert_eq!(warnings(&unused), ["41:8: `jerk` is not used by a move of order 2"]);
    let encoder = AXIS.replace("[drive.current]", "[drive.load_encoder]\nstep = \"1 um\"\n[drive.current]");
    let said = "25:1: the encoder on the load is not used; write `position_feedback = \"load\"` in `[drive]`";
    assert_eq!(warnings(&encoder), [said]);
    let narrow = AXIS.replace("static = \"32 N\"\n", "");
    assert_eq!(warnings(&narrow), ["13:21: `stribeck_velocity` has no effect without `static`"]);
}

/// `max_torque` bounds the drive's request, not the motor's torque: a limit from there to 5 % above is missed whenever the torque
/// saturates.
#[test]
fn a_limit_of_the_torque_at_the_drives_own_is_doubtful() {
    let said = |limit: &str| {
        warnings(
            &AXIS
                .replace("dc_link = \"320 V\"", "dc_link = \"320 V\"\nmax_torque = \"6 Nm\"")
                .replace("settling_time = \"50 ms\"", limit),
        )
    };
    let doubt = "a torque at `drive.max_torque` exceeds this limit: the current loop overshoots; `torque_peak` is that of the \
                 motor; limit `torque_reference_peak`, that of the drive's command, or leave 5 % and more above";
    for limit in ["6 Nm", "6.29 Nm"] {
        let found = said(&format!("torque_peak = \"{limit}\""));
        assert!(found.len() == 1 && found[0].ends_with(doubt), "{limit}: {found:?}");
    }
    for limit in ["torque_peak = \"5.9 Nm\"", "torque_peak = \"6.31 Nm\"", "torque_reference_peak = \"6 Nm\""] {
        assert_eq!(said(limit), [""; 0], "{limit}");
    }
}

/// 13.3 Arms are 18.8 A of amplitude, the limit for both axes together.
#[test]
fn a_current_of_the_d_axis_leaves_some_for_the_other() {
    let said = |current: &str| {
        mistakes(&AXIS.replace("bandwidth = \"1 kHz\"", &format!("bandwidth = \"1 kHz\"\nd_reference = \"{current}\"")))
    };
    assert_eq!(said("-13.2 Arms"), [""; 0]);
    let found = said("-13.3 Arms");
    assert!(found.len() == 1 && found[0].contains("uses up the current limit, 18.80904 A"), "{found:?}");
}

#[test]
fn a_file_that_is_not_there_is_an_error_of_its_own() {
    let error = servobench_scenario::load(Path::new("no/such/file.toml")).unwrap_err();
    assert!(matches!(error, LoadError::Read { .. }));
    assert!(error.to_string().starts_with("cannot read `no/such/file.toml`: "), "{error}");
}
