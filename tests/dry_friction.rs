//! Dry friction of chains on every engine: sticking to the bit, breaking away, stopping.
use super::{STEP, body, build, effort, in_a_row, motion, state};
use servobench_base::Setpoint;
use servobench_plant::{
    Body, BodyState, Drive, DryFriction, Engine, Friction, Integrator, Link, Mechanics, MechanicsSetup, Model,
};
use servobench_tests::engines;

fn dry(coulomb: f64, breakaway: f64, stribeck_velocity: f64) -> Friction {
    Friction { dry: DryFriction { coulomb, breakaway, stribeck_velocity }, ..Friction::NONE }
}

fn axis(
    engine: &dyn Engine,
    bodies: &[Body],
    stiffness: f64,
    drive: Drive,
    initial: &[BodyState],
) -> Box<dyn Mechanics> {
    let links = vec![Link { stiffness, damping: 0.0 }; bodies.len() - 1];
    let model = Model::Chain(in_a_row(bodies.to_vec(), links));
    build(engine, &MechanicsSetup { model, drive, step: STEP, initial: initial.to_vec() })
}

/// Oracle: the neighbour's mode, as the integrator distorts it.
#[test]
fn a_stuck_body_keeps_its_position_to_the_bit_while_its_neighbour_swings() {
    for engine in engines() {
        let bodies = [Body { friction: dry(50.0, 80.0, 1e-3), ..body(20.0) }, body(10.0)];
        // 1e-4 m of stretch is 60 N: below breakaway.
        let mut axis = axis(engine, &bodies, 6e5, Drive::Effort, &[state(0.3, 0.0), state(0.3 + 1e-4, 0.0)]);
        let omega = (6e5_f64 / 10.0).sqrt();
        let integrator = engine.name().capabilities().integrator.unwrap();
        let shift = integrator.distortion(omega, STEP).unwrap().shift;
        let mut off = 0.0_f64;
        for k in 1..=32_000 {
            axis.advance(&effort(0.0)).unwrap();
            let [motor, load] = axis.bodies() else { panic!("two bodies") };
            assert_eq!(motor.position.to_bits(), 0.3_f64.to_bits(), "{} at tick {k}", engine.name());
            let exact = 0.3 + 1e-4 * (omega * (1.0 + shift) * f64::from(k) * STEP).cos();
            off = off.max((load.position - exact).abs());
        }
        let bound = match integrator {
            // Rounding.
            Integrator::Exact | Integrator::Leapfrog => 1e-13,
            // What MuJoCo holds gives way to its neighbour within the tick by (ω·h)³/6 of that one's motion, 6e-7: for 490 rad of 0.1 mm.
            Integrator::Rk4 => 3e-8,
        };
        assert!(off < bound, "{}: {off:e} m", engine.name());
    }
}

/// Oracle: a body thrown with v0 against Coulomb friction, x = v0·t − f/m·t²/2, stops after v0²·m/(2·f) and stays there. A constant force is
/// exact in each engine, so only rounding is left on the way.
#[test]
fn a_sliding_body_stops_where_coulomb_says() {
    for engine in engines() {
        let mut axis = axis(
            engine,
            &[Body { friction: dry(20.0, 25.0, 0.0), ..body(4.0) }],
            0.0,
            Drive::Effort,
            &[state(0.0, 0.5)],
        );
        let mut off = 0.0_f64;
        for k in 1..=3_200 {
            axis.advance(&effort(0.0)).unwrap();
            let (t, found) = (f64::from(k) * STEP, axis.bodies()[0]);
            if t < 0.1 - STEP {
                off = off.max((found.velocity - (0.5 - 5.0 * t)).abs());
                off = off.max((found.position - (0.5 * t - 2.5 * t * t)).abs());
            }
        }
        println!("{}: {off:e}", engine.name());
        assert!(off < 1e-13, "{}: {off:e}", engine.name());
        let stop = axis.bodies()[0];
        assert_eq!(stop.velocity.to_bits(), 0.0_f64.to_bits());
        // Found to within the tick of the stop: at most a·h² = 2e-8 m.
        assert!((stop.position - 0.5_f64.powi(2) * 4.0 / 40.0).abs() < 2e-8, "{}: {}", engine.name(), stop.position);
        for k in 0..30_000 {
            axis.advance(&effort(24.9 * (f64::from(k) * 0.01).sin())).unwrap();
            assert_eq!(axis.bodies()[0], stop, "{}: below breakaway nothing moves", engine.name());
        }
        axis.advance(&effort(25.1)).unwrap();
        assert!(axis.bodies()[0].velocity > 0.0, "{}: above it does", engine.name());
    }
}

