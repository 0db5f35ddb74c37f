//! Sweep files.
use crate::{WORDS, check_places};
use servobench_fuzz::{Splice, check, fuzz};
use servobench_scenario::{LoadError, parse_sweep};
use std::path::Path;

const SWEEPS: [&str; 3] = [
    "scenario = \"a.toml\"\nengine = [\"exact\", \"rapier\"]\narrangement = \"zip\"\nmetrics = [\"settling_time\"]\n[[vary]]\n\
     key = \"setpoint.jerk\"\nvalues = [\"25 m/s3\", 50, true, \"zvd\"]\n[[vary]]\nkey = \"axis.load.mass\"\n\
     range = { from = \"1 kg\", to = \"4 kg\", count = 4, spacing = \"log\" }\n",
    "scenario = \"a.toml\"\n[[vary]]\nkey = \"a\"\nnormal = { mean = \"5 kg\", tolerance = \"5 %\" }\n[[vary]]\nkey = \"b\"\n\
     uniform = { from = \"-1 m\", to = \"1 m\" }\n[draws]\ncount = 100\nseed = 7\nmethod = \"random\"\n",
    "scenario = \"\"\n[[vary]]\nkey = \"c\"\ntriangular = { from = 0, mode = 0.5, to = 1e3 }\n[draws]\ncount = 1000\n",
];

/// Any text is a sweep whose points are finite and can be written, or yields a list of mistakes with places.
#[test]
fn sweeps() {
    fuzz(check!(), 3_000, Splice::text(&SWEEPS, WORDS), |text| match parse_sweep("any.toml", text, Path::new("")) {
        Ok(request) => {
            let points = request.sweep.points();
            assert!(points > 0);
            let keys = request.sweep.keys().count();
            for index in [0, points / 2, points - 1] {
                let settings = request.sweep.point(index);
                assert_eq!(settings.len(), keys);
                assert!(
                    settings
                        .iter()
                        .all(|one| one.value.number().is_none_or(f64::is_finite) && !one.written().is_empty())
                );
            }
        }
        Err(LoadError::Invalid(invalid)) => {
            assert!(!invalid.diagnostics.is_empty());
            check_places(&invalid.sources, &invalid.diagnostics);
        }
        Err(LoadError::Read { path, error }) => panic!("{}: {error}", path.display()),
    });
}
