//! A second opinion on the motor: `MuJoCo`'s own actuator `dcmotor` beside servobench's synchronous motor.
//!
//! A synchronous motor whose d-axis current is held at zero is a DC motor with K = p·ψ, R/1.5, L/1.5 and the current 1.5·i_q: torque 3/2·p·ψ·i_q,
//! back-EMF ω_e·ψ, copper loss 3/2·R·i_q². `MuJoCo` integrates its current exactly for a held voltage, its temperature by Euler's rule,
//! and takes cogging at the position where a step begins. Its equations: technical note on the DC motor in `MuJoCo`'s documentation.
use mujoco_rs::prelude::{MjData, MjModel};
use servobench_base::{Coordinate, Dq, PowerCommand};
use servobench_engine_mujoco::Mujoco;
use servobench_plant::pmsm::{COPPER, Cogging, Effects, Params, Temperature, Temperatures, ThermalNetwork};
use servobench_plant::{
    Actuation, Body, BodyState, Chain, Drive, Engine as _, Friction, Input, MechanicsSetup, Model, PowerStage,
};

/// WITTENSTEIN premo 1F, but for one pole pair: a tick then turns the stator's voltage by little in the rotor's frame.
const MOTOR: Params = Params {
    electrical_ratio: 1.0,
    resistance: 1.615,
    inductance: Dq { d: 3.485e-3, q: 3.485e-3 },
    flux_linkage: 0.2424,
};

/// Its shaft in `MuJoCo` with the inertia `inertia` (kg·m²), in steps of `h` (s); `more` are attributes of the motor.
fn dc_motor(inertia: f64, h: f64, start: BodyState, more: &str) -> MjData<Box<MjModel>> {
    let k = MOTOR.electrical_ratio * MOTOR.flux_linkage;
    let xml = format!(
        r#"<mujoco>
  <option timestep="{h:e}" integrator="implicitfast" gravity="0 0 0"><flag contact="disable"/></option>
  <worldbody><body>
    <joint name="shaft" type="hinge" axis="0 0 1"/>
    <inertial pos="0 0 0" mass="1" diaginertia="{inertia:e} {inertia:e} {inertia:e}"/>
  </body></worldbody>
  <actuator><dcmotor joint="shaft" motorconst="{k} {k}" resistance="{}" {more}/></actuator>
</mujoco>"#,
        MOTOR.resistance / 1.5
    );
    let mut data = MjData::new(Box::new(MjModel::from_xml_string(&xml).unwrap()));
    data.qpos_mut()[0] = start.position;
    data.qvel_mut()[0] = start.velocity;
    data
}

fn stage(effects: &Effects, speed: f64, h: f64) -> PowerStage {
    PowerStage::pmsm(MOTOR, 320.0, speed, h).and_then(|stage| stage.with_effects(effects, h)).unwrap()
}

