//! Position profiles for a drive with commands at the instants of a clock.
use crate::random::Random;
use servobench_motion::position_profile::{
    Clock, ClockedPlateaus, ClockedSpline, Command, PlateauShare, Plateaus, Spline,
};
use servobench_motion::pvt::Knot;

/// Position at `t` of a drive that obeys the commands from `x` at velocity `v` and time `start` on.
fn place(commands: &[Command], [start, x, v]: [f64; 3], t: f64) -> f64 {
    let (mut x, mut v, mut now) = (x, v, start);
    for (k, command) in commands.iter().enumerate() {
        x += v * (command.t.min(t) - now).max(0.0);
        now = command.t.max(now);
        let until = commands.get(k + 1).map_or(t, |next| next.t.min(t));
        let time = (until - now).max(0.0);
        let way = (command.velocity - v).abs();
        let ramp = if way > 0.0 { way / command.acceleration } else { 0.0 };
        let part = time.min(ramp);
        let reached = if part < ramp { v + (command.velocity - v) * part / ramp } else { command.velocity };
        x += f64::midpoint(v, reached) * part + reached * (time - part);
        (v, now) = (reached, now.max(until));
    }
    x
}

/// A table that begins and ends at any time, with segments of `shortest` to ten times that (s).
fn table(random: &mut Random, shortest: f64) -> Vec<Knot> {
    let (mut t, mut x) = (random.unit() - 0.5, random.unit());
    let mut knots = vec![Knot::new(t, x)];
    for _ in 0..3 + random.next() % 12 {
        t += shortest * (1.0 + 9.0 * random.unit());
        x += 0.1 * (random.unit() - 0.5);
        knots.push(Knot::new(t, x));
    }
    knots
}

fn is_whole(periods: f64) -> bool {
    (periods - periods.round()).abs() < 1e-6
}

/// Every position is met at its own time, anywhere between two instants, by commands at instants whose ramps end at instants.
/// Oracle: a drive that obeys. Roundings of a metre, added up over the segments, and of the times.
#[test]
fn plateaus_meet_every_position_at_any_share_and_period() {
    let mut random = Random::seeded(175);
    for case in 0..2000 {
        let period = 1e-4 * (1.0 + 99.0 * random.unit());
        // The first and the last segment have space for a separate ramp beside that of the next point.
        let original = table(&mut random, 3.0 * period);
        let alpha = [0.25, 0.5, 0.01, 0.5 * random.unit().max(1e-9)][case % 4];
        let [start, end] = [random.unit() - 0.5, random.unit() - 0.5].map(|v| if case % 3 == 0 { 0.0 } else { v });
        let clock = Clock::new(random.unit(), period).unwrap();
        let (mut knots, mut scratch) = (original.clone(), vec![0.0; original.len()]);
        let plateaus = ClockedPlateaus::solve(&mut knots, start, end, alpha, clock, &mut scratch).unwrap();
        assert_eq!(plateaus.knots().len(), original.len(), "case {case}");
        let commands: Vec<Command> = plateaus.commands().collect();
        assert_eq!(commands.len(), original.len());
        let first = plateaus.knots()[0].t;
        let mut before = start;
        for (k, command) in commands.iter().enumerate() {
            let ramp = (command.velocity - before).abs() / command.acceleration;
            assert!(is_whole((command.t - first) / period), "case {case}: {command:?}");
            assert!(command.acceleration == 0.0 || is_whole(ramp / period), "case {case}: {command:?}");
            let until = commands.get(k + 1).map_or(original[original.len() - 1].t, |next| next.t);
            assert!(command.acceleration == 0.0 || command.t + ramp <= until + 1e-9, "case {case}: {command:?}");
            before = command.velocity;
        }
        for knot in &original {
            let x = place(&commands, [original[0].t, original[0].x, start], knot.t);
            assert!((x - knot.x).abs() < 1e-12, "case {case}, α {alpha}: {x} instead of {} at {}", knot.x, knot.t);
        }
    }
}

