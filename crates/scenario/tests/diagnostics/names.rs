//! Names of keys, values and models; values of the wrong type.
use crate::{AXIS, after, mistakes};
use servobench_scenario::{LoadError, Sources, parse};
use servobench_signals::Signal;
use std::path::Path;

#[test]
fn unknown_keys_get_the_nearest_valid_name() {
    let cases = [
        ("damping = ", "dampign = ", "11:1: unknown key `dampign` in `axis.table`; did you mean `damping`?"),
        ("[drive.position]", "[drive.postion]", "31:8: unknown key `postion` in `drive`; did you mean `position`?"),
        ("[measure]", "[mesure]", "47:2: unknown key `mesure`; did you mean `measure`?"),
        ("settling_time = ", "setling_time = ", "50:1: unknown metric `setling_time`; did you mean `settling_time`?"),
        (
            "engine = \"exact\"",
            "engine = \"exakt\"",
            "2:10: \"exakt\" is not a value of `engine`; did you mean `exact`?",
        ),
        (
            "kind = \"pmsm\"",
            "kind = \"dc\"",
            "16:8: \"dc\" is not a value of `kind`; known here: `pmsm`, `ideal-source`, `prescribed`",
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
    assert_eq!(model, ["16:9: unknown model `saarakala-2.2kw` in `models/motors`; did you mean `saarakkala-2.2kw`?"]);
    let path = after("[motor]\nkind = \"pmsm\"", "[motor]\nmodel = \"../x\"\nkind = \"pmsm\"");
    assert_eq!(path, ["16:9: `../x` is not a model name; a name has letters, digits, `-`, `_` and `.`"]);
    let channel = after("[measure]", "[record]\nchannels = [\"load.position\", \"load.veloctiy\"]\n[measure]");
    assert_eq!(channel, ["48:30: \"load.veloctiy\" is not a value of `channels`; did you mean `load.velocity`?"]);
}

/// Keys missing from a table may be in the model that was not found.
#[test]
fn a_model_that_is_not_found_is_the_only_mistake() {
    let text = "[run]\nbase_rate = \"16 kHz\"\n[axis]\nmodel = \"x\"\n[motor]\nmodel = \"y\"\n[drive]\nmodel = \"z\"\n";
    let said = mistakes(text);
    assert!(said.len() == 3 && said.iter().all(|line| line.contains("unknown model")), "{said:#?}");
}

#[test]
fn wrong_types() {
    let cases = [
        (
            "velocity = true",
            "velocity = \"yes\"",
            "35:12: `velocity` must be true, false or a share from 0 to 1, got \"yes\"",
        ),
        (
            "velocity = true",
            "velocity = true\ndelay = \"automatic\"",
            "36:9: `delay` must be \"auto\" or a value like 125 us, got \"automatic\"",
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
            "1:15: `description` must be a string, got a date",
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
            (
                "axis.toml",
                7,
                "`max_current` must be a current (Arms or Apk), but \"1 A\" is neither an amplitude nor an RMS value"
            ),
            ("mine.toml", 4, "`resistance` needs a unit, got the bare number 1.6"),
            ("mine.toml", 5, "unknown key `inductence` in `motor`"),
        ]
    );
}

fn at<'a>(sources: &'a Sources, one: &'a servobench_scenario::Diagnostic) -> (&'a str, usize, &'a str) {
    let name = Path::new(sources.name(one.source)).file_name().unwrap().to_str().unwrap();
    (name, sources.line_and_column(one.source, one.span.start).0, &one.message)
}

/// The axis with `name = NAME`, and `addition` at the end.
fn named(name: &str, addition: &str) -> Vec<String> {
    mistakes(&(AXIS.replace("[axis]\n", &format!("[axis]\nname = {name}\n")) + addition))
}

#[test]
fn names_of_axes() {
    for name in ["\"x\"", "\"X_2-b\"", "\"load\"", "\"0\"", &format!("\"{}\"", "x".repeat(32))] {
        assert_eq!(named(name, ""), [""; 0], "{name}");
    }
    let help = "; write a name like \"x\"";
    let letters = "the name of an axis consists of letters from a to z, digits, `_` and `-`, got";
    let too_long = |characters| format!("the name of an axis has at most 32 characters, got {characters}");
    for (name, said) in [
        ("\"\"", format!("`name`: the name of an axis must not be empty{help}")),
        ("\"a.b\"", format!("`name`: {letters} '.'{help}")),
        ("'a\"b'", format!("`name`: {letters} '\"'{help}")),
        ("\"a b\"", format!("`name`: {letters} ' '{help}")),
        ("\"ä\"", format!("`name`: {letters} 'ä'{help}")),
        ("\"\\u001b[2J\"", format!("`name`: {letters} '\\u{{1b}}'{help}")),
        ("\"\\u202ex\"", format!("`name`: {letters} '\\u{{202e}}'{help}")),
        (&format!("\"{}\"", "x".repeat(33)), format!("`name`: {}{help}", too_long(33))),
        (&format!("\"{}\"", "x".repeat(10_000)), format!("`name`: {}{help}", too_long(10_000))),
        ("1", "`name` must be a string, got 1".to_owned()),
        ("[\"x\"]", "`name` must be a string, got a list".to_owned()),
    ] {
        assert_eq!(named(name, ""), [format!("6:8: {said}")], "{name}");
    }
    for taken in ["measured", "settling_time"] {
        let said = named(&format!("\"{taken}\""), "");
        let names = "names of metrics or signals could be read in two ways; give another name";
        assert_eq!(said, [format!("6:8: `{taken}` cannot name an axis: {names}")]);
    }
}

/// A signal is called by its own name, or with that of its axis in front.
#[test]
fn signals_and_limits_of_axes() {
    let x = |addition: &str| named("\"x\"", addition);
    let places = |said: Vec<String>| said.into_iter().map(|line| line.split_once(": ").unwrap().1.to_owned());
    let said = |said: Vec<String>| places(said).collect::<Vec<_>>();
    let channels = |names: &str| format!("[record]\nchannels = [{names}]\n");
    assert_eq!(x(&channels("\"load.position\", \"x.load.velocity\"")), [""; 0]);
    assert_eq!(
        said(x(&channels("\"y.load.position\""))),
        ["\"y.load.position\" is not a value of `channels`; unknown axis `y`; the axes are: `x`"]
    );
    assert_eq!(
        said(mistakes(&format!("{AXIS}{}", channels("\"x.load.position\"")))),
        [
            "\"x.load.position\" is not a value of `channels`; unknown axis `x`; the axis gets a name by `name` in `[axis]`"
        ]
    );
    assert_eq!(
        said(x(&channels("\"x.load.veloctiy\""))),
        ["\"x.load.veloctiy\" is not a value of `channels`; did you mean `load.velocity`?"]
    );
    assert_eq!(x("[limits.x]\nmove_time = \"2 s\"\n"), [""; 0]);
    assert_eq!(
        said(x("[limits.y]\nmove_time = \"2 s\"\n")),
        ["unknown metric `y`; unknown axis `y`; the axes are: `x`"]
    );
    assert_eq!(
        said(x("[limits.x]\nsettling_time = \"20 ms\"\n")),
        ["`settling_time` has two limits; leave one of them out"]
    );
    let twice = said(x("[limits.x.x]\nmove_time = \"2 s\"\n"));
    assert_eq!(twice, ["unknown metric `x`; unknown axis `x`; the axes are: `x`"]);
}

#[test]
fn the_example_of_the_page_is_right() {
    let page = include_str!("../../../../docs/results.md");
    let block = page.split("```toml\n").find(|block| block.starts_with("[axis]\n")).unwrap();
    let (axis, rest) = block.split_once("```").unwrap().0.split_once("\n\n").unwrap();
    let text = AXIS.replace("[axis]\n", &format!("{axis}\n")) + rest;
    let loaded = parse("axis.toml", &text, None).unwrap_or_else(|error| panic!("{error}"));
    assert_eq!(loaded.scenario.axis.name.unwrap().as_str(), "x");
    assert_eq!(loaded.scenario.record.channels, [Signal::LoadPosition, Signal::LoadVelocity]);
    assert_eq!(loaded.scenario.limits.len(), 2);
}
