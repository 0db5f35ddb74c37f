//! A slave with numbers in SI units.
use crate::ports::Ports;
use servobench_fmi::{
    Capabilities, DataType, DeclaredNumber, FmuMistake, LogLine, Severity, Slave, SlaveError, StepEnd,
};

/// A slave wired with ports: its numbers are in SI units outside and in the FMU's units inside.
pub struct InSi {
    slave: Box<dyn Slave>,
    ports: Ports,
    /// Inputs of a step, and of a reading, in its units.
    moving: Vec<[f64; 3]>,
    present: Vec<f64>,
    /// Lines to log before its own.
    notes: Vec<LogLine>,
    doubts: Vec<FmuMistake>,
}

impl InSi {
    /// `slave`, whose inputs and outputs are those of `ports` in the same order.
    #[must_use]
    pub fn new(slave: Box<dyn Slave>, ports: Ports) -> Self {
        let inputs = ports.inputs.len();
        Self {
            slave,
            ports,
            moving: vec![[0.0; 3]; inputs],
            present: vec![0.0; inputs],
            notes: Vec::new(),
            doubts: Vec::new(),
        }
    }

    /// The same, with warnings at the beginning of its log.
    #[must_use]
    pub fn with_warnings(self, warnings: &[String]) -> Self {
        Self { notes: warnings.iter().cloned().map(warning).collect(), ..self }
    }

    /// The same, with doubts about its request, which are logged too.
    #[must_use]
    pub fn with_doubts(mut self, doubts: Vec<FmuMistake>) -> Self {
        self.notes.extend(doubts.iter().map(|doubt| warning(doubt.to_string())));
        Self { doubts, ..self }
    }
}

fn warning(message: String) -> LogLine {
    LogLine { time: 0.0, severity: Severity::Warning, category: String::new(), message }
}

/// `inputs` in the units of the FMU.
fn own<'a>(present: &'a mut [f64], ports: &Ports, inputs: &[f64]) -> &'a [f64] {
    for ((own, wire), si) in present.iter_mut().zip(&ports.inputs).zip(inputs) {
        *own = wire.of_si(*si);
    }
    present
}

impl Slave for InSi {
    fn capabilities(&self) -> Capabilities {
        self.slave.capabilities()
    }

    fn feeds_through(&self, output: usize, input: usize) -> bool {
        self.slave.feeds_through(output, input)
    }

    fn is_discrete(&self, output: usize) -> bool {
        self.slave.is_discrete(output)
    }

    fn declared_input(&self, input: usize) -> Option<&DeclaredNumber> {
        self.ports.inputs.get(input).map(|wire| &wire.declared)
    }

    fn declared_output(&self, output: usize) -> Option<&DeclaredNumber> {
        self.ports.outputs.get(output).map(|wire| &wire.declared)
    }

    fn is_single_precision(&self) -> bool {
        let mut wires = self.ports.inputs.iter().chain(&self.ports.outputs);
        wires.any(|wire| wire.declared.data_type == DataType::Float32)
    }

    fn doubts(&self) -> &[FmuMistake] {
        &self.doubts
    }

    fn is_initialising(&self) -> bool {
        self.slave.is_initialising()
    }

    fn follows_at_start(&self, output: usize, input: usize) -> bool {
        self.slave.follows_at_start(output, input)
    }

    fn start(&mut self, inputs: Option<&[f64]>) -> Result<(), SlaveError> {
        let present = inputs.map(|inputs| own(&mut self.present, &self.ports, inputs));
        self.slave.start(present)
    }

    fn end(&mut self) {
        self.slave.end();
    }

    fn step(&mut self, time: f64, length: f64, inputs: &[[f64; 3]]) -> Result<StepEnd, SlaveError> {
        for ((own, wire), si) in self.moving.iter_mut().zip(&self.ports.inputs).zip(inputs) {
            *own = wire.of_si_in_motion(*si);
        }
        self.slave.step(time, length, &self.moving)
    }

    fn read(&mut self, inputs: Option<&[f64]>, outputs: &mut [f64]) -> Result<(), SlaveError> {
        let present = inputs.map(|inputs| own(&mut self.present, &self.ports, inputs));
        self.slave.read(present, outputs)?;
        for (output, wire) in outputs.iter_mut().zip(&self.ports.outputs) {
            *output = wire.to_si(*output);
        }
        Ok(())
    }

    fn save(&mut self) -> Result<(), SlaveError> {
        self.slave.save()
    }

    fn restore(&mut self) -> Result<(), SlaveError> {
        self.slave.restore()
    }

    fn take_log(&mut self) -> Vec<LogLine> {
        let mut log = std::mem::take(&mut self.notes);
        log.extend(self.slave.take_log());
        log
    }
}
