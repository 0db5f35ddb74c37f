//! Conclusions over several runs: one that is dead, unstable or over its limit never wins, is never on a front, and is named.
//!
//! Results are made up from a seed; what a run may win by is decided here once more, by its verdict alone.
use servobench_metrics::Standing;
use servobench_report::{Compared, Comparison, Noise, Style, SweepOptions, sweep_front, sweep_table};
use servobench_results::samples::{of_numbers, requirements};
use servobench_results::{Outcome as Ended, RunResult};
use servobench_sweep::{Arrangement, Axis, Column, Outcome, Sweep, Table, Value};
use servobench_testkit::Random;

/// Cases of each test.
const CASES: u64 = 500;
/// Columns of a terminal.
const WIDTH: usize = 80;

/// In which way a run is bad.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Bad {
    /// Never moves: no vibration, no effort, no error after the profile.
    Dead,
    Unstable,
    OverLimit,
    /// Calls that were not executed, which the scenario lifts.
    Lifted,
    BrokeOff,
}

const BAD: [Bad; 5] = [Bad::Dead, Bad::Unstable, Bad::OverLimit, Bad::Lifted, Bad::BrokeOff];

fn number(random: &mut Random) -> [f64; 8] {
    let frequency = random.between(10.0, 40.0);
    [
        random.between(0.5, 2.0),
        random.between(0.0, 0.5),
        random.decades(-7.0, -3.0),
        random.decades(-9.0, -4.0),
        frequency,
        random.between(0.001, 0.05),
        random.between(10.0, 200.0),
        random.between(5.0, 50.0),
    ]
}

fn good(random: &mut Random, label: &str) -> RunResult {
    of_numbers(label, number(random))
}

/// A bad run with numbers that are better than those of every good one.
fn bad(random: &mut Random, label: &str, how: Bad) -> RunResult {
    let mut numbers = number(random);
    numbers[..4].copy_from_slice(&[0.1, 0.0, 1e-9, 0.0]);
    let mut run = of_numbers(label, numbers);
    let broken = |name: &'static str, standing| requirements([(name, standing, vec!["it did not".to_owned()])]);
    run.verdict = Ended::Failed;
    match how {
        Bad::Dead => run.requirements = broken("arrives", Standing::Broken),
        Bad::Unstable => run.requirements = broken("stable", Standing::Broken),
        Bad::OverLimit => run.reasons = vec!["torque_peak 200 N, limit 20 N".into()],
        Bad::Lifted => (run.requirements, run.verdict) = (broken("executed", Standing::Lifted), Ended::Unjudged),
        Bad::BrokeOff => run.verdict = Ended::Error,
    }
    if matches!(how, Bad::Dead | Bad::Unstable) {
        run.reasons = vec!["arrives: it did not".into()];
    }
    run
}

fn compared<'a>((label, result): &'a (String, RunResult), noise: Noise<'a>) -> Compared<'a> {
    Compared { label, result, moves: &[], noise }
}

/// The sentences without line breaks.
fn words(comparison: &Comparison<'_>) -> String {
    let words = comparison.words(WIDTH);
    assert!(words.lines().all(|line| line.chars().count() <= WIDTH), "{words}");
    words.replace('\n', " ")
}

/// Runs of which the conclusion says that they win, or that are worth a choice.
fn praised(words: &str, labels: &[String]) -> Vec<String> {
    let conclusion = words.trim_end().trim_end_matches('.').rsplit(". ").next().unwrap_or_default();
    let (praised, _) = conclusion.split_once(" beaten by one").unwrap_or((conclusion, ""));
    let (praised, _) = praised.split_once("; ").unwrap_or((praised, ""));
    let is_named = |label: &&String| praised.split([' ', ',', ':', ';']).any(|word| word == label.as_str());
    if conclusion.starts_with("No run wins") { Vec::new() } else { labels.iter().filter(is_named).cloned().collect() }
}

