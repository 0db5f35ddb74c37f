//! Reasons why a file cannot be used as an FMU.
use crate::slave::SlaveError;
use servobench_files::{named, quoted, with_short_quotes};
use std::io;
use std::path::PathBuf;
use thiserror::Error;

/// Reason why a file cannot be used as an FMU.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum FmuError {
    /// The operating system refused.
    #[error("`{}` cannot be {what}: {source}", path.display())]
    File {
        /// File or folder.
        path: PathBuf,
        /// Attempted action: read, written, made.
        what: &'static str,
        /// Reason of the operating system.
        source: io::Error,
    },
    /// The archive is broken, hostile, or not an FMU.
    #[error("`{}` cannot be used as an FMU: {problem}", path.display())]
    Archive {
        /// The file.
        path: PathBuf,
        /// The mistake.
        problem: ArchiveProblem,
    },
    /// The model description violates the standard.
    #[error("{file}:{line}:{column}: {problem}")]
    Description {
        /// File as messages name it.
        file: String,
        /// Line, from 1.
        line: u32,
        /// Column in characters, from 1.
        column: u32,
        /// The mistake there.
        problem: Box<DescriptionProblem>,
    },
    /// The library cannot be used.
    #[error("the FMU `{}` cannot be loaded: {problem}", path.display())]
    Library {
        /// The FMU.
        path: PathBuf,
        /// The mistake.
        problem: LibraryProblem,
    },
    /// A wired or started variable does not fit the FMU.
    #[error("{what} `{name}` of the FMU `{}`: {problem}", path.display())]
    Setup {
        /// The FMU.
        path: PathBuf,
        /// Input, output or start value.
        what: &'static str,
        /// Name of the variable.
        name: String,
        /// The mistake.
        problem: String,
    },
    /// The FMU failed while it was initialised.
    #[error("the FMU `{}` cannot be initialised: {source}", path.display())]
    Initialise {
        /// The FMU.
        path: PathBuf,
        /// Its failure.
        source: SlaveError,
    },
}

impl FmuError {
    /// True if the machine lacked a resource and the FMU may be right: descriptors, memory, room on a disk.
    #[must_use]
    pub fn is_shortage(&self) -> bool {
        matches!(self, Self::File { source, .. } if servobench_files::is_shortage(source))
    }
}

/// Reason why a library cannot be used.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum LibraryProblem {
    /// No library for this machine.
    #[error("it has no `{wanted}`; it has {}{}", listed(platforms), if *has_sources { " and sources, which can be compiled into it with other tools" } else { "" })]
    NoBinary {
        /// Expected path.
        wanted: String,
        /// Platforms with a folder in the FMU.
        platforms: Vec<String>,
        /// True if the FMU has sources.
        has_sources: bool,
    },
    /// The operating system refused to open it.
    #[error("its library cannot be opened ({why}){hint}")]
    Open {
        /// Reason of the operating system.
        why: String,
        /// Remedy, if known.
        hint: &'static str,
    },
    /// A function that the description promises or the standard demands is missing.
    #[error("its library has no function `{symbol}`")]
    NoFunction {
        /// Its name.
        symbol: &'static str,
    },
    /// The library is for another version or platform.
    #[error("its library says `{said}` when asked with `{call}`, expected `{wanted}`")]
    Says {
        /// The function called.
        call: &'static str,
        /// Its answer.
        said: String,
        /// The right one.
        wanted: &'static str,
    },
    /// The library returned no instance.
    #[error("`{call}` gives no instance{}", if why.is_empty() { " and says nothing".to_owned() } else { format!(": {why}") })]
    Instantiate {
        /// The function.
        call: &'static str,
        /// The last message that it logged.
        why: String,
    },
}

fn listed(platforms: &[String]) -> String {
    if platforms.is_empty() { "no libraries at all".into() } else { format!("those for {}", platforms.join(", ")) }
}

