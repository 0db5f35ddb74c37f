//! FMUs beside the axis, here written in Rust.
use crate::rig::{self, values};
use servobench_fmi::{
    Capabilities, DataType, DeclaredNumber, DeclaredUnit, Exponents, FmuEntry, FmuMistake, FmuRequest, Slave,
    SlaveError, StepEnd,
};
use servobench_plant::{Engine, Exact};
use servobench_scenario as scenario;
use servobench_sim::{Bench, FmuDoubt, FmuOpener, NoFmus};
use servobench_trace::Recording;
use std::f64::consts::TAU;
use std::sync::Arc;
use std::sync::atomic::{AtomicUsize, Ordering};

/// A prescribed or driven table of 40 kg and, beside it, parts by their file's name.
pub(crate) const TABLE: &str = r#"
[run]
base_rate = "16 kHz"
duration = "0.5 s"
[axis]
motion = "linear"
motor_side.mass = "40 kg"
[motor]
kind = "pmsm"
pole_pitch = "16 mm"
resistance = "1.6 Ohm"
inductance = "3.5 mH"
flux_linkage = "0.06 V s"
max_current = "13.3 Arms"
[drive]
enabled = false
"#;

/// A drive, which an FMU stands for.
const DRIVE: &str = r#"dc_link = "320 V"
[drive.current]
rate = "16 kHz"
bandwidth = "1 kHz"
[drive.velocity]
rate = "8 kHz"
bandwidth = "60 Hz"
[drive.position]
rate = "4 kHz"
gain = "80 1/s"
"#;

/// A part: outputs by the time, the length of the step and the means of the inputs.
struct Part {
    law: fn(f64, f64, &[f64]) -> f64,
    last: Vec<f64>,
    saves: bool,
}

impl Slave for Part {
    fn capabilities(&self) -> Capabilities {
        Capabilities { saves_state: self.saves, ..Capabilities::default() }
    }

    fn step(&mut self, time: f64, length: f64, inputs: &[[f64; 3]]) -> Result<StepEnd, SlaveError> {
        let mean: Vec<f64> =
            inputs.iter().map(|[u, d, dd]| u + d * length / 2.0 + dd * length * length / 6.0).collect();
        self.last.fill((self.law)(time, length, &mean));
        Ok(StepEnd::Done)
    }

    /// A part with an input follows it without a step.
    fn read(&mut self, inputs: Option<&[f64]>, outputs: &mut [f64]) -> Result<(), SlaveError> {
        if let Some(inputs) = inputs.filter(|inputs| !inputs.is_empty()) {
            self.last.fill((self.law)(0.0, 0.0, inputs));
        }
        outputs.copy_from_slice(&self.last);
        Ok(())
    }

    fn save(&mut self) -> Result<(), SlaveError> {
        Ok(())
    }

    fn restore(&mut self) -> Result<(), SlaveError> {
        Ok(())
    }
}

/// Gives what it was given in its last step, and half of it more if it is read with inputs; opens as itself.
#[derive(Clone, Default)]
struct Relay {
    feeds_through: bool,
    last: f64,
    /// How often all of them were read with inputs.
    readings: Arc<AtomicUsize>,
    /// Its output and its input.
    declared: Option<[DeclaredNumber; 2]>,
}

impl FmuOpener for Relay {
    fn open(&self, _: &FmuRequest<'_>) -> Result<Box<dyn Slave>, Vec<FmuMistake>> {
        Ok(Box::new(self.clone()))
    }
}

impl Slave for Relay {
    fn feeds_through(&self, _output: usize, _input: usize) -> bool {
        self.feeds_through
    }

    fn declared_output(&self, _output: usize) -> Option<&DeclaredNumber> {
        self.declared.as_ref().map(|[output, _]| output)
    }

    fn declared_input(&self, _input: usize) -> Option<&DeclaredNumber> {
        self.declared.as_ref().map(|[_, input]| input)
    }

    fn step(&mut self, _: f64, _: f64, inputs: &[[f64; 3]]) -> Result<StepEnd, SlaveError> {
        self.last = inputs.first().map_or(0.0, |input| input[0]);
        Ok(StepEnd::Done)
    }

