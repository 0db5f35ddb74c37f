//! Cost of a conversion of units: `cargo bench -p servobench-cia402 --bench units`.
//!
//! Each axis has an encoder of 20 bits, a gear of 7:2 and a screw of 5 mm in µm, over the positions of a move; `wide` has
//! a reduced fraction so large that a product needs more than 64 bits.
use divan::counter::ItemsCount;
use divan::{Bencher, black_box};
use servobench_cia402::modulo::{Direction, PositionRange};
use servobench_cia402::units::{AxisUnit, FactorGroup, Ratio, Scaling};

fn main() {
    divan::main();
}

/// Conversions of one measurement.
const CONVERSIONS: u32 = 10_000;
/// Increments from one conversion to the next.
const STEP: i64 = 1_237;

fn scaling(gear_ratio: [u32; 2]) -> Option<Scaling> {
    let factors = FactorGroup {
        position_encoder_resolution: [1 << 20, 1],
        gear_ratio,
        feed_constant: [5000, 1],
        ..FactorGroup::default()
    };
    factors.scaling(AxisUnit::Metre(Ratio::new(1, 1_000_000).ok()?)).ok()
}

/// Each conversion begins when the one before is done, as a tick waits for its inputs: latency, not throughput.
fn conversions(bencher: Bencher<'_, '_>, gear: [u32; 2], convert: impl Fn(&Scaling, i64) -> i64) {
    let Some(scaling) = scaling(gear) else { return };
    bencher.counter(ItemsCount::new(CONVERSIONS)).bench_local(|| {
        let scaling = black_box(&scaling);
        (0..CONVERSIONS).fold(0, |before: i64, k| convert(scaling, i64::from(k) * STEP + (before & 1)))
    });
}

const GEAR: [u32; 2] = [7, 2];
const WIDE: [u32; 2] = [4_294_967_291, 4_294_967_279];

/// Cost of the measurement itself.
#[divan::bench]
fn nothing(bencher: Bencher<'_, '_>) {
    conversions(bencher, GEAR, |_, count| black_box(count));
}

#[divan::bench]
fn position(bencher: Bencher<'_, '_>) {
    conversions(bencher, GEAR, |scaling, count| scaling.position(count.into()).map_or(0, low));
}

#[divan::bench]
fn increments(bencher: Bencher<'_, '_>) {
    conversions(bencher, GEAR, |scaling, count| scaling.increments(count.into()).map_or(0, low));
}

#[divan::bench]
fn metres(bencher: Bencher<'_, '_>) {
    conversions(bencher, GEAR, |scaling, count| bits(scaling.metres_or_radians(count.into()).unwrap_or(0.0)));
}

#[divan::bench]
fn increments_at_metres(bencher: Bencher<'_, '_>) {
    conversions(bencher, GEAR, |scaling, count| scaling.increments_at(count as f64 * 1e-7).map_or(0, low));
}

#[divan::bench]
fn position_wide(bencher: Bencher<'_, '_>) {
    conversions(bencher, WIDE, |scaling, count| scaling.position(i128::from(count) << 24).map_or(0, low));
}

#[divan::bench]
fn metres_wide(bencher: Bencher<'_, '_>) {
    conversions(bencher, WIDE, |scaling, count| bits(scaling.metres_or_radians(count.into()).unwrap_or(0.0)));
}

#[divan::bench]
fn increments_at_metres_wide(bencher: Bencher<'_, '_>) {
    conversions(bencher, WIDE, |scaling, count| scaling.increments_at(count as f64 * 1e-7).map_or(0, low));
}

#[divan::bench]
fn shortest_way(bencher: Bencher<'_, '_>) {
    let Ok(range) = PositionRange::new(0, 359_999) else { return };
    conversions(bencher, GEAR, |_, count| black_box(&range).way(count, 3 * count, Direction::Shortest));
}

#[expect(clippy::cast_possible_truncation, reason = "only its last bit is used")]
const fn low(count: i128) -> i64 {
    count as i64
}

const fn bits(number: f64) -> i64 {
    number.to_bits().cast_signed()
}
