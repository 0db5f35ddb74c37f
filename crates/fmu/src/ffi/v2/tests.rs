//! The functions of FMI 2.0 as called by a host.
use super::*;
use crate::ffi::host::{Messages, Room, recording};
use crate::interface::{Kind, Role};
use crate::part::Part;
use servobench_config::Choice as _;
use servobench_testkit::Random;
use std::ptr;

/// Base rate of the demo (Hz).
const RATE: f64 = 16_000.0;

unsafe extern "C" fn log(environment: *mut c_void, _: Text, status: Status, category: Text, message: Text) {
    // SAFETY: the environment is that of `instantiate`, the texts end with a zero byte.
    let (messages, category, message) =
        unsafe { (&*environment.cast::<Messages>(), CStr::from_ptr(category), CStr::from_ptr(message)) };
    let [category, message] = [category, message].map(|text| text.to_string_lossy().into_owned());
    messages.add(status.0, category, message);
}

/// An instance, until it is dropped.
struct Fmu<'a> {
    c: Component,
    room: &'a Room,
    _functions: Box<v2::CallbackFunctions>,
}

impl Drop for Fmu<'_> {
    fn drop(&mut self) {
        // SAFETY: the instance is not used any more.
        unsafe { fmi2FreeInstance(self.c) };
    }
}

fn instantiate_as<'a>(room: &'a Room, kind: v2::Type, token: &CStr) -> Fmu<'a> {
    type Plain = unsafe extern "C" fn(*mut c_void, Text, Status, Text, Text);
    // SAFETY: on x86-64 a function without variable arguments takes a call with none of them.
    let logger = unsafe { std::mem::transmute::<Plain, v2::CallbackLogger>(log as Plain) };
    let functions = Box::new(v2::CallbackFunctions {
        logger: Some(logger),
        allocate_memory: None,
        free_memory: None,
        step_finished: None,
        component_environment: room.log.environment(),
    });
    let path = room.path();
    // SAFETY: all pointers are those of living values.
    let c =
        unsafe { fmi2Instantiate(c"axis".as_ptr(), kind, token.as_ptr(), path.as_ptr(), &raw const *functions, 0, 1) };
    Fmu { c, room, _functions: functions }
}

fn instantiate(room: &Room) -> Fmu<'_> {
    let fmu = instantiate_as(room, v2::Type::CO_SIMULATION, &room.token);
    assert!(!fmu.c.is_null(), "{:?}", room.log.take());
    fmu
}

/// An initialised instance.
fn begun(room: &Room) -> Fmu<'_> {
    let fmu = instantiate(room);
    fmu.initialise();
    fmu
}

impl Fmu<'_> {
    fn initialise(&self) {
        // SAFETY: the instance lives.
        unsafe {
            assert_eq!(fmi2SetupExperiment(self.c, 0, 0.0, 0.0, 0, 0.0), Status::OK);
            assert_eq!(fmi2EnterInitializationMode(self.c), Status::OK);
            assert_eq!(fmi2ExitInitializationMode(self.c), Status::OK);
        }
    }

    fn get(&self, references: &[u32]) -> Vec<f64> {
        let mut values = vec![f64::NAN; references.len()];
        // SAFETY: as many values as references.
        let status = unsafe { fmi2GetReal(self.c, references.as_ptr(), references.len(), values.as_mut_ptr()) };
        assert_eq!(status, Status::OK, "{:?}", self.room.log.take());
        values
    }

    fn set(&self, name: &str, value: f64) {
        assert_eq!(self.try_set(self.room.input(name), value), Status::OK, "{:?}", self.room.log.take());
    }

    fn try_set(&self, reference: u32, value: f64) -> Status {
        // SAFETY: one value for one reference.
        unsafe { fmi2SetReal(self.c, &raw const reference, 1, &raw const value) }
    }

    fn set_integer(&self, name: &str, value: i32) -> Status {
        let reference = self.room.input(name);
        // SAFETY: one value for one reference.
        unsafe { fmi2SetInteger(self.c, &raw const reference, 1, &raw const value) }
    }

    fn set_boolean(&self, name: &str, value: bool) {
        let (reference, value) = (self.room.input(name), i32::from(value));
        // SAFETY: one value for one reference.
        let status = unsafe { fmi2SetBoolean(self.c, &raw const reference, 1, &raw const value) };
        assert_eq!(status, Status::OK);
    }

    /// Steps from tick `from` over `ticks`.
    fn step(&self, from: u32, ticks: f64) -> Status {
        // SAFETY: the instance lives.
        unsafe { fmi2DoStep(self.c, f64::from(from) / RATE, ticks / RATE, 1) }
    }

    fn step_to(&self, ticks: std::ops::Range<u32>) {
        for tick in ticks {
            assert_eq!(self.step(tick, 1.0), Status::OK, "{:?}", self.room.log.take());
        }
    }

    /// Text of the last refusal.
    fn said(&self) -> String {
        self.room.log.take().pop().map(|(_, _, message)| message).unwrap_or_default()
    }
}

