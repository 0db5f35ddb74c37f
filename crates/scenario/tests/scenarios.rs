//! The files of the repository: every scenario and model loads, and the schema and its reference describe them.
//!
//! `SERVOBENCH_WRITE_DOCS=1 cargo test -p servobench-scenario` rewrites `docs/scenario.schema.json`, `docs/sweep.schema.json` and the
//! tables of `docs/scenario.md` and `docs/sweep.md`.
use serde_json::{Value as Json, json};
use servobench_scenario::{
    Actuator, AxisMechanics, Document, Override, Step, embedded_demo, embedded_models, json_schema, load, load_sweep,
    parse, sweep_schema, value_of_schema,
};
use std::fmt::Write as _;
use std::path::{Path, PathBuf};

const WRITE_DOCS: &str = "SERVOBENCH_WRITE_DOCS";

fn repository() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../..")
}

fn read(path: &Path) -> String {
    std::fs::read_to_string(path).unwrap_or_else(|e| panic!("{}: {e}", path.display()))
}

/// Every scenario file of the repository.
fn scenarios() -> Vec<PathBuf> {
    let folders = ["scenarios", "scenarios/demo", "scenarios/plc", "scenarios/setpoints", "scenarios/templates"]
        .map(|folder| repository().join(folder));
    let files = folders.iter().flat_map(|folder| std::fs::read_dir(folder).unwrap());
    let mut all: Vec<PathBuf> = files
        .map(|entry| entry.unwrap().path())
        .filter(|path| path.extension().is_some_and(|extension| extension == "toml") && !is_sweep(path))
        .collect();
    all.sort();
    assert!(all.len() >= 14, "{all:?}");
    all
}

/// Sweep files are beside the scenarios that they vary.
fn is_sweep(path: &Path) -> bool {
    path.to_string_lossy().ends_with(".sweep.toml")
}

#[test]
fn every_scenario_loads_without_a_warning_and_says_what_it_shows() {
    for path in scenarios() {
        let loaded = load(&path).unwrap_or_else(|e| panic!("{e}"));
        assert_eq!(loaded.warnings, [], "{}", path.display());
        assert!(!loaded.scenario.description.is_empty(), "{} has no description", path.display());
        let of_moves = loaded.scenario.program.iter().any(|step| match step {
            Step::Move(step) => !step.metric_limits.is_empty(),
            Step::Wait(_) => false,
        });
        assert!(of_moves || !loaded.scenario.limits.is_empty(), "{} cannot fail", path.display());
        let text = read(&path);
        let (pointer, rest) = text.split_once('\n').unwrap();
        let schema = path.parent().unwrap().join(pointer.strip_prefix("#:schema ").unwrap());
        assert!(schema.is_file(), "{} points at {}", path.display(), schema.display());
        assert!(rest.starts_with("# "), "{} begins without a comment", path.display());
    }
}

#[test]
fn every_sweep_loads_with_the_scenario_that_it_varies() {
    let validator = jsonschema::validator_for(&sweep_schema()).unwrap();
    let folder = repository().join("scenarios/sweeps");
    let files: Vec<PathBuf> = std::fs::read_dir(&folder).unwrap().map(|entry| entry.unwrap().path()).collect();
    assert!(!files.is_empty() && files.iter().all(|path| is_sweep(path)), "{files:?}");
    for path in files {
        let request = load_sweep(&path).unwrap_or_else(|e| panic!("{e}"));
        assert!(!request.description.is_empty(), "{} has no description", path.display());
        for point in request.sweep.cover(100) {
            let overrides: Vec<Override> = request
                .sweep
                .settings(point)
                .iter()
                .map(|one| Override::new(&request.keys[one.key], &one.value).unwrap())
                .collect();
            Document::open(&request.scenario, None)
                .and_then(|document| document.scenario(&overrides))
                .unwrap_or_else(|e| panic!("{e}"));
        }
        assert!(validator.is_valid(&as_json(&read(&path))), "{}", path.display());
    }
}

