//! Resistance of the axis to a motion that it follows exactly.
//!
//! ```text
//! τ = r·Σ (m_i·a + b_i·v)/r_i² + r·Σ (f_i(v) + f0_i)/r_i − τ_d − r·f_d       rigid, r = r_0
//!   + r·(m1·m2/c·s + (m1·k2 + m2·k1)/c·j + k1·k2/c·a)                       where the drive makes the load follow
//! ```
//! τ is in the motor's coordinate, τ_d and f_d disturb motor and load. The second line is the contribution of a spring between two bodies
//! (Lambrechts, Boerlage, Steinbuch, *Control Engineering Practice* 13, 2005), m1 and k1 in the axis coordinate. An axis at rest is held by
//! its friction up to the friction's limit.
use servobench_base::Setpoint;
use servobench_drive::Estimate;
use servobench_drive::feedforward::Model;
use servobench_plant::{Body, Chain, Friction};
use servobench_scenario::{Actuator, Disturbance, DisturbedBody, Scenario};
use std::f64::consts::TAU;

/// Resistance of the axis to its motion.
#[derive(Debug, Clone)]
pub(super) struct Resistance {
    /// Motor effort per acceleration, velocity, and per jerk and snap, of the axis.
    inertia: f64,
    viscous: f64,
    jerk: f64,
    snap: f64,
    /// Constant effort.
    bias: f64,
    /// Friction of each body, body coordinate per axis coordinate, and motor effort per effort of the body.
    friction: Vec<(Friction, f64, f64)>,
    disturbances: Vec<Disturbance>,
    /// Axis coordinate per motor coordinate.
    transmission: f64,
}

impl Resistance {
    /// Resistance of the actual bodies.
    pub(super) fn of_chain(scenario: &Scenario, chain: &Chain) -> Self {
        let r = chain.bodies()[0].transmission;
        let sum = |value: fn(&Body) -> f64| chain.bodies().iter().map(value).sum::<f64>();
        let friction =
            chain.bodies().iter().map(|body| (body.friction, 1.0 / body.transmission, r / body.transmission));
        let mut all = Self {
            inertia: r * sum(|body| body.inertia / body.transmission.powi(2)),
            viscous: r * sum(|body| body.friction.linear() / body.transmission.powi(2)),
            jerk: 0.0,
            snap: 0.0,
            bias: r * sum(|body| body.bias / body.transmission),
            friction: friction.collect(),
            disturbances: scenario.disturbances.clone(),
            transmission: r,
        };
        let load_follows = |actuator: &Actuator| {
            actuator.drive().is_some_and(|drive| matches!(drive.params.feedforward.model, Model::TwoMass { .. }))
        };
        if let ([motor, load], [link], true) = (chain.bodies(), chain.links(), load_follows(&scenario.actuator)) {
            let [m1, k1] = [motor.inertia, motor.friction.linear()].map(|own| own / (r * r));
            let (m2, k2, c) = (load.inertia, load.friction.linear(), link.stiffness);
            all.inertia += r * k1 * k2 / c;
            all.jerk = r * (m1 * k2 + m2 * k1) / c;
            all.snap = r * m1 * m2 / c;
        }
        all
    }

    /// Resistance by the drive's estimate, where the bodies are unknown here; `None` without an estimated inertia.
    pub(super) fn believed(scenario: &Scenario, estimate: &Estimate) -> Option<Self> {
        let (r, inertia) = (scenario.axis.transmission, estimate.motor_inertia + estimate.load_inertia);
        (inertia > 0.0).then(|| Self {
            inertia: r * inertia,
            viscous: r * (estimate.motor_viscous + estimate.load_viscous),
            jerk: 0.0,
            snap: 0.0,
            bias: r * estimate.bias,
            friction: vec![(Friction::coulomb(estimate.coulomb), 1.0, r)],
            disturbances: scenario.disturbances.clone(),
            transmission: r,
        })
    }

    /// Motor effort (N·m or N) that the axis needs at `t` (s) for the motion `now`.
    pub(super) fn effort(&self, t: f64, now: Setpoint) -> f64 {
        let disturbed: f64 = self.disturbances.iter().map(|one| self.disturbing(one, t)).sum();
        let moving = self.inertia * now.a + self.viscous * now.v + self.jerk * now.j + self.snap * now.s;
        let effort = moving + self.bias - disturbed;
        if now.v != 0.0 {
            let friction: f64 = self.friction.iter().map(|(one, own, share)| share * one.sliding(own * now.v)).sum();
            return effort + friction.copysign(now.v);
        }
        let held: f64 = self.friction.iter().map(|(one, _, share)| share * one.breakaway()).sum();
        effort.signum() * (effort.abs() - held).max(0.0)
    }

