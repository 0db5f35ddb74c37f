//! The engine `exact` against closed forms to the rounding. Guarantees of every engine: `tests/contract.rs`.
use servobench_base::{Coordinate, Setpoint, Stateful};
use servobench_plant::{
    Actuation, Body, BodyState, Chain, Drive, DryFriction, Engine, Exact, Friction, Input, LinearMechanics, Link,
    Mechanics, MechanicsError, MechanicsSetup, Model, NotLinear,
};

const H: f64 = 1.0 / 16_000.0;

fn body(name: &'static str, inertia: f64) -> Body {
    Body { name, coordinate: Coordinate::Linear, inertia, transmission: 1.0, friction: Friction::NONE, bias: 0.0 }
}

fn build(chain: Chain, drive: Drive, initial: Vec<BodyState>) -> Box<dyn Mechanics> {
    Exact.build(&MechanicsSetup { model: Model::Chain(chain), drive, step: H, initial }).unwrap()
}

fn effort(effort: f64) -> Input {
    Input { actuation: Actuation::Effort(effort), motor_disturbance: 0.0, load_disturbance: 0.0 }
}

/// Saarakkala/Hinkkanen: J_M = J_L = 0.005 kg·m², K_s = 700 N·m/rad.
fn two_mass(damping: f64) -> Chain {
    Chain::new(vec![body("motor", 5e-3), body("load", 5e-3)], vec![Link { stiffness: 700.0, damping }]).unwrap()
}

/// Oracle: stretch s(t) = s0·e^(−σt)·(cos ω_d t + σ/ω_d·sin ω_d t), σ = d/(2·J_red), J_red = J/2.
#[test]
fn free_ring_down_follows_the_closed_form_for_ten_seconds() {
    let (damping, reduced, stretch) = (0.01, 2.5e-3, 1e-3);
    let sigma = damping / (2.0 * reduced);
    let omega = (700.0_f64 / reduced - sigma * sigma).sqrt();
    let mut axis = build(
        two_mass(damping),
        Drive::Effort,
        vec![BodyState { position: stretch, velocity: 0.0 }, BodyState::default()],
    );
    for k in 1..=160_000 {
        axis.advance(&effort(0.0)).unwrap();
        let t = f64::from(k) * H;
        let exact = stretch * (-sigma * t).exp() * ((omega * t).cos() + sigma / omega * (omega * t).sin());
        let [motor, load] = axis.bodies() else { panic!("two bodies") };
        let found = motor.position - load.position;
        // The transition matrix is right to a few 1e-16; that is a phase error of 1e-15 per tick at most.
        assert!((found - exact).abs() < stretch * 1e-9, "tick {k}: {found} against {exact}");
        assert!((motor.position + load.position - stretch).abs() < 1e-12, "the centre of mass stays");
    }
}

/// Oracle: a rigid body under constant force, viscous friction b: v = F/b·(1 − e^(−bt/m)), x = F/b·(t − m/b·(1 − e^(−bt/m))).
#[test]
fn one_body_with_viscous_friction_is_exact() {
    let (m, b, force) = (95.1089, 203.5034, 120.0);
    let chain = Chain::new(
        vec![Body { friction: Friction { viscous: b, ..Friction::NONE }, bias: 20.0, ..body("motor", m) }],
        vec![],
    )
    .unwrap();
    let mut axis = build(chain, Drive::Effort, vec![]);
    for _ in 0..16_000 {
        axis.advance(&effort(force)).unwrap();
    }
    let decay = (-b / m).exp();
    let (v, x) = (100.0 / b * (1.0 - decay), 100.0 / b * (1.0 - m / b * (1.0 - decay)));
    let found = axis.bodies()[0];
    // 16 000 roundings of numbers of order one.
    assert!((found.velocity - v).abs() < 1e-11 && (found.position - x).abs() < 1e-11, "{found:?} {v} {x}");
}

