//! Allocations per tick: Rapier's own, and none of ours.
use super::{H, build, effort, feed_axis, two_mass};
use servobench_plant::{Chain, Drive};
use std::alloc::{GlobalAlloc, Layout, System};
use std::cell::Cell;

thread_local! {
    static ALLOCATIONS: Cell<u64> = const { Cell::new(0) };
}

/// Counts the calling thread's allocations.
struct Counting;

#[expect(unsafe_code, reason = "an allocator is unsafe by contract; this one only counts and passes on")]
unsafe impl GlobalAlloc for Counting {
    unsafe fn alloc(&self, layout: Layout) -> *mut u8 {
        ALLOCATIONS.with(|count| count.set(count.get() + 1));
        // SAFETY: the caller's promises are passed on unchanged.
        unsafe { System.alloc(layout) }
    }

    unsafe fn dealloc(&self, memory: *mut u8, layout: Layout) {
        // SAFETY: as above.
        unsafe { System.dealloc(memory, layout) }
    }
}

#[global_allocator]
static COUNTING: Counting = Counting;

/// Allocations per tick once everything has its size.
fn per_tick(chain: &Chain) -> f64 {
    let mut axis = build(chain, Drive::Effort, H, vec![]);
    let mut run = |ticks: u32| {
        for k in 0..ticks {
            axis.advance(&effort(f64::from(k % 3) - 1.0)).unwrap();
        }
    };
    run(100);
    let before = ALLOCATIONS.get();
    run(1_000);
    (ALLOCATIONS.get() - before) as f64 / 1_000.0
}

/// Rapier 0.36.1 itself allocates once in each step of a scene, whatever is in it. Two lumps are one scene, four are two.
/// The feed axis also changes the centre of its motor a few times, which Rapier notes in a list.
#[test]
fn a_tick_allocates_what_the_bare_step_does() {
    assert!((per_tick(&two_mass(0.01)) - 1.0).abs() < 1e-12, "{}", per_tick(&two_mass(0.01)));
    assert!((per_tick(&feed_axis()) - 2.0).abs() < 0.1, "{}", per_tick(&feed_axis()));
}