/// With everything on the grid already, nothing changes.
#[test]
fn plateaus_on_the_grid_are_those_without_one() {
    let knots = [(0.0, 0.0), (0.05, 0.01), (0.15, 0.03), (0.25, -0.02), (0.3, 0.0)].map(|(t, x)| Knot::new(t, x));
    let (mut one, mut other, mut scratch) = (knots, knots, [0.0; 5]);
    let free = Plateaus::solve(&mut one, 0.0, 0.1, 0.2, &mut scratch).unwrap();
    let clock = Clock::new(-3.0, 5e-3).unwrap();
    let clocked = ClockedPlateaus::solve(&mut other, 0.0, 0.1, 0.2, clock, &mut scratch).unwrap();
    for (one, other) in free.commands().zip(clocked.commands()) {
        let near = |a: f64, b: f64| (a - b).abs() < 1e-12 * (1.0 + a.abs());
        assert!(near(one.t, other.t) && near(one.velocity, other.velocity), "{one:?} {other:?}");
        assert!((one.acceleration - other.acceleration).abs() < 1e-9, "{one:?} {other:?}");
    }
}

/// Points closer to each other than a period cannot all be met: those that are kept are met, and nothing swings around them.
#[test]
fn points_faster_than_the_clock_are_left_out() {
    let mut random = Random::seeded(1500);
    for case in 0..500 {
        let period = 1e-3;
        let original = table(&mut random, 0.05 * period);
        if original[original.len() - 1].t - original[0].t < 4.0 * period {
            continue;
        }
        let original: Vec<Knot> = original.iter().map(|knot| Knot::new(knot.t, (40.0 * knot.t).sin())).collect();
        let (mut knots, mut scratch) = (original.clone(), vec![0.0; original.len()]);
        let clock = Clock::new(0.0, period).unwrap();
        let start = 40.0 * (40.0 * original[0].t).cos();
        let plateaus = ClockedPlateaus::solve(&mut knots, start, 0.0, 0.25, clock, &mut scratch).unwrap();
        let commands: Vec<Command> = plateaus.commands().collect();
        assert!(commands.windows(2).all(|pair| pair[1].t - pair[0].t > 0.999 * period), "case {case}");
        for knot in plateaus.knots() {
            let x = place(&commands, [original[0].t, original[0].x, start], knot.t);
            assert!((x - knot.x).abs() < 1e-12, "case {case}: {x} instead of {}", knot.x);
        }
        assert!(commands.iter().all(|command| command.velocity.abs() < 1000.0), "case {case}: {commands:?}");
    }
}

/// The velocity is the spline's at every command, commands are at instants, at most one at each, and their number is that of the rate.
#[test]
fn steps_along_the_spline_are_at_instants() {
    let mut random = Random::seeded(300);
    for case in 0..300 {
        let period = 1e-4 * (1.0 + 99.0 * random.unit());
        let original = table(&mut random, 3.0 * period);
        let rate = [300.0, 100.0, 1e6, 1.0 / period][case % 4];
        let clock = Clock::new(random.unit(), period).unwrap();
        let (mut knots, mut scratch) = (original.clone(), vec![0.0; original.len()]);
        let steps = ClockedSpline::solve(&mut knots, 0.1, -0.2, rate, clock, &mut scratch).unwrap();
        let commands: Vec<Command> = steps.commands().collect();
        let mut spline = knots.clone();
        let spline = Spline::solve(&mut spline, 0.1, -0.2, &mut scratch).unwrap();
        let (first, last) = (knots[0].t, knots[knots.len() - 1].t);
        assert!(first - original[0].t < period && original[original.len() - 1].t - last < period);
        let expected = ((last - first) * rate.min(1.0 / period) - 1e-6).ceil();
        assert!((commands.len() as f64 - expected).abs() <= 1.0, "case {case}: {} {expected}", commands.len());
        for (k, command) in commands.iter().enumerate() {
            let until = commands.get(k + 1).map_or(last, |next| next.t);
            assert!(is_whole((command.t - first) / period) && until - command.t > 0.999 * period, "case {case}");
            assert!((command.velocity - spline.table().at(until).v).abs() < 1e-9, "case {case}: {command:?}");
        }
    }
}

