//! Standard output and standard error of a contained process.
use std::io::{self, PipeReader, Read};

/// Bytes of each stream that are kept: the last ones.
const KEPT: usize = 4_000;
/// Bytes that are read at once.
const CHUNK: usize = 1 << 16;
/// Chunks that are read in one call: as much as a pipe holds at most by default (`/proc/sys/fs/pipe-max-size`), so that nothing written
/// before the call is left, and a process that continues to write causes no delay.
const CHUNKS: usize = 16;

/// Output text of a contained process.
#[derive(Debug)]
pub struct Output {
    /// Its standard output, unless redirected.
    pub stdout: Option<Stream<PipeReader>>,
    /// Its standard error.
    pub stderr: Stream<PipeReader>,
}

/// One stream of the process: it is always read, so that the writer never waits, and only the end of a flood is kept.
#[derive(Debug)]
pub struct Stream<S> {
    /// `None` after its end.
    source: Option<S>,
    kept: Vec<u8>,
    /// Bytes since the last call of [`Stream::take`].
    count: u64,
    chunk: Vec<u8>,
}

impl<S: Read> Stream<S> {
    /// Reads from `source`, which must not block: without data it returns [`io::ErrorKind::WouldBlock`].
    pub fn new(source: S) -> Self {
        Self { source: Some(source), kept: Vec::new(), count: 0, chunk: vec![0; CHUNK] }
    }

    /// The source, until its end.
    #[must_use]
    pub fn source(&self) -> Option<&S> {
        self.source.as_ref()
    }

    /// Reads the available bytes.
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
                // The source has no more data.
                Err(_) => self.source = None,
            }
        }
    }

    /// Text since the last call, and the number of dropped bytes before it.
    pub fn take(&mut self) -> Option<(String, u64)> {
        let kept = &self.kept[self.kept.len().saturating_sub(KEPT)..];
        let dropped = self.count - kept.len() as u64;
        let text = String::from_utf8_lossy(kept).trim_end().to_owned();
        self.kept.clear();
        let some = self.count > 0;
        self.count = 0;
        some.then_some((text, dropped))
    }

    /// The last bytes, without taking them.
    #[must_use]
    pub fn last_words(&self) -> String {
        let kept = &self.kept[self.kept.len().saturating_sub(KEPT)..];
        String::from_utf8_lossy(kept).trim().to_owned()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A pipe: the bytes that are in it, and whether it is still open for writing.
    struct Pipe(Vec<u8>, bool);

    impl Read for Pipe {
        fn read(&mut self, bytes: &mut [u8]) -> io::Result<usize> {
            let count = bytes.len().min(self.0.len());
            if count == 0 && self.1 {
                return Err(io::ErrorKind::WouldBlock.into());
            }
            bytes[..count].copy_from_slice(&self.0[..count]);
            self.0.drain(..count);
            Ok(count)
        }
    }

    fn write(stream: &mut Stream<Pipe>, bytes: &[u8]) {
        stream.source.as_mut().unwrap().0.extend(bytes);
        stream.drain();
    }

    #[test]
    fn of_a_flood_the_end_is_kept_and_the_rest_counted() {
        let mut stream = Stream::new(Pipe(Vec::new(), true));
        for _ in 0..20 {
            write(&mut stream, &vec![b'x'; 50_000]);
        }
        write(&mut stream, b"the reason\n");
        assert!(stream.last_words().ends_with("xthe reason"));
        let (text, dropped) = stream.take().unwrap();
        assert_eq!((text.len() as u64 + 1 + dropped, text.ends_with("xthe reason")), (1_000_011, true));
        assert_eq!(stream.take(), None);
        write(&mut stream, b"more");
        assert_eq!(stream.take(), Some(("more".into(), 0)));
        stream.source.as_mut().unwrap().1 = false;
        stream.drain();
        assert!(stream.source().is_none());
    }

    /// A source that writes as fast as it is read: a call ends all the same.
    #[test]
    fn a_visit_ends_however_much_comes() {
        let mut stream = Stream::new(io::repeat(0));
        stream.drain();
        assert_eq!(stream.take().unwrap().1, (CHUNK * CHUNKS - KEPT) as u64);
    }
}
