//! Outputs of a command, which must not overwrite its inputs.
//!
//! Every command names all its outputs here before anything runs and gets an [`Output`] for each, by which alone it writes. Refused are
//! an output that is an input under any name (a link, a detour), one that another option names too, and a folder.
mod place;
mod target;

pub(crate) use target::Output;

use crate::error::CliError;
use place::Place;
use servobench_files::{Destination, FileId};
use std::collections::HashMap;
use std::ffi::OsStr;
use std::fmt::Display;
use std::path::{Path, PathBuf};
use std::sync::{Mutex, MutexGuard, PoisonError};
use thiserror::Error;

/// Standard output as the value of `-o`.
const STDOUT: &str = "-";

/// The files that this process reads, each with its description.
static INPUTS: Mutex<Option<HashMap<FileId, String>>> = Mutex::new(None);

/// Notes that the file at `path` is read, and its description `what`: `the scenario a.toml`, `the table of --points`. Other than regular
/// files have nothing to lose.
pub(crate) fn reads(path: &Path, what: impl Display) {
    if std::fs::metadata(path).is_ok_and(|found| found.is_file()) {
        note(FileId::of(path).ok(), what);
    }
}

/// Notes that standard input is read.
pub(crate) fn reads_stdin() {
    note(FileId::of_standard_input(), "what comes in on standard input");
}

fn note(file: Option<FileId>, what: impl Display) {
    if let Some(file) = file {
        inputs().get_or_insert_default().entry(file).or_insert_with(|| what.to_string());
    }
}

/// Description of the file if it is an input.
fn input(file: &FileId) -> Option<String> {
    inputs().as_ref().and_then(|inputs| inputs.get(file)).cloned()
}

fn inputs() -> MutexGuard<'static, Option<HashMap<FileId, String>>> {
    // A panic never leaves the map half changed.
    INPUTS.lock().unwrap_or_else(PoisonError::into_inner)
}

/// Makes a folder and its parents.
pub(crate) fn make_folder(folder: &Path) -> Result<(), CliError> {
    std::fs::create_dir_all(folder).map_err(|error| CliError::MakeFolder { folder: folder.to_owned(), error })
}

/// Refusal to write an output.
#[derive(Debug, Error)]
pub(crate) enum Refused {
    #[error("{option}: `{}` is {input} and would be lost; name another file", .path.display())]
    Input { option: String, path: PathBuf, input: String },
    #[error("{option}: `{}` is written by {other} too; name another file", .path.display())]
    Twice { option: String, other: String, path: PathBuf },
    #[error("{option}: `{}` is a folder; name a file in it", .path.display())]
    Folder { option: String, path: PathBuf },
    #[error("`{}` exists and is not overwritten; {way_out}", .path.display())]
    Exists { path: PathBuf, way_out: &'static str },
    #[error("{option}: `{}` is no folder; name one, or a name that is free", .path.display())]
    NoFolder { option: String, path: PathBuf },
    #[error("`{name}` is no name of a file beside the results")]
    Name { name: String },
}

/// The outputs of a command.
#[derive(Default)]
pub(crate) struct Outputs<'a> {
    files: HashMap<Place, String>,
    folders: Vec<ClaimedFolder<'a>>,
}

/// A folder that claims certain file names.
struct ClaimedFolder<'a> {
    option: String,
    place: Place,
    is_name_of_its_own: Box<dyn Fn(&str) -> bool + 'a>,
}

impl ClaimedFolder<'_> {
    fn claims(&self, place: &Place) -> bool {
        place.name_in(&self.place).is_some_and(|name| (self.is_name_of_its_own)(name))
    }
}

impl<'a> Outputs<'a> {
    /// The file at `path`, which `option` names.
    pub(crate) fn file(&mut self, option: &str, path: &Path) -> Result<Output, Refused> {
        let kind = Destination::of(path);
        if kind == Destination::Folder {
            return Err(Refused::Folder { option: option.to_owned(), path: path.to_owned() });
        }
        spares(option, path)?;
        // Several options may write to one device.
        if kind != Destination::Device {
            let place = Place::of(path);
            let of_a_folder = self.folders.iter().find(|folder| folder.claims(&place)).map(|folder| &folder.option);
            if let Some(other) = of_a_folder.or_else(|| self.files.get(&place)) {
                let (option, other) = (option.to_owned(), other.clone());
                return Err(Refused::Twice { option, other, path: path.to_owned() });
            }
            self.files.insert(place, option.to_owned());
        }
        Ok(Output::at(path, kind))
    }

