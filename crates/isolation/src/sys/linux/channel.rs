//! A channel between two processes: a pair of sockets.
use std::fs::File;
use std::io::{self, Read, Write};
use std::net::Shutdown;
use std::os::fd::{AsFd as _, OwnedFd};
use std::os::unix::net::UnixStream;
use std::process::Stdio;
use std::time::Duration;

/// One end of a channel between two processes. Bytes written at one end are read at the other.
#[derive(Debug)]
pub struct Channel(UnixStream);

impl Channel {
    /// Both ends: one to keep, one that a contained process gets as its standard input.
    ///
    /// # Errors
    /// Those of the operating system.
    pub fn pair() -> io::Result<(Self, Self)> {
        let (one, other) = UnixStream::pair()?;
        Ok((Self(one), Self(other)))
    }

    /// Sets a timeout: reading and writing then fail with [`io::ErrorKind::WouldBlock`] after `time` at the latest.
    ///
    /// # Errors
    /// Those of the operating system.
    pub fn set_timeout(&self, time: Duration) -> io::Result<()> {
        self.0.set_read_timeout(Some(time))?;
        self.0.set_write_timeout(Some(time))
    }

    /// The same end again.
    ///
    /// # Errors
    /// Those of the operating system.
    pub fn try_clone(&self) -> io::Result<Self> {
        self.0.try_clone().map(Self)
    }

    /// Ends the channel in both directions.
    ///
    /// # Errors
    /// Those of the operating system: the other end is gone.
    pub fn close(&self) -> io::Result<()> {
        self.0.shutdown(Shutdown::Both)
    }
}

impl Read for Channel {
    fn read(&mut self, bytes: &mut [u8]) -> io::Result<usize> {
        self.0.read(bytes)
    }
}

impl Write for Channel {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        self.0.write(bytes)
    }

    fn flush(&mut self) -> io::Result<()> {
        self.0.flush()
    }
}

impl From<Channel> for Stdio {
    fn from(channel: Channel) -> Self {
        OwnedFd::from(channel.0).into()
    }
}

/// Takes over standard input, a channel, and standard output, a file, of this process: code that reads standard input from now on finds it
/// empty, and output on standard output goes to standard error.
///
/// # Errors
/// Those of the operating system.
pub fn claim_standard_streams() -> io::Result<(Channel, File)> {
    let (stdin, stdout) = (io::stdin().as_fd().try_clone_to_owned()?, io::stdout().as_fd().try_clone_to_owned()?);
    rustix::stdio::dup2_stdin(File::open("/dev/null")?)?;
    rustix::stdio::dup2_stdout(io::stderr())?;
    Ok((Channel(stdin.into()), stdout.into()))
}
