//! Files that are complete or absent.
use std::ffi::OsString;
use std::fs::{self, File};
use std::io::{self, BufWriter, ErrorKind, Write};
use std::path::{Path, PathBuf};
use std::process;
use std::sync::atomic::{AtomicU64, Ordering};

/// Writes the file `path`, completely or not at all: `bytes` go to a file of another name beside it, which then replaces
/// it. Several writers of one path, in one process or in many, do not disturb each other; the last one stays.
///
/// # Errors
/// Those of the operating system. An older file of that name is then unchanged, and nothing is left beside it.
pub fn write_whole(path: impl AsRef<Path>, bytes: impl AsRef<[u8]>) -> io::Result<()> {
    stream_whole(path, |file| file.write_all(bytes.as_ref()))
}

/// Writes the output of `write`, completely or not at all, as [`write_whole`]: for files larger than memory.
///
/// # Errors
/// Those of `write` and of the operating system, as in [`write_whole`].
pub fn stream_whole<E: From<io::Error>>(
    path: impl AsRef<Path>,
    write: impl FnOnce(&mut BufWriter<&File>) -> Result<(), E>,
) -> Result<(), E> {
    Ok(streamed(path.as_ref(), write)?.finish()?)
}

/// The same, and syncs the bytes to disk before they replace the old file, and their name before it returns: a power failure
/// leaves either the old file or the new one.
///
/// # Errors
/// As [`stream_whole`].
pub fn stream_durably<E: From<io::Error>>(
    path: impl AsRef<Path>,
    write: impl FnOnce(&mut BufWriter<&File>) -> Result<(), E>,
) -> Result<(), E> {
    let path = path.as_ref();
    let unfinished = streamed(path, write)?;
    unfinished.file.sync_all()?;
    unfinished.finish()?;
    let folder = path.parent().filter(|folder| !folder.as_os_str().is_empty()).unwrap_or_else(|| Path::new("."));
    // A folder that cannot be opened or synced still holds the file.
    File::open(folder).and_then(|folder| folder.sync_all()).ok();
    Ok(())
}

fn streamed<E: From<io::Error>>(
    path: &Path,
    write: impl FnOnce(&mut BufWriter<&File>) -> Result<(), E>,
) -> Result<Unfinished, E> {
    let unfinished = Unfinished::create(path)?;
    let mut buffered = BufWriter::new(&unfinished.file);
    write(&mut buffered)?;
    buffered.flush()?;
    drop(buffered);
    Ok(unfinished)
}

/// A file that gets its name when it is finished. Dropped before that, it is gone.
#[derive(Debug)]
pub(crate) struct Unfinished {
    /// For writing and reading.
    pub(crate) file: File,
    path: PathBuf,
    target: PathBuf,
    is_finished: bool,
}

impl Unfinished {
    /// An empty file that will be `target`.
    pub(crate) fn create(target: &Path) -> io::Result<Self> {
        static COUNTER: AtomicU64 = AtomicU64::new(0);
        loop {
            let path = partial_path(target, COUNTER.fetch_add(1, Ordering::Relaxed));
            match File::options().read(true).write(true).create_new(true).open(&path) {
                Ok(file) => return Ok(Self { file, path, target: target.to_path_buf(), is_finished: false }),
                // Left by a process of the same id that was killed, or being written from another machine.
                Err(error) if error.kind() == ErrorKind::AlreadyExists => {}
                Err(error) => return Err(error),
            }
        }
    }

    /// Moves the file to its place.
    pub(crate) fn finish(mut self) -> io::Result<()> {
        fs::rename(&self.path, &self.target)?;
        self.is_finished = true;
        Ok(())
    }
}

impl Drop for Unfinished {
    fn drop(&mut self) {
        if !self.is_finished {
            // An error has been reported already; a file that cannot be removed either changes nothing.
            fs::remove_file(&self.path).ok();
        }
    }
}

/// A file for another process to read; it is removed when this is dropped.
#[derive(Debug)]
pub struct PassingFile(pub(crate) Unfinished);

impl PassingFile {
    /// Path of the file.
    #[must_use]
    pub fn path(&self) -> &Path {
        &self.0.path
    }
}

/// Bytes of the target's name in that of its file on the way: with what is added it has to fit into the 255 of most file systems.
const LONGEST: usize = 200;

/// Id of the process that was writing the unfinished file called `name`; `None` for any other name.
#[must_use]
pub fn unfinished_by(name: &str) -> Option<u32> {
    let (_, number) = name.strip_prefix('.')?.strip_suffix(".partial")?.rsplit_once('.')?;
    let (process, count) = number.split_once('-')?;
    count.parse::<u64>().ok()?;
    process.parse().ok()
}

