//! Many revolutions.
use super::{H, body, build, effort, state, viscous};
use servobench_base::Coordinate;
use servobench_plant::{Body, Chain, Drive, Link};
use std::f64::consts::TAU;

/// 3000 rpm (rad/s).
const FAST: f64 = TAU * 50.0;

/// Oracle: θ = ω·t; nothing wraps and nothing is lost to the growth of the angle, 500 revolutions long.
#[test]
fn a_free_rotor_at_3000_rpm_keeps_its_angle() {
    let rotor = Body { coordinate: Coordinate::Rotary, ..body(2e-4) };
    let mut axis = build(&Chain::new(vec![rotor], vec![]).unwrap(), Drive::Effort, H, vec![state(0.0, FAST)]);
    for k in 1..=160_000 {
        axis.advance(&effort(0.0)).unwrap();
        if k % 1_000 == 0 {
            let exact = FAST * f64::from(k) * H;
            let found = axis.bodies()[0].position;
            assert!((found - exact).abs() < 1e-9, "tick {k}: {found} against {exact}");
        }
    }
}

/// Oracle: a motor that turns its screw at constant speed stretches nothing; table and motor stay in step.
#[test]
fn a_screw_keeps_its_stretch_over_many_revolutions() {
    let r = 10e-3 / TAU;
    let motor = Body { coordinate: Coordinate::Rotary, transmission: r, ..body(2e-4) };
    let chain = Chain::new(vec![motor, body(40.0)], vec![Link { stiffness: 1e8, damping: 0.0 }]).unwrap();
    let mut axis = build(&chain, Drive::Effort, H, vec![state(0.0, FAST), state(0.0, r * FAST)]);
    for k in 1..=32_000 {
        axis.advance(&effort(0.0)).unwrap();
        let [motor, table] = axis.bodies() else { panic!("two bodies") };
        // The motor changes its centre every four radians: 157 times in these two seconds.
        let stretch = r * motor.position - table.position;
        assert!(stretch.abs() < 1e-12, "tick {k}: {stretch:e}");
        assert!((table.position - r * FAST * f64::from(k) * H).abs() < 1e-11, "tick {k}: {}", table.position);
    }
}

/// A rotor and a slide of the same number are the same bit for bit: Rapier sees two slides.
#[test]
fn a_rotary_coordinate_is_as_good_as_a_linear_one() {
    let run = |coordinate| {
        let chain = Chain::new(vec![Body { coordinate, friction: viscous(0.3), ..body(0.02) }], vec![]).unwrap();
        let mut axis = build(&chain, Drive::Effort, H, vec![]);
        for k in 0..2_000 {
            axis.advance(&effort(f64::from(k % 37) - 11.0)).unwrap();
        }
        axis.bodies()[0]
    };
    assert_eq!(run(Coordinate::Linear), run(Coordinate::Rotary));
}