#[test]
fn a_bad_run_never_wins_a_comparison_and_is_named() {
    for seed in 0..CASES {
        let random = &mut Random::seeded(seed);
        let count = 2 + random.index(5);
        let place = random.index(count);
        let how = random.one_of(&BAD);
        // One in five has a second bad one.
        let second = (random.below(5) == 0).then(|| random.index(count));
        let runs: Vec<(String, RunResult)> = (0..count)
            .map(|k| {
                let label = format!("run{k}");
                let is_bad = k == place || Some(k) == second;
                let result = if is_bad { bad(random, &label, how) } else { good(random, &label) };
                (label, result)
            })
            .collect();
        let labels: Vec<String> = runs.iter().map(|(label, _)| label.clone()).collect();
        let comparison = Comparison::new(runs.iter().map(|run| compared(run, Noise::None)).collect());
        let (words, out) = (words(&comparison), comparison.out(WIDTH).replace('\n', " "));
        let praised = praised(&words, &labels);
        let table = comparison.table(Style::default());
        for k in [Some(place), second].into_iter().flatten() {
            assert!(!praised.contains(&labels[k]), "seed {seed}, {how:?}: {} in `{words}`", labels[k]);
            assert!(out.contains(&format!("{} is out: ", labels[k])), "seed {seed}, {how:?}: {out}");
            assert!(!words.contains(&format!("{} wins", labels[k])), "seed {seed}: {words}");
        }
        assert!(table.contains("out"), "seed {seed}: {table}");
        assert!(table.lines().all(|line| line.chars().count() <= WIDTH), "{table}");
        let left = count - 1 - usize::from(second.is_some_and(|second| second != place));
        match left {
            0 => assert!(words.contains("No run wins: all are out."), "seed {seed}: {words}"),
            1 => assert!(praised.len() == 1 && words.contains(" wins: "), "seed {seed}: {words}"),
            _ => assert!(!praised.is_empty() || words.contains("nothing to choose"), "seed {seed}: {words}"),
        }
    }
}

/// A machine whose numbers scatter by up to a fifth, twice, with other seeds.
fn twins(random: &mut Random, seeds: usize) -> [Vec<RunResult>; 2] {
    let (own, scatter) = (number(random), random.decades(-4.0, -0.7));
    let mut runs = |label: &str| {
        let mut all = Vec::new();
        for _ in 0..seeds {
            // The sum of twelve uniform numbers is nearly normal.
            let mut normal = || (0..12).map(|_| random.unit()).sum::<f64>() - 6.0;
            let numbers = own.map(|x| x * (1.0 + scatter * normal()));
            all.push(of_numbers(label, numbers));
        }
        all
    };
    [runs("one"), runs("two")]
}

#[test]
fn one_machine_with_two_seeds_never_has_a_winner() {
    let mut told = 0;
    for seed in 0..CASES {
        let random = &mut Random::seeded(seed);
        let count = random.one_of(&[1, 2, 4, 5, 6, 10]);
        let both = twins(random, count);
        let labelled = ["one", "two"].map(str::to_owned).into_iter().zip(both.iter().map(|runs| runs[0].clone()));
        let labelled: Vec<(String, RunResult)> = labelled.collect();
        let runs = labelled.iter().zip(&both).map(|(run, seeds)| compared(run, Noise::Seeds(&seeds[1..])));
        let comparison = Comparison::new(runs.collect());
        let words = words(&comparison);
        assert!(!words.contains(" wins: ") && !words.contains("it is a choice"), "seed {seed}, {count} seeds: {words}");
        let is_told = words.contains("ithin noise") || words.contains("nothing to choose");
        assert!(is_told, "seed {seed}: {words}");
        told += usize::from(words.contains("ithin noise"));
    }
    assert!(told > 300, "{told}");
}

