//! Conclusions from the comparison of two runs, in words.
use super::relation::{Relation, percent};
use super::standing::Standing;
use super::terms::SEEDS;
use super::{Compared, Comparison, Value, force_or_torque, in_words, many};
use crate::text::wrapped;
use servobench_metrics::{Name, Quantity, ResidualRatios};

impl Comparison<'_> {
    /// Conclusions from the table, in sentences of lines that fit `width`.
    #[must_use]
    pub fn words(&self, width: usize) -> String {
        let sentences = match (self.runs.as_slice(), self.sound().as_slice()) {
            ([] | [_], _) => vec!["There is nothing to compare.".to_owned()],
            (_, [one, two]) => Pair::of(self, *one, *two).sentences(),
            (_, [] | [_]) => vec![self.only_one_in().unwrap_or_else(|| "No run wins: all are out.".to_owned())],
            (_, many) => many::sentences(self, many),
        };
        wrapped(&sentences.join(" "), width).join("\n") + "\n"
    }

    /// Conclusion if all runs but one are out.
    pub(super) fn only_one_in(&self) -> Option<String> {
        let mut all = self.runs.iter().filter(|run| Self::is_in(run));
        let (one, None) = (all.next()?, all.next()) else { return None };
        let others = if self.runs.len() > 2 { "all others are out" } else { "the other one is out" };
        Some(if one.has_unknown_noise() {
            format!("{} is left, within noise: {others}, and it was run with fewer than {SEEDS} seeds.", one.label)
        } else {
            format!("{} wins: {others}.", one.label)
        })
    }
}

/// Relative range of frequencies on either side of a mode that is examined.
const AROUND: f64 = 0.1;
/// Ratio from which two damping ratios count as different: fits of one decay agree more closely than that.
const OTHER_DAMPING: f64 = 1.05;

/// Names of the derivatives that have limits, and their powers of the second.
const DERIVATIVES: [(&str, &str); 4] = [("velocity", ""), ("acceleration", "²"), ("jerk", "³"), ("snap", "⁴")];

/// Two runs: the subject of the sentences, and the other.
struct Pair<'c, 'a> {
    comparison: &'c Comparison<'a>,
    this: Compared<'a>,
    other: Compared<'a>,
    /// The metric by which their vibrations are compared.
    vibration: Name,
}

impl<'c, 'a> Pair<'c, 'a> {
    /// Makes the run with less vibration the subject; the second if that does not decide.
    fn of(comparison: &'c Comparison<'a>, one: Compared<'a>, two: Compared<'a>) -> Self {
        let vibration = comparison.vibration(&[one, two]);
        let is_second_more = comparison.relation(vibration, &two, &one).is_some_and(Relation::is_more);
        let (this, other) = if is_second_more { (one, two) } else { (two, one) };
        Self { comparison, this, other, vibration }
    }

    /// Values of both, this run's first.
    fn both(&self, name: Name) -> Option<(Value<'a>, Value<'a>)> {
        Some((self.this.metric(name)?, self.other.metric(name)?))
    }

    /// Relation of this run to the other.
    fn relation(&self, name: Name) -> Option<Relation> {
        self.comparison.relation(name, &self.this, &self.other)
    }

    fn sentences(&self) -> Vec<String> {
        let sentences = [
            self.equal(),
            self.vibration(),
            self.mode(),
            self.beside_the_mode(),
            self.limits(),
            self.time(),
            self.settling(),
            self.costs(),
            self.conclusion(),
        ];
        sentences.into_iter().flatten().collect()
    }

    /// The metric in which the runs were made equal; a vibration has its own sentence.
    fn equal(&self) -> Option<String> {
        let name = self.comparison.equal.filter(|name| *name != self.vibration)?;
        let ((this, unit), (other, _)) = self.both(name)?;
        let (one, two) = (Quantity::new(other, unit), Quantity::new(this, unit));
        Some(match Relation::of(other, this) {
            Relation::Same => format!("Both have a {name} of {two}."),
            _ => format!("{} has a {name} of {one}, {} of {two}.", self.other.label, self.this.label),
        })
    }