/// Value references of all outputs that are numbers, with their names.
fn outputs(room: &Room) -> Vec<(u32, &str)> {
    let all = (0..).zip(&room.model.variables);
    let is_real = |role: &Role, kind| matches!(role, Role::Output(_)) && kind == Kind::Real;
    all.filter(|(_, one)| is_real(&one.role, one.kind)).map(|(at, one)| (at, one.name.as_str())).collect()
}

/// True for outputs of the end of a step; the others are those of the tick before.
fn is_of_a_body(name: &str) -> bool {
    ["motor.", "table.", "load."].iter().any(|body| name.starts_with(body))
}

/// Oracle: the recording of `servobench run`, bit for bit. Two instances in turns, in steps of a tick and of 16.
#[test]
fn what_it_computes_is_what_a_run_records() {
    const TICKS: u32 = 4_000;
    let (room, expected) = (Room::new(Part::Axis), recording(TICKS));
    let (one, other) = (begun(&room), begun(&room));
    let names = outputs(&room);
    let references: Vec<u32> = names.iter().map(|(at, _)| *at).collect();
    for tick in 0..TICKS {
        one.step_to(tick..tick + 1);
        let found = one.get(&references);
        if tick % 16 == 15 {
            assert_eq!(other.step(tick - 15, 16.0), Status::OK);
            assert_eq!(other.get(&references), found, "tick {tick}");
        }
        for ((_, name), value) in names.iter().zip(found) {
            let channel = expected.channels.iter().find(|channel| channel.spec.name == *name).unwrap();
            let row = tick as usize + usize::from(is_of_a_body(name));
            assert_eq!(value.to_bits(), channel.values[row].to_bits(), "{name} in step {tick}");
        }
    }
    assert!(one.get(&[room.output("load.position")])[0] > 0.05, "it has moved");
}

/// Oracle: the axis in one piece. Drive first, mechanics with its output, measurements back: the loop's own order.
#[test]
fn drive_and_mechanics_apart_are_the_axis_to_the_bit() {
    let rooms = [Part::Axis, Part::Drive, Part::Mechanics].map(Room::new);
    let [axis, drive, mechanics] = rooms.each_ref().map(begun);
    let of_axis = ["load.position", "load.velocity", "motor.position"].map(|name| rooms[0].output(name));
    let of_mechanics = ["load.position", "load.velocity", "motor.position"].map(|name| rooms[2].output(name));
    let measured = ["shaft.position", "shaft.velocity", "load.position", "load.velocity"];
    let motion = measured.map(|name| rooms[2].output(name));
    let effort = [rooms[1].output("effort.motor")];
    for tick in 0..3_000 {
        for (name, value) in measured.iter().zip(mechanics.get(&motion)) {
            drive.set(name, value);
        }
        drive.step_to(tick..tick + 1);
        mechanics.set("effort.motor", drive.get(&effort)[0]);
        mechanics.step_to(tick..tick + 1);
        axis.step_to(tick..tick + 1);
        assert_eq!(axis.get(&of_axis), mechanics.get(&of_mechanics), "tick {tick}");
    }
    assert!(axis.get(&of_axis)[0] > 0.04, "it has moved");
}

