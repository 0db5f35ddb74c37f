//! Where the power of a motor goes, tick by tick, and the voltage that its inverter gives.
use crate::rig::{run, values};
use servobench_metrics::{Name, Question, measure};
use std::f64::consts::PI;

/// A small motor of 24 V on two masses, whose current and voltage saturate; on a DC link of `link` that the drive believes to
/// have 48 V.
fn small(base: u32, link: u32, acceleration: u32) -> String {
    format!(
        r#"
[run]
base_rate = "{base} kHz"
duration = "0.4 s"
[axis]
motion = "rotary"
motor_side = {{ inertia = "1e-5 kg m2", viscous = "1e-5 Nm s/rad" }}
load = {{ inertia = "2e-5 kg m2", stiffness = "60 Nm/rad", damping = "0.002 Nm s/rad" }}
[motor]
kind = "pmsm"
pole_pairs = 4
resistance = "0.36 Ohm"
inductance_d = "0.2 mH"
inductance_q = "0.26 mH"
flux_linkage = "6.395 mV s"
inertia = "7.06e-6 kg m2"
max_current = "7.1 Apk"
[drive]
dc_link = "{link} V"
estimate = {{ dc_link = "48 V" }}
current = {{ rate = "12 kHz", bandwidth = "700 Hz" }}
velocity = {{ rate = "6 kHz", bandwidth = "60 Hz" }}
position = {{ rate = "3 kHz", bandwidth = "12 Hz" }}
feedforward = {{ velocity = true, effort = "rigid" }}
[setpoint]
order = 2
velocity = "3000 rpm"
acceleration = "{acceleration} rad/s2"
[[program]]
move_to = "4 rev"
"#
    )
}

fn largest(all: &[f64]) -> f64 {
    all.iter().fold(0.0, |most: f64, one| most.max(one.abs()))
}

/// Oracle: |u| ≤ U_dc/√3 of the inverter's own DC link; the drive asks for more.
#[test]
fn the_voltage_is_the_inverters_and_the_reference_the_drives() {
    let recording = run(&small(12, 16, 9_000));
    let most = largest(values(&recording, "voltage.magnitude"));
    let limit = 16.0 / 3.0_f64.sqrt();
    // Cut to the circle and turned into the rotor's frame.
    assert!((most / limit - 1.0).abs() < 1e-14, "{most} V on a link that gives {limit} V");
    let [d, q] = ["voltage.d_reference", "voltage.q_reference"].map(|name| values(&recording, name));
    let asked = d.iter().zip(q).fold(0.0, |most: f64, (d, q)| most.max(d.hypot(*q)));
    assert!(asked > 1.5 * limit, "{asked} V");
}

/// Oracle: the first law, at every tick.
#[test]
fn electrical_power_is_loss_and_field_and_air_gap() {
    for link in [16, 36] {
        let recording = run(&small(24, link, 9_000));
        let [electrical, copper, stored, air_gap] =
            ["electrical", "copper", "stored", "air_gap"].map(|name| values(&recording, &format!("power.{name}")));
        assert!(largest(electrical) > 20.0 && largest(stored) > 1.0, "something happens");
        for k in 0..recording.len() {
            let terms = [electrical[k], copper[k], stored[k], air_gap[k]];
            let difference = (terms[0] - terms[1] - terms[2] - terms[3]).abs();
            assert!(difference <= 1e-12 * largest(&terms), "row {k}: {terms:?} leave {difference} W");
        }
    }
}

/// Oracle: a constant resistance loses 3·R·I² of an effective phase current I, the heat of the ripple included; and what is recorded beside
/// the current changes nothing. At the ticks alone the peak is a fifth less at half of the carrier.
#[test]
fn the_effective_current_is_that_of_the_heat() {
    for (base, carrier) in [(12, 12), (24, 12), (12, 6)] {
        let inverter = format!(
            "[drive.inverter]\nmodulation = \"switching\"\ncarrier = \"{carrier} kHz\"\ndead_time = \"1 us\"\n"
        );
        let text = small(base, 48, 2_000).replace("[setpoint]", &format!("{inverter}[setpoint]"));
        let metrics = |text: &str| measure(&run(text), &Question::default()).run;
        let all = metrics(&text);
        let value = |name| all.value(name).unwrap_or_else(|| panic!("{name}"));
        let of_the_heat = (value(Name::CopperLoss) / (3.0 * 0.36 * 0.4)).sqrt();
        let [found, peak] = [Name::CurrentRms, Name::CurrentPeak].map(value);
        println!("{base} kHz, {carrier} kHz: {found} A, {of_the_heat} A by the heat, peak {peak} A");
        assert!((found / of_the_heat - 1.0).abs() < 1e-9, "{found} {of_the_heat}");
        let few = metrics(&format!("{text}[record]\nchannels = [\"current.d\", \"current.q\"]\n"));
        for name in [Name::CurrentRms, Name::CurrentPeak] {
            assert_eq!(few.value(name).map(f64::to_bits), Some(value(name).to_bits()), "{name}");
        }
    }
}

