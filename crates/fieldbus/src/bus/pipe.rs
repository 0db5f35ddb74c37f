//! Frames under way in one direction.

use servobench_base::Stateful;
/// Frames that a pipe holds at most.
const LENGTH: usize = 16;

/// A frame per cycle goes in, another comes out.
#[derive(Debug, Clone, Copy, PartialEq, Stateful)]
pub(super) struct Pipe<T> {
    frames: [Option<T>; LENGTH],
    /// Where the next one goes in.
    entry: usize,
}

impl<T: Copy> Default for Pipe<T> {
    fn default() -> Self {
        Self { frames: [None; LENGTH], entry: 0 }
    }
}

impl<T: Copy> Pipe<T> {
    /// Puts a frame in, takes out the one that was put in `delay` cycles ago; `delay` is below [`LENGTH`].
    pub(super) const fn carry(&mut self, frame: Option<T>, delay: usize) -> Option<T> {
        self.frames[self.entry] = frame;
        let exit = (self.entry + LENGTH - delay) % LENGTH;
        self.entry = (self.entry + 1) % LENGTH;
        self.frames[exit]
    }
}
