//! Diagnostics of FMUs.
use crate::AXIS;
use servobench_scenario::{LoadError, load};

/// Diagnostics of the axis with `addition`, in a folder with the files `a.fmu` and `b.fmu`; lines count from the addition's.
fn said(addition: &str) -> Vec<String> {
    let folder = tempfile::tempdir().unwrap();
    for file in ["a.fmu", "b.fmu"] {
        std::fs::write(folder.path().join(file), "").unwrap();
    }
    let path = folder.path().join("axis.toml");
    std::fs::write(&path, format!("{AXIS}{addition}")).unwrap();
    let shift = AXIS.lines().count();
    let (all, sources) = match load(&path) {
        Ok(loaded) => (loaded.warnings, loaded.sources),
        Err(LoadError::Invalid(invalid)) => (invalid.diagnostics, invalid.sources),
        Err(other) => panic!("{other}"),
    };
    let relative = all.iter().map(|one| {
        let line = one.line(&sources).replace(&format!("{}/", folder.path().display()), "");
        let line = line.trim_start_matches("axis.toml:").to_owned();
        let (number, rest) = line.split_once(':').unwrap();
        match number.parse::<usize>().unwrap().checked_sub(shift) {
            Some(number) if number > 0 => format!("{number}:{rest}"),
            _ => line,
        }
    });
    relative.collect()
}

fn check(cases: &[(&str, &[&str])]) {
    for (addition, expected) in cases {
        assert_eq!(said(addition), *expected, "{addition}");
    }
}

const LOAD: &str =
    "[[fmu]]\nfile = \"a.fmu\"\ninputs = { x = \"load.position\" }\noutputs = { F = \"disturbance.load\" }\n";

#[test]
fn fmus_beside_the_axis_are_right() {
    check(&[
        (LOAD, &[]),
        (&format!("{LOAD}excites = true\n"), &[]),
        (&format!("{LOAD}[coupling]\nstep = \"1 ms\"\nmethod = \"iterated\"\ntolerance = 1e-6\niterations = 9\n"), &[]),
        (
            &format!(
                "{LOAD}[[fmu]]\nfile = \"b.fmu\"\ninputs = {{ u = \"a.F\", t = \"time\", \"v[1]\" = \"a.body.v\" }}\n"
            ),
            &[],
        ),
        (
            "[[fmu]]\nfile = \"a.fmu\"\nisolation = \"none\"\nparameters = { m = \"12 kg\", n = 3, k = [1.0, true], s.t = \"x\" }\n",
            &[],
        ),
    ]);
}

/// Signals of the axis `x`, with its name in front and without.
#[test]
fn signals_of_an_axis_with_a_name() {
    let said = |addition: &str| {
        let folder = tempfile::tempdir().unwrap();
        std::fs::write(folder.path().join("a.fmu"), "").unwrap();
        let path = folder.path().join("axis.toml");
        std::fs::write(&path, AXIS.replace("[axis]\n", "[axis]\nname = \"x\"\n") + addition).unwrap();
        match load(&path) {
            Ok(loaded) => Ok(loaded.scenario.fmus.into_iter().map(|fmu| (fmu.inputs, fmu.outputs)).collect::<Vec<_>>()),
            Err(error) => Err(error.to_string()),
        }
    };
    let own = said(LOAD).unwrap();
    let full = LOAD.replace("\"load.position", "\"x.load.position").replace("disturbance", "x.disturbance");
    assert_eq!(said(&full).unwrap(), own);
    let other = said(&LOAD.replace("\"load.position", "\"y.load.position")).unwrap_err();
    assert!(other.ends_with("`y.load.position` is not a signal; unknown axis `y`; the axes are: `x`"), "{other}");
    let other = said(&LOAD.replace("disturbance", "y.disturbance")).unwrap_err();
    assert!(other.ends_with("unknown axis `y`; the axes are: `x`"), "{other}");
    let taken = said(&format!("{LOAD}name = \"x\"\n")).unwrap_err();
    assert!(taken.ends_with("an FMU and the axis are called `x`; give each its own `name`"), "{taken}");
}

#[test]
fn files_names_and_signals_are_there() {
    check(&[
        ("[[fmu]]\nname = \"x\"\n", &["1:1: missing `file` in `fmu`"]),
        (
            "[[fmu]]\nfile = \"c.fmu\"\n",
            &["2:8: cannot read `c.fmu`: No such file or directory (os error 2); the path is relative to this file"],
        ),
        (
            &format!("{LOAD}{LOAD}"),
            &[
                "5:1: a second FMU is called `a`; give each its own `name`",
                "8:17: `disturbance.load` is given by another FMU too; efforts are not added here: let one FMU sum them",
            ],
        ),
        (
            "[[fmu]]\nname = \"load\"\nfile = \"a.fmu\"\n",
            &[
                "2:8: `load` cannot name an FMU; signals are called `name.variable`: give a `name` without a point that does not begin the name of a channel",
            ],
        ),
        (
            "[[fmu]]\nfile = \"a.fmu\"\ninputs = { x = \"load.positon\" }\n",
            &["3:16: `load.positon` is not a signal; did you mean `load.position`?"],
        ),
        (
            "[[fmu]]\nfile = \"a.fmu\"\noutputs = { x = \"load.position\" }\n",
            &["3:17: `load.position` is not an output that an FMU can have here; known here: `disturbance.motor`, \
                 `disturbance.load`, `setpoint.position`, `setpoint.velocity`, `setpoint.acceleration`, `effort.motor`, \
                 `voltage.d`, `voltage.q`"],
        ),
        (
            "[[fmu]]\nfile = \"a.fmu\"\ninputs = { x = 3 }\n",
            &["3:16: a signal is a string, got 3; write variable = \"load.position\""],
        ),
        (
            "[[fmu]]\nfile = \"a.fmu\"\noutputs = { x = \"disturbance.load\", y = \"disturbance.load\" }\n",
            &["3:41: `disturbance.load` is given twice; one output is one signal"],
        ),
    ]);
}