#[test]
fn the_embedded_demo_needs_no_folder() {
    let demo = embedded_demo();
    assert_eq!(demo.iter().map(|(name, _)| *name).collect::<Vec<_>>(), ["jerk.toml", "snap.toml"]);
    for (name, text) in demo {
        let embedded = parse(name, text, None).unwrap_or_else(|e| panic!("{e}")).scenario;
        let on_disk = load(&repository().join("scenarios/demo").join(name)).unwrap().scenario;
        let nowhere =
            |scenario| servobench_scenario::Scenario { path: None, root: None, made_of: Vec::new(), ..scenario };
        let contents = |scenario: &servobench_scenario::Scenario| -> Vec<_> {
            scenario.made_of.iter().map(|file| (file.role, file.sha256.clone())).collect()
        };
        assert_eq!(contents(&embedded), contents(&on_disk), "{name}");
        assert_eq!(nowhere(embedded), nowhere(on_disk), "{name}");
    }
}

/// Each model replaces that of a scenario that has the others.
#[test]
fn every_model_is_complete_and_says_where_its_values_come_from() {
    let models = embedded_models();
    assert!(models.len() >= 10, "{models:?}");
    for (path, text) in models {
        assert!(text.starts_with("# ") && text.contains("\nsource = \""), "{path} says no source");
        let (folder, file) = path.split_once('/').unwrap();
        let name = file.strip_suffix(".toml").unwrap();
        let (mut axis, mut motor, mut drive) =
            ("model = \"ball-screw\"", "model = \"wittenstein-premo-1f\"", "model = \"servo-16khz\"");
        let own = format!("model = \"{name}\"");
        match folder {
            "axes" => axis = &own,
            "motors" => motor = &own,
            "drives" => drive = &own,
            other => panic!("{other} holds no models"),
        }
        if ["axes/linear-slide.toml", "motors/siemens-1fn3900-4wb0.toml"].contains(&path) {
            (axis, motor) = ("model = \"linear-slide\"", "model = \"siemens-1fn3900-4wb0\"");
        }
        // An ideal source moves along the line, and takes volts from the drive of the same bench.
        if ["axes/lambrechts.toml", "axes/emps.toml", "motors/emps.toml", "drives/emps.toml"].contains(&path) {
            motor = "model = \"emps\"";
            axis = if folder == "axes" { &own } else { "model = \"emps\"" };
        }
        let text = format!("[run]\nbase_rate = \"16 kHz\"\n[axis]\n{axis}\n[motor]\n{motor}\n[drive]\n{drive}\n");
        let loaded = parse(path, &text, None).unwrap_or_else(|e| panic!("{path}: {e}"));
        let unused = loaded.warnings.iter().filter(|warning| !warning.message.contains("current loop is not used"));
        assert_eq!(unused.count(), 0, "{path}: {:?}", loaded.warnings);
    }
}

