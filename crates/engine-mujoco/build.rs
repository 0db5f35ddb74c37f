//! Lets the tests and benchmarks of this package find the MuJoCo library beside the folder they are built in.

fn main() {
    println!("cargo::rerun-if-changed=build.rs");
    // `<target>/release/deps/test` and `<target>/release/program`, with the library in `<target>/native/lib`. A link
    // argument of a dependency does not reach its dependents: each package that links MuJoCo needs these two lines.
    println!("cargo::rustc-link-arg=-Wl,-rpath,$ORIGIN/../native/lib:$ORIGIN/../../native/lib");
}
