//! Conclusions from a table of more than two runs, in words.
use super::relation::Relation;
use super::table::MOST_COLUMNS;
use super::terms::SEEDS;
use super::words::mode;
use super::{Compared, Comparison, Value, force_or_torque, in_words};
use servobench_metrics::{Name, Quantity};

/// Each quantity of the sound runs, ranked from best to worst; then the runs that may win and are worth choosing.
pub(super) fn sentences<'a>(comparison: &Comparison<'a>, runs: &[Compared<'a>]) -> Vec<String> {
    let unit = runs.iter().find_map(|run| run.metric(Name::TorqueRms)).map_or("", |(_, unit)| unit);
    let vibration = comparison.vibration(runs);
    let ranked = [
        (format!("Residual vibration ({})", in_words(vibration)), vibration),
        ("Move".to_owned(), Name::MoveTime),
        ("Move with settling".to_owned(), Name::MoveAndSettlingTime),
        ("Peak following error".to_owned(), Name::FollowingErrorPeakLoad),
        (format!("RMS {}", force_or_torque(unit)), Name::TorqueRms),
    ];
    let ranked = ranked.into_iter().filter_map(|(words, name)| {
        let all: Vec<_> = runs.iter().filter_map(|run| Some((run.label, run.metric(name)?))).collect();
        ranking(&words, all, runs.len())
    });
    // For programs of several moves the longest move does not give the time at which they are done.
    let program = runs.iter().any(|run| !run.is_one_move()).then(|| {
        let all = runs.iter().filter_map(|run| Some((run.label, run.arrival()?)));
        ranking("Program done after", all.filter(|(_, (time, _))| time.is_finite()).collect(), runs.len())
    });
    let ranked = ranked.chain(program.flatten());
    ranked.chain(unsettled(runs)).chain(ringing(runs)).chain(choice(comparison)).collect()
}

