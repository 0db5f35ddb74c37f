//! Two masses with a spring and a damper between them: as two coupled FMUs, and as one system.
use super::files::Files;
use crate::ENGINE;
use servobench_base::{Divider, Rate};
use servobench_coupling::{
    Block, Connection, CouplingError, Input, InputPort, Master, Member, Method, Network, Order, Port, Settings, StepEnd,
};
use servobench_fmi::{FmuFile, FmuRequest, Isolation, SiPort, Slave, SlaveError, Value};
use std::num::NonZeroU32;
use std::path::Path;

/// Base ticks per second.
pub(crate) const RATE: u32 = 8192;

/// Masses (kg), stiffness (N/m), damping (N·s/m), which is below the critical one.
#[derive(Debug, Clone, Copy)]
pub(crate) struct TwoMasses {
    pub(crate) m1: f64,
    pub(crate) m2: f64,
    pub(crate) c: f64,
    pub(crate) d: f64,
    /// Amplitude F₀ (N) and angular frequency w (rad/s) of the force on the first mass, F₀·(1 − cos wt)².
    pub(crate) force: (f64, f64),
    /// Initial velocity of the first mass (m/s).
    pub(crate) v1: f64,
}

impl TwoMasses {
    /// Both FMUs, coupled by the spring's force and the mass's motion.
    pub(crate) fn coupled(&self, files: &Files, isolation: Isolation, settings: &Settings) -> Outcome {
        let Self { m1, m2, c, d, force: (amplitude, w), v1 } = *self;
        let start = [("m", m1), ("v", v1), ("amplitude", amplitude), ("w", w)];
        let mass = member("mass", &files.mass, &start, (&["f"], &["x", "v"]), isolation);
        let start = [("m", m2), ("c", c), ("d", d)];
        let spring = member("spring", &files.spring, &start, (&["x1", "v1"], &["f", "x", "v"]), isolation);
        let network = Network {
            members: vec![mass, spring],
            connections: vec![connect((1, 0), (0, 0)), connect((0, 0), (1, 0)), connect((0, 1), (1, 1))],
        };
        Master::new(network, settings)
    }

    /// x₁, v₁, x₂, v₂ at `t` (s) in closed form: the centre of mass, and the distance r = x₁ − x₂ with
    /// r'' + 2·δ·r' + ω₀²·r = F/m₁, whose response to each part of F = F₀·(3/2 − 2·cos wt + ½·cos 2wt) is a harmonic.
    pub(crate) fn exact(&self, t: f64) -> [f64; 4] {
        let Self { m1, m2, c, d, force: (amplitude, w), v1 } = *self;
        let all = m1 + m2;
        let (delta, omega2) = (d * all / (2.0 * m1 * m2), c * all / (m1 * m2));
        let omega = (omega2 - delta * delta).sqrt();
        let (mut x, mut v) = (m1 / all * v1 * t, m1 / all * v1);
        // The distance and its derivative, forced at t and at 0.
        let (mut forced, mut at_start) = ([0.0; 2], [0.0; 2]);
        for (share, w) in [(1.5, 0.0), (-2.0, w), (0.5, 2.0 * w)] {
            let force = amplitude * share;
            let (sin, cos) = (w * t).sin_cos();
            x += force / all * if w == 0.0 { t * t / 2.0 } else { (1.0 - cos) / (w * w) };
            v += force / all * if w == 0.0 { t } else { sin / w };
            let (real, imaginary) = (omega2 - w * w, 2.0 * delta * w);
            let gain = force / m1 / (real * real + imaginary * imaginary);
            forced[0] += gain * (real * cos + imaginary * sin);
            forced[1] += gain * w * (imaginary * cos - real * sin);
            at_start[0] += gain * real;
            at_start[1] += gain * w * imaginary;
        }
        let a = -at_start[0];
        let b = (v1 - at_start[1] + delta * a) / omega;
        let (sin, cos) = (omega * t).sin_cos();
        let decay = (-delta * t).exp();
        let distance = forced[0] + decay * (a * cos + b * sin);
        let rate = forced[1] + decay * ((omega * b - delta * a) * cos - (omega * a + delta * b) * sin);
        [x + m2 / all * distance, v + m2 / all * rate, x - m1 / all * distance, v - m1 / all * rate]
    }
}

pub(crate) type Outcome = Result<Master<Coupled>, CouplingError<SlaveError>>;

/// Present x₁, v₁, x₂, v₂.
pub(crate) fn state(master: &Master<Coupled>) -> [f64; 4] {
    [(0, 0), (0, 1), (1, 1), (1, 2)].map(|(block, port)| master.value(Port { block, port }).unwrap())
}

pub(crate) fn settings(method: Method, order: Order, ticks: u32) -> Settings {
    Settings {
        base_rate: Rate::new(RATE).unwrap(),
        step: Divider::new(ticks).unwrap(),
        method,
        order,
        algebraic: None,
        watch: true,
    }
}

fn member(
    name: &str,
    path: &Path,
    start: &[(&str, f64)],
    (inputs, outputs): (&[&str], &[&str]),
    isolation: Isolation,
) -> Member<Coupled> {
    let ports = |names: &[&str]| names.iter().map(|name| SiPort { variable: (*name).into(), unit: None }).collect();
    let start = start.iter().map(|(variable, value)| ((*variable).into(), Value::Number(*value))).collect();
    let request = FmuRequest {
        file: &FmuFile { path: path.into(), start, isolation, event_mode: true },
        name: Some(name),
        inputs: ports(inputs),
        outputs: ports(outputs),
        step: 1.0 / f64::from(RATE),
        end: Some(2.0),
        waits: true,
    };
    Member {
        name: name.into(),
        inputs: inputs.iter().map(|name| InputPort { name: (*name).into(), held: 0.0 }).collect(),
        outputs: outputs.iter().map(|name| (*name).into()).collect(),
        every: NonZeroU32::MIN,
        block: Coupled(ENGINE.open(&request).unwrap_or_else(|mistakes| panic!("{mistakes:?}"))),
    }
}

fn connect(from: (usize, usize), to: (usize, usize)) -> Connection {
    let port = |(block, port)| Port { block, port };
    Connection { from: port(from), to: port(to), gain: 1.0, offset: 0.0, is_discrete: false }
}

/// An FMU as a block.
pub(crate) struct Coupled(Box<dyn Slave>);

impl Block for Coupled {
    type Error = SlaveError;

    fn saves_state(&self) -> bool {
        self.0.capabilities().saves_state
    }

    fn feeds_through(&self, output: usize, input: usize) -> bool {
        self.0.feeds_through(output, input)
    }

    fn has_initial_equations(&self) -> bool {
        self.0.is_initialising()
    }

    fn follows_at_start(&self, output: usize, input: usize) -> bool {
        self.0.follows_at_start(output, input)
    }

    fn start(&mut self, inputs: &[f64]) -> Result<(), SlaveError> {
        self.0.start(Some(inputs))
    }

    fn step(&mut self, time: f64, length: f64, inputs: &[Input]) -> Result<StepEnd, SlaveError> {
        self.0.step(time, length, inputs)
    }

    fn read(&mut self, inputs: Option<&[f64]>, outputs: &mut [f64]) -> Result<(), SlaveError> {
        self.0.read(inputs, outputs)
    }

    fn save(&mut self) -> Result<(), SlaveError> {
        self.0.save()
    }

    fn restore(&mut self) -> Result<(), SlaveError> {
        self.0.restore()
    }
}