/// A name beside `target` that no other writer uses: unique within the process by the number, across processes by their ids.
fn partial_path(target: &Path, number: u64) -> PathBuf {
    let mut name = OsString::from(".");
    let whole = target.file_name().unwrap_or_default();
    if whole.len() > LONGEST {
        let whole = whole.to_string_lossy();
        name.push(&whole[..whole.floor_char_boundary(LONGEST)]);
    } else {
        name.push(whole);
    }
    name.push(format!(".{}-{number}.partial", process::id()));
    target.with_file_name(name)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_file_that_is_not_whole_is_known_by_its_name() {
        let path = partial_path(Path::new("out/a.b.parquet"), 7);
        assert_eq!(unfinished_by(path.file_name().unwrap().to_str().unwrap()), Some(process::id()));
        for name in ["a.parquet", ".partial", ".a.partial", ".a.7.partial", ".a.x-7.partial", "a.7-7.partial"] {
            assert_eq!(unfinished_by(name), None, "{name}");
        }
    }

    fn names(folder: &Path) -> Vec<String> {
        let entries = fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().file_name().into_string().unwrap());
        let mut names: Vec<_> = entries.collect();
        names.sort();
        names
    }

    #[test]
    fn a_file_that_is_not_finished_leaves_the_old_one_and_nothing_else() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("results.json");
        write_whole(&path, "old").unwrap();
        let mut unfinished = Unfinished::create(&path).unwrap();
        unfinished.file.write_all(b"half of the n").unwrap();
        assert_eq!(names(folder.path()).len(), 2);
        assert_eq!(fs::read(&path).unwrap(), b"old");
        drop(unfinished);
        assert_eq!(names(folder.path()), ["results.json"]);
        assert_eq!(fs::read(&path).unwrap(), b"old");
    }

    #[test]
    fn a_stream_that_breaks_off_leaves_the_old_file() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("plan.csv");
        write_whole(&path, "old").unwrap();
        let broken = stream_whole(&path, |file| {
            file.write_all(&vec![b'x'; 100_000])?;
            Err(io::Error::other("enough"))
        });
        assert_eq!(broken.unwrap_err().to_string(), "enough");
        assert_eq!((names(folder.path()), fs::read(&path).unwrap()), (vec!["plan.csv".to_owned()], b"old".to_vec()));
        stream_whole(&path, |file| (0..1000).try_for_each(|k| writeln!(file, "{k}"))).unwrap();
        assert_eq!(fs::read_to_string(&path).unwrap().lines().last(), Some("999"));
    }

    #[test]
    fn a_target_that_cannot_be_replaced_leaves_nothing_beside_it() {
        let folder = tempfile::tempdir().unwrap();
        let taken = folder.path().join("taken");
        fs::create_dir_all(taken.join("by a folder")).unwrap();
        assert!(write_whole(&taken, "text").is_err());
        assert_eq!(names(folder.path()), ["taken"]);
    }

    /// A name may be as long as the file system permits.
    #[test]
    fn the_longest_name_is_written() {
        let folder = tempfile::tempdir().unwrap();
        for name in ["x".repeat(255), "µ".repeat(127)] {
            write_whole(folder.path().join(&name), "text").unwrap();
            assert_eq!(fs::read(folder.path().join(&name)).unwrap(), b"text");
        }
        assert!(write_whole(folder.path().join("x".repeat(256)), "text").is_err());
        assert_eq!(names(folder.path()).len(), 2);
    }

    #[cfg(unix)]
    #[test]
    fn a_link_is_replaced_and_not_followed() {
        let folder = tempfile::tempdir().unwrap();
        let (link, victim) = (folder.path().join("results.json"), folder.path().join("victim"));
        fs::write(&victim, "victim").unwrap();
        for write in [
            |path: &Path| write_whole(path, "new").unwrap(),
            |path: &Path| stream_durably(path, |file| file.write_all(b"new")).unwrap(),
        ] {
            std::os::unix::fs::symlink(&victim, &link).unwrap();
            write(&link);
            assert!(!link.is_symlink());
            assert_eq!((fs::read(&link).unwrap(), fs::read(&victim).unwrap()), (b"new".to_vec(), b"victim".to_vec()));
            fs::remove_file(&link).unwrap();
        }
    }

    /// Files left by killed processes of the same id do not matter.
    #[test]
    fn names_that_are_taken_are_passed_over() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("results.json");
        for number in 0..1000 {
            fs::write(partial_path(&path, number), "left").unwrap();
        }
        write_whole(&path, "whole").unwrap();
        assert_eq!(fs::read(&path).unwrap(), b"whole");
        assert_eq!(names(folder.path()).len(), 1001);
    }

    /// A reader finds one of the texts, never a mixture and never a part.
    #[test]
    fn writers_of_one_path_do_not_disturb_each_other() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("results.json");
        let texts: Vec<String> = (1..=4_usize).map(|k| k.to_string().repeat(100_000 * k)).collect();
        std::thread::scope(|scope| {
            for text in &texts {
                let path = &path;
                scope.spawn(move || (0..20).for_each(|_| write_whole(path, text).unwrap()));
            }
            for _ in 0..50 {
                match fs::read_to_string(&path) {
                    Ok(found) => assert!(texts.contains(&found), "{} bytes", found.len()),
                    Err(error) => assert_eq!(error.kind(), ErrorKind::NotFound),
                }
            }
        });
        assert_eq!(names(folder.path()), ["results.json"]);
    }
}
