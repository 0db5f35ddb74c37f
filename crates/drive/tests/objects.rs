//! Settings and objects of the drive, each computed from the other.
use servobench_cia402::PowerState;
use servobench_cia402::modulo::{PositionRange, RotaryAxisOption};
use servobench_cia402::objects::{Dictionary, HOMING_METHODS, OBJECTS, Value};
use servobench_cia402::units::{AxisUnit, FactorGroup, Object, Ratio, UnitError};
use servobench_drive::device::{ObjectsError, Params, Rotary, Units, Window};
use servobench_drive::modes::homing::Method;
use servobench_drive::modes::profile::Ramp;
use servobench_testkit::Random;

fn write(objects: &mut Dictionary, index: u16, subindex: u8, value: impl Into<Value>) {
    objects.write(Object { index, subindex }, value.into(), PowerState::SwitchOnDisabled).unwrap();
}

fn micrometre() -> AxisUnit {
    AxisUnit::Metre(Ratio::new(1, 1_000_000).unwrap())
}

/// A screw of 5 mm behind a gear of 2:1, an encoder of 10 000 increments, positions in µm, velocities in µm/s.
fn screw() -> Dictionary {
    let mut objects = Dictionary::new();
    write(&mut objects, 0x608F, 1, 10_000_u32);
    write(&mut objects, 0x6091, 1, 2_u32);
    write(&mut objects, 0x6092, 1, 5_000_u32);
    write(&mut objects, 0x6076, 0, 2_400_u32);
    objects
}

fn assert_near(value: f64, expected: f64) {
    // A few roundings of factors and products.
    assert!((value - expected).abs() <= 1e-15 * expected.abs(), "{value} instead of {expected}");
}

#[test]
fn objects_mean_what_the_profile_says() {
    let mut objects = screw();
    write(&mut objects, 0x6065, 0, 2_000_u32);
    write(&mut objects, 0x6066, 0, 20_u16);
    write(&mut objects, 0x606D, 0, 500_u16);
    write(&mut objects, 0x6072, 0, 2_500_u16);
    write(&mut objects, 0x60E1, 0, 500_u16);
    write(&mut objects, 0x607D, 1, -10_000_i32);
    write(&mut objects, 0x607D, 2, 300_000_i32);
    write(&mut objects, 0x6080, 0, 3_000_u32);
    write(&mut objects, 0x6084, 0, 4_000_000_u32);
    write(&mut objects, 0x6086, 0, 3_i16);
    write(&mut objects, 0x60A4, 1, 50_000_000_u32);
    write(&mut objects, 0x6087, 0, 10_000_u32);
    write(&mut objects, 0x6098, 0, 17_i8);
    write(&mut objects, 0x6099, 2, 1_500_u32);
    write(&mut objects, 0x60C2, 1, 2_u8);
    write(&mut objects, 0x607B, 2, 4_999_i32);
    write(&mut objects, 0x607B, 1, 0_i32);
    write(&mut objects, 0x60F2, 0, 0x80_u16);
    let settings = Params::default().with_objects(&objects, micrometre()).unwrap();
    assert_near(settings.following_error.width, 2e-3);
    assert_near(settings.following_error.time, 0.02);
    assert!(settings.position.width.is_infinite());
    assert_near(settings.velocity.width, 5e-4);
    // 2.4 N·m: 250 % forward by 6072h, below the 300 % of 60E0h; 50 % backward.
    assert_near(settings.limits.effort.forward, 6.0);
    assert_near(settings.limits.effort.backward, 1.2);
    let [lowest, highest] = settings.limits.position.unwrap();
    assert_near(lowest, -0.01);
    assert_near(highest, 0.3);
    // 3000/min of the motor are 1500/min of a screw of 5 mm.
    assert_near(settings.limits.velocity, 0.125);
    assert!(settings.limits.acceleration.is_infinite());
    assert_near(settings.profile.deceleration, 4.0);
    let Ramp::JerkLimited(jerk) = settings.profile.ramp else { panic!("a jerk-limited profile") };
    assert_near(jerk, 50.0);
    assert_near(settings.profile.effort_slope, 24.0);
    assert_eq!(settings.homing.method.number(), 17);
    assert_near(settings.homing.zero_speed, 1.5e-3);
    // 2 ms over steps of 250 µs.
    assert_eq!(settings.cycle.steps, 8);
    let rotary = Rotary { range: Some(PositionRange::new(0, 4_999).unwrap()), direction: RotaryAxisOption::Positive };
    assert_eq!(settings.rotary, rotary);
    let mut stored = screw();
    settings.store_in(&mut stored).unwrap();
    assert_eq!(stored.position_range(), objects.position_range());
    assert_eq!(Params::default().with_objects(&stored, micrometre()).unwrap().rotary, rotary);
}

