//! The zip archive of an FMU, of unknown origin and therefore unpacked with care.
//!
//! Every entry's name, kind and size in the directory of the archive is checked before anything is written. While unpacking, no file
//! grows beyond its size there. Names that lead out of the folder, links, devices, encrypted files, duplicates with different bytes and
//! compressions outside the standard are refused.
//!
//! Source: FMI 2.0.5, §2.3, and FMI 3.0.2, §2.5 (a zip with `deflate` or no compression); PKWARE, *.ZIP File Format
//! Specification*, 6.3.10, §4.3.16 (end of the directory).

mod folder;
mod name;
mod twice;

use crate::description::{MOST_BYTES, ModelDescription};
use crate::error::{ArchiveProblem, FmuError};
use crate::library;
use folder::{Own, writing};
use name::Names;

pub use folder::{remove_abandoned, remove_unpacked};
use std::fs::{self, File};
use std::io::{self, Read, Seek, SeekFrom};
use std::path::{Path, PathBuf};
use std::sync::Arc;
use zip::{CompressionMethod, ZipArchive};

/// Limits of an archive.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Limits {
    /// Files and folders.
    pub entries: usize,
    /// Bytes of a name, with its folders.
    pub name: usize,
    /// Bytes of a file.
    pub file: u64,
    /// Bytes of all files.
    pub total: u64,
    /// Ratio of the bytes of all files to those of the archive.
    pub ratio: u64,
}

impl Default for Limits {
    /// Far above FMUs that carry a whole interpreter with them.
    fn default() -> Self {
        Self { entries: 20_000, name: 500, file: 1 << 30, total: 4 << 30, ratio: 250 }
    }
}

/// A small archive may be compressed better than [`Limits::ratio`].
const SMALL: u64 = 16 << 20;
/// The bits of a Unix mode that give the kind of file.
const KIND: u32 = 0o170_000;
/// Path of the description.
const DESCRIPTION: &str = "modelDescription.xml";

/// A packed FMU; all its names and sizes are within the limits.
#[derive(Debug)]
pub struct Archive {
    path: PathBuf,
    zip: ZipArchive<File>,
    names: Names,
    /// Oddities that do no harm.
    remarks: Vec<String>,
}

impl Archive {
    /// Opens a file and checks its directory.
    ///
    /// # Errors
    /// [`FmuError::File`], [`FmuError::Archive`]
    pub fn open(path: impl Into<PathBuf>, limits: &Limits) -> Result<Self, FmuError> {
        let path = path.into();
        let at = |problem| FmuError::Archive { path: path.clone(), problem };
        let unreadable = |source| FmuError::File { path: path.clone(), what: "read", source };
        let (mut file, bytes) = open_file(&path).map_err(unreadable)?;
        refuse_long_directory(&mut file, bytes).map_err(unreadable)?.map_err(at)?;
        let mut other = file.try_clone().map_err(unreadable)?;
        let mut zip = ZipArchive::new(file).map_err(|error| at(ArchiveProblem::Zip(error.to_string())))?;
        let remarks = if zip.has_duplicate_names() {
            let place = (zip.central_directory_start(), zip.offset());
            remarks(&twice::same_twice(&mut other, place, bytes).map_err(at)?).map_err(at)?
        } else {
            Vec::new()
        };
        let names = look(&mut zip, bytes, limits).map_err(at)?;
        Ok(Self { path, zip, names, remarks })
    }

    /// The file.
    #[must_use]
    pub fn path(&self) -> &Path {
        &self.path
    }

    /// Names of the files in it.
    pub fn files(&self) -> impl Iterator<Item = &str> {
        self.names.files()
    }

    /// Reads only the model description.
    ///
    /// # Errors
    /// [`FmuError`]
    pub fn description(&mut self) -> Result<ModelDescription, FmuError> {
        let text = self.description_text().map_err(|problem| self.refuse(problem))?;
        let mut description = ModelDescription::read(&text, &format!("{}/{DESCRIPTION}", self.path.display()))?;
        description.remarks.extend_from_slice(&self.remarks);
        Ok(description)
    }

    fn refuse(&self, problem: ArchiveProblem) -> FmuError {
        FmuError::Archive { path: self.path.clone(), problem }
    }

    fn description_text(&mut self) -> Result<String, ArchiveProblem> {
        let Some(index) = self.names.index(DESCRIPTION) else { return Err(no_description(&self.names)) };
        let broken = |why: String| ArchiveProblem::Entry { entry: DESCRIPTION.into(), why };
        let entry = self.zip.by_index(index).map_err(|error| broken(error.to_string()))?;
        let most = MOST_BYTES as u64;
        if entry.size() > most {
            return Err(ArchiveProblem::Limit {
                what: format!("the size of `{DESCRIPTION}` in bytes"),
                value: entry.size(),
                most,
            });
        }
        let mut text = vec![];
        entry.take(most).read_to_end(&mut text).map_err(|error| broken(error.to_string()))?;
        String::from_utf8(text).map_err(|error| broken(format!("it has to be UTF-8: {error}")))
    }

