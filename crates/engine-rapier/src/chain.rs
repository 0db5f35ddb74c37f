//! A chain of lumped bodies: half kick – drift – half kick.
//!
//! ```text
//! half kick      M·(v½ − v(k)) = h/2·F(x(k), v, u(k))          ours, see `half_kick`
//! drift          x(k+1) = x(k) + h·v½                          Rapier's, see `lumps`
//! half kick      M·(v(k+1) − v½) = h/2·F(x(k+1), v, u(k))      ours
//! ```
//! Second order, with damping and behind a prescribed base too; a mode of ω oscillates too fast by (ω·h)²/24 and keeps its
//! amplitude. Source: Hairer, Lubich & Wanner, *Geometric Numerical Integration*, 2nd ed., §I.1.4 (Störmer–Verlet).
use crate::NAME;
use crate::half_kick::HalfKick;
use crate::lumps::{Lumps, Positions};
use servobench_base::Setpoint;
use servobench_base::state::Stateful;
use servobench_plant::{
    Actuation, BodyState, Chain, Drive, Grips, GroundFriction, Identity, Input, Mechanics, MechanicsError,
    MechanicsSetup, check_states,
};

/// A chain simulated in Rapier.
#[derive(Stateful)]
pub(crate) struct LumpChain<const N: usize> {
    identity: Identity,
    #[state(constant)]
    parameters: Parameters<N>,
    friction: GroundFriction<N>,
    /// True if body 0 follows a set-point and is not a lump.
    #[state(constant)]
    prescribed: bool,
    /// Tick length (s).
    #[state(constant)]
    step: f64,
    /// The half kick that a tick begins with, with the bodies held in it.
    #[state(recomputed)]
    kick: HalfKick<N>,
    #[state(derived)]
    lumps: Lumps,
    positions: Positions<N>,
    /// Velocities (m/s or rad/s).
    velocities: [f64; N],
    /// Stretch of each link when both its ends are at their centres (m or rad).
    #[state(recomputed)]
    stretch_of_centres: [f64; N],
    #[state(recomputed)]
    bodies: [BodyState; N],
}

/// The chain's parameters in arrays; zero for a missing body or link.
struct Parameters<const N: usize> {
    transmission: [f64; N],
    viscous: [f64; N],
    bias: [f64; N],
    /// Stiffness of link i, between bodies i and i+1.
    stiffness: [f64; N],
    damping: [f64; N],
}

impl<const N: usize> LumpChain<N> {
    pub(crate) fn new(chain: &Chain, setup: &MechanicsSetup) -> Result<Self, MechanicsError> {
        let prescribed = setup.drive == Drive::Prescribed;
        check_stability(chain, prescribed, setup.step)?;
        let bodies: [BodyState; N] = std::array::from_fn(|i| setup.initial.get(i).copied().unwrap_or_default());
        let first = usize::from(prescribed);
        let (lumps, mut positions) = Lumps::new(chain, first, &bodies, setup.step)?;
        if prescribed {
            positions.from_centre[0] = bodies[0].position;
        }
        let mut mechanics = Self {
            parameters: Parameters::new(chain),
            friction: GroundFriction::new(chain, setup.drive, setup.step),
            prescribed,
            step: setup.step,
            kick: HalfKick::new(chain, setup.step),
            lumps,
            positions,
            velocities: bodies.map(|state| state.velocity),
            stretch_of_centres: [0.0; N],
            bodies,
            identity: Identity::new(NAME, setup),
        };
        mechanics.kick.hold(first);
        mechanics.measure_centres();
        Ok(mechanics)
    }

    fn measure_centres(&mut self) {
        let (r, centre) = (&self.parameters.transmission, &self.positions.centre);
        for i in 0..N - 1 {
            self.stretch_of_centres[i] = r[i] * centre[i] - r[i + 1] * centre[i + 1];
        }
    }

    /// `constant` plus efforts of links, viscous friction and bias, as defined in [`Chain`].
    #[inline]
    fn with_passive(&self, constant: &[f64; N]) -> [f64; N] {
        let Parameters { transmission: r, viscous, bias, stiffness, damping, .. } = &self.parameters;
        let (x, v) = (&self.positions.from_centre, &self.velocities);
        let mut efforts: [f64; N] = std::array::from_fn(|i| constant[i] - viscous[i] * v[i] - bias[i]);
        for i in 0..N - 1 {
            let stretch = self.stretch_of_centres[i] + (r[i] * x[i] - r[i + 1] * x[i + 1]);
            let force = stiffness[i] * stretch + damping[i] * (r[i] * v[i] - r[i + 1] * v[i + 1]);
            efforts[i] -= r[i] * force;
            efforts[i + 1] += r[i + 1] * force;
        }
        efforts
    }

    /// Adds dry friction to the efforts and stops the bodies that it holds; `all` are all other efforts.
    fn grip(&mut self, constant: &mut [f64; N], all: &mut [f64; N]) {
        let Grips { held, forces } = self.friction.before_tick(self.velocities, *all);
        for (i, force) in forces.into_iter().enumerate() {
            constant[i] += force;
            all[i] += force;
        }
        // A half kick unknown to Rapier can have brought a held body to rest.
        self.stop(held);
        self.kick.hold(held | usize::from(self.prescribed));
    }

