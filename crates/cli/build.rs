//! Lets the program find the MuJoCo library beside the folder it is built in, or beside the one it is unpacked in.

fn main() {
    println!("cargo::rerun-if-changed=build.rs");
    if std::env::var_os("CARGO_FEATURE_MUJOCO").is_some() {
        println!("cargo::rustc-link-arg=-Wl,-rpath,$ORIGIN/../native/lib:$ORIGIN/../../native/lib");
    }
}
