//! A master that predicts the motion of the task: the way to the drive is shorter, and the run is measured against the true motion.
use crate::rig::{BUS, MOVE, SCREW, last, peak, run, states, values};
use servobench_trace::Recording;

fn with(more: &str) -> Recording {
    run(&format!("{SCREW}{BUS}motion_cycle = \"20 ms\"\ninterpolation = \"cubic\"\n{more}{MOVE}"))
}

/// Oracle: the run that is not predicted, whose reference is the quintic through the samples of the task, 20 ms later. Ahead of the newest
/// sample the reference is the program itself, not its prediction.
#[test]
fn the_reference_is_the_program_at_the_shorter_delay() {
    let [plain, ahead] = [with(""), with("run_ahead = 1\n")];
    let sooner = plain.moves[0].start - ahead.moves[0].start;
    assert!((sooner - 20e-3).abs() < 1e-9, "{sooner}");
    let [reference, program] = [&plain, &ahead].map(|recording| values(recording, "reference.position"));
    let apart = program.iter().zip(&reference[320..]).map(|(one, other)| (one - other).abs()).fold(0.0, f64::max);
    println!("{apart:.2e} m apart");
    // What a snap of 5000 m/s⁴ that begins within 20 ms is beside a quintic: s·T⁴/384.
    assert!(apart < 5000.0 * 0.02_f64.powi(4) / 384.0 * 1.5, "{apart}");
}

/// What the prediction costs is an error of following: its peak is above that without, and it ends on the target.
#[test]
fn what_it_costs_shows_in_the_following_error() {
    let [plain, ahead] = [with(""), with("run_ahead = 1\n")];
    let [before, after] = [&plain, &ahead].map(|recording| peak(recording, "following_error.load"));
    // 100 m/s³ in 20 ms: 133 µm.
    let parabola = 100.0 * 0.02_f64.powi(3) / 6.0;
    println!("{before:.3e} m, {after:.3e} m ahead: {:.1} j·T³/6", after / parabola);
    assert!(after > parabola && after < 10.0 * parabola, "{after}");
    assert!(before < 0.2 * parabola, "{before}");
    assert!((last(&ahead, "load.position") - 0.25).abs() < 10e-6, "{}", last(&ahead, "load.position"));
    assert!(
        states(&ahead, "link", "interpolation").contains(&"Run2")
            && !states(&ahead, "link", "interpolation").contains(&"Run3")
    );
}
