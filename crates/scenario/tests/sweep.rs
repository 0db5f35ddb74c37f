//! Sweep files: their requests, and the diagnostics of mistakes in them.
use servobench_metrics::Name;
use servobench_plant::EngineName;
use servobench_scenario::{LoadError, Override, SweepRequest, load_sweep, parse_sweep};
use servobench_sweep::Setting;
use std::path::Path;

fn read(text: &str) -> SweepRequest {
    parse_sweep("sweep.toml", text, Path::new("folder")).unwrap_or_else(|error| panic!("{error}"))
}

/// Every point as on the command line.
fn points(text: &str) -> Vec<String> {
    let sweep = read(text).sweep;
    let written = |index| sweep.point(index).iter().map(Setting::written).collect::<Vec<_>>().join(", ");
    (0..sweep.points()).map(written).collect()
}

/// The mistakes in `text`, each in one line.
fn mistakes(text: &str) -> Vec<String> {
    match parse_sweep("sweep.toml", text, Path::new("")) {
        Err(LoadError::Invalid(invalid)) => invalid.diagnostics.iter().map(|one| one.line(&invalid.sources)).collect(),
        other => panic!("{other:?}"),
    }
}

const HEAD: &str = "scenario = \"a.toml\"\n";

#[test]
fn lists_and_ranges_make_a_grid() {
    let request = read(
        "scenario = \"../a.toml\"\ndescription = \"jerk against mass\"\nengine = [\"exact\", \"rapier\"]\n\
         metrics = [\"settling_time\", \"residual_vibration_pp\"]\n[[vary]]\nkey = \"setpoint.jerk\"\n\
         values = [\"25 m/s3\", \"50 m/s3\"]\n[[vary]]\nkey = \"axis.load.mass\"\n\
         range = { from = \"1 kg\", to = \"100 kg\", count = 3, spacing = \"log\" }\n",
    );
    assert_eq!(request.scenario, Path::new("folder/../a.toml"));
    assert_eq!(request.engines, [EngineName::Exact, EngineName::Rapier]);
    assert_eq!(request.metrics, [Name::SettlingTime, Name::ResidualVibrationPp]);
    assert_eq!((request.description.as_str(), request.sweep.points()), ("jerk against mass", 6));
    let found: Vec<_> = request.sweep.point(4).iter().map(Setting::written).collect();
    assert_eq!(found[0], "setpoint.jerk=50 m/s3");
    let mass = request.sweep.point(4)[1].value.number().unwrap();
    assert!((mass - 10.0).abs() < 1e-13, "{mass}");
    // Each is an override as on the command line.
    for index in 0..6 {
        assert!(request.sweep.point(index).iter().all(|one| one.written().parse::<Override>().is_ok()));
    }
}

#[test]
fn values_of_any_kind_go_side_by_side() {
    let found = points(&format!(
        "{HEAD}arrangement = \"zip\"\n[[vary]]\nkey = \"setpoint.shaper\"\nvalues = [\"zv\", \"ei\", \"none\"]\n[[vary]]\n\
         key = \"drive.feedforward.velocity\"\nvalues = [true, false, true]\n[[vary]]\nkey = \"setpoint.order\"\nvalues = [2, 3, 4]\n"
    ));
    let expected = ["zv, true, 2", "ei, false, 3", "none, true, 4"].map(|values| {
        let keys = ["setpoint.shaper", "drive.feedforward.velocity", "setpoint.order"];
        keys.iter().zip(values.split(", ")).map(|(key, value)| format!("{key}={value}")).collect::<Vec<_>>().join(", ")
    });
    assert_eq!(found, expected);
}

/// Names may begin with a digit, and a unit may directly follow its number.
#[test]
fn a_name_that_begins_with_a_number_stays_a_name() {
    let of = |value: &str| points(&format!("{HEAD}[[vary]]\nkey = \"a\"\nvalues = \"{value}\"\n"));
    for name in ["2hump-ei", "3hump-ei", "2-mass.toml", "1e", "5 parsecs", "7"] {
        assert_eq!(of(name), [format!("a={name}")]);
    }
    for (value, written) in [("5mm", "5 mm"), ("50m/s3", "50 m/s3"), ("5%", "5 %"), (" 5  m/s ", "5 m/s")] {
        assert_eq!(of(value), [format!("a={written}")]);
    }
}

