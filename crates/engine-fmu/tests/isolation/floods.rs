//! Unbounded memory and text.
use super::*;
use servobench_fmi::Severity;

const BOUND: u64 = 300_000_000;

fn bounded() -> Bounds {
    Bounds { memory: BOUND, ..Bounds::default() }
}

#[test]
fn one_that_hoards_memory_is_reported_as_that() {
    let said = "it asked for more memory than the 300 MB that it may have";
    for bad in [Bad::Hoard { block: 4000 }, Bad::Hoard { block: 1 << 20 }] {
        let how = crash_of_step(&bad, bounded());
        assert!(how.starts_with(said) && how.contains("then signal 11 (SIGSEGV"), "{bad:?}: {how}");
    }
    let how = crash_of_step(&Bad::HugeVector, bounded());
    assert!(how.starts_with(said) && how.contains("memory allocation of 1099511627776 bytes failed"), "{how}");
    let call_timeout = impatient().call_timeout;
    let how = crash_of_step(&Bad::HoardAndHang, Bounds { call_timeout, memory: BOUND });
    assert!(how.starts_with(said) && how.contains("did not come back within 1 s"), "{how}");
}

/// A crash without large allocations is not blamed on memory.
#[test]
fn one_that_has_memory_is_not_reported_as_that() {
    let how = crash_of_step(&Bad::NullWrite, bounded());
    assert!(!how.contains("memory that it may have"), "{how}");
}

/// Its last output is kept; it never waits for a reader.
#[test]
fn one_that_prints_without_end_goes_on() {
    const MUCH: usize = 64 << 20;
    let mut slave = start(&Bad::Print(MUCH), Bounds::default()).unwrap();
    slave.take_log();
    slave.step(0.0, 0.1, &[[0.0; 3]]).unwrap();
    let log = slave.take_log();
    for (category, end) in [("standard output", "the end of the output"), ("standard error", "the end of the errors")] {
        let lines: Vec<_> = log.iter().filter(|line| line.category == category).collect();
        let [dropped, last] = lines[..] else { panic!("{} lines", lines.len()) };
        // All but 4000 bytes.
        let notice = (Severity::Warning, "(67 MB before this were dropped)");
        assert_eq!((dropped.severity, dropped.message.as_str()), notice);
        assert!(last.message.starts_with("xx") && last.message.ends_with(end) && last.message.len() < 5000);
        assert_eq!(last.severity, Severity::Info);
    }
    slave.step(0.1, 0.1, &[[0.0; 3]]).unwrap();
}

#[test]
fn a_log_without_end_is_cut_and_counted() {
    let mut slave = start(&Bad::Log(100_000), Bounds::default()).unwrap();
    slave.take_log();
    slave.step(0.0, 0.1, &[[0.0; 3]]).unwrap();
    let mut log = slave.take_log();
    let last = log.pop().unwrap();
    let dropped: usize = last.message.split(' ').next().unwrap().parse().unwrap();
    assert_eq!((log.len() + dropped, last.severity), (100_000, Severity::Warning), "{}", last.message);
    assert_eq!(log.last().unwrap().message, format!("line {}", log.len() - 1));
    slave.step(0.0, 0.1, &[[0.0; 3]]).unwrap();
    assert_eq!(slave.take_log()[0].message, "line 0", "there is room again");
}
