//! Embedded files are read at compile time: a new one must trigger a build.

fn main() {
    for folder in ["../../models", "../../scenarios/demo"] {
        println!("cargo::rerun-if-changed={folder}");
    }
}
