//! Target of an output: a file, a stream or standard output, neither an input nor another output.
use crate::console;
use crate::error::CliError;
use servobench_files::Destination;
use servobench_trace::{stream_durably, stream_whole};
use std::fs::File;
use std::io::{self, BufWriter, Write};
use std::path::{Path, PathBuf};

/// Target of an output. A file gets its name when it is whole; standard output, a pipe or a device receives data at once.
#[derive(Debug, Clone)]
pub(crate) struct Output {
    to: To,
}

#[derive(Debug, Clone)]
enum To {
    File(PathBuf),
    /// A file in a folder that may have to be made.
    FileAnywhere(PathBuf),
    /// A device, a pipe or a standard stream named by a path.
    Stream(PathBuf, Destination),
    /// Without a named file, or for `-`.
    StandardOutput,
}

impl Output {
    pub(super) const STANDARD_OUTPUT: Self = Self { to: To::StandardOutput };

    pub(super) fn at(path: &Path, kind: Destination) -> Self {
        let path = path.to_owned();
        let to = match kind {
            Destination::File | Destination::Folder => To::File(path),
            Destination::Device | Destination::Pipe | Destination::StandardOutput | Destination::StandardError => {
                To::Stream(path, kind)
            }
        };
        Self { to }
    }

    /// The same file in a folder that is made if missing.
    pub(super) fn anywhere(self) -> Self {
        match self.to {
            To::File(path) => Self { to: To::FileAnywhere(path) },
            to => Self { to },
        }
    }

    /// True for standard output, unless a path names it.
    pub(crate) const fn is_standard_output(&self) -> bool {
        matches!(self.to, To::StandardOutput)
    }

    /// The path that the user named; `None` for standard output.
    pub(crate) fn path(&self) -> Option<&Path> {
        match &self.to {
            To::File(path) | To::FileAnywhere(path) | To::Stream(path, _) => Some(path),
            To::StandardOutput => None,
        }
    }

    /// Name in messages.
    pub(crate) fn shown(&self) -> String {
        self.path().map_or_else(|| "standard output".to_owned(), |path| path.display().to_string())
    }

    /// Writes text, made fit for a terminal on standard output: the whole file or nothing.
    pub(crate) fn write_text(&self, text: &str) -> Result<(), CliError> {
        if self.is_standard_output() { console::print(text) } else { self.write(text) }
    }

    /// Writes the whole file or nothing.
    pub(crate) fn write(&self, bytes: impl AsRef<[u8]>) -> Result<(), CliError> {
        match &self.to {
            To::StandardOutput => console::print_bytes(bytes.as_ref()),
            To::File(_) | To::FileAnywhere(_) | To::Stream(..) => {
                self.stream(|out| out.write_all(bytes.as_ref()).map_err(|error| self.failed(error)))
            }
        }
    }

    /// Writes the output of `write`, the whole file or nothing: for more than fits in memory.
    pub(crate) fn stream(
        &self,
        write: impl FnOnce(&mut (dyn Write + Send)) -> Result<(), CliError>,
    ) -> Result<(), CliError> {
        self.streamed(write, false)
    }

    /// Like [`Self::stream`], and syncs the file to disk before it replaces an earlier one.
    pub(crate) fn stream_durably(
        &self,
        write: impl FnOnce(&mut (dyn Write + Send)) -> Result<(), CliError>,
    ) -> Result<(), CliError> {
        self.streamed(write, true)
    }

    /// Lets another process, started by `run`, write the file: the whole file or nothing.
    pub(crate) fn by_process(&self, run: impl FnOnce(File) -> Result<(), CliError>) -> Result<(), CliError> {
        match &self.to {
            To::File(path) | To::FileAnywhere(path) => {
                let copied =
                    |file: &mut BufWriter<&File>| file.get_ref().try_clone().map_err(|error| self.failed(error));
                self.whole(path, |file| run(copied(file)?), false)
            }
            To::Stream(path, kind) => run(kind.open(path).map_err(|error| self.failed(error))?),
            To::StandardOutput => {
                let path = Path::new("standard output");
                run(Destination::StandardOutput.open(path).map_err(|error| self.failed(error))?)
            }
        }
    }

    fn streamed(
        &self,
        write: impl FnOnce(&mut (dyn Write + Send)) -> Result<(), CliError>,
        is_durable: bool,
    ) -> Result<(), CliError> {
        match &self.to {
            To::File(path) => self.whole(path, |file| write(file), is_durable),
            To::FileAnywhere(path) => {
                if let Some(folder) = path.parent().filter(|folder| !folder.as_os_str().is_empty()) {
                    super::make_folder(folder)?;
                }
                self.whole(path, |file| write(file), is_durable)
            }
            To::Stream(path, kind) => {
                let mut out = BufWriter::new(Read(kind.open(path).map_err(|error| self.failed(error))?));
                write(&mut out)?;
                out.flush().map_err(|error| self.failed(error))
            }
            To::StandardOutput => {
                let mut bytes = Vec::new();
                write(&mut bytes)?;
                console::print_bytes(&bytes)
            }
        }
    }

    fn whole(
        &self,
        path: &Path,
        write: impl FnOnce(&mut BufWriter<&File>) -> Result<(), CliError>,
        is_durable: bool,
    ) -> Result<(), CliError> {
        // Errors of the file and errors of `write` return by one path.
        let mut said = None;
        let write = |file: &mut BufWriter<&File>| {
            write(file).map_err(|error| {
                said = Some(error);
                io::Error::other("not written")
            })
        };
        let done = if is_durable { stream_durably(path, write) } else { stream_whole(path, write) };
        match (done, said) {
            (_, Some(error)) => Err(error),
            (done, None) => done.map_err(|error| self.failed(error)),
        }
    }

    /// Error of a failed write.
    pub(crate) fn failed(&self, error: io::Error) -> CliError {
        match self.path() {
            Some(path) => CliError::Write { path: path.to_owned(), error },
            None => CliError::Print(error),
        }
    }
}

/// A stream whose reader may close it early: a broken pipe is not an error.
struct Read(File);

impl Write for Read {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        match self.0.write(bytes) {
            Err(error) if error.kind() == io::ErrorKind::BrokenPipe => Ok(bytes.len()),
            done => done,
        }
    }

    fn flush(&mut self) -> io::Result<()> {
        self.0.flush()
    }
}
