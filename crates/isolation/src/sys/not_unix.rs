//! A system without signals: a request to end a program ends it at once.
use std::convert::Infallible;
use std::io;
use std::process::ExitStatus;

/// Requests to end this program: none is received here.
#[derive(Debug)]
pub struct Interrupts(Infallible);

/// A request to end this program.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Interrupt(Infallible);

impl Interrupts {
    /// `None`: a request to end this program ends it.
    ///
    /// # Errors
    /// None.
    pub fn listen() -> io::Result<Option<Self>> {
        Ok(None)
    }

    /// None.
    pub fn all(&mut self) -> impl Iterator<Item = Interrupt> {
        std::iter::empty()
    }
}

impl Interrupt {
    /// `true` when it came from the keyboard.
    #[must_use]
    pub const fn is_from_keyboard(self) -> bool {
        match self.0 {}
    }

    /// Ends this program.
    pub fn end(self) -> ! {
        match self.0 {}
    }
}

/// Does nothing: the system has no limit of file size that would end the process.
///
/// # Errors
/// None.
pub fn refuse_large_files() -> io::Result<()> {
    Ok(())
}

/// Does nothing: the system has no limit of open files that could be raised.
pub fn allow_open_files(_: u64) {}

/// No signal ends a process.
pub(crate) fn signal_of(_: ExitStatus) -> Option<i32> {
    None
}
