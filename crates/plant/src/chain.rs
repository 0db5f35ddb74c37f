//! A chain of lumped bodies: motor – (coupling, screw) – table – (flexure) – load.
//!
//! ```text
//! F_link,i = c_i·(r_i·q_i − r_{i+1}·q_{i+1}) + d_i·(r_i·q̇_i − r_{i+1}·q̇_{i+1})
//! m_i·q̈_i = u_i − b_i·q̇_i − f_i(q̇_i) − f0_i − r_i·F_link,i + r_i·F_link,i−1
//! ```
//! `q` is each body's own coordinate, `r·q` the axis coordinate: a rotary motor on a screw of lead `p` has
//! `r = p/2π` (m/rad), every other body `r = 1`.
use crate::friction::Friction;
use crate::mechanics::BodyState;
use servobench_base::{Coordinate, ParamError};
use servobench_config::Kind::{Axis, Plain};
use servobench_config::quantities::{EFFORT, INERTIAL, RATIO, STIFFNESS, VISCOUS};
use servobench_config::{any, not_negative, positive};

servobench_config::parameters! {
    /// A parameter of bodies and the couplings between them, in the axis coordinate; those of the motor's body in the motor coordinate.
    pub enum ChainParameter {
        /// Mass or moment of inertia
        INERTIA "inertia" = positive(Axis(&INERTIAL), "40 kg");
        /// Axis coordinate per coordinate of the body
        TRANSMISSION "transmission" = positive(Plain(&RATIO), "1");
        /// Constant resisting force or torque: gravity, or friction that differs between the directions
        BIAS "bias" = any(Axis(&EFFORT), "-3.2 N");
        /// Stiffness of the coupling to the body before it
        STIFFNESS "stiffness" = positive(Axis(&STIFFNESS), "120 N/um");
        /// Damping of that coupling
        DAMPING "damping" = not_negative(Axis(&VISCOUS), "3000 N s/m");
    }
}

/// One lumped body.
#[derive(Debug, Clone, PartialEq)]
pub struct Body {
    /// Name for recordings and models: `motor`, `table`, `load`.
    pub name: &'static str,
    /// Kind of its own coordinate: a length or an angle.
    pub coordinate: Coordinate,
    /// Mass (kg) or inertia (kg·m²) in its own coordinate.
    pub inertia: f64,
    /// Axis coordinate per own coordinate, `r` (1, or m/rad).
    pub transmission: f64,
    /// Friction against the ground.
    pub friction: Friction,
    /// Constant resisting force, `f0`: gravity on a vertical axis, asymmetry of the friction (N or N·m).
    pub bias: f64,
}

/// Elastic coupling between two neighbours, in the axis coordinate.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Link {
    /// Stiffness, `c` (N/m or N·m/rad).
    pub stiffness: f64,
    /// Damping, `d` (N·s/m or N·m·s/rad).
    pub damping: f64,
}

/// Bodies in order from the motor to the load, with a link between each pair of neighbours.
#[derive(Debug, Clone, PartialEq)]
pub struct Chain {
    bodies: Vec<Body>,
    links: Vec<Link>,
}

impl Chain {
    /// Most bodies a chain can have.
    pub const MAX_BODIES: usize = 4;

    /// Checks every parameter.
    ///
    /// # Errors
    /// [`ParamError`] names the first parameter out of its bound; `bodies` and `links` when their numbers do not fit.
    pub fn new(bodies: Vec<Body>, links: Vec<Link>) -> Result<Self, ParamError> {
        let chain = Self { bodies, links };
        chain.check()?;
        Ok(chain)
    }

    /// # Errors
    /// As [`new`](Self::new), after bodies or links were changed.
    pub fn check(&self) -> Result<(), ParamError> {
        let Self { bodies, links } = self;
        if bodies.is_empty() || bodies.len() > Self::MAX_BODIES {
            return Err(ParamError { name: "bodies", value: bodies.len() as f64, bound: "1 to 4 in number" });
        }
        if links.len() + 1 != bodies.len() {
            return Err(ParamError { name: "links", value: links.len() as f64, bound: "one fewer than the bodies" });
        }
        for body in bodies {
            ChainParameter::INERTIA.check_in_words(body.inertia)?;
            ChainParameter::TRANSMISSION.check_in_words(body.transmission)?;
            body.friction.check()?;
            ChainParameter::BIAS.check_in_words(body.bias)?;
        }
        for link in links {
            ChainParameter::STIFFNESS.check_in_words(link.stiffness)?;
            ChainParameter::DAMPING.check_in_words(link.damping)?;
        }
        Ok(())
    }

    /// The bodies, the motor first.
    #[must_use]
    pub fn bodies(&self) -> &[Body] {
        &self.bodies
    }

    /// The links; number i is between bodies i and i+1.
    #[must_use]
    pub fn links(&self) -> &[Link] {
        &self.links
    }

    /// The bodies, for changes.
    #[must_use]
    pub fn bodies_mut(&mut self) -> &mut [Body] {
        &mut self.bodies
    }

    /// The links, for changes.
    #[must_use]
    pub fn links_mut(&mut self) -> &mut [Link] {
        &mut self.links
    }

    /// Effort on body `i` from its links, the linear part of its friction and bias; neither actuation nor the rest of friction.
    #[must_use]
    pub fn passive_effort(&self, i: usize, states: &[BodyState]) -> f64 {
        let body = &self.bodies[i];
        let mut effort = -body.friction.linear() * states[i].velocity - body.bias;
        if i > 0 {
            effort += body.transmission * self.link_force(i - 1, states);
        }
        if i < self.links.len() {
            effort -= body.transmission * self.link_force(i, states);
        }
        effort
    }

    /// Force through link `i` in the axis coordinate, positive when body i pushes body i+1 forward.
    fn link_force(&self, i: usize, states: &[BodyState]) -> f64 {
        let (near, far, link) = (&self.bodies[i], &self.bodies[i + 1], &self.links[i]);
        link.stiffness * (near.transmission * states[i].position - far.transmission * states[i + 1].position)
            + link.damping * (near.transmission * states[i].velocity - far.transmission * states[i + 1].velocity)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn body(inertia: f64, transmission: f64) -> Body {
        let (coordinate, friction) = (Coordinate::Linear, Friction { viscous: 2.0, ..Friction::NONE });
        Body { name: "motor", coordinate, inertia, transmission, friction, bias: 0.5 }
    }

    #[test]
    fn forces_through_a_screw_balance_in_power() {
        let chain =
            Chain::new(vec![body(1e-3, 0.01), body(10.0, 1.0)], vec![Link { stiffness: 1e6, damping: 100.0 }]).unwrap();
        let states = [BodyState { position: 1.0, velocity: 3.0 }, BodyState { position: 0.009, velocity: 0.02 }];
        let force = 1e6 * (0.01 - 0.009) + 100.0 * (0.03 - 0.02);
        let motor = chain.passive_effort(0, &states);
        let table = chain.passive_effort(1, &states);
        assert!((motor - (-2.0 * 3.0 - 0.5 - 0.01 * force)).abs() < 1e-9, "{motor}");
        assert!((table - (-2.0 * 0.02 - 0.5 + force)).abs() < 1e-9, "{table}");
    }

    #[test]
    fn negative_inertia_is_refused_by_name() {
        let e = Chain::new(vec![body(-1.0, 1.0)], vec![]).unwrap_err();
        assert_eq!(e.to_string(), "`inertia` must be finite and positive, got -1");
        assert!(Chain::new(vec![body(1.0, 1.0)], vec![Link { stiffness: 1.0, damping: 0.0 }]).is_err());
    }
}
