//! The name of the axis, and the names of signals with it in front.
use crate::diagnostic::Report;
use crate::field::{Field, key, written};
use crate::tree::{Node, Table};
use serde_json::{Value as Json, json};
use servobench_base::AxisName;
use servobench_files::{quoted, suggestion};
use servobench_metrics::Name;
use servobench_signals::Signal;

impl Field for AxisName {
    fn decode(path: &str, node: &Node, (): &(), report: &mut Report) -> Option<Self> {
        let key = key(path);
        let Some(text) = node.value.as_text() else {
            report.error(node.span, format!("`{key}` must be a string, got {}", written(node)), "");
            return None;
        };
        match text.parse() {
            Ok(name) if is_taken(name) => {
                let message =
                    format!("`{name}` cannot name an axis: names of metrics or signals could be read in two ways");
                report.error(node.span, message, "give another name");
                None
            }
            Ok(name) => Some(name),
            Err(error) => {
                report.error(node.span, format!("`{key}`: {error}"), "write a name like \"x\"");
                None
            }
        }
    }

    fn schema((): &()) -> Json {
        json!({ "type": "string", "pattern": format!("^{PATTERN}$"), "examples": ["x"] })
    }
}

/// An axis name as a regular expression.
pub(crate) const PATTERN: &str = "[A-Za-z0-9_-]{1,32}";

/// True of a metric, since `[limits.x]` has the limits of the axis `x`, and where a signal with this name in front has the name of another
/// signal.
fn is_taken(name: AxisName) -> bool {
    let is_signal = |text: &str| text.parse::<Signal>().is_ok();
    let is_metric = name.as_str().parse::<Name>().is_ok();
    is_metric || Signal::ALL.iter().any(|signal| name.strip(signal.name()).is_some_and(is_signal))
}

/// The name of the axis in `root`, as far as it is right.
pub(crate) fn axis_name(root: &Table) -> Option<AxisName> {
    let text = root.get("axis")?.value.as_table()?.get("name")?.value.as_text()?;
    text.parse().ok().filter(|name| !is_taken(*name))
}

/// `text` without the name of `axis` in front: `load.position` of `x.load.position` on the axis `x`.
pub(crate) fn within(text: &str, axis: Option<AxisName>) -> &str {
    axis.and_then(|axis| axis.strip(text)).unwrap_or(text)
}

/// Help for `text`, which is not among `names` on `axis`: the axes that there are where it begins with the name of another one, or the name
/// that it probably means.
pub(crate) fn suggestion_on<'a>(
    text: &str,
    axis: Option<AxisName>,
    names: impl IntoIterator<Item = &'a str> + Clone,
) -> String {
    match text.split_once('.') {
        Some((other, name)) if names.clone().into_iter().any(|known| known == name) => no_axis(other, axis),
        _ => suggestion(within(text, axis), names),
    }
}

/// Help for the name `other` of an axis, which is not that of `axis`.
pub(crate) fn no_axis(other: &str, axis: Option<AxisName>) -> String {
    let other = quoted(other);
    match axis {
        Some(axis) => format!("unknown axis `{other}`; the axes are: `{axis}`"),
        None => format!("unknown axis `{other}`; the axis gets a name by `name` in `[axis]`"),
    }
}