#[test]
fn an_inverted_axis_has_its_limits_the_other_way_round() {
    let mut objects = screw();
    write(&mut objects, 0x607E, 0, 0x80_u8);
    write(&mut objects, 0x607D, 1, -10_000_i32);
    write(&mut objects, 0x607D, 2, 300_000_i32);
    let settings = Params::default().with_objects(&objects, micrometre()).unwrap();
    let [lowest, highest] = settings.limits.position.unwrap();
    assert_near(lowest, -0.3);
    assert_near(highest, 0.01);
    let mut stored = screw();
    write(&mut stored, 0x607E, 0, 0x80_u8);
    settings.store_in(&mut stored).unwrap();
    for subindex in [1, 2] {
        let limit = Object { index: 0x607D, subindex };
        assert_eq!(stored.read(limit), objects.read(limit));
    }
}

/// 60E0h limits the torque that is positive for the master.
#[test]
fn an_inverted_torque_has_its_limits_the_other_way_round() {
    let mut objects = screw();
    write(&mut objects, 0x607E, 0, 0xE0_u8);
    write(&mut objects, 0x60E0, 0, 250_u16);
    let settings = Params::default().with_objects(&objects, micrometre()).unwrap();
    assert_near(settings.limits.effort.forward, 7.2);
    assert_near(settings.limits.effort.backward, 0.6);
    assert_near(settings.units.rated_effort(), 2.4);
    let mut stored = screw();
    write(&mut stored, 0x607E, 0, 0xE0_u8);
    settings.store_in(&mut stored).unwrap();
    for (index, thousandths) in [(0x60E0, 250_u16), (0x60E1, 3000)] {
        assert_eq!(stored.read(Object { index, subindex: 0 }), Ok(thousandths.into()));
    }
    assert_eq!(settings.with_objects(&stored, micrometre()).unwrap(), settings);
}

#[test]
fn what_is_stored_is_read_again() {
    let default = Params::default();
    let mut objects = Dictionary::new();
    default.store_in(&mut objects).unwrap();
    let again = default.with_objects(&objects, micrometre()).unwrap();
    let mut stored = Dictionary::new();
    again.store_in(&mut stored).unwrap();
    // A setting that its object shows is kept bit for bit.
    for index in 0x6000..=0x60FF {
        for subindex in 0..=2 {
            let object = Object { index, subindex };
            assert_eq!(stored.read(object), objects.read(object), "{object}");
        }
    }
    assert_eq!(again, default);
}

#[test]
fn the_methods_that_are_taken_are_those_that_there_are() {
    let methods: Vec<i64> = Method::all().map(|method| method.number().into()).collect();
    assert_eq!(methods, HOMING_METHODS);
}

#[test]
fn what_does_not_go_together_is_refused_in_words() {
    let mut objects = screw();
    write(&mut objects, 0x60C2, 2, -4_i8);
    let refused = Params::default().with_objects(&objects, micrometre()).unwrap_err();
    assert_eq!(
        refused.to_string(),
        "interpolation time period (60C2h) must be a multiple of the drive's period, 2.5e-4 s, got 1e-4 s"
    );
}