/// Steps over `ticks` with inputs that change in each one; returns the outputs of each.
fn outputs_of(fmu: &Fmu, references: &[u32], ticks: std::ops::Range<u32>) -> Vec<f64> {
    let name = if fmu.room.model.part == Part::Drive { "shaft.velocity" } else { "force.load" };
    let steps = ticks.flat_map(|tick| {
        fmu.set(name, f64::from(tick % 7) * 0.1);
        fmu.step_to(tick..tick + 1);
        fmu.get(references)
    });
    steps.collect()
}

/// Oracle: the run itself, continued from the state.
#[test]
fn a_saved_state_goes_on_to_the_bit_and_so_do_its_bytes() {
    for &(_, part, _) in Part::ALL {
        let room = Room::new(part);
        let references: Vec<u32> = outputs(&room).iter().map(|(at, _)| *at).collect();
        let (one, other) = (begun(&room), begun(&room));
        outputs_of(&one, &references, 0..500);
        let (mut state, mut copy, mut size) = (ptr::null_mut(), ptr::null_mut(), 0);
        // SAFETY: places and buffers are those of living values, of the requested size.
        let bytes = unsafe {
            assert_eq!(fmi2GetFMUstate(one.c, &raw mut state), Status::OK);
            assert_eq!(fmi2SerializedFMUstateSize(one.c, state, &raw mut size), Status::OK);
            let mut bytes: Vec<c_char> = vec![0; size];
            assert_eq!(fmi2SerializeFMUstate(one.c, state, bytes.as_mut_ptr(), size - 1), Status::ERROR, "no room");
            assert_eq!(fmi2SetFMUstate(one.c, state), Status::OK, "a way out of an error");
            assert_eq!(fmi2SerializeFMUstate(one.c, state, bytes.as_mut_ptr(), size), Status::OK);
            assert_eq!(fmi2DeSerializeFMUstate(other.c, bytes.as_ptr(), size, &raw mut copy), Status::OK);
            bytes
        };
        let go = |fmu: &Fmu| outputs_of(fmu, &references, 500..900);
        let expected = go(&one);
        // SAFETY: both states are those of above and live.
        unsafe {
            for _ in 0..2 {
                assert_eq!(fmi2SetFMUstate(one.c, state), Status::OK);
                assert!(go(&one) == expected, "{part:?}: from the state");
            }
            assert_eq!(fmi2SetFMUstate(other.c, copy), Status::OK);
            assert!(go(&other) == expected, "{part:?}: from the bytes");
            let longer: Vec<c_char> = bytes.iter().copied().chain([0; 8]).collect();
            for (wrong, why) in [
                (&bytes[..size - 8], "end too early"),
                (&bytes[..size - 3], "end too early"),
                (&longer[..], "go on after its end"),
                (&bytes[1..], "of another FMU"),
            ] {
                let mut none = ptr::null_mut();
                assert_eq!(fmi2DeSerializeFMUstate(other.c, wrong.as_ptr(), wrong.len(), &raw mut none), Status::ERROR);
                assert!(other.said().contains(why) && none.is_null());
            }
            // One damaged byte, in a thousand places.
            let mut random = Random::seeded(40);
            for _ in 0..1_000 {
                let (mut damaged, mut none) = (bytes.clone(), ptr::null_mut());
                damaged[random.index(size)] ^= 1 << random.index(8);
                assert_eq!(fmi2DeSerializeFMUstate(other.c, damaged.as_ptr(), size, &raw mut none), Status::ERROR);
                assert!(none.is_null());
            }
            assert_eq!(fmi2FreeFMUstate(one.c, &raw mut state), Status::OK);
            assert_eq!(fmi2FreeFMUstate(one.c, &raw mut copy), Status::OK);
            assert!(state.is_null() && copy.is_null());
            assert_eq!(fmi2FreeFMUstate(one.c, &raw mut state), Status::OK, "NULL is freed, too");
        }
    }
}

