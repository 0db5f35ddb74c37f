//! An axis reversed by the polarity (607Eh): the same frames, the mirrored motion, under the drive's own loops.
use servobench_base::{PowerCommand, Rate, Setpoint};
use servobench_cia402::units::{AxisUnit, FactorGroup, Ratio};
use servobench_cia402::{Command as Word, Commands, Controlword, Mode};
use servobench_drive::device::{self, Inputs, Measured, Units};
use servobench_drive::{self as drive, Demand, EffortLimits, Sensors, Stage, delay, feedforward, velocity};
use servobench_motion::interpolate;
use std::f64::consts::TAU;

/// Mass (kg), and rated force (N), of which the bus counts thousandths.
const MASS: f64 = 20.0;
const RATED: f64 = 1000.0;

fn loops() -> drive::Params {
    let base_rate = Rate::new(16_000).unwrap();
    let every = |hertz| base_rate.divider(Rate::new(hertz).unwrap()).unwrap();
    drive::Params {
        base_rate,
        transmission: 1.0,
        position_gain: 40.0,
        position_every: every(4_000),
        // 160 1/s.
        velocity: velocity::Params { k_p: 160.0 * MASS, integral_time: None, max_effort: f64::INFINITY },
        velocity_every: every(8_000),
        velocity_filter_time: 0.0,
        feedforward: feedforward::Params {
            velocity: 0.0,
            interpolate: true,
            model: feedforward::Model::Off,
            coulomb: 0.0,
            bias: 0.0,
        },
        blocks: drive::Blocks::default(),
        reference_delay: delay::Params::default(),
        stage: Stage::Direct { gain: 1.0 },
    }
}

/// Readings of the master.
struct Seen {
    position: Vec<i32>,
    torque: Vec<i16>,
    /// Largest following error (m).
    peak: f64,
    /// Final position of the axis, in the encoder's direction (m).
    end: f64,
}

/// 100 mm in 0.5 s in csp, with the velocity in 60B1h and the force in 60B2h: x = A·(τ − sin(2πτ)/2π).
fn moved(polarity: u8, with_force: bool) -> Seen {
    let micrometre = AxisUnit::Metre(Ratio::new(1, 1_000_000).unwrap());
    // 0.1 µm per increment.
    let factors = FactorGroup {
        position_encoder_resolution: [10_000_000, 1],
        feed_constant: [1_000_000, 1],
        polarity,
        ..FactorGroup::default()
    };
    let units = Units::new(&factors, micrometre, RATED).unwrap();
    let p = device::Params { units, interpolation: interpolate::Mode::Cubic, ..device::Params::default() };
    let loops = loops();
    let mut drive = device::State::new(&p).unwrap();
    let mut firmware = drive::State::new(&loops, Setpoint::at_rest(0.0)).unwrap();
    let mut frame = Commands { mode: Mode::CyclicSynchronousPosition.code(), ..Commands::default() };
    let (mut x, mut v, mut force) = (0.0_f64, 0.0_f64, 0.0);
    let tick = 1.0 / 16_000.0;
    let mut demand = Demand::Off;
    let mut seen = Seen { position: vec![], torque: vec![], peak: 0.0, end: 0.0 };
    for k in 0..16_000_u32 {
        let sensors = Sensors { motor_position: x, motor_velocity: Some(v), ..Sensors::default() };
        if k % 4 == 0 {
            let is_frame = k % 16 == 0;
            if is_frame {
                let words = [Word::DisableVoltage, Word::Shutdown, Word::SwitchOn, Word::EnableOperation];
                frame.controlword = Controlword::of(words[usize::try_from(k / 16).unwrap().min(3)]);
                // The set-point of the end of the cycle, 60B1h as used by the cubic, and 60B2h for the same instant.
                let passed = ((f64::from(k) * tick - 0.1) / 0.5).clamp(0.0, 1.0);
                let (sine, cosine) = (TAU * passed).sin_cos();
                let velocity = 0.1 * (1.0 - cosine) / 0.5;
                let acceleration = 0.1 * TAU * sine / 0.25;
                #[expect(clippy::cast_possible_truncation, reason = "whole, and in range")]
                {
                    frame.target_position = (1e6 * 0.1 * (passed - sine / TAU)).round() as i32;
                    frame.velocity_offset = (1e6 * velocity).round() as i32;
                    frame.torque_offset =
                        if with_force { (1000.0 * MASS * acceleration / RATED).round() as i16 } else { 0 };
                }
            }
            let following_error = firmware.following_error(&loops, &sensors);
            let measured = Measured {
                increments: p.units.increments(x),
                velocity: v,
                effort: force,
                following_error,
                ..Measured::default()
            };
            let inputs = Inputs { frame: is_frame.then_some(&frame), measured, fault: None, main_voltage: true };
            demand = device::step(&p, &mut drive, &inputs).demand;
            let actuals = drive.actuals(&p);
            seen.position.push(actuals.position);
            seen.torque.push(actuals.torque);
            seen.peak = seen.peak.max(following_error.abs());
        }
        force = match drive::step(&loops, &mut firmware, &demand, EffortLimits::NONE, &sensors) {
            PowerCommand::Output(force) => force,
            PowerCommand::Off => 0.0,
            PowerCommand::Voltage(_) => panic!("a direct stage"),
        };
        x += tick * (v + 0.5 * tick * force / MASS);
        v += tick * force / MASS;
    }
    seen.end = x;
    seen
}

/// Oracle: mass, loops and rounding are odd, so that a reversed axis makes the mirrored motion bit for bit and the master sees the same.
/// Reversed in position and velocity only, as in the standard, it is pushed in the wrong direction: about twice as far off as without
/// any force in 60B2h.
#[test]
fn an_axis_turned_in_all_three_follows_as_well_as_one_that_is_not() {
    let (straight, turned) = (moved(0, true), moved(0xE0, true));
    assert_eq!(straight.position, turned.position);
    assert_eq!(straight.torque, turned.torque);
    assert!((straight.end - 0.1).abs() < 1e-6 && straight.end.to_bits() == (-turned.end).to_bits());
    assert_eq!(straight.peak.to_bits(), turned.peak.to_bits());
    // m·a of 20 kg and 2.5 m/s² are 50 N at the peak.
    assert!((45..=55).contains(straight.torque.iter().max().unwrap()), "{:?}", straight.torque.iter().max());
    let (bare, against) = (moved(0, false), moved(0xC0, true));
    println!(
        "following error: {:.1e} m, turned {:.1e} m; without 60B2h {:.1e} m, by C0h {:.1e} m",
        straight.peak, turned.peak, bare.peak, against.peak
    );
    assert!(turned.peak < 0.1 * bare.peak, "{} {}", turned.peak, bare.peak);
    assert!((1.8..2.2).contains(&(against.peak / bare.peak)), "{} {}", against.peak, bare.peak);
}
