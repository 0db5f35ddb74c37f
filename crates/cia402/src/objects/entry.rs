//! Description of an object in the table.
use super::value::{DataType, Value};
use crate::Mode;

/// Access of the master to an entry.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Access {
    /// Constant: read only, and never changes.
    Constant,
    /// Read by the master.
    ReadOnly,
    /// Read and written by the master.
    ReadWrite,
    /// Written by the master.
    WriteOnly,
}

/// Process data into which an entry may be mapped.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Mapping {
    /// None.
    No,
    /// Data that the drive receives (RPDO).
    Receive,
    /// Data that the drive transmits (TPDO).
    Transmit,
}

/// Values that an entry takes.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Admitted {
    /// Every value of the type.
    Any,
    /// From the first to the second one.
    Range(i64, i64),
    /// These values.
    OneOf(&'static [i64]),
    /// Values without other bits than these.
    Bits(u32),
}

/// One value of the object dictionary.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Entry {
    /// Name in the standard; for a variable that of the object.
    pub name: &'static str,
    /// Data type.
    pub data_type: DataType,
    /// Access of the master.
    pub access: Access,
    /// Process data into which the entry may be mapped.
    pub mapping: Mapping,
    /// Value after power-on.
    pub default: i64,
    /// Values that the entry takes.
    pub admitted: Admitted,
    /// Unit; empty without one.
    pub unit: &'static str,
    /// True if the entry may be written only while the drive function is disabled.
    pub disabled_only: bool,
    /// Mode whose motion depends on the entry: during that motion the entry may not be written.
    pub governs: Option<Mode>,
}

/// The entries of an object.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Contents {
    /// One, at sub-index 00h.
    Variable(Entry),
    /// A string that never changes (VISIBLE_STRING), at sub-index 00h.
    Text(&'static str),
    /// Several of one kind, from sub-index 01h on; 00h has their number.
    Array(&'static [Entry]),
    /// Several of different kinds, from sub-index 01h on; 00h has their number.
    Record(&'static [Entry]),
}

/// An object of the dictionary.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct ObjectDescription {
    /// Index, such as 6041h.
    pub index: u16,
    /// Name in the standard.
    pub name: &'static str,
    /// Contents.
    pub contents: Contents,
}

/// Name of sub-index 00h of an array or record (CiA 301, section 7.4.4).
pub(super) const HIGHEST_SUBINDEX: &str = "Highest sub-index supported";

impl ObjectDescription {
    /// Numbers of the object: one at sub-index 00h, or several from 01h on; none for a string.
    #[must_use]
    pub const fn entries(&self) -> &[Entry] {
        match &self.contents {
            Contents::Variable(entry) => core::slice::from_ref(entry),
            Contents::Text(_) => &[],
            Contents::Array(entries) | Contents::Record(entries) => entries,
        }
    }

    /// String of the object, if it is one.
    #[must_use]
    pub const fn text(&self) -> Option<&'static str> {
        if let Contents::Text(text) = self.contents { Some(text) } else { None }
    }

    /// Sub-index of the first of [`entries`](Self::entries).
    #[must_use]
    pub const fn first_subindex(&self) -> u8 {
        if matches!(self.contents, Contents::Variable(_) | Contents::Text(_)) { 0 } else { 1 }
    }

    /// Number of sub-indices above 00h.
    #[must_use]
    pub fn highest_subindex(&self) -> u8 {
        match self.contents {
            Contents::Variable(_) | Contents::Text(_) => 0,
            // An index has 255 sub-indices, and the table fewer.
            Contents::Array(entries) | Contents::Record(entries) => u8::try_from(entries.len()).unwrap_or(u8::MAX),
        }
    }
}

impl Access {
    /// True if the master may read the entry.
    #[must_use]
    pub const fn is_read(self) -> bool {
        !matches!(self, Self::WriteOnly)
    }

    /// True if the master may write the entry.
    #[must_use]
    pub const fn is_written(self) -> bool {
        matches!(self, Self::ReadWrite | Self::WriteOnly)
    }

    /// Abbreviation of CiA 301.
    #[must_use]
    pub const fn abbreviation(self) -> &'static str {
        match self {
            Self::Constant => "const",
            Self::ReadOnly => "ro",
            Self::ReadWrite => "rw",
            Self::WriteOnly => "wo",
        }
    }
}

impl Mapping {
    /// Abbreviation of CiA 301; empty for none.
    #[must_use]
    pub const fn abbreviation(self) -> &'static str {
        match self {
            Self::No => "",
            Self::Receive => "RPDO",
            Self::Transmit => "TPDO",
        }
    }
}

impl Entry {
    /// Value after power-on, with its type.
    #[must_use]
    pub const fn default_value(&self) -> Value {
        self.data_type.value(self.default.cast_unsigned())
    }

    /// Bounds of the entry, if its values form a range.
    #[must_use]
    pub const fn range(&self) -> Option<(i64, i64)> {
        if let Admitted::Range(lowest, highest) = self.admitted { Some((lowest, highest)) } else { None }
    }

    pub(super) const fn unit(self, unit: &'static str) -> Self {
        Self { unit, ..self }
    }

    pub(super) const fn within(self, lowest: i64, highest: i64) -> Self {
        Self { admitted: Admitted::Range(lowest, highest), ..self }
    }

    pub(super) const fn at_least_one(self) -> Self {
        #[expect(clippy::cast_possible_truncation, reason = "of types up to 32 bits")]
        self.within(1, self.data_type.highest() as i64)
    }

    pub(super) const fn one_of(self, accepted: &'static [i64]) -> Self {
        Self { admitted: Admitted::OneOf(accepted), ..self }
    }

    pub(super) const fn bits(self, bits: u32) -> Self {
        Self { admitted: Admitted::Bits(bits), ..self }
    }

    pub(super) const fn received(self) -> Self {
        Self { mapping: Mapping::Receive, ..self }
    }

    pub(super) const fn disabled_only(self) -> Self {
        Self { disabled_only: true, ..self }
    }

    pub(super) const fn governs(self, mode: Mode) -> Self {
        Self { governs: Some(mode), ..self }
    }

    pub(super) const fn named(self, name: &'static str) -> Self {
        Self { name, ..self }
    }
}