    fn read(&mut self, inputs: Option<&[f64]>, outputs: &mut [f64]) -> Result<(), SlaveError> {
        self.readings.fetch_add(usize::from(inputs.is_some()), Ordering::Relaxed);
        outputs.fill(self.last + inputs.and_then(<[f64]>::first).map_or(0.0, |input| 0.5 * input));
        Ok(())
    }
}

/// Parts by the name of the FMU.
struct Parts;

/// Stiffness of the spring that stands for a load (N/m), with 40 kg a mode of 10 Hz.
const STIFFNESS: f64 = 40.0 * (TAU * 10.0) * (TAU * 10.0);

impl FmuOpener for Parts {
    fn open(&self, request: &FmuRequest<'_>) -> Result<Box<dyn Slave>, Vec<FmuMistake>> {
        let name = request.name.unwrap_or_default();
        let law: fn(f64, f64, &[f64]) -> f64 = match name {
            "spring" => |_, _, u| -STIFFNESS * u[0],
            "push" => |t, h, _| if t + h < 0.1 - 1e-9 { 20.0 } else { 0.0 },
            "controller" => |_, _, u| 4e4 * (u[0] - u[1]) - 2e3 * u[2],
            // -3·(motor velocity) + 2·(set-point), which come in this order or the other.
            "first" => |_, _, u| 2.0 * u[1] - 3.0 * u[0],
            "second" => |_, _, u| 2.0 * u[0] - 3.0 * u[1],
            // 10 V per metre, both axes alike.
            "amplifier" => |_, _, u| 10.0 * u[0],
            "ramp" => |t, h, _| 0.01 * (t + h),
            other => return Err(vec![FmuMistake::of_file(&format!("no part `{other}`"))]),
        };
        let start = if name == "push" { 20.0 } else { 0.0 };
        Ok(Box::new(Part { law, last: vec![start; request.outputs.len()], saves: name == "spring" }))
    }
}

fn run(text: &str) -> Recording {
    rig::run_bench(bench(text, &Parts).unwrap_or_else(|error| panic!("{error}")))
}

fn bench(text: &str, fmu_opener: &dyn FmuOpener) -> Result<Bench, String> {
    bench_beside_fmus(text, &Exact, fmu_opener)
}

/// The bench of a scenario beside whose file lie FMUs, whose insides do not matter here.
pub(crate) fn bench_beside_fmus(text: &str, engine: &dyn Engine, fmu_opener: &dyn FmuOpener) -> Result<Bench, String> {
    let folder = tempfile::tempdir().unwrap();
    for name in ["spring", "push", "ramp", "controller", "amplifier", "first", "second", "tank"] {
        std::fs::write(folder.path().join(format!("{name}.fmu")), "").unwrap();
    }
    let path = folder.path().join("coupled.toml");
    std::fs::write(&path, text).unwrap();
    let loaded = scenario::load(&path).map_err(|error| error.to_string())?;
    Bench::with_fmus(&loaded.scenario, engine, fmu_opener).map_err(|error| error.to_string())
}

fn fmu(name: &str, keys: &str) -> String {
    format!("[[fmu]]\nfile = \"{name}.fmu\"\n{keys}")
}

/// Oracle: a force of 20 N as a disturbance of the scenario. What is exchanged is a line between two values, so that the force
/// falls within its last tick: half of that tick's impulse on 40 kg is missing, which goes on for 0.4 s.
#[test]
fn a_source_of_force_is_a_disturbance() {
    let push = "[[disturbance]]\non = \"load\"\nduration = \"0.1 s\"\nforce = \"20 N\"\n";
    let expected = run(&format!("{TABLE}{push}"));
    let found = run(&format!("{TABLE}{}", fmu("push", "outputs = { F = \"disturbance.load\" }\n")));
    let missing = 20.0 * 0.5 / 16e3 / 40.0 * 0.4;
    let (found, expected) = (values(&found, "load.position"), values(&expected, "load.position"));
    let most = found.iter().zip(expected).map(|(found, expected)| (found - expected).abs()).fold(0.0, f64::max);
    assert!((most / missing - 1.0).abs() < 1e-3, "{most} of {missing}");
    assert_eq!(found.len(), expected.len());
}