/// Oracle: the published numbers of the reference, computed by hand from the data sheets.
#[test]
fn peak_and_effective_values_of_the_motors() {
    let motor_and_limit = |name: &str| {
        let axis = if name.starts_with("siemens-1fn3") { "linear-slide" } else { "ball-screw" };
        let text = format!(
            "[run]\nbase_rate = \"16 kHz\"\n[axis]\nmodel = \"{axis}\"\n[motor]\nmodel = \"{name}\"\n[drive]\n\
             model = \"servo-16khz\"\n"
        );
        match parse("motor.toml", &text, None).unwrap().scenario.actuator {
            Actuator::Pmsm { motor, drive, .. } => (motor, drive.params.current_loop().unwrap().0.max_current),
            other => panic!("{other:?}"),
        }
    };
    let pmsm = |name| motor_and_limit(name).0;
    let torque_constant = |name| pmsm(name).effort_constant(0.0);
    let near = |a: f64, b: f64, digits: i32| (a - b).abs() <= 0.5 * 10_f64.powi(-digits);
    // Teknic: 4.64 Vpk/krpm line to line are 6.395 mVs and 0.0384 Nm/Apk.
    assert!(near(pmsm("teknic-m2310p").flux_linkage, 6.395e-3, 6));
    assert!(near(torque_constant("teknic-m2310p"), 0.0384, 4));
    // WITTENSTEIN: 31.1 Vrms/krpm and 0.51 Nm/Arms are printed side by side (10 % tolerance is usual; these agree to 1 %).
    let per_effective_ampere = torque_constant("wittenstein-premo-1f") * 2_f64.sqrt();
    assert!((per_effective_ampere / 0.51 - 1.0).abs() < 0.01, "{per_effective_ampere}");
    assert!(near(motor_and_limit("wittenstein-premo-1f").1, 18.81, 2));
    // HEIDENHAIN, of the Siemens linear motor: 145.4 V effective per phase at 2.66 m/s, 57 Hz (rounded down, 57.8 Hz);
    // 8100 N at 49.4 A effective.
    let (linear, max_current) = motor_and_limit("siemens-1fn3900-4wb0");
    let omega_e = linear.electrical_ratio * 2.66;
    assert!(near(omega_e * linear.flux_linkage / 2_f64.sqrt(), 145.4, 1), "{}", linear.flux_linkage);
    assert!((57.0..58.0).contains(&(omega_e / (2.0 * std::f64::consts::PI))), "{omega_e}");
    assert!(near(linear.effort_constant(0.0) * max_current, 8100.0, 2));
    // Modelica: 112.3 V effective per phase at 50 Hz.
    let back_emf = pmsm("msl-sm-permanent-magnet").flux_linkage * 2.0 * std::f64::consts::PI * 50.0 / 2_f64.sqrt();
    assert!(near(back_emf, 112.3, 6), "{back_emf}");
    assert!(near(pmsm("msl-sm-permanent-magnet").inductance.d * 100.0 * std::f64::consts::PI, 0.4, 9));
}

/// Oracle: the published modes, from `√(c/m)/2π` and `√(c·(1/m1 + 1/m2))/2π`.
#[test]
fn modes_of_the_published_axes() {
    let modes = |file: &str| {
        let scenario = load(&repository().join("scenarios").join(file)).unwrap().scenario;
        let AxisMechanics::Bodies(chain) = scenario.axis.mechanics else { panic!("bodies") };
        let ([motor, load], [link]) = (chain.bodies(), chain.links()) else { panic!("two bodies") };
        let stiffness = link.stiffness;
        let hertz = |inverse: f64| (stiffness * inverse).sqrt() / std::f64::consts::TAU;
        (hertz(1.0 / load.inertia), hertz(1.0 / load.inertia + 1.0 / motor.inertia))
    };
    for (file, held, free) in [("lambrechts-snap.toml", 38.985, 47.746), ("two-mass.toml", 59.55, 84.22)] {
        let (own_held, own_free) = modes(file);
        assert!((own_held / held - 1.0).abs() < 1e-4 && (own_free / free - 1.0).abs() < 1e-4, "{own_held} {own_free}");
    }
}

#[test]
fn the_schemas_in_the_repository_are_those_of_the_program() {
    for (file, schema) in [("scenario", json_schema()), ("sweep", sweep_schema())] {
        let path = repository().join(format!("docs/{file}.schema.json"));
        if std::env::var_os(WRITE_DOCS).is_some() {
            std::fs::write(&path, serde_json::to_string_pretty(&schema).unwrap() + "\n").unwrap();
        }
        let written: Json = serde_json::from_str(&read(&path)).unwrap();
        assert!(written == schema, "{file}: run the tests of this crate with {WRITE_DOCS}=1");
    }
}

#[test]
fn the_schema_accepts_every_scenario_and_refuses_mistakes() {
    let validator = jsonschema::validator_for(&json_schema()).unwrap();
    for path in scenarios() {
        let scenario = as_json(&read(&path));
        let errors: Vec<_> = validator.iter_errors(&scenario).map(|e| format!("{} {e}", e.instance_path())).collect();
        assert_eq!(errors, [""; 0], "{}", path.display());
    }
    let right = as_json(&read(&repository().join("scenarios/feed-axis-move.toml")));
    for (pointer, wrong) in [
        ("/setpoint/velocity", json!(30)),
        ("/setpoint/order", json!(5)),
        ("/engine", json!("mujocco")),
        ("/program/0/move_to", json!("far")),
        ("/limits/settling_time", json!({ "most": "1 s" })),
        ("/run", json!({})),
        ("/drive", json!({ "colour": "red" })),
    ] {
        let mut scenario = right.clone();
        *scenario.pointer_mut(pointer).unwrap() = wrong;
        assert!(!validator.is_valid(&scenario), "{pointer}");
    }
}

