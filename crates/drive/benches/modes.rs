//! Cost of the modes, per step of the drive: `cargo bench -p servobench-drive --bench modes`.
use divan::counter::ItemsCount;
use divan::{Bencher, black_box};
use servobench_base::Setpoint;
use servobench_cia402::Controlword;
use servobench_cia402::interpolated::{Point, SubMode, TimePeriod};
use servobench_drive::Demand;
use servobench_drive::modes::interpolated::Buffer;
use servobench_drive::modes::{Actual, Answer, Moment, Steepness, Targets, homing, interpolated};

fn main() {
    divan::main();
}

const STEPS: u32 = 10_000;
const PERIOD: f64 = 62.5e-6;
const STEEPNESS: Steepness = Steepness { acceleration: 10.0, jerk: Some(1000.0) };

fn moment(bits: u16, demanded: Setpoint) -> Moment {
    let targets = Targets { controlword: Controlword::from_bits(bits), ..Targets::default() };
    let actual = Actual { position: demanded.x, velocity: demanded.v, ..Actual::default() };
    Moment { targets, actual, demanded, period: PERIOD }
}

fn follow(answer: &Answer) -> Setpoint {
    match answer.demand {
        Demand::Position { setpoint, .. } => setpoint.after(PERIOD),
        _ => Setpoint::default(),
    }
}

fn params(ms: u8) -> interpolated::Params {
    let period = TimePeriod::new(ms, -3).unwrap_or_else(|error| panic!("{error}"));
    interpolated::Params { sub_mode: SubMode::Cubic, period, count: 1e-6, stop: STEEPNESS, velocity: f64::INFINITY }
}

/// Points `ms` apart, always as many as the buffer has room for.
#[divan::bench(args = [255, 10, 1])]
fn interpolated(bencher: Bencher, ms: u8) {
    let params = params(ms);
    bencher.counter(ItemsCount::new(STEPS)).bench_local(|| {
        let mut now = moment(0x0F, Setpoint::default());
        let mut buffer = Buffer::default();
        let mut state = interpolated::State::begin(&now);
        let point = Point { position: 0, is_relative: true, velocity: Some(0), time: 1000 * u32::from(ms) };
        for step in 0..STEPS {
            if step % 16 == 0 {
                while buffer.free() > 0 && buffer.add(black_box(point)).is_ok() {}
            }
            let answer = interpolated::step(black_box(&params), &mut state, &mut buffer, &now);
            now = moment(0x1F, follow(&answer));
        }
        state.is_following()
    });
}

/// The same as the moments alone, to be subtracted.
#[divan::bench]
fn nothing(bencher: Bencher) {
    bencher.counter(ItemsCount::new(STEPS)).bench_local(|| {
        let mut now = moment(0x0F, Setpoint::default());
        for _ in 0..STEPS {
            let demand = Demand::position(black_box(now.demanded));
            let answer = Answer { demand, target_reached: false, bit_12: false, bit_13: false };
            now = moment(0x1F, follow(&answer));
        }
        now
    });
}

/// At rest, no move.
#[divan::bench]
fn interpolated_at_rest(bencher: Bencher) {
    let params = params(10);
    bencher.counter(ItemsCount::new(STEPS)).bench_local(|| {
        let mut now = moment(0x0F, Setpoint::default());
        let mut buffer = Buffer::default();
        let mut state = interpolated::State::begin(&now);
        for _ in 0..STEPS {
            let answer = interpolated::step(black_box(&params), &mut state, &mut buffer, &now);
            now = moment(0x0F, follow(&answer));
        }
        state.is_following()
    });
}

/// Looking for a switch that does not come.
#[divan::bench]
fn homing(bencher: Bencher) {
    let method = homing::Method::from_number(7).unwrap_or_else(|error| panic!("{error}"));
    let params = homing::Params {
        method,
        switch_speed: 0.1,
        zero_speed: 0.01,
        acceleration: 10.0,
        jerk: None,
        home_offset: 0.0,
    };
    bencher.counter(ItemsCount::new(STEPS)).bench_local(|| {
        let mut now = moment(0x0F, Setpoint::default());
        let mut state = homing::State::begin(&now);
        for _ in 0..STEPS {
            let output = homing::step(black_box(&params), &mut state, &now);
            now = moment(0x1F, follow(&output.answer));
        }
        state.is_homed()
    });
}
