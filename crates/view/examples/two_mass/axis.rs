//! A two-mass axis in a few lines, to have something to look at: the plant of Lambrechts' motor-load system behind a
//! P/PI cascade with rigid-body feedforward. The tool's own closed loop is in other crates; nothing here is a reference.
use servobench_base::Rate;
use servobench_trace::{About, ChannelSpec, Ending, Event, Move, Recorder, Recording};

/// Rate of control and recording (Hz).
const HERTZ: u32 = 16_000;
/// Motor and load mass (kg), stiffness (N/m), damping (N·s/m), viscous friction of both (N·s/m).
const PLANT: [f64; 5] = [20.0, 10.0, 1.5e5, 60.0, 10.0];
/// Steps of integration per period of control.
const STEPS: u32 = 8;
/// Force per current (N/A).
const FORCE_CONSTANT: f64 = 44.0;

/// A simulated case.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Case {
    /// Name of the scenario.
    pub(crate) name: &'static str,
    /// Order of the profile, 3 or 4.
    pub(crate) order: u8,
    /// True if positions are angles.
    pub(crate) rotary: bool,
    /// Length of the run (s).
    pub(crate) duration: f64,
}

/// Position and four derivatives at each instant, and the duration: a step of 1, smoothed by one moving average per box
/// of length x/v, v/a, a/j and for order 4 also j/s. Each derivative turns one average into a difference quotient.
fn profile(order: u8, instants: usize) -> (Vec<[f64; 5]>, f64) {
    let boxes = &[1.0, 0.2, 0.1, 0.05][..usize::from(order)];
    let derivative = |count: usize| {
        let mut signal = vec![1.0; instants];
        for (index, length) in boxes.iter().enumerate() {
            #[expect(
                clippy::cast_possible_truncation,
                clippy::cast_sign_loss,
                reason = "a small positive whole number"
            )]
            let samples = (length * f64::from(HERTZ)).round() as usize;
            let before = signal.clone();
            let mut sum = 0.0;
            for k in 0..instants {
                let old = k.checked_sub(samples).map_or(0.0, |old| before[old]);
                sum += before[k] - old;
                signal[k] = if index < count { (before[k] - old) / length } else { sum / samples as f64 };
            }
        }
        // Beyond the order, the derivative is a row of impulses: not shown.
        if count > boxes.len() { vec![0.0; instants] } else { signal }
    };
    let derivatives: [Vec<f64>; 5] = std::array::from_fn(derivative);
    let rows = (0..instants).map(|k| std::array::from_fn(|count| derivatives[count][k]));
    (rows.collect(), boxes.iter().sum())
}

/// Simulates `case`.
#[must_use]
pub(crate) fn run(case: Case) -> Recording {
    let (u, effort) = if case.rotary { ("rad", "N m") } else { ("m", "N") };
    let rate = Rate::new(HERTZ).expect("not zero");
    let channels = [
        ("setpoint.position", u.to_owned(), "set-point"),
        ("setpoint.velocity", format!("{u}/s"), "set-point"),
        ("setpoint.acceleration", format!("{u}/s²"), "set-point"),
        ("setpoint.jerk", format!("{u}/s³"), "set-point"),
        ("setpoint.snap", format!("{u}/s⁴"), "set-point"),
        ("reference.position", u.to_owned(), "position loop"),
        ("motor.position", u.to_owned(), "mechanics"),
        ("motor.velocity", format!("{u}/s"), "mechanics"),
        ("load.position", u.to_owned(), "mechanics"),
        ("load.velocity", format!("{u}/s"), "mechanics"),
        ("following_error.motor", u.to_owned(), "position loop"),
        ("following_error.load", u.to_owned(), "position loop"),
        ("velocity.reference", format!("{u}/s"), "position loop"),
        ("effort.reference", effort.to_owned(), "velocity loop"),
        ("effort.motor", effort.to_owned(), "motor"),
        ("current.d", "A".to_owned(), "motor"),
        ("current.q", "A".to_owned(), "motor"),
        ("current.q_reference", "A".to_owned(), "velocity loop"),
        ("voltage.magnitude", "V".to_owned(), "inverter"),
        ("voltage.limit", "V".to_owned(), "inverter"),
        ("saturation.voltage", String::new(), "inverter"),
        ("saturation.current", String::new(), "velocity loop"),
    ];
    let specs = channels.map(|(name, unit, writer)| ChannelSpec {
        axis: None,
        name: name.into(),
        unit,
        writer: writer.into(),
        rate,
    });
    let bodies = vec!["motor".to_owned(), "load".to_owned()];
    let about =
        About { scenario: case.name.into(), engine: "example".into(), axis_unit: u.into(), bodies, overrides: vec![] };
    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "a small positive whole number")]
    let instants = (case.duration * f64::from(HERTZ)).round() as usize;
    let mut recorder = Recorder::new(about, rate, specs.to_vec(), instants);
    let (profile, end) = profile(case.order, instants);
    let [m1, m2, stiffness, damping, viscous] = PLANT;
    let (mut x1, mut v1, mut x2, mut v2) = (0.0, 0.0, 0.0, 0.0);
    let (mut integral, mut current) = (0.0, 0.0);
    let h = rate.period();
    let (k_v, gain, integral_time, current_time) = (60.0, (m1 + m2) * 250.0, 0.02, 4e-4);
    for [x, v, a, j, s] in profile {
        let speed = v + k_v * (x - x1);
        let error = speed - v1;
        let wanted = gain * (error + integral / integral_time) + (m1 + m2) * a + 2.0 * viscous * v;
        integral += h * error;
        let wanted_current = wanted / FORCE_CONSTANT;
        let force = FORCE_CONSTANT * current;
        let voltage = (12.0 * v1 + 1.4 * current).abs();
        recorder.push(&[
            x,
            v,
            a,
            j,
            s,
            x,
            x1,
            v1,
            x2,
            v2,
            x - x1,
            x - x2,
            speed,
            wanted,
            force,
            0.02 * current * v1,
            current,
            wanted_current,
            voltage,
            311.8,
            0.0,
            0.0,
        ]);
        current += h / current_time * (wanted_current - current);
        let step = h / f64::from(STEPS);
        for _ in 0..STEPS {
            let spring = stiffness * (x1 - x2) + damping * (v1 - v2);
            v1 += step / m1 * (force - spring - viscous * v1);
            v2 += step / m2 * (spring - viscous * v2);
            x1 += step * v1;
            x2 += step * v2;
        }
    }
    recorder.note_move(Move {
        label: format!("move to 1 {u}, order {}", case.order),
        start: 0.0,
        end,
        from: 0.0,
        to: 1.0,
        peaks: [1.0, 5.0, 50.0, if case.order == 4 { 1000.0 } else { f64::INFINITY }],
        limits: [Some(1.0), Some(5.0), Some(50.0), (case.order == 4).then_some(1000.0)],
        cruise: (end - 1.0, 0.65),
        ending: Ending::AtRest,
    });
    recorder.note_event(Event::new(0.1, 0.1, "drive", "an event of the example, at an instant"));
    recorder.finish().0
}
