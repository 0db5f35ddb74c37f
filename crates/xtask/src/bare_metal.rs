//! Bare metal: set-point generators, function blocks and the link to a drive are linked for a machine that has neither `std` nor
//! an allocator.
//!
//! The core library for that machine is a part of the Rust toolchain. Where it cannot be had, the step is left out, and it is said.
use crate::failure::Failure;
use crate::toolchain;
use crate::workspace::Workspace;
use std::process::Command;

/// A Cortex-M4 or -M7 with floating point: what drives are made with.
const TARGET: &str = "thumbv7em-none-eabihf";

/// Whether it can be built here, and why not.
#[derive(Debug)]
pub(crate) struct BareMetal(Result<(), Failure>);

impl BareMetal {
    /// Fetches the core library, unless it is there.
    pub(crate) fn prepare() -> Self {
        Self(toolchain::ensure("core library", TARGET))
    }

    /// The command that links them, if it can be run.
    pub(crate) fn command(&self, workspace: &Workspace) -> Option<Command> {
        let build = ["build", "--release", "--package", "servobench-bare-metal", "--target", TARGET];
        self.0.is_ok().then(|| workspace.cargo(build))
    }

    /// Says what is left out, if it is.
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
