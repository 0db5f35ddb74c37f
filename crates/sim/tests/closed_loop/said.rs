//! What FMUs say is in the recording at its time, whether they are beside the axis or its mechanics and however the run ends.
use crate::coupled::{TABLE, bench_beside_fmus};
use servobench_base::Severity;
use servobench_fmi::{FmuMistake, FmuRequest, LogLine, Slave, SlaveError, StepEnd};
use servobench_plant::{
    BodyState, Engine, EngineName, Exact, Input, LogMessage, Mechanics, MechanicsError, MechanicsSetup,
};
use servobench_sim::{FmuOpener, NoFmus, Outcome};

/// When the FMUs here fail (s).
const END: f64 = 0.1;

/// It says something at its start, at each step, and what is wrong with it.
#[derive(Default)]
struct Chatty {
    said: Vec<LogLine>,
}

impl Chatty {
    fn say(&mut self, time: f64, severity: Severity, message: &str) {
        self.said.push(LogLine { time, severity, category: "logAll".into(), message: message.into() });
    }
}

impl Slave for Chatty {
    fn step(&mut self, time: f64, _: f64, _: &[[f64; 3]]) -> Result<StepEnd, SlaveError> {
        self.say(time, Severity::Info, "step");
        if time > END - 1e-9 {
            self.say(time, Severity::Error, "leak");
            return Err(SlaveError::Failed {
                call: "fmi3DoStep".into(),
                time,
                status: "fmi3Error".into(),
                message: "leak".into(),
            });
        }
        Ok(StepEnd::Done)
    }

    fn read(&mut self, _: Option<&[f64]>, outputs: &mut [f64]) -> Result<(), SlaveError> {
        outputs.fill(0.0);
        Ok(())
    }

    fn take_log(&mut self) -> Vec<LogLine> {
        std::mem::take(&mut self.said)
    }
}

struct Opens;

impl FmuOpener for Opens {
    fn open(&self, _: &FmuRequest<'_>) -> Result<Box<dyn Slave>, Vec<FmuMistake>> {
        let mut chatty = Chatty::default();
        chatty.say(0.0, Severity::Info, "hello");
        Ok(Box::new(chatty))
    }
}

/// A run of a table of 40 kg at 1 kHz.
fn run(more: &str, engine: &dyn Engine, fmu_opener: &dyn FmuOpener) -> Outcome {
    let text = TABLE.replace("16 kHz", "1 kHz") + more;
    bench_beside_fmus(&text, engine, fmu_opener).unwrap_or_else(|error| panic!("{error}")).run(&mut |_| {})
}

fn beside(coupling: &str) -> Outcome {
    let fmu =
        "[[fmu]]\nfile = \"tank.fmu\"\ninputs = { x = \"load.position\" }\noutputs = { F = \"disturbance.load\" }\n";
    run(&format!("{fmu}{coupling}"), &Exact, &Opens)
}

/// Ten as they are, the others as one entry: of the steps at 0 ms, 1 ms, … 100 ms.
#[test]
fn an_fmu_beside_the_axis_is_heard_to_its_failure() {
    let Outcome { recording, failure } = beside("[coupling]\nmethod = \"jacobi\"\n");
    assert!(failure.is_some_and(|failure| failure.to_string().contains("leak")));
    let said: Vec<(&str, u64)> = recording.log.iter().map(|entry| (entry.text.as_str(), entry.times)).collect();
    assert_eq!(said[..2], [("hello", 1), ("step", 1)]);
    assert_eq!(said[11..], [("step", 91), ("leak", 1)]);
    assert!(recording.log.iter().all(|entry| entry.source == "FMU tank"));
    let [first, .., counted, last] = &recording.log[..] else { panic!("{said:?}") };
    assert_eq!((first.start, first.severity), (0.0, Severity::Info));
    assert!((counted.start - 0.01).abs() < 1e-12 && (counted.end - END).abs() < 1e-12, "{counted:?}");
    assert!((last.start - END).abs() < 1e-12 && last.severity == Severity::Error, "{last:?}");
    assert!(recording.events.is_empty(), "what an FMU says is no event of ours");
}

/// The engine `exact`, whose mechanics say something at each tick and whose clock is wrong at some.
struct Talking;

struct Talks {
    exact: Box<dyn Mechanics>,
    ticks: usize,
    said: Vec<LogMessage>,
}

impl Engine for Talking {
    fn name(&self) -> EngineName {
        EngineName::Exact
    }

    fn build(&self, setup: &MechanicsSetup) -> Result<Box<dyn Mechanics>, MechanicsError> {
        Ok(Box::new(Talks { exact: Exact.build(setup)?, ticks: 0, said: Vec::new() }))
    }
}

impl Mechanics for Talks {
    fn bodies(&self) -> &[BodyState] {
        self.exact.bodies()
    }

    fn advance(&mut self, input: &Input) -> Result<(), MechanicsError> {
        let time = [1e-3, f64::NAN, 1e300].get(self.ticks).copied().unwrap_or(-1.0);
        self.ticks += 1;
        self.said.push(LogMessage { time, severity: Severity::Warning, text: format!("in {}", self.ticks) });
        if self.ticks > 3 {
            return Err(MechanicsError::Native { engine: EngineName::Exact, message: "enough".into() });
        }
        self.exact.advance(input)
    }

    fn take_log(&mut self) -> Vec<LogMessage> {
        std::mem::take(&mut self.said)
    }
}

/// The fourth tick, which begins at 3 ms, fails. Nothing is said before the start or after the present.
#[test]
fn mechanics_are_heard_to_their_failure() {
    let Outcome { recording, failure } = run("", &Talking, &NoFmus);
    assert!(failure.is_some());
    let said: Vec<(f64, &str)> = recording.log.iter().map(|entry| (entry.start, entry.text.as_str())).collect();
    assert_eq!(said, [(0.0, "in 4"), (1e-3, "in 1"), (3e-3, "in 2"), (3e-3, "in 3")]);
    assert!(recording.log.iter().all(|entry| entry.source == "FMU of the axis"));
}
