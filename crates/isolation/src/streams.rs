//! The standard streams of a contained process, which are more than text.
use std::fs::File;
use std::io;
use std::os::fd::{AsFd, OwnedFd};

/// Takes standard input and standard output of this process for something else: what reads standard input from now on finds nothing, and
/// what is written on standard output goes to standard error.
///
/// # Errors
/// Those of the system.
pub fn claim_standard_streams() -> io::Result<(OwnedFd, OwnedFd)> {
    let (stdin, stdout) = (io::stdin().as_fd().try_clone_to_owned()?, io::stdout().as_fd().try_clone_to_owned()?);
    rustix::stdio::dup2_stdin(File::open("/dev/null")?)?;
    rustix::stdio::dup2_stdout(io::stderr())?;
    Ok((stdin, stdout))
}
