//! What a run of a scenario records on the engine `exact` at every tick, as CSV with every number to the bit: `record SCENARIO`.
use servobench_plant::Exact;
use servobench_scenario::load;
use servobench_sim::Bench;
use std::error::Error;
use std::io::{BufWriter, Write};
use std::path::Path;

fn main() -> Result<(), Box<dyn Error>> {
    let path = std::env::args().nth(1).ok_or("usage: record SCENARIO")?;
    let outcome = Bench::new(&load(Path::new(&path))?.scenario, &Exact)?.run(&mut |_| ());
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