    fn vibration(&self) -> Option<String> {
        let (this, other) = (self.this.label, self.other.label);
        let Some(((value, unit), (reference, _))) = self.both(self.vibration) else {
            let without = [self.this, self.other];
            let without = without.into_iter().find(|run| run.metric(self.vibration).is_none())?;
            return Some(format!("The residual vibration of {} was not measured.", without.label));
        };
        let plain = Relation::of(reference, value);
        let (value, reference) = (Quantity::new(value, unit), Quantity::new(reference, unit));
        let kind = in_words(self.vibration);
        Some(match self.relation(self.vibration)? {
            Relation::Same if plain == Relation::Same => {
                format!("{this} and {other} leave the same residual vibration within 1 %: {value}.")
            }
            Relation::Same => format!(
                "{this} leaves {value} of residual vibration ({kind}) and {other} {reference}: too little to tell apart."
            ),
            Relation::Chance => {
                format!("{this} leaves {value} of residual vibration ({kind}) and {other} {reference}: within noise.")
            }
            relation => format!(
                "{this} leaves {value} of residual vibration ({kind}) where {other} leaves {reference}: {relation}."
            ),
        })
    }

    /// Frequency and damping at which the ratio holds, and the dampings if they differ.
    fn mode(&self) -> Option<String> {
        let (this, other) = (mode(self.this), mode(self.other));
        let differs = !self.relation(self.vibration)?.is_equal();
        let text = |(frequency, damping)| {
            format!("{:.4} (ζ = {:.2})", Quantity::new(frequency, "Hz"), Quantity::new(damping, ""))
        };
        let holds = if differs { "; the ratio holds for this mode, not for every other" } else { "" };
        Some(match (this, other) {
            (Some(this), Some(other)) if Relation::of(other.0, this.0) != Relation::Same => format!(
                "They ring in different modes, {} at {} and {} at {}.",
                self.this.label,
                text(this),
                self.other.label,
                text(other)
            ),
            (Some((frequency, this)), Some((_, other))) if is_other_damping(this, other) => format!(
                "The load rings at {:.4}, damped by ζ = {:.2} with {} and ζ = {:.2} with {}{holds}.",
                Quantity::new(frequency, "Hz"),
                Quantity::new(this, ""),
                self.this.label,
                Quantity::new(other, ""),
                self.other.label,
            ),
            (_, Some(mode)) | (Some(mode), None) if differs => format!("The load rings at {}{holds}.", text(mode)),
            _ => return None,
        })
    }

    /// Effect of the set-points alone on modes beside the one measured: near a zero of a spectrum the ratio changes
    /// several times over within a per cent.
    fn beside_the_mode(&self) -> Option<String> {
        if !self.comparison.is_of_set_points
            || self.vibration != Name::ResidualVibrationAmplitude
            || self.relation(self.vibration)?.is_equal()
        {
            return None;
        }
        let (frequency, _) = mode(self.other)?;
        let ResidualRatios { low, high } = ResidualRatios::of(self.this.moves, self.other.moves, frequency, AROUND)?;
        Some(format!(
            "Of undamped modes within ±{:.0} % of that frequency the set-points alone would make, by their closed form, \
             four in five ring from {} to {}.",
            100.0 * AROUND,
            size(low),
            size(high)
        ))
    }

    /// Limits that differ: the difference is then not due to the order of the profile.
    fn limits(&self) -> Option<String> {
        let axis = self.this.metric(Name::ResidualVibrationPp).map_or("m", |(_, unit)| unit);
        let differences: Vec<_> = DERIVATIVES
            .into_iter()
            .enumerate()
            .filter_map(|(k, (name, power))| Some((name, power, self.this.limit(k)?, self.other.limit(k)?)))
            .filter(|(_, _, this, other)| this.to_bits() != other.to_bits())
            .map(|(name, power, this, other)| {
                let unit = format!("{axis}/s{power}");
                format!("{name} {} against {}", Quantity::new(this, &unit), Quantity::new(other, &unit))
            })
            .collect();
        (!differences.is_empty()).then(|| format!("Their limits differ: {}.", differences.join(", ")))
    }

