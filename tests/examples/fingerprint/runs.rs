//! What a scenario gives.
use crate::{call, recordings, said};
use std::fs;
use std::path::{Path, PathBuf};

/// What a scenario gives, as text.
#[derive(Default)]
pub(crate) struct Runs {
    pub(crate) recordings: String,
    pub(crate) results: String,
    pub(crate) said: String,
}

/// Engines that a scenario is run on beside those that it names.
const ENGINES: [&str; 6] = ["--engine", "exact", "--engine", "rapier", "--engine", "mujoco"];

/// Runs the scenario `file` with `program`.
pub(crate) fn of(program: &Path, file: &Path) -> Runs {
    let file = file.canonicalize().unwrap();
    let (folder, name) = (file.parent().unwrap(), file.file_name().unwrap().to_string_lossy());
    let checked = call(program, folder, &["check", &name]);
    let header = format!("== {name}\n");
    let mut runs = Runs { recordings: header.clone(), results: header.clone(), said: header };
    runs.said += &said(&checked);
    for engines in [&[][..], &ENGINES[..]] {
        let work = tempfile::tempdir().unwrap();
        let out = work.path().to_string_lossy();
        let arguments: Vec<&str> = ["run", &name, "--quiet", "--jobs", "1", "--out", &out]
            .into_iter()
            .chain(engines.iter().copied())
            .collect();
        let ran = call(program, folder, &arguments);
        let plain = |text: String| text.replace(&*out, "OUT").replace(&*folder.to_string_lossy(), "FOLDER");
        runs.said += &plain(said(&ran));
        for file in files(work.path()) {
            if file.extension().is_some_and(|end| end == "parquet") {
                runs.recordings += &recordings::of(&file);
            } else if file.ends_with("results.json") {
                runs.results += &without_digests(&plain(fs::read_to_string(&file).unwrap()));
            }
        }
    }
    runs
}

/// Without the digests that say which program it was.
fn without_digests(results: &str) -> String {
    let of_program = ["\"suite\": ", "\"inputs\": ", "\"digest\": "];
    let is_number = |line: &&str| !of_program.iter().any(|key| line.trim_start().starts_with(key));
    results.lines().filter(is_number).flat_map(|line| [line, "\n"]).collect()
}

fn files(folder: &Path) -> Vec<PathBuf> {
    let mut files: Vec<PathBuf> = fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path()).collect();
    files.sort();
    files
}
