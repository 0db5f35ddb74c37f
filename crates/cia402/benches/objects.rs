//! Cost of the object dictionary to a drive and to its master: `cargo bench -p servobench-cia402 --bench objects`.
use divan::counter::ItemsCount;
use divan::{Bencher, black_box};
use servobench_cia402::objects::{Dictionary, Value, parameter};
use servobench_cia402::units::Object;
use servobench_cia402::{Actuals, Commands, PowerState};

fn main() {
    divan::main();
}

/// Accesses of one measurement.
const ACCESSES: u32 = 10_000;

fn accesses(bencher: Bencher<'_, '_>, mut access: impl FnMut(&mut Dictionary, u32)) {
    let mut dictionary = Dictionary::new();
    bencher.counter(ItemsCount::new(ACCESSES)).bench_local(|| {
        for number in 0..ACCESSES {
            access(black_box(&mut dictionary), number);
        }
    });
}

/// Cost per step of the drive's check for changed parameters.
#[divan::bench]
fn generation(bencher: Bencher<'_, '_>) {
    accesses(bencher, |dictionary, _| {
        black_box(dictionary.generation());
    });
}

#[divan::bench]
fn parameter(bencher: Bencher<'_, '_>) {
    accesses(bencher, |dictionary, _| {
        black_box(dictionary.get(parameter::FOLLOWING_ERROR_WINDOW));
    });
}

/// Cost per frame.
#[divan::bench]
fn mirror(bencher: Bencher<'_, '_>) {
    accesses(bencher, |dictionary, number| {
        let position = number.cast_signed();
        let commands = Commands { mode: 8, target_position: position, ..Commands::default() };
        let actuals = Actuals { mode: 8, position, ..Actuals::default() };
        dictionary.mirror(black_box(&commands), black_box(&actuals));
    });
}

/// Cost after a write.
#[divan::bench]
fn power_params(bencher: Bencher<'_, '_>) {
    accesses(bencher, |dictionary, _| {
        black_box(dictionary.power_params());
    });
}

#[divan::bench]
fn sdo_read(bencher: Bencher<'_, '_>) {
    accesses(bencher, |dictionary, _| {
        black_box(dictionary.read(black_box(Object { index: 0x6064, subindex: 0 }))).ok();
    });
}

#[divan::bench]
fn sdo_write(bencher: Bencher<'_, '_>) {
    accesses(bencher, |dictionary, number| {
        let object = Object { index: 0x6065, subindex: 0 };
        black_box(dictionary.write(object, Value::Unsigned32(number), PowerState::OperationEnabled)).ok();
    });
}

/// The slowest write, which forms the product of all factors.
#[divan::bench]
fn sdo_write_of_a_factor(bencher: Bencher<'_, '_>) {
    accesses(bencher, |dictionary, number| {
        let object = Object { index: 0x6091, subindex: 1 };
        black_box(dictionary.write(object, Value::Unsigned32(number + 1), PowerState::SwitchedOn)).ok();
    });
}
