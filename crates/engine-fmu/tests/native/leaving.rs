//! End of the process of an FMU.
use super::{ENGINE, File};
use servobench_engine_fmu::{HostCommand, Place, load};
use servobench_fmi::{Bounds, Port, Setup, Unpacked};

/// The library stays loaded until the process ends, as Python's does.
#[test]
fn no_destructor_runs_at_the_end_and_what_is_buffered_comes_out() {
    let file = File::compiled_with(&["-DLINGERS", "-Wl,-z,nodelete"]);
    let folder = tempfile::tempdir().unwrap();
    let notes = folder.path().join("notes");
    let env = vec![("MASS_NOTES".into(), notes.clone().into_os_string())];
    let command = HostCommand { env, ..(ENGINE.host)().unwrap() };
    let port = |variable: &str| vec![Port { variable: variable.into(), element: 0 }];
    let setup = Setup { inputs: port("force"), outputs: port("v"), ..Setup::default() };
    let fmu = Unpacked::new(&file.path).unwrap();
    let mut slave = load(&fmu, &setup, &Place::Process { command, bounds: Bounds::default() }).unwrap();
    slave.step(0.0, 0.5, &[[2.0, 0.0, 0.0]]).unwrap();
    let mut read = [0.0];
    slave.read(None, &mut read).unwrap();
    assert!((read[0] - 1.0).abs() < 1e-15, "{read:?}");
    assert_eq!(std::fs::read_to_string(&notes).unwrap(), "", "it is buffered");
    drop(slave);
    assert_eq!(std::fs::read_to_string(&notes).unwrap(), "instantiated\nfreed\n");
}