/// A tolerance is three standard deviations, or half the width.
#[test]
fn tolerances_are_drawn() {
    let request = read(&format!(
        "{HEAD}[[vary]]\nkey = \"a\"\nnormal = {{ mean = \"5 kg\", tolerance = \"6 %\" }}\n[[vary]]\nkey = \"b\"\n\
         uniform = {{ mean = \"-2 m\", tolerance = \"10 %\" }}\n[[vary]]\nkey = \"c\"\n\
         triangular = {{ mode = 10, tolerance = \"20 %\" }}\n[draws]\ncount = 10000\nseed = 3\n"
    ));
    let column = |key: usize| -> Vec<f64> {
        (0..10_000).map(|index| request.sweep.point(index)[key].value.number().unwrap()).collect()
    };
    let (normal, uniform, triangle) = (column(0), column(1), column(2));
    let mean = normal.iter().sum::<f64>() / 1e4;
    let sigma = (normal.iter().map(|x| (x - mean) * (x - mean)).sum::<f64>() / 1e4).sqrt();
    // With a hypercube mean and deviation are closer than with random draws: 0.1 kg/√1e4 and 0.1 kg/√2e4.
    assert!((mean - 5.0).abs() < 1e-3 && (sigma - 0.1).abs() < 7e-4, "{mean} {sigma}");
    let range = |all: &[f64]| all.iter().fold((f64::INFINITY, f64::NEG_INFINITY), |(l, h), x| (l.min(*x), h.max(*x)));
    let ((low, high), (left, right)) = (range(&uniform), range(&triangle));
    assert!((-2.2..-2.199).contains(&low) && (-1.801..=-1.8).contains(&high), "{low} {high}");
    assert!((8.0..8.1).contains(&left) && (11.9..=12.0).contains(&right), "{left} {right}");
    assert_eq!(request.sweep.keys().collect::<Vec<_>>(), [("a", "kg"), ("b", "m"), ("c", "")]);
}

#[test]
fn mistakes_have_their_places() {
    let of = |rest: &str| mistakes(&format!("{HEAD}{rest}"));
    let vary = |values: &str| of(&format!("[[vary]]\nkey = \"setpoint.jerk\"\n{values}\n")).join("\n");
    assert!(mistakes("").iter().any(|line| line.contains("scenario")), "{:?}", mistakes(""));
    assert!(vary("").contains("sweep.toml:2") && vary("").contains("it has none"), "{}", vary(""));
    assert!(vary("values = [1]\nrange = { from = 1, to = 2, count = 2 }").contains("it has more than one"));
    let units = vary("range = { from = \"1 m/s3\", to = \"2 mm/s3\", count = 2 }");
    assert!(
        units.contains("sweep.toml:4") && units.contains("`2 mm/s3` has `mm/s3`, the other number `m/s3`"),
        "{units}"
    );
    let words = vary("range = { from = \"slow\", to = \"fast\", count = 2 }");
    assert!(words.contains("`slow` is not a number"), "{words}");
    let log = vary("range = { from = \"0 m/s3\", to = \"2 m/s3\", count = 2, spacing = \"log\" }");
    assert!(log.contains("`setpoint.jerk`: a scale from 0 to 2 cannot be logarithmic"), "{log}");
    assert!(vary("normal = { mean = \"1 kg\", tolerance = \"5 %\" }").contains("write `[draws]`"));
    assert!(vary("normal = { mean = \"1 kg\" }").contains("`sigma` or `tolerance` beside `mean`"));
    assert!(vary("uniform = { from = 2, to = 1 }\n[draws]\ncount = 5").contains("from a lower to a higher value"));
    let metric = of("metrics = \"settling_tim\"\n[[vary]]\nkey = \"a\"\nvalues = 1\n").join("\n");
    assert!(metric.contains("unknown metric `settling_tim`") && metric.contains("settling_time"), "{metric}");
    let twice = of("[[vary]]\nkey = \"a\"\nvalues = 1\n[[vary]]\nkey = \"a\"\nvalues = 2\n").join("\n");
    assert!(twice.contains("`a` varies twice"), "{twice}");
    for number in ["nan", "inf", "-inf", "\"1e400 kg\""] {
        let wrong = vary(&format!("range = {{ from = {number}, to = 1, count = 2 }}"));
        assert!(wrong.contains("sweep.toml:4"), "{number}: {wrong}");
    }
    // Several at once.
    assert!(of("engine = \"exakt\"\narrangement = \"gird\"\n[[vary]]\nkey = \"a\"\nvalues = []\n").len() >= 3);
}

