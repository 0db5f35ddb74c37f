//! Cost of a step in this process, in a separate one, and over pipes, beside threads that do nothing but compute.
//!
//! `cargo bench -p servobench-engine-fmu`

use servobench_engine_fmu::{HostCommand, Isolated, Wires, serve};
use servobench_fmi::{Bounds, Slave, SlaveError, StepEnd};
use std::hint::black_box;
use std::io::{Read, Write, stdin, stdout};
use std::process::{Child, Command, Stdio};
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering::Relaxed};
use std::thread::{JoinHandle, spawn};

/// One input, two outputs: an axis with a force as input, position and velocity as outputs.
const WIRES: Wires = Wires { inputs: 1, outputs: 2 };
/// Steps and readings per sample.
const TURNS: usize = 1000;
/// Threads that compute.
const LOADS: [usize; 3] = [0, 1, 2];

fn main() {
    match std::env::args().nth(1).as_deref() {
        Some("host") => serve(|()| Ok(Box::new(Mass::default()))).unwrap(),
        Some("pipe") => pipe(),
        _ => divan::main(),
    }
}

/// 1 kg: nothing to compute, so that only the exchange is measured.
#[derive(Default)]
struct Mass {
    x: f64,
    v: f64,
}

impl Slave for Mass {
    fn step(&mut self, _: f64, length: f64, inputs: &[[f64; 3]]) -> Result<StepEnd, SlaveError> {
        self.v += length * inputs[0][0];
        self.x += length * self.v;
        Ok(StepEnd::Done)
    }

    fn read(&mut self, _: Option<&[f64]>, outputs: &mut [f64]) -> Result<(), SlaveError> {
        outputs.copy_from_slice(&[self.x, self.v]);
        Ok(())
    }
}

/// Threads that take what processor time they get.
struct Load(Arc<AtomicBool>, Vec<JoinHandle<()>>);

impl Load {
    fn new(threads: usize) -> Self {
        let over = Arc::new(AtomicBool::new(false));
        let compute = |over: Arc<AtomicBool>| move || while !over.load(Relaxed) {};
        let threads = (0..threads).map(|_| spawn(compute(Arc::clone(&over)))).collect();
        Self(over, threads)
    }
}

impl Drop for Load {
    fn drop(&mut self) {
        self.0.store(true, Relaxed);
        self.1.drain(..).for_each(|thread| thread.join().unwrap());
    }
}

fn steps_and_readings(slave: &mut dyn Slave) {
    let mut outputs = [0.0; 2];
    for k in 0..TURNS {
        slave.step(k as f64 * 1e-3, 1e-3, black_box(&[[1.0, 0.0, 0.0]])).unwrap();
        slave.read(None, &mut outputs).unwrap();
        black_box(&outputs);
    }
}

#[divan::bench]
fn here(bencher: divan::Bencher) {
    let mut slave: Box<dyn Slave> = Box::new(Mass::default());
    bencher.counter(TURNS).bench_local(|| steps_and_readings(slave.as_mut()));
}

#[divan::bench(args = LOADS)]
fn isolated(bencher: divan::Bencher, load: usize) {
    let command = HostCommand { program: std::env::current_exe().unwrap(), args: vec!["host".into()], env: Vec::new() };
    let mut slave = Isolated::start(&command, &(), WIRES, Bounds::default()).unwrap();
    let _load = Load::new(load);
    bencher.counter(TURNS).bench_local(|| steps_and_readings(&mut slave));
}

/// One exchange, which combines a step and a reading.
#[divan::bench(args = LOADS)]
fn over_pipes(bencher: divan::Bencher, load: usize) {
    let mut child = Command::new(std::env::current_exe().unwrap())
        .arg("pipe")
        .stdin(Stdio::piped())
        .stdout(Stdio::piped())
        .spawn()
        .unwrap();
    let _load = Load::new(load);
    bencher.counter(TURNS).bench_local(|| (0..TURNS).for_each(|_| exchange(&mut child)));
    drop(child.stdin.take());
    child.wait().unwrap();
}

fn exchange(child: &mut Child) {
    let mut numbers = [0; 16];
    child.stdin.as_mut().unwrap().write_all(&1.0_f64.to_le_bytes()).unwrap();
    child.stdout.as_mut().unwrap().read_exact(&mut numbers).unwrap();
    black_box(&numbers);
}

fn pipe() {
    let (mut mass, mut number, mut outputs) = (Mass::default(), [0; 8], [0.0; 2]);
    while stdin().read_exact(&mut number).is_ok() {
        mass.step(0.0, 1e-3, &[[f64::from_le_bytes(number), 0.0, 0.0]]).unwrap();
        mass.read(None, &mut outputs).unwrap();
        stdout().write_all(outputs.map(f64::to_le_bytes).as_flattened()).unwrap();
        stdout().flush().unwrap();
    }
}
