//! Arguments of the commands to begin with: `init`, `examples`, `explain`, `models`.
use super::{choice::plain, file};
use crate::ready::templates;
use clap::Args;
use clap::builder::{PossibleValue, PossibleValuesParser};
use std::path::PathBuf;

pub(super) const AFTER_INIT: &str = "Each value has a comment: its meaning, its unit, and where to find it. Replace the values by those of \
                                     your machine; servobench explain KEY says more about a key.\n\n\
                                     Examples:\n  \
                                     servobench init\n  \
                                     servobench init gantry.toml --from belt\n  \
                                     servobench init - --from plc | servobench run -";

pub(super) const AFTER_EXAMPLES: &str = "A scenario is written with the tables, models and scenarios that it names; existing files are not \
                                         overwritten.\n\n\
                                         Examples:\n  \
                                         servobench examples\n  \
                                         servobench examples figure-3b\n  \
                                         servobench examples sweeps/jerk-or-snap --to trial";

pub(super) const AFTER_EXPLAIN: &str = "Of a key the end of its path is enough; numbers of list items may be left out.\n\n\
                                        Examples:\n  \
                                        servobench explain axis.motor_side.mass\n  \
                                        servobench explain program.0.move_to\n  \
                                        servobench explain drive.velocity\n  \
                                        servobench explain settling_time\n  \
                                        servobench explain load.position\n  \
                                        servobench explain MC_MoveAbsolute\n  \
                                        servobench explain 4";

pub(super) const AFTER_MODELS: &str = "A scenario names a model by the key model of [axis], [motor] or [drive]; its other keys override \
                                       values of the model.\n\n\
                                       Examples:\n  \
                                       servobench models\n  \
                                       servobench models teknic-m2310p\n  \
                                       servobench models drives/emps";

#[derive(Debug, Args)]
pub(crate) struct InitArgs {
    /// The scenario file to write, or - for standard output. An existing file is not overwritten.
    #[arg(default_value = "axis.toml")]
    pub(crate) file: PathBuf,
    /// The kind of axis.
    #[arg(long, value_name = "KIND", value_parser = template(), default_value = "screw")]
    pub(crate) from: String,
}

#[derive(Debug, Args)]
pub(crate) struct ExamplesArgs {
    /// The scenario to write, as the list names it; without it the list is printed.
    pub(crate) name: Option<String>,
    /// Write into this folder [default: the current folder].
    #[arg(long, value_name = "DIR", requires = "name", value_parser = file())]
    pub(crate) to: Option<PathBuf>,
}

#[derive(Debug, Args)]
pub(crate) struct ExplainArgs {
    /// A key, a table, a metric, a requirement, a signal, a function block or an exit code; without it they are listed.
    pub(crate) name: Option<String>,
}

#[derive(Debug, Args)]
pub(crate) struct ModelsArgs {
    /// The model to print; without it all are listed.
    pub(crate) name: Option<String>,
    /// List them as JSON.
    #[arg(long, conflicts_with = "name")]
    pub(crate) json: bool,
}

/// The templates by their names.
fn template() -> PossibleValuesParser {
    PossibleValuesParser::new(
        templates().map(|ready| PossibleValue::new(ready.name()).help(plain(&ready.description()))),
    )
}
