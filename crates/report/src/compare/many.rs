//! What a table of more than two runs says, in words.
use super::relation::Relation;
use super::table::MOST_COLUMNS;
use super::words::mode;
use super::{Compared, Value, force_or_torque, in_words, vibration_of};
use servobench_metrics::{Name, Quantity};

/// Each quantity from the best run to the worst, then which of them are worth a choice.
pub(super) fn sentences(runs: &[Compared<'_>]) -> Vec<String> {
    let unit = runs.iter().find_map(|run| run.metric(Name::TorqueRms)).map_or("", |(_, unit)| unit);
    let vibration = vibration_of(runs);
    let ranked = [
        (format!("Residual vibration ({})", in_words(vibration)), vibration),
        ("Move".to_owned(), Name::MoveTime),
        ("Move with settling".to_owned(), Name::MoveAndSettlingTime),
        ("Peak following error".to_owned(), Name::FollowingErrorPeakLoad),
        (format!("RMS {}", force_or_torque(unit)), Name::TorqueRms),
    ];
    let ranked = ranked.into_iter().filter_map(|(words, name)| ranking(&words, name, runs));
    ranked.chain(ringing(runs)).chain(choice(runs, vibration)).collect()
}

/// The runs from the best to the worst; of many the first three and the last.
fn ranking(words: &str, name: Name, runs: &[Compared<'_>]) -> Option<String> {
    let mut ranked: Vec<_> = runs.iter().filter_map(|run| Some((run.label, run.metric(name)?))).collect();
    ranked.sort_by(|one, two| one.1.0.abs().total_cmp(&two.1.0.abs()));
    let (_, best) = *ranked.first()?;
    let (_, worst) = *ranked.last()?;
    if ranked.len() == runs.len() && Relation::of(best.0, worst.0) == Relation::Same {
        return Some(format!("{words}: all the same within 1 %, {}.", Quantity::new(best.0, best.1)));
    }
    let told = |one: &(&str, Value<'_>)| format!("{} {}", one.0, against(best.0, one.1));
    Some(match ranked.as_slice() {
        [first, second, third, .., last] if runs.len() > MOST_COLUMNS && ranked.len() > MOST_COLUMNS => {
            let [least, most] = if best.1 == "s" { ["shortest", "longest"] } else { ["least", "most"] };
            let best = format!("{words}: {least} {}, then {} and {}", told(first), told(second), told(third));
            format!("{best}; {most} {}.", told(last))
        }
        all => format!("{words}: {}.", all.iter().map(told).collect::<Vec<_>>().join(", ")),
    })
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

/// In which mode they ring, where it is one.
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

/// A run by its label, its vibration and its time.
type Standing<'a> = (&'a str, f64, f64);

/// Which runs are not beaten in vibration and time together by one of the others.
fn choice<'a>(runs: &[Compared<'a>], vibration: Name) -> Option<String> {
    let settles = runs.iter().all(|run| run.metric(Name::MoveAndSettlingTime).is_some());
    let time = if settles { Name::MoveAndSettlingTime } else { Name::MoveTime };
    let both = |run: &Compared<'a>| Some((run.label, run.metric(vibration)?.0.abs(), run.metric(time)?.0.abs()));
    let all = runs.iter().map(both).collect::<Option<Vec<_>>>()?;
    let beats = |one: &Standing<'a>, other: &Standing<'a>| {
        let stands = [Relation::of(other.1, one.1), Relation::of(other.2, one.2)];
        stands.iter().all(|relation| !relation.is_more()) && stands.iter().any(|relation| *relation != Relation::Same)
    };
    let (mut front, beaten): (Vec<&Standing<'a>>, Vec<&Standing<'a>>) =
        all.iter().partition(|one| !all.iter().any(|other| beats(other, one)));
    front.sort_by(|one, two| one.2.total_cmp(&two.2));
    let names = |all: &[&Standing<'a>]| listing(&all.iter().map(|one| one.0).collect::<Vec<_>>());
    let arrives = if settles { "is in position" } else { "arrives" };
    match front.as_slice() {
        [] => None,
        [winner] => Some(format!("{} wins: no other shakes its load less or {arrives} sooner.", winner.0)),
        [first, .., last] if beaten.is_empty() && same(first, last) => {
            Some("Between them there is nothing to choose.".to_owned())
        }
        _ if beaten.is_empty() => Some(format!(
            "Each that {arrives} sooner shakes its load more, from {} to {}: it is a choice.",
            front[0].0,
            front[front.len() - 1].0
        )),
        _ => {
            let is = if beaten.len() == 1 { "is" } else { "are" };
            Some(format!(
                "The choice is between {}; {} {is} beaten by one that shakes its load no more and {arrives} no later.",
                names(&front),
                names(&beaten)
            ))
        }
    }
}

fn same(one: &Standing<'_>, two: &Standing<'_>) -> bool {
    Relation::of(one.1, two.1) == Relation::Same && Relation::of(one.2, two.2) == Relation::Same
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
    use crate::compare::{Compared, Comparison};
    use servobench_results::samples::{jerk, of_numbers, snap};

    #[test]
    fn three_are_ranked() {
        let (jerk, snap) = (jerk(), snap());
        let trapezoid = of_numbers("trapezoid", [1.2, 0.3, 90e-6, 41e-6, 38.985, 0.0021, 190.0, 60.3]);
        let runs = vec![
            Compared { label: "trapezoid", result: &trapezoid, moves: &[] },
            Compared { label: "jerk", result: &jerk, moves: &[] },
            Compared { label: "snap", result: &snap, moves: &[] },
        ];
        insta::assert_snapshot!(Comparison::new(runs).words(76), @r#"
        Residual vibration (amplitude of the mode): snap 105 nm, jerk 1.70 µm
        (16 × as much), trapezoid 20.5 µm (200 × as much). Move: trapezoid 1.20 s,
        jerk 1.30 s (8.3 % longer), snap 1.35 s (13 % longer). Move with settling:
        jerk 1.30 s, snap 1.35 s (3.5 % longer), trapezoid 1.50 s (15 % longer).
        Peak following error: snap 730 nm, jerk 3.10 µm (4.2 × as much), trapezoid
        90.0 µm (120 × as much). RMS force: snap 60.0 N, trapezoid 60.3 N, jerk
        61.2 N (2.0 % more). The choice is between jerk and snap; trapezoid is
        beaten by one that shakes its load no more and is in position no later.
        "#);
    }

    /// Time, vibration, and what is said of them.
    fn conclusion(numbers: &[(&str, f64, f64)]) -> String {
        let all: Vec<_> = numbers
            .iter()
            .map(|(name, time, vibration)| {
                (*name, of_numbers(name, [*time, 0.0, 3e-6, *vibration, 39.0, 0.002, 170.0, 60.0]))
            })
            .collect();
        let runs = all.iter().map(|(label, result)| Compared { label, result, moves: &[] });
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
        The choice is between none, zv, zvd and zvdd; mzv, ei, 2hump-ei and 3hump-ei are beaten by one that shakes its load no more and is in position no later.
        "#);
    }

    #[test]
    fn each_outcome_has_its_conclusion() {
        let last = |numbers: &[(&str, f64, f64)]| conclusion(numbers).rsplit_once(". ").unwrap().1.to_owned();
        assert_eq!(
            last(&[("a", 1.0, 1e-6), ("b", 1.1, 2e-6), ("c", 1.2, 3e-6)]),
            "a wins: no other shakes its load less or is in position sooner."
        );
        assert_eq!(
            last(&[("a", 1.0, 3e-6), ("b", 1.1, 2e-6), ("c", 1.2, 1e-6)]),
            "Each that is in position sooner shakes its load more, from a to c: it is a choice."
        );
        assert_eq!(
            last(&[("a", 1.0, 3e-6), ("b", 1.2, 3e-6), ("c", 1.2, 1e-6)]),
            "The choice is between a and c; b is beaten by one that shakes its load no more and is in position no later."
        );
        assert_eq!(last(&[("a", 1.0, 1e-6); 3]), "Between them there is nothing to choose.");
    }
}