/// Oracle: effort times travel, from the recorded channels of the row before and of this one.
#[test]
fn shaft_power_is_effort_times_travel() {
    let recording = run(&small(12, 36, 9_000));
    let [shaft, air_gap, residual, effort, position] =
        ["power.shaft", "power.air_gap", "power.residual", "effort.motor", "motor.position"]
            .map(|name| values(&recording, name));
    assert_eq!(shaft[0].to_bits(), 0.0_f64.to_bits(), "no tick has ended yet");
    for k in 1..recording.len() {
        let expected = effort[k - 1] * (position[k] - position[k - 1]) * 12_000.0;
        assert!((shaft[k] - expected).abs() <= 1e-12 * expected.abs(), "row {k}: {} {expected}", shaft[k]);
        assert_eq!(residual[k].to_bits(), (air_gap[k] - shaft[k]).to_bits());
    }
}

/// The feed axis with everything that motor and inverter may have, on a link that its brake fills.
fn everything_on() -> String {
    let (axis, _) = include_str!("../../../../scenarios/feed-axis-move.toml").split_once("[limits]").unwrap();
    axis.to_owned()
        + r#"
[[motor.cogging]]
per_rev = 36
amplitude = "25 mNm"
[[motor.flux_harmonic]]
order = 6
d = 0.01
q = -0.02
[motor.saturation]
current = "18.8 Apk"
share = 0.891
[motor.iron_loss]
speed = "3000 rpm"
hysteresis = "6 W"
eddy = "10 W"
[motor.thermal]
ambient = "30 degC"
to_housing = "0.6 K/W"
to_ambient = "1.1 K/W"
winding_capacity = "6 J/K"
housing_capacity = "90 J/K"
[drive.inverter]
modulation = "switching"
carrier = "16 kHz"
dead_time = "2 us"
device_drop = "1 V"
on_resistance = "30 mOhm"
[drive.link]
capacitance = "470 uF"
source_resistance = "0.5 Ohm"
mains_frequency = "50 Hz"
brake = { resistance = "47 Ohm", on = "325 V", off = "323 V" }
"#
}

/// Oracle: the first law over a whole run, from the mains to the shaft, and at every tick.
#[test]
fn the_energy_of_a_run_closes_with_every_effect() {
    let recording = run(&everything_on());
    let names = ["mains", "brake", "inverter", "electrical", "copper", "iron", "stored", "air_gap", "shaft"];
    let all = names.map(|name| values(&recording, &format!("power.{name}")));
    let h = 1.0 / 16e3;
    let [mains, brake, inverter, _, copper, iron, stored, air_gap, shaft] =
        all.map(|power| power.iter().sum::<f64>() * h);
    let throughput = all[7].iter().map(|power| power.abs()).sum::<f64>() * h;
    let link = values(&recording, "voltage.dc_link");
    // The first row has no tick behind it, and the voltage of the mains.
    let field = 0.5 * 470e-6 * (link[link.len() - 1].powi(2) - link[0].powi(2));
    for part in [mains, brake, inverter, copper, iron, shaft] {
        assert!(part > 0.1, "everything happens: {mains} {brake} {inverter} {copper} {iron} {stored} {shaft} J");
    }
    let left = mains - brake - inverter - copper - iron - stored - air_gap - field;
    println!("{left:e} J of {throughput} J left at the motor, {:e} J to the shaft", air_gap - shaft);
    assert!(left.abs() < 1e-9 * throughput, "{left} J");
    // What the coupling adds is of second order in the tick.
    assert!((left + air_gap - shaft).abs() < 1e-6 * throughput, "{} J of {throughput} J", air_gap - shaft);
    let [_, _, _, electrical, copper, iron, stored, air_gap, _] = all;
    let current = values(&recording, "current.q");
    for k in 0..recording.len() {
        let [electrical, copper, iron, stored, air_gap] = [electrical, copper, iron, stored, air_gap].map(|all| all[k]);
        let largest = [copper, iron, stored, air_gap].iter().fold(electrical.abs(), |most, one| most.max(one.abs()));
        // A motor that saturates has its energy by its flux linkage, which is not zero at no current: a rounding of i·ψ/h, from edge to
        // edge, where the current ripples by up to a quarter of an ampere.
        let rounding = 4.0 * f64::EPSILON * 0.0606 / h * (0.25 + current[k].abs());
        let left = electrical - copper - iron - stored - air_gap;
        assert!(left.abs() <= 1e-12 * largest + rounding, "row {k}: {left} W of {largest} W");
    }
}

