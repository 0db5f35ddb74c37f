//! The table as an electronic data sheet (EDS, CiA 306-1), which tools and masters of CANopen read.
use super::dictionary::Dictionary;
use super::entry::{Access, Contents, Entry, HIGHEST_SUBINDEX, Mapping, ObjectDescription};
use super::pdo::without_node_id;
use super::table::OBJECTS;
use super::value::DataType;
use crate::units::Object;
use core::fmt::{self, Display, Formatter};

/// Description of the file in the file.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct FileInfo<'a> {
    /// File name, such as `drive.eds`.
    pub name: &'a str,
    /// Date of creation, `mm-dd-yyyy`.
    pub date: &'a str,
    /// Time of creation, `hh:mmAM` or `hh:mmPM`.
    pub time: &'a str,
}

/// The electronic data sheet of the drive, as displayable text: ASCII, with lines ended by a line feed, as in CiA 306-1.
///
/// ```
/// use servobench_cia402::objects::{Eds, FileInfo};
/// let file = FileInfo { name: "drive.eds", date: "11-21-2026", time: "08:00AM" };
/// let eds = Eds { file, configured: None }.to_string();
/// assert!(eds.contains("[6041]\nParameterName=Statusword\nObjectType=0x7\nDataType=0x0006\nAccessType=ro\n"));
/// ```
#[derive(Debug, Clone, Copy)]
pub struct Eds<'a> {
    /// Description of the file.
    pub file: FileInfo<'a>,
    /// Values for the configuration of the drive. Those that differ from the values after power-on are added as `ParameterValue`, as in a
    /// device configuration file (DCF).
    pub configured: Option<&'a Dictionary>,
}

/// Objects that every device has (CiA 301).
const MANDATORY: [u16; 3] = [0x1000, 0x1001, 0x1018];

impl Display for Eds<'_> {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        let FileInfo { name, date, time } = self.file;
        writeln!(f, "[FileInfo]\nFileName={name}\nFileVersion=1\nFileRevision=1\nEDSVersion=4.0")?;
        writeln!(f, "Description=Simulated servo drive, profile CiA 402")?;
        for verb in ["Creation", "Modification"] {
            writeln!(f, "{verb}Time={time}\n{verb}Date={date}")?;
        }
        writeln!(f, "CreatedBy=servobench\nModifiedBy=servobench\n")?;
        f.write_str("[DeviceInfo]\nVendorName=servobench\nVendorNumber=0x0\nProductName=Simulated servo drive\n")?;
        f.write_str("ProductNumber=0x0\nRevisionNumber=0x0\nOrderCode=0\n")?;
        for kilobaud in [10, 20, 50, 125, 250, 500, 800, 1000] {
            writeln!(f, "BaudRate_{kilobaud}=0")?;
        }
        f.write_str("SimpleBootUpMaster=0\nSimpleBootUpSlave=0\nGranularity=8\nDynamicChannelsSupported=0\n")?;
        f.write_str("GroupMessaging=0\nNrOfRXPDO=5\nNrOfTXPDO=5\nLSS_Supported=0\n\n[DummyUsage]\n")?;
        for dummy in 1..=7 {
            writeln!(f, "Dummy{dummy:04}=0")?;
        }
        f.write_str("\n[Comments]\nLines=0\n\n")?;
        list(f, "MandatoryObjects", |index| MANDATORY.contains(&index))?;
        list(f, "OptionalObjects", |index| !MANDATORY.contains(&index) && !is_manufacturers(index))?;
        list(f, "ManufacturerObjects", is_manufacturers)?;
        OBJECTS.iter().try_for_each(|object| self.sections(f, object))
    }
}

/// Data type of a string (CiA 301, table 44).
const VISIBLE_STRING: u16 = 9;

/// True if the index is in the manufacturer-specific profile area.
fn is_manufacturers(index: u16) -> bool {
    (0x2000..0x6000).contains(&index)
}

/// Writes one list of indices.
fn list(f: &mut Formatter<'_>, name: &str, belongs: impl Fn(u16) -> bool) -> fmt::Result {
    let listed = || OBJECTS.iter().map(|object| object.index).filter(|index| belongs(*index));
    writeln!(f, "[{name}]\nSupportedObjects={}", listed().count())?;
    for (number, index) in (1..).zip(listed()) {
        writeln!(f, "{number}=0x{index:04X}")?;
    }
    writeln!(f)
}

impl Eds<'_> {
    /// Writes the section of an object and those of its sub-indices.
    fn sections(&self, f: &mut Formatter<'_>, object: &ObjectDescription) -> fmt::Result {
        let (index, name) = (object.index, object.name);
        let (object_type, entries) = match object.contents {
            Contents::Variable(entry) => {
                writeln!(f, "[{index:04X}]")?;
                return self.variable(f, Object { index, subindex: 0 }, &entry, None);
            }
            Contents::Text(text) => {
                writeln!(f, "[{index:04X}]\nParameterName={name}\nObjectType=0x7\nDataType=0x{VISIBLE_STRING:04X}")?;
                return writeln!(f, "AccessType=const\nDefaultValue={text}\nPDOMapping=0\n");
            }
            Contents::Array(entries) => (8, entries),
            Contents::Record(entries) => (9, entries),
        };
        writeln!(
            f,
            "[{index:04X}]\nParameterName={name}\nObjectType=0x{object_type}\nSubNumber=0x{:X}\n",
            entries.len() + 1
        )?;
        let unsigned8 = DataType::Unsigned8.code();
        writeln!(f, "[{index:04X}sub0]\nParameterName={HIGHEST_SUBINDEX}\nObjectType=0x7\nDataType=0x{unsigned8:04X}")?;
        writeln!(f, "AccessType=const\nDefaultValue={}\nPDOMapping=0\n", entries.len())?;
        for (subindex, entry) in (1..).zip(entries) {
            writeln!(f, "[{index:04X}sub{subindex:X}]")?;
            // Readers also find entries by name: several of one name get a number.
            let alike = entries.iter().filter(|other| other.name == entry.name).count();
            self.variable(f, Object { index, subindex }, entry, (alike > 1).then_some(subindex))?;
        }
        Ok(())
    }

    /// Writes the keys of a section that describes a value.
    fn variable(&self, f: &mut Formatter<'_>, object: Object, entry: &Entry, number: Option<u8>) -> fmt::Result {
        write!(f, "ParameterName={}", entry.name)?;
        if let Some(number) = number {
            write!(f, " {number}")?;
        }
        let access = match (entry.access, entry.mapping) {
            (Access::ReadWrite, Mapping::Receive) => "rww",
            (Access::ReadWrite, Mapping::Transmit) => "rwr",
            (access, _) => access.abbreviation(),
        };
        writeln!(f, "\nObjectType=0x7\nDataType=0x{:04X}\nAccessType={access}", entry.data_type.code())?;
        match without_node_id(object.index, object.subindex, entry.default) {
            Some(added) => writeln!(f, "DefaultValue=$NODEID+0x{added:X}")?,
            None => writeln!(f, "DefaultValue={}", entry.default_value())?,
        }
        writeln!(f, "PDOMapping={}", u8::from(entry.mapping != Mapping::No))?;
        if let Some((lowest, highest)) = entry.range() {
            writeln!(f, "LowLimit={lowest}\nHighLimit={highest}")?;
        }
        if let Some(Ok(value)) = self.configured.map(|values| values.read(object))
            && value != entry.default_value()
        {
            writeln!(f, "ParameterValue={value}")?;
        }
        writeln!(f)
    }
}
