//! Errors of a machine with too few resources, as opposed to those of a file.
use crate::sys;
use std::io;

/// `true` when the operating system refuses for want of descriptors, processes, memory or space on a disk: another time, or on another
/// machine, the same would succeed.
#[must_use]
pub fn is_shortage(error: &io::Error) -> bool {
    sys::is_shortage(error)
}

/// `true` when this process, or the machine, has too many files open.
#[must_use]
pub fn is_too_many_open(error: &io::Error) -> bool {
    sys::is_too_many_open(error)
}

#[cfg(all(test, unix))]
mod tests {
    use super::*;

    #[test]
    fn a_file_that_is_not_there_is_no_shortage() {
        // EMFILE, ENOSPC, ENOENT, EACCES; ENFILE of Linux (errno(3)).
        let are = [24, 28, 2, 13].map(|code| is_shortage(&io::Error::from_raw_os_error(code)));
        assert_eq!(are, [true, true, false, false]);
        let open = [24, 23, 28, 2].map(|code| is_too_many_open(&io::Error::from_raw_os_error(code)));
        assert_eq!(open, [true, true, false, false]);
        // A file that is too large for us may still fit the system.
        assert!(!is_shortage(&io::ErrorKind::FileTooLarge.into()));
    }
}
