//! Prints the object dictionary: `eds [NAME DATE TIME]` as an electronic data sheet, `json` with the values after power-on.
//! With `sdo` it answers accesses to a drive without power instead, one a line, as a master sends them:
//!
//! ```text
//! read  INDEX SUBINDEX            all in hexadecimal digits, BYTES with the lowest first
//! write INDEX SUBINDEX BYTES
//! ```
//!
//! Each answer is a line: the bytes, nothing for a write, or `abort`, the code and the reason.
use servobench_cia402::objects::{Dictionary, Eds, FileInfo, Json};
use servobench_cia402::units::Object;
use servobench_cia402::{PowerState, SdoError};
use std::error::Error;
use std::io::{self, BufWriter, Write as _};

fn main() -> Result<(), Box<dyn Error>> {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let words: Vec<&str> = arguments.iter().map(String::as_str).collect();
    let mut out = BufWriter::new(io::stdout().lock());
    match words.as_slice() {
        ["eds"] => write!(out, "{}", data_sheet("drive.eds", "01-01-2026", "12:00AM"))?,
        ["eds", name, date, time] => write!(out, "{}", data_sheet(name, date, time))?,
        ["json"] => write!(out, "{}", Json(&Dictionary::new()))?,
        ["sdo"] => {
            let mut dictionary = Dictionary::new();
            for (number, line) in io::stdin().lines().enumerate() {
                let line = line?;
                let request = Request::of(&line).map_err(|error| format!("line {}, `{line}`: {error}", number + 1))?;
                match request.answer(&mut dictionary) {
                    Ok(bytes) => bytes.iter().try_for_each(|byte| write!(out, "{byte:02x}"))?,
                    Err(refused) => write!(out, "abort {:08x} {refused}", refused.abort_code().bits())?,
                }
                writeln!(out)?;
            }
        }
        _ => return Err("usage: object_dictionary eds [NAME MM-DD-YYYY HH:MMAM] | json | sdo".into()),
    }
    Ok(out.flush()?)
}

fn data_sheet<'a>(name: &'a str, date: &'a str, time: &'a str) -> Eds<'a> {
    Eds { file: FileInfo { name, date, time }, configured: None }
}

/// One access.
struct Request {
    object: Object,
    /// Bytes to write; `None` for a read.
    bytes: Option<Vec<u8>>,
}

impl Request {
    fn of(line: &str) -> Result<Self, Box<dyn Error>> {
        let words: Vec<&str> = line.split_whitespace().collect();
        let (index, subindex, bytes) = match words.as_slice() {
            ["read", index, subindex] => (index, subindex, None),
            ["write", index, subindex] => (index, subindex, Some("")),
            ["write", index, subindex, bytes] => (index, subindex, Some(*bytes)),
            _ => return Err("an access is read or write, an index, a sub-index and the bytes to be written".into()),
        };
        let object = Object { index: u16::from_str_radix(index, 16)?, subindex: u8::from_str_radix(subindex, 16)? };
        let byte = |digits: &[u8]| Ok::<_, Box<dyn Error>>(u8::from_str_radix(str::from_utf8(digits)?, 16)?);
        let bytes = bytes.map(|digits| digits.as_bytes().chunks(2).map(byte).collect()).transpose()?;
        Ok(Self { object, bytes })
    }

    fn answer(&self, dictionary: &mut Dictionary) -> Result<Vec<u8>, SdoError> {
        let Some(bytes) = &self.bytes else {
            return dictionary.upload(self.object).map(|bytes| bytes.as_ref().to_vec());
        };
        dictionary.download(self.object, bytes, PowerState::SwitchOnDisabled).map(|()| vec![])
    }
}