#[test]
fn a_file_that_is_not_there_is_named() {
    let Err(LoadError::Read { path, .. }) = load_sweep(Path::new("no/such.toml")) else { panic!("it is there") };
    assert_eq!(path, Path::new("no/such.toml"));
}

/// A front compares choices: the machine, its disturbances and seeds are given unless the file declares otherwise.
#[test]
fn the_machine_is_given_where_combinations_are_chosen() {
    let vary = |key: &str, more: &str| format!("[[vary]]\nkey = \"{key}\"\n{more}values = [1, 2]\n");
    let machine_keys = |text: &str| read(&format!("{HEAD}{text}")).sweep.machine_keys().to_vec();
    for key in ["axis.load.mass", "motor.limit", "disturbance[0].force", "motor.encoder.seed", "bus.fault[0].seed"] {
        assert_eq!(machine_keys(&vary(key, "")), [key]);
        assert!(machine_keys(&vary(key, "given = false\n")).is_empty(), "{key}");
        let given = read(&format!("{HEAD}{}", vary(key, "given = true\n"))).sweep;
        assert!(given.machine_keys().is_empty() && given.given_keys() == [key], "{key}");
    }
    for key in ["setpoint.jerk", "drive.position.gain", "measure.mode", "program[0].move_to"] {
        assert!(machine_keys(&vary(key, "")).is_empty(), "{key}");
    }
    assert_eq!(machine_keys(&vary("measure.mode", "also = \"axis.load.frequency\"\n")), ["measure.mode"]);
    let sweep = read(&format!("{HEAD}{}{}", vary("axis.load.mass", ""), vary("setpoint.jerk", ""))).sweep;
    let chosen = sweep.chosen_for_a_machine().unwrap();
    assert_eq!(chosen.axes().iter().map(|axis| axis.key.as_str()).collect::<Vec<_>>(), ["setpoint.jerk"]);
    assert!(sweep.chosen().is_none(), "tables have every combination");
}

/// Seeds are whole numbers in each range and each draw: a scenario accepts no others.
#[test]
fn seeds_are_whole_numbers() {
    let vary = "[[vary]]\nkey = \"motor.encoder.seed\"\n";
    let range = points(&format!("{HEAD}{vary}range = {{ from = 1, to = 20, count = 20 }}\n"));
    let expected: Vec<String> = (1..=20).map(|seed| format!("motor.encoder.seed={seed}")).collect();
    assert_eq!(range, expected);
    let drawn = points(&format!(
        "{HEAD}{vary}whole = {{ from = 0, to = 4294967295 }}\n[draws]\ncount = 50\nmethod = \"random\"\n"
    ));
    let seeds: Vec<u32> = drawn.iter().map(|one| one.split('=').nth(1).unwrap().parse().unwrap()).collect();
    assert!(seeds.len() == 50 && seeds.iter().any(|seed| *seed > 1 << 31), "{seeds:?}");
    let wrong = mistakes(&format!("{HEAD}{vary}whole = {{ from = 0.5, to = 3 }}\n[draws]\ncount = 2\n"));
    assert!(wrong.iter().any(|line| line.contains("lower to a higher whole number")), "{wrong:?}");
}

/// A range through zero contains zero, not a remainder of rounding.
#[test]
fn a_range_through_zero_contains_zero() {
    let vary = "[[vary]]\nkey = \"axis.load.bias\"\nrange = { from = \"-0.1 N\", to = \"0.3 N\", count = 5 }\n";
    let values = ["-0.1", "0", "0.1", "0.2", "0.3"].map(|value| format!("axis.load.bias={value} N"));
    assert_eq!(points(&format!("{HEAD}{vary}")), values);
}