/// Oracle: x = x0·cos(ω·t) of 40 kg on the spring that the FMU is.
#[test]
fn a_load_behind_the_axis_swings_as_it_must() {
    let spring = fmu("spring", "inputs = { x = \"load.position\" }\noutputs = { F = \"disturbance.load\" }\n");
    let start = "[initial]\nload_position = \"1 mm\"\n";
    let error = |coupling: &str| {
        let recording = run(&format!("{TABLE}{start}{spring}{coupling}"));
        assert_eq!(recording.channels[0].values.len(), 8_001, "{coupling}: a row for each tick");
        let x = values(&recording, "load.position");
        let errors = x.iter().enumerate().map(|(k, x)| (x - 1e-3 * (TAU * 10.0 * k as f64 / 16e3).cos()).abs());
        errors.fold(0.0, f64::max)
    };
    // A force that is a step late drives the mode: its amplitude grows by e^(ω²·H·t/2), 0.5 s at a tick by 6.4 %. The mean of the
    // parabola through the last exchanges is right to second order and more.
    let held = error("[coupling]\nmethod = \"jacobi\"\nextrapolation = 0\n");
    let by_default = error("");
    let extrapolated = error("[coupling]\nmethod = \"jacobi\"\nextrapolation = 2\n");
    let iterated = error("[coupling]\nmethod = \"iterated\"\nextrapolation = 1\n");
    println!("held {held:.2e} m, extrapolated {extrapolated:.2e} m, iterated {iterated:.2e} m");
    assert!(held > 1e-5 && held < 2e-4, "{held}");
    assert!(extrapolated < held / 50.0, "{extrapolated}");
    assert!(by_default < held / 50.0, "{by_default}");
    assert!(iterated < held / 50.0, "{iterated}");
}

/// Oracle: the same with the inputs in another order, which means the same.
#[test]
fn inputs_may_be_named_in_any_order() {
    let keys = |inputs: &str| format!("inputs = {{ {inputs} }}\noutputs = {{ F = \"disturbance.load\" }}\n");
    let program = "[setpoint]\norder = 3\nvelocity = \"0.5 m/s\"\nacceleration = \"5 m/s2\"\njerk = \"100 m/s3\"\n\
                   [[program]]\nmove_to = \"50 mm\"\n";
    let table = TABLE.replace("enabled = false\n", DRIVE);
    let (x, v) = ("x = \"motor.velocity\"", "v = \"setpoint.position\"");
    let [one, other] = [("first", format!("{x}, {v}")), ("second", format!("{v}, {x}"))]
        .map(|(name, inputs)| run(&format!("{table}{program}{}", fmu(name, &keys(&inputs)))));
    assert!(
        one.channels.iter().any(|channel| channel.spec.name == "disturbance.load"),
        "what an FMU gives is recorded"
    );
    for (one, other) in one.channels.iter().zip(&other.channels) {
        assert!(one.values == other.values, "{}", one.spec.name);
    }
}

/// Oracle: by hand, 40 kg under the same law sampled at each tick and held over it.
#[test]
fn a_controller_samples_at_a_tick_and_holds_over_it() {
    let keys = "inputs = { x = \"setpoint.position\", y = \"motor.position\", v = \"motor.velocity\" }\n\
                outputs = { F = \"effort.motor\" }\n";
    let program = "[setpoint]\norder = 3\nvelocity = \"0.5 m/s\"\nacceleration = \"5 m/s2\"\njerk = \"100 m/s3\"\n\
                   [[program]]\nmove_to = \"50 mm\"\n";
    for extrapolation in [0, 2] {
        let coupling = format!("[coupling]\nextrapolation = {extrapolation}\n");
        let table = TABLE.replace("enabled = false\n", DRIVE);
        let recording = run(&format!("{table}{program}{}{coupling}", fmu("controller", keys)));
        let (setpoint, found) = (values(&recording, "setpoint.position"), values(&recording, "load.position"));
        let (mut x, mut v, mut most, h) = (0.0, 0.0, 0.0_f64, 1.0 / 16e3);
        for (wanted, found) in setpoint.iter().zip(found) {
            most = most.max((x - found).abs());
            let a = (4e4 * (wanted - x) - 2e3 * v) / 40.0;
            (x, v) = (x + h * (v + 0.5 * h * a), v + h * a);
        }
        println!("{most:.1e} m after {} mm", 1e3 * x);
        assert!(x > 0.045 && most < 1e-14, "{most}");
    }
}

