//! A step allocates nothing.
use super::*;
use std::alloc::{GlobalAlloc, Layout, System};
use std::cell::Cell;

struct Counting;

thread_local! {
    static COUNT: Cell<usize> = const { Cell::new(0) };
}

#[global_allocator]
static ALLOCATOR: Counting = Counting;

#[expect(unsafe_code, reason = "an allocator that counts")]
// SAFETY: the system's, counted.
unsafe impl GlobalAlloc for Counting {
    unsafe fn alloc(&self, layout: Layout) -> *mut u8 {
        COUNT.with(|count| count.set(count.get() + 1));
        // SAFETY: as the caller promises.
        unsafe { System.alloc(layout) }
    }

    unsafe fn dealloc(&self, memory: *mut u8, layout: Layout) {
        // SAFETY: as the caller promises.
        unsafe { System.dealloc(memory, layout) }
    }
}

#[test]
fn a_step_allocates_nothing() {
    let mut slave = start(&Bad::Nothing, Bounds::default()).unwrap();
    let mut outputs = [0.0; 2];
    let before = COUNT.with(Cell::get);
    for k in 0..1000 {
        slave.save().unwrap();
        slave.step(f64::from(k), 1.0, &[[1.0, 0.0, 0.0]]).unwrap();
        slave.restore().unwrap();
        slave.step(f64::from(k), 1.0, &[[1.0, 0.0, 0.0]]).unwrap();
        slave.read(None, &mut outputs).unwrap();
        slave.read(Some(&[1.0]), &mut outputs).unwrap();
    }
    assert_eq!(COUNT.with(Cell::get), before);
    drop(vec![0_u8; 10]);
    assert_ne!(COUNT.with(Cell::get), before, "it counts");
}
