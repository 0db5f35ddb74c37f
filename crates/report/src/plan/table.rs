//! A plan as text.
use super::times::Times;
use super::{NAMES, PlannedMove};
use crate::text::wrapped;
use servobench_motion::Profile;
use servobench_planner::{Peak, Plan};

/// Width of `125.663706 ms`.
const TIME: usize = 13;
const QUANTITY: usize = 16;
/// Characters in a line.
const WIDTH: usize = 80;

/// A peak and its limit (SI); infinite without a limit.
pub(super) struct Kept {
    /// Derivative of position, 1 to 4.
    pub(super) derivative: usize,
    /// `+` or `-` where the limits differ by direction.
    pub(super) side: &'static str,
    pub(super) peak: f64,
    pub(super) limit: f64,
}

impl PlannedMove {
    /// Duration, notes, peaks against limits, segments: in the units in which distance and limits were given,
    /// all times in one unit.
    #[must_use]
    pub fn table(&self) -> String {
        let duration = self.plan.duration();
        let segments = self.profile().into_iter().flat_map(Profile::segments);
        let segments = segments.flat_map(|segment| [segment.start, segment.length]);
        let all = self.dwells().map(|(.., time)| time).chain(segments).chain([duration]);
        let times = Times::new(duration, all);
        let what = self.what(&format!("move of {}", self.show(0, self.distance())));
        let mut lines = wrapped(&format!("{what} in {}, {}", times.show(duration), self.kind()), WIDTH);
        lines.extend(self.notes().iter().flat_map(|note| wrapped(note, WIDTH)));
        let dwells: Vec<String> = self
            .dwells()
            .map(|(name, meaning, value)| format!("{name}  {:>TIME$}   {meaning}", times.show(value)))
            .collect();
        let blocks = [dwells, self.peaks_against_limits(), self.rows()];
        for block in blocks.into_iter().filter(|block| !block.is_empty()) {
            lines.push(String::new());
            lines.extend(block);
        }
        lines.join("\n") + "\n"
    }

    fn peaks_against_limits(&self) -> Vec<String> {
        let kept = self.kept();
        let is_limited = kept.iter().any(|kept| kept.limit.is_finite());
        let mut lines = vec![if is_limited {
            format!("{:<13} {:>QUANTITY$} {:>QUANTITY$} {:>9}", "", "peak", "limit", "of limit")
        } else {
            format!("{:<13} {:>QUANTITY$}", "", "peak")
        }];
        lines.extend(kept.iter().map(|Kept { derivative, side, peak, limit }| {
            let name = format!("{side}{}", NAMES[*derivative]);
            let line = format!("{name:<13} {:>QUANTITY$}", self.show(*derivative, *peak));
            if limit.is_finite() {
                let share = 100.0 * peak / limit;
                format!("{line} {:>QUANTITY$} {share:>7.2} %", self.show(*derivative, *limit))
            } else if is_limited {
                format!("{line} {:>QUANTITY$}", "none")
            } else {
                line
            }
        }));
        lines
    }

    /// Largest magnitudes of velocity and higher derivatives with their limits, by direction where the limits differ.
    pub(super) fn kept(&self) -> Vec<Kept> {
        kept(&self.plan)
    }
}

/// Peaks and limits of any plan.
pub(super) fn kept(plan: &Plan) -> Vec<Kept> {
    let mut all = Vec::new();
    let peaks = plan.peaks().into_iter().zip(plan.largest()).zip(plan.limits()).take(plan.order());
    for (i, ((Peak { lowest, highest }, largest), limit)) in peaks.enumerate() {
        let derivative = i + 1;
        if limit.above.to_bits() == limit.below.to_bits() {
            all.push(Kept { derivative, side: "", peak: largest, limit: limit.above });
        } else {
            all.push(Kept { derivative, side: "+", peak: highest, limit: limit.above });
            all.push(Kept { derivative, side: "-", peak: -lowest, limit: limit.below });
        }
    }
    all
}

