//! Tables of points.
use crate::WORDS;
use servobench_fuzz::{Splice, check, fuzz};
use servobench_scenario::{PointsError, read_accelerations, read_points, read_velocities};

const TABLES: [&str; 5] = [
    "time [ms],position [mm],velocity [mm/s]\n0,0,0\n10,5,\n20,15,750\n30,20,0\n",
    "position [deg],time [s]\r\n0,0\r\n-90,.5\r\n\r\n1e2,1.25\r\n",
    "time [us],velocity [rpm],position [rev]\n-1,0,+3.\n0,1e-3,4\n1e6,,5\n",
    "\u{feff}time [min],position [m]\n0,0\n1,2\n",
    "time [ms],step [mm],velocity [mm/s],jerk [m/s3]\n0,9e32,0,1\n10,5,,\n20,-15,750,0\n",
];

/// A table that is read is finite, in the order of time, with a velocity or `None` for each point; a refusal has a place in the text.
#[test]
fn points() {
    fuzz(check!(), 3_000, Splice::text(&TABLES, WORDS), |text| match read_points(text) {
        Ok(points) => {
            let count = points.times.len();
            assert!(count >= 2 && points.positions.len() == count, "{points:?}");
            assert!(points.times.windows(2).all(|pair| pair[0] < pair[1]), "{points:?}");
            let velocities = points.velocities.into_iter().flat_map(|all| {
                assert_eq!(all.len(), count);
                all
            });
            let mut values = points.times.into_iter().chain(points.positions).chain(velocities.flatten());
            assert!(values.all(|value| value.abs() <= 1e30));
        }
        Err(error) => check_place(&error, text),
    });
}

const PROFILES: [&str; 3] = [
    "time [ms],velocity [mm/s]\n0,0\n10,5\n20,0\n",
    "acceleration [deg/s2],time [s]\r\n0,0\r\n-90,.5\r\n",
    "time [us],velocity [rpm]\n-1,0\n1e6,5\n",
];

/// The same for a profile, which has a value for each point.
#[test]
fn profiles() {
    fuzz(check!(), 3_000, Splice::text(&PROFILES, WORDS), |text| {
        for read in [read_velocities, read_accelerations] {
            match read(text) {
                Ok(profile) => {
                    assert!(profile.times.len() >= 2 && profile.values.len() == profile.times.len(), "{profile:?}");
                    assert!(profile.times.windows(2).all(|pair| pair[0] < pair[1]), "{profile:?}");
                    assert!(profile.times.into_iter().chain(profile.values).all(|value| value.abs() <= 1e30));
                }
                Err(error) => check_place(&error, text),
            }
        }
    });
}

fn check_place(error: &PointsError, text: &str) {
    assert!(error.line <= text.lines().count().max(1), "{error}");
    let line = text.lines().nth(error.line - 1).unwrap_or("");
    assert!((1..=line.chars().count() + 1).contains(&error.column), "{error}");
}
