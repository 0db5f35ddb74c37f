//! Features of a user's own MJCF file that an engine treats unexpectedly.
use super::Doubt;
use servobench_plant::EngineName;
use servobench_scenario::{AxisMechanics, Scenario};

/// Dry friction of a joint.
const FRICTION: &str = "frictionloss";

/// Doubts about the file of `scenario` on `engines`.
pub(super) fn doubts(scenario: &Scenario, engines: &[EngineName]) -> Vec<Doubt> {
    let AxisMechanics::Mjcf(mjcf) = &scenario.axis.mechanics else { return Vec::new() };
    let creeping = engines.iter().filter(|engine| engine.capabilities().creeps);
    creeping.flat_map(|engine| creeps(*engine, &mjcf.xml)).collect()
}

/// A joint of the file creeps on `engine`.
fn creeps(engine: EngineName, xml: &str) -> impl Iterator<Item = Doubt> {
    lines_with(xml, FRICTION).map(move |line| {
        let message = format!(
            "on `{engine}` a joint with `frictionloss` creeps: the friction is a soft constraint that slides slowly under an \
             effort below it (2.1 mm/s at 4 N of 5 N, 2 kg)"
        );
        let help = "the engine `rapier` holds such a joint; bodies in `[axis]` with `coulomb` are held on every engine";
        Doubt { line: Some(line), ..Doubt::new("axis.mjcf.file", message, help) }
    })
}

/// Lines, from 1, on which an attribute has a value above zero, without comments.
fn lines_with<'a>(xml: &'a str, attribute: &'a str) -> impl Iterator<Item = u32> + 'a {
    let is_there = move |line: &str| {
        line.match_indices(attribute).any(|(at, _)| {
            let before = line[..at].chars().next_back();
            let value = line[at + attribute.len()..].trim_start().strip_prefix('=').map(str::trim_start);
            let quoted = value.and_then(|value| value.strip_prefix(['"', '\'']));
            let number = quoted.and_then(|value| value.split(['"', '\'']).next()?.trim().parse::<f64>().ok());
            before.is_none_or(char::is_whitespace) && number.is_some_and(|number| number > 0.0)
        })
    };
    let mut in_comment = false;
    (1..).zip(xml.lines()).filter_map(move |(number, line)| {
        let mut outside = String::new();
        let mut rest = line;
        while !rest.is_empty() {
            let (part, end) = if in_comment { (rest.find("-->"), 3) } else { (rest.find("<!--"), 4) };
            let upto = part.unwrap_or(rest.len());
            if !in_comment {
                outside.push_str(&rest[..upto]);
            }
            in_comment ^= part.is_some();
            rest = rest.get(upto + end..).unwrap_or_default();
        }
        is_there(&outside).then_some(number)
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn attributes_are_found_by_their_lines() {
        let xml = "<mujoco>\n<joint name=\"x\" frictionloss=\"5\"/>\n<!-- frictionloss=\"5\"\n<joint frictionloss='1'/>\n-->\n\
                   <joint frictionloss=\"0\"/> <!-- --> <joint damping=\"2\"\nfrictionloss = '.25'/>\n<joint my_frictionloss=\"3\"/>\n";
        assert_eq!(lines_with(xml, FRICTION).collect::<Vec<_>>(), [2, 7]);
    }
}
