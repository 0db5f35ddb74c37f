//! What a run of a scenario records on the engine `exact` at every tick, as CSV with every number bit for bit: `record SCENARIO`.
//! FMUs beside the axis are loaded into this process, with the start values that they have; their numbers are SI numbers.
use servobench_fmi::{FmuMistake, FmuRequest, Loaded, Port, Setup, SiPort, Slave, Unpacked};
use servobench_plant::Exact;
use servobench_scenario::load;
use servobench_sim::{Bench, FmuOpener};
use std::error::Error;
use std::io::{BufWriter, Write};
use std::path::Path;

/// Opens FMUs of scenarios.
struct Here;

impl FmuOpener for Here {
    fn open(&self, request: &FmuRequest<'_>) -> Result<Box<dyn Slave>, Vec<FmuMistake>> {
        if !request.file.start.is_empty() {
            return Err(vec![FmuMistake::of_file(&"this example sets no parameters")]);
        }
        let ports = |ports: &[SiPort]| {
            ports.iter().map(|port| Port { variable: port.variable.clone(), element: 0 }).collect::<Vec<_>>()
        };
        let setup = Setup {
            instance_name: request.name.unwrap_or_default().to_owned(),
            inputs: ports(&request.inputs),
            outputs: ports(&request.outputs),
            stop_time: request.end,
            ..Setup::default()
        };
        let opened = Unpacked::new(&request.file.path).and_then(|fmu| Loaded::new(&fmu, &setup));
        Ok(Box::new(opened.map_err(|error| vec![FmuMistake::of_file(&error)])?))
    }
}

fn main() -> Result<(), Box<dyn Error>> {
    let path = std::env::args().nth(1).ok_or("usage: record SCENARIO")?;
    let scenario = load(Path::new(&path))?.scenario;
    let outcome = Bench::with_fmus(&scenario, &Exact, &Here)?.run(&mut |_| ());
    if let Some(failure) = outcome.failure {
        return Err(failure.into());
    }
    let recording = outcome.recording;
    let mut out = BufWriter::new(std::io::stdout().lock());
    let names: Vec<_> = recording.channels.iter().map(|channel| channel.spec.name.as_str()).collect();
    writeln!(out, "{},{}", recording.rate.hertz(), names.join(","))?;
    for row in 0..recording.channels.first().map_or(0, |channel| channel.values.len()) {
        let values: Vec<_> = recording.channels.iter().map(|channel| format!("{:?}", channel.values[row])).collect();
        writeln!(out, "{row},{}", values.join(","))?;
    }
    Ok(())
}
