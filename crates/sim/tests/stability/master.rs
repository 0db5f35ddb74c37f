//! The position loop that a master closes over a bus.
use crate::files::scenario;
use servobench_sim::{Analysis, MasterLoop, analyse_stability};
use servobench_stability::Depth;
use std::f64::consts::{PI, TAU};

/// A mass under a velocity loop of 600 Hz.
const AXIS: &str = r#"
[run]
base_rate = "16 kHz"
[axis]
motion = "linear"
motor_side = { mass = "20 kg" }
[motor]
kind = "ideal-source"
[drive]
velocity = { rate = "8 kHz", bandwidth = "600 Hz", kind = "p" }
position = { rate = "8 kHz", bandwidth = "10 Hz" }
[setpoint]
order = 3
velocity = "0.5 m/s"
acceleration = "5 m/s2"
jerk = "200 m/s3"
"#;

/// Velocity loops (Hz), delays (cycles) and cycles (ms).
const BUSES: [(f64, u32, f64); 6] =
    [(600.0, 0, 1.0), (600.0, 1, 1.0), (600.0, 2, 1.0), (1500.0, 1, 4.0), (600.0, 0, 8.0), (600.0, 7, 2.0)];

/// The largest gain by the cycle, and the round trip in cycles with the age of the answer and the lag of the velocity loop in it.
fn largest((velocity, delay, cycle): (f64, u32, f64), gains: &str) -> [f64; 2] {
    let axis = AXIS.replace("600", &velocity.to_string());
    let bus =
        format!("cycle = \"{cycle} ms\"\nmode = \"csv\"\ndelay = {delay}\nunits = {{ drive = 1, axis = \"1 nm\" }}\n");
    let scenario = scenario(&format!("{axis}[bus]\n{bus}position_gain = \"10 1/s\"\n{gains}"));
    let analysis = analyse_stability(&scenario, Depth::Boundaries, None, None);
    let Ok(Analysis::Done { master: Some(MasterLoop { largest: Some(largest), .. }), .. }) = analysis else {
        panic!("{analysis:?}")
    };
    let (age, lag) = (0.125, 1e3 / (TAU * velocity));
    [largest * 1e-3 * cycle, f64::from(2 * delay + 1) + (age + lag) / cycle]
}

/// Oracle: K·T = 2·tan(π·T/(4·D)) of docs/fieldbus.md, with the lag of the velocity loop added to the round trip D, which a lag is but for
/// its own frequency response; from one cycle to the next it is exact for whole cycles only.
#[test]
fn the_largest_gain_is_that_of_the_round_trip() {
    for bus in BUSES {
        let [found, round_trip] = largest(bus, "");
        let expected = 2.0 * (PI / (4.0 * round_trip)).tan();
        println!("{bus:?}: {found} {expected}");
        assert!((found / expected - 1.0).abs() < 0.02, "{bus:?}: {found} {expected}");
    }
}

/// Oracle: the table of docs/fieldbus.md, K·D = θ·sin θ with tan θ = θ·T_i/D, for cycles much shorter than D.
#[test]
fn integral_and_derivative_change_it_as_the_table_has_it() {
    let bus = (600.0, 7, 2.0);
    let [_, round_trip] = largest(bus, "");
    let delay = round_trip * 2e-3;
    for (ratio, expected) in [(2.0, 1.07), (4.0, 1.37), (10.0, 1.50), (20.0, 1.54)] {
        let [found, _] = largest(bus, &format!("position_integral_time = \"{} s\"\n", ratio * delay));
        println!("{ratio}: {}", found * round_trip);
        assert!((found * round_trip / expected - 1.0).abs() < 0.03, "{ratio}: {}", found * round_trip);
    }
    let [found, _] = largest(bus, &format!("position_derivative_time = \"{} s\"\n", 0.2 * delay));
    println!("derivative: {}", found * round_trip);
    assert!((found * round_trip / 1.78 - 1.0).abs() < 0.03, "{}", found * round_trip);
}
