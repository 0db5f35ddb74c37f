//! Files without a name, and their bytes as memory.
#![expect(unsafe_code, reason = "a mapped file must not change: these have no name by which anybody could open them")]
use memmap2::Mmap;
use std::fs::File;
use std::io::{self, Seek as _, SeekFrom, Write as _};
use std::ops::Deref;
use std::path::Path;

/// A file that only this process has, and that is gone at the end of the process, whatever its cause.
#[derive(Debug)]
pub struct UnnamedFile(File);

impl UnnamedFile {
    /// An empty file on the disk that holds `folder`.
    ///
    /// # Errors
    /// Those of the operating system.
    pub fn new_in(folder: &Path) -> io::Result<Self> {
        tempfile::tempfile_in(folder).map(Self)
    }

    /// Writes `bytes` from the byte `at` on.
    ///
    /// # Errors
    /// Those of the operating system: the disk is full.
    pub fn write_at(&mut self, at: u64, bytes: &[u8]) -> io::Result<()> {
        self.0.seek(SeekFrom::Start(at))?;
        self.0.write_all(bytes)
    }

    /// The first `length` bytes as memory.
    ///
    /// # Errors
    /// Those of the operating system.
    pub fn map(self, length: u64) -> io::Result<MappedFile> {
        self.0.set_len(length)?;
        // SAFETY: only this process has the file, and it is closed here.
        unsafe { Mmap::map(&self.0) }.map(MappedFile)
    }
}

/// Bytes of a file that is not written any more, in memory as far as they are read.
#[derive(Debug)]
pub struct MappedFile(Mmap);

impl MappedFile {
    /// Gives back memory that was taken by reading the bytes. They can be read again; nothing is lost.
    pub fn release(&self) {
        #[cfg(unix)]
        {
            // A hint only: where it is not followed the memory stays until it is needed.
            // SAFETY: the mapping is shared and never written, so that a dropped page comes back from the file.
            let _ = unsafe { self.0.unchecked_advise(memmap2::UncheckedAdvice::DontNeed) };
        }
    }
}

impl Deref for MappedFile {
    type Target = [u8];

    fn deref(&self) -> &[u8] {
        &self.0
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn bytes_are_there_again_after_they_were_released() {
        let mut file = UnnamedFile::new_in(&std::env::temp_dir()).unwrap();
        file.write_at(2, b"cd").unwrap();
        file.write_at(0, b"ab").unwrap();
        let mapped = file.map(3).unwrap();
        assert_eq!(&*mapped, b"abc");
        mapped.release();
        assert_eq!(&*mapped, b"abc");
    }
}
