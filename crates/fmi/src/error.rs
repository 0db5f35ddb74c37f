//! Why a file cannot be used as an FMU.
use crate::slave::SlaveError;
use servobench_files::{named, quoted, with_short_quotes};
use std::io;
use std::path::PathBuf;
use thiserror::Error;

/// Why a file cannot be used as an FMU.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum FmuError {
    /// The operating system refuses.
    #[error("`{}` cannot be {what}: {source}", path.display())]
    File {
        /// File or folder.
        path: PathBuf,
        /// What was tried: read, written, made.
        what: &'static str,
        /// Its reason.
        source: io::Error,
    },
    /// The archive is broken, hostile, or something else than an FMU.
    #[error("`{}` cannot be used as an FMU: {problem}", path.display())]
    Archive {
        /// The file.
        path: PathBuf,
        /// What is wrong with it.
        problem: ArchiveProblem,
    },
    /// The model description is not what the standard says.
    #[error("{file}:{line}:{column}: {problem}")]
    Description {
        /// File as messages name it.
        file: String,
        /// Line, from 1.
        line: u32,
        /// Column in characters, from 1.
        column: u32,
        /// What is wrong there.
        problem: Box<DescriptionProblem>,
    },
    /// Its library cannot be used.
    #[error("the FMU `{}` cannot be loaded: {problem}", path.display())]
    Library {
        /// The FMU.
        path: PathBuf,
        /// What is wrong.
        problem: LibraryProblem,
    },
    /// It has not what it is wired or started with.
    #[error("{what} `{name}` of the FMU `{}`: {problem}", path.display())]
    Setup {
        /// The FMU.
        path: PathBuf,
        /// Input, output or start value.
        what: &'static str,
        /// Name of the variable.
        name: String,
        /// What is wrong.
        problem: String,
    },
    /// It failed while it was initialised.
    #[error("the FMU `{}` cannot be initialised: {source}", path.display())]
    Initialise {
        /// The FMU.
        path: PathBuf,
        /// What it did.
        source: SlaveError,
    },
}

impl FmuError {
    /// Whether the machine had too little of something, and the FMU may be right: descriptors, memory, room on a disk.
    #[must_use]
    pub fn is_shortage(&self) -> bool {
        matches!(self, Self::File { source, .. } if servobench_files::is_shortage(source))
    }
}

/// What is wrong with a library.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum LibraryProblem {
    /// There is none for this machine.
    #[error("it has no `{wanted}`; it has {}{}", listed(platforms), if *has_sources { " and sources, which can be compiled into it with other tools" } else { "" })]
    NoBinary {
        /// Where it should be.
        wanted: String,
        /// Platforms that there is a folder for.
        platforms: Vec<String>,
        /// Whether there are sources.
        has_sources: bool,
    },
    /// The operating system refuses it.
    #[error("its library cannot be opened ({why}){hint}")]
    Open {
        /// Its reason.
        why: String,
        /// What to do, if that is known.
        hint: &'static str,
    },
    /// It lacks a function that the description promises or the standard demands.
    #[error("its library has no function `{symbol}`")]
    NoFunction {
        /// Its name.
        symbol: &'static str,
    },
    /// It is for something else.
    #[error("its library says `{said}` when asked with `{call}`, expected `{wanted}`")]
    Says {
        /// The question.
        call: &'static str,
        /// Its answer.
        said: String,
        /// The right one.
        wanted: &'static str,
    },
    /// It gives no instance.
    #[error("`{call}` gives no instance{}", if why.is_empty() { " and says nothing".to_owned() } else { format!(": {why}") })]
    Instantiate {
        /// The function.
        call: &'static str,
        /// The last that it logged.
        why: String,
    },
}

fn listed(platforms: &[String]) -> String {
    if platforms.is_empty() { "no libraries at all".into() } else { format!("those for {}", platforms.join(", ")) }
}

/// What is wrong with an archive.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum ArchiveProblem {
    /// It cannot be read.
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
    /// A name would be written outside the folder, or is no name of a file.
    #[error("the name `{entry}` in it {why}; nothing was unpacked")]
    Name {
        /// Name in the archive, control characters escaped.
        entry: String,
        /// What is wrong with the name.
        why: &'static str,
    },
    /// Something that is neither a file nor a folder.
    #[error("`{entry}` in it is {what}; only files and folders are unpacked")]
    Kind {
        /// Name in the archive.
        entry: String,
        /// What it is.
        what: &'static str,
    },
    /// More than a limit allows.
    #[error(
        "{what} is {value}, at most {most} is unpacked, which no FMU needs; pack it anew without what does not belong to it"
    )]
    Limit {
        /// What is limited.
        what: String,
        /// What it is.
        value: u64,
        /// The limit.
        most: u64,
    },
    /// There is no model description.
    #[error("it has no `modelDescription.xml` at its top level{hint}")]
    NoDescription {
        /// Where there is one, if anywhere.
        hint: String,
    },
    /// It is a system structure and parameterisation package.
    #[error(
        "it is an SSP package (`{entry}`), a system of components, which is not supported; give one FMU of its `resources/`"
    )]
    Ssp {
        /// What says so.
        entry: String,
    },
}

/// What is wrong at a place of a model description.
#[derive(Debug, Clone, PartialEq, Error)]
#[non_exhaustive]
pub enum DescriptionProblem {
    /// It is no XML.
    #[error("no well-formed XML: {}", with_short_quotes(.0))]
    Xml(String),
    /// More than a limit allows.
    #[error("{what} is more than {most}, which no model description needs")]
    Limit {
        /// What is limited.
        what: &'static str,
        /// The limit.
        most: usize,
    },
    /// Another element than the one that has to be here.
    #[error("the element is `<{}>`, expected {expected}", named(.found))]
    Element {
        /// Its name.
        found: String,
        /// What may be here.
        expected: String,
    },
    /// An element that has to be here is not.
    #[error("`<{}>` has no element {expected}", named(.parent))]
    NoElement {
        /// The element that lacks it.
        parent: String,
        /// What has to be here.
        expected: &'static str,
    },
    /// An attribute that has to be here is not.
    #[error("`<{}>` has no attribute `{attribute}`", named(.element))]
    NoAttribute {
        /// The element that lacks it.
        element: String,
        /// Its name.
        attribute: &'static str,
    },
    /// An attribute has another value than it may have.
    #[error("`{attribute}=\"{}\"` of `<{}>`: expected {expected}", quoted(.value), named(.element))]
    Attribute {
        /// The element.
        element: String,
        /// Its attribute.
        attribute: &'static str,
        /// Its value.
        value: String,
        /// What it may be.
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
        /// What has it already.
        first: String,
    },
    /// Causality, variability and initial of a variable do not go together.
    #[error("variable `{}`: {found} {} allowed; the standard has {allowed}", named(.variable), if found.contains(',') { "are not" } else { "is not" })]
    Combination {
        /// Its name.
        variable: String,
        /// What it has.
        found: String,
        /// What would be right.
        allowed: String,
    },
    /// Something that is not supported.
    #[error("{what} is not supported; {help}")]
    Unsupported {
        /// What it is.
        what: String,
        /// What to do.
        help: &'static str,
    },
}