/// A changed word of the state with a valid checksum is refused, or gives an axis that was never simulated; the host
/// survives either way.
#[test]
fn a_forged_state_ends_no_host() {
    let mut random = Random::seeded(41);
    let room = Room::new(Part::Axis);
    let (one, other) = (begun(&room), begun(&room));
    one.step_to(0..300);
    let (mut state, mut size) = (ptr::null_mut(), 0);
    // SAFETY: places and buffers are those of living values, of the requested size.
    let bytes = unsafe {
        assert_eq!(fmi2GetFMUstate(one.c, &raw mut state), Status::OK);
        assert_eq!(fmi2SerializedFMUstateSize(one.c, state, &raw mut size), Status::OK);
        let mut bytes: Vec<c_char> = vec![0; size];
        assert_eq!(fmi2SerializeFMUstate(one.c, state, bytes.as_mut_ptr(), size), Status::OK);
        bytes
    };
    let words = size / 8;
    let mut taken = 0;
    for _ in 0..2_000 {
        let (mut forged, mut copy) = (bytes.clone(), ptr::null_mut());
        let word = 6 + random.index(words - 7);
        let value = [0, 1, 255, u64::MAX, f64::NAN.to_bits(), 1e300_f64.to_bits(), random.index(1 << 40) as u64];
        let put = |forged: &mut [c_char], word: usize, value: u64| {
            for (place, byte) in forged[8 * word..].iter_mut().zip(value.to_le_bytes()) {
                *place = byte.cast_signed();
            }
        };
        put(&mut forged, word, random.one_of(&value));
        let unsigned: Vec<u8> = forged[..size - 8].iter().map(|byte| byte.cast_unsigned()).collect();
        put(&mut forged, words - 1, twox_hash::XxHash64::oneshot(0, &unsigned));
        // SAFETY: as above; an accepted state is freed.
        unsafe {
            if fmi2DeSerializeFMUstate(other.c, forged.as_ptr(), size, &raw mut copy) != Status::OK {
                continue;
            }
            if fmi2SetFMUstate(other.c, copy) == Status::OK {
                taken += 1;
                let (from, h) = (300.0 / 16e3, 1.0 / 16e3);
                for k in 0..20 {
                    if fmi2DoStep(other.c, from + f64::from(k) * h, h, 1) != Status::OK {
                        break;
                    }
                }
            }
            assert_eq!(fmi2FreeFMUstate(other.c, &raw mut copy), Status::OK);
            assert_eq!(fmi2SetFMUstate(other.c, state), Status::OK, "a way out of an error");
        }
    }
    assert!(taken > 500, "most numbers are as good as others: {taken}");
    // SAFETY: the state is that of above and lives.
    unsafe { assert_eq!(fmi2FreeFMUstate(one.c, &raw mut state), Status::OK) };
}

/// Oracle: §4.2.4. After an error only reset, a saved state and the end are allowed.
#[test]
fn a_call_in_the_wrong_state_is_refused() {
    let room = Room::new(Part::Axis);
    let position = room.output("load.position");
    let get = |fmu: &Fmu| {
        let mut value = 0.0;
        // SAFETY: one value for one reference.
        unsafe { fmi2GetReal(fmu.c, &raw const position, 1, &raw mut value) }
    };
    let fmu = instantiate(&room);
    // SAFETY: the instance lives.
    unsafe {
        let calls: [(&str, &dyn Fn() -> Status); 4] = [
            ("fmi2DoStep", &|| fmu.step(0, 1.0)),
            ("fmi2ExitInitializationMode", &|| fmi2ExitInitializationMode(fmu.c)),
            ("fmi2Terminate", &|| fmi2Terminate(fmu.c)),
            ("fmi2GetReal", &|| get(&fmu)),
        ];
        for (name, call) in calls {
            assert_eq!(call(), Status::ERROR, "{name} before initialization");
            assert!(fmu.said().starts_with(name));
            assert_eq!(fmi2EnterInitializationMode(fmu.c), Status::ERROR, "after an error");
            assert_eq!(fmi2Reset(fmu.c), Status::OK);
        }
        assert_eq!(fmi2EnterInitializationMode(fmu.c), Status::OK);
        assert_eq!(get(&fmu), Status::OK, "outputs have initial values");
        assert_eq!(fmi2SetupExperiment(fmu.c, 0, 0.0, 0.0, 0, 0.0), Status::ERROR);
        assert!(fmu.said().contains("not allowed in Initialization Mode: before initialization mode only"));
        assert_eq!(fmi2Reset(fmu.c), Status::OK);
        fmu.initialise();
        assert_eq!(fmi2EnterInitializationMode(fmu.c), Status::ERROR, "twice");
        assert_eq!(fmi2Reset(fmu.c), Status::OK);
        fmu.initialise();
        assert_eq!(fmi2Terminate(fmu.c), Status::OK);
        assert_eq!(get(&fmu), Status::OK, "the last values");
        assert_eq!(fmu.step(0, 1.0), Status::ERROR);
        assert!(fmu.said().contains("in the state Terminated"));
        assert_eq!(fmi2CancelStep(fmu.c), Status::ERROR);
        assert!(fmu.said().contains("not supported"));
    }
}

