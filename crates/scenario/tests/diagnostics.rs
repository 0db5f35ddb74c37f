//! What is said of each kind of mistake, and where.
use servobench_scenario::{LoadError, Sources, parse};
use std::path::Path;

/// A rotary axis with a synchronous motor; line numbers in the tests count from its first line.
const AXIS: &str = r#"description = "an elastic axis"
engine = "exact"
[run]
base_rate = "16 kHz"
[axis]
motion = "linear"
lead = "10 mm"
[axis.table]
mass = "40 kg"
stiffness = "43 N/um"
damping = "1659 N s/m"
coulomb = "20 N"
static = "32 N"
stribeck_velocity = "1 mm/s"
[motor]
kind = "pmsm"
pole_pairs = 4
resistance = "1.6 Ohm"
inductance = "3.5 mH"
flux_linkage = "0.06 V s"
inertia = "1.57 kg cm2"
max_current = "13.3 Arms"
[drive]
dc_link = "320 V"
[drive.current]
rate = "16 kHz"
bandwidth = "1 kHz"
[drive.velocity]
rate = "8 kHz"
bandwidth = "60 Hz"
[drive.position]
rate = "4 kHz"
gain = "80 1/s"
[drive.feedforward]
velocity = true
effort = "two-mass"
[setpoint]
order = 3
velocity = "30 m/min"
acceleration = "6 m/s2"
jerk = "200 m/s3"
[[program]]
move_to = "250 mm"
[[disturbance]]
on = "load"
force = "100 N"
[measure]
window = "10 um"
[limits]
settling_time = "50 ms"
"#;

/// `line:column: message; help` of every mistake in `text`.
fn mistakes(text: &str) -> Vec<String> {
    match parse("axis.toml", text, None) {
        Ok(_) => Vec::new(),
        Err(LoadError::Invalid(invalid)) => {
            invalid.diagnostics.iter().map(|one| shortened(&one.line(&invalid.sources))).collect()
        }
        Err(other) => panic!("{other}"),
    }
}

fn shortened(line: &str) -> String {
    line.strip_prefix("axis.toml:").unwrap_or(line).to_owned()
}

/// The mistakes after `old` in the axis became `new`.
fn after(old: &str, new: &str) -> Vec<String> {
    assert_eq!(AXIS.matches(old).count(), 1, "`{old}` must be there once");
    mistakes(&AXIS.replace(old, new))
}

fn warnings(text: &str) -> Vec<String> {
    let loaded = parse("axis.toml", text, None).unwrap_or_else(|e| panic!("{e}"));
    loaded.warnings.iter().map(|one| shortened(&one.line(&loaded.sources))).collect()
}

#[test]
fn the_axis_itself_is_right() {
    assert_eq!(mistakes(AXIS), [""; 0]);
    assert_eq!(warnings(AXIS), [""; 0]);
}

#[test]
fn a_bare_number_is_told_its_unit() {
    let cases = [
        (
            "move_to = \"250 mm\"",
            "move_to = 250",
            "43:11: `move_to` needs a unit, got the bare number 250; write \"250 mm\"",
        ),
        ("mass = \"40 kg\"", "mass = 40.5", "9:8: `mass` needs a unit, got the bare number 40.5; write \"40.5 kg\""),
        ("mass = \"40 kg\"", "mass = \"40\"", "9:8: `mass` needs a unit, got the bare number 40; write \"40 kg\""),
        (
            "base_rate = \"16 kHz\"",
            "base_rate = 16000",
            "4:13: `base_rate` needs a unit, got the bare number 16000; write \"16000 Hz\"",
        ),
        (
            "settling_time = \"50 ms\"",
            "settling_time = 0.05",
            "50:17: `settling_time` needs a unit, got the bare number 0.05; write \"0.05 s\"",
        ),
    ];
    for (old, new, said) in cases {
        assert_eq!(after(old, new), [said], "{new}");
    }
}

