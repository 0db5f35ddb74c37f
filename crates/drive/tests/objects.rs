//! Settings and objects of the drive, each made of the other.
use servobench_cia402::PowerState;
use servobench_cia402::objects::{Dictionary, HOMING_METHODS, OBJECTS, Value};
use servobench_cia402::units::{AxisUnit, Object, Ratio, UnitError};
use servobench_drive::device::{ObjectsError, Params};
use servobench_drive::modes::homing::Method;
use servobench_drive::modes::profile::Ramp;

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
    let settings = Params::default().with_objects(&objects, micrometre()).unwrap();
    assert_near(settings.following_error.width, 2e-3);
    assert_near(settings.following_error.time, 0.02);
    assert!(settings.position.width.is_infinite());
    assert_near(settings.velocity.width, 5e-4);
    // 2.4 N·m: 250 % forward by 6072h, below the 300 % of 60E0h; 50 % backward.
    assert_near(settings.limits.effort[0], 6.0);
    assert_near(settings.limits.effort[1], 1.2);
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

#[test]
fn what_is_stored_is_read_again() {
    let default = Params::default();
    let mut objects = Dictionary::new();
    default.store_in(&mut objects).unwrap();
    let again = default.with_objects(&objects, micrometre()).unwrap();
    let mut stored = Dictionary::new();
    again.store_in(&mut stored).unwrap();
    // Whole units are kept to the bit; settings in whole micrometres come back within the roundings of their product.
    for index in 0x6000..=0x60FF {
        for subindex in 0..=2 {
            let object = Object { index, subindex };
            assert_eq!(stored.read(object), objects.read(object), "{object}");
        }
    }
    assert_near(again.profile.velocity, default.profile.velocity);
    assert_near(again.homing.switch_speed, default.homing.switch_speed);
    assert_near(again.position.width, default.position.width);
    assert_eq!((again.limits, again.power, again.cycle), (default.limits, default.power, default.cycle));
    assert_eq!(again.homing.method, default.homing.method);
    assert_eq!(again.profile.ramp, default.profile.ramp);
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
    let mut fast = Params::default();
    fast.profile.velocity = 5_000.0;
    let refused = fast.store_in(&mut Dictionary::new()).unwrap_err();
    assert!(matches!(refused, ObjectsError::NotHeld { .. }));
    assert_eq!(
        refused.to_string(),
        "6081h:00h cannot hold 5e9 of its units: choose a coarser unit (6092h, 6096h), or set it lower"
    );
    let mut slow = Params::default();
    slow.homing.zero_speed = 1e-7;
    let refused = slow.store_in(&mut Dictionary::new()).unwrap_err();
    assert_eq!(refused.to_string(), "`Speed during search for zero` (6099h:02h) must be at least 1, got 0");
}

/// A dictionary that a master filled at random is one that the drive follows, but for times that its clock does not count.
#[test]
fn what_the_dictionary_takes_the_drive_takes() {
    let mut random = Random(7);
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

/// SplitMix64 (Steele, Lea and Flood 2014).
struct Random(u64);

impl Random {
    fn next(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9E37_79B9_7F4A_7C15);
        let mixed = (self.0 ^ (self.0 >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
        let mixed = (mixed ^ (mixed >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
        mixed ^ (mixed >> 31)
    }
}