#[cfg(test)]
mod tests {
    use super::super::{PlannedMove, moves};
    use servobench_base::Setpoint;
    use servobench_motion::online::{DirectionalLimits, Effort, Sides, Target};
    use servobench_motion::pvt::Knot;
    use servobench_motion::rockwell::{Jerk, MaximumJerk, Move, Shape};
    use servobench_motion::sampled::Execution;
    use servobench_motion::shape::Shaper;
    use servobench_motion::{Limits, Order};
    use servobench_planner::{
        Averages, CommandRate, Filter, Follow, Generator, Grid, Method, PointToPoint, Replanning, Request, Rockwell,
        Sampling, Shaping, TableMove, Velocities,
    };
    use std::f64::consts::TAU;

    /// The table; each line must fit the screen.
    fn table(plan: &PlannedMove) -> String {
        let table = plan.table();
        assert!(table.lines().all(|line| line.chars().count() <= 80), "{table}");
        table
    }

    /// 90° at 60 rpm and 50 rad/s²: the triangle peaks at √(π/2·50) rad/s = 8.862 rad/s, above 2π rad/s, so it cruises.
    #[test]
    fn units_are_those_of_the_user() {
        let limits = Limits { velocity: TAU, acceleration: 50.0, jerk: f64::INFINITY, snap: f64::INFINITY };
        let (order, method, distance) = (Order::Second, Method::Published, -TAU / 4.0);
        let asked = PointToPoint { distance, order, limits, method, grid: None };
        let plan = PlannedMove::new(Request::new(Generator::PointToPoint(asked)), "rad").unwrap();
        let plan = plan.as_given(0, "-90 deg", distance).as_given(1, "60 rpm", TAU).as_given(2, "50 rad/s2", 50.0);
        insta::assert_snapshot!(table(&plan), @r#"
        move of -90 deg in 375.663706 ms, order 2

        t_a  125.663706 ms   acceleration at its peak
        t_v  124.336294 ms   velocity at its peak

                                  peak            limit  of limit
        velocity                60 rpm           60 rpm  100.00 %
        acceleration         50 rad/s2        50 rad/s2  100.00 %

                start        length  acceleration
          0.000000 ms 125.663706 ms  -50 rad/s2
        125.663706 ms 124.336294 ms  0 rad/s2
        250.000000 ms 125.663706 ms  50 rad/s2
        "#);
    }

    #[test]
    fn the_published_move() {
        insta::assert_snapshot!(table(&moves::sampled(1e-3)), @r#"
        move of 1.00 m in 1.35 s, order 4
        1350 samples of 1 ms

        t_d         0.05 s   snap at its peak
        t_j         0.05 s   jerk at its peak
        t_a         0.05 s   acceleration at its peak
        t_v         0.65 s   velocity at its peak

                                  peak            limit  of limit
        velocity              1.00 m/s         1.00 m/s  100.00 %
        acceleration         5.00 m/s²        5.00 m/s²  100.00 %
        jerk                 50.0 m/s³        50.0 m/s³  100.00 %
        snap                 1000 m/s⁴        1000 m/s⁴  100.00 %

                start        length  snap
               0.00 s        0.05 s  1000 m/s⁴
               0.05 s        0.05 s  0 m/s⁴
               0.10 s        0.05 s  -1000 m/s⁴
               0.15 s        0.05 s  0 m/s⁴
               0.20 s        0.05 s  -1000 m/s⁴
               0.25 s        0.05 s  0 m/s⁴
               0.30 s        0.05 s  1000 m/s⁴
               0.35 s        0.65 s  0 m/s⁴
               1.00 s        0.05 s  -1000 m/s⁴
               1.05 s        0.05 s  0 m/s⁴
               1.10 s        0.05 s  1000 m/s⁴
               1.15 s        0.05 s  0 m/s⁴
               1.20 s        0.05 s  1000 m/s⁴
               1.25 s        0.05 s  0 m/s⁴
               1.30 s        0.05 s  -1000 m/s⁴
        "#);
    }

    /// (384/512)^¼ of the time, where snap alone binds.
    #[test]
    fn the_shortest_move_says_what_it_gained() {
        let (order, method) = (Order::Fourth, Method::Optimal);
        let asked = PointToPoint { distance: 1e-3, order, limits: moves::LAMBRECHTS, method, grid: None };
        insta::assert_snapshot!(table(&moves::of(Generator::PointToPoint(asked))), @r#"
        move of 1.00 mm in 139.98542 ms, order 4, optimal
        6.94 % shorter than the published profile (150.424 ms)

                                  peak            limit  of limit
        velocity             16.7 mm/s         1.00 m/s    1.67 %
        acceleration         420 mm/s²        5.00 m/s²    8.41 %
        jerk                 29.0 m/s³        50.0 m/s³   57.98 %
        snap                 1000 m/s⁴        1000 m/s⁴  100.00 %

                start        length  snap
           0.00000 ms   20.50039 ms  1000 m/s⁴
          20.50039 ms   49.49232 ms  -1000 m/s⁴
          69.99271 ms   49.49232 ms  1000 m/s⁴
         119.48503 ms   20.50039 ms  -1000 m/s⁴
        "#);
    }

    /// The example of the generator: 50 samples instead of 56.
    #[test]
    fn the_shortest_sampled_move_says_that_it_is() {
        let grid = Some(Grid { sample_time: 5e-3, sampling: Sampling::Published, execution: Execution::ExactHold });
        let (order, method) = (Order::Fourth, Method::Optimal);
        let asked = PointToPoint { distance: 0.01, order, limits: moves::LAMBRECHTS, method, grid };
        insta::assert_snapshot!(table(&moves::of(Generator::PointToPoint(asked))), @r#"
        move of 10.0 mm in 250 ms, order 4, optimal
        50 samples of 5 ms
        proven: no move of fewer samples reaches the distance
        10.71 % shorter than the published profile (280 ms)

                                  peak            limit  of limit
        velocity             93.7 mm/s         1.00 m/s    9.37 %
        acceleration         1.32 m/s²        5.00 m/s²   26.36 %
        jerk                 49.3 m/s³        50.0 m/s³   98.69 %
        snap                  987 m/s⁴        1000 m/s⁴   98.69 %

                start        length  snap
                 0 ms         35 ms  987 m/s⁴
                35 ms          5 ms  -348 m/s⁴
                40 ms         80 ms  -987 m/s⁴
               120 ms          5 ms  -639 m/s⁴
               125 ms          5 ms  639 m/s⁴
               130 ms         80 ms  987 m/s⁴
               210 ms          5 ms  348 m/s⁴
               215 ms         35 ms  -987 m/s⁴
        "#);
    }

    #[test]
    fn the_cascade_says_how_late_it_is() {
        let table = table(&moves::executed(1e-3, Execution::ForwardEuler));
        insta::assert_snapshot!(table.lines().take(4).collect::<Vec<_>>().join("\n"), @r#"
        move of 1.00 m in 1.35 s, order 4
        1350 samples of 1 ms
        forward-Euler cascade: 1.5 ms behind the exact hold on the way
        "#);
    }

    #[test]
    fn a_transition_says_from_where_to_where_and_its_limits_by_direction() {
        let limits = DirectionalLimits {
            velocity: Sides { below: 0.8, above: 1.0 },
            acceleration: Sides { below: 4.0, above: 5.0 },
            jerk: 50.0,
            snap: 1000.0,
        };
        let generator = |v: f64| {
            let from = Setpoint { x: 0.1, v, a: 1.0, j: -5.0, s: 0.0 };
            let (target, order, effort) = (Target::Position { x: -0.5, v: -0.2 }, Order::Fourth, Effort::Refined);
            Generator::Replanning(Replanning { from, target, order, limits, effort })
        };
        insta::assert_snapshot!(table(&moves::of(generator(0.4))), @r#"
        move of -600 mm in 1.212321295 s, order 4, online refined
        from 100 mm, 400 mm/s, 1.00 m/s², -5.00 m/s³ to -500 mm, -200 mm/s

                                  peak            limit  of limit
        +velocity             425 mm/s         1.00 m/s   42.53 %
        -velocity             800 mm/s         800 mm/s  100.00 %
        +acceleration        4.37 m/s²        5.00 m/s²   87.36 %
        -acceleration        4.00 m/s²        4.00 m/s²  100.00 %
        jerk                 50.0 m/s³        50.0 m/s³  100.00 %
        snap                 1000 m/s⁴        1000 m/s⁴  100.00 %

                start        length  snap
        0.000000000 s 0.045000000 s  -1000 m/s⁴
        0.045000000 s 0.050250000 s  0 m/s⁴
        0.095250000 s 0.050000000 s  1000 m/s⁴
        0.145250000 s 0.177630599 s  0 m/s⁴
        0.322880599 s 0.050000000 s  1000 m/s⁴
        0.372880599 s 0.030000000 s  0 m/s⁴
        0.402880599 s 0.050000000 s  -1000 m/s⁴
        0.452880599 s 0.484718646 s  0 m/s⁴
        0.937599245 s 0.050000000 s  1000 m/s⁴
        0.987599245 s 0.037361025 s  0 m/s⁴
        1.024960270 s 0.100000000 s  -1000 m/s⁴
        1.124960270 s 0.037361025 s  0 m/s⁴
        1.162321295 s 0.050000000 s  1000 m/s⁴
        "#);
        let beyond = table(&moves::of(generator(1.2)));
        assert!(beyond.contains("% beyond its limits: its initial state cannot be left within them"), "{beyond}");
    }

    /// A²/V·(200/% − 1): 160·7 m/s³ and 640·1 m/s³.
    #[test]
    fn a_rockwell_move_says_its_jerks() {
        let operands = Move {
            distance: 0.01,
            speed: 0.1,
            acceleration: 4.0,
            deceleration: 8.0,
            shape: Shape::SCurve { acceleration: Jerk::PercentOfTime(25.0), deceleration: Jerk::PercentOfTime(100.0) },
        };
        let maximum = MaximumJerk { acceleration: f64::INFINITY, deceleration: f64::INFINITY };
        insta::assert_snapshot!(table(&moves::of(Generator::Rockwell(Rockwell { operands, maximum }))), @r#"
        move of 10.0 mm in 126.785714 ms, Rockwell S-curve
        jerk 1120 m/s³ of the acceleration, 640 m/s³ of the deceleration

                                  peak            limit  of limit
        velocity              100 mm/s         100 mm/s  100.00 %
        +acceleration        4.00 m/s²        4.00 m/s²  100.00 %
        -acceleration        8.00 m/s²        8.00 m/s²  100.00 %
        jerk                 1120 m/s³        1120 m/s³  100.00 %

                start        length  jerk
          0.000000 ms   3.571429 ms  1120 m/s³
          3.571429 ms  21.428571 ms  0 m/s³
         25.000000 ms   3.571429 ms  -1120 m/s³
         28.571429 ms  73.214286 ms  0 m/s³
        101.785714 ms  12.500000 ms  -640 m/s³
        114.285714 ms  12.500000 ms  640 m/s³
        "#);
    }

    fn knots(count: u32) -> Vec<Knot> {
        (0..count).map(|k| Knot::new(0.01 * f64::from(k), 1e-3 * f64::from(k * k % 7))).collect()
    }

    #[test]
    fn a_long_table_shows_its_ends() {
        let asked = TableMove { knots: knots(1000), velocities: Velocities::Average, follow: Follow::Segments };
        insta::assert_snapshot!(table(&moves::of(Generator::Table(asked))), @r#"
        move of 4.00 mm through 1000 points in 9.99 s, PVT
        velocities by the average rule

                                  peak
        velocity              393 mm/s
        acceleration          120 m/s²

                 time         position         velocity     acceleration
               0.00 s              0 m            0 m/s        20.0 m/s²
               0.01 s          1.00 mm         200 mm/s        90.0 m/s²
               0.02 s          4.00 mm        50.0 mm/s        -120 m/s²
               0.03 s          2.00 mm        -100 mm/s        20.0 m/s²
               0.04 s          2.00 mm         100 mm/s        90.0 m/s²
               0.05 s          4.00 mm       -50.0 mm/s        -120 m/s²
               0.06 s          1.00 mm        -200 mm/s        20.0 m/s²
               0.07 s              0 m            0 m/s        20.0 m/s²
               0.08 s          1.00 mm         200 mm/s        90.0 m/s²
               0.09 s          4.00 mm        50.0 mm/s        -120 m/s²
               0.10 s          2.00 mm        -100 mm/s        20.0 m/s²
               0.11 s          2.00 mm         100 mm/s        90.0 m/s²
                    … 984 points more
               9.96 s          4.00 mm        50.0 mm/s        -120 m/s²
               9.97 s          2.00 mm        -100 mm/s        20.0 m/s²
               9.98 s          2.00 mm         100 mm/s        80.0 m/s²
               9.99 s          4.00 mm            0 m/s           0 m/s²
        "#);
    }

    #[test]
    fn a_position_profile_lists_its_commands() {
        let generator = |follow| Generator::Table(TableMove { knots: knots(5), velocities: Velocities::Given, follow });
        insta::assert_snapshot!(table(&moves::of(generator(Follow::Plateaus { share: 0.25.into() }))), @r#"
        move of 2.00 mm through 5 points in 40 ms, position profile
        5 velocity commands, α = 0.25: every position is hit

                                  peak
        velocity              354 mm/s
        acceleration          122 m/s²

              sent at         velocity     acceleration
               0.0 ms        95.8 mm/s        38.3 m/s²
               7.5 ms         354 mm/s        51.7 m/s²
              17.5 ms        -255 mm/s         122 m/s²
              27.5 ms        19.6 mm/s        55.0 m/s²
              37.5 ms            0 m/s        7.85 m/s²
        "#);
        let steps = table(&moves::of(generator(Follow::Steps { rate: CommandRate::Given(100.0) })));
        insta::assert_snapshot!(steps.lines().take(3).collect::<Vec<_>>().join("\n"), @r#"
        move of 1.71 mm through 5 points in 40 ms, position profile
        4 velocity commands at 100 Hz: at most 893 µm off the cubic spline
        "#);
    }

    #[test]
    fn filters_say_what_they_cost() {
        let zvd = |frequency| Shaping { shaper: Shaper::Zvd, frequency, damping: 0.0 };
        let averages = Some(Averages { lengths: vec![0.01, 0.005], sample_time: 1e-3 });
        let (order, method) = (Order::Third, Method::Published);
        let asked = PointToPoint { distance: 0.3, order, limits: moves::LAMBRECHTS, method, grid: None };
        let request = Request { duration: Some(1.0), ..Request::new(Generator::PointToPoint(asked)) };
        let behind = |filter| table(&PlannedMove::new(Request { filter, ..request.clone() }, "m").unwrap());
        insta::assert_snapshot!(behind(Filter { shapers: vec![zvd(10.0)], averages }), @r#"
        move of 300 mm in 1 s, order 3
        1000 samples of 1 ms
        115 ms longer by a shaper of 3 impulses over 100 ms and averages of 10 ms and
        5 ms
        slowed to the duration that was asked for

                                  peak            limit  of limit
        velocity              668 mm/s         1.00 m/s   66.81 %
        acceleration         2.30 m/s²        5.00 m/s²   45.96 %
        jerk                 15.6 m/s³        50.0 m/s³   31.16 %
        "#);
        let two = behind(Filter { shapers: vec![zvd(10.0), zvd(25.0)], averages: None });
        assert!(two.contains("140 ms longer by 2 shapers of 9 impulses over 140 ms"), "{two}");
    }
}