/// The TOML text as JSON for the schema.
fn as_json(text: &str) -> Json {
    fn convert(value: &toml::Value) -> Json {
        match value {
            toml::Value::String(text) => json!(text),
            toml::Value::Integer(number) => json!(number),
            toml::Value::Float(number) => json!(number),
            toml::Value::Boolean(value) => json!(value),
            toml::Value::Datetime(date) => json!(date.to_string()),
            toml::Value::Array(items) => items.iter().map(convert).collect(),
            toml::Value::Table(table) => table.iter().map(|(key, value)| (key.clone(), convert(value))).collect(),
        }
    }
    convert(&toml::Value::Table(text.parse().unwrap()))
}

/// The first is a whole scenario, the others are parts of one with its axis and drive.
#[test]
fn the_examples_of_the_reference_load() {
    let text = read(&repository().join("docs/scenario.md"));
    let examples: Vec<_> = text.split("```toml\n").skip(1).filter_map(|rest| rest.split("```").next()).collect();
    let [whole, moves, bus, calls] = examples.as_slice() else { panic!("{} examples", examples.len()) };
    let (axis, _) = whole.split_once("[[program]]\n").unwrap();
    let axis = axis.replace("feedforward = { velocity = true, effort = \"rigid\" }\n", "");
    let long = axis.replace("[run]\n", "[run]\nduration = \"4 s\"\n");
    for example in
        [(*whole).to_owned(), format!("{axis}{moves}"), format!("{axis}{bus}"), format!("{long}{bus}{calls}")]
    {
        let loaded = parse("example.toml", &example, None).unwrap_or_else(|e| panic!("{e}\n{example}"));
        assert_eq!(loaded.warnings, [], "{example}");
    }
}

const BEGIN: &str = "<!-- generated: keys -->\n";
const END: &str = "<!-- end of generated keys -->\n";

#[test]
fn the_references_list_every_key() {
    let (scenario, sweep) = (json_schema(), sweep_schema());
    let (mut of_scenarios, mut of_sweeps) = (String::new(), String::new());
    describe("", &scenario, &mut of_scenarios);
    describe_conditions(&scenario, &mut of_scenarios);
    describe_blocks(&scenario, &mut of_scenarios);
    describe_channels(&scenario, &mut of_scenarios);
    describe("", &sweep, &mut of_sweeps);
    for (file, tables) in [("scenario", of_scenarios), ("sweep", of_sweeps)] {
        let path = repository().join(format!("docs/{file}.md"));
        let text = read(&path);
        let (before, rest) = text.split_once(BEGIN).unwrap();
        let (written, after) = rest.split_once(END).unwrap();
        if std::env::var_os(WRITE_DOCS).is_some() {
            std::fs::write(&path, format!("{before}{BEGIN}{tables}{END}{after}")).unwrap();
        } else {
            assert!(written == tables, "{file}: run the tests of this crate with {WRITE_DOCS}=1");
        }
    }
}