/// A ring of FMUs that follow their inputs is solved at each exchange: each of its two is read with inputs more than once. One of
/// FMUs that say that they do not is no loop, and nothing is read again.
#[test]
fn a_ring_without_feedthrough_is_no_algebraic_loop() {
    let readings = |feeds_through| {
        let relays = Relay { feeds_through, ..Relay::default() };
        let ring = fmu("push", "name = \"a\"\ninputs = { u = \"b.y\" }\noutputs = { y = \"disturbance.load\" }\n")
            + &fmu("push", "name = \"b\"\ninputs = { u = \"a.y\" }\n");
        let text = format!("{TABLE}{ring}").replace("duration = \"0.5 s\"", "duration = \"10 ms\"");
        let outcome = bench(&text, &relays).unwrap().run(&mut |_| {});
        assert_eq!(outcome.failure, None);
        (relays.readings.load(Ordering::Relaxed), outcome.recording.channels[0].values.len())
    };
    let (looped, ticks) = readings(true);
    assert!(looped >= 2 * 2 * (ticks - 1), "{looped} in {ticks} ticks");
    assert_eq!(readings(false), (0, ticks));
}

/// Oracle: the encoder is off by 0.1 mm and the current sensor by 0.5 A on phase a alone (2/√3 times that as a vector), and an FMU in place of
/// the drive is given both at the tick itself.
#[test]
fn a_controller_is_given_what_the_sensors_say() {
    let keys = "inputs = { x = \"measured.motor.position\", i = \"measured.current.q\", v = \"motor.velocity\" }\n\
                outputs = { d = \"voltage.d\", q = \"voltage.q\" }\n";
    let sensors = TABLE
        .replace("[drive]\n", "encoder = { zero_offset = \"0.1 mm\" }\n[drive]\n")
        .replace("enabled = false\n", DRIVE)
        .replace("bandwidth = \"1 kHz\"\n", "bandwidth = \"1 kHz\"\nsensor = { offset_a = \"0.5 A\" }\n");
    let recording = run(&format!("{sensors}{}", fmu("amplifier", keys)));
    let pairs = |one, other| values(&recording, one).iter().zip(values(&recording, other));
    for (measured, position) in pairs("measured.motor.position", "motor.position") {
        // Two roundings of the sum.
        assert!((measured - position - 1e-4).abs() < 1e-15, "{measured} at {position}");
    }
    let off = pairs("measured.current.d", "current.d").zip(pairs("measured.current.q", "current.q"));
    for ((measured_d, d), (measured_q, q)) in off {
        let length = (measured_d - d).hypot(measured_q - q);
        assert!((length - 0.5 * 2.0 / 3.0_f64.sqrt()).abs() < 1e-12, "{length}");
    }
    // 10 V per metre of the 0.1 mm, as the first exchange has it.
    assert!((values(&recording, "voltage.q_reference")[0] - 1e-3).abs() < 1e-15);
    let ideal = TABLE.replace("enabled = false\n", DRIVE);
    let refused = bench(&format!("{ideal}{}", fmu("amplifier", keys)), &Parts).err().unwrap_or_default();
    assert!(refused.contains("no channel `measured.motor.position`"), "{refused}");
}

/// A force into a length of another FMU, as between an FMU and the axis.
#[test]
fn units_and_types_between_fmus_fit() {
    let with = |declared: [DeclaredNumber; 2]| {
        let ring = fmu("push", "name = \"a\"\n")
            + &fmu("push", "name = \"b\"\ninputs = { u = \"a.y\" }\noutputs = { y = \"disturbance.load\" }\n");
        bench(&format!("{TABLE}{ring}"), &Relay { declared: Some(declared), ..Relay::default() })
    };
    let number = |unit: Option<(&str, Exponents)>| DeclaredNumber {
        data_type: DataType::Float64,
        unit: unit.map(|(name, exponents)| DeclaredUnit { name: name.into(), exponents }),
    };
    let metre = || number(Some(("m", Exponents { m: 1, ..Exponents::default() })));
    let force = |name| number(Some((name, Exponents { kg: 1, m: 1, s: -2, ..Exponents::default() })));
    let integer = || DeclaredNumber { data_type: DataType::Int32, unit: None };
    let turns = |rad| number(Some(("w", Exponents { s: -1, rad, ..Exponents::default() })));
    for (from, to, says) in [
        (force("kN"), metre(), "`u` counts in `m`, into which `kN` of `a.y` cannot be turned"),
        (number(None), integer(), "`u` is of type Int32, and `a.y` of type Float64"),
    ] {
        let refused = with([from, to]).err().unwrap_or_default();
        assert!(refused.contains(says), "{refused}");
    }
    for (from, to) in [(force("kN"), force("N")), (turns(1), turns(0)), (integer(), number(None)), (integer(), metre())]
    {
        assert_eq!(with([from, to]).unwrap().fmu_doubts(), []);
    }
    for (from, to, says) in [
        (number(None), force("N"), "`a.y` has no unit, and `u` counts in `N`"),
        (metre(), number(None), "`u` has no unit, and `a.y` counts in `m`"),
    ] {
        let bench = with([from, to]).unwrap();
        let [FmuDoubt { index: 1, doubt }] = bench.fmu_doubts() else { panic!("{:?}", bench.fmu_doubts()) };
        assert!(doubt.at == FmuEntry::Input("u".into()) && doubt.message.starts_with(says), "{doubt}");
        let outcome = bench.run(&mut |_| {});
        assert!(outcome.recording.log.iter().any(|line| line.text.contains(says)), "{:?}", outcome.recording.log);
    }
}

