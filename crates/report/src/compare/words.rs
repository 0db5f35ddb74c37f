//! What the table says, in words.
use super::relation::{Relation, percent};
use super::{Compared, Comparison, Value, force_or_torque, in_words, many, vibration_of};
use crate::text::wrapped;
use servobench_metrics::{Name, Quantity, ResidualRatios};

impl Comparison<'_> {
    /// What the table says, in sentences of lines that fit `width`.
    #[must_use]
    pub fn words(&self, width: usize) -> String {
        let sentences = match self.runs.as_slice() {
            [] | [_] => vec!["There is nothing to compare.".to_owned()],
            [one, two] => Pair { is_of_set_points: self.is_of_set_points, ..Pair::of(*one, *two) }.sentences(),
            many => many::sentences(many),
        };
        wrapped(&sentences.join(" "), width).join("\n") + "\n"
    }
}

/// Frequencies on either side of a mode that are looked at, relative.
const AROUND: f64 = 0.1;

/// Names of the derivatives that have limits, and their powers of the second.
const DERIVATIVES: [(&str, &str); 4] = [("velocity", ""), ("acceleration", "²"), ("jerk", "³"), ("snap", "⁴")];

/// Two runs: the one of which the sentences speak, and the other.
struct Pair<'a> {
    this: Compared<'a>,
    other: Compared<'a>,
    /// By which metric their vibrations are held against each other.
    vibration: Name,
    /// Whether only their set-points differ.
    is_of_set_points: bool,
}

impl<'a> Pair<'a> {
    /// Speaks of the run that leaves less vibration; of the second when that does not decide.
    fn of(one: Compared<'a>, two: Compared<'a>) -> Self {
        let vibration = vibration_of(&[one, two]);
        let value = |run: Compared<'_>| run.metric(vibration).map(|(value, _)| value);
        match (value(one), value(two)) {
            (Some(first), Some(second)) if Relation::of(first, second).is_more() => {
                Self { this: one, other: two, vibration, is_of_set_points: true }
            }
            _ => Self { this: two, other: one, vibration, is_of_set_points: true },
        }
    }

    /// Values of both, this run's first.
    fn both(&self, name: Name) -> Option<(Value<'a>, Value<'a>)> {
        Some((self.this.metric(name)?, self.other.metric(name)?))
    }

    /// How this run stands to the other.
    fn relation(&self, name: Name) -> Option<Relation> {
        self.both(name).map(|(this, other)| Relation::of(other.0, this.0))
    }