    fn time(&self) -> Option<String> {
        let ((this, unit), (other, _)) = self.both(Name::MoveTime)?;
        let label = self.this.label;
        let (subject, both) = if [self.this, self.other].iter().all(|run| run.result.moves.len() < 2) {
            (format!("The {label} move takes"), "Both moves take")
        } else {
            (format!("The longest move of {label} takes"), "The longest move of both takes")
        };
        Some(match Relation::of(other, this) {
            Relation::Same => format!("{both} {}.", Quantity::new(this, unit)),
            relation => format!(
                "{subject} {} ({:.2} %) {}.",
                Quantity::new((this - other).abs(), unit),
                percent(other, this),
                if relation.is_more() { "longer" } else { "less time" }
            ),
        })
    }

    fn is_one_move(&self) -> bool {
        self.this.is_one_move() && self.other.is_one_move()
    }

    /// Program time, with settling if a window requires it.
    fn settling(&self) -> Option<String> {
        let ((this, unit), (other, _)) = (self.this.arrival()?, self.other.arrival()?);
        let has_window = [self.this, self.other].iter().any(|run| run.metric(Name::SettlingTime).is_some());
        if !(this.is_finite() && other.is_finite()) || (self.is_one_move() && !has_window) {
            return None;
        }
        let (subject, both) = if self.is_one_move() {
            ("With settling, it is in position", "With settling, both take")
        } else {
            ("Its program is done", "Both programs are done after")
        };
        let difference = Quantity::new((this - other).abs(), unit);
        Some(match self.comparison.arrival(&self.this, &self.other)? {
            Relation::Same => format!("{both} {}.", Quantity::new(this, unit)),
            Relation::Chance => format!("{subject} {difference} {}: within noise.", sooner(this > other)),
            relation => {
                format!("{subject} {difference} ({:.2} %) {}.", percent(other, this), sooner(relation.is_more()))
            }
        })
    }

    /// Following error and effort.
    fn costs(&self) -> Option<String> {
        let unit = self.this.metric(Name::TorquePeak).map_or("", |(_, unit)| unit);
        let effort = force_or_torque(unit);
        let parts: Vec<_> = [
            (Name::FollowingErrorPeakLoad, "peak following error".to_owned()),
            (Name::TorquePeak, format!("peak {effort}")),
            (Name::TorqueRms, format!("RMS {effort}")),
        ]
        .into_iter()
        .filter_map(|(name, words)| Some((words, self.relation(name)?)))
        .enumerate()
        .map(|(k, (words, relation))| {
            let verb = if k == 0 { " is" } else { "" };
            let relation = if relation == Relation::Same { "the same".to_owned() } else { relation.to_string() };
            format!("{words}{verb} {relation}")
        })
        .collect();
        (!parts.is_empty()).then(|| format!("Its {}.", parts.join(", ")))
    }