    /// A new file at `path`; if one exists, the error gives the advice `way_out`.
    pub(crate) fn new_file(&mut self, option: &str, path: &Path, way_out: &'static str) -> Result<Output, Refused> {
        // A dangling link exists, too.
        if std::fs::symlink_metadata(path).is_ok() {
            return Err(Refused::Exists { path: path.to_owned(), way_out });
        }
        self.anywhere(option, path)
    }

    /// The file at `path`, if there is one.
    pub(crate) fn optional(&mut self, option: &str, path: Option<&Path>) -> Result<Option<Output>, Refused> {
        path.map(|path| self.file(option, path)).transpose()
    }

    /// The file at `path`, whose folder is made if missing.
    pub(crate) fn anywhere(&mut self, option: &str, path: &Path) -> Result<Output, Refused> {
        self.file(option, path).map(Output::anywhere)
    }

    /// The file at `path`; standard output for `None` and for `-`.
    pub(crate) fn or_standard(&mut self, option: &str, path: Option<&Path>) -> Result<Output, Refused> {
        match path {
            Some(path) if path.as_os_str() != STDOUT => self.file(option, path),
            _ => Ok(Output::STANDARD_OUTPUT),
        }
    }

    /// The folder at `path`, which `option` names, for all files whose names satisfy `is_name_of_its_own`: they may be too many for a list.
    pub(crate) fn folder(
        &mut self,
        option: &str,
        path: &Path,
        is_name_of_its_own: impl Fn(&str) -> bool + 'a,
    ) -> Result<OutputFolder, Refused> {
        if std::fs::metadata(path).is_ok_and(|found| !found.is_dir()) {
            return Err(Refused::NoFolder { option: option.to_owned(), path: path.to_owned() });
        }
        // Only an existing file can be an input.
        for entry in std::fs::read_dir(path).into_iter().flatten().flatten() {
            if entry.file_name().to_str().is_some_and(&is_name_of_its_own) {
                let taken = entry.path();
                if taken.is_dir() {
                    return Err(Refused::Folder { option: option.to_owned(), path: taken });
                }
                spares(option, &taken)?;
            }
        }
        let (option, place) = (option.to_owned(), Place::of_folder(path));
        let folder = ClaimedFolder { option, place, is_name_of_its_own: Box::new(is_name_of_its_own) };
        if let Some((file, other)) = self.files.iter().find(|(file, _)| folder.claims(file)) {
            let path = path.join(file.name_in(&folder.place).unwrap_or_default());
            return Err(Refused::Twice { option: folder.option, other: other.clone(), path });
        }
        self.folders.push(folder);
        Ok(OutputFolder { path: path.to_owned() })
    }
}

/// Refuses to overwrite an input.
fn spares(option: &str, path: &Path) -> Result<(), Refused> {
    match FileId::of(path).ok().and_then(|file| input(&file)) {
        Some(input) => Err(Refused::Input { option: option.to_owned(), path: path.to_owned(), input }),
        None => Ok(()),
    }
}

/// Checks that `name`, from an untrusted source, is a plain file name without a folder.
pub(crate) fn is_name(name: &str) -> Result<(), Refused> {
    let is_one = Path::new(name).file_name() == Some(OsStr::new(name)) && !name.contains(['/', '\\', '\0']);
    if is_one { Ok(()) } else { Err(Refused::Name { name: name.to_owned() }) }
}

/// A folder that a command writes into.
#[derive(Debug, Clone)]
pub(crate) struct OutputFolder {
    path: PathBuf,
}

impl OutputFolder {
    /// Path of the folder.
    pub(crate) fn path(&self) -> &Path {
        &self.path
    }

    /// Path of the claimed file `name` in the folder. Writing there replaces a link and does not follow it.
    pub(crate) fn place(&self, name: &str) -> Result<PathBuf, Refused> {
        is_name(name)?;
        Ok(self.path.join(name))
    }

    /// The claimed file `name` in the folder.
    pub(crate) fn file(&self, name: &str) -> Result<Output, Refused> {
        Ok(Output::at(&self.place(name)?, Destination::File))
    }
}
