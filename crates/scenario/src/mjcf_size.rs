//! Number of bodies and joints that an MJCF file creates. A few words may create any number: `<replicate count="100000">` repeats its
//! content that often, `<composite>` and `<flexcomp>` create a body per point of a grid, `<attach>` the tree of another file. The
//! library that compiles such a file cannot be interrupted, so they are counted here first.
//!
//! Source: MuJoCo documentation, *XML Reference*, `replicate`, `composite`, `flexcomp`, `attach`.
use crate::access::Refused;
use roxmltree::{Document, Node};
use std::path::Path;

/// Largest number of bodies and of joints in all files of a model: several times those of the largest published models (100
/// humanoids have 1 600). The library takes a minute for a hundred thousand.
const MOST: u64 = 5_000;
/// Largest number of elements of any kind, as many as may be written out.
const MOST_ELEMENTS: u64 = 300_000;

/// Numbers of elements that the files of a model create.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct Size {
    bodies: u64,
    joints: u64,
    elements: u64,
    /// Number of times that the tree of another file is attached, multiplied over files that attach each other.
    attached: u64,
}

impl Default for Size {
    fn default() -> Self {
        Self { bodies: 0, joints: 0, elements: 0, attached: 1 }
    }
}

impl Size {
    /// Adds the elements of a file.
    pub(crate) fn add(&mut self, document: &Document<'_>) {
        let mut attached = 0_u64;
        // The element, and the number of copies made by the elements above it.
        let mut pending = vec![(document.root_element(), 1_u64)];
        while let Some((node, times)) = pending.pop() {
            let name = node.tag_name().name();
            let points = || times.saturating_mul(count(node));
            self.elements = self.elements.saturating_add(times);
            match name {
                "body" => self.bodies = self.bodies.saturating_add(times),
                "joint" | "freejoint" => self.joints = self.joints.saturating_add(times),
                "composite" | "flexcomp" => self.bodies = self.bodies.saturating_add(points()),
                "attach" => attached = attached.saturating_add(times),
                _ => {}
            }
            let times = if name == "replicate" { points() } else { times };
            pending.extend(node.children().filter(Node::is_element).map(|child| (child, times)));
        }
        self.attached = self.attached.saturating_mul(attached.max(1));
    }

    /// Refuses a model with too many elements; `path` is its main file.
    pub(crate) fn hold(self, path: &Path) -> Result<(), Refused> {
        let all =
            [("bodies", self.bodies, MOST), ("joints", self.joints, MOST), ("elements", self.elements, MOST_ELEMENTS)];
        for (what, made, most) in all {
            let made = made.saturating_mul(self.attached);
            if made > most {
                return Err(Refused {
                    message: format!(
                        "`{}` makes {made} {what}, replicated, composite and attached ones included, and at most {most} are read",
                        path.display()
                    ),
                    help: "leave out bodies that neither carry nor drive the axis, or join them into one",
                });
            }
        }
        Ok(())
    }
}

/// The product of the numbers in the attribute `count`; 1 without the attribute. The library refuses anything but numbers.
fn count(node: Node<'_, '_>) -> u64 {
    let numbers = node.attribute("count").unwrap_or("1").split_whitespace();
    numbers.filter_map(|number| number.parse::<u64>().ok()).fold(1, u64::saturating_mul)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn refusal(bodies: &[&str]) -> Option<String> {
        let mut size = Size::default();
        for inner in bodies {
            let text = format!("<mujoco><worldbody>{inner}</worldbody></mujoco>");
            size.add(&Document::parse(&text).unwrap());
        }
        size.hold(Path::new("arm.xml")).err().map(|refused| refused.message)
    }

    #[test]
    fn few_words_for_many_bodies_are_refused() {
        for many in [
            "<replicate count=\"100000\"><body/></replicate>",
            "<replicate count=\"100\"><frame><replicate count=\"100\"><body/></replicate></frame></replicate>",
            "<body><composite type=\"cable\" count=\"6000 1 1\"/></body>",
            "<flexcomp type=\"grid\" count=\"20 20 20\"/>",
            "<body><replicate count=\"18446744073709551615\"><joint/><joint/></replicate></body>",
            "<replicate count=\"400000\"><geom/></replicate>",
        ] {
            assert!(refusal(&[many]).is_some(), "{many}");
        }
        let words = refusal(&["<body/>", "<replicate count=\"100000\"><body/></replicate>"]).unwrap();
        assert!(words.contains("`arm.xml` makes 100001 bodies") && words.contains("at most 5000 are read"), "{words}");
        // Each file attaches the next one this often.
        let attaching = "<replicate count=\"60\"><attach model=\"m\" body=\"b\"/></replicate>";
        assert!(refusal(&[attaching, attaching, "<body/><body/>"]).is_some());
    }

    #[test]
    fn what_is_published_is_read() {
        let humanoids = "<replicate count=\"100\"><body><joint/><body><joint/><geom/></body></body></replicate>";
        assert_eq!(refusal(&[humanoids]), None);
        assert_eq!(refusal(&["<body/>".repeat(5_000).as_str()]), None);
        assert_eq!(refusal(&["<replicate count=\"many\"><body/></replicate>"]), None, "for the library to refuse");
        assert_eq!(refusal(&["<attach model=\"a\" body=\"b\"/>", "<body><joint/></body>"]), None);
    }
}