#[test]
fn a_wrong_dimension_names_both() {
    let cases = [
        ("mass = \"40 kg\"", "mass = \"40 N\"", "9:8: `mass` must be a mass, but \"40 N\" is a force (N)"),
        (
            "stiffness = \"43 N/um\"",
            "stiffness = \"43 N um\"",
            "10:13: `stiffness` must be a stiffness, but \"43 N um\" is a torque (Nm)",
        ),
        (
            "move_to = \"250 mm\"",
            "move_to = \"90 deg\"",
            "43:11: `move_to` must be a length, but \"90 deg\" is an angle (deg)",
        ),
        (
            "gain = \"80 1/s\"",
            "gain = \"80 Hz\"",
            "33:8: `gain` must be a position gain (1/s), but \"80 Hz\" is a frequency (Hz)",
        ),
        (
            "bandwidth = \"60 Hz\"",
            "bandwidth = \"60 1/s\"",
            "30:13: `bandwidth` must be a bandwidth (Hz or rad/s), but \"60 1/s\" is a position gain (1/s)",
        ),
        (
            "max_current = \"13.3 Arms\"",
            "max_current = \"13.3 A\"",
            "22:15: `max_current` must be a current (Arms or Apk), but \"13.3 A\" is a current (A); say whether the \
             amplitude or the effective value is meant: `Apk` or `Arms`, `Vpk` or `Vrms`",
        ),
    ];
    for (old, new, said) in cases {
        assert_eq!(after(old, new), [said], "{new}");
    }
}

#[test]
fn what_is_no_quantity_is_pointed_at_inside_the_text() {
    let cases = [
        ("mass = \"40 kg\"", "mass = \"40 Kg\"", "9:12: `mass`: unknown unit `Kg`; did you mean `kg`?"),
        ("mass = \"40 kg\"", "mass = \"nan kg\"", "9:9: `mass`: the number must be finite"),
        (
            "mass = \"40 kg\"",
            "mass = \"forty kg\"",
            "9:9: `mass`: a quantity begins with a number; write as in \"250 mm\"",
        ),
        ("mass = \"40 kg\"", "mass = \"4,5 kg\"", "9:10: `mass`: the decimal sign is a point"),
        (
            "damping = \"1659 N s/m\"",
            "damping = \"1659 N/m s\"",
            "11:21: `damping`: a unit ends with its quotient; write \"N s/m\" or \"N/(m s)\", whichever is meant",
        ),
        (
            "mass = \"40 kg\"",
            "mass = \"40 kg\\u0020?\"",
            "9:8: `mass`: this is no unit; write as in \"250 mm\", \"30 m/min\" or \"0.5 kg m2\"",
        ),
    ];
    for (old, new, said) in cases {
        assert_eq!(after(old, new), [said], "{new}");
    }
}

#[test]
fn numbers_out_of_their_bounds() {
    let cases = [
        ("mass = \"40 kg\"", "mass = \"-40 kg\"", "9:8: `mass` must be above zero, got \"-40 kg\""),
        ("mass = \"40 kg\"", "mass = nan", "9:8: `mass` needs a unit, got the bare number nan; write \"1 kg\""),
        ("coulomb = \"20 N\"", "coulomb = \"-1 N\"", "12:11: `coulomb` must be zero or more, got \"-1 N\""),
        (
            "inertia = \"1.57 kg cm2\"",
            "inertia = \"-1 kg m2\"",
            "21:11: `inertia` must be above zero, got \"-1 kg m2\"",
        ),
        ("pole_pairs = 4", "pole_pairs = 0", "17:14: `pole_pairs` must be a whole number from 1 to 1000, got 0"),
        ("pole_pairs = 4", "pole_pairs = 4.5", "17:14: `pole_pairs` must be a whole number from 1 to 1000, got 4.5"),
        ("order = 3", "order = 5", "38:9: `order` must be a whole number from 2 to 4, got 5"),
        ("velocity = true", "velocity = 1.5", "35:12: `velocity` must be from 0 to 1, got 1.5"),
        ("velocity = true", "velocity = inf", "35:12: `velocity` must be finite, got inf"),
        (
            "base_rate = \"16 kHz\"",
            "base_rate = \"16000.5 Hz\"",
            "4:13: `base_rate`: a rate must be a whole number of hertz from 1 to 4294967295, got 16000.5 Hz",
        ),
        (
            "base_rate = \"16 kHz\"",
            "base_rate = \"1 GHz\"",
            "4:13: `base_rate` must be at most 10000000 Hz, got \"1 GHz\"",
        ),
        (
            "static = \"32 N\"",
            "static = \"15 N\"",
            "13:10: `static` is 15, below `coulomb`, which is 20 (SI); friction at rest is at least that of sliding",
        ),
    ];
    for (old, new, said) in cases {
        assert_eq!(after(old, new), [said], "{new}");
    }
}

