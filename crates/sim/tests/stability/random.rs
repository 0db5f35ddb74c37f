//! Random loops: all combinations of motors, bodies, rates, filters, late sensors and wrong estimates.
use crate::files::scenario;
use servobench_base::{Coordinate, Rate};
use servobench_drive::current::{Gains, Tuning};
use servobench_drive::filter::{self, Filter};
use servobench_drive::measurement::{self, observer};
use servobench_drive::{Stage, delay, derivative, position};
use servobench_plant::{Body, Chain, CurrentSensor, Encoder, EncoderErrors, Friction, Link};
use servobench_scenario::{Actuator, AxisMechanics, Feedback, Scenario};
use servobench_testkit::Random;

const PMSM: &str = r#"
[run]
base_rate = "16 kHz"
duration = "1 ms"
[axis]
motion = "rotary"
[motor]
kind = "pmsm"
pole_pairs = 3
resistance = "3.6 Ohm"
inductance_d = "36 mH"
inductance_q = "51 mH"
flux_linkage = "0.545 V s"
inertia = "0.005 kg m2"
max_current = "1e9 Apk"
[drive]
dc_link = "1e9 V"
[drive.current]
rate = "16 kHz"
bandwidth = "1 kHz"
"#;
const IDEAL: &str = r#"
[run]
base_rate = "16 kHz"
duration = "1 ms"
[axis]
motion = "rotary"
motor_side.inertia = "0.005 kg m2"
[motor]
kind = "ideal-source"
"#;

/// Loops of both; gains and rates are drawn.
const LOOPS: &str = r#"
[drive.velocity]
rate = "16 kHz"
gain = "1 Nm s/rad"
kind = "p"
[drive.position]
rate = "16 kHz"
gain = "1 1/s"
[initial]
load_velocity = "1e-9 rad/s"
"#;

/// A loop without friction, limits and quantisation.
pub(crate) fn random_loop(random: &mut Random) -> Scenario {
    let is_pmsm = random.unit() < 0.6;
    let mut scenario = scenario(&format!("{}{LOOPS}", if is_pmsm { PMSM } else { IDEAL }));
    let base = random.one_of(&[12_000, 16_000, 20_000, 24_000]);
    let current_every = if is_pmsm { random.one_of(&[1, 1, 2]) } else { 1 };
    let velocity_every = current_every * random.one_of(&[1, 2, 4]);
    let position_every = velocity_every * random.one_of(&[1, 2, 3, 4]);
    let rate = |every: u32| Rate::new(base / every).unwrap();
    // A rate must divide the base rate; 24 and its like do all of these.
    let position_every = if base.is_multiple_of(position_every) { position_every } else { velocity_every };
    scenario.base_rate = rate(1);
    scenario.record.rate = rate(1);

    let is_screw = random.unit() < 0.3;
    let transmission = if is_screw { random.logarithmic(1e-3, 5e-3) } else { 1.0 };
    if is_screw {
        scenario.axis.motion = Coordinate::Linear;
    }
    scenario.axis.transmission = transmission;
    let chain = chain(random, base, transmission);
    let bodies = chain.bodies();
    let inertia: f64 =
        bodies[0].inertia + transmission * transmission * bodies[1..].iter().map(|body| body.inertia).sum::<f64>();
    scenario.axis.mechanics = AxisMechanics::Bodies(chain);

    let velocity_period = f64::from(velocity_every) / f64::from(base);
    let omega = random.logarithmic(0.01, 0.3) / velocity_period;
    let (gain, off) = (inertia * omega, random.logarithmic(0.9, 1.1));
    let every = |every: u32| rate(1).divider(rate(every)).unwrap();
    let drive = match &mut scenario.actuator {
        Actuator::Pmsm { drive, .. } => {
            let Stage::Current { params, every: of_current } = &mut drive.params.stage else {
                panic!("a current loop")
            };
            *of_current = every(current_every);
            let tuning = Tuning::Bandwidth(random.logarithmic(0.1, 0.7) * f64::from(base / current_every));
            params.max_current = f64::INFINITY;
            let motor = &mut params.motor;
            motor.resistance *= random.logarithmic(0.6, 1.6);
            let inductance = random.logarithmic(0.7, 1.3);
            // A deviation of the bodies does not reach the d axis, which must not be the first at the circle.
            motor.inductance.d *= 0.7 * inductance;
            motor.inductance.q *= inductance;
            motor.flux_linkage *= random.logarithmic(0.8, 1.25);
            params.gains = Gains::tuned(motor, tuning, None);
            drive.current_tuning = Some(tuning);
            drive
        }
        Actuator::IdealSource { source, drive, .. } => {
            source.gain = random.logarithmic(0.5, 40.0);
            source.limit = f64::INFINITY;
            drive.params.stage = Stage::Direct { gain: source.gain * random.logarithmic(0.7, 1.4) };
            drive
        }
        Actuator::Prescribed | Actuator::Off(_) => panic!("neither is asked for"),
    };
    let params = &mut drive.params;
    params.base_rate = rate(1);
    params.velocity.max_effort = f64::INFINITY;
    params.velocity_every = every(velocity_every);
    params.velocity.k_p = gain;
    params.velocity.integral_time = (random.unit() < 0.6).then(|| random.logarithmic(2.0, 12.0) / omega);
    params.velocity_filter_time =
        if random.unit() < 0.5 { random.logarithmic(0.2, 3.0) * velocity_period } else { 0.0 };
    params.position_every = every(position_every);
    params.position_gain = if random.unit() < 0.1 { 0.0 } else { random.logarithmic(0.03, 0.3) * omega };
    params.reference_delay = delay::Params::default();
    params.transmission = transmission * off;
    if random.unit() < 0.3 {
        drive.position_feedback = Feedback::Load(Encoder::default());
    }
    drive.estimate.transmission = transmission * off;
    blocks(random, &mut drive.params);
    parts(random, &mut drive.params, (inertia, omega));
    if random.unit() < 0.5 {
        late(random, &mut scenario);
    }
    hold_a_current(random, &mut scenario);
    scenario
}

