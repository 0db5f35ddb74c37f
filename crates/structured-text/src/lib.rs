//! The generator of fourth order as code for a PLC: the function block `Profile4th` in Structured Text (IEC 61131-3), and `MC_MoveAbsolute`
//! on top of it.
//!
//! The text, `profile_4th.st`, is written by hand and reproduces `servobench_plcopen::generator` with the plan of
//! `servobench_motion::Profile::plan_sampled`: the same operations on LREAL in the same order, but for the roots by which a length is
//! estimated. An estimate only has to be close: the length is the smallest whole number for which a product reaches a bound, and that is
//! decided by the same operations on both sides. Change both sides together; `tests/outside/profile_4th_by_pyplcopen.py` compares them bit
//! for bit.
//!
//! # Rules of the text
//!
//! - One declaration a line, its meaning as a comment before the semicolon: [`Export`] parses them for memory, interface and dialects.
//! - Every loop is a FOR between constants: a call takes a bounded time.
//! - No arrays, and no functions but SQRT, ABS, MOD and the conversions between LREAL and LINT, which controllers with LREAL have. The
//!   result of a conversion is only a first try, so that it may round to either side.
//! - No division by zero, no conversion of a number outside the range of LINT.
//! - No input of a function or block has the name of a variable of its caller, and no variable that of another unit: some front ends
//!   substitute names in the whole text of a call.
//! - Comments in bodies contain no keywords, quotes and semicolons, and none stands before a statement that calls a function from within:
//!   some front ends split a body at its keywords before they remove the comments.
mod memory;
#[cfg(test)]
mod page;
mod pou;
mod scl;
mod xml;

use servobench_base::{ParamError, non_negative, positive};
use servobench_config::Choice as _;
use thiserror::Error;

servobench_config::choices! {
    /// Dialect of the text.
    pub enum Dialect default Iec {
        /// IEC 61131-3 as it stands, for MATIEC, OpenPLC, Beremiz and others; XML of TC6 2.01
        Iec = "iec",
        /// CODESYS V3 and TwinCAT 3: the same text, XML of TC6 2.0 as they import it
        Codesys = "codesys",
        /// Siemens S7-1500: an external source (.scl) for TIA Portal, no XML
        Scl = "scl",
    }
}

servobench_config::choices! {
    /// File format.
    pub enum Format default St {
        /// Structured Text: functions and function blocks one after the other
        St = "st",
        /// PLCopen XML: the same with the interface of each as elements
        Xml = "xml",
    }
}

/// Settings of an export.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Export<'a> {
    /// Dialect of the text.
    pub dialect: Dialect,
    /// Text or XML.
    pub format: Format,
    /// Initial values of inputs.
    pub times: Times,
    /// Name of the block with Execute, [`MOVE`] unless a library of the project has one of that name.
    pub move_block: &'a str,
}

/// Default times of a call.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Times {
    /// Default of `Ts`: the period of the task (s).
    pub sample: f64,
    /// Default of `T_set`: time from the end of a move until the block is ready (s).
    pub settling: f64,
}

/// Errors of an export.
#[derive(Debug, Clone, PartialEq, Error)]
pub enum ExportError {
    /// An invalid time.
    #[error(transparent)]
    Parameter(#[from] ParamError),
    /// A time that the block would refuse.
    #[error("`{name}` must be within {lowest:e} and {highest:e} s, got {value:e}: the block refuses other values")]
    OutOfRange {
        /// Field name.
        name: &'static str,
        /// Rejected value (s).
        value: f64,
        /// Smallest accepted value (s).
        lowest: f64,
        /// Largest accepted value (s).
        highest: f64,
    },
    /// An invalid name of a block.
    #[error("`move_block` must be {bound}, got \"{name}\"")]
    Name {
        /// Rejected name.
        name: String,
        /// Bound of the name, in words.
        bound: &'static str,
    },
    /// PLCopen XML for TIA Portal, which cannot import it.
    #[error("the dialect `{}` has no PLCopen XML, which TIA Portal does not import: take the format `{}`", .dialect.name(), Format::St.name())]
    NoXml {
        /// Dialect without XML.
        dialect: Dialect,
    },
}

/// Function blocks of the text.
const BLOCKS: [&str; 2] = ["Profile4th", MOVE];
/// Block with Execute, by its name in the standard.
pub const MOVE: &str = "MC_MoveAbsolute";
/// Longest name: the limit of the controllers of the dialects.
const LONGEST_NAME: usize = 80;
/// Smallest and largest sample time of the block (s).
const SAMPLE_TIMES: (f64, f64) = (1e-30, 1e30);
/// Longest settling time of the block (s).
const LONGEST_SETTLING: f64 = 1e30;

impl Export<'_> {
    /// Text of the file; `written` is the creation time for XML, as an `xs:dateTime`.
    ///
    /// # Errors
    /// [`ExportError`] if a time is not positive (a settling time: not positive or zero) or out of the range of the block, for a name that
    /// is not an identifier of IEC 61131-3 or that is used by another function of the file, and for XML of a dialect without it.
    pub fn text(&self, written: &str) -> Result<String, ExportError> {
        let source = self.source()?;
        let pous = pou::read(&source);
        let head = format!("(*\n{}*)\n", self.head());
        Ok(match (self.format, self.dialect) {
            (Format::St, Dialect::Iec | Dialect::Codesys) => format!("{head}\n{source}"),
            (Format::St, Dialect::Scl) => format!("{head}\n{}", scl::text(&pous)),
            (Format::Xml, Dialect::Iec) => xml::text(&pous, &head, xml::STANDARD, written),
            (Format::Xml, Dialect::Codesys) => xml::text(&pous, &head, xml::CODESYS, written),
            (Format::Xml, Dialect::Scl) => return Err(ExportError::NoXml { dialect: self.dialect }),
        })
    }

