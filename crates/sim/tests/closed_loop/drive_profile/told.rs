//! Profile position: targets, to which the drive makes its own profile.
use super::AXIS;
use crate::rig::{peak, run, values};

/// Profile position: the drive plans each move itself. Oracle: a trapezoid by hand, 100 mm at 0.5 m/s and 5 m/s² take
/// 0.1/0.5 + 0.5/5 = 0.3 s, and back again after the pause.
#[test]
fn moves_in_profile_position_are_the_drives_own() {
    let recording = run(&format!(
        "{AXIS}[bus]\ncycle = \"1 ms\"\nmode = \"pp\"\nunits = {{ drive = 1000, axis = \"1 mm\" }}\n\
         [setpoint]\norder = 2\nvelocity = \"0.5 m/s\"\nacceleration = \"5 m/s2\"\n\
         [[program]]\nmove_to = \"100 mm\"\n[[program]]\nwait = \"0.1 s\"\n[[program]]\nmove_by = \"-100 mm\"\n"
    ));
    let (x, v) = (values(&recording, "setpoint.position"), values(&recording, "setpoint.velocity"));
    let moving: Vec<usize> = (0..v.len()).filter(|row| v[*row].abs() > 0.0).collect();
    let ways: Vec<(f64, f64)> = moving
        .chunk_by(|row, next| next - row < 16)
        .map(|rows| (rows.len() as f64 * recording.rate.period(), x[rows[rows.len() - 1]]))
        .collect();
    println!("{ways:?}");
    assert_eq!(ways.len(), 2, "{ways:?}");
    for ((length, end), target) in ways.iter().zip([0.1, 0.0]) {
        assert!((length - 0.3).abs() < 1e-3 && (end - target).abs() < 1e-5, "{ways:?}");
    }
    assert!((peak(&recording, "setpoint.velocity") - 0.5).abs() < 1e-9);
    assert!(peak(&recording, "following_error.motor") < 1e-3);
}

/// In profile position the drive makes its own profile, whatever that of the program is: linear ramps, or jerk-limited ones. Oracle: its
/// set-point, which the request meets to a step of the drive, and by hand 0.1/0.4 + 0.4/4 = 0.35 s for a trapezoid over 100 mm.
#[test]
fn the_request_in_profile_position_is_the_profile_of_the_drive() {
    for (objects, length) in [("", 0.35), ("\"6086h\" = 3\n\"60A4h.1\" = 40000000\n", 0.45)] {
        let recording = run(&format!(
            "{AXIS}[drive.objects]\n{objects}[bus]\ncycle = \"1 ms\"\nmode = \"pp\"\nunits = {{ drive = 1000, axis = \"1 mm\" }}\n\
             [setpoint]\norder = 3\nvelocity = \"0.4 m/s\"\nacceleration = \"4 m/s2\"\njerk = \"90 m/s3\"\n\
             [[program]]\nwait = \"0.1003 s\"\n[[program]]\nmove_to = \"100 mm\"\n[[program]]\nwait = \"0.25 s\"\n\
             [[program]]\nmove_to = \"0 mm\"\n[[program]]\nwait = \"0.3 s\"\n"
        ));
        let [setpoint, request] = ["setpoint.position", "request.position"].map(|name| values(&recording, name));
        let off = setpoint.iter().zip(request).map(|(x, wanted)| (x - wanted).abs()).fold(0.0, f64::max);
        assert!(off < 0.4 * 0.3e-3, "{objects}: {off} m");
        for made in &recording.moves {
            assert!((made.end - made.start - length).abs() < 1e-9, "{objects}: {} s", made.end - made.start);
            let order = if objects.is_empty() { ", order 2" } else { ", order 3" };
            assert!(made.label.ends_with(order), "{}", made.label);
            let begins = recording.index_at(made.start);
            let moves = |row: usize| (setpoint[row] - setpoint[row - 1]).abs() > 0.0;
            assert!(!moves(begins - 2) && moves(begins + 10), "{objects}: it begins at {} s", made.start);
        }
    }
}