    /// The winner, if there is one.
    fn conclusion(&self) -> Option<String> {
        let (this, other) = (self.this.label, self.other.label);
        match [self.this, self.other].map(|run| run.standing()) {
            [Standing::In, Standing::In] => {}
            _ => return Some(self.comparison.only_one_in().unwrap_or_else(|| "No run wins: all are out.".to_owned())),
        }
        let settled = |run: Compared<'_>| run.arrival().is_some_and(|(time, _)| time.is_finite());
        if self.this.has_unknown_noise() || self.other.has_unknown_noise() {
            return Some(many::within_noise(&[self.this, self.other]));
        }
        match (settled(self.this), settled(self.other)) {
            (true, false) => return Some(format!("{this} wins: only it settles.")),
            (false, true) => return Some(format!("{other} wins: only it settles.")),
            (false, false) if self.this.arrival().is_some() => return Some("No run wins: none settles.".to_owned()),
            _ => {}
        }
        let vibration = self.relation(self.vibration)?;
        let arrival = self.comparison.arrival(&self.this, &self.other)?;
        let noise = if [vibration, arrival].contains(&Relation::Chance) { "Within noise " } else { "" };
        let equal = if vibration == Relation::Chance {
            "at a vibration that is equal within noise"
        } else {
            "at equal vibration"
        };
        let time =
            if arrival == Relation::Chance { "in a time that is equal within noise" } else { "in the same time" };
        Some(match (vibration, arrival) {
            (one, two) if one.is_equal() && two.is_equal() && noise.is_empty() => {
                format!("Between {this} and {other} there is nothing to choose.")
            }
            (one, two) if one.is_equal() && two.is_equal() => {
                format!("{noise}there is nothing to choose between {this} and {other}.")
            }
            (one, Relation::Less(_)) if one.is_equal() => format!("{this} wins: in position sooner {equal}."),
            (one, Relation::More(_)) if one.is_equal() => format!("{other} wins: in position sooner {equal}."),
            (_, Relation::More(_)) => {
                format!("{this} leaves less residual vibration, {other} is in position sooner: it is a choice.")
            }
            (_, Relation::Less(_)) => format!("{this} wins: less residual vibration, and in position sooner."),
            _ => format!("{this} wins: less residual vibration {time}."),
        })
    }
}

/// `later` or `sooner`.
const fn sooner(is_more: bool) -> &'static str {
    if is_more { "later" } else { "sooner" }
}

/// True for two different dampings.
fn is_other_damping(one: f64, other: f64) -> bool {
    let (less, more) = (one.abs().min(other.abs()), one.abs().max(other.abs()));
    more > OTHER_DAMPING * less
}

/// Natural frequency (Hz) and damping ratio of the mode in which a run rings.
pub(super) fn mode(run: Compared<'_>) -> Option<(f64, f64)> {
    let (frequency, _) = run.metric(Name::ResidualVibrationFrequency)?;
    Some((frequency, run.metric(Name::ResidualVibrationDamping)?.0))
}

