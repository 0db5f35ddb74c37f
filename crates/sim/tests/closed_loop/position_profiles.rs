//! Position profiles as velocity commands over a bus, off its grid: the positions are met as the plan announces.
use crate::rig;
use servobench_motion::position_profile::Spline;
use servobench_motion::pvt::Knot;
use servobench_scenario::Scenario;
use servobench_sim::Program;
use servobench_trace::Recording;
use std::fmt::Write as _;

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

/// A way to follow the table, the cycle of the bus (ms), and of how many of them that of the motion task is.
struct Case {
    follow: String,
    cycle: f64,
    every: u32,
}

/// The moves of a file, or the calls of blocks, as the table named in them is followed.
fn run(case: &Case, unit: &str, program: impl Fn(&str) -> String) -> (Scenario, Recording) {
    let mut table = "time [s],position [m]\n".to_owned();
    for (t, x) in POINTS {
        let _ = writeln!(table, "{t},{x}");
    }
    let mut file = tempfile::Builder::new().suffix(".csv").tempfile().unwrap_or_else(|error| panic!("{error}"));
    std::io::Write::write_all(&mut file, table.as_bytes()).unwrap_or_else(|error| panic!("{error}"));
    let Case { follow, cycle, every } = case;
    let program = program(&format!("table = {{ file = \"{}\", {follow} }}", file.path().display()));
    let text = format!(
        "
[run]
base_rate = \"16 kHz\"
duration = \"0.7 s\"
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
{program}
",
        cycle * f64::from(*every),
    );
    let scenario = rig::scenario(&text);
    let recording = rig::run(&text);
    (scenario, recording)
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
                let case = Case { follow: follow.clone(), cycle, every };
                let moves = |table: &str| {
                    let wait = |time: f64| format!("[[program]]\nwait = \"{time} ms\"\n");
                    format!("{}[[program]]\n{table}\n{}", wait(pause), wait(30.0))
                };
                let (scenario, recording) = run(&case, unit, moves);
                let announced = Program::new(&scenario).unwrap_or_else(|error| panic!("{error}")).announced();
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

/// MC_PositionProfile tells the drive velocities in its cycles: the same table is met as exactly. By steps along the spline, as the spline
/// followed at that rate announces. Oracle: the drive's velocity summed up.
#[test]
fn a_block_meets_the_positions_with_its_velocities() {
    let calls = |table: &str| {
        format!(
            "[setpoint]\norder = 2\nvelocity = \"2 m/s\"\nacceleration = \"40 m/s2\"\n[plc]\nhoming_required = false\n[[call]]\nblock = \
             \"MC_Power\"\nname = \"power\"\n[[call]]\nblock = \"MC_PositionProfile\"\nstart = \"power.Status\"\n{table}\n"
        )
    };
    let mut knots = POINTS.map(|(t, x)| Knot::new(t, x));
    let mut scratch = [0.0; POINTS.len()];
    let spline = Spline::solve(&mut knots, 0.0, 0.0, &mut scratch).unwrap_or_else(|error| panic!("{error}"));
    for (cycle, every) in [(1.0, 1), (1.0, 4), (0.5, 1), (2.0, 1)] {
        let period = 1e-3 * cycle * f64::from(every);
        for (follow, rate) in [
            ("follow = \"plateaus\", plateau_share = \"auto\"", None),
            ("follow = \"plateaus\", plateau_share = 0.4321", None),
            ("follow = \"steps\"", Some(1.0 / period)),
            ("follow = \"steps\", command_rate = \"100 Hz\"", Some(100.0)),
        ] {
            let case = Case { follow: follow.to_owned(), cycle, every };
            let (_, recording) = run(&case, "units = { drive = 1, axis = \"1 um\" }", calls);
            let [at_points, at_all] = missed(&recording, 0.0, spline.table().knots(), &spline);
            let what = format!("{follow}, {cycle} ms × {every}");
            println!("{what}: {at_points:.3e} m at the points, {at_all:.3e} m off the spline");
            match rate {
                None => assert!(at_points < 2e-7, "{what}: {at_points} m at the points"),
                Some(rate) => {
                    let announced = spline.stepped(rate).map_or(f64::NAN, |stepped| stepped.largest_error());
                    assert!(at_all < 1.2 * announced + 2e-7, "{what}: {at_all} m, {announced} m announced");
                }
            }
        }
    }
}
