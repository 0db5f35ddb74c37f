//! Writing an FMU: description, library and resources in one archive.
use crate::description::describe;
use crate::error::FmuError;
use crate::machine::Model;
use crate::part::Part;
use crate::resources::Resources;
use servobench_fmi::Version;
use servobench_scenario::Loaded;
use std::io::{Cursor, Write as _};
use zip::write::SimpleFileOptions;
use zip::{CompressionMethod, DateTime, ZipWriter};

/// Name of the library in the archive, without its extension.
const IDENTIFIER: &str = "servobench";
/// Beginning of a 64-bit little-endian ELF file, and the machine x86-64 at byte 18.
const ELF64: &[u8] = b"\x7fELF\x02\x01";
const X86_64: [u8; 2] = [62, 0];

/// The FMU of a part of a scenario, as the bytes of its archive, with this library inside: the one built from this crate. The
/// same arguments give the same bytes.
///
/// # Errors
/// [`FmuError`] names the part of the scenario that cannot be in an FMU, or rejects the library.
pub fn export(loaded: &Loaded, version: Version, part: Part, library: &[u8]) -> Result<Vec<u8>, FmuError> {
    if !(library.starts_with(ELF64) && library.get(18..20) == Some(&X86_64)) {
        return Err(FmuError::Library);
    }
    let model = Model::new(part, &loaded.scenario)?;
    let resources = Resources::of(part, loaded)?;
    let description = describe(&model, version, &resources.token(), IDENTIFIER)
        .map_err(|error| FmuError::Archive(error.to_string()))?;
    let platform = match version {
        Version::Two => "linux64",
        Version::Three => "x86_64-linux",
    };
    let description = description.write();
    let library_path = format!("binaries/{platform}/{IDENTIFIER}.so");
    let mut files = vec![("modelDescription.xml".to_owned(), description.as_bytes()), (library_path, library)];
    for (path, text) in &resources.files {
        files.push((format!("resources/{path}"), text.as_bytes()));
    }
    archive(&files).map_err(|error| FmuError::Archive(error.to_string()))
}

