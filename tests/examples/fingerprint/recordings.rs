//! What is in a recording.
use crate::hash;
use servobench_trace::Recording;
use std::fmt::{Debug, Write as _};
use std::path::Path;

/// A line for each part of the recording in `file`.
pub(crate) fn of(file: &Path) -> String {
    let name = file.file_name().unwrap().to_string_lossy();
    let recording = match Recording::read_parquet(file) {
        Ok(recording) => recording,
        Err(error) => return format!("{name}: {error}\n"),
    };
    let mut lines = format!("{name}: {} Hz, {} rows\n", recording.rate.hertz(), recording.len());
    for channel in &recording.channels {
        let spec = &channel.spec;
        let hash = hash::of_numbers(&channel.values);
        writeln!(lines, "  {} [{}] {} {} Hz: {hash:016x}", spec.name, spec.unit, spec.writer, spec.rate.hertz())
            .unwrap();
    }
    for signal in &recording.signals {
        writeln!(lines, "  {}.{}: {:016x}", signal.source, signal.name, of_debug(&signal.changes)).unwrap();
    }
    for (kind, hash) in [
        ("about", of_debug(&recording.about)),
        ("moves", of_debug(&recording.moves)),
        ("events", of_debug(&recording.events)),
        ("calls", of_debug(&recording.calls)),
        ("limit reversals", of_debug(&recording.limit_reversals)),
        ("log", of_debug(&recording.log)),
    ] {
        writeln!(lines, "  {kind}: {hash:016x}").unwrap();
    }
    lines
}

/// `Debug` writes every number so that it reads back as the same.
fn of_debug(value: &impl Debug) -> u64 {
    hash::of_bytes(format!("{value:?}").into_bytes())
}
