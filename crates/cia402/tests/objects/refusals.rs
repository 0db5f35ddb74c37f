//! Every refusal has its abort code, and names object, value, bound and remedy.
use crate::object;
use servobench_cia402::objects::{Dictionary, Value};
use servobench_cia402::units::Object;
use servobench_cia402::{Actuals, Commands, PowerState, SdoError, Statusword};

/// Codes by CiA 301, table 22.
fn assert_refused(refused: SdoError, code: u32, message: &str) {
    assert_eq!((refused.abort_code().bits(), refused.to_string().as_str()), (code, message));
}

fn refused(at: Object, value: impl Into<Value>) -> SdoError {
    let (mut dictionary, untouched) = (Dictionary::new(), Dictionary::new());
    let refused = dictionary.write(at, value.into(), PowerState::SwitchOnDisabled).unwrap_err();
    assert_eq!(dictionary, untouched, "{refused}");
    refused
}

#[test]
fn objects_that_are_not_there() {
    let dictionary = Dictionary::new();
    for index in [0, 0x1002, 0x6042, 0x60FB, 0xFFFF] {
        let refused = dictionary.read(object(index, 0)).unwrap_err();
        let message = format!("object {index:04X}h does not exist: take one of the drive's object dictionary");
        assert_refused(refused, 0x0602_0000, &message);
    }
    let refused = dictionary.read(object(0x6041, 1)).unwrap_err();
    assert_refused(refused, 0x0609_0011, "6041h:01h does not exist: `Statusword` has sub-indices up to 00h");
    let refused = dictionary.read(object(0x6091, 3)).unwrap_err();
    assert_refused(refused, 0x0609_0011, "6091h:03h does not exist: `Gear ratio` has sub-indices up to 02h");
}

#[test]
fn accesses_that_are_not_given() {
    let message = "`IP move segment command` (2010h:00h) is write only: keep what was written";
    assert_refused(Dictionary::new().read(object(0x2010, 0)).unwrap_err(), 0x0601_0001, message);
    for (at, name) in [
        (object(0x6041, 0), "`Statusword` (6041h:00h)"),
        (object(0x1018, 1), "`Vendor-ID` (1018h:01h)"),
        (object(0x607D, 0), "`Highest sub-index supported` (607Dh:00h)"),
    ] {
        let message = format!("{name} is read only: it reports the state of the drive");
        assert_refused(refused(at, 0_u8), 0x0601_0002, &message);
    }
}

#[test]
fn values_of_another_type_or_length() {
    let message = "`Controlword` (6040h:00h) is of type UNSIGNED16, got INTEGER16 6";
    assert_refused(refused(object(0x6040, 0), 6_i16), 0x0607_0010, message);
    for length in [0, 1, 3, 4, 8, 9] {
        let mut dictionary = Dictionary::new();
        let state = PowerState::SwitchOnDisabled;
        let refused = dictionary.download(object(0x6040, 0), &[0; 9][..length], state).unwrap_err();
        let message = format!("`Controlword` (6040h:00h) is of type UNSIGNED16, 2 byte long, got {length} byte");
        assert_refused(refused, 0x0607_0010, &message);
    }
}

#[test]
fn values_out_of_range() {
    let message = "`Quick stop option code` (605Ah:00h) must be at most 8, got 9";
    assert_refused(refused(object(0x605A, 0), 9_i16), 0x0609_0031, message);
    let message = "`Halt option code` (605Dh:00h) must be at least 1, got 0";
    assert_refused(refused(object(0x605D, 0), 0_i16), 0x0609_0032, message);
    let message = "`Modes of operation` (6060h:00h) must be one of [0, 1, 3, 4, 6, 7, 8, 9, 10], got 2";
    assert_refused(refused(object(0x6060, 0), 2_i8), 0x0609_0030, message);
    let message = "`Polarity` (607Eh:00h) must have no bits but 0xe0, got 0x81: clear the others";
    assert_refused(refused(object(0x607E, 0), 0x81_u8), 0x0609_0030, message);
    let refused = refused(object(0x6098, 0), 36_i8);
    assert_eq!(refused.abort_code().to_string(), "0609 0030h");
    assert!(refused.to_string().ends_with("33, 34, 35, 37], got 36"), "{refused}");
}

#[test]
fn a_scale_of_zero() {
    for index in [0x608F, 0x6091, 0x6092, 0x6096] {
        for subindex in [1, 2] {
            let refused = refused(object(index, subindex), 0_u32);
            assert_eq!(refused.abort_code().bits(), 0x0609_0032);
            assert!(refused.to_string().ends_with("must be at least 1, got 0"), "{refused}");
        }
    }
}

#[test]
fn a_drive_that_is_driving() {
    let mut dictionary = Dictionary::new();
    let at = object(0x6091, 1);
    let refused = dictionary.write(at, Value::Unsigned32(5), PowerState::OperationEnabled).unwrap_err();
    let message =
        "`Motor shaft revolutions` (6091h:01h) cannot be written in Operation enabled: disable operation first";
    assert_refused(refused, 0x0800_0022, message);
}

#[test]
fn a_search_that_is_under_way() {
    let (mut dictionary, state) = (Dictionary::new(), PowerState::OperationEnabled);
    let actuals = Actuals { statusword: Statusword::of(state), mode: 6, ..Actuals::default() };
    dictionary.mirror(&Commands::default(), &actuals);
    let refused = dictionary.write(object(0x6098, 0), Value::Integer8(17), state).unwrap_err();
    let message = "`Homing method` (6098h:00h) cannot be written while a motion of hm is under way: wait for its end, or clear \
                   bit 4 of the controlword";
    assert_refused(refused, 0x0800_0022, message);
}

#[test]
fn a_window_with_its_ends_exchanged() {
    let mut dictionary = Dictionary::new();
    let state = PowerState::SwitchedOn;
    dictionary.write(object(0x607D, 1), Value::Integer32(10), state).unwrap();
    let refused = dictionary.write(object(0x607D, 2), Value::Integer32(-10), state).unwrap_err();
    let message =
        "`Max position limit` (607Dh:02h) must be above 10, the other end, got -10: write the other end first";
    assert_refused(refused, 0x0609_0036, message);
}
