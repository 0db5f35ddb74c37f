//! Frames on their way in one direction.

use servobench_base::Stateful;
/// Capacity of a pipe (frames).
const LENGTH: usize = 16;

/// A delay line: a frame per cycle goes in, another comes out.
#[derive(Debug, Clone, Copy, PartialEq, Stateful)]
pub(super) struct Pipe<T> {
    frames: [Option<T>; LENGTH],
    /// Index of the next input.
    entry: usize,
}

impl<T: Copy> Default for Pipe<T> {
    fn default() -> Self {
        Self { frames: [None; LENGTH], entry: 0 }
    }
}

impl<T: Copy> Pipe<T> {
    /// Puts in a frame and takes out the one from `delay` cycles ago; `delay` is below [`LENGTH`].
    pub(super) const fn carry(&mut self, frame: Option<T>, delay: usize) -> Option<T> {
        self.frames[self.entry] = frame;
        let exit = (self.entry + LENGTH - delay) % LENGTH;
        self.entry = (self.entry + 1) % LENGTH;
        self.frames[exit]
    }
}