#[test]
fn references_types_and_values_are_checked() {
    let room = Room::new(Part::Axis);
    let refused = |call: &dyn Fn(&Fmu) -> Status, why: &str| {
        let fmu = begun(&room);
        assert_eq!(call(&fmu), Status::ERROR, "{why}");
        let said = fmu.said();
        assert!(said.contains(why), "{said}");
    };
    let count = u32::try_from(room.model.variables.len()).unwrap();
    refused(&|fmu| fmu.try_set(count, 0.0), "there is no variable with the value reference");
    refused(&|fmu| fmu.try_set(room.input("start"), 0.0), "is of the type Boolean, not Real");
    refused(&|fmu| fmu.try_set(room.output("load.position"), 0.0), "an output");
    refused(&|fmu| fmu.try_set(0, 0.0), "the independent variable");
    refused(&|fmu| fmu.try_set(room.input("target"), f64::NAN), "`target` takes finite values, got NaN");
    refused(&|fmu| fmu.try_set(room.input("override"), 2.1), "`override` takes values from 0 to 2, got 2.1");
    refused(&|fmu| fmu.try_set(room.input("load.inertia"), 1.0), "a fixed parameter, and initialization is over");
    let fmu = instantiate(&room);
    assert_eq!(fmu.set_integer("command", 4), Status::ERROR);
    assert!(fmu.said().contains("`command` takes values from 1 to 3, got 4"));
    let fmu = instantiate(&room);
    assert_eq!(fmu.try_set(room.input("load.inertia"), -1.0), Status::ERROR);
    let fmu = begun(&room);
    // SAFETY: NULL is refused.
    let status = unsafe { fmi2GetReal(fmu.c, ptr::null(), 1, ptr::null_mut()) };
    assert_eq!(status, Status::ERROR);
    assert!(fmu.said().contains("`vr` is NULL"));
}

/// A step that is not a whole number of ticks never fits: to discard it would make importers repeat it endlessly, as FMPy does.
#[test]
fn steps_are_whole_ticks_from_the_time_of_the_fmu_to_the_stop_time() {
    let room = Room::new(Part::Axis);
    let fmu = instantiate(&room);
    // SAFETY: the instance lives, the place is that of a value.
    unsafe {
        assert_eq!(fmi2SetupExperiment(fmu.c, 0, 0.0, 0.0, 1, 10.0 / RATE), Status::OK);
        assert_eq!(fmi2EnterInitializationMode(fmu.c), Status::OK);
        assert_eq!(fmi2ExitInitializationMode(fmu.c), Status::OK);
        fmu.step_to(0..4);
        assert_eq!(fmu.step(4, 6.0 * (1.0 + 1e-12)), Status::OK, "a rounding is no other length");
        assert_eq!(fmu.step(10, 1.0), Status::ERROR);
        assert!(fmu.said().contains("goes beyond the stop time 0.000625 s"));
    }
    for ticks in [0.4, 1.5, 2.01, 1e-9] {
        let fmu = begun(&room);
        fmu.step_to(0..4);
        assert_eq!(fmu.step(4, ticks), Status::ERROR, "{ticks}");
        let (status, category, message) = room.log.take().pop().unwrap();
        assert_eq!((status, category.as_str()), (3, "logStatusError"));
        assert!(message.contains("no whole number of base ticks of 1/16000 s"), "{message}");
        let mut time = 0.0;
        // SAFETY: the place is that of a value.
        unsafe { assert_eq!(fmi2GetRealStatus(fmu.c, StatusKind::LAST_SUCCESSFUL_TIME, &raw mut time), Status::OK) };
        assert_eq!(time.to_bits(), (4.0 / RATE).to_bits(), "nothing was computed");
        assert_eq!(fmu.step(4, 1.0), Status::ERROR, "it stays so");
    }
    for (from, ticks, why) in [(1, 1.0, "is not the time of the FMU"), (0, -1.0, "above zero"), (0, f64::NAN, "NaN")] {
        let fmu = begun(&room);
        assert_eq!(fmu.step(from, ticks), Status::ERROR);
        assert!(fmu.said().contains(why), "{why}");
    }
}

