//! Allowed combinations of causality, variability and initial.
//!
//! Source: FMI 2.0.5, §2.2.7, tables of the attributes of `ScalarVariable`; FMI 3.0.2, §2.4.7.4, tables "allowed combinations of
//! variability/causality" and "definition of initial". The two versions agree where both have the causality; 2.0 alone
//! refuses `initial` for inputs, 3.0 takes `exact`.
use super::variable::{Causality, Initial, Variability};

/// Variabilities that a causality can have.
pub(super) fn variabilities(causality: Causality) -> &'static [Variability] {
    use Variability::{Constant, Continuous, Discrete, Fixed, Tunable};
    match causality {
        Causality::StructuralParameter | Causality::Parameter | Causality::CalculatedParameter => &[Fixed, Tunable],
        Causality::Input => &[Discrete, Continuous],
        Causality::Output => &[Constant, Discrete, Continuous],
        Causality::Local => &[Constant, Fixed, Tunable, Discrete, Continuous],
        Causality::Independent => &[Continuous],
    }
}

/// Values of `initial` of a causality and variability that go together, the default first.
pub(super) fn initials(causality: Causality, variability: Variability) -> &'static [Initial] {
    use Initial::{Approx, Calculated, Exact};
    match (causality, variability) {
        (Causality::Independent, _) => &[],
        (_, Variability::Constant) | (Causality::StructuralParameter | Causality::Parameter | Causality::Input, _) => {
            &[Exact]
        }
        (_, Variability::Fixed | Variability::Tunable) => &[Calculated, Approx],
        (_, Variability::Discrete | Variability::Continuous) => &[Calculated, Exact, Approx],
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use servobench_config::Choice as _;

    /// The table of FMI 3.0.2 row by row as printed: `-` not allowed, else the initial values, the default in capitals.
    const PRINTED: &str = "
        constant    -    -    -     -    E    E    -
        fixed       E    E    Ca    -    -    Ca   -
        tunable     E    E    Ca    -    -    Ca   -
        discrete    -    -    -     E    Cea  Cea  -
        continuous  -    -    -     E    Cea  Cea  none";

    #[test]
    fn the_tables_are_those_of_the_standard() {
        let columns = [
            Causality::StructuralParameter,
            Causality::Parameter,
            Causality::CalculatedParameter,
            Causality::Input,
            Causality::Output,
            Causality::Local,
            Causality::Independent,
        ];
        for row in PRINTED.trim().lines() {
            let mut cells = row.split_whitespace();
            let variability = Variability::from_name(cells.next().unwrap()).unwrap();
            for (causality, cell) in columns.into_iter().zip(cells) {
                let is_allowed = variabilities(causality).contains(&variability);
                assert_eq!(is_allowed, cell != "-", "{variability:?} {causality:?}");
                if !is_allowed {
                    continue;
                }
                let letters: String = initials(causality, variability)
                    .iter()
                    .map(|initial| initial.name().chars().next().unwrap())
                    .collect();
                assert_eq!(letters, cell.to_lowercase().trim_start_matches("none"), "{variability:?} {causality:?}");
            }
        }
    }
}