    /// Unpacks everything into a new temporary folder.
    ///
    /// # Errors
    /// [`FmuError`]
    pub fn unpack(mut self) -> Result<Unpacked, FmuError> {
        let description = self.description()?;
        let parent = std::env::temp_dir();
        let folder = Own::new(&parent).map_err(|source| FmuError::File { path: parent, what: "written to", source })?;
        for index in 0..self.zip.len() {
            self.unpack_entry(index, folder.path())?;
        }
        let (folder, description) = (Arc::new(Folder::Own(folder)), Arc::new(description));
        Ok(Unpacked { path: self.path, folder, description, remarks: self.remarks })
    }

    fn unpack_entry(&mut self, index: usize, folder: &Path) -> Result<(), FmuError> {
        let _writing = writing();
        let name = self.names.name(index);
        let target = folder.join(name);
        let unwritable = |source| FmuError::File { path: target.clone(), what: "written", source };
        if name.ends_with('/') {
            return fs::create_dir_all(&target).map_err(unwritable);
        }
        if let Some(parent) = target.parent() {
            fs::create_dir_all(parent).map_err(unwritable)?;
        }
        let broken = |why: String| FmuError::Archive {
            path: self.path.clone(),
            problem: ArchiveProblem::Entry { entry: name.to_owned(), why },
        };
        let mut entry = self.zip.by_index(index).map_err(|error| broken(error.to_string()))?;
        // An executable file stays executable for its owner; others have no permissions.
        let is_program = entry.unix_mode().unwrap_or(0) & 0o100 != 0;
        let mut file = servobench_files::create_private(&target, is_program).map_err(unwritable)?;
        let size = entry.size();
        let copied = io::copy(&mut (&mut entry).take(size), &mut file).map_err(|error| broken(error.to_string()))?;
        let is_longer = entry.read(&mut [0]).map_err(|error| broken(error.to_string()))? > 0;
        if is_longer || copied != size {
            return Err(broken(format!("its size is not the {size} bytes of the directory")));
        }
        Ok(())
    }
}

/// Greatest length of an archive (bytes): the form for larger ones (zip64) is refused anyway.
const LARGEST: u64 = u32::MAX as u64;

/// Opens a regular file; returns it with its length.
fn open_file(path: &Path) -> io::Result<(File, u64)> {
    let file = servobench_files::open(path, LARGEST)?;
    let bytes = file.metadata()?.len();
    Ok((file, bytes))
}

/// Remarks on names that occur more than once with the same bytes.
fn remarks(twice: &[(String, usize)]) -> Result<Vec<String>, ArchiveProblem> {
    if twice.is_empty() {
        // Either names are the same in different encodings, or the directory announces more than it has.
        return Err(ArchiveProblem::Zip("its directory has fewer different names than entries".into()));
    }
    let remark = |(name, count): &(String, usize)| {
        format!("`{name}` is in the archive {count} times, always with the same bytes")
    };
    Ok(twice.iter().map(remark).collect())
}

/// An unpacked FMU. Its folder is removed with the last clone of this.
#[derive(Debug, Clone)]
pub struct Unpacked {
    path: PathBuf,
    folder: Arc<Folder>,
    description: Arc<ModelDescription>,
    remarks: Vec<String>,
}

#[derive(Debug)]
enum Folder {
    /// Removed when it is dropped.
    Own(Own),
    /// Owned by another process.
    Foreign(PathBuf),
}

impl Unpacked {
    /// Opens and unpacks a file within the default limits.
    ///
    /// # Errors
    /// [`FmuError`]
    pub fn new(path: impl Into<PathBuf>) -> Result<Self, FmuError> {
        Archive::open(path, &Limits::default())?.unpack()
    }

    /// An FMU unpacked into `folder` before, for a process that uses what another has unpacked. The folder stays.
    ///
    /// # Errors
    /// [`FmuError`]
    pub fn in_folder(path: impl Into<PathBuf>, folder: impl Into<PathBuf>) -> Result<Self, FmuError> {
        let (path, folder) = (path.into(), folder.into());
        let file = folder.join(DESCRIPTION);
        let text = servobench_files::read_text(&file, MOST_BYTES as u64).map_err(|source| FmuError::File {
            path: file,
            what: "read",
            source,
        })?;
        let description = ModelDescription::read(&text, &format!("{}/{DESCRIPTION}", path.display()))?;
        let (folder, description) = (Arc::new(Folder::Foreign(folder)), Arc::new(description));
        Ok(Self { path, folder, description, remarks: Vec::new() })
    }

