//! `scenarios/hardware`: each effect is within its limits, and out of them where it is off or another one.
mod faults;
mod firmware;
mod inverter;
mod motor;
mod sensors;

use crate::{code, said, servobench};

/// Exit code, words and results of `scenarios/NAME.toml` with these keys, on `exact`.
fn run(name: &str, keys: &[&str]) -> (i32, String, String) {
    let out = tempfile::tempdir().unwrap();
    let file = format!("scenarios/{name}.toml");
    let mut arguments =
        vec!["run", &file, "--engine", "exact", "--keep", "none", "--out", out.path().to_str().unwrap()];
    arguments.extend(keys.iter().flat_map(|key| ["--set", key]));
    let output = servobench(&arguments);
    let results = std::fs::read_to_string(out.path().join("results.json")).unwrap_or_default();
    (code(&output), said(&output), results)
}

/// `scenarios/hardware/NAME.toml` passes, and fails with each of these sets of keys.
fn passes_but_not_with(name: &str, others: &[&[&str]]) {
    let name = format!("hardware/{name}");
    let (status, said, _) = run(&name, &[]);
    assert_eq!(status, 0, "{name}: {said}");
    for keys in others {
        let (status, said, _) = run(&name, keys);
        assert_eq!(status, 4, "{name} with {keys:?}: {said}");
    }
}