/// Oracle: rotary motor on a screw without stretch moves like one mass M + J/r² under the force τ/r.
#[test]
fn a_stiff_screw_moves_like_one_mass() {
    let r = 10e-3 / (2.0 * std::f64::consts::PI);
    let motor = Body { coordinate: Coordinate::Rotary, transmission: r, ..body("motor", 2e-4) };
    let chain = Chain::new(vec![motor, body("load", 40.0)], vec![Link { stiffness: 5e8, damping: 5e4 }]).unwrap();
    let mut axis = build(chain, Drive::Effort, vec![]);
    for _ in 0..16_000 {
        axis.advance(&effort(0.5)).unwrap();
    }
    let a = 0.5 / r / (40.0 + 2e-4 / (r * r));
    let [motor, load] = axis.bodies() else { panic!("two bodies") };
    assert!((load.velocity / a - 1.0).abs() < 1e-6, "{} {a}", load.velocity);
    // The spring carries the load's acceleration: stretch = M·a/c.
    assert!((r * motor.position - load.position - 40.0 * a / 5e8).abs() < 1e-12);
}

/// Oracle: undamped load behind a base with constant jerk from rest: with ω² = c/m,
/// x − x_b = −(j/ω²)·(t − sin(ωt)/ω); the base's polynomial is part of the exact transition.
#[test]
fn a_prescribed_base_is_integrated_exactly() {
    let (m, c, j) = (10.0, 6e5, 50.0);
    let omega = f64::sqrt(c / m);
    let chain =
        Chain::new(vec![body("motor", 20.0), body("load", m)], vec![Link { stiffness: c, damping: 0.0 }]).unwrap();
    let mut axis = build(chain, Drive::Prescribed, vec![]);
    let start = Setpoint { j, ..Setpoint::default() };
    for k in 0..1_600 {
        let motion = Actuation::Motion(start.after(f64::from(k) * H));
        axis.advance(&Input { actuation: motion, motor_disturbance: 0.0, load_disturbance: 0.0 }).unwrap();
        let t = f64::from(k + 1) * H;
        let [base, load] = axis.bodies() else { panic!("two bodies") };
        let exact = -j / (omega * omega) * (t - (omega * t).sin() / omega);
        let found = load.position - base.position;
        assert!((found - exact).abs() < 1e-15, "tick {k}: {found} against {exact}");
        assert!((base.position - j * t.powi(3) / 6.0).abs() < 1e-15);
    }
}

/// Oracle: the sum of the inertias, and persistence of a velocity; between the sticking and the sliding of dry friction nothing is linear.
#[test]
fn linear_mechanics_are_those_of_the_bodies() {
    let linear = |friction: Friction| {
        let load = Body { friction, ..body("load", 3.0) };
        let chain = Chain::new(vec![body("motor", 2.0), load], vec![Link { stiffness: 7e4, damping: 30.0 }]).unwrap();
        LinearMechanics::around_rest(build(chain, Drive::Effort, vec![]).as_mut(), H)
    };
    let free = linear(Friction::NONE).unwrap();
    assert!((free.inertia() / 5.0 - 1.0).abs() < 1e-4 && free.is_free(), "{free:?}");
    let braked = linear(Friction { viscous: 0.3, ..Friction::NONE }).unwrap();
    assert!((braked.inertia() / 5.0 - 1.0).abs() < 1e-4 && !braked.is_free(), "{braked:?}");
    let dry = DryFriction { coulomb: 2e3, breakaway: 2e3, stribeck_velocity: 0.0 };
    let stuck = linear(Friction { dry, ..Friction::NONE });
    assert!(matches!(stuck, Err(NotLinear::NotSmooth(_))), "{stuck:?}");
    let broken = LinearMechanics::around_rest(&mut Broken(vec![BodyState::default()], 0.0), H);
    assert!(matches!(broken, Err(NotLinear::NotSmooth(bend)) if bend.is_nan()), "{broken:?}");
}

/// A body with a number beside it that becomes NaN where it is not zero.
#[derive(Stateful)]
struct Broken(#[state(fixed)] Vec<BodyState>, f64);

impl Mechanics for Broken {
    fn bodies(&self) -> &[BodyState] {
        &self.0
    }

    fn advance(&mut self, input: &Input) -> Result<(), MechanicsError> {
        let Actuation::Effort(effort) = input.actuation else { panic!("{input:?}") };
        self.0[0].position += H * self.0[0].velocity;
        self.0[0].velocity += H * effort;
        self.1 = if self.1 == 0.0 { 0.0 } else { f64::NAN };
        Ok(())
    }

    fn state(&mut self) -> Option<&mut dyn Stateful> {
        Some(self)
    }
}