/// A size in words, relative to a reference that is `ratio` times as large.
fn size(ratio: f64) -> String {
    match Relation::of(1.0, 1.0 / ratio) {
        Relation::Same => "as much".into(),
        relation => relation.to_string(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::compare::Noise;
    use servobench_results::RunResult;
    use servobench_results::samples::{jerk, lambrechts_move, of_numbers, snap};
    use servobench_trace::Move;

    fn words(one: &RunResult, two: &RunResult) -> String {
        words_of_moves(one, two, [&[], &[]])
    }

    fn words_of_moves(one: &RunResult, two: &RunResult, moves: [&[Move]; 2]) -> String {
        let one = Compared { label: "jerk", result: one, moves: moves[0], noise: Noise::None };
        let two = Compared { label: "snap", result: two, moves: moves[1], noise: Noise::None };
        Comparison::new(vec![one, two]).words(76)
    }

    #[test]
    fn a_ratio_stands_beside_what_the_set_points_make_of_the_frequencies_around() {
        let (third, fourth) = ([lambrechts_move(3)], [lambrechts_move(4)]);
        let text = words_of_moves(&jerk(), &snap(), [&third, &fourth]).replace('\n', " ");
        // The ratio has its pole within 10 % of 38.985 Hz, at 40 Hz.
        assert!(text.contains("four in five ring from 9.3 × less to 100 × less."), "{text}");
        assert!(!text.contains("differ"), "{text}");
    }

    #[test]
    fn where_more_than_the_set_points_differs_their_closed_form_says_nothing() {
        let (jerk, snap, third, fourth) = (jerk(), snap(), [lambrechts_move(3)], [lambrechts_move(4)]);
        let one = Compared { label: "jerk", result: &jerk, moves: &third, noise: Noise::None };
        let two = Compared { label: "snap", result: &snap, moves: &fourth, noise: Noise::None };
        let text = Comparison::new(vec![one, two]).of_more_than_set_points().words(76);
        assert!(!text.contains("closed form") && text.contains("16 × less"), "{text}");
    }

    #[test]
    fn limits_that_differ_are_said() {
        let slow = Move { limits: [Some(0.5), Some(5.0), Some(50.0), None], ..lambrechts_move(3) };
        let text = words_of_moves(&jerk(), &snap(), [&[slow], &[lambrechts_move(4)]]).replace('\n', " ");
        assert!(text.contains("Their limits differ: velocity 1.00 m/s against 500 mm/s."), "{text}");
    }

    #[test]
    fn words_of_two() {
        insta::assert_snapshot!(words(&jerk(), &snap()), @r#"
        snap leaves 105 nm of residual vibration (amplitude of the mode) where jerk
        leaves 1.70 µm: 16 × less. The load rings at 38.98 Hz (ζ = 0.0021); the
        ratio holds for this mode, not for every other. The snap move takes 50.0 ms
        (3.8 %) longer. With settling, it is in position 46.0 ms (3.5 %) later. Its
        peak following error is 4.2 × less, peak force the same, RMS force 2.0 %
        less. snap leaves less residual vibration, jerk is in position sooner: it is
        a choice.
        "#);
    }

    /// The order in which runs are given does not decide which one wins.
    #[test]
    fn the_quieter_run_is_the_subject_whichever_comes_first() {
        let (jerk, snap) = (jerk(), snap());
        let runs = vec![
            Compared { label: "snap", result: &snap, moves: &[], noise: Noise::None },
            Compared { label: "jerk", result: &jerk, moves: &[], noise: Noise::None },
        ];
        assert_eq!(Comparison::new(runs).words(76), words(&jerk, &snap));
    }

    #[test]
    fn within_one_per_cent_nobody_wins() {
        let one = of_numbers("one", [1.3, 0.1, 3e-6, 3.40e-6, 39.0, 0.002, 170.0, 60.0]);
        let two = of_numbers("two", [1.309, 0.1, 3e-6, 3.42e-6, 39.0, 0.002, 170.0, 60.0]);
        let text = words(&one, &two).replace('\n', " ");
        assert!(text.contains("leave the same residual vibration within 1 %: 1.71 µm."), "{text}");
        assert!(text.contains("Between snap and jerk there is nothing to choose."), "{text}");
        assert!(!text.contains("wins") && !text.contains("less"), "{text}");
    }

    #[test]
    fn each_outcome_has_its_conclusion() {
        let conclusion = |time: f64, vibration: f64| {
            let one = of_numbers("one", [1.0, 0.0, 3e-6, 1e-6, 39.0, 0.002, 170.0, 60.0]);
            let two = of_numbers("two", [time, 0.0, 3e-6, vibration, 39.0, 0.002, 170.0, 60.0]);
            let text = words(&one, &two).replace('\n', " ");
            text.trim_end().rsplit_once(". ").unwrap().1.to_owned()
        };
        assert_eq!(
            conclusion(1.1, 0.5e-6),
            "snap leaves less residual vibration, jerk is in position sooner: it is a choice."
        );
        assert_eq!(conclusion(1.0, 0.5e-6), "snap wins: less residual vibration in the same time.");
        assert_eq!(conclusion(0.9, 0.5e-6), "snap wins: less residual vibration, and in position sooner.");
        assert_eq!(conclusion(0.9, 1e-6), "snap wins: in position sooner at equal vibration.");
        assert_eq!(conclusion(1.1, 1e-6), "jerk wins: in position sooner at equal vibration.");
        assert_eq!(conclusion(1.1, 2e-6), "jerk wins: less residual vibration, and in position sooner.");
    }

    #[test]
    fn a_run_that_never_settles_does_not_win() {
        let (jerk, mut snap) = (jerk(), snap());
        snap.metrics = snap.metrics.into_iter().filter(|(name, _)| !name.contains("settling")).collect();
        snap.absent.insert("settling_time".into(), "`move to 1 m` has not settled: the load left its window".into());
        assert!(words(&jerk, &snap).contains("jerk wins: only it settles."));
    }
}
