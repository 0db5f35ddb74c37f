//! A tick allocates nothing, whether it exchanges or extrapolates.
use super::*;
use servobench_testkit::CountingAllocator;

#[global_allocator]
static ALLOCATOR: CountingAllocator = CountingAllocator;

#[test]
fn a_tick_allocates_nothing() {
    let mut fmu = mechanics(ExactFmu::new(3.0 * TICK), &model(3), &IN_SI);
    let before = CountingAllocator::count();
    (0..300).for_each(|_| fmu.advance(&input(1.0, 2.0)).unwrap());
    assert_eq!(CountingAllocator::count(), before);
    drop(fmu.bodies().to_vec());
    assert_ne!(CountingAllocator::count(), before, "it counts");
}
