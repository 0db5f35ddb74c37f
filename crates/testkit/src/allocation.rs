//! Number and size of a thread's allocations.
use std::alloc::{GlobalAlloc, Layout, System};
use std::cell::Cell;

thread_local! {
    static COUNT: Cell<u64> = const { Cell::new(0) };
    static LARGEST: Cell<usize> = const { Cell::new(0) };
}

/// The system's allocator with counters; a test sets it as its `#[global_allocator]`. Growing a block counts as an allocation.
#[derive(Debug, Clone, Copy)]
pub struct CountingAllocator;

impl CountingAllocator {
    /// Allocations of this thread so far.
    #[must_use]
    pub fn count() -> u64 {
        COUNT.get()
    }

    /// Result of `call`, and its largest allocation (bytes).
    pub fn largest_of<T>(call: impl FnOnce() -> T) -> (T, usize) {
        LARGEST.set(0);
        let given = call();
        (given, LARGEST.get())
    }
}

fn note(size: usize) {
    COUNT.set(COUNT.get() + 1);
    LARGEST.set(LARGEST.get().max(size));
}

#[expect(unsafe_code, reason = "an allocator is unsafe by contract; this one only counts and passes on")]
// SAFETY: the system's allocator, to which every call is passed on.
unsafe impl GlobalAlloc for CountingAllocator {
    unsafe fn alloc(&self, layout: Layout) -> *mut u8 {
        note(layout.size());
        // SAFETY: the caller's promises are passed on unchanged.
        unsafe { System.alloc(layout) }
    }

    unsafe fn dealloc(&self, memory: *mut u8, layout: Layout) {
        // SAFETY: as above.
        unsafe { System.dealloc(memory, layout) }
    }

    unsafe fn realloc(&self, memory: *mut u8, layout: Layout, size: usize) -> *mut u8 {
        note(size);
        // SAFETY: as above.
        unsafe { System.realloc(memory, layout, size) }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[global_allocator]
    static ALLOCATOR: CountingAllocator = CountingAllocator;

    #[test]
    fn what_is_allocated_and_what_grows_is_counted() {
        let before = CountingAllocator::count();
        let (mut bytes, largest) = CountingAllocator::largest_of(|| Vec::<u8>::with_capacity(1000));
        assert_eq!((CountingAllocator::count() - before, largest), (1, 1000));
        bytes.resize(1000, 1);
        let ((), largest) = CountingAllocator::largest_of(|| bytes.reserve_exact(5000));
        assert_eq!((CountingAllocator::count() - before, largest), (2, 6000));
    }
}
