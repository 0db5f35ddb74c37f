//! Errors of a machine that has too little of something, as opposed to those of a file.
use std::io;

/// Whether the operating system refuses for want of descriptors, processes, memory or room on a disk: another time, or on another
/// machine, the same would succeed.
#[must_use]
pub fn is_shortage(error: &io::Error) -> bool {
    #[cfg(unix)]
    {
        use rustix::io::Errno;
        const SHORTAGES: [Errno; 7] =
            [Errno::MFILE, Errno::NFILE, Errno::AGAIN, Errno::NOMEM, Errno::NOSPC, Errno::DQUOT, Errno::FBIG];
        error.raw_os_error().is_some_and(|code| SHORTAGES.iter().any(|errno| errno.raw_os_error() == code))
    }
    #[cfg(not(unix))]
    {
        matches!(error.kind(), io::ErrorKind::OutOfMemory | io::ErrorKind::StorageFull)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_file_that_is_not_there_is_no_shortage() {
        // EMFILE, ENOSPC, ENOENT, EACCES of Linux (errno(3)).
        let are = [24, 28, 2, 13].map(|code| is_shortage(&io::Error::from_raw_os_error(code)));
        assert_eq!(are, [true, true, false, false]);
        // A file that is too large for us is not one that is too large for the system.
        assert!(!is_shortage(&io::ErrorKind::FileTooLarge.into()));
    }
}