/// Motor and mechanics meet at different speeds, the one extrapolated, the other what it becomes: while nothing saturates,
/// half the tick makes a quarter of it.
#[test]
fn what_the_coupling_adds_is_of_second_order() {
    let residual = |base: u32| {
        let recording = run(&small(base, 48, 1_500));
        let residual = values(&recording, "power.residual");
        (residual.iter().map(|power| power * power).sum::<f64>() / residual.len() as f64).sqrt()
    };
    let [coarse, fine, finest] = [48, 96, 192].map(residual);
    for order in [(coarse / fine).log2(), (fine / finest).log2()] {
        assert!((order - 2.0).abs() < 0.3, "observed order {order}: {coarse} {fine} {finest} W");
    }
}

/// The axis of the published point speeds up; its position loop has half the rate of its velocity loop. Held from cycle to
/// cycle the velocity that is fed forward is a staircase, and so is the torque.
#[test]
fn a_velocity_fed_forward_between_cycles_of_the_position_loop_spares_the_motor_a_staircase() {
    let text = include_str!("../../../../scenarios/msl-operating-point.toml");
    let switch = "[drive.feedforward]\n";
    assert!(text.contains(switch));
    let [goes_on, held] = [true, false].map(|interpolate| {
        let recording = run(&text.replace(switch, &format!("{switch}interpolate = {interpolate}\n")));
        // Constant acceleration, before the load comes.
        let torque = &values(&recording, "effort.motor")[recording.index_at(0.03)..recording.index_at(0.09)];
        torque.windows(3).map(|three| (three[2] - 2.0 * three[1] + three[0]).abs()).fold(0.0, f64::max)
    });
    assert!(held > 5.0 * goes_on, "second differences of {held} and {goes_on} N·m");
}

/// Oracle: published (Modelica Standard Library, `SM_PermanentMagnet`): 100 V, 100 A and 1500 rpm give 181.4 N·m, the rotor
/// angle 20.75° and the power factor 0.98; recomputed from its parameters 181.44 N·m, 20.756° and 0.98004.
#[test]
fn the_published_operating_point_is_met() {
    let recording = run(include_str!("../../../../scenarios/msl-operating-point.toml"));
    let point = recording.index_at(2.2)..recording.index_at(2.8);
    let mean = |name: &str| {
        let all = &values(&recording, name)[point.clone()];
        all.iter().sum::<f64>() / all.len() as f64
    };
    let near = |what: &str, found: f64, published: f64| {
        assert!((found / published - 1.0).abs() < 2e-3, "{what}: {found} for {published}");
    };
    let (d, q) = (mean("voltage.d"), mean("voltage.q"));
    let voltage = d.hypot(q) / 2.0_f64.sqrt();
    let current = mean("current.d").hypot(mean("current.q")) / 2.0_f64.sqrt();
    near("voltage (Vrms)", voltage, 100.0);
    near("current (Arms)", current, 100.0);
    near("torque (N m)", mean("effort.motor"), 181.4);
    near("speed (rad/s)", mean("motor.velocity"), 50.0 * PI);
    near("rotor angle (°)", (-d).atan2(q).to_degrees(), 20.75);
    near("power factor", mean("power.electrical") / (3.0 * voltage * current), 0.98);
}
