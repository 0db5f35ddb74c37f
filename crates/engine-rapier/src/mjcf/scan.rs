//! Checks a file against the grammar: all elements, attributes and values outside of it are found at once.
use super::grammar::{Element, ROOT, Values};
use super::refusal::{MjcfRefusal, list, names};
use roxmltree::{Document, Node};
use servobench_files::quoted;

/// Everything outside of the grammar.
pub(crate) fn scan(document: &Document) -> Vec<MjcfRefusal> {
    let root = document.root_element();
    if root.tag_name().name() != ROOT.name {
        let message =
            format!("the root element is <{}>, that of an MJCF file is <mujoco>", quoted(root.tag_name().name()));
        return vec![MjcfRefusal::Unreadable { message }];
    }
    let mut refusals = vec![];
    visit(root, &ROOT, &mut refusals);
    classes(root, &mut refusals);
    refusals
}

/// Checks default classes: each has a name, and all classes referred to exist.
fn classes(root: Node, refusals: &mut Vec<MjcfRefusal>) {
    let mut known = vec!["main"];
    for node in root.descendants().filter(|node| node.has_tag_name("default")) {
        let top = node.parent() == Some(root);
        match node.attribute("class") {
            Some(name) if top && name != "main" => refusals.push(MjcfRefusal::Value {
                line: line(node),
                element: "default",
                attribute: "class".into(),
                value: name.into(),
                supported: "`main`, or left out, in an outermost <default>".into(),
            }),
            Some(name) => known.push(name),
            None if top => {}
            None => refusals.push(MjcfRefusal::Missing { line: line(node), element: "default", attribute: "class" }),
        }
    }
    for node in root.descendants().filter(|node| !node.has_tag_name("default")) {
        for name in ["class", "childclass"].into_iter().filter_map(|attribute| node.attribute(attribute)) {
            if !known.contains(&name) {
                let known = names(known.iter().copied());
                refusals.push(MjcfRefusal::Unknown { what: "default class", name: name.into(), known });
            }
        }
    }
}

/// Line of a node, from 1.
pub(crate) fn line(node: Node) -> u32 {
    node.document().text_pos_at(node.range().start).row
}

/// Most refusals: nobody reads more, and finding the line of each takes time in proportion to the file.
const MOST_REFUSALS: usize = 100;

fn visit(node: Node, element: &'static Element, refusals: &mut Vec<MjcfRefusal>) {
    if element.idle || refusals.len() >= MOST_REFUSALS {
        return;
    }
    for attribute in node.attributes() {
        let (name, value) = (attribute.name(), attribute.value());
        let Some((_, values)) = element.attributes.iter().find(|(known, _)| *known == name) else {
            refusals.push(MjcfRefusal::Attribute {
                line: line(node),
                element: element.name,
                attribute: name.into(),
                supported: list(element.attributes.iter().map(|(name, _)| *name)),
            });
            continue;
        };
        if let Some(supported) = objection(*values, value) {
            refusals.push(MjcfRefusal::Value {
                line: line(node),
                element: element.name,
                attribute: name.into(),
                value: value.into(),
                supported,
            });
        }
    }
    for child in node.children().filter(Node::is_element) {
        let name = child.tag_name().name();
        match element.children.iter().find(|known| known.name == name) {
            Some(known) => visit(child, known, refusals),
            None if refusals.len() >= MOST_REFUSALS => return,
            None => refusals.push(MjcfRefusal::Element {
                line: line(child),
                element: name.into(),
                parent: element.name,
                supported: list(element.children.iter().map(|child| child.name)),
            }),
        }
    }
}

/// Allowed value, if this one is not.
fn objection(values: Values, value: &str) -> Option<String> {
    let number = |word: &str| word.parse().ok().filter(|x: &f64| x.is_finite());
    match values {
        Values::Any => None,
        Values::NotNegative => {
            (!number(value.trim()).is_some_and(|x| x >= 0.0)).then(|| "one number that is not negative".into())
        }
        Values::OneOf(words) => (!words.contains(&value)).then(|| list(words.iter().copied())),
        Values::Numbers(least, most) => {
            let numbers: Option<Vec<f64>> = value.split_ascii_whitespace().map(number).collect();
            let fits = numbers.is_some_and(|numbers| (least..=most).contains(&numbers.len()));
            (!fits).then(|| match (least, most) {
                (1, 1) => "one finite number".into(),
                _ if least == most => format!("{most} finite numbers"),
                _ => format!("{least} to {most} finite numbers"),
            })
        }
    }
}
