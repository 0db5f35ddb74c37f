//! `servobench models`: the built-in models.
use crate::args::ModelsArgs;
use crate::console::{print, print_json, style};
use crate::error::CliError;
use crate::exit::Exit;
use serde_json::{Map, Value, json};
use servobench_files::nearest;
use servobench_report::{Style, two_columns};
use servobench_scenario::{embedded_models, written_values};

/// Keys that the list leaves out: friction, damping and origin.
const LEFT_OUT: [&str; 7] = ["source", "viscous", "coulomb", "static", "stribeck_velocity", "damping", "bias"];

/// A built-in model.
struct Model {
    /// Its folder: `axes`, `drives`, `motors`.
    kind: &'static str,
    name: &'static str,
    text: &'static str,
    values: Vec<(String, String)>,
}

/// Lists the built-in models, or prints one.
pub(crate) fn models(args: &ModelsArgs) -> Result<Exit, CliError> {
    let all = all();
    match &args.name {
        Some(name) => print(named(&all, name)?.text)?,
        None if args.json => {
            print_json(&(serde_json::to_string_pretty(&as_json(&all)).map_err(CliError::Schema)? + "\n"))?;
        }
        None => print(&listed(&all, style()))?,
    }
    Ok(Exit::Passed)
}

fn all() -> Vec<Model> {
    let split = |(path, text): (&'static str, &'static str)| {
        let (kind, name) = path.trim_end_matches(".toml").split_once('/')?;
        Some(Model { kind, name, text, values: written_values(text) })
    };
    embedded_models().into_iter().filter_map(split).collect()
}

/// The models by kind, with values and sources.
fn listed(all: &[Model], style: Style) -> String {
    let mut text = String::new();
    for kind in all.chunk_by(|one, other| one.kind == other.kind) {
        let rows: Vec<_> = kind.iter().map(|model| (model.name, model.summary())).collect();
        text += &two_columns(kind[0].kind, &rows, style);
        text.push('\n');
    }
    text + "servobench models NAME prints one of them.\n"
}

fn as_json(all: &[Model]) -> Value {
    let each = all.iter().map(|model| {
        let is_value = |(key, _): &&(String, String)| key != "source";
        let values: Map<String, Value> =
            model.values.iter().filter(is_value).map(|(key, value)| (key.clone(), json!(value))).collect();
        json!({ "kind": model.kind, "name": model.name, "source": model.source(), "values": values })
    });
    each.collect()
}

/// The model called `name`: `teknic-m2310p`, `motors/teknic-m2310p`, or its path in the repository.
fn named<'a>(all: &'a [Model], name: &str) -> Result<&'a Model, CliError> {
    let asked = name.trim_start_matches("models/").trim_end_matches(".toml");
    let full = |model: &Model| format!("{}/{}", model.kind, model.name);
    let found: Vec<&Model> = all.iter().filter(|model| asked == model.name || asked == full(model)).collect();
    if let [one] = found.as_slice() {
        return Ok(one);
    }
    if !found.is_empty() {
        let names = found.iter().map(|model| full(model)).collect();
        return Err(CliError::Several { what: "built-in models", name: name.to_owned(), names });
    }
    let help = match nearest(asked, all.iter().map(|model| model.name)) {
        Some(near) => format!("did you mean `{near}`?"),
        None => "`servobench models` lists them".to_owned(),
    };
    Err(CliError::NoSuch { what: "built-in model", name: name.to_owned(), help })
}

impl Model {
    /// Source of its values.
    fn source(&self) -> &str {
        self.values.iter().find(|(key, _)| key == "source").map_or("", |(_, text)| text)
    }

    /// Its values in a line, and its source in another.
    fn summary(&self) -> String {
        let is_shown = |key: &str| !LEFT_OUT.contains(&key.rsplit('.').next().unwrap_or(key));
        let shown = self.values.iter().filter(|(key, _)| is_shown(key)).map(|(key, value)| format!("{key} {value}"));
        format!("{}\n{}", shown.collect::<Vec<_>>().join(", "), self.source())
    }
}
