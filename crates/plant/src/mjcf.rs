//! MJCF of a chain, for the engines that read it: one body per lump on its own slide or hinge along x, coupled by
//! fixed tendons that are spring and damper at once.
//!
//! Dry friction, the bias and the disturbances are not in the file: the engine applies them, so that all engines stick
//! and slip alike.
use crate::chain::Chain;
use crate::mechanics::Drive;
use servobench_base::Coordinate;
use std::fmt::Write as _;

/// Writes the chain as MJCF text. Joints are named after the bodies, the actuator is `motor_effort`, tendons are
/// `link_0`, `link_1`, … With [`Drive::Prescribed`] there is no body 0, and the world is the moving base.
///
/// `step` is the tick length (s). The integrator is RK4: the axis is smooth and its efforts are held, so each
/// tick is accurate to fifth order.
#[must_use]
pub fn chain_to_mjcf(chain: &Chain, drive: Drive, step: f64) -> String {
    let first = usize::from(drive == Drive::Prescribed);
    let mut bodies = String::new();
    for (i, body) in chain.bodies().iter().enumerate().skip(first) {
        let (name, inertia, viscous) = (body.name, body.inertia, body.friction.linear());
        let rotary = body.coordinate == Coordinate::Rotary;
        let (kind, mass) = if rotary { ("hinge", inertia * 1e3) } else { ("slide", inertia) };
        // A slide does not feel the rotational inertia, a hinge not the mass; both must be positive.
        let (size, colour) = (0.05, ["0.45 0.50 0.55 1", "0.20 0.45 0.70 1", "0.90 0.55 0.15 1", "0.5 0.7 0.3 1"][i]);
        let diag = if rotary { inertia } else { inertia * 1e-3 };
        let z = 0.15 * i as f64;
        let _ = write!(
            bodies,
            r#"
    <body name="{name}" pos="0 0 {z}">
      <joint name="{name}" type="{kind}" axis="1 0 0" damping="{viscous:?}"/>
      <inertial pos="0 0 0" mass="{mass:?}" diaginertia="{diag:?} {diag:?} {diag:?}"/>
      <geom type="box" size="{size} {size} {size}" rgba="{colour}" contype="0" conaffinity="0"/>
    </body>"#
        );
    }
    let mut tendons = String::new();
    for (i, link) in chain.links().iter().enumerate() {
        let mut joints = String::new();
        for (j, sign) in [(i, 1.0), (i + 1, -1.0)] {
            if j >= first {
                let body = &chain.bodies()[j];
                let _ = write!(joints, r#"<joint joint="{}" coef="{:?}"/>"#, body.name, sign * body.transmission);
            }
        }
        let (stiffness, damping) = (link.stiffness, link.damping);
        let _ = write!(
            tendons,
            r#"
    <fixed name="link_{i}" stiffness="{stiffness:?}" damping="{damping:?}" springlength="0">{joints}</fixed>"#
        );
    }
    let motor = if first == 0 {
        let name = chain.bodies()[0].name;
        format!("\n  <actuator>\n    <motor name=\"motor_effort\" joint=\"{name}\"/>\n  </actuator>")
    } else {
        String::new()
    };
    let tendons = if tendons.is_empty() { String::new() } else { format!("\n  <tendon>{tendons}\n  </tendon>") };
    format!(
        r#"<mujoco model="servobench chain">
  <compiler angle="radian" inertiafromgeom="false"/>
  <option timestep="{step:?}" gravity="0 0 0" integrator="RK4"/>
  <worldbody>{bodies}
  </worldbody>{tendons}{motor}
</mujoco>
"#
    )
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::chain::{Body, Link};
    use crate::friction::Friction;

    fn screw_axis() -> Chain {
        let body = |name, coordinate, inertia, transmission| Body {
            name,
            coordinate,
            inertia,
            transmission,
            friction: Friction { viscous: 0.5, ..Friction::NONE },
            bias: 0.0,
        };
        Chain::new(
            vec![body("motor", Coordinate::Rotary, 1e-3, 0.01), body("table", Coordinate::Linear, 20.0, 1.0)],
            vec![Link { stiffness: 1e8, damping: 2e3 }],
        )
        .unwrap()
    }

    #[test]
    fn a_driven_chain_has_every_body_and_a_motor() {
        let xml = chain_to_mjcf(&screw_axis(), Drive::Effort, 1.0 / 16_000.0);
        assert!(xml.contains(r#"<joint name="motor" type="hinge" axis="1 0 0" damping="0.5"/>"#), "{xml}");
        assert!(xml.contains(r#"<joint joint="motor" coef="0.01"/><joint joint="table" coef="-1.0"/>"#), "{xml}");
        assert!(xml.contains(r#"<motor name="motor_effort" joint="motor"/>"#), "{xml}");
    }

    #[test]
    fn a_prescribed_base_is_the_world() {
        let xml = chain_to_mjcf(&screw_axis(), Drive::Prescribed, 1.0 / 16_000.0);
        assert!(!xml.contains(r#"name="motor""#) && !xml.contains("<actuator>"), "{xml}");
        assert!(xml.contains(r#"springlength="0"><joint joint="table" coef="-1.0"/></fixed>"#), "{xml}");
    }
}