    /// The file that was unpacked.
    #[must_use]
    pub fn path(&self) -> &Path {
        &self.path
    }

    /// The folder with its unpacked files.
    #[must_use]
    pub fn folder(&self) -> &Path {
        match &*self.folder {
            Folder::Own(folder) => folder.path(),
            Folder::Foreign(folder) => folder,
        }
    }

    /// Oddities of its archive, which was accepted all the same.
    #[must_use]
    pub fn remarks(&self) -> &[String] {
        &self.remarks
    }

    /// Its model description.
    #[must_use]
    pub fn description(&self) -> &ModelDescription {
        &self.description
    }

    /// Path of its library for this platform. Nothing is loaded.
    ///
    /// # Errors
    /// [`FmuError::Library`] lists what the FMU has instead.
    pub fn library(&self) -> Result<PathBuf, FmuError> {
        library::path(self)
    }
}

/// Length of the record at the end of the directory, without the comment behind it.
const END: usize = 22;
const LONGEST_COMMENT: u64 = u16::MAX as u64;

/// Refuses a directory that is too long. The directory is read as a whole: before that, each record that may be its end must announce
/// fewer than 65535 entries. An FMU within the limits does not need the form for larger archives (zip64).
fn refuse_long_directory(file: &mut File, bytes: u64) -> io::Result<Result<(), ArchiveProblem>> {
    let from = bytes.saturating_sub(LONGEST_COMMENT + END as u64);
    file.seek(SeekFrom::Start(from))?;
    let mut tail = vec![];
    file.take(bytes - from).read_to_end(&mut tail)?;
    file.rewind()?;
    let is_large = |end: &[u8]| {
        end.starts_with(b"PK\x05\x06")
            && (end[8..12].chunks(2).any(|n| n == [0xff; 2]) || end[12..20].chunks(4).any(|n| n == [0xff; 4]))
    };
    Ok(if tail.windows(END).any(is_large) {
        Err(ArchiveProblem::Zip("it is in the form for archives above 4 GB or 65534 files (zip64)".into()))
    } else {
        Ok(())
    })
}

/// Checks every entry of the directory.
fn look(zip: &mut ZipArchive<File>, bytes: u64, limits: &Limits) -> Result<Names, ArchiveProblem> {
    let within = |what: &dyn Fn() -> String, value: u64, most: u64| {
        if value > most { Err(ArchiveProblem::Limit { what: what(), value, most }) } else { Ok(()) }
    };
    within(&|| "the number of its files".into(), zip.len() as u64, limits.entries as u64)?;
    let (mut names, mut total) = (Names::default(), 0_u64);
    for index in 0..zip.len() {
        let entry = zip.by_index_raw(index).map_err(|error| ArchiveProblem::Zip(error.to_string()))?;
        let raw = entry.name_raw();
        within(&|| "the length of a name in it".into(), raw.len() as u64, limits.name as u64)?;
        let name = entry.name().map_err(|error| ArchiveProblem::Entry {
            entry: String::from_utf8_lossy(raw).escape_debug().to_string(),
            why: error.to_string(),
        })?;
        let refuse = |what| Err(ArchiveProblem::Kind { entry: name.escape_debug().to_string(), what });
        match entry.unix_mode().map_or(0, |mode| mode & KIND) {
            0 | 0o100_000 | 0o040_000 => {}
            0o120_000 => return refuse("a symbolic link"),
            _ => return refuse("a special file"),
        }
        if entry.encrypted() {
            return refuse("encrypted");
        }
        if !matches!(entry.compression(), CompressionMethod::Stored | CompressionMethod::Deflated) {
            return refuse("compressed in a way that the standard does not have (it has `deflate` and none)");
        }
        let size = entry.size();
        within(&|| format!("the size of `{}` in bytes", name.escape_debug()), size, limits.file)?;
        total = total.saturating_add(size);
        within(&|| "the size of all its files in bytes".into(), total, limits.total)?;
        let name = name.into_owned();
        names.add(name)?;
    }
    if total > SMALL {
        within(&|| "the size of all its files for a byte of the archive".into(), total / bytes.max(1), limits.ratio)?;
    }
    Ok(names)
}

/// Error for a missing description, with a hint at a nested one; a package (SSP) has its own error.
fn no_description(names: &Names) -> ArchiveProblem {
    if names.index("SystemStructure.ssd").is_some() {
        return ArchiveProblem::Ssp { entry: "SystemStructure.ssd".into() };
    }
    let nested = names.files().find(|name| name.strip_suffix(DESCRIPTION).is_some_and(|folder| folder.ends_with('/')));
    let hint = nested.map(|name| format!(": it is `{name}`; pack the content of the folder, not the folder"));
    ArchiveProblem::NoDescription { hint: hint.unwrap_or_else(|| "; is it an FMU?".into()) }
}