/// An axis in nanometres: 1 mm/s is a million units, which 16 bits do not hold; the velocities of 100 mm/s are held. Objects that
/// the master does not write stay as they are, bit for bit.
#[test]
fn an_object_that_cannot_hold_its_setting_shows_its_end_and_the_setting_stays() {
    let nanometre = AxisUnit::Metre(Ratio::new(1, 1_000_000_000).unwrap());
    let units = Units::new(&FactorGroup::default(), nanometre, 0.0004).unwrap();
    let velocity = Window { width: 1e-3, time: 0.01 };
    let mut set = Params { units, velocity, standstill: velocity, ..Params::default() };
    set.profile.velocity = 5.0;
    set.homing.zero_speed = 3.3e-10;
    let mut objects = Dictionary::new();
    set.store_in(&mut objects).unwrap();
    let shown = |objects: &Dictionary, index, subindex| objects.read(Object { index, subindex }).unwrap();
    assert_eq!(shown(&objects, 0x606D, 0), u16::MAX.into());
    assert_eq!(shown(&objects, 0x606F, 0), u16::MAX.into());
    assert_eq!(shown(&objects, 0x6081, 0), u32::MAX.into());
    assert_eq!(shown(&objects, 0x6099, 1), 50_000_000_u32.into());
    // A third of a unit, and 0.4 mN: their objects take no zero.
    assert_eq!(shown(&objects, 0x6099, 2), 1_u32.into());
    assert_eq!(shown(&objects, 0x6076, 0), 1_u32.into());
    assert_eq!(set.with_objects(&objects, nanometre).unwrap(), Params { cycle: set.cycle, ..set });
    write(&mut objects, 0x6068, 0, 7_u16);
    let mut expected = set;
    expected.position.time = 0.007;
    assert_eq!(set.with_objects(&objects, nanometre).unwrap(), expected);
    // A value written by the master counts, even if it equals the one that the object showed.
    write(&mut objects, 0x606D, 0, u16::MAX);
    let taken = set.with_objects(&objects, nanometre).unwrap();
    assert_near(taken.velocity.width, 65_535e-9);
    assert_near(taken.standstill.width, 1e-3);
    let refused = objects.write_number(Object { index: 0x606D, subindex: 0 }, 1_000_000, PowerState::SwitchOnDisabled);
    assert_eq!(refused.unwrap_err().to_string(), "`Velocity window` (606Dh:00h) must be at most 65535, got 1000000");
}

/// The drive follows a dictionary that a master filled at random, but for times that its clock cannot count.
#[test]
fn what_the_dictionary_takes_the_drive_takes() {
    let mut random = Random::seeded(7);
    let mut followed = 0;
    for _ in 0..sweep(2_000) {
        let mut objects = Dictionary::new();
        for known in &OBJECTS {
            for subindex in 0..=known.highest_subindex() {
                let object = Object { index: known.index, subindex };
                // Of any magnitude, for every width of an object alike.
                let number = random.next().cast_signed() >> (random.next() % 64);
                let written = objects.write_number(object, number, PowerState::SwitchOnDisabled);
                assert!(written.is_ok() || !written.unwrap_err().to_string().is_empty());
            }
        }
        match Params::default().with_objects(&objects, micrometre()) {
            Ok(settings) => {
                settings.check().unwrap();
                followed += 1;
            }
            // Factors whose product is too large were refused before; with the length of the unit it may be again.
            Err(ObjectsError::Cycle { .. } | ObjectsError::Unit(UnitError::RatioTooLarge { .. })) => {}
            Err(other) => panic!("{other}"),
        }
    }
    // 96 of 100 of them.
    assert!(10 * followed > 9 * sweep(2_000), "{followed}");
}

fn sweep(usual: u64) -> u64 {
    std::env::var("SERVOBENCH_SWEEP").map_or(usual, |size| size.parse().unwrap())
}
