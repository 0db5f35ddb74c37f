//! A step allocates nothing.
use super::*;
use servobench_testkit::CountingAllocator;

#[global_allocator]
static ALLOCATOR: CountingAllocator = CountingAllocator;

#[test]
fn a_step_allocates_nothing() {
    let mut slave = start(&Bad::Nothing, Bounds::default()).unwrap();
    let mut outputs = [0.0; 2];
    let before = CountingAllocator::count();
    for k in 0..1000 {
        slave.save().unwrap();
        slave.step(f64::from(k), 1.0, &[[1.0, 0.0, 0.0]]).unwrap();
        slave.restore().unwrap();
        slave.step(f64::from(k), 1.0, &[[1.0, 0.0, 0.0]]).unwrap();
        slave.read(None, &mut outputs).unwrap();
        slave.read(Some(&[1.0]), &mut outputs).unwrap();
    }
    assert_eq!(CountingAllocator::count(), before);
    drop(vec![0_u8; 10]);
    assert_ne!(CountingAllocator::count(), before, "it counts");
}