    /// Text of the standard with the times inserted.
    fn source(&self) -> Result<String, ExportError> {
        let sample_time = positive("sample_time", self.times.sample)?;
        within("sample_time", sample_time, SAMPLE_TIMES)?;
        let settling_time = non_negative("settling_time", self.times.settling)?;
        within("settling_time", settling_time, (0.0, LONGEST_SETTLING))?;
        let text = include_str!("profile_4th.st");
        self.check_name(text)?;
        let text = text.replace(&format!("FUNCTION_BLOCK {MOVE}"), &format!("FUNCTION_BLOCK {}", self.move_block));
        Ok(text.replace("{sample_time}", &literal(sample_time)).replace("{settling_time}", &literal(settling_time)))
    }

    /// Checks the name of the block with Execute against the others of `text`.
    fn check_name(&self, text: &str) -> Result<(), ExportError> {
        let name = self.move_block;
        let refuse = |bound| Err(ExportError::Name { name: name.to_owned(), bound });
        let is_letter = |letter: char| letter.is_ascii_alphanumeric() || letter == '_';
        let begins = name.starts_with(|first: char| first.is_ascii_alphabetic() || first == '_');
        if !begins || !name.chars().all(is_letter) || name.contains("__") || name.ends_with('_') {
            return refuse("letters, digits and single `_` between them, a letter or `_` first");
        }
        if name.len() > LONGEST_NAME {
            return refuse("at most 80 letters long");
        }
        let is_taken = |pou: &pou::Pou<'_>| pou.name != MOVE && pou.name.eq_ignore_ascii_case(name);
        if pou::read(text).iter().any(is_taken) {
            return refuse("another name than those of the other blocks and functions of the file");
        }
        Ok(())
    }

    /// Function blocks with the memory of an instance in bytes: inputs, outputs and kept variables by their declarations, with natural
    /// alignment.
    #[must_use]
    pub fn instances(&self) -> [(&str, usize); BLOCKS.len()] {
        instances().map(|(name, bytes)| (if name == MOVE { self.move_block } else { name }, bytes))
    }

    /// Head of the file, for its reader.
    fn head(&self) -> String {
        let tried = match (self.dialect, self.format) {
            (Dialect::Iec, Format::St) => "Compiled and run by pyplcopen 0.21. Not tried on any other compiler.",
            _ => {
                "Not tried on a compiler of the vendor. The statements are those that pyplcopen 0.21 compiled and ran."
            }
        };
        let memory = self.instances().map(|(name, bytes)| format!("    {name:<15} {bytes:>5} bytes"));
        include_str!("head.txt")
            .replace("{version}", env!("CARGO_PKG_VERSION"))
            .replace("{dialect}", self.dialect.name())
            .replace("{tried}", tried)
            .replace("{move}", self.move_block)
            .replace("{memory}", &memory.join("\n"))
    }
}

/// Function blocks with their memory, by the names of the text.
fn instances() -> [(&'static str, usize); BLOCKS.len()] {
    let pous = pou::read(include_str!("profile_4th.st"));
    BLOCKS.map(|name| (name, memory::instance(&pous, name)))
}

fn within(name: &'static str, value: f64, (lowest, highest): (f64, f64)) -> Result<(), ExportError> {
    if (lowest..=highest).contains(&value) {
        Ok(())
    } else {
        Err(ExportError::OutOfRange { name, value, lowest, highest })
    }
}

/// A number as a literal of LREAL: the shortest that reads back to the same bits, with the decimal point that it needs.
fn literal(number: f64) -> String {
    let text = format!("{number:?}").to_uppercase();
    match text.split_once('E') {
        Some((digits, exponent)) if !digits.contains('.') => format!("{digits}.0E{exponent}"),
        _ => text,
    }
}

#[cfg(test)]
mod tests;
