//! Geoms that could touch, by MuJoCo's filter: bit masks, rigidly joined bodies, parent and child, excluded pairs.
use super::refusal::MjcfRefusal;
use mjcf_rs::Model;
use mjcf_rs::body::Geom;

/// Every pair of bodies with geoms that could touch.
pub(crate) fn possible_contacts(model: &Model) -> Vec<MjcfRefusal> {
    let mut refusals = vec![];
    for (second, entry) in model.bodies.iter().enumerate() {
        for (first, other) in model.bodies[..second].iter().enumerate() {
            let touch = entry.body.geoms.iter().any(|a| other.body.geoms.iter().any(|b| collide(a, b)));
            if touch && !filtered(model, first, second) {
                let name = |id: usize| match &model.bodies[id].body.name {
                    Some(name) => name.clone(),
                    None if id == 0 => "world".into(),
                    None => "(without a name)".into(),
                };
                refusals.push(MjcfRefusal::Contact { first: name(first), second: name(second) });
            }
        }
    }
    refusals
}

fn collide(a: &Geom, b: &Geom) -> bool {
    a.contype & b.conaffinity != 0 || b.contype & a.conaffinity != 0
}

fn filtered(model: &Model, first: usize, second: usize) -> bool {
    let (a, b) = (rigid_root(model, first), rigid_root(model, second));
    let parent = |id: usize| model.bodies[id].parent.map(|parent| rigid_root(model, parent));
    let family = a != 0 && b != 0 && (parent(a) == Some(b) || parent(b) == Some(a));
    let named = |id: usize, name: &str| model.bodies[id].body.name.as_deref() == Some(name);
    let excluded = model.contact.excludes.iter().any(|pair| {
        named(first, &pair.body1) && named(second, &pair.body2)
            || named(first, &pair.body2) && named(second, &pair.body1)
    });
    a == b || family || excluded
}

/// The nearest body with a joint to which `id` is rigidly joined, or the world.
fn rigid_root(model: &Model, mut id: usize) -> usize {
    while let Some(parent) = model.bodies[id].parent.filter(|_| model.bodies[id].body.joints.is_empty()) {
        id = parent;
    }
    id
}
