//! A tick allocates nothing, whether it exchanges or extrapolates.
use super::*;
use std::alloc::{GlobalAlloc, Layout, System};
use std::cell::Cell;

thread_local! {
    static COUNT: Cell<u64> = const { Cell::new(0) };
}

struct Counting;

#[global_allocator]
static COUNTING: Counting = Counting;

#[expect(unsafe_code, reason = "an allocator is unsafe by contract; this one only counts and passes on")]
// SAFETY: the system's, counted.
unsafe impl GlobalAlloc for Counting {
    unsafe fn alloc(&self, layout: Layout) -> *mut u8 {
        COUNT.set(COUNT.get() + 1);
        // SAFETY: as the caller promises.
        unsafe { System.alloc(layout) }
    }

    unsafe fn dealloc(&self, memory: *mut u8, layout: Layout) {
        // SAFETY: as the caller promises.
        unsafe { System.dealloc(memory, layout) }
    }
}

#[test]
fn a_tick_allocates_nothing() {
    let mut fmu = mechanics(ExactFmu::new(3.0 * TICK), &model(3), &IN_SI);
    let before = COUNT.get();
    (0..300).for_each(|_| fmu.advance(&input(1.0, 2.0)).unwrap());
    assert_eq!(COUNT.get(), before);
    drop(fmu.bodies().to_vec());
    assert_ne!(COUNT.get(), before, "it counts");
}
