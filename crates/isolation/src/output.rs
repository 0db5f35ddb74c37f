//! What a contained process writes on standard output and standard error.
use rustix::io::ioctl_fionbio;
use std::io::{self, Read};
use std::os::fd::AsFd;

/// Bytes of each stream that are kept: the last ones.
const KEPT: usize = 4_000;
/// Bytes that are read at once.
const CHUNK: usize = 1 << 16;
/// Chunks that are read in one visit: as much as a pipe holds at most by default (`/proc/sys/fs/pipe-max-size`), so that
/// nothing that was written before the visit is left, and one that goes on writing holds nobody up.
const CHUNKS: usize = 16;

/// One stream of the process: it is always read, so that the writer never waits, and of a flood only the end is kept.
#[derive(Debug)]
pub struct Stream<S> {
    /// `None` after its end.
    source: Option<S>,
    kept: Vec<u8>,
    /// Bytes since the last time it was taken.
    count: u64,
    chunk: Vec<u8>,
}

impl<S: Read + AsFd> Stream<S> {
    /// Listens to `source`, which from now on does not wait.
    ///
    /// # Errors
    /// Those of the system.
    pub fn new(source: S) -> io::Result<Self> {
        ioctl_fionbio(&source, true)?;
        Ok(Self { source: Some(source), kept: Vec::new(), count: 0, chunk: vec![0; CHUNK] })
    }

    /// Where to listen, before its end.
    #[must_use]
    pub fn source(&self) -> Option<&S> {
        self.source.as_ref()
    }

    /// Reads what is there.
    pub fn drain(&mut self) {
        for _ in 0..CHUNKS {
            let Some(source) = &mut self.source else { return };
            match source.read(&mut self.chunk) {
                Ok(0) => self.source = None,
                Ok(count) => {
                    self.count += count as u64;
                    self.kept.extend_from_slice(&self.chunk[..count]);
                    if self.kept.len() > 2 * KEPT {
                        self.kept.drain(..self.kept.len() - KEPT);
                    }
                }
                Err(error) if error.kind() == io::ErrorKind::Interrupted => {}
                Err(error) if error.kind() == io::ErrorKind::WouldBlock => return,
                // Nothing comes out of it any more.
                Err(_) => self.source = None,
            }
        }
    }

    /// What has come since the last time, and how many bytes before that were dropped.
    pub fn take(&mut self) -> Option<(String, u64)> {
        let kept = &self.kept[self.kept.len().saturating_sub(KEPT)..];
        let dropped = self.count - kept.len() as u64;
        let text = String::from_utf8_lossy(kept).trim_end().to_owned();
        self.kept.clear();
        let some = self.count > 0;
        self.count = 0;
        some.then_some((text, dropped))
    }

    /// The last bytes, which stay.
    #[must_use]
    pub fn last_words(&self) -> String {
        let kept = &self.kept[self.kept.len().saturating_sub(KEPT)..];
        String::from_utf8_lossy(kept).trim().to_owned()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::io::Write;

    #[test]
    fn of_a_flood_the_end_is_kept_and_the_rest_counted() {
        let (reader, mut writer) = io::pipe().unwrap();
        let mut stream = Stream::new(reader).unwrap();
        let flood = vec![b'x'; 50_000];
        for _ in 0..20 {
            writer.write_all(&flood).unwrap();
            stream.drain();
        }
        writer.write_all(b"the reason\n").unwrap();
        stream.drain();
        assert!(stream.last_words().ends_with("xthe reason"));
        let (text, dropped) = stream.take().unwrap();
        assert_eq!((text.len() as u64 + 1 + dropped, text.ends_with("xthe reason")), (1_000_011, true));
        assert_eq!(stream.take(), None);
        writer.write_all(b"more").unwrap();
        stream.drain();
        assert_eq!(stream.take(), Some(("more".into(), 0)));
        drop(writer);
        stream.drain();
        assert!(stream.source().is_none());
    }

    /// One that writes as fast as it is read: a visit ends all the same.
    #[test]
    fn a_visit_ends_however_much_comes() {
        let mut stream = Stream::new(std::fs::File::open("/dev/zero").unwrap()).unwrap();
        stream.drain();
        assert_eq!(stream.take().unwrap().1, (CHUNK * CHUNKS - KEPT) as u64);
    }
}