/// Oracle: pulled by a spring whose far end moves at constant velocity, a body with f_s > f_c sticks until c·s = f_s,
/// then swings about c·s = f_c: the first slip ends after half a period, 2·(f_s − f_c)/c (+ v-dependent terms) further.
#[test]
fn stick_slip_has_the_period_of_the_closed_form() {
    let (mass, stiffness, pull) = (4.0, 1e4, 0.01);
    let (coulomb, breakaway) = (10.0, 20.0);
    // Slip: ẍ = ω²·(v·t + (f_s − f_c)/c − x), from rest. x = v·t + Δ·(1 − cos ωt) − v/ω·sin ωt with Δ = (f_s − f_c)/c.
    let omega = f64::sqrt(stiffness / mass);
    let delta = (breakaway - coulomb) / stiffness;
    let velocity = |t: f64| pull * (1.0 - (omega * t).cos()) + delta * omega * (omega * t).sin();
    let (mut low, mut high) = (0.5 / omega, 6.0 / omega);
    while high - low > 1e-12 {
        let middle = f64::midpoint(low, high);
        if velocity(middle) > 0.0 { low = middle } else { high = middle }
    }
    let slip = pull * low + delta * (1.0 - (omega * low).cos()) - pull / omega * (omega * low).sin();
    for engine in engines() {
        let bodies = [body(1.0), Body { friction: dry(coulomb, breakaway, 0.0), ..body(mass) }];
        let mut axis = axis(engine, &bodies, stiffness, Drive::Prescribed, &[]);
        let (mut was_stuck, mut breakaways, mut stops) = (true, vec![], vec![]);
        for k in 0..24_000 {
            let t = f64::from(k) * STEP;
            axis.advance(&motion(Setpoint { x: pull * t, v: pull, ..Setpoint::default() })).unwrap();
            let load = axis.bodies()[1];
            let stuck = load.velocity == 0.0;
            if was_stuck && !stuck {
                breakaways.push((t, load.position));
            }
            if !was_stuck && stuck {
                stops.push((t + STEP, load.position));
            }
            was_stuck = stuck;
        }
        let found = format!("{}: {breakaways:?} {stops:?}", engine.name());
        // First breakaway: c·v·t = f_s. The body stuck at zero until then.
        assert!((breakaways[0].0 - breakaway / (stiffness * pull)).abs() <= STEP, "{found}");
        assert!((stops[0].0 - breakaways[0].0 - low).abs() <= 2.0 * STEP, "slip lasts {low}: {found}");
        // Breaking away up to a tick late adds v·h to Δ, twice that to the slip: 2·0.01·6.25e-5.
        assert!((stops[0].1 - slip).abs() < 1.3e-6, "{found} against {slip}");
        // Then it sticks until the spring is back at f_s: the cycle advances by the slip in slip/v.
        let period = breakaways[2].0 - breakaways[1].0;
        assert!((period - slip / pull).abs() < 2.5e-4, "{period} against {}: {found}", slip / pull);
    }
}

/// Oracle: Stribeck friction sliding down to rest from v0: m·v̇ = −(f_c + (f_s − f_c)·e^(−(v/v_s)²)), by quadrature.
#[test]
fn a_stribeck_curve_is_followed() {
    // x = ∫ m·v/f(v) dv, midpoint rule.
    let n = 200_000;
    let dv = 0.05 / f64::from(n);
    let part = |i: i32| {
        let v = (f64::from(i) + 0.5) * dv;
        2.0 * v / (5.0 + 10.0 * (-(v / 0.02).powi(2)).exp()) * dv
    };
    let exact: f64 = (0..n).map(part).sum();
    for engine in engines() {
        let slider = Body { friction: dry(5.0, 15.0, 0.02), ..body(2.0) };
        let mut axis = axis(engine, &[slider], 0.0, Drive::Effort, &[state(0.0, 0.05)]);
        while axis.bodies()[0].velocity > 0.0 {
            axis.advance(&effort(0.0)).unwrap();
        }
        let found = axis.bodies()[0].position;
        // The friction of a tick is that of its start: first order, v·h = 3e-6 m at most.
        assert!((found - exact).abs() < 1e-6, "{}: {found} against {exact}", engine.name());
    }
}
