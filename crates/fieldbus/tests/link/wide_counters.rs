//! Counters of up to 64 bits: counts are exact for any width; positions that an `f64` cannot represent are refused.
use crate::rig::{BUS, Rig, follow, settings};
use servobench_cia402::counter::Counter;
use servobench_fieldbus::link::{Settings, Units};
use servobench_fieldbus::{AxisCommand, Fault, LinkFault, Power, Task};
use servobench_motion::interpolate::Sample;

/// Counts in a cycle of the bus: a prime.
const STEP: i128 = 7_919;

fn rig(counter: Counter) -> Rig {
    let units = Units { drive_units: 1e6, counter, ..settings().units };
    Rig::new(Settings { units, velocity_from_differences: true, round_trip: 1, velocity_limit: 10.0, ..settings() })
}

const OFF: AxisCommand =
    AxisCommand { power: false, ..AxisCommand::of(Task::Follow(Sample { x: 0.0, v: 0.0, a: 0.0, torque: 0.0 })) };

/// Oracle: the counts of the drive. Without power the target is the next position of the axis, to the count, through 2⁵³, the ends of the
/// counter and 2⁶³ itself; the velocity by differences is that of whole counts.
#[test]
fn no_count_is_lost_beyond_what_a_number_of_64_bits_can_say() {
    for bits in [33, 40, 53, 54, 63, 64] {
        for (signed, direction) in [(true, 1), (true, -1), (false, 1), (false, -1)] {
            let counter = if signed { Counter::signed(bits) } else { Counter::unsigned(bits) }.unwrap();
            let end = if direction > 0 { counter.highest() } else { counter.lowest() };
            for start in [end, direction << 53, 0] {
                let mut rig = rig(counter);
                rig.drive.counts = start - direction * 10 * STEP;
                rig.drive.coasts = direction * STEP;
                rig.write(0, OFF);
                for cycle in 0..20 {
                    rig.cycle();
                    let shown = counter.reading_of([rig.commands.target_position, rig.commands.target_position_high]);
                    // The first answers have no velocity yet, by differences over four cycles.
                    if cycle > 5 {
                        assert_eq!(shown, counter.wrap(rig.drive.counts), "{bits} bits, signed {signed}, from {start}");
                        let v = rig.feedback().velocity;
                        assert!((v - (direction * STEP) as f64 * 1e-3).abs() < 1e-9, "{v} m/s in cycle {cycle}");
                    }
                }
            }
        }
    }
}

/// Oracle: rounding. A position of 2⁶³ µm is an `f64` that is off by half of its last digit, 2¹⁰ counts; this holds across the end of a
/// signed counter of 64 bits.
#[test]
fn a_position_beyond_2_to_the_53_is_the_nearest_number() {
    let counter = Counter::signed(64).unwrap();
    let mut rig = rig(counter);
    rig.drive.counts = counter.highest() - 10 * STEP;
    rig.drive.coasts = STEP;
    rig.write(0, OFF);
    let mut last = 0.0;
    for _ in 0..20 {
        rig.cycle();
        let (position, counts) = (rig.feedback().position, (rig.drive.counts - STEP) as f64);
        if rig.tick > BUS {
            // One rounding of the count, one of the product.
            assert!((position - 1e-6 * counts).abs() <= 1e-6 * counts * 2.0 * f64::EPSILON, "{position} for {counts}");
            assert!(position >= last, "no step back at the end of the counter: {position} after {last}");
        }
        last = position;
    }
    assert!(rig.drive.counts > counter.highest(), "it went through the end");
}

/// Set-points at which an `f64` cannot represent every count are refused, not rounded.
#[test]
fn set_points_end_at_2_to_the_53_counts() {
    let counter = Counter::signed(64).unwrap();
    let highest = 9_007_199_254_740_992_i128;
    for (counts, is_followed) in [(highest - 4_096, true), (highest + 4_096, false)] {
        let mut rig = rig(counter);
        rig.drive.counts = counts;
        let x = counts as f64 * 1e-6;
        rig.run(6, |_| follow(Sample { x, ..Sample::default() }));
        let feedback = rig.feedback();
        if is_followed {
            assert_eq!((feedback.power, feedback.fault), (Power::On, None), "{counts}");
            // A set-point of 9e9 m is off by half of its last digit, of 1 µm.
            assert!((rig.drive.counts - counts).abs() <= 2, "{} for {counts}", rig.drive.counts);
        } else {
            assert_eq!(feedback.fault, Some(Fault::Link(LinkFault::Command)), "{counts}");
            assert_eq!(rig.drive.counts, counts, "it stays");
        }
    }
}