/// A current along the d axis, of some loops with a right commutation.
fn hold_a_current(random: &mut Random, scenario: &mut Scenario) {
    let is_right =
        scenario.actuator.encoder().and_then(|encoder| encoder.errors).is_none_or(|errors| errors.commutation == 0.0);
    let (d, is_held) = (-random.logarithmic(0.1, 3.0), is_right && random.unit() < 0.3);
    let Actuator::Pmsm { drive, .. } = &mut scenario.actuator else { return };
    if let (true, Stage::Current { params, .. }) = (is_held, &mut drive.params.stage) {
        params.d_reference = d;
        if let Some(sensor) = &mut drive.current_sensor {
            sensor.gain_error = [sensor.gain_error[0]; 2];
        }
    }
}

/// Sensors that are late: by some cycles and a share of a tick; current sensors that read too much, and a commutation that is off.
fn late(random: &mut Random, scenario: &mut Scenario) {
    let tick = scenario.base_rate.period();
    let mut encoder = || {
        let latency = if random.unit() < 0.3 { tick } else { random.logarithmic(0.2, 20.0) * tick };
        let errors = EncoderErrors { latency, ..EncoderErrors::default() };
        Encoder { errors: (random.unit() < 0.7).then_some(errors), ..Encoder::default() }
    };
    let (motor, load) = (encoder(), encoder());
    let mut current = CurrentSensor { delay: random.one_of(&[0, 0, 1, 2]), ..CurrentSensor::default() };
    current.shift = if random.unit() < 0.5 { random.unit() * tick } else { 0.0 };
    current.gain_error = [random.logarithmic(0.8, 1.25) - 1.0; 2];
    if random.unit() < 0.3 {
        current.gain_error[1] *= random.logarithmic(0.5, 2.0);
    }
    let commutation = if random.unit() < 0.4 { random.unit() - 0.5 } else { 0.0 };
    let drive = match &mut scenario.actuator {
        Actuator::Pmsm { encoder, drive, motor: pmsm, .. } => {
            *encoder = motor;
            if commutation != 0.0 {
                let errors = encoder.errors.get_or_insert_default();
                errors.commutation = commutation / pmsm.electrical_ratio;
            }
            drive.current_sensor = Some(current);
            drive
        }
        Actuator::IdealSource { encoder, drive, .. } => {
            *encoder = motor;
            drive
        }
        Actuator::Prescribed | Actuator::Off(_) => panic!("neither is asked for"),
    };
    if let Feedback::Load(encoder) = &mut drive.position_feedback {
        *encoder = load;
    }
}