    /// Stops the bodies of the set `at_rest`, body i being bit i, also in Rapier.
    fn stop(&mut self, at_rest: usize) {
        for i in (0..N).filter(|i| at_rest & (1 << i) != 0) {
            self.velocities[i] = 0.0;
            self.lumps.stop(i);
        }
    }

    /// Moves body 0 to the set-point.
    fn follow(&mut self, setpoint: &Setpoint) {
        let r = self.parameters.transmission[0];
        self.positions.from_centre[0] = setpoint.x / r;
        self.velocities[0] = setpoint.v / r;
    }

    #[inline]
    fn publish(&mut self) {
        for (i, body) in self.bodies.iter_mut().enumerate() {
            body.position = self.positions.centre[i] + self.positions.from_centre[i];
            body.velocity = self.velocities[i];
        }
    }

    #[inline]
    fn half_kick(&mut self, efforts: &[f64; N]) {
        for (velocity, change) in self.velocities.iter_mut().zip(self.kick.velocity_change(efforts)) {
            *velocity += change;
        }
    }
}

impl<const N: usize> Mechanics for LumpChain<N> {
    fn state(&mut self) -> Option<&mut dyn Stateful> {
        Some(self)
    }

    fn restored(&mut self) -> Result<(), MechanicsError> {
        self.lumps.put(&self.positions);
        self.measure_centres();
        self.publish();
        Ok(())
    }

    fn bodies(&self) -> &[BodyState] {
        &self.bodies
    }

    fn advance(&mut self, input: &Input) -> Result<(), MechanicsError> {
        // Efforts that are constant during the tick, without the bias (N or N·m).
        let mut constant = [0.0; N];
        match (&input.actuation, self.prescribed) {
            (Actuation::Effort(effort), false) => constant[0] = *effort,
            (Actuation::Motion(now), true) => self.follow(now),
            (Actuation::Effort(_), true) | (Actuation::Motion(_), false) => {
                return Err(MechanicsError::wrong_actuation(NAME));
            }
        }
        constant[0] += input.motor_disturbance;
        constant[N - 1] += self.parameters.transmission[N - 1] * input.load_disturbance;

        let mut efforts = self.with_passive(&constant);
        if !self.friction.is_linear() {
            self.grip(&mut constant, &mut efforts);
        }
        self.half_kick(&efforts);
        if self.lumps.drift(&mut self.velocities, &mut self.positions)? {
            self.measure_centres();
        }
        if let Actuation::Motion(now) = &input.actuation {
            self.follow(&now.after(self.step));
        }
        let efforts = self.with_passive(&constant);
        self.half_kick(&efforts);
        if !self.friction.is_linear() {
            let at_rest = self.friction.after_tick(self.velocities);
            self.stop(at_rest);
        }

        self.publish();
        check_states(NAME, self.bodies.iter().copied())
    }
}

impl<const N: usize> Parameters<N> {
    fn new(chain: &Chain) -> Self {
        let body = |value: fn(&servobench_plant::Body) -> f64| -> [f64; N] {
            std::array::from_fn(|i| value(&chain.bodies()[i]))
        };
        let link = |value: fn(&servobench_plant::Link) -> f64| -> [f64; N] {
            std::array::from_fn(|i| chain.links().get(i).map_or(0.0, value))
        };
        Self {
            transmission: body(|body| body.transmission),
            viscous: body(|body| body.friction.linear()),
            bias: body(|body| body.bias),
            stiffness: link(|link| link.stiffness),
            damping: link(|link| link.damping),
        }
    }
}

/// Refuses a chain with a mode of ω·h ≥ 2, for which half kick – drift – half kick diverges.
///
/// Every mode is below λ = 4/h² when K − λ·M is negative definite: every pivot of its elimination is negative.
fn check_stability(chain: &Chain, prescribed: bool, step: f64) -> Result<(), MechanicsError> {
    let (bodies, links) = (chain.bodies(), chain.links());
    let bound = 4.0 / (step * step);
    let mut coupled = 0.0;
    for (i, body) in bodies.iter().enumerate().skip(usize::from(prescribed)) {
        let r = body.transmission;
        let before = i.checked_sub(1).map_or(0.0, |l| links[l].stiffness);
        let after = links.get(i).map_or(0.0, |link| link.stiffness);
        let pivot = r * r * (before + after) - bound * body.inertia - coupled;
        if pivot >= 0.0 {
            let highest = 1.0 / (std::f64::consts::PI * step);
            return Err(MechanicsError::Unsupported {
                engine: NAME,
                what: format!("a mode of body `{}` above {highest:.0} Hz at a tick of {} µs", body.name, step * 1e6),
                help: "raise the base rate, merge the bodies that the stiff link couples, or choose the engine `exact`"
                    .into(),
            });
        }
        let off_diagonal = bodies.get(i + 1).map_or(0.0, |far| r * far.transmission * after);
        coupled = off_diagonal * off_diagonal / pivot;
    }
    Ok(())
}
