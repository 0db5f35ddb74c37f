//! Values that are in range, but in conflict with others or with the present state.
use crate::object;
use servobench_cia402::objects::{Dictionary, Value};
use servobench_cia402::units::Object;
use servobench_cia402::{AbortCode, Actuals, Commands, PowerState, Statusword};

const DISABLED: PowerState = PowerState::ReadyToSwitchOn;

fn code(dictionary: &mut Dictionary, at: Object, value: impl Into<Value>) -> Option<AbortCode> {
    dictionary.write(at, value.into(), DISABLED).err().map(|refused| refused.abort_code())
}

#[test]
fn the_ends_of_a_window_do_not_change_places() {
    for index in [0x607B, 0x607D] {
        let (mut dictionary, min, max) = (Dictionary::new(), object(index, 1), object(index, 2));
        assert_eq!(code(&mut dictionary, min, 100), None);
        for not_above in [99, 100] {
            assert_eq!(code(&mut dictionary, max, not_above), Some(AbortCode::MaximumBelowMinimum));
        }
        assert_eq!(dictionary.read(max), Ok(Value::Integer32(i32::MAX)));
        assert_eq!(code(&mut dictionary, max, 200), None);
        assert_eq!(code(&mut dictionary, min, 201), Some(AbortCode::MaximumBelowMinimum));
        assert_eq!(dictionary.read(min), Ok(Value::Integer32(100)));
        // Up and down, with the leading end first.
        assert_eq!(code(&mut dictionary, max, 400), None);
        assert_eq!(code(&mut dictionary, min, 300), None);
        assert_eq!(code(&mut dictionary, min, -400), None);
        assert_eq!(code(&mut dictionary, max, -300), None);
    }
}

#[test]
fn factors_that_do_not_multiply_are_refused_together() {
    let mut dictionary = Dictionary::new();
    // Primes below 2³²: nothing is reduced, and three of them need 96 bits.
    for (at, prime) in [(object(0x608F, 1), 4_294_967_291_u32), (object(0x6091, 1), 2_147_483_647)] {
        assert_eq!(code(&mut dictionary, at, prime), None);
    }
    let at = object(0x6096, 2);
    let refused = dictionary.write(at, Value::Unsigned32(4_294_967_279), DISABLED).unwrap_err();
    assert_eq!(refused.abort_code(), AbortCode::Incompatible);
    let message = refused.to_string();
    assert!(message.starts_with("6096h:02h = 4294967279 does not fit the other objects of the factor group: "));
    assert!(message.ends_with("choose factors that have more in common, or a coarser unit"), "{message}");
    assert_eq!(dictionary.read(at), Ok(Value::Unsigned32(1)));
}

#[test]
fn what_scales_the_axis_waits_until_it_is_not_driven() {
    let writes: [(Object, Value); 6] = [
        (object(0x607E, 0), 0x80_u8.into()),
        (object(0x608F, 1), 4_096_u32.into()),
        (object(0x6091, 2), 3_u32.into()),
        (object(0x6092, 1), 10_u32.into()),
        (object(0x6096, 1), 60_u32.into()),
        (object(0x607B, 1), 0_i32.into()),
    ];
    for state in PowerState::ALL {
        let is_driven = matches!(
            state,
            PowerState::OperationEnabled | PowerState::QuickStopActive | PowerState::FaultReactionActive
        );
        for (at, value) in writes {
            let mut dictionary = Dictionary::new();
            let code = dictionary.write(at, value, state).err().map(|refused| refused.abort_code());
            assert_eq!(code, is_driven.then_some(AbortCode::DeviceState), "{at} in {state}");
        }
        // Windows and set-points can be written at any time.
        assert!(Dictionary::new().write(object(0x6065, 0), 5_u32.into(), state).is_ok());
        assert!(Dictionary::new().write(object(0x607A, 0), 5_i32.into(), state).is_ok());
    }
}

/// Oracle: the tables of bits 10, 12 and 13 in the profile, homing mode and interpolated position mode. In every other state, mode
/// and result the method and the sub-mode can be written.
#[test]
fn what_a_motion_goes_by_waits_for_its_end() {
    let writes: [(Object, Value, i8); 2] =
        [(object(0x6098, 0), 7_i8.into(), 6), (object(0x60C0, 0), (-2_i16).into(), 7)];
    for (at, value, governing) in writes {
        for state in PowerState::ALL {
            for mode in [0, 1, 3, 4, 6, 7, 8, 9, 10] {
                for bits in 0..8_u16 {
                    let [reached, bit_12, bit_13] = [1, 2, 4].map(|bit| bits & bit != 0);
                    let word = Statusword::of(state).bits()
                        | u16::from(reached) << 10
                        | u16::from(bit_12) << 12
                        | u16::from(bit_13) << 13;
                    let mut dictionary = Dictionary::new();
                    let actuals = Actuals { statusword: Statusword::from_bits(word), mode, ..Actuals::default() };
                    dictionary.mirror(&Commands::default(), &actuals);
                    let is_under_way = if mode == 6 { bits == 0 } else { bit_12 };
                    let is_refused = state == PowerState::OperationEnabled && mode == governing && is_under_way;
                    let code = dictionary.write(at, value, state).err().map(|refused| refused.abort_code());
                    assert_eq!(
                        code,
                        is_refused.then_some(AbortCode::DeviceState),
                        "{at} in {state}, {mode}, {bits:03b}"
                    );
                }
            }
        }
    }
}
