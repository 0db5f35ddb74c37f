//! Names of runs in tables and text.

/// Names without their common prefix: `lambrechts-jerk` and `lambrechts-snap` become `jerk` and `snap`. Equal ones are numbered.
pub(super) fn labels(names: &[&str]) -> Vec<String> {
    let parts: Vec<Vec<&str>> = names.iter().map(|name| name.split('-').collect()).collect();
    let shortest = parts.iter().map(Vec::len).min().unwrap_or(0);
    let same = |i: usize| parts.iter().all(|one| one[i] == parts[0][i]);
    let front = if names.len() < 2 { 0 } else { (0..shortest.saturating_sub(1)).take_while(|i| same(*i)).count() };
    let mut labels: Vec<String> = parts.iter().map(|one| one[front..].join("-")).collect();
    for i in 0..labels.len() {
        if labels[..i].contains(&labels[i]) {
            labels[i] = format!("{}-{}", labels[i], i + 1);
        }
    }
    labels
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn labels_are_what_tells_the_names_apart() {
        assert_eq!(labels(&["lambrechts-jerk", "lambrechts-snap"]), ["jerk", "snap"]);
        assert_eq!(labels(&["jerk", "snap"]), ["jerk", "snap"]);
        assert_eq!(labels(&["a-b", "a-b", "a"]), ["a-b", "a-b-2", "a"]);
        assert_eq!(labels(&["lambrechts-jerk"]), ["lambrechts-jerk"]);
    }
}
