//! Dry friction: sticking bit for bit, breaking away, stopping.
use super::{H, body, build, effort, state};
use servobench_plant::{Body, Chain, Drive, DryFriction, Friction, Link};

#[test]
fn a_stuck_body_keeps_its_position_to_the_bit_while_its_neighbour_swings() {
    let dry = DryFriction { coulomb: 50.0, breakaway: 80.0, stribeck_velocity: 1e-3 };
    let chain = Chain::new(
        vec![Body { friction: Friction { dry, ..Friction::NONE }, ..body(20.0) }, body(10.0)],
        vec![Link { stiffness: 6e5, damping: 0.0 }],
    )
    .unwrap();
    // 1e-4 m of stretch is 60 N: below breakaway.
    let mut axis = build(&chain, Drive::Effort, H, vec![state(0.3, 0.0), state(0.3 + 1e-4, 0.0)]);
    let omega = (6e5_f64 / 10.0).sqrt();
    for k in 1..=32_000 {
        axis.advance(&effort(0.0)).unwrap();
        let [motor, load] = axis.bodies() else { panic!("two bodies") };
        assert_eq!(motor.position.to_bits(), 0.3_f64.to_bits(), "tick {k}");
        let t = f64::from(k) * H;
        // The phase runs ahead by (ω·h)²/24·ω·t, half a percent of a radian after two seconds.
        let exact = 0.3 + 1e-4 * (omega * (1.0 + (omega * H).powi(2) / 24.0) * t).cos();
        assert!((load.position - exact).abs() < 1e-9, "tick {k}: {} {exact}", load.position);
    }
}

/// Oracle: a body thrown with v0 against Coulomb friction stops after v0²·m/(2·f) and stays there.
#[test]
fn a_sliding_body_stops_where_coulomb_says() {
    let dry = DryFriction { coulomb: 20.0, breakaway: 25.0, stribeck_velocity: 0.0 };
    let chain = Chain::new(vec![Body { friction: Friction { dry, ..Friction::NONE }, ..body(4.0) }], vec![]).unwrap();
    let mut axis = build(&chain, Drive::Effort, H, vec![state(0.0, 0.5)]);
    for _ in 0..3_200 {
        axis.advance(&effort(0.0)).unwrap();
    }
    let stop = axis.bodies()[0];
    assert_eq!(stop.velocity.to_bits(), 0.0_f64.to_bits());
    // Found to within the tick of the stop: at most a·h² = 2e-8 m.
    assert!((stop.position - 0.5_f64.powi(2) * 4.0 / 40.0).abs() < 2e-8, "{}", stop.position);
    for _ in 0..1_000 {
        axis.advance(&effort(24.9)).unwrap();
        assert_eq!(axis.bodies()[0], stop, "below breakaway nothing moves");
    }
    axis.advance(&effort(25.1)).unwrap();
    assert!(axis.bodies()[0].velocity > 0.0, "above it does");
}

/// Oracle: pulled by a spring whose far end moves at constant velocity, a body with f_s > f_c sticks until c·s = f_s,
/// then swings about c·s = f_c: the first slip ends after half a period, 2·(f_s − f_c)/c (+ v-dependent terms) further.
#[test]
fn stick_slip_has_the_period_of_the_closed_form() {
    let (mass, stiffness, pull) = (4.0, 1e4, 0.01);
    let dry = DryFriction { coulomb: 10.0, breakaway: 20.0, stribeck_velocity: 0.0 };
    let chain = Chain::new(
        vec![body(1.0), Body { friction: Friction { dry, ..Friction::NONE }, ..body(mass) }],
        vec![Link { stiffness, damping: 0.0 }],
    )
    .unwrap();
    let mut axis = build(&chain, Drive::Prescribed, H, vec![]);
    let (mut was_stuck, mut breakaways, mut stops) = (true, vec![], vec![]);
    for k in 0..24_000 {
        let t = f64::from(k) * H;
        let base = servobench_base::Setpoint { x: pull * t, v: pull, ..servobench_base::Setpoint::default() };
        axis.advance(&super::motion(base)).unwrap();
        let stuck = axis.bodies()[1].velocity == 0.0;
        if was_stuck && !stuck {
            breakaways.push((t, axis.bodies()[1].position));
        }
        if !was_stuck && stuck {
            stops.push((t + H, axis.bodies()[1].position));
        }
        was_stuck = stuck;
    }
    // First breakaway: c·v·t = f_s. The body stuck at zero until then.
    assert!((breakaways[0].0 - dry.breakaway / (stiffness * pull)).abs() <= H, "{breakaways:?}");
    // Slip: ẍ = ω²·(v·t + (f_s − f_c)/c − x), from rest. x = v·t + Δ·(1 − cos ωt) − v/ω·sin ωt with Δ = (f_s − f_c)/c.
    let omega = f64::sqrt(stiffness / mass);
    let delta = (dry.breakaway - dry.coulomb) / stiffness;
    let velocity = |t: f64| pull * (1.0 - (omega * t).cos()) + delta * omega * (omega * t).sin();
    let (mut low, mut high) = (0.5 / omega, 6.0 / omega);
    while high - low > 1e-12 {
        let middle = f64::midpoint(low, high);
        if velocity(middle) > 0.0 { low = middle } else { high = middle }
    }
    let slip = pull * low + delta * (1.0 - (omega * low).cos()) - pull / omega * (omega * low).sin();
    assert!((stops[0].0 - breakaways[0].0 - low).abs() <= 2.0 * H, "slip lasts {low}: {breakaways:?} {stops:?}");
    // Breaking away up to a tick late adds v·h to Δ, twice that to the slip: 2·0.01·6.25e-5.
    assert!((stops[0].1 - slip).abs() < 1.3e-6, "{} against {slip}", stops[0].1);
    // Then it sticks until the spring is back at f_s: the cycle advances by the slip in slip/v.
    let period = breakaways[2].0 - breakaways[1].0;
    assert!((period - slip / pull).abs() < 2.5e-4, "{period} against {}", slip / pull);
}

/// Oracle: Stribeck friction sliding down to rest from v0: m·v̇ = −(f_c + (f_s − f_c)·e^(−(v/v_s)²)), by quadrature.
#[test]
fn a_stribeck_curve_is_followed() {
    let dry = DryFriction { coulomb: 5.0, breakaway: 15.0, stribeck_velocity: 0.02 };
    let chain = Chain::new(vec![Body { friction: Friction { dry, ..Friction::NONE }, ..body(2.0) }], vec![]).unwrap();
    let mut axis = build(&chain, Drive::Effort, H, vec![state(0.0, 0.05)]);
    while axis.bodies()[0].velocity > 0.0 {
        axis.advance(&effort(0.0)).unwrap();
    }
    // x = ∫ m·v/f(v) dv, midpoint rule.
    let n = 200_000;
    let dv = 0.05 / f64::from(n);
    let exact: f64 = (0..n)
        .map(|i| {
            let v = (f64::from(i) + 0.5) * dv;
            2.0 * v / (5.0 + 10.0 * (-(v / 0.02).powi(2)).exp()) * dv
        })
        .sum();
    let found = axis.bodies()[0].position;
    // The friction of a tick is that of its start: first order, v·h = 3e-6 m at most.
    assert!((found - exact).abs() < 1e-6, "{found} against {exact}");
}