/// Oracle: the duration of a jerk-limited move in closed form, d/v + v/a + a/j, and the target.
#[test]
fn a_target_is_moved_to_when_execute_rises() {
    let room = Room::new(Part::Axis);
    let fmu = instantiate(&room);
    assert_eq!(fmu.set_integer("command", 2), Status::OK);
    for (name, limit) in [("target.velocity", 0.2), ("target.acceleration", 2.0), ("target.jerk", 40.0)] {
        fmu.set(name, limit);
    }
    fmu.initialise();
    fmu.set("target", 0.05);
    let position = [room.output("setpoint.position"), room.output("load.position")];
    fmu.step_to(0..100);
    assert_eq!(fmu.get(&position)[0].to_bits(), 0.0_f64.to_bits(), "nothing executes");
    fmu.set_boolean("execute", true);
    // 0.25 + 0.1 + 0.05 s; the set-point is that of the last tick.
    fmu.step_to(100..6_490);
    assert!(fmu.get(&position)[0] < 0.05 - 1e-12);
    fmu.step_to(6_490..6_502);
    assert!((fmu.get(&position)[0] - 0.05).abs() < 1e-12);
    fmu.step_to(6_502..16_000);
    // The load keeps swaying, by less than in the move of the demo at ten times the jerk: half a millimetre.
    assert!((fmu.get(&position)[1] - 0.05).abs() < 5e-4);
}

/// Oracle: the same run, started later.
#[test]
fn the_program_waits_for_start() {
    let (room, expected) = (Room::new(Part::Axis), recording(2_000));
    let fmu = begun(&room);
    fmu.set_boolean("start", false);
    fmu.step_to(0..333);
    fmu.set_boolean("start", true);
    fmu.step_to(333..2_000);
    let setpoint = expected.channels.iter().find(|one| one.spec.name == "setpoint.position").unwrap();
    assert_eq!(fmu.get(&[room.output("setpoint.position")])[0].to_bits(), setpoint.values[2_000 - 333 - 1].to_bits());
}

#[test]
fn what_it_is_not_is_not_instantiated() {
    let room = Room::new(Part::Axis);
    let fmu = instantiate_as(&room, v2::Type::MODEL_EXCHANGE, &room.token);
    assert!(fmu.c.is_null() && fmu.said().contains("it cannot be instantiated for model exchange"));
    let fmu = instantiate_as(&room, v2::Type::CO_SIMULATION, c"{another}");
    assert!(fmu.c.is_null() && fmu.said().contains("the model description has the token `{another}`"));
}

#[test]
fn the_location_is_a_uri_of_a_folder() {
    let path = |uri: &CStr| folder(uri).map(|path| path.display().to_string());
    for uri in [c"file:///tmp/a%20b/resources", c"file:/tmp/a b/resources", c"file://localhost/tmp/a%20b/resources"] {
        assert_eq!(path(uri).unwrap(), "/tmp/a b/resources", "{uri:?}");
    }
    assert_eq!(path(c"/tmp/100%/x").unwrap(), "/tmp/100%/x", "a plain path is taken as it is");
    assert_eq!(path(c"file:///tmp/%zz%").unwrap(), "/tmp/%zz%", "no escape");
    assert!(path(c"file://host/x").is_err());
}
