//! Whatever is in a file, it is a scenario or a list of mistakes with places in their files.
//!
//! `PROPTEST_CASES=100000` runs more cases than CI does.
use proptest::prelude::*;
use servobench_scenario::{LoadError, Sources, parse};

/// Loads `text`; every place that is named must be in its file.
fn check(text: &str) -> Result<(), TestCaseError> {
    let places = |sources: &Sources, all: &[servobench_scenario::Diagnostic]| {
        for one in all {
            let file = sources.text(one.source);
            prop_assert!(
                file.get(one.span.clone()).is_some(),
                "{:?} in {} bytes: {}",
                one.span,
                file.len(),
                one.message
            );
            prop_assert!(!one.message.is_empty() && !one.line(sources).is_empty());
        }
        Ok(())
    };
    match parse("any.toml", text, None) {
        Ok(loaded) => places(&loaded.sources, &loaded.warnings),
        Err(LoadError::Invalid(invalid)) => {
            prop_assert!(!invalid.diagnostics.is_empty());
            places(&invalid.sources, &invalid.diagnostics)?;
            places(&invalid.sources, &invalid.warnings)
        }
        Err(other) => Err(TestCaseError::fail(other.to_string())),
    }
}

const SEEDS: [&str; 3] = [
    include_str!("../../../scenarios/feed-axis-move.toml"),
    include_str!("../../../scenarios/two-mass-ring-down.toml"),
    include_str!("../../../scenarios/emps.toml"),
];

/// What mistakes are made of.
fn fragment() -> impl Strategy<Value = String> {
    prop_oneof![
        "[a-z_]{1,12}",
        "[-+0-9.e]{1,8}",
        "\"[-+0-9.e]{1,6} [a-zA-Zµ°%/·^2³ ]{0,8}\"",
        Just("\"".to_owned()),
        Just("[".to_owned()),
        Just("]]".to_owned()),
        Just("{".to_owned()),
        Just("\n".to_owned()),
        Just("\"\"\"".to_owned()),
        Just(" = ".to_owned()),
        Just("[drive.velocity]\n".to_owned()),
        Just("lead = \"10 mm\"\n".to_owned()),
        Just("model = \"emps\"\n".to_owned()),
        Just("kind = \"prescribed\"\n".to_owned()),
        Just("inf".to_owned()),
        Just("\u{0}".to_owned()),
        "\\PC{1,4}",
    ]
}

proptest! {
    #[test]
    fn any_text(text in "\\PC{0,400}") {
        check(&text)?;
    }

    #[test]
    fn any_bytes(bytes in proptest::collection::vec(any::<u8>(), 0..400)) {
        check(&String::from_utf8_lossy(&bytes))?;
    }

    /// Pieces of scenarios cut out, doubled and replaced.
    #[test]
    fn any_mutation(
        seed in 0..SEEDS.len(),
        cuts in proptest::collection::vec((any::<prop::sample::Index>(), 0usize..40, fragment()), 1..6),
    ) {
        let mut text: Vec<char> = SEEDS[seed].chars().collect();
        for (at, length, put) in cuts {
            let start = at.index(text.len() + 1);
            let end = (start + length).min(text.len());
            text.splice(start..end, put.chars());
        }
        check(&text.into_iter().collect::<String>())?;
    }

    /// Lines of scenarios in any order, some missing, some twice.
    #[test]
    fn any_order_of_lines(
        seed in 0..SEEDS.len(),
        order in proptest::collection::vec(any::<prop::sample::Index>(), 1..80),
    ) {
        let lines: Vec<&str> = SEEDS[seed].lines().collect();
        let text: Vec<&str> = order.iter().map(|at| lines[at.index(lines.len())]).collect();
        check(&text.join("\n"))?;
    }

    /// Each value of a scenario replaced by something else: one mistake at a time, at its own line.
    #[test]
    fn any_value(seed in 0..SEEDS.len(), which in any::<prop::sample::Index>(), value in fragment()) {
        let lines: Vec<&str> = SEEDS[seed].lines().collect();
        let keyed: Vec<usize> = (0..lines.len()).filter(|&i| lines[i].contains(" = ")).collect();
        let at = keyed[which.index(keyed.len())];
        let (key, _) = lines[at].split_once(" = ").unwrap();
        let replaced = format!("{key} = {value}");
        let text: Vec<&str> = lines.iter().enumerate().map(|(i, line)| if i == at { replaced.as_str() } else { line }).collect();
        check(&text.join("\n"))?;
    }
}
