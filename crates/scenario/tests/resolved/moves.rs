//! Moves and their limits.
use super::*;

#[test]
fn moves_take_what_they_do_not_say_from_the_set_point() {
    let text = format!(
        "{SCREW}{}",
        r#"
[setpoint]
order = 4
velocity = "30 m/min"
acceleration = "5 m/s2"
jerk = "50 m/s3"
snap = "1000 m/s4"
sample_time = "1 ms"
[[program]]
move_to = "250 mm"
[[program]]
wait = "0.2 s"
[[program]]
move_by = "-50 mm"
order = 3
velocity = "100 mm/s"
duration = "2 s"
"#
    );
    // The third step leaves `snap` unused, which is worth a warning.
    let loaded = parse("test.toml", &text, None).unwrap();
    assert_eq!(loaded.warnings.len(), 1, "{:?}", loaded.warnings);
    let [Step::Move(first), Step::Wait(pause), Step::Move(second)] = loaded.scenario.program.as_slice() else {
        panic!()
    };
    for (step, distance, positioning, order, duration, limits) in [
        (first, 0.25, Positioning::Absolute, 4, None, [0.5, 5.0, 50.0, 1000.0]),
        (second, -0.05, Positioning::Relative, 3, Some(2.0), [0.1, 5.0, 50.0, f64::INFINITY]),
    ] {
        let generator = &step.request.generator;
        assert_eq!((generator.distance(), step.positioning), (Some(distance), positioning));
        assert_eq!((generator.order(), step.request.duration), (order, duration));
        assert_eq!(generator.limits().map(f64::to_bits), limits.map(f64::to_bits));
    }
    assert_eq!(grid(first), Grid::new(0.001));
    assert!(same(*pause, 0.2));
}

/// Every kind of move, and the keys that steps inherit from `[setpoint]`.
#[test]
fn moves_of_every_family() {
    let folder = tempfile::tempdir().unwrap();
    std::fs::write(
        folder.path().join("points.csv"),
        "time [ms],position [mm],velocity [mm/s]\n0,0,\n10,5,500\n20,15,\n",
    )
    .unwrap();
    let text = format!(
        "{SCREW}{}",
        r#"
[setpoint]
order = 4
velocity = "30 m/min"
acceleration = "5 m/s2"
jerk = "50 m/s3"
snap = "1000 m/s4"
method = "optimal"
negative_velocity = "20 m/min"
shaper = { kind = "ei", frequency = "17.5 Hz", damping = 0.02 }
averages = ["10 ms", "5 ms"]
interpolation = { mode = "quintic-b-spline", period = "4 ms" }
[[program]]
move_to = "250 mm"
[[program]]
move_to = "50 mm"
aborts_after = "0.1 s"
end_velocity = "-5 m/min"
shaper = { kind = "none" }
averages = []
[[program]]
reach_velocity = "6 m/min"
online = "refined"
hold = "0.2 s"
order = 3
shaper = { kind = "none" }
averages = []
[[program]]
move_to = "0 mm"
shaper = { kind = "none" }
averages = []
[[program]]
table = { file = "points.csv", relative = true, velocities = "smooth", passes = 5 }
[[program]]
table = { file = "points.csv", relative = true, follow = "steps", command_rate = "200 Hz" }
shaper = { kind = "none" }
averages = []
[[program]]
move_by = "10 mm"
rockwell = { shape = "s-curve", deceleration = "8 m/s2", jerk_of_time = "25 %", deceleration_jerk_of_maximum = 0.5, maximum_jerk = "400 m/s3" }
"#
    );
    let scenario = parse("test.toml", &text, Some(folder.path())).unwrap_or_else(|e| panic!("{e}")).scenario;
    let period = 4e-3;
    assert_eq!(scenario.interpolation, Some(Interpolation { mode: Mode::QuinticBSpline, period }));
    let moves = scenario.program.iter().filter_map(|step| match step {
        Step::Move(step) => Some(step),
        Step::Wait(_) => None,
    });
    let moves: Vec<_> = moves.collect();
    let [rest, passing, turning, home, through, steps, rockwell] = moves.as_slice() else { panic!("{moves:?}") };

    let generator = |step: &MoveStep| step.request.generator.clone();
    let (order, limits) = (Order::Fourth, Limits { velocity: 0.5, acceleration: 5.0, jerk: 50.0, snap: 1000.0 });
    let method = Method::Optimal;
    let expected = PointToPoint { distance: 0.25, order, limits, method, grid: None };
    assert_eq!(generator(rest), Generator::PointToPoint(expected));
    let shaper = Shaping { shaper: Shaper::Ei { tolerable: 0.05 }, frequency: 17.5, damping: 0.02 };
    let averages = Averages { lengths: vec![0.01, 0.005], sample_time: scenario.base_rate.period() };
    assert_eq!(rest.request.filter, Filter { shapers: vec![shaper], averages: Some(averages) });
    assert_eq!((rest.aborts_after, passing.aborts_after), (None, Some(0.1)));
    assert_eq!(passing.request.filter, Filter::NONE);
    let online = |target, order, effort| {
        let snap = if order == Order::Fourth { limits.snap } else { f64::INFINITY };
        let velocity = Sides { above: limits.velocity, below: 20.0 / 60.0 };
        let limits = DirectionalLimits { velocity, snap, ..limits.into() };
        Generator::Replanning(Replanning { from: Setpoint::default(), target, order, limits, effort })
    };
    let to = |x, v| online(Target::Position { x, v }, Order::Fourth, Effort::Fast);
    assert_eq!(generator(passing), to(0.05, -5.0 / 60.0));
    assert_eq!(generator(turning), online(Target::Velocity(0.1), Order::Third, Effort::Refined));
    assert_eq!((passing.hold, turning.hold), (0.0, 0.2));
    assert!([passing, turning].iter().all(|step| step.request.generator.ends_in_motion()));
    // No key of its own requires it: the move before ends in motion.
    assert_eq!(generator(home), to(0.0, 0.0));

    let knots = vec![Knot::new(0.0, 0.0), Knot::moving(0.01, 0.005, 0.5), Knot::new(0.02, 0.015)];
    let table = |velocities, follow| Generator::Table(TableMove { knots: knots.clone(), velocities, follow });
    assert_eq!(generator(through), table(Velocities::Smooth { passes: 5 }, Follow::Segments));
    assert_eq!(generator(steps), table(Velocities::Given, Follow::Steps { rate: CommandRate::Given(200.0) }));
    assert_eq!([through, steps].map(|step| step.request.generator.order()), [3, 2]);
    let shape = Shape::SCurve { acceleration: Jerk::PercentOfTime(25.0), deceleration: Jerk::PercentOfMaximum(50.0) };
    let operands = Move { distance: 0.01, speed: 0.5, acceleration: 5.0, deceleration: 8.0, shape };
    let maximum = MaximumJerk { acceleration: 400.0, deceleration: 400.0 };
    assert_eq!(generator(rockwell), Generator::Rockwell(Rockwell { operands, maximum }));
    let positioning = moves.iter().map(|step| step.positioning == Positioning::Absolute);
    assert!(positioning.eq([true, true, false, true, false, false, false]));
}

