//! Memory that is not private.
use super::*;

const BOUND: u64 = 300_000_000;

/// 6 GB once passed a bound on private memory. They are not used up here: the process is killed long before.
#[test]
fn shared_memory_counts_too() {
    const MUCH: usize = 6_000_000_000;
    let all = [Bad::ShareMemory(MUCH), Bad::FillMemoryFile(MUCH), Bad::Spread { processes: 4, each: 200_000_000 }];
    for bad in all {
        let how = crash_of_step(&bad, Bounds { memory: BOUND, ..Bounds::default() });
        assert!(how.starts_with("it took "), "{bad:?}: {how}");
        assert!(how.ends_with(" of memory, private and shared, of the 300 MB that it may have"), "{bad:?}: {how}");
    }
}

/// Memory shared by several processes counts once, as does a file that is open and mapped.
#[test]
fn memory_below_the_bound_is_no_concern() {
    for bad in [Bad::ShareMemory(150_000_000), Bad::FillMemoryFile(150_000_000)] {
        let mut slave = start(&bad, Bounds { memory: BOUND, ..Bounds::default() }).unwrap();
        slave.step(0.0, 0.1, &[[0.0; 3]]).unwrap();
        std::thread::sleep(Duration::from_millis(300));
        slave.end();
        assert!(slave.take_log().iter().all(|line| line.severity < Severity::Warning));
    }
}