/// Filters in the torque path and a weight on the reference, of some loops.
fn blocks(random: &mut Random, params: &mut servobench_drive::Params) {
    let rate = params.velocity_rate();
    if random.unit() < 0.5 {
        let mut filter = || {
            let frequency = random.logarithmic(0.02, 0.45) * f64::from(rate.hertz());
            let (zero_damping, pole_damping) = (random.logarithmic(0.01, 0.5), random.logarithmic(0.2, 1.3));
            match random.one_of(&[0, 1, 2, 3]) {
                0 => Filter::LowPass { frequency },
                1 => Filter::SecondOrder { frequency, damping: pole_damping },
                2 => Filter::Notch { frequency, zero_damping, pole_damping },
                _ => {
                    let pole_frequency = (frequency * random.logarithmic(0.7, 1.4)).min(0.45 * f64::from(rate.hertz()));
                    Filter::BiQuad { zero_frequency: frequency, zero_damping, pole_frequency, pole_damping }
                }
            }
        };
        let filters: Vec<_> = (0..3).map(|_| filter()).collect();
        let count = random.one_of(&[1, 1, 2, 3]);
        params.blocks.filters = filter::Params::new(&filters[..count], rate).unwrap();
    }
    if params.velocity.integral_time.is_some() && random.unit() < 0.3 {
        params.blocks.reference_weight = random.unit();
    }
}

/// How the velocity is measured, and integral and derivative parts of the outer loops, of some loops with this `inertia` at the motor
/// and this bandwidth (rad/s) of the velocity loop.
fn parts(random: &mut Random, params: &mut servobench_drive::Params, (inertia, omega): (f64, f64)) {
    let period = params.velocity_rate().period();
    let inertia = inertia * random.logarithmic(0.6, 1.6);
    let compensation = if random.unit() < 0.5 { random.unit() } else { 0.0 };
    let observer = observer::Params::new(random.logarithmic(1.0, 8.0) * omega, period, inertia, compensation).unwrap();
    params.blocks.measurement = match random.one_of(&[0, 0, 0, 1, 2, 2]) {
        0 => None,
        1 => Some(measurement::Params::Difference),
        _ => Some(measurement::Params::Observer(observer)),
    };
    let derivative = |time: f64, random: &mut Random| derivative::Params {
        time,
        filter_time: if random.unit() < 0.3 { 0.0 } else { time * random.logarithmic(0.1, 1.0) },
    };
    if random.unit() < 0.25 {
        params.blocks.acceleration = Some(derivative(random.logarithmic(0.03, 0.3) / omega, random));
    }
    if random.unit() < 0.25 && params.position_gain > 0.0 {
        params.blocks.position = Some(position::Params {
            integral_time: (random.unit() < 0.6).then(|| random.logarithmic(3.0, 20.0) / params.position_gain),
            derivative: (random.unit() < 0.6)
                .then(|| derivative(random.logarithmic(0.03, 0.3) / params.position_gain, random)),
        });
    }
}

/// One to four bodies in a row.
fn chain(random: &mut Random, base: u32, transmission: f64) -> Chain {
    let count = random.one_of(&[1, 2, 2, 3, 4]);
    let damped = random.unit() < 0.7;
    let viscous = random.unit() < 0.4;
    let (mut bodies, mut links): (Vec<Body>, Vec<Link>) = (Vec::new(), Vec::new());
    for name in ["motor", "table", "load", "tool"].into_iter().take(count) {
        let is_first = bodies.is_empty();
        let own = if is_first { 1.0 } else { transmission };
        let inertia = random.logarithmic(1e-3, 1e-2) / (own * own);
        if let Some(last) = bodies.last() {
            let before = if bodies.len() == 1 { last.inertia / (transmission * transmission) } else { last.inertia };
            let reduced = before * inertia / (before + inertia);
            let omega = std::f64::consts::TAU * random.logarithmic(15.0, 0.3 * f64::from(base));
            let damping = if damped { 2.0 * random.logarithmic(1e-3, 3e-2) * reduced * omega } else { 0.0 };
            links.push(Link { stiffness: reduced * omega * omega, damping });
        }
        let viscous = if viscous { random.logarithmic(0.1, 3.0) * inertia } else { 0.0 };
        bodies.push(Body {
            name,
            coordinate: Coordinate::Rotary,
            inertia,
            transmission: if is_first { transmission } else { 1.0 },
            friction: Friction { viscous, ..Friction::NONE },
            bias: 0.0,
        });
    }
    Chain::new(bodies, links).unwrap()
}
