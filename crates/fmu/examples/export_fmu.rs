//! Writes an FMU: `export_fmu SCENARIO 2|3 axis|drive|mechanics LIBRARY FMU`.
use servobench_config::Choice as _;
use servobench_fmi::Version;
use servobench_fmu::{Part, export};
use servobench_scenario::load;
use std::error::Error;
use std::path::Path;

fn main() -> Result<(), Box<dyn Error>> {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let [scenario, version, part, library, fmu] = arguments.as_slice() else {
        return Err("usage: export_fmu SCENARIO 2|3 axis|drive|mechanics LIBRARY FMU".into());
    };
    let version = match version.as_str() {
        "2" => Version::Two,
        "3" => Version::Three,
        other => return Err(format!("`{other}` is no version: 2 or 3").into()),
    };
    let part = Part::from_name(part).ok_or_else(|| format!("`{part}` is no part: axis, drive or mechanics"))?;
    let loaded = load(Path::new(scenario))?;
    std::fs::write(fmu, export(&loaded, version, part, &std::fs::read(library)?)?)?;
    Ok(())
}