/// The runs from best to worst with their values; of many runs the first three and the last.
fn ranking(words: &str, mut ranked: Vec<(&str, Value<'_>)>, runs: usize) -> Option<String> {
    ranked.sort_by(|one, two| one.1.0.abs().total_cmp(&two.1.0.abs()));
    let (_, best) = *ranked.first()?;
    let (_, worst) = *ranked.last()?;
    if ranked.len() == runs && Relation::of(best.0, worst.0) == Relation::Same {
        return Some(format!("{words}: all the same within 1 %, {}.", Quantity::new(best.0, best.1)));
    }
    let told = |one: &(&str, Value<'_>)| format!("{} {}", one.0, against(best.0, one.1));
    Some(match ranked.as_slice() {
        [first, second, third, .., last] if runs > MOST_COLUMNS && ranked.len() > MOST_COLUMNS => {
            let [least, most] = if best.1 == "s" { ["shortest", "longest"] } else { ["least", "most"] };
            let best = format!("{words}: {least} {}, then {} and {}", told(first), told(second), told(third));
            format!("{best}; {most} {}.", told(last))
        }
        all => format!("{words}: {}.", all.iter().map(told).collect::<Vec<_>>().join(", ")),
    })
}

/// Runs that do not settle, which are missing from all rankings of times with settling.
fn unsettled(runs: &[Compared<'_>]) -> Option<String> {
    let never = runs.iter().filter(|run| run.arrival().is_some_and(|(time, _)| time.is_infinite()));
    let names: Vec<&str> = never.map(|run| run.label).collect();
    let verb = if names.len() == 1 { "does" } else { "do" };
    (!names.is_empty()).then(|| format!("{} {verb} not settle: later than all others.", listing(&names)))
}

/// `1.35 s (3.8 % longer)`
fn against(best: f64, (value, unit): Value<'_>) -> String {
    let text = Quantity::new(value, unit).to_string();
    match Relation::of(best, value) {
        Relation::Same => text,
        relation if unit == "s" => {
            let relation = relation.to_string().replace("more", "longer").replace("as much", "as long");
            format!("{text} ({relation})")
        }
        relation => format!("{text} ({relation})"),
    }
}

/// The mode in which the runs ring, if it is the same for all.
fn ringing(runs: &[Compared<'_>]) -> Option<String> {
    if runs.len() <= MOST_COLUMNS {
        return None;
    }
    let modes: Vec<_> = runs.iter().filter_map(|run| mode(*run)).collect();
    let (frequency, damping) = *modes.first()?;
    let is_one = modes.iter().all(|other| Relation::of(frequency, other.0) == Relation::Same);
    is_one.then(|| {
        format!("The load rings at {:.4} (ζ = {:.2}).", Quantity::new(frequency, "Hz"), Quantity::new(damping, ""))
    })
}

/// The runs that may win and are not beaten in both vibration and time by another one.
fn choice(comparison: &Comparison<'_>) -> Option<String> {
    let runs: Vec<Compared<'_>> = comparison.runs.iter().filter(|run| Comparison::is_in(run)).copied().collect();
    match runs.as_slice() {
        [] => return Some("No run wins: all are out.".to_owned()),
        [_] => return comparison.only_one_in(),
        many if many.iter().any(Compared::has_unknown_noise) => return Some(within_noise(many)),
        _ => {}
    }
    let vibration = comparison.vibration(&runs);
    let places: Vec<usize> = (0..runs.len()).collect();
    let mut stands = Vec::new();
    for one in &runs {
        let of =
            |other: &Compared<'_>| Some([comparison.relation(vibration, one, other)?, comparison.arrival(one, other)?]);
        stands.push(runs.iter().map(of).collect::<Option<Vec<_>>>()?);
    }
    let beats = |one: usize, other: usize| {
        let [vibration, time] = stands[one][other];
        let is_better = matches!(vibration, Relation::Less(_)) || matches!(time, Relation::Less(_));
        is_better && !vibration.is_more() && !time.is_more()
    };
    let (mut front, beaten): (Vec<usize>, Vec<usize>) =
        places.iter().partition(|one| !places.iter().any(|other| beats(*other, **one)));
    let time = |place: &usize| runs[*place].arrival().map_or(f64::INFINITY, |(time, _)| time);
    front.sort_by(|one, two| time(one).total_cmp(&time(two)));
    let names = |all: &[usize]| listing(&all.iter().map(|place| runs[*place].label).collect::<Vec<_>>());
    let settles = |run: &Compared<'_>| run.arrival().is_none_or(|(time, _)| time.is_finite());
    let has_window = runs.iter().any(|run| run.metric(Name::SettlingTime).is_some());
    let arrives = if has_window && runs.iter().all(settles) { "is in position" } else { "arrives" };
    let is_equal = |one: &usize, other: &usize| stands[*one][*other].iter().all(|relation| relation.is_equal());
    let is_chance = stands.iter().flatten().flatten().any(|relation| *relation == Relation::Chance);
    match front.as_slice() {
        [] => None,
        [winner] => {
            Some(format!("{} wins: no other leaves less residual vibration or {arrives} sooner.", runs[*winner].label))
        }
        all if beaten.is_empty() && all.iter().all(|one| all.iter().all(|other| is_equal(one, other))) => {
            let noise = if is_chance { "Within noise there" } else { "Between them there" };
            Some(format!("{noise} is nothing to choose."))
        }
        [first, .., last] if beaten.is_empty() => Some(format!(
            "Each that {arrives} sooner leaves more residual vibration, from {} to {}: it is a choice.",
            runs[*first].label, runs[*last].label
        )),
        _ => {
            let is = if beaten.len() == 1 { "is" } else { "are" };
            Some(format!(
                "The choice is between {}; {} {is} beaten by one that leaves no more residual vibration and {arrives} no later.",
                names(&front),
                names(&beaten)
            ))
        }
    }
}

/// Conclusion for runs with random numbers that were run with too few seeds.
pub(super) fn within_noise(runs: &[Compared<'_>]) -> String {
    let names: Vec<&str> = runs.iter().filter(|run| run.has_unknown_noise()).map(|run| run.label).collect();
    let have = if names.len() == 1 { "has" } else { "have" };
    format!(
        "Within noise: {} {have} random numbers and fewer than {SEEDS} seeds, so that no run wins; --seeds {SEEDS} shows what is \
         chance.",
        listing(&names)
    )
}

/// `one, two and three`
fn listing(names: &[&str]) -> String {
    match names {
        [] => String::new(),
        [one] => (*one).to_owned(),
        [others @ .., last] => format!("{} and {last}", others.join(", ")),
    }
}

#[cfg(test)]
mod tests {
    use crate::compare::{Compared, Comparison, Noise};
    use servobench_results::samples::{jerk, of_numbers, snap};

    #[test]
    fn three_are_ranked() {
        let (jerk, snap) = (jerk(), snap());
        let trapezoid = of_numbers("trapezoid", [1.2, 0.3, 90e-6, 41e-6, 38.985, 0.0021, 190.0, 60.3]);
        let runs = vec![
            Compared { label: "trapezoid", result: &trapezoid, moves: &[], noise: Noise::None },
            Compared { label: "jerk", result: &jerk, moves: &[], noise: Noise::None },
            Compared { label: "snap", result: &snap, moves: &[], noise: Noise::None },
        ];
        insta::assert_snapshot!(Comparison::new(runs).words(76), @r#"
        Residual vibration (amplitude of the mode): snap 105 nm, jerk 1.70 µm
        (16 × as much), trapezoid 20.5 µm (200 × as much). Move: trapezoid 1.20 s,
        jerk 1.30 s (8.3 % longer), snap 1.35 s (13 % longer). Move with settling:
        jerk 1.30 s, snap 1.35 s (3.5 % longer), trapezoid 1.50 s (15 % longer).
        Peak following error: snap 730 nm, jerk 3.10 µm (4.2 × as much), trapezoid
        90.0 µm (120 × as much). RMS force: snap 60.0 N, trapezoid 60.3 N, jerk
        61.2 N (2.0 % more). The choice is between jerk and snap; trapezoid is
        beaten by one that leaves no more residual vibration and is in position no
        later.
        "#);
    }

    /// The conclusion for runs of these times and vibrations.
    fn conclusion(numbers: &[(&str, f64, f64)]) -> String {
        let all: Vec<_> = numbers
            .iter()
            .map(|(name, time, vibration)| {
                (*name, of_numbers(name, [*time, 0.0, 3e-6, *vibration, 39.0, 0.002, 170.0, 60.0]))
            })
            .collect();
        let runs = all.iter().map(|(label, result)| Compared { label, result, moves: &[], noise: Noise::None });
        Comparison::new(runs.collect()).words(1000).trim_end().to_owned()
    }

    #[test]
    fn of_eight_the_best_and_the_worst_are_told() {
        let numbers = [
            ("none", 1.30, 3.4e-6),
            ("zv", 1.32, 0.9e-6),
            ("mzv", 1.33, 1.1e-6),
            ("zvd", 1.34, 0.2e-6),
            ("ei", 1.34, 0.3e-6),
            ("zvdd", 1.36, 0.05e-6),
            ("2hump-ei", 1.36, 0.2e-6),
            ("3hump-ei", 1.38, 0.2e-6),
        ];
        let all = conclusion(&numbers).replace(". ", ".\n");
        insta::assert_snapshot!(all, @r#"
        Residual vibration (amplitude of the mode): least zvdd 25.0 nm, then zvd 100 nm (4.0 × as much) and 2hump-ei 100 nm (4.0 × as much); most none 1.70 µm (68 × as much).
        Move: shortest none 1.30 s, then zv 1.32 s (1.5 % longer) and mzv 1.33 s (2.3 % longer); longest 3hump-ei 1.38 s (6.2 % longer).
        Move with settling: shortest none 1.30 s, then zv 1.32 s (1.5 % longer) and mzv 1.33 s (2.3 % longer); longest 3hump-ei 1.38 s (6.2 % longer).
        Peak following error: all the same within 1 %, 3.00 µm.
        RMS force: all the same within 1 %, 60.0 N.
        The load rings at 39.00 Hz (ζ = 0.0020).
        The choice is between none, zv, zvd and zvdd; mzv, ei, 2hump-ei and 3hump-ei are beaten by one that leaves no more residual vibration and is in position no later.
        "#);
    }

    #[test]
    fn each_outcome_has_its_conclusion() {
        let last = |numbers: &[(&str, f64, f64)]| conclusion(numbers).rsplit_once(". ").unwrap().1.to_owned();
        assert_eq!(
            last(&[("a", 1.0, 1e-6), ("b", 1.1, 2e-6), ("c", 1.2, 3e-6)]),
            "a wins: no other leaves less residual vibration or is in position sooner."
        );
        assert_eq!(
            last(&[("a", 1.0, 3e-6), ("b", 1.1, 2e-6), ("c", 1.2, 1e-6)]),
            "Each that is in position sooner leaves more residual vibration, from a to c: it is a choice."
        );
        assert_eq!(
            last(&[("a", 1.0, 3e-6), ("b", 1.2, 3e-6), ("c", 1.2, 1e-6)]),
            "The choice is between a and c; b is beaten by one that leaves no more residual vibration and is in position no later."
        );
        assert_eq!(last(&[("a", 1.0, 1e-6); 3]), "Between them there is nothing to choose.");
    }
}