/// One shaper is a table, several are a list, and "none" is omitted from it.
#[test]
fn shapers_of_several_modes() {
    let zv = Shaping { shaper: Shaper::Zv, frequency: 17.5, damping: 0.0 };
    let humps = Shaping { shaper: Shaper::ThreeHumpEi { tolerable: 0.02 }, frequency: 40.0, damping: 0.01 };
    let both = r#"[{ kind = "zv", frequency = "17.5 Hz" }, { kind = "3hump-ei", frequency = "40 Hz", damping = 0.01, tolerable = "2 %" }]"#;
    let move_of = |setpoint: &str, step: &str, set: &[&str]| {
        let text = format!(
            "{SCREW}[setpoint]\norder = 2\nvelocity = \"30 m/min\"\nacceleration = \"5 m/s2\"\n{setpoint}\n[[program]]\n\
             move_to = \"1 mm\"\n{step}"
        );
        let overrides: Vec<Override> = set.iter().map(|one| one.parse().unwrap()).collect();
        let loaded = Document::parse("test.toml", &text, None, None)
            .and_then(|document| document.scenario(&overrides))
            .unwrap_or_else(|e| panic!("{e}"));
        let Some(Step::Move(step)) = loaded.scenario.program.first() else { panic!() };
        step.request.filter.shapers.clone()
    };
    let setpoint = format!("shaper = {both}");
    assert_eq!(move_of(&setpoint, "", &[]), [zv, humps]);
    assert_eq!(move_of("", &setpoint, &[]), [zv, humps]);
    let tables = "[[setpoint.shaper]]\nkind = \"zv\"\nfrequency = \"17.5 Hz\"\n[[setpoint.shaper]]\nkind = \"none\"";
    assert_eq!(move_of(tables, "", &[]), [zv]);
    assert_eq!(move_of(&setpoint, "shaper = { kind = \"none\" }", &[]), []);
    assert_eq!(move_of(&setpoint, "shaper = [{ kind = \"none\" }]", &[]), []);
    let zvd = Shaping { shaper: Shaper::Zvd, frequency: 20.0, ..zv };
    assert_eq!(
        move_of(&setpoint, "", &["setpoint.shaper.0.kind=zvd", "setpoint.shaper[0].frequency=20 Hz"]),
        [zvd, humps]
    );
    let without = setpoint.replace(", tolerable = \"2 %\"", "");
    assert_eq!(move_of(&without, "", &["setpoint.shaper.1.kind=none"]), [zv]);
    assert_eq!(move_of("", "", &["setpoint.shaper.kind=zvd", "setpoint.shaper.frequency=20 Hz"]), [zvd]);
    assert_eq!(move_of(&setpoint, "", &["setpoint.shaper={ kind = \"zvd\", frequency = \"20 Hz\" }"]), [zvd]);
}

#[test]
fn limits_keep_their_order_and_their_meaning() {
    let text = format!(
        "{SCREW}{}",
        r#"
[limits]
torque_peak = "5 Nm"
current_peak = "10 Arms"
current_rms = "10 Arms"
following_error_cruise_load = { min = "0.4 mm", max = "0.5 mm" }
residual_vibration_damping = "5 %"
setpoint_jerk_ratio = 1
"#
    );
    let limit = |metric: &str, min, max| Limit { metric: metric.parse().unwrap(), min, max: Some(max) };
    let limits = scenario(&text).limits;
    assert!(same(limits[2].max.unwrap(), 10.0), "an effective value is judged as one");
    assert!(same(limits[1].max.unwrap(), 10.0 * 2_f64.sqrt()), "a peak as one");
    assert_eq!(limits[0], limit("torque_peak", None, 5.0));
    assert_eq!(
        limits[3..],
        [
            limit("following_error_cruise_load", Some(4e-4), 5e-4),
            limit("residual_vibration_damping", None, 0.05),
            limit("setpoint_jerk_ratio", None, 1.0),
        ]
    );
}