#[test]
fn steps_fit_and_keys_belong_together() {
    check(&[
        (
            "[coupling]\nstep = \"1 ms\"\n",
            &["1:1: there is nothing to couple; give `[[fmu]]`; `[axis.fmu]` has a separate `step`"],
        ),
        (&format!("{LOAD}step = \"0.1 ms\"\n"), &["5:8: `step` is 1.6000 base ticks, not a whole number; 125 us fits"]),
        (
            &format!("{LOAD}step = \"3 ms\"\n[coupling]\nstep = \"2 ms\"\n"),
            &["5:8: `step` is 48 base ticks, not a whole number of steps of `[coupling]`, 32"],
        ),
        // For algebraic loops, which are possible with every method.
        (&format!("{LOAD}[coupling]\niterations = 3\ntolerance = 1e-5\n"), &[]),
        (
            "[[fmu]]\nfile = \"a.fmu\"\nexcites = true\ninputs = { x = \"load.position\" }\n",
            &["3:11: `excites` is for an FMU that gives an effort; connect an output to `disturbance.motor` or \
               `disturbance.load`, or leave it out"],
        ),
        (
            &format!("{LOAD}isolation = \"none\"\ncall_timeout = \"1 s\"\n"),
            &["6:16: `call_timeout` is for an FMU in a separate process; leave `isolation` out"],
        ),
    ]);
}

#[test]
fn what_an_fmu_stands_for_has_no_double() {
    let of = |outputs: &str| format!("[[fmu]]\nfile = \"a.fmu\"\noutputs = {{ {outputs} }}\n");
    check(&[
        (&of("x = \"setpoint.velocity\""), &["3:17: a set-point needs a position; connect `setpoint.position` too"]),
        (&of("u = \"voltage.d\""), &["3:17: a voltage needs both parts; connect `voltage.d` and `voltage.q`"]),
        (&of("u = \"voltage.d\", v = \"voltage.q\""), &[]),
    ]);
}

#[test]
fn mechanics_need_their_engine_and_their_outputs() {
    let fmu = |outputs: &str| {
        format!("[axis.fmu]\nfile = \"a.fmu\"\ninputs = {{ tau = \"effort.motor\" }}\noutputs = {{ {outputs} }}\n")
    };
    check(&[
        (&fmu("x = \"shaft.position\", v = \"shaft.velocity\""), &["1:1: `fmu` is not used; add \"fmu\" to `engine`"]),
        (
            &fmu("x = \"load.position\""),
            &[
                "4:11: no output is `shaft.position`; mechanics give the motor's position in the motor coordinate, and the load's \
               unless they are one body",
            ],
        ),
        (
            &fmu("x = \"shaft.position\", v = \"load.velocity\""),
            &["4:39: a load with a velocity needs a position; connect `load.position` too"],
        ),
        (
            "[axis.fmu]\nfile = \"a.fmu\"\noutputs = { x = \"shaft.position\" }\n",
            &["1:1: no input is given `effort.motor`; write inputs = { variable = \"effort.motor\" }"],
        ),
    ]);
}

/// With an FMU in place of the drive only FMUs read sensors.
#[test]
fn sensors_that_nothing_reads_are_mistakes() {
    let of = |inputs: &str, outputs: &str| {
        format!("[[fmu]]\nfile = \"a.fmu\"\ninputs = {{ {inputs} }}\noutputs = {{ {outputs} }}\n")
    };
    let (effort, voltage) = ("e = \"effort.motor\"", "d = \"voltage.d\", q = \"voltage.q\"");
    let encoder = "[motor.encoder]\nstep = \"0.01 deg\"\nnoise = \"0.0001 deg\"\n";
    let idle = "is not used: an FMU replaces the drive, and none is given `measured.motor.position`; connect an input to \
                `measured.motor.position`, or leave it out";
    check(&[
        (&format!("{encoder}{}", of("x = \"motor.position\"", effort)), &[&format!("3:9: `noise` {idle}")]),
        // A resolution alone is a warning.
        (
            &format!("[motor.encoder]\nstep = \"0.01 deg\"\n{}", of("x = \"motor.position\"", effort)),
            &[&format!("2:8: `step` {idle}")],
        ),
        (&format!("{encoder}{}", of("x = \"measured.motor.position\"", effort)), &[]),
        (&format!("{encoder}{LOAD}"), &[]),
        (
            &format!("[motor.encoder]\ncommutation_offset = \"3 deg\"\n{}", of("x = \"motor.position\"", voltage)),
            &[
                "2:22: `commutation_offset` is not used: the voltage of an FMU in place of the drive is in the frame of the rotor \
               itself; leave it out",
            ],
        ),
        (
            &format!("[drive.current.sensor]\noffset_a = \"0.1 A\"\n{}", of("x = \"motor.position\"", voltage)),
            &[
                "2:12: `offset_a` is not used: no FMU is given the measured current; connect an input to `measured.current.d` or \
               `measured.current.q`, or leave it out",
            ],
        ),
        (
            &format!("[drive.current.sensor]\noffset_a = \"0.1 A\"\n{}", of("x = \"measured.current.q\"", effort)),
            &[
                "2:12: `offset_a` is not used: no FMU is given the measured current; leave it out: an FMU that gives `effort.motor` \
               replaces the motor, too",
            ],
        ),
        (&format!("[drive.current.sensor]\noffset_a = \"0.1 A\"\n{}", of("x = \"measured.current.q\"", voltage)), &[]),
    ]);
}