    fn sentences(&self) -> Vec<String> {
        let sentences = [
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

    fn vibration(&self) -> Option<String> {
        let (this, other) = (self.this.label, self.other.label);
        let Some(((value, unit), (reference, _))) = self.both(self.vibration) else {
            let without = [self.this, self.other];
            let without = without.into_iter().find(|run| run.metric(self.vibration).is_none())?;
            return Some(format!("The residual vibration of {} was not measured.", without.label));
        };
        let (value, reference_text) = (Quantity::new(value, unit), Quantity::new(reference, unit));
        Some(match Relation::of(reference, value.value) {
            Relation::Same => format!("{this} and {other} leave the same residual vibration within 1 %: {value}."),
            relation => format!(
                "{this} leaves {value} of residual vibration ({}) where {other} leaves {reference_text}: {relation}.",
                in_words(self.vibration)
            ),
        })
    }

    /// At which frequency and damping the ratio holds.
    fn mode(&self) -> Option<String> {
        if matches!(self.relation(self.vibration), None | Some(Relation::Same)) {
            return None;
        }
        let text = |(frequency, damping)| {
            format!("{:.4} (ζ = {:.2})", Quantity::new(frequency, "Hz"), Quantity::new(damping, ""))
        };
        let holds = "the ratio holds for this mode, not for every other.";
        Some(match (mode(self.this), mode(self.other)) {
            (Some(this), Some(other)) if Relation::of(other.0, this.0) != Relation::Same => format!(
                "They ring in different modes, {} at {} and {} at {}.",
                self.this.label,
                text(this),
                self.other.label,
                text(other)
            ),
            (_, Some(mode)) | (Some(mode), None) => format!("The load rings at {}; {holds}", text(mode)),
            (None, None) => return None,
        })
    }

    /// What the set-points alone make of modes that lie beside the one measured: a ratio near a zero of a spectrum changes
    /// several times over within a per cent.
    fn beside_the_mode(&self) -> Option<String> {
        if !self.is_of_set_points
            || self.vibration != Name::ResidualVibrationAmplitude
            || self.relation(self.vibration) == Some(Relation::Same)
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

    /// Limits that differ: then it is not the order of the profile that makes the difference.
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
        Some(match Relation::of(other, this) {
            Relation::Same => format!("Both moves take {}.", Quantity::new(this, unit)),
            relation => format!(
                "The move of {} takes {} ({:.2} %) {}.",
                self.this.label,
                Quantity::new((this - other).abs(), unit),
                percent(other, this),
                if relation.is_more() { "longer" } else { "less time" }
            ),
        })
    }

    fn settling(&self) -> Option<String> {
        let name = Name::MoveAndSettlingTime;
        if let Some(((this, unit), (other, _))) = self.both(name) {
            return Some(match Relation::of(other, this) {
                Relation::Same => format!("With settling, both take {}.", Quantity::new(this, unit)),
                relation => format!(
                    "With settling, it is in position {} ({:.2} %) {}.",
                    Quantity::new((this - other).abs(), unit),
                    percent(other, this),
                    if relation.is_more() { "later" } else { "sooner" }
                ),
            });
        }
        None
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

    /// Who wins, if anyone does.
    fn conclusion(&self) -> Option<String> {
        let settled = |run: Compared<'_>| run.metric(Name::MoveAndSettlingTime).is_some();
        match (settled(self.this), settled(self.other)) {
            (true, false) => return Some(format!("{} wins: only it settles.", self.this.label)),
            (false, true) => return Some(format!("{} wins: only it settles.", self.other.label)),
            _ => {}
        }
        let vibration = self.relation(self.vibration)?;
        let arrival = self.relation(Name::MoveAndSettlingTime).or_else(|| self.relation(Name::MoveTime))?;
        let (this, other) = (self.this.label, self.other.label);
        Some(match (vibration, arrival) {
            (Relation::Same, Relation::Same) => format!("Between {this} and {other} there is nothing to choose."),
            (Relation::Same, Relation::Less(_)) => format!("{this} wins: it arrives sooner at equal vibration."),
            (Relation::Same, Relation::More(_)) => format!("{other} wins: it arrives sooner at equal vibration."),
            (_, Relation::Same) => format!("{this} wins: it shakes its load less in the same time."),
            (_, Relation::Less(_)) => format!("{this} wins: it shakes its load less and arrives sooner."),
            (_, Relation::More(_)) => format!("{this} shakes its load less, {other} arrives sooner."),
        })
    }
}

/// Natural frequency (Hz) and damping ratio of the mode in which a run rings.
pub(super) fn mode(run: Compared<'_>) -> Option<(f64, f64)> {
    let (frequency, _) = run.metric(Name::ResidualVibrationFrequency)?;
    Some((frequency, run.metric(Name::ResidualVibrationDamping)?.0))
}

/// How a size stands to a reference that is `ratio` times as large.
fn size(ratio: f64) -> String {
    match Relation::of(1.0, 1.0 / ratio) {
        Relation::Same => "as much".into(),
        relation => relation.to_string(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use servobench_results::RunResult;
    use servobench_results::samples::{jerk, lambrechts_move, of_numbers, snap};
    use servobench_trace::Move;

    fn words(one: &RunResult, two: &RunResult) -> String {
        words_of_moves(one, two, [&[], &[]])
    }

    fn words_of_moves(one: &RunResult, two: &RunResult, moves: [&[Move]; 2]) -> String {
        let one = Compared { label: "jerk", result: one, moves: moves[0] };
        let two = Compared { label: "snap", result: two, moves: moves[1] };
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
        let one = Compared { label: "jerk", result: &jerk, moves: &third };
        let two = Compared { label: "snap", result: &snap, moves: &fourth };
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
        ratio holds for this mode, not for every other. The move of snap takes
        50.0 ms (3.8 %) longer. With settling, it is in position 46.0 ms (3.5 %)
        later. Its peak following error is 4.2 × less, peak force the same, RMS
        force 2.0 % less. snap shakes its load less, jerk arrives sooner.
        "#);
    }

    /// The order in which runs are given does not decide who wins.
    #[test]
    fn the_quieter_run_is_the_subject_whichever_comes_first() {
        let (jerk, snap) = (jerk(), snap());
        let runs = vec![
            Compared { label: "snap", result: &snap, moves: &[] },
            Compared { label: "jerk", result: &jerk, moves: &[] },
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
        assert_eq!(conclusion(1.1, 0.5e-6), "snap shakes its load less, jerk arrives sooner.");
        assert_eq!(conclusion(1.0, 0.5e-6), "snap wins: it shakes its load less in the same time.");
        assert_eq!(conclusion(0.9, 0.5e-6), "snap wins: it shakes its load less and arrives sooner.");
        assert_eq!(conclusion(0.9, 1e-6), "snap wins: it arrives sooner at equal vibration.");
        assert_eq!(conclusion(1.1, 1e-6), "jerk wins: it arrives sooner at equal vibration.");
        assert_eq!(conclusion(1.1, 2e-6), "jerk wins: it shakes its load less and arrives sooner.");
    }

    #[test]
    fn a_run_that_never_settles_does_not_win() {
        let (jerk, mut snap) = (jerk(), snap());
        snap.metrics = snap.metrics.into_iter().filter(|(name, _)| !name.contains("settling")).collect();
        assert!(words(&jerk, &snap).contains("jerk wins: only it settles."));
    }
}
