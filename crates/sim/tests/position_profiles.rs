//! Position profiles as velocity commands over a bus, off its grid: the positions are met as the plan announces.
use servobench_motion::position_profile::Spline;
use servobench_motion::pvt::Knot;
use servobench_plant::Exact;
use servobench_scenario as scenario;
use servobench_sim::{Bench, Outcome, Program};
use servobench_trace::Recording;
use std::fmt::Write as _;
use std::path::Path;

/// Times (s) and positions (m) of the points: no time is a whole number of any cycle.
const POINTS: [(f64, f64); 9] = [
    (0.0, 0.0),
    (0.031_7, 0.001_3),
    (0.083_3, 0.011),
    (0.1217, 0.025),
    (0.190_03, 0.041_7),
    (0.251_9, 0.045),
    (0.299_3, 0.033_3),
    (0.377_7, 0.020_1),
    (0.4543, 0.02),
];

/// A way to follow the table, the cycle of the bus and that of the motion task (ms), and the pause before it (ms).
struct Case {
    follow: String,
    cycle: f64,
    every: u32,
    pause: f64,
}

fn run(case: &Case, unit: &str) -> (scenario::Loaded, Recording) {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../scenarios/plc");
    let mut table = "time [s],position [m]\n".to_owned();
    for (t, x) in POINTS {
        let _ = writeln!(table, "{t},{x}");
    }
    let mut file = tempfile::Builder::new().suffix(".csv").tempfile().unwrap_or_else(|error| panic!("{error}"));
    std::io::Write::write_all(&mut file, table.as_bytes()).unwrap_or_else(|error| panic!("{error}"));
    let Case { follow, cycle, every, pause } = case;
    let text = format!(
        "
[run]
base_rate = \"16 kHz\"
[axis]
model = \"ball-screw\"
[motor]
model = \"wittenstein-premo-1f\"
encoder = {{ counts_per_rev = 1048576 }}
[drive]
model = \"servo-16khz\"
dc_link = \"320 V\"
max_torque = \"6.09 Nm\"
[bus]
cycle = \"{cycle} ms\"
motion_cycle = \"{} ms\"
delay = 1
mode = \"pv\"
{unit}
[[program]]
wait = \"{pause} ms\"
[[program]]
table = {{ file = \"{}\", {follow} }}
[[program]]
wait = \"30 ms\"
",
        cycle * f64::from(*every),
        file.path().display()
    );
    let loaded = scenario::parse("test", &text, Some(&folder)).unwrap_or_else(|error| panic!("{error}"));
    let bench = Bench::new(&loaded.scenario, &Exact).unwrap_or_else(|error| panic!("{error}"));
    let Outcome { recording, failure } = bench.run(&mut |_| {});
    assert_eq!(failure, None);
    (loaded, recording)
}

/// What the position of the drive's velocity differs from the points at their times, and from the spline at any time.
fn missed(recording: &Recording, pause: f64, knots: &[Knot], spline: &Spline<'_>) -> [f64; 2] {
    let velocity = recording.channel("setpoint.velocity").unwrap_or_else(|| panic!("no channel"));
    let (tick, start) = (recording.rate.period(), recording.moves[0].start);
    // The program's time 0 is on the grid, its pause need not be.
    let powered = recording.index_at(start - 1e-3 * pause);
    let offset = 1e-3 * pause;
    let (mut x, mut next, mut at_points, mut at_all) = (0.0, 0, 0.0_f64, 0.0_f64);
    for (k, pair) in velocity[powered..].windows(2).enumerate() {
        let t = k as f64 * tick - offset;
        let slope = (pair[1] - pair[0]) / tick;
        while let Some(knot) = knots.get(next).filter(|knot| knot.t < t + tick) {
            let passed = (knot.t - t).max(0.0);
            at_points = at_points.max((x + passed * (pair[0] + 0.5 * passed * slope) - knot.x).abs());
            next += 1;
        }
        if (0.0..=knots[knots.len() - 1].t).contains(&t) {
            at_all = at_all.max((x - spline.table().at(t).x).abs());
        }
        x += tick * f64::midpoint(pair[0], pair[1]);
    }
    assert_eq!(next, knots.len());
    [at_points, at_all]
}

/// 24 shares of plateaus and 24 rates of commands over cycles that divide neither them nor the times of the points nor the pause before.
/// Oracle: the drive's velocity summed up.
#[test]
fn positions_are_met_as_announced_at_any_share_and_rate() {
    let shares = [0.25, 0.1, 0.3, 0.5, 0.01, 0.4321];
    let rates = [100.0, 300.0, 333.0, 70.7, 1500.0, 4000.0];
    let cycles = [(1.0, 1, 100.0), (1.0, 4, 100.3), (0.5, 1, 77.77), (2.0, 1, 51.3)];
    let mut knots = POINTS.map(|(t, x)| Knot::new(t, x));
    let mut scratch = [0.0; POINTS.len()];
    let spline = Spline::solve(&mut knots, 0.0, 0.0, &mut scratch).unwrap_or_else(|error| panic!("{error}"));
    let mut worst = 0.0_f64;
    for (cycle, every, pause) in cycles {
        let plateaus = shares.map(|share| format!("follow = \"plateaus\", plateau_share = {share}"));
        let steps = rates.map(|rate| format!("follow = \"steps\", command_rate = \"{rate} Hz\""));
        for (follow, is_spline) in plateaus.map(|follow| (follow, false)).into_iter().chain(steps.map(|f| (f, true))) {
            // In increments of the encoder, 9.5 nm, 32 bits hold up to 41 m/s².
            let units = ["units = { drive = 1, axis = \"1 um\" }", "units = { drive = 7, axis = \"1 um\" }", ""];
            for unit in &units[..if follow.ends_with("0.01") || follow.ends_with("0.1") { 2 } else { 3 }] {
                let case = Case { follow: follow.clone(), cycle, every, pause };
                let (loaded, recording) = run(&case, unit);
                let announced = Program::new(&loaded.scenario).unwrap_or_else(|error| panic!("{error}")).announced();
                let announced = announced.iter().flatten().copied().fold(0.0, f64::max);
                let [at_points, at_all] = missed(&recording, pause, spline.table().knots(), &spline);
                let measured = if is_spline { at_all } else { at_points };
                let what = format!("{follow}, {cycle} ms × {every}, pause {pause} ms, {unit}");
                println!(
                    "{what}: {at_points:.3e} m at the points, {at_all:.3e} m off the spline, {announced:.3e} m announced"
                );
                assert!(at_points <= announced + 1e-9, "{what}: {at_points} m, {announced} m announced");
                let is_close = (announced - measured).abs() <= (0.1 * measured).max(1e-9);
                assert!(is_close, "{what}: {measured} m, {announced} m announced");
                worst = worst.max(if is_spline { 0.0 } else { at_points });
            }
        }
    }
    println!("plateaus: {worst:.2e} m at worst");
}
