//! Compiles the logger of FMI 2.0, a variadic function, which stable Rust cannot define.

fn main() {
    println!("cargo::rerun-if-changed=src/library/logger.c");
    cc::Build::new().file("src/library/logger.c").warnings_into_errors(true).compile("servobench_fmi2_logger");
}
