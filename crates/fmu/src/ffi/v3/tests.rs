//! The functions of FMI 3.0 as called by a host.
use super::*;
use crate::ffi::host::{Messages, Room, recording};
use crate::part::Part;
use std::ffi::c_void;
use std::ptr;

/// Base rate of the demo (Hz).
const RATE: f64 = 16_000.0;

unsafe extern "C" fn log(environment: *mut c_void, status: Status, category: Text, message: Text) {
    // SAFETY: the environment is that of `instantiate`, the texts end with a zero byte.
    let (messages, category, message) =
        unsafe { (&*environment.cast::<Messages>(), CStr::from_ptr(category), CStr::from_ptr(message)) };
    let [category, message] = [category, message].map(|text| text.to_string_lossy().into_owned());
    messages.add(status.0, category, message);
}

/// An instance, until it is dropped.
struct Fmu<'a> {
    instance: Instance,
    room: &'a Room,
}

impl Drop for Fmu<'_> {
    fn drop(&mut self) {
        // SAFETY: the instance is not used any more.
        unsafe { fmi3FreeInstance(self.instance) };
    }
}

fn begun(room: &Room) -> Fmu<'_> {
    let (path, environment) = (room.path(), room.log.environment());
    let (token, none) = (room.token.as_ptr(), ptr::null());
    // SAFETY: all pointers are those of living values.
    let instance = unsafe {
        fmi3InstantiateCoSimulation(
            c"axis".as_ptr(),
            token,
            path.as_ptr(),
            0,
            1,
            0,
            0,
            none,
            0,
            environment,
            Some(log),
            None,
        )
    };
    assert!(!instance.is_null(), "{:?}", room.log.take());
    // SAFETY: the instance lives.
    unsafe {
        assert_eq!(fmi3EnterInitializationMode(instance, 0, 0.0, 0.0, 0, 0.0), Status::OK);
        assert_eq!(fmi3ExitInitializationMode(instance), Status::OK);
    }
    Fmu { instance, room }
}

impl Fmu<'_> {
    fn get(&self, name: &str) -> f64 {
        let (reference, mut value) = (self.room.output(name), f64::NAN);
        // SAFETY: one value for one reference.
        let status = unsafe { fmi3GetFloat64(self.instance, &raw const reference, 1, &raw mut value, 1) };
        assert_eq!(status, Status::OK, "{:?}", self.room.log.take());
        value
    }

    /// Steps from tick `from` over `ticks`; returns the status and the last successful time.
    fn step(&self, from: u32, ticks: f64) -> (Status, f64) {
        let (mut flags, mut time) = ([7; 3], f64::NAN);
        let [event, terminate, early] = flags.each_mut().map(ptr::from_mut);
        let (from, length) = (f64::from(from) / RATE, ticks / RATE);
        // SAFETY: the instance and the places live.
        let status = unsafe { fmi3DoStep(self.instance, from, length, 1, event, terminate, early, &raw mut time) };
        assert_eq!(flags, [v3::FALSE; 3]);
        (status, time)
    }

    fn said(&self) -> String {
        self.room.log.take().pop().map(|(_, _, message)| message).unwrap_or_default()
    }
}

/// Oracle: the recording of `servobench run`, bit for bit.
#[test]
fn what_it_computes_is_what_a_run_records() {
    let (room, expected) = (Room::new(Part::Axis), recording(2_000));
    let fmu = begun(&room);
    let values = |name: &str| &expected.channels.iter().find(|channel| channel.spec.name == name).unwrap().values;
    let (position, effort) = (values("load.position"), values("effort.motor"));
    for tick in 0..2_000 {
        assert_eq!(fmu.step(tick, 1.0), (Status::OK, f64::from(tick) / RATE + 1.0 / RATE));
        let row = tick as usize;
        assert_eq!(fmu.get("load.position").to_bits(), position[row + 1].to_bits(), "step {tick}");
        assert_eq!(fmu.get("effort.motor").to_bits(), effort[row].to_bits(), "step {tick}");
    }
}

#[test]
fn a_step_of_no_whole_number_of_ticks_is_an_error() {
    let room = Room::new(Part::Axis);
    let fmu = begun(&room);
    assert_eq!(fmu.step(0, 3.0), (Status::OK, 3.0 / RATE));
    assert_eq!(fmu.step(3, 0.7), (Status::ERROR, 3.0 / RATE));
    assert!(fmu.said().starts_with("fmi3DoStep: the step of "));
    assert_eq!(fmu.step(3, 1.0).0, Status::ERROR, "it stays so");
}