#[test]
fn unknown_keys_get_the_nearest_valid_name() {
    let cases = [
        ("damping = ", "dampign = ", "11:1: unknown key `dampign` in `axis.table`; did you mean `damping`?"),
        ("[drive.position]", "[drive.postion]", "31:8: unknown key `postion` in `drive`; did you mean `position`?"),
        ("[measure]", "[mesure]", "47:2: unknown key `mesure`; did you mean `measure`?"),
        (
            "settling_time = ",
            "setling_time = ",
            "50:1: there is no metric `setling_time`; did you mean `settling_time`?",
        ),
        ("engine = \"exact\"", "engine = \"exakt\"", "2:10: `engine` has no value \"exakt\"; did you mean `exact`?"),
        (
            "kind = \"pmsm\"",
            "kind = \"dc\"",
            "16:8: `kind` has no value \"dc\"; known here: `pmsm`, `ideal-source`, `prescribed`",
        ),
    ];
    for (old, new, said) in cases {
        assert!(after(old, new).contains(&said.to_owned()), "{new}: {:#?}", after(old, new));
    }
    let colour = after("engine = \"exact\"", "engine = \"exact\"\n[drive.current]\ncolour = 1");
    assert!(colour[0].contains("unknown key `colour` in `drive.current`; known here: `rate`, "), "{colour:?}");
}

#[test]
fn names_of_models_and_channels() {
    let model = after("[motor]\nkind = \"pmsm\"", "[motor]\nmodel = \"saarakala-2.2kw\"\nkind = \"pmsm\"");
    assert_eq!(
        model,
        ["16:9: there is no model `saarakala-2.2kw` in `models/motors`; did you mean `saarakkala-2.2kw`?"]
    );
    let path = after("[motor]\nkind = \"pmsm\"", "[motor]\nmodel = \"../x\"\nkind = \"pmsm\"");
    assert_eq!(path, ["16:9: `../x` is no name of a model; letters, digits, `-`, `_` and `.` make a name"]);
    let channel = after("[measure]", "[record]\nchannels = [\"load.position\", \"load.veloctiy\"]\n[measure]");
    assert_eq!(channel, ["48:30: `channels` has no value \"load.veloctiy\"; did you mean `load.velocity`?"]);
}

/// What a table lacks may be in the model that was not found.
#[test]
fn a_model_that_is_not_found_is_the_only_mistake() {
    let text = "[run]\nbase_rate = \"16 kHz\"\n[axis]\nmodel = \"x\"\n[motor]\nmodel = \"y\"\n[drive]\nmodel = \"z\"\n";
    let said = mistakes(text);
    assert!(said.len() == 3 && said.iter().all(|line| line.contains("there is no model")), "{said:#?}");
}

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
        ("lead = \"10 mm\"\n", "5:1: missing `lead` in `axis`; give the travel per revolution of the motor"),
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
        ("move_to = \"250 mm\"\n", "42:1: this step does nothing; give `move_to`, `move_by` or `wait`"),
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

#[test]
fn order_four_needs_snap() {
    assert_eq!(after("order = 3", "order = 4"), ["42:1: missing `snap` in `setpoint`; a move of order 4 needs it"]);
}

#[test]
fn task_rates_that_do_not_divide_the_base_rate() {
    let said = "3000 Hz does not divide the base rate 16000 Hz; 2000 Hz and 3200 Hz do; change it or `run.base_rate`";
    assert_eq!(after("rate = \"4 kHz\"", "rate = \"3 kHz\""), [format!("32:8: {said}")]);
    assert_eq!(after("[measure]", "[record]\nrate = \"3 kHz\"\n[measure]"), [format!("48:8: {said}")]);
    let sample = after("jerk = \"200 m/s3\"", "jerk = \"200 m/s3\"\nsample_time = \"0.3 ms\"");
    assert_eq!(sample, ["42:15: `sample_time` is 4.8000 base ticks, not a whole number; 312.5 us fits"]);
}