/// Current after steps of the voltage, at rest and in motion. At rest both are exact; in motion the d-axis current is held at zero from
/// tick to tick, which leaves out what it grows to within one: ω_e·h/2 of what the q axis changes.
#[test]
fn a_current_in_an_inductance() {
    let h = 1.0 / 16e3;
    let inductance = format!(r#"inductance="{} 0""#, MOTOR.inductance.q / 1.5);
    for (speed, allowed) in [(0.0, 1e-9), (17.3, 1e-3)] {
        let start = BodyState { position: 0.31, velocity: speed };
        // So heavy that its speed stays.
        let mut theirs = dc_motor(1e9, h, start, &inductance);
        let mut ours = stage(&Effects::default(), speed, h);
        let mut most: f64 = 0.0;
        for k in 0..400_u32 {
            let u = if k < 160 { 23.0 } else { -11.0 };
            theirs.ctrl_mut()[0] = u;
            theirs.step();
            let motor = BodyState { position: start.position + speed * h * f64::from(k), velocity: speed };
            ours.measured_current(motor);
            let u_d = -speed * MOTOR.inductance.q * ours.current().q;
            let middle = ours.rotation().rotation().ahead(speed * h / 2.0);
            ours.advance(PowerCommand::Voltage(Dq { d: u_d, q: u }.to_alpha_beta(middle)), motor, h);
            most = most.max((1.5 * ours.current().q - theirs.act()[0]).abs());
        }
        // Of the current that the first step goes to.
        let scale = 23.0 * 1.5 / MOTOR.resistance;
        println!("{speed} rad/s: {:e} of {scale} A", most / scale);
        assert!(most < allowed * scale, "{speed} rad/s: {most} A of {scale} A");
    }
}

/// Torque of the cogging over the angle, and a rotor that swings in its teeth with no current. Ours is the mean over a tick, of second
/// order in the coupling with the mechanics.
#[test]
fn a_rotor_that_cogs() {
    let (h, amplitude, order, phase) = (1.0 / 16e3, 0.031, 12.0, 0.4);
    let attributes = format!(r#"cogging="{amplitude} {order} {phase}""#);
    let effects = Effects { cogging: vec![Cogging { ratio: order, amplitude, phase }], ..Effects::default() };
    for k in 0..97 {
        let angle = 0.0713 * f64::from(k) - 2.9;
        let at = BodyState { position: angle, velocity: 0.0 };
        let mut theirs = dc_motor(1.0, h, at, &attributes);
        theirs.forward();
        let torque = stage(&effects, 0.0, h).advance(PowerCommand::Off, at, h);
        assert!((torque - theirs.actuator_force()[0]).abs() < 1e-13, "{angle}: {torque}");
    }

    // About its stable angle: 12·φ + 0.4 = π. The windings are open; those of `MuJoCo` have so much resistance that it is the same.
    let (inertia, stable) = (3e-4, (std::f64::consts::PI - phase) / order);
    let start = BodyState { position: stable + 0.07, velocity: 0.0 };
    let chain = Chain::new(
        vec![Body {
            name: "motor",
            coordinate: Coordinate::Rotary,
            inertia,
            transmission: 1.0,
            friction: Friction::NONE,
            bias: 0.0,
        }],
        vec![],
    )
    .unwrap();
    let setup = MechanicsSetup { model: Model::Chain(chain), drive: Drive::Effort, step: h, initial: vec![start] };
    let mut mechanics = Mujoco.build(&setup).unwrap();
    let mut ours = stage(&effects, 0.0, h);
    let mut theirs = dc_motor(inertia, h / 16.0, start, &format!(r#"{attributes} inductance="1e9 0""#));
    let mut most: f64 = 0.0;
    for _ in 0..8_000 {
        let motor = mechanics.bodies()[0];
        let effort = ours.advance(PowerCommand::Off, motor, h);
        let input = Input { actuation: Actuation::Effort(effort), motor_disturbance: 0.0, load_disturbance: 0.0 };
        mechanics.advance(&input).unwrap();
        (0..16).for_each(|_| theirs.step());
        most = most.max((mechanics.bodies()[0].position - theirs.qpos()[0]).abs());
    }
    println!("a rotor that swings by 0.07 rad for half a second: {:e} of it", most / 0.07);
    assert!(most < 1e-3 * 0.07, "{most}");
}

/// A winding on a constant voltage that warms up, and so takes less current. One body: our housing is on what surrounds it. `MuJoCo` has
/// no inductance here, ours takes a millisecond; its Euler steps leave out half a step over the time constant of 36 s.
#[test]
fn a_winding_that_warms_up() {
    let (h, to_ambient, capacity) = (2e-3, 0.6, 60.0);
    let thermal = format!(r#"thermal="{to_ambient} {capacity} 0 {COPPER} 20 31""#);
    let mut theirs = dc_motor(1e9, h, BodyState::default(), &thermal);
    let effects = Effects {
        temperature: Some(Temperature {
            reference: 20.0,
            resistance_coefficient: COPPER,
            flux_coefficient: 0.0,
            start: Temperatures { winding: 31.0, housing: 31.0 },
            network: Some(ThermalNetwork {
                ambient: 31.0,
                to_housing: to_ambient,
                to_ambient: 1e-9,
                winding_capacity: capacity,
                housing_capacity: 1e6,
                winding_limit: 155.0,
            }),
        }),
        ..Effects::default()
    };
    let quick = Params { inductance: Dq { d: 2e-3, q: 2e-3 }, ..MOTOR };
    let mut ours = PowerStage::pmsm(quick, 320.0, 0.0, h).and_then(|stage| stage.with_effects(&effects, h)).unwrap();
    let (mut most, mut hottest): (f64, f64) = (0.0, 0.0);
    for k in 0..60_000 {
        theirs.ctrl_mut()[0] = 13.0;
        theirs.step();
        ours.measured_current(BodyState::default());
        let voltage = Dq { d: 0.0, q: 13.0 }.to_alpha_beta(ours.rotation().rotation());
        ours.advance(PowerCommand::Voltage(voltage), BodyState::default(), h);
        let (found, expected) = (ours.temperatures().winding - 31.0, theirs.act()[0]);
        (most, hottest) = (most.max((found - expected).abs()), hottest.max(expected));
        if k == 59_999 {
            let r = MOTOR.resistance * (1.0 + COPPER * (ours.temperatures().winding - 20.0));
            let current = ours.current().q;
            assert!((current - 13.0 / r).abs() < 1e-6 * current, "{current} A");
        }
    }
    println!("after 120 s: {hottest} K, at most {:e} of it apart", most / hottest);
    assert!(hottest > 50.0 && most < 1e-3 * hottest, "{most} K of {hottest} K");
}
