//! Bare metal: links set-point generators, function blocks and the link to a drive for a machine that has neither `std` nor an allocator.
//!
//! The core library for that machine is a part of the Rust toolchain. Where it cannot be fetched, the step is left out and reported.
use crate::failure::Failure;
use crate::toolchain;
use crate::workspace::Workspace;
use std::process::Command;

/// A Cortex-M4 or -M7 with floating point, as in many drives.
const TARGET: &str = "thumbv7em-none-eabihf";

/// Result of fetching the core library.
#[derive(Debug)]
pub(crate) struct BareMetal(Result<(), Failure>);

impl BareMetal {
    /// Fetches the core library, unless it is there.
    pub(crate) fn prepare() -> Self {
        Self(toolchain::ensure("core library", TARGET))
    }

    /// The command that links everything, if it can be run.
    pub(crate) fn command(&self, workspace: &Workspace) -> Option<Command> {
        let build = ["build", "--release", "--package", "servobench-bare-metal", "--target", TARGET];
        self.0.is_ok().then(|| workspace.cargo(build))
    }

    /// Reports the step if it is left out.
    pub(crate) fn report(&self) {
        if let Err(why) = &self.0 {
            println!(
                "LEFT OUT, bare metal: that set-point generators, function blocks and link need no `std` and no heap\n  {why}"
            );
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_cannot_be_built_is_no_step() {
        let nowhere = Workspace { root: ".".into(), target: "target".into() };
        assert!(BareMetal(Ok(())).command(&nowhere).is_some());
        let why = Failure::Usage { given: String::new(), commands: String::new() };
        assert!(BareMetal(Err(why)).command(&nowhere).is_none());
    }
}