/// A zip archive of `files`, independent of the time and place of writing.
fn archive(files: &[(String, &[u8])]) -> zip::result::ZipResult<Vec<u8>> {
    let mut zip = ZipWriter::new(Cursor::new(Vec::new()));
    let options = SimpleFileOptions::default()
        .compression_method(CompressionMethod::Deflated)
        .last_modified_time(DateTime::default());
    for (path, bytes) in files {
        let mode = if path.starts_with("binaries/") { 0o755 } else { 0o644 };
        zip.start_file(path, options.unix_permissions(mode))?;
        zip.write_all(bytes)?;
    }
    Ok(zip.finish()?.into_inner())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::instance::{Asked, Instance};
    use crate::interface::Kind;
    use servobench_config::Choice as _;
    use servobench_fmi::{Archive, Causality, DataType, Limits, ModelDescription, Variable};
    use servobench_scenario::{embedded_demo, parse};
    use servobench_sim::Program;
    use std::sync::Arc;

    fn demo() -> Loaded {
        let (name, text) = embedded_demo()[0];
        parse(name, text, None).unwrap_or_else(|error| panic!("{error}"))
    }

    /// The beginning of a library.
    fn library() -> Vec<u8> {
        let mut bytes = vec![0; 64];
        bytes[..6].copy_from_slice(ELF64);
        bytes[18..20].copy_from_slice(&X86_64);
        bytes
    }

    /// Oracle: the reader of model descriptions, which rejects everything that contradicts the standard, and has no remarks.
    #[test]
    fn what_is_written_is_read_without_a_remark() {
        let loaded = demo();
        for version in [Version::Two, Version::Three] {
            for &(_, part, _) in Part::ALL {
                let model = Model::new(part, &loaded.scenario).unwrap();
                let text = describe(&model, version, "{token}", IDENTIFIER).unwrap().write();
                let read =
                    ModelDescription::read(&text, "modelDescription.xml").unwrap_or_else(|e| panic!("{e}\n{text}"));
                assert_eq!(read.remarks, Vec::<String>::new());
                assert_eq!(read.variables.len(), model.variables.len());
                assert!(read.co_simulation.can_serialize_state);
                let kinds = |causality| read.variables.iter().filter(move |one| one.causality == causality).count();
                assert_eq!(kinds(Causality::Output), read.structure.outputs.len());
                assert!(kinds(Causality::Input) > 0 && kinds(Causality::Parameter) > 0);
                // No output follows an input directly.
                assert!(read.structure.outputs.iter().all(|one| one.dependencies.as_ref().is_some_and(Vec::is_empty)));
            }
        }
    }

    /// Oracle: the instance itself. Values within `min` and `max` are accepted, and values a rounding beyond them are refused.
    #[test]
    fn the_bounds_that_are_written_are_those_that_are_kept() {
        let asked = Asked { name: "Float64", takes: |kind| kind == Kind::Real, name_of: |_| "another type" };
        let mut bounded = 0;
        for &(_, part, _) in Part::ALL {
            let model = Arc::new(Model::new(part, &demo().scenario).unwrap());
            let written = describe(&model, Version::Three, "{token}", IDENTIFIER).unwrap();
            let written = ModelDescription::read(&written.write(), "modelDescription.xml").unwrap();
            let is_settable = |one: &&Variable| {
                one.data_type == DataType::Float64 && matches!(one.causality, Causality::Input | Causality::Parameter)
            };
            for one in written.variables.iter().filter(is_settable) {
                let mut instance = Instance::new(Arc::clone(&model));
                let mut set = |value| instance.set(one.value_reference, &asked, value);
                for (bound, beyond) in [(one.min, f64::next_down as fn(f64) -> f64), (one.max, f64::next_up)] {
                    let Some(bound) = bound else { continue };
                    assert_eq!(set(bound), Ok(()), "{} at {bound}", one.name);
                    assert!(set(beyond(bound)).is_err(), "{} beyond {bound}", one.name);
                    bounded += 1;
                }
                if one.min.is_none() {
                    assert_eq!(set(-1e300), Ok(()), "{}", one.name);
                }
            }
        }
        assert!(bounded > 10, "{bounded}");
    }

    /// Oracle: the end of the program in `sim`, and the run that records it.
    #[test]
    fn the_default_experiment_covers_the_program() {
        const SLOW: &str = "[[program]]\nmove_to = \"4 m\"\n[[program]]\nwait = \"1.23456 s\"\n";
        let text = embedded_demo()[0].1;
        let (before, _) = text.split_once("[[program]]").unwrap();
        for (text, least) in [(text.to_owned(), 0.0), (format!("{before}{SLOW}"), 5.0)] {
            let loaded = parse("slow", &text, None).unwrap_or_else(|error| panic!("{error}"));
            let end = Program::new(&loaded.scenario).unwrap().end();
            assert!(end > least, "{end}");
            for &(_, part, _) in Part::ALL {
                let model = Model::new(part, &loaded.scenario).unwrap();
                let written = describe(&model, Version::Two, "{token}", IDENTIFIER).unwrap().default_experiment;
                let (stop, step) = (written.stop_time.unwrap(), written.step_size.unwrap());
                assert!(stop >= end, "{part:?}: {stop} of {end}");
                let count = stop / step;
                assert!((count - count.round()).abs() < 1e-6, "{part:?}: {count} steps");
            }
        }
    }

    #[test]
    fn the_same_arguments_give_the_same_bytes() {
        let write = || export(&demo(), Version::Three, Part::Axis, &library()).unwrap();
        let bytes = write();
        assert!(bytes == write());
        let file = tempfile::NamedTempFile::new().unwrap();
        std::fs::write(file.path(), &bytes).unwrap();
        let archive = Archive::open(file.path(), &Limits::default());
        assert!(archive.is_ok(), "{:?}", archive.err());
    }

    #[test]
    fn what_cannot_be_in_an_fmu_is_refused_with_the_way_out() {
        let refusal = |loaded: &Loaded, part, library: &[u8]| {
            export(loaded, Version::Two, part, library).unwrap_err().to_string()
        };
        assert!(refusal(&demo(), Part::Axis, b"MZ").contains("cargo build --release -p servobench-fmu"));
        let text = "[run]\nbase_rate = \"16 kHz\"\n[axis]\nmotion = \"linear\"\n[motor]\nkind = \"prescribed\"\n";
        let bare = parse("bare", text, None).unwrap_or_else(|error| panic!("{error}"));
        assert_eq!(
            refusal(&bare, Part::Drive, &library()),
            "`bare` has no drive: `--part axis` or `--part mechanics` can be exported"
        );
    }
}