    /// Motor effort of a disturbance at `t` (s).
    fn disturbing(&self, one: &Disturbance, t: f64) -> f64 {
        let since = t - one.start;
        if since < 0.0 || since >= one.duration {
            return 0.0;
        }
        let effort = one.effort * one.frequency.map_or(1.0, |frequency| (TAU * frequency * since).sin());
        match one.on {
            DisturbedBody::Motor => effort,
            DisturbedBody::Load => self.transmission * effort,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use servobench_sim::Bench;

    fn scenario(axis: &str, feedforward: &str, disturbances: &str) -> Scenario {
        let text = format!(
            "[run]\nbase_rate = \"12 kHz\"\n{axis}\n[motor]\nkind = \"ideal-source\"\nlimit = \"1 MN\"\n\
             [drive.velocity]\nrate = \"12 kHz\"\nbandwidth = \"20 Hz\"\n[drive.position]\nrate = \"12 kHz\"\n\
             bandwidth = \"4 Hz\"\n[drive.feedforward]\neffort = \"{feedforward}\"\n{disturbances}"
        );
        let text = if axis.contains("lead") { text.replace("1 MN", "1 kN m") } else { text };
        servobench_scenario::parse("test", &text, None).unwrap_or_else(|error| panic!("{error}\n{text}")).scenario
    }

    fn resistance(scenario: &Scenario) -> Resistance {
        Resistance::of_chain(scenario, &Bench::chain(scenario).unwrap().unwrap())
    }

    /// Oracle: by hand. 3.7 kg behind a screw of 13 mm, J = 4e-4 kg·m²; r = 0.013/2π, so τ = J·a/r + r·(m·a + b·v + f).
    #[test]
    fn a_rigid_axis_needs_its_inertia_and_its_friction() {
        let axis = "[axis]\nmotion = \"linear\"\nlead = \"13 mm\"\n[axis.motor_side]\ninertia = \"4e-4 kg m2\"\n\
                    [axis.load]\nmass = \"3.7 kg\"\nviscous = \"25 N s/m\"\ncoulomb = \"11 N\"\nbias = \"-6 N\"\n";
        let found = resistance(&scenario(axis, "off", ""));
        let (r, a, v) = (0.013 / TAU, -3.1, 0.42);
        let expected = 4e-4 * a / r + r * (3.7 * a + 25.0 * v + 11.0 - 6.0);
        let effort = found.effort(0.0, Setpoint { v, a, ..Setpoint::default() });
        assert!((effort / expected - 1.0).abs() < 1e-12, "{effort} {expected}");
        let back = found.effort(0.0, Setpoint { v: -v, ..Setpoint::default() });
        assert!((back / (r * (-25.0 * v - 11.0 - 6.0)) - 1.0).abs() < 1e-12, "{back}");
        // At rest friction holds 11 N of the 6 N: nothing is left for the motor.
        assert!(found.effort(0.0, Setpoint::default()).abs() < 1e-15);
    }

    /// Oracle: Newton on each body, the motor's motion from x_m = x + (m2·a + k2·v)/c differentiated twice.
    #[test]
    fn a_load_that_follows_through_a_spring_needs_jerk_and_snap_too() {
        let axis = "[axis]\nmotion = \"linear\"\n[axis.motor_side]\nmass = \"21 kg\"\nviscous = \"9 N s/m\"\n\
                    [axis.load]\nmass = \"8 kg\"\nviscous = \"13 N s/m\"\nstiffness = \"3e5 N/m\"\n";
        let now = Setpoint { x: 0.1, v: 0.3, a: 2.0, j: -40.0, s: 900.0 };
        let (m1, k1, m2, k2, c) = (21.0, 9.0, 8.0, 13.0, 3e5);
        let spring = m2 * now.a + k2 * now.v;
        let (v_m, a_m) = (now.v + (m2 * now.j + k2 * now.a) / c, now.a + (m2 * now.s + k2 * now.j) / c);
        let expected = m1 * a_m + k1 * v_m + spring;
        let elastic = resistance(&scenario(axis, "two-mass", "")).effort(0.0, now);
        assert!((elastic / expected - 1.0).abs() < 1e-12, "{elastic} {expected}");
        let rigid = resistance(&scenario(axis, "rigid", "")).effort(0.0, now);
        assert!((rigid / (29.0 * now.a + 22.0 * now.v) - 1.0).abs() < 1e-12, "{rigid}");
    }

    /// Oracle: a quarter of the sine's period after its start it is at its amplitude; what pushes the load forward saves effort.
    #[test]
    fn disturbances_count_while_they_act() {
        let axis = "[axis]\nmotion = \"linear\"\n[axis.motor_side]\nmass = \"21 kg\"\n";
        let two = "[[disturbance]]\non = \"load\"\nforce = \"70 N\"\nstart = \"0.1 s\"\nduration = \"0.3 s\"\n\
                   [[disturbance]]\non = \"motor\"\nforce = \"-20 N\"\nstart = \"0.1 s\"\nfrequency = \"5 Hz\"\n";
        let found = resistance(&scenario(axis, "off", two));
        for (t, expected) in [(0.09, 0.0), (0.15, -50.0), (0.45, 20.0 * (TAU * 5.0 * 0.35).sin())] {
            let effort = found.effort(t, Setpoint::default());
            assert!((effort - expected).abs() < 1e-9, "{t} s: {effort} N");
        }
    }
}