/// A difference far beyond the noise is told with five seeds, and not with four.
#[test]
fn a_difference_beyond_the_noise_is_told_with_five_seeds() {
    let random = &mut Random::seeded(1);
    let near = |label: &str, vibration: f64, random: &mut Random| {
        let near = |x: f64, random: &mut Random| x * (1.0 + 0.02 * random.signed());
        let numbers = [1.0, 0.1, 3e-6, near(vibration, random), 39.0, 0.002, 170.0, 60.0];
        of_numbers(label, numbers)
    };
    let (loud, quiet): (Vec<_>, Vec<_>) =
        (0..5).map(|_| (near("loud", 4e-6, random), near("quiet", 1e-6, random))).unzip();
    let words = |seeds: usize| {
        let runs = [("loud", &loud), ("quiet", &quiet)].map(|(label, runs)| Compared {
            label,
            result: &runs[0],
            moves: &[],
            noise: Noise::Seeds(&runs[1..seeds]),
        });
        words(&Comparison::new(runs.into()))
    };
    assert!(words(5).contains("quiet wins: less residual vibration in the same time."), "{}", words(5));
    let within = "Within noise: quiet and loud have random numbers and fewer than 5 seeds, so that no run wins;";
    assert!(words(4).contains(within), "{}", words(4));
}

/// A run of which one seed in five misses a limit is out.
#[test]
fn a_limit_must_be_kept_with_every_seed() {
    let random = &mut Random::seeded(2);
    let (mut one, two) = ((0..5).map(|_| good(random, "one")).collect::<Vec<_>>(), good(random, "two"));
    one[3].verdict = Ended::Failed;
    one[3].reasons = vec!["settling_time 21.0 ms, limit 20.0 ms".into()];
    let runs = vec![
        Compared { label: "one", result: &one[0], moves: &[], noise: Noise::Seeds(&one[1..]) },
        Compared { label: "two", result: &two, moves: &[], noise: Noise::None },
    ];
    let comparison = Comparison::new(runs);
    assert_eq!(comparison.out(WIDTH), "one is out: with 1 of 5 seeds: settling_time 21.0 ms, limit 20.0 ms\n");
    assert!(words(&comparison).ends_with("two wins: the other one is out. "), "{}", words(&comparison));
}

#[test]
fn a_bad_run_is_never_on_the_front_of_a_sweep() {
    let value = |k: usize| Value::Number(10.0 * (k + 1) as f64, "m/s3".into());
    for seed in 0..CASES {
        let random = &mut Random::seeded(seed);
        let (jerks, orders) = (2 + random.index(6), 1 + random.index(3));
        let axis = |key: &str, count: usize| Axis { key: key.into(), values: (0..count).map(value).collect() };
        let axes = vec![axis("setpoint.jerk", jerks), axis("drive.gain", orders)];
        let sweep = Sweep::new(axes, Arrangement::Grid, None).unwrap();
        let engines = ["exact".to_owned()];
        let place = random.index(jerks);
        let outcome = random.one_of(&[Outcome::Broken, Outcome::Failed, Outcome::NoVerdict]);
        let is_bad = |row: usize| row / orders == place;
        let rows = sweep.points();
        let mut values = |least: f64, low: f64, high: f64| -> Vec<f64> {
            (0..rows).map(|row| if is_bad(row) { least } else { random.logarithmic(low, high) }).collect()
        };
        let columns = vec![
            Column { name: "move_time".into(), unit: "s".into(), values: values(0.1, 0.5, 2.0) },
            Column { name: "residual_vibration_pp".into(), unit: "m".into(), values: values(0.0, 1e-8, 1e-4) },
        ];
        let outcomes = (0..rows).map(|row| if is_bad(row) { outcome } else { Outcome::Good }).collect();
        let table = Table { sweep: &sweep, engines: &engines, columns, outcomes };
        // A sweep without limits has runs that broke a requirement, too.
        let judged = random.below(2) == 0;
        let options = SweepOptions { judged, ..SweepOptions::default() };
        let text = sweep_table(&table, Style::default(), &options);
        let (_, front) = text.split_once("o other combination").unwrap_or_else(|| panic!("seed {seed}: {text}"));
        let of_bad = format!("jerk {} m/s3", 10 * (place + 1));
        assert!(!front.contains(&of_bad), "seed {seed}, {outcome:?}: {text}");
        assert!(front.contains("that keeps all limits"), "seed {seed}: {text}");
        // Of more than 20 combinations the best are shown.
        if rows <= 20 && outcome != Outcome::NoVerdict && (judged || outcome == Outcome::Broken) {
            assert_eq!(text.matches("FAILED").count(), orders, "seed {seed}: {text}");
        }
        if outcome == Outcome::Broken {
            let words = format!("{orders} of {rows} ");
            assert!(text.contains(&words) && text.contains("broke a requirement"), "seed {seed}: {text}");
        }
        assert!(sweep_front(&table, &options).is_some());
    }
}

