//! `modelDescription.xml`: identity and variables of an FMU, in one form for both versions.
//!
//! Contradictions within the file or with the standard that could make a simulation wrong are errors with their line. Omissions and
//! superfluous parts with only one possible meaning are accepted and listed in [`ModelDescription::remarks`]: files of many tools have
//! them.
//!
//! Source: FMI 2.0.5, §2.2 and §4.3.1; FMI 3.0.2, §2.4 and §4.4.

mod bounds;
mod clock;
mod combination;
mod declared;
mod element;
mod interface;
mod named;
mod numeric;
mod start;
mod structure;
mod unit;
mod units;
mod variable;
mod variables;
mod write;
mod xml;

pub(crate) use bounds::MOST_BYTES;
pub use clock::{IntervalVariability, Ticks};
pub use declared::{Enumeration, Item};
pub use interface::{CoSimulation, DefaultExperiment, LogCategory};
pub use structure::{DependencyKind, ModelStructure, Unknown};
pub use unit::{BaseUnit, DisplayUnit, Exponents, Unit};
pub use variable::{Alias, Causality, DataType, Dimension, Initial, Values, Variability, Variable};

use crate::error::{DescriptionProblem, FmuError};
use declared::Declared;
use element::Element;
use roxmltree::{Document, ParsingOptions};
use servobench_files::quoted;
use std::collections::HashMap;
use units::Units;
use variables::Variables;

servobench_config::choices! {
    /// Version of the standard.
    pub enum Version default Three {
        /// FMI 2.0
        Two = "2",
        /// FMI 3.0
        Three = "3",
    }
}

/// Model description of an FMU.
#[derive(Debug, Clone, PartialEq)]
pub struct ModelDescription {
    /// Version of the standard.
    pub version: Version,
    /// The version as the file has it.
    pub fmi_version: String,
    /// Name of the model.
    pub model_name: String,
    /// Token that ties library and description together: `guid` of FMI 2.0, `instantiationToken` of FMI 3.0.
    pub instantiation_token: String,
    /// Description of the model; empty if the file has none, like all of the following.
    pub description: String,
    /// Author of the model.
    pub author: String,
    /// Version of the model.
    pub model_version: String,
    /// Copyright.
    pub copyright: String,
    /// Licence.
    pub license: String,
    /// Tool that made the FMU.
    pub generation_tool: String,
    /// Date and time of generation.
    pub generation_date_and_time: String,
    /// Capabilities in co-simulation.
    pub co_simulation: CoSimulation,
    /// Suggested settings of a simulation.
    pub default_experiment: DefaultExperiment,
    /// Categories of its log.
    pub log_categories: Vec<LogCategory>,
    /// Units of its variables.
    pub units: Vec<Unit>,
    /// Enumerations of its variables.
    pub enumerations: Vec<Enumeration>,
    /// Variables in the order of the file.
    pub variables: Vec<Variable>,
    /// Dependencies between variables.
    pub structure: ModelStructure,
    /// Harmless departures from the standard.
    pub remarks: Vec<String>,
    /// Position of each variable by its names.
    positions: HashMap<String, usize>,
}

impl ModelDescription {
    /// Reads the text of a model description; messages name the file `file`.
    ///
    /// # Errors
    /// [`FmuError::Description`], with the place.
    pub fn read(text: &str, file: &str) -> Result<Self, FmuError> {
        let at = |line, column, problem| FmuError::Description {
            file: file.to_owned(),
            line,
            column,
            problem: Box::new(problem),
        };
        // A byte order mark is not part of the XML.
        let text = text.trim_start_matches('\u{feff}');
        bounds::hold(text).map_err(|(byte, problem)| {
            let (line, column) = place(text, byte);
            at(line, column, problem)
        })?;
        let options = ParsingOptions { allow_dtd: false, nodes_limit: bounds::MOST_NODES };
        let document = Document::parse_with_options(text, options).map_err(|error| {
            let place = error.pos();
            at(place.row, place.col, DescriptionProblem::Xml(error.to_string()))
        })?;
        Self::of(Element::root(&document, file))
    }