/// Oracle: 40 kg on a spring of 10 Hz with 20 exchanges per period: 5·(ωH)²/12 is 4 %, with 320 a 256th of it.
#[test]
fn a_run_estimates_the_error_of_its_coupling() {
    let spring = fmu("spring", "inputs = { x = \"load.position\" }\noutputs = { F = \"disturbance.load\" }\n");
    let start = "[initial]\nload_position = \"1 mm\"\n";
    let estimate = |coupling: &str| run(&format!("{TABLE}{start}{spring}{coupling}")).coupling;
    let coarse = estimate("[coupling]\nstep = \"5 ms\"\n").unwrap();
    assert!(coarse.error > 0.02 && coarse.error < 0.08, "{coarse:?}");
    assert!(coarse.connection.contains("spring.F") || coarse.connection.contains("spring.x"), "{coarse:?}");
    let fine = estimate("[coupling]\nstep = \"0.3125 ms\"\n").unwrap();
    assert!(fine.error < coarse.error / 128.0, "{fine:?}");
    assert_eq!(run(TABLE).coupling, None);
    let push = fmu("push", "outputs = { F = \"effort.motor\" }\n");
    let table = TABLE.replace("enabled = false\n", DRIVE);
    assert_eq!(run(&format!("{table}{push}")).coupling, None, "a controller samples, which is no error");
}

#[test]
fn what_nobody_can_open_or_connect_is_refused() {
    let push = fmu("push", "outputs = { F = \"disturbance.load\" }\n");
    let refused = bench(&format!("{TABLE}{push}"), &NoFmus).err().unwrap_or_default();
    assert_eq!(refused, "FMU `push`: this program opens no FMUs");
    let spring = fmu("spring", "inputs = { x = \"table.position\" }\noutputs = { F = \"disturbance.load\" }\n");
    let refused = bench(&format!("{TABLE}{spring}"), &Parts).err().unwrap_or_default();
    assert!(
        refused.starts_with("this axis has no channel `table.position` for the input `x` of an FMU; it has"),
        "{refused}"
    );
}

#[test]
fn connections_say_how_late_they_are() {
    let spring = fmu("spring", "inputs = { x = \"load.position\" }\noutputs = { F = \"disturbance.load\" }\n");
    let delays = |coupling: &str| {
        let bench = bench(&format!("{TABLE}{spring}[coupling]\nstep = \"1 ms\"\n{coupling}"), &Parts).unwrap();
        let all = bench.delays().iter();
        all.map(|delay| format!("{} -> {}: {} ms", delay.from, delay.to, 1e3 * delay.delay)).collect::<Vec<_>>()
    };
    let (there, back) = ("load.position -> spring.x", "spring.F -> disturbance.load");
    assert_eq!(delays("method = \"jacobi\"\n"), [format!("{there}: 1 ms"), format!("{back}: 1 ms")]);
    assert_eq!(delays(""), [format!("{there}: 1 ms"), format!("{back}: 0 ms")]);
    assert_eq!(delays("method = \"iterated\"\n"), [format!("{there}: 0 ms"), format!("{back}: 0 ms")]);
}