/// Oracle: §2.3 and §4.2; an error ends the instance, except for reset and saved states.
#[test]
fn what_it_has_not_is_refused_by_name() {
    let room = Room::new(Part::Axis);
    let calls: [(&str, unsafe extern "C" fn(Instance) -> Status, &str); 5] = [
        ("fmi3EnterEventMode", fmi3EnterEventMode, "hasEventMode = false"),
        ("fmi3EnterStepMode", fmi3EnterStepMode, "hasEventMode = false"),
        ("fmi3EnterConfigurationMode", fmi3EnterConfigurationMode, "no structural parameters"),
        ("fmi3EnterContinuousTimeMode", fmi3EnterContinuousTimeMode, "for co-simulation"),
        ("fmi3ExitInitializationMode", fmi3ExitInitializationMode, "in initialization mode only"),
    ];
    for (name, call, why) in calls {
        let fmu = begun(&room);
        // SAFETY: the instance lives.
        assert_eq!(unsafe { call(fmu.instance) }, Status::ERROR, "{name}");
        let said = fmu.said();
        assert!(said.starts_with(name) && said.contains(why), "{said}");
        // SAFETY: the instance lives.
        unsafe {
            assert_eq!(fmi3Terminate(fmu.instance), Status::ERROR, "after an error");
            assert_eq!(fmi3Reset(fmu.instance), Status::OK);
        }
    }
}

#[test]
fn other_types_and_other_lengths_are_refused() {
    let room = Room::new(Part::Axis);
    let reference = room.output("load.position");
    let (mut float, mut number, mut text) = (0.0_f32, 0_i64, ptr::null());
    // SAFETY: one value for one reference, where it says so.
    unsafe {
        let fmu = begun(&room);
        assert_eq!(fmi3GetFloat32(fmu.instance, &raw const reference, 1, &raw mut float, 1), Status::ERROR);
        assert!(fmu.said().contains("`load.position`") && float.to_bits() == 0);
        let fmu = begun(&room);
        assert_eq!(fmi3GetInt64(fmu.instance, &raw const reference, 1, &raw mut number, 1), Status::ERROR);
        assert!(fmu.said().contains("is of the type Float64, not Int64"));
        let fmu = begun(&room);
        assert_eq!(fmi3GetString(fmu.instance, &raw const reference, 1, &raw mut text, 1), Status::ERROR);
        assert!(text.is_null());
        let fmu = begun(&room);
        let value = [0.0; 2];
        assert_eq!(fmi3SetFloat64(fmu.instance, &raw const reference, 1, value.as_ptr(), 2), Status::ERROR);
        assert!(fmu.said().contains("2 values for 1 value references"));
        let fmu = begun(&room);
        let command = room.input("command");
        assert_eq!(fmi3GetInt64(fmu.instance, &raw const command, 1, &raw mut number, 1), Status::OK);
        assert_eq!(number, 1, "the program");
    }
}

/// Oracle: the run, continued.
#[test]
fn a_state_and_its_bytes_go_on_to_the_bit() {
    let room = Room::new(Part::Axis);
    let (one, other) = (begun(&room), begun(&room));
    assert_eq!(one.step(0, 1_500.0).0, Status::OK);
    let (mut state, mut copy, mut size) = (ptr::null_mut(), ptr::null_mut(), 0);
    // SAFETY: places and buffers are those of living values, of the requested size.
    unsafe {
        assert_eq!(fmi3GetFMUState(one.instance, &raw mut state), Status::OK);
        assert_eq!(fmi3SerializedFMUStateSize(one.instance, state, &raw mut size), Status::OK);
        let mut bytes = vec![0; size];
        assert_eq!(fmi3SerializeFMUState(one.instance, state, bytes.as_mut_ptr(), size), Status::OK);
        assert_eq!(fmi3DeserializeFMUState(other.instance, bytes.as_ptr(), size, &raw mut copy), Status::OK);
        assert_eq!(fmi3SetFMUState(other.instance, copy), Status::OK);
    }
    let go = |fmu: &Fmu| {
        assert_eq!(fmu.step(1_500, 500.0).0, Status::OK);
        ["load.position", "current.q", "velocity.reference"].map(|name| fmu.get(name).to_bits())
    };
    let expected = go(&one);
    assert_eq!(go(&other), expected);
    // SAFETY: the states are those of above and live.
    unsafe {
        assert_eq!(fmi3SetFMUState(one.instance, state), Status::OK);
        assert_eq!(go(&one), expected);
        assert_eq!(fmi3FreeFMUState(one.instance, &raw mut state), Status::OK);
        assert_eq!(fmi3FreeFMUState(one.instance, &raw mut copy), Status::OK);
    }
    assert!(state.is_null() && copy.is_null());
}

#[test]
fn other_interfaces_are_not_instantiated() {
    let room = Room::new(Part::Axis);
    let (path, token) = (room.path(), room.token.as_ptr());
    let environment = room.log.environment();
    // SAFETY: all pointers are those of living values.
    unsafe {
        assert!(
            fmi3InstantiateModelExchange(c"a".as_ptr(), token, path.as_ptr(), 0, 0, environment, Some(log)).is_null()
        );
        assert!(room.log.take()[0].2.contains("for model exchange"));
        let (path, name) = (path.as_ptr(), c"a".as_ptr());
        assert!(
            fmi3InstantiateScheduledExecution(name, token, path, 0, 0, environment, Some(log), None, None, None)
                .is_null()
        );
        assert!(room.log.take()[0].2.contains("for scheduled execution"));
    }
}