#[test]
fn what_has_no_instants_is_refused() {
    assert!(Clock::new(0.0, 0.0).is_err() && Clock::new(f64::NAN, 1.0).is_err() && Clock::new(0.0, f64::NAN).is_err());
    let mut knots = [Knot::new(0.0, 0.0), Knot::new(0.0199, 1.0)];
    let clock = Clock::new(0.0, 0.01).unwrap();
    let refused = ClockedPlateaus::solve(&mut knots, 0.0, 0.0, 0.25, clock, &mut [0.0; 2]).unwrap_err();
    let said =
        "`command_cycle` must be so short that at least two and at most 1e9 of them fit into the table, got 0.01";
    assert_eq!(refused.to_string(), said);
    for alpha in [0.0, -0.1, 0.51, f64::NAN, f64::INFINITY] {
        assert!(ClockedPlateaus::solve(&mut knots, 0.0, 0.0, alpha, clock, &mut [0.0; 2]).is_err(), "{alpha}");
    }
    for rate in [0.0, -1.0, f64::NAN, f64::INFINITY] {
        assert!(ClockedSpline::solve(&mut knots, 0.0, 0.0, rate, clock, &mut [0.0; 2]).is_err(), "{rate}");
    }
    assert!(ClockedPlateaus::solve(&mut knots, f64::NAN, 0.0, 0.2, clock, &mut [0.0; 2]).is_err());
}

/// The position of a drive that obeys is given by the piece of any time, and the ramp of any time is the last command that was sent.
/// Oracle: the drive that obeys, and the list of commands.
#[test]
fn a_piece_and_a_ramp_are_found_at_any_time() {
    let mut random = Random::seeded(417);
    for case in 0..300 {
        let period = 1e-4 * (1.0 + 99.0 * random.unit());
        let original = table(&mut random, 3.0 * period);
        let alpha = [0.25, 0.5, 0.01, 0.5 * random.unit().max(1e-9)][case % 4];
        let [start, end] = [random.unit() - 0.5, random.unit() - 0.5];
        let clock = Clock::new(random.unit(), period).unwrap();
        let (mut knots, mut scratch) = (original.clone(), vec![0.0; original.len()]);
        let solved = ClockedPlateaus::solve(&mut knots, start, end, alpha, clock, &mut scratch).unwrap();
        let (plateaus, count) = (solved, solved.knots().len());
        let commands: Vec<Command> = plateaus.commands().collect();
        let [first, last] = [plateaus.knots()[0], plateaus.knots()[count - 1]];
        for _ in 0..100 {
            let t = first.t + (last.t - first.t) * random.unit();
            let piece = plateaus.piece(t);
            let x = place(&commands, [first.t, first.x, start], t);
            assert!(piece.holds(t) && (piece.at(t).x - x).abs() < 1e-11, "case {case} at {t}: {x} {:?}", piece.at(t));
            let sent = commands.iter().rev().find(|command| command.t <= t).unwrap_or(&commands[0]);
            assert_eq!(plateaus.ramp_at(t).command(), *sent, "case {case} at {t}");
        }
        let beyond = plateaus.piece(last.t + 1.0);
        assert!((beyond.at(last.t + 1.0).v - end).abs() < 1e-12 && beyond.ends().is_infinite());
        let ramps: Vec<_> = plateaus.ramps().collect();
        let again = ClockedPlateaus::solved(&knots[..count], end, alpha, clock);
        let near = |one: f64, other: f64| (one - other).abs() < 1e-9 * (1.0 + one.abs());
        for (one, other) in ramps.iter().zip(again.ramps()) {
            assert!(near(one.begin, other.begin) && near(one.length, other.length), "case {case}: {one:?} {other:?}");
            assert_eq!([one.from, one.to].map(f64::to_bits), [other.from, other.to].map(f64::to_bits));
        }
    }
}