#[test]
fn contradictions() {
    let cases = [
        (
            "gain = \"80 1/s\"",
            "gain = \"80 1/s\"\nbandwidth = \"10 Hz\"",
            "33:8: `bandwidth` and `gain` say the same thing; give one of them",
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
            "46:10: the load moves along a line and feels no `torque`; give a `force`",
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
            "25:21: there is no encoder on the load; add `[drive.load_encoder]`",
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
    let said = "34:10: the axis is rigid: there are no two masses; write \"rigid\", or give `stiffness` and \
                `load_inertia` in `[drive.estimate]`";
    assert_eq!(mistakes(&rigid), [said]);
}

#[test]
fn wrong_types() {
    let cases = [
        (
            "velocity = true",
            "velocity = \"yes\"",
            "35:13: `velocity`: a quantity begins with a number; write as in \"250 mm\"",
        ),
        ("engine = \"exact\"", "engine = []", "2:10: `engine` must not be empty"),
        (
            "pole_pairs = 4",
            "pole_pairs = \"4\"",
            "17:14: `pole_pairs` must be a whole number from 1 to 1000, got \"4\"",
        ),
        ("mass = \"40 kg\"", "mass = [1, 2]", "9:8: `mass` must be a mass, got a list; write \"1 kg\""),
        ("[[program]]", "[program]", "42:1: `program` must be a list, got a table; write `[[program]]`"),
        (
            "description = \"an elastic axis\"",
            "description = 1979-05-27",
            "1:15: `description` must be a text, got a date",
        ),
        (
            "[drive.current]\nrate = \"16 kHz\"\nbandwidth = \"1 kHz\"",
            "current = 5",
            "25:11: `drive.current` must be a table, got a number; write `[drive.current]`",
        ),
    ];
    for (old, new, said) in cases {
        assert!(after(old, new).contains(&said.to_owned()), "{new}: {:#?}", after(old, new));
    }
}

#[test]
fn every_mistake_of_a_file_is_reported_in_one_go_in_its_order() {
    let text = AXIS
        .replace("mass = \"40 kg\"", "mass = 40")
        .replace("dampign", "damping")
        .replace("resistance = \"1.6 Ohm\"\n", "")
        .replace("rate = \"8 kHz\"", "rate = \"7 kHz\"")
        .replace("order = 3", "order = 4")
        .replace("window", "windwo");
    let said = mistakes(&text);
    let lines: Vec<_> = said.iter().map(|line| line.split(':').next().unwrap()).collect();
    assert_eq!(lines, ["9", "15", "28", "41", "47", "49"], "{said:#?}");
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

#[test]
fn errors_in_a_model_point_into_the_model() {
    let folder = tempfile::tempdir().unwrap();
    let motors = folder.path().join("models/motors");
    std::fs::create_dir_all(&motors).unwrap();
    std::fs::write(
        motors.join("mine.toml"),
        "kind = \"pmsm\"\npole_pairs = 4\ninertia = \"1 kg m2\"\nresistance = 1.6\ninductence = \"1 mH\"\n",
    )
    .unwrap();
    let text = "[run]\nbase_rate = \"16 kHz\"\n[axis]\nmotion = \"rotary\"\n[motor]\nmodel = \"mine\"\nmax_current = \"1 A\"\n";
    let Err(LoadError::Invalid(invalid)) = parse("axis.toml", text, Some(folder.path())) else { panic!("is wrong") };
    let said: Vec<_> = invalid.diagnostics.iter().map(|one| at(&invalid.sources, one)).collect();
    assert_eq!(
        said,
        [
            ("axis.toml", 5, "missing `inductance` in `motor`"),
            ("axis.toml", 5, "missing `flux_linkage` in `motor`"),
            ("axis.toml", 7, "`max_current` must be a current (Arms or Apk), but \"1 A\" is a current (A)"),
            ("mine.toml", 4, "`resistance` needs a unit, got the bare number 1.6"),
            ("mine.toml", 5, "unknown key `inductence` in `motor`"),
        ]
    );
}

fn at<'a>(sources: &'a Sources, one: &'a servobench_scenario::Diagnostic) -> (&'a str, usize, &'a str) {
    let name = Path::new(sources.name(one.source)).file_name().unwrap().to_str().unwrap();
    (name, sources.line_and_column(one.source, one.span.start).0, &one.message)
}

#[test]
fn what_is_doubtful_is_a_warning() {
    let unused = AXIS.replace("order = 3", "order = 2");
    assert_eq!(warnings(&unused), ["41:8: `jerk` is not used by a move of order 2"]);
    let narrow = AXIS.replace("static = \"32 N\"\n", "");
    assert_eq!(warnings(&narrow), ["13:21: `stribeck_velocity` does nothing without `static`"]);
}

#[test]
fn a_file_that_is_not_there_is_an_error_of_its_own() {
    let error = servobench_scenario::load(Path::new("no/such/file.toml")).unwrap_err();
    assert!(matches!(error, LoadError::Read { .. }));
    assert!(error.to_string().starts_with("cannot read `no/such/file.toml`: "), "{error}");
}