/// Reason why an archive cannot be used.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum ArchiveProblem {
    /// The archive cannot be read.
    #[error("it is no readable zip archive ({}); an FMU is one, with `modelDescription.xml` in it", with_short_quotes(.0))]
    Zip(String),
    /// A file in it cannot be read.
    #[error("`{entry}` in it cannot be read ({why})")]
    Entry {
        /// Name in the archive.
        entry: String,
        /// The reason.
        why: String,
    },
    /// A name leads outside the folder, or is not a file name.
    #[error("the name `{entry}` in it {why}; nothing was unpacked")]
    Name {
        /// Name in the archive, control characters escaped.
        entry: String,
        /// The mistake in the name.
        why: &'static str,
    },
    /// An entry that is neither a file nor a folder.
    #[error("`{entry}` in it is {what}; only files and folders are unpacked")]
    Kind {
        /// Name in the archive.
        entry: String,
        /// Its kind.
        what: &'static str,
    },
    /// A limit is exceeded.
    #[error(
        "{what} is {value}, at most {most} is unpacked, which no FMU needs; pack it anew without what does not belong to it"
    )]
    Limit {
        /// The limited quantity.
        what: String,
        /// Its value.
        value: u64,
        /// The limit.
        most: u64,
    },
    /// The model description is missing.
    #[error("it has no `modelDescription.xml` at its top level{hint}")]
    NoDescription {
        /// Hint at one in a subfolder, if any.
        hint: String,
    },
    /// The archive is a system structure and parameterisation package.
    #[error(
        "it is an SSP package (`{entry}`), a system of components, which is not supported; give one FMU of its `resources/`"
    )]
    Ssp {
        /// Evidence of that.
        entry: String,
    },
}

/// Mistake at a place of a model description.
#[derive(Debug, Clone, PartialEq, Error)]
#[non_exhaustive]
pub enum DescriptionProblem {
    /// Not XML.
    #[error("no well-formed XML: {}", with_short_quotes(.0))]
    Xml(String),
    /// A limit is exceeded.
    #[error("{what} is more than {most}, which no model description needs")]
    Limit {
        /// The limited quantity.
        what: &'static str,
        /// The limit.
        most: usize,
    },
    /// An unexpected element.
    #[error("the element is `<{}>`, expected {expected}", named(.found))]
    Element {
        /// Its name.
        found: String,
        /// The elements allowed here.
        expected: String,
    },
    /// A required element is missing.
    #[error("`<{}>` has no element {expected}", named(.parent))]
    NoElement {
        /// The element that lacks it.
        parent: String,
        /// The required element.
        expected: &'static str,
    },
    /// A required attribute is missing.
    #[error("`<{}>` has no attribute `{attribute}`", named(.element))]
    NoAttribute {
        /// The element that lacks it.
        element: String,
        /// Its name.
        attribute: &'static str,
    },
    /// An attribute has a value that is not allowed.
    #[error("`{attribute}=\"{}\"` of `<{}>`: expected {expected}", quoted(.value), named(.element))]
    Attribute {
        /// The element.
        element: String,
        /// Its attribute.
        attribute: &'static str,
        /// Its value.
        value: String,
        /// The allowed values.
        expected: String,
    },
    /// Two things have the same name or reference.
    #[error("`{attribute}=\"{}\"` of `<{}>` stands for `{}` already", named(.value), named(.element), named(.first))]
    Twice {
        /// The element.
        element: String,
        /// Its attribute.
        attribute: &'static str,
        /// Its value.
        value: String,
        /// The first one with this value.
        first: String,
    },
    /// Causality, variability and initial of a variable do not go together.
    #[error("variable `{}`: {found} {} allowed; the standard has {allowed}", named(.variable), if found.contains(',') { "are not" } else { "is not" })]
    Combination {
        /// Its name.
        variable: String,
        /// The combination found.
        found: String,
        /// The allowed ones.
        allowed: String,
    },
    /// A feature that is not supported.
    #[error("{what} is not supported; {help}")]
    Unsupported {
        /// The feature.
        what: String,
        /// Remedy.
        help: &'static str,
    },
}