/// Oracle: the list of commands, whose velocities are the spline's.
#[test]
fn the_step_of_any_time_is_the_one_sent_last() {
    let mut random = Random::seeded(3017);
    for case in 0..300 {
        let period = 1e-4 * (1.0 + 99.0 * random.unit());
        let original = table(&mut random, 3.0 * period);
        let rate = [300.0, 100.0, 1e6, 1.0 / period, 0.999_999_9 / period, 1.0 / (3.0 * period)][case % 6];
        let clock = Clock::new(random.unit(), period).unwrap();
        let (mut knots, mut scratch) = (original.clone(), vec![0.0; original.len()]);
        let steps = ClockedSpline::solve(&mut knots, 0.1, -0.2, rate, clock, &mut scratch).unwrap();
        let commands: Vec<Command> = steps.commands().collect();
        let kept = steps.table().knots();
        let again = ClockedSpline::solved(kept, rate, clock);
        let (first, last) = (kept[0].t, kept[kept.len() - 1].t);
        let mut instant = first;
        while instant < last - 0.5 * period {
            // At an instant, and anywhere before the next one.
            for t in [instant, instant + 0.99 * random.unit() * period] {
                let sent = commands.iter().rev().find(|sent| sent.t <= t + 1e-6 * period).unwrap();
                for ramp in [steps.ramp_at(t), again.ramp_at(t)] {
                    assert!(
                        (ramp.begin - sent.t).abs() < 1e-9 * period.max(1.0),
                        "case {case} at {t}: {ramp:?} {sent:?}"
                    );
                    assert!((ramp.to - sent.velocity).abs() < 1e-9, "case {case} at {t}: {ramp:?} {sent:?}");
                    assert!(
                        (ramp.command().acceleration - sent.acceleration).abs() < 1e-6,
                        "case {case}: {ramp:?} {sent:?}"
                    );
                }
            }
            instant += period;
        }
    }
}

/// For a single segment from rest to rest, V = p/(T·(1 − α)) and a = V/(α·T): both are the same part of 0.2 m/s and 1 m/s² at α = 0.2.
#[test]
fn the_share_of_one_segment_is_the_one_that_takes_the_smallest_part_of_the_limits() {
    let (mut knots, mut scratch) = (vec![Knot::new(0.0, 0.0), Knot::new(1.0, 0.1)], [0.0; 2]);
    let mut share = |velocity, acceleration| {
        let share = PlateauShare::SmallestPartOf { velocity, acceleration };
        Plateaus::solve(&mut knots, 0.0, 0.0, share, &mut scratch).map(|profile| profile.share())
    };
    assert!((share(0.2, 1.0).unwrap() - 0.2).abs() < 1e-6);
    // The acceleration alone is smallest without a plateau.
    assert!((share(1e3, 1.0).unwrap() - 0.5).abs() < 1e-6);
    for [velocity, acceleration] in [[0.0, 1.0], [1.0, f64::NAN], [f64::INFINITY, 1.0], [1.0, -1.0]] {
        assert!(share(velocity, acceleration).is_err(), "{velocity} {acceleration}");
    }
}

/// Oracle: 2000 shares, none of which needs a smaller part of the limits than the chosen one.
#[test]
fn no_share_takes_a_smaller_part_of_the_limits() {
    let mut random = Random::seeded(2718);
    for case in 0..100 {
        let knots = table(&mut random, 0.05);
        let [start, end] = [random.unit() - 0.5, random.unit() - 0.5];
        let [velocity, acceleration] = [4.0 * (1.0 + random.unit()), 400.0 * (0.1 + random.unit())];
        let clock = Clock::new(0.0, 2e-3).unwrap();
        let mut scratch = vec![0.0; knots.len()];
        for is_clocked in [false, true] {
            let mut part = |share: PlateauShare| {
                let (mut own, scratch) = (knots.clone(), &mut scratch);
                let commands: Vec<Command> = if is_clocked {
                    ClockedPlateaus::solve(&mut own, start, end, share, clock, scratch).unwrap().commands().collect()
                } else {
                    Plateaus::solve(&mut own, start, end, share, scratch).unwrap().commands().collect()
                };
                let parts = commands.iter().map(|c| (c.velocity.abs() / velocity).max(c.acceleration / acceleration));
                parts.fold(start.abs() / velocity, f64::max)
            };
            let chosen = part(PlateauShare::SmallestPartOf { velocity, acceleration });
            let least = (1..=2000).map(|k| part((0.5 * f64::from(k) / 2000.0).into())).fold(f64::MAX, f64::min);
            // Ramps of whole periods jump with the share: the best one may lie between two of the grid.
            let most = if is_clocked { 1.05 } else { 1.0 + 1e-3 };
            assert!(chosen <= most * least, "case {case}, {is_clocked}: {chosen} {least}");
        }
    }
}
