//! Sub-mode 0: a master whose clock differs from the drive's.
use crate::axis::{Axis, PERIOD, assert_near, run};
use servobench_cia402::interpolated::{SubMode, TimePeriod};
use servobench_drive::modes::interpolated::DataRecord;
use servobench_testkit::Random;

const POINTS: i32 = 10_000;
const STEP: i32 = 100;

/// A master that sends a point per period of its own clock, late by at most the fraction `late` of a period.
fn stream(units: u8, clock: f64, late: f64, seed: u64) {
    let mut random = Random::seeded(seed);
    let period = TimePeriod::new(units, -3).unwrap();
    let nominal = f64::from(units) * 1e-3;
    let mut axis = Axis::at(0, SubMode::LinearAdapted);
    axis.params.period = period;
    axis.step(run());
    let (mut record, mut sent, mut k) = (DataRecord::default(), 0, 0_u32);
    let mut due = |sent: i32| (f64::from(sent) + late * random.unit()) * nominal * clock;
    let mut next = due(0);
    let (mut waiting, mut started) = (vec![0_u32; 33], None);
    while sent < POINTS {
        k += 1;
        let t = f64::from(k) * PERIOD;
        if t >= next {
            sent += 1;
            next = due(sent);
            record.write(SubMode::LinearAdapted, period, &mut axis.buffer, 1, STEP * sent).unwrap();
        }
        axis.step(run());
        let case = format!("{units} ms, clock {clock}, late {late}, point {sent}");
        assert_eq!(axis.errors(), 0, "{case}");
        if axis.answer.bit_12 {
            started.get_or_insert(k);
            waiting[32 - axis.buffer.free()] += 1;
            // Segments are a period of the drive longer or shorter, at most.
            let slope = f64::from(STEP) * 1e-6;
            let (slow, fast) = (slope / (nominal + PERIOD), slope / (nominal - PERIOD));
            assert!(
                axis.last.v >= slow * (1.0 - 1e-12) && axis.last.v <= fast * (1.0 + 1e-12),
                "{case}: {:?}",
                axis.last
            );
        }
    }
    // The axis is two to four points behind the master, however long it went on.
    let behind = f64::from(sent) - axis.last.x / (f64::from(STEP) * 1e-6);
    assert!((1.5..=4.5).contains(&behind), "{behind} points behind");
    let most = waiting.iter().rposition(|steps| *steps > 0).unwrap();
    assert!(most <= 5, "{waiting:?}");
    let started = f64::from(started.unwrap()) * PERIOD;
    assert!(started <= 3.5 * nominal, "{started}");
}

#[test]
fn a_clock_a_thousandth_fast_or_slow_neither_fills_nor_drains_the_buffer() {
    for clock in [0.999, 1.0, 1.001] {
        for (units, late) in [(10, 0.0), (10, 0.8), (2, 0.0), (2, 0.8), (20, 0.5)] {
            stream(units, clock, late, 60);
        }
    }
}

#[test]
fn without_adaptation_the_same_clocks_drain_the_buffer() {
    let mut axis = Axis::at(0, SubMode::Linear);
    let mut record = DataRecord::default();
    let period = TimePeriod::new(10, -3).unwrap();
    let mut k = 0;
    let mut send = |axis: &mut Axis, sent: i32| record.write(SubMode::Linear, period, &mut axis.buffer, 1, STEP * sent);
    for sent in 1..=3 {
        send(&mut axis, sent).unwrap();
    }
    let mut sent = 3;
    while axis.errors() == 0 {
        k += 1;
        assert!(k < 4_000_000, "a clock a thousandth slow starves the buffer within 3000 points");
        if f64::from(k) * PERIOD >= f64::from(sent - 2) * 0.01 * 1.001 {
            sent += 1;
            send(&mut axis, sent).unwrap();
        }
        axis.step(run());
    }
    assert_eq!(axis.errors(), 4);
    // Three points ahead, of which a thousandth of a point is lost per point.
    assert_near(f64::from(sent), 3000.0, 1010.0);
}