/// The tables of the schema as Markdown, each before those inside it.
fn describe(path: &str, table: &Json, out: &mut String) {
    let is_array = table["type"] == "array";
    // A table and a list of tables have the same description.
    let one = &table["anyOf"][0];
    let object = if is_array { &table["items"] } else { one.as_object().map_or(table, |_| one) };
    let in_order = object["x-order"].as_array().unwrap().iter().map(|key| key.as_str().unwrap());
    let properties: Vec<(&str, &Json)> = in_order.map(|key| (key, &object["properties"][key])).collect();
    let title = match (path, is_array) {
        ("", _) => "Top level".to_owned(),
        (_, true) => format!("`[[{path}]]`"),
        (_, false) if one.is_object() => format!("`[{path}]` or `[[{path}]]`"),
        (_, false) => format!("`[{path}]`"),
    };
    let text = |value: &Json| value["description"].as_str().unwrap().to_owned();
    let _ = write!(
        out,
        "\n### {title}\n\n{}\n\n| key | value | meaning |\n|---|---|---|\n",
        text(if one.is_object() { table } else { object })
    );
    let is_table = |value: &Json| {
        [value, &value["items"], &value["anyOf"][0]].into_iter().any(|table| table["properties"].is_object())
    };
    for (key, value) in &properties {
        if !is_table(value) {
            let _ = writeln!(out, "| `{key}` | {} | {} |", kind(value), text(value));
        }
    }
    for (key, value) in properties {
        if is_table(value) {
            let below = if path.is_empty() { key.to_owned() } else { format!("{path}.{key}") };
            describe(&below, value, out);
        }
    }
}

/// The meaning of "condition", as Markdown.
fn describe_conditions(schema: &Json, out: &mut String) {
    let condition = &schema["properties"]["call"]["items"]["properties"]["start"]["anyOf"][1];
    let _ = write!(
        out,
        "\n### Conditions\n\n{} `\"first.Done\"` is short for `{{ after = \"first.Done\" }}`.\n\n| key | value | meaning |\n\
         |---|---|---|\n",
        condition["description"].as_str().unwrap()
    );
    for key in condition["x-order"].as_array().unwrap().iter().map(|key| key.as_str().unwrap()) {
        let value = &condition["properties"][key];
        let _ = writeln!(out, "| `{key}` | {} | {} |", kind(value), value["description"].as_str().unwrap());
    }
}

/// Inputs and outputs of the function blocks, as Markdown.
fn describe_blocks(schema: &Json, out: &mut String) {
    let choices = &schema["properties"]["call"]["items"]["properties"]["block"]["oneOf"];
    let _ = write!(
        out,
        "\n### Blocks\n\nFunction blocks for `call.block`. `start` and `stop` set `Execute` or `Enable`; conditions can name the \
         outputs.\n\n| block | function | inputs | outputs |\n|---|---|---|---|\n"
    );
    for choice in choices.as_array().unwrap() {
        let list = |key: &str| {
            let all = choice[key].as_array().unwrap().iter().map(|one| format!("`{}`", one.as_str().unwrap()));
            all.collect::<Vec<_>>().join(", ")
        };
        let inputs = [format!("`{}`", choice["x-trigger"].as_str().unwrap()), list("x-inputs")];
        let inputs: Vec<_> = inputs.into_iter().filter(|part| !part.is_empty()).collect();
        let (name, meaning) = (choice["const"].as_str().unwrap(), choice["description"].as_str().unwrap());
        let _ = writeln!(out, "| `{name}` | {meaning} | {} | {} |", inputs.join("; "), list("x-outputs"));
    }
}

/// Recordable channels, as Markdown.
fn describe_channels(schema: &Json, out: &mut String) {
    let choices = &schema["properties"]["record"]["properties"]["channels"]["anyOf"][0]["anyOf"][0]["oneOf"];
    let _ = write!(
        out,
        "\n### Channels\n\nChannels for `record.channels`. U is the unit of the axis, m or rad; E that of the motor's torque \
         or force, N m or N; F that of the load's. Currents and voltages are amplitudes.\n\n| channel | unit | meaning |\n\
         |---|---|---|\n"
    );
    for choice in choices.as_array().unwrap() {
        let (unit, meaning) =
            choice["description"].as_str().unwrap().strip_prefix('[').and_then(|rest| rest.split_once("] ")).unwrap();
        let _ = writeln!(out, "| `{}` | {unit} | {meaning} |", choice["const"].as_str().unwrap());
    }
}

/// Values that a key may have, as Markdown.
fn kind(value: &Json) -> String {
    value_of_schema(value).replace("a condition", "a [condition](#conditions)")
}