    fn of(root: Element) -> Result<Self, FmuError> {
        if root.name() != "fmiModelDescription" {
            let found = root.name().to_owned();
            return Err(root.error(DescriptionProblem::Element { found, expected: "`<fmiModelDescription>`".into() }));
        }
        let version = version(root)?;
        let co_simulation = interface::co_simulation(root)?;
        let mut remarks = vec![];
        let mut units = Units::read(root)?;
        let declared = Declared::read(root, version, &mut units, &mut remarks)?;
        let Variables { all: variables, positions } =
            Variables::read(root, version, &mut units, &declared, &mut remarks)?;
        let structure = ModelStructure::read(root, version, &variables)?;
        let token = match version {
            Version::Two => root.required("guid")?,
            Version::Three => root.required("instantiationToken")?,
        };
        Ok(Self {
            version,
            fmi_version: root.text_or_empty("fmiVersion"),
            model_name: root.required("modelName")?.to_owned(),
            instantiation_token: token.to_owned(),
            description: root.text_or_empty("description"),
            author: root.text_or_empty("author"),
            model_version: root.text_or_empty("version"),
            copyright: root.text_or_empty("copyright"),
            license: root.text_or_empty("license"),
            generation_tool: root.text_or_empty("generationTool"),
            generation_date_and_time: root.text_or_empty("generationDateAndTime"),
            co_simulation,
            default_experiment: DefaultExperiment::read(root)?,
            log_categories: log_categories(root)?,
            units: units.all,
            enumerations: declared.enumerations,
            variables,
            structure,
            remarks,
            positions,
        })
    }

    /// Position of the variable of this name, which may be an alias.
    #[must_use]
    pub fn position(&self, name: &str) -> Option<usize> {
        self.positions.get(name).copied()
    }

    /// The variable of this name, which may be an alias.
    #[must_use]
    pub fn variable(&self, name: &str) -> Option<&Variable> {
        self.variables.get(self.position(name)?)
    }

    /// The unit of a variable.
    #[must_use]
    pub fn unit(&self, variable: &Variable) -> Option<&Unit> {
        self.units.get(variable.unit?)
    }

    /// The enumeration of a variable.
    #[must_use]
    pub fn enumeration(&self, variable: &Variable) -> Option<&Enumeration> {
        self.enumerations.get(variable.enumeration?)
    }

    /// Extents of a variable while structural parameters keep their start values; none for a scalar.
    #[must_use]
    pub fn shape(&self, variable: &Variable) -> Vec<u64> {
        let extent = |dimension: &Dimension| match dimension {
            Dimension::Fixed(extent) => *extent,
            Dimension::Structural(at) => match &self.variables[*at].start {
                Some(Values::Integer(start)) => start.first().and_then(|&first| first.try_into().ok()).unwrap_or(0),
                _ => 0,
            },
        };
        variable.dimensions.iter().map(extent).collect()
    }
}

/// Line and column of a byte, from 1.
fn place(text: &str, byte: usize) -> (u32, u32) {
    let before = &text[..byte];
    let column = before.chars().rev().take_while(|c| *c != '\n').count() + 1;
    let line = before.bytes().filter(|byte| *byte == b'\n').count() + 1;
    (u32::try_from(line).unwrap_or(u32::MAX), u32::try_from(column).unwrap_or(u32::MAX))
}

/// Version of the standard; an error if not 2.0 or 3.0.
fn version(root: Element) -> Result<Version, FmuError> {
    let text = root.required("fmiVersion")?;
    let unsupported = |what: &str| {
        let what = format!("{what} (`fmiVersion=\"{}\"`)", quoted(text));
        let help = "export the model for FMI 2.0 or 3.0, co-simulation";
        root.error_at("fmiVersion", DescriptionProblem::Unsupported { what, help })
    };
    let is_patch = |rest: &str| rest.strip_prefix('.').is_some_and(|patch| patch.parse::<u32>().is_ok());
    match text.split_at_checked(3) {
        Some(("2.0", rest)) if rest.is_empty() || is_patch(rest) => Ok(Version::Two),
        Some(("3.0", rest)) if rest.is_empty() || is_patch(rest) => Ok(Version::Three),
        Some(("1.0", _)) => Err(unsupported("FMI 1.0")),
        _ => Err(unsupported("this version of FMI")),
    }
}

fn log_categories(root: Element) -> Result<Vec<LogCategory>, FmuError> {
    let category = |element: Element| {
        let name = element.required("name")?.to_owned();
        Ok(LogCategory { name, description: element.text_or_empty("description") })
    };
    root.grandchildren("LogCategories").filter(|child| child.name() == "Category").map(category).collect()
}