/// Where all failed there is no front.
#[test]
fn a_sweep_of_which_all_failed_has_no_front() {
    let values = [1.0, 2.0].map(|value| Value::Number(value, "m".into())).to_vec();
    let sweep = Sweep::new(vec![Axis { key: "setpoint.jerk".into(), values }], Arrangement::Grid, None).unwrap();
    let column = |name: &str, values: [f64; 2]| Column { name: name.into(), unit: "s".into(), values: values.into() };
    let columns = vec![column("move_time", [1.0, 2.0]), column("residual_vibration_pp", [2.0, 1.0])];
    let of = |outcome| Table { sweep: &sweep, engines: &[], columns: columns.clone(), outcomes: vec![outcome; 2] };
    for outcome in [Outcome::Failed, Outcome::Broken] {
        let text =
            sweep_table(&of(outcome), Style::default(), &SweepOptions { judged: true, ..SweepOptions::default() });
        assert!(!text.contains("smaller in both"), "{text}");
    }
    let text = sweep_table(&of(Outcome::Failed), Style::default(), &SweepOptions::default());
    assert!(text.contains("No combination is left: all failed"), "{text}");
}

/// The machine is not chosen: combinations are compared at their worst over its keys and the engines.
#[test]
fn a_front_is_over_what_is_chosen() {
    let axis = |key: &str, values: [f64; 2]| Axis {
        key: key.into(),
        values: values.map(|value| Value::Number(value, "kg".into())).to_vec(),
    };
    let of = |axes: Vec<Axis>, engines: &[String], values: [Vec<f64>; 2]| {
        let sweep = Sweep::new(axes, Arrangement::Grid, None).unwrap().of_the_machine("axis.load.mass");
        let [time, vibration] = values;
        let columns = vec![
            Column { name: "move_time".into(), unit: "s".into(), values: time },
            Column { name: "residual_vibration_pp".into(), unit: "m".into(), values: vibration },
        ];
        let outcomes = vec![Outcome::Good; columns[0].values.len()];
        let table = Table { sweep: &sweep, engines, columns, outcomes };
        sweep_table(&table, Style::default(), &SweepOptions::default()).replace("\n  ", " ")
    };
    let (mass, jerk) = (axis("axis.load.mass", [1.0, 2.0]), axis("setpoint.jerk", [3.0, 4.0]));
    // Of the light machine each is as good as the other; of the heavy one the first vibrates more and the second is slower.
    let both = [vec![1.0, 1.0, 1.0, 2.0], vec![1e-6, 1e-6, 3e-6, 1e-6]];
    let text = of(vec![mass.clone(), jerk.clone()], &[], both);
    let (_, front) = text.split_once("No other combination").unwrap();
    assert!(front.contains("each at its worst over axis.load.mass"), "{text}");
    assert!(front.contains("1.00 s    3.00 µm  jerk 3 kg") && front.contains("2.00 s    1.00 µm  jerk 4 kg"), "{text}");
    assert!(!front.contains("mass 1 kg"), "{text}");
    let text = of(vec![mass], &[], [vec![1.0, 2.0], vec![2e-6, 1e-6]]);
    assert!(text.contains("Nothing to choose: axis.load.mass is what the machine is"), "{text}");
    let engines = ["exact", "rapier"].map(str::to_owned);
    let text = of(vec![jerk], &engines, [vec![1.0, 2.0, 1.5, 2.0], vec![2e-6, 1e-6, 2e-6, 1.5e-6]]);
    let (_, front) = text.split_once("No other combination").unwrap();
    assert!(front.contains("1.50 s    2.00 µm  jerk 3 kg") && front.contains("2.00 s    1.50 µm  jerk 4 kg"), "{text}");
    assert!(front.contains("worst over the engines"), "{text}");
}
