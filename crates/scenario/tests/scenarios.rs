//! The files of the repository: every scenario and model loads, and the schema describes them.
use servobench_scenario::load;
use std::path::{Path, PathBuf};

fn repository() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../..")
}

/// Every scenario file of the repository.
fn scenarios() -> Vec<PathBuf> {
    let folders = ["scenarios", "scenarios/demo"].map(|folder| repository().join(folder));
    let files = folders.iter().flat_map(|folder| std::fs::read_dir(folder).unwrap());
    let mut all: Vec<PathBuf> = files
        .map(|entry| entry.unwrap().path())
        .filter(|path| path.extension().is_some_and(|extension| extension == "toml"))
        .collect();
    all.sort();
    assert!(all.len() >= 15, "{all:?}");
    all
}

#[test]
fn every_scenario_loads_without_a_warning() {
    for path in scenarios() {
        let loaded = load(&path).unwrap_or_else(|e| panic!("{e}"));
        assert_eq!(loaded.warnings, [], "{}", path.display());
        assert!(!loaded.scenario.description.is_empty(), "{} says nothing", path.display());
    }
}
