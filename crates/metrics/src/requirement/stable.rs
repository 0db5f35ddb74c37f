//! `stable`: the linear loop has no pole outside the unit circle; nothing swings between its limits; no oscillation grows.
use super::Rules;
use super::growth::growth;
use super::rules::{Driven, LinearLoop};
use super::swings::between_limits;
use servobench_trace::Recording;

/// Reasons why the axis is not stable; `None` where no loop is closed.
pub(super) fn broken(recording: &Recording, rules: &Rules<'_>) -> Option<Vec<String>> {
    if rules.driven != Driven::ByLoops {
        return None;
    }
    let linear = match &rules.linear_loop {
        LinearLoop::Unstable(words) => Some(words.clone()),
        LinearLoop::Stable | LinearLoop::NotAnalysed => None,
    };
    Some(linear.into_iter().chain(between_limits(recording, rules)).chain(growth(recording, rules)).collect())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::requirement::tests::rules;
    use crate::synthetic::Build;

    #[test]
    fn an_unstable_linear_loop_is_unstable_whatever_the_trace_shows() {
        let linear_loop = LinearLoop::Unstable("the loop is unstable".into());
        let recording = Build::new(1000, 1001).finish();
        let found = broken(&recording, &Rules { linear_loop: linear_loop.clone(), ..rules() }).unwrap();
        assert_eq!(found, ["the loop is unstable"]);
        for driven in [Driven::Exactly, Driven::Not] {
            assert_eq!(broken(&recording, &Rules { linear_loop: linear_loop.clone(), driven, ..rules() }), None);
        }
    }
}
