//! The engine `exact`: zero-order hold of the linear chain by the matrix exponential; exact at every tick while the
//! efforts are constant over it.
//!
//! ```text
//! y = (s_1 … s_{n−1}, V_0 … V_{n−1})      s_i = x_{i−1} − x_i  link stretch,  V_i = h·ẋ_i,  x axis coordinates
//! y' = A·y + B·u  per tick                u = effort on each body
//! y(k+1) = Φ·y(k) + Γ·u(k)                [Φ Γ; 0 I] = exp([A B; 0 0])
//! ```
//! Stretches instead of positions: a nanometre of vibration at one metre of travel then keeps all its digits, and
//! moving the whole axis changes nothing bit for bit. Velocities per tick keep the norm of A near (ω·h)².
//!
//! A prescribed base adds the states (h·v, h²·a, h³·j, h⁴·s) of its own motion, so that its polynomial is integrated
//! exactly too. A stuck body has its velocity row and column struck out: one pair (Φ, Γ) for each set of stuck bodies.
//! Source: Åström & Wittenmark, *Computer-Controlled Systems*, 3rd ed., §2.3; Van Loan, IEEE TAC 23(3), 1978.
#![expect(clippy::inline_always, reason = "what is inlined is compiled for the registers of its caller")]
use crate::chain::Chain;
use crate::engine::{Engine, EngineName};
use crate::ground_friction::{Grips, GroundFriction};
use crate::identity::Identity;
use crate::mechanics::{
    Actuation, BodyState, Drive, Input, Mechanics, MechanicsError, MechanicsSetup, Model, check_states,
};
use nalgebra::DMatrix;
use servobench_base::state::{Damaged, FixedForm as _, Part, Reader, Writer};
use servobench_base::{Stateful, wide_registers};
use std::sync::Arc;

const NAME: EngineName = EngineName::Exact;
const MAX_BODIES: usize = Chain::MAX_BODIES;
/// Most rows: stretches and velocities of the chain, derivatives of a prescribed base, travel.
const ROWS: usize = 2 * MAX_BODIES - 1 + 4 + 1;
/// Most columns: the same but travel, then the efforts.
const COLUMNS: usize = ROWS - 1 + MAX_BODIES;

/// Number of states: stretches and velocities, and the four derivatives of a prescribed base.
fn states(chain: &Chain, prescribed: bool) -> usize {
    2 * chain.bodies().len() - 1 + if prescribed { 4 } else { 0 }
}

/// The engine `exact`.
#[derive(Debug, Clone, Copy, Default)]
pub struct Exact;

impl Engine for Exact {
    fn name(&self) -> EngineName {
        NAME
    }

    fn build(&self, setup: &MechanicsSetup) -> Result<Box<dyn Mechanics>, MechanicsError> {
        setup.check()?;
        match &setup.model {
            // Rows in use: stretches, velocities, base derivatives, travel. The next multiple of four fills registers.
            Model::Chain(chain) => Ok(match states(chain, setup.drive == Drive::Prescribed) + 1 {
                0..=4 => Box::new(ExactChain::<4>::new(chain.clone(), setup)),
                5..=8 => Box::new(ExactChain::<8>::new(chain.clone(), setup)),
                _ => Box::new(ExactChain::<ROWS>::new(chain.clone(), setup)),
            }),
            other => Err(MechanicsError::not_simulated(NAME, other)),
        }
    }
}

/// `y(k+1) = Φ·y(k) + Γ·u(k)` for one set of stuck bodies, column by column: those of the states, then those of the
/// efforts. The row after the states is the travel of body 0 in the tick.
type Hold<const W: usize> = Vec<[f64; W]>;

/// A chain under zero-order hold, `W` rows wide.
#[derive(Clone)]
struct ExactChain<const W: usize> {
    chain: Arc<Chain>,
    prescribed: bool,
    /// Tick length (s).
    step: f64,
    /// Rows that are states.
    states: usize,
    /// One entry for each set of stuck bodies, body i being bit i; only those that dry friction can reach are there.
    holds: Arc<[Option<Hold<W>>]>,
    /// Factors of the columns: y, and behind it the efforts of the current tick.
    factors: [f64; COLUMNS],
    bodies: Vec<BodyState>,
    terms: [Terms; MAX_BODIES],
    friction: GroundFriction<MAX_BODIES>,
    identity: Identity,
}

/// Data of a body for a tick.
#[derive(Clone, Copy, Default)]
struct Terms {
    bias: f64,
    /// Axis coordinate per own coordinate.
    transmission: f64,
    /// Own coordinate per axis coordinate.
    per_axis: f64,
    /// Own velocity per travel in a tick.
    per_travel: f64,
}

impl<const W: usize> ExactChain<W> {
    fn new(chain: Chain, setup: &MechanicsSetup) -> Self {
        let n = chain.bodies().len();
        let prescribed = setup.drive == Drive::Prescribed;
        let friction = GroundFriction::new(&chain, setup.drive, setup.step);
        let may_hold = friction.may_hold();
        let holds = (0..1_usize << n)
            .map(|stuck| (stuck & !may_hold == 0).then(|| hold(&chain, prescribed, setup.step, stuck)))
            .collect();
        let bodies: Vec<BodyState> = (0..n).map(|i| setup.initial.get(i).copied().unwrap_or_default()).collect();
        let mut terms = [Terms::default(); MAX_BODIES];
        for (terms, body) in terms.iter_mut().zip(chain.bodies()) {
            let transmission = body.transmission;
            let (per_axis, per_travel) = (1.0 / transmission, 1.0 / (setup.step * transmission));
            *terms = Terms { bias: body.bias, transmission, per_axis, per_travel };
        }
        let mut factors = [0.0; COLUMNS];
        let axis_position = |i: usize| chain.bodies()[i].transmission * bodies[i].position;
        for i in 1..n {
            factors[i - 1] = axis_position(i - 1) - axis_position(i);
        }
        for i in 0..n {
            factors[n - 1 + i] = setup.step * chain.bodies()[i].transmission * bodies[i].velocity;
        }
        let states = states(&chain, prescribed);
        let (chain, identity) = (Arc::new(chain), Identity::new(NAME, setup));
        Self { chain, prescribed, step: setup.step, states, holds, factors, bodies, terms, friction, identity }
    }

    /// Efforts that are constant over the tick, without dry friction.
    #[inline(always)]
    fn efforts(&self, input: &Input) -> [f64; MAX_BODIES] {
        let mut u = self.terms.map(|terms| -terms.bias);
        if let Actuation::Effort(effort) = input.actuation {
            u[0] += effort;
        }
        u[0] += input.motor_disturbance;
        // In the axis coordinate: on a single rotary body behind a screw it acts through the transmission.
        let last = (self.bodies.len() - 1).min(MAX_BODIES - 1);
        u[last] += self.terms[last].transmission * input.load_disturbance;
        u
    }

    #[cfg(target_arch = "x86_64")]
    #[target_feature(enable = "avx2")]
    fn advanced_in_wide_registers(&mut self, input: &Input) -> Result<(), MechanicsError> {
        self.advanced(input)
    }

    #[inline(always)]
    fn advanced(&mut self, input: &Input) -> Result<(), MechanicsError> {
        let n = self.bodies.len().min(MAX_BODIES);
        let mut base_position = None;
        match (input.actuation, self.prescribed) {
            (Actuation::Effort(_), false) => {}
            (Actuation::Motion(now), true) => {
                let h = self.step;
                let derivatives = [h * now.v, h * h * now.a, h * h * h * now.j, h * h * h * h * now.s];
                self.factors[2 * n - 1..2 * n + 3].copy_from_slice(&derivatives);
                self.factors[n - 1] = derivatives[0];
                base_position = Some(now.after(h).x);
            }
            (Actuation::Effort(_), true) | (Actuation::Motion(_), false) => {
                return Err(MechanicsError::wrong_actuation(NAME));
            }
        }
        let mut u = self.efforts(input);
        let stuck = if self.friction.is_linear() { 0 } else { self.grip(&mut u) };
        let Some(hold) = &self.holds[stuck] else {
            return Err(MechanicsError::Native {
                engine: NAME,
                message: format!("no transition for stuck set {stuck}"),
            });
        };

        // All possible efforts: those that no body has are not multiplied.
        for (factor, effort) in self.factors[self.states..].iter_mut().zip(&u) {
            *factor = *effort;
        }
        let mut next = [0.0; W];
        for (column, factor) in hold.iter().zip(&self.factors) {
            for (next, entry) in next.iter_mut().zip(column) {
                *next += entry * factor;
            }
        }
        let travel = std::mem::take(&mut next[self.states]);

        let mut axis_position = base_position.unwrap_or(self.terms[0].transmission * self.bodies[0].position + travel);
        let (stretches, rows) = next.split_at_mut(n - 1);
        let mut velocities = [0.0; MAX_BODIES];
        for ((velocity, row), terms) in velocities.iter_mut().zip(&*rows).zip(&self.terms).take(n) {
            *velocity = row * terms.per_travel;
        }
        let at_rest = if self.friction.is_linear() { 0 } else { stuck | self.friction.after_tick(velocities) };
        for (i, ((body, row), terms)) in self.bodies.iter_mut().zip(rows).zip(&self.terms).enumerate() {
            if i > 0 {
                axis_position -= stretches[i - 1];
            }
            let mut velocity = velocities[i];
            if at_rest & (1 << i) != 0 {
                velocity = 0.0;
                *row = 0.0;
            }
            let position = if stuck & (1 << i) != 0 { body.position } else { axis_position * terms.per_axis };
            *body = BodyState { position, velocity };
        }
        self.factors[..W].copy_from_slice(&next);
        check_states(NAME, self.bodies.iter().copied())
    }

    /// Adds dry friction to `u` and returns the set of bodies that are held.
    #[inline(always)]
    fn grip(&mut self, u: &mut [f64; MAX_BODIES]) -> usize {
        let (mut velocities, mut others) = ([0.0; MAX_BODIES], [0.0; MAX_BODIES]);
        for (i, body) in self.bodies.iter().enumerate().take(MAX_BODIES) {
            velocities[i] = body.velocity;
            // `passive_effort` holds the bias, and `u` does too.
            others[i] = self.chain.passive_effort(i, &self.bodies) + u[i] + self.terms[i].bias;
        }
        let Grips { held, forces } = self.friction.before_tick(velocities, others);
        u.iter_mut().zip(forces).for_each(|(u, force)| *u += force);
        held
    }
}

/// Stretches, velocities, derivatives of the base and the position of the motor are the state; the bodies are derived from them, except
/// for accumulated roundings, which is why they are saved.
impl<const W: usize> Stateful for ExactChain<W> {
    fn save(&self, to: &mut dyn Writer) {
        let Self { identity, factors, bodies, friction, states, chain: _, prescribed: _, step: _, holds: _, terms: _ } =
            self;
        identity.save(to);
        let count = bodies.len();
        for (index, factor) in factors[..*states].iter().enumerate() {
            let name =
                ["stretch", "velocity", "base"][usize::from(index + 1 >= count) + usize::from(index + 1 >= 2 * count)];
            to.enter(Part::field(name));
            to.number(*factor);
            to.leave();
        }
        to.enter(Part::field("position"));
        to.number(bodies[0].position);
        to.leave();
        to.enter(Part::derived("bodies"));
        bodies.save_fixed(to);
        to.leave();
        to.enter(Part::field("friction"));
        friction.save(to);
        to.leave();
    }

    fn restore(&mut self, from: &mut Reader<'_>) -> Result<(), Damaged> {
        self.identity.restore(from)?;
        for factor in &mut self.factors[..self.states] {
            *factor = from.number()?;
        }
        let position = from.number()?;
        self.bodies.restore_fixed(from)?;
        self.friction.restore(from)?;
        if from.is_moved() {
            self.derive_bodies(position);
        }
        Ok(())
    }
}

impl<const W: usize> ExactChain<W> {
    /// The bodies of this state, with the motor at `position` (its own coordinate).
    fn derive_bodies(&mut self, position: f64) {
        let (stretches, velocities) = self.factors.split_at(self.bodies.len() - 1);
        let mut axis_position = self.terms[0].transmission * position;
        for (i, (body, terms)) in self.bodies.iter_mut().zip(&self.terms).enumerate() {
            if i > 0 {
                axis_position -= stretches[i - 1];
            }
            *body = BodyState { position: axis_position * terms.per_axis, velocity: velocities[i] * terms.per_travel };
        }
        self.bodies[0].position = position;
    }
}

impl<const W: usize> Mechanics for ExactChain<W> {
    fn state(&mut self) -> Option<&mut dyn Stateful> {
        Some(self)
    }

    fn bodies(&self) -> &[BodyState] {
        &self.bodies
    }

    fn advance(&mut self, input: &Input) -> Result<(), MechanicsError> {
        wide_registers!(self.advanced(input), Self::advanced_in_wide_registers, self, input)
    }
}

/// Transition over one tick while the bodies of the set `stuck` do not move.
fn hold<const W: usize>(chain: &Chain, prescribed: bool, h: f64, stuck: usize) -> Hold<W> {
    let n = chain.bodies().len();
    let states = states(chain, prescribed);
    let (inputs, travel) = (n, states);
    let velocity = |i: usize| n - 1 + i;
    let moves = |i: usize| stuck & (1 << i) == 0;
    // States, then the travel of body 0, then the inputs (whose rows stay zero: they are held).
    let size = states + 1 + inputs;
    let mut a = DMatrix::<f64>::zeros(size, size);

    for i in 0..n {
        if !moves(i) {
            continue;
        }
        if i == 0 {
            a[(travel, velocity(0))] = 1.0;
        }
        // Stretch s_i = x_{i-1} - x_i grows with body i-1 and shrinks with body i.
        if i + 1 < n {
            a[(i, velocity(i))] += 1.0;
        }
        if i > 0 {
            a[(i - 1, velocity(i))] -= 1.0;
        }
        if prescribed && i == 0 {
            continue;
        }
        let body = &chain.bodies()[i];
        let per_force = h * h * body.transmission * body.transmission / body.inertia;
        for (link, sign) in [(i.checked_sub(1), 1.0), ((i + 1 < n).then_some(i), -1.0)] {
            let Some(link) = link else { continue };
            let coupling = &chain.links()[link];
            a[(velocity(i), link)] += sign * per_force * coupling.stiffness;
            for (end, side) in [(link, 1.0), (link + 1, -1.0)] {
                if moves(end) {
                    a[(velocity(i), velocity(end))] += sign * side * per_force * coupling.damping / h;
                }
            }
        }
        a[(velocity(i), velocity(i))] -= h * body.friction.linear() / body.inertia;
        a[(velocity(i), states + 1 + i)] = h * h * body.transmission / body.inertia;
    }
    if prescribed {
        // V_0 is a copy of the base's own velocity; both follow the chain v → a → j → s.
        let base = 2 * n - 1;
        a[(velocity(0), base + 1)] = 1.0;
        for k in 0..3 {
            a[(base + k, base + k + 1)] = 1.0;
        }
    }

    let e = a.exp();
    (0..states)
        .chain(states + 1..size)
        .map(|column| std::array::from_fn(|row| if row <= travel { e[(row, column)] } else { 0.0 }))
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::chain::{Body, Link};
    use crate::friction::{DryFriction, Friction};
    use servobench_base::state::words;

    fn body(inertia: f64, friction: Friction) -> Body {
        let coordinate = servobench_base::Coordinate::Linear;
        Body { name: "body", coordinate, inertia, transmission: 1.0, friction, bias: 0.1 }
    }

    /// Unchanged numbers give the bodies that were saved with them, except for roundings.
    #[test]
    fn bodies_follow_from_the_moved_numbers() {
        let bodies =
            [0.3, 0.7, 1.1].map(|inertia| Body { transmission: 0.5 + inertia, ..body(inertia, Friction::NONE) });
        let chain = Chain::new(bodies.to_vec(), vec![Link { stiffness: 3e4, damping: 2.0 }; 2]).unwrap();
        let model = Model::Chain(chain.clone());
        let setup = MechanicsSetup { model, drive: Drive::Effort, step: 1.0 / 12_000.0, initial: vec![] };
        let mut mechanics = ExactChain::<8>::new(chain, &setup);
        for _ in 0..2000 {
            let actuation = Actuation::Effort(20.0);
            mechanics.advance(&Input { actuation, motor_disturbance: 1.0, load_disturbance: -2.0 }).unwrap();
        }
        let mut saved = Vec::new();
        Mechanics::save(&mut mechanics, &mut words(|word| saved.push(word))).unwrap();
        let bodies = mechanics.bodies.clone();
        Mechanics::restore(&mut mechanics, &mut Reader::new(&saved)).unwrap();
        assert_eq!(mechanics.bodies, bodies);
        Mechanics::restore(&mut mechanics, &mut Reader::moved(&saved)).unwrap();
        for (one, other) in mechanics.bodies.iter().zip(&bodies) {
            // Three sums and a product.
            let is_near = |a: f64, b: f64| (a - b).abs() <= 8.0 * f64::EPSILON * b.abs();
            assert!(
                is_near(one.position, other.position) && is_near(one.velocity, other.velocity),
                "{one:?} {other:?}"
            );
        }
    }

    /// One to four bodies, with dry friction and without: processors with and without wide registers give the same bits.
    #[test]
    fn both_kinds_of_processors_give_the_same_bits() {
        fn compare<const W: usize>(chain: Chain, setup: &MechanicsSetup) {
            let mut random = servobench_testkit::Random::seeded(19);
            let mut here = ExactChain::<W>::new(chain, setup);
            let mut in_any = here.clone();
            for _ in 0..2000 {
                let (motor_disturbance, load_disturbance) = (random.signed(), random.signed());
                let actuation = Actuation::Effort(20.0 * random.signed());
                let input = Input { actuation, motor_disturbance, load_disturbance };
                here.advance(&input).unwrap();
                in_any.advanced(&input).unwrap();
                let bits = |chain: &ExactChain<W>| {
                    let bodies =
                        chain.bodies.iter().flat_map(|body| [body.position.to_bits(), body.velocity.to_bits()]);
                    bodies.collect::<Vec<_>>()
                };
                assert_eq!(bits(&here), bits(&in_any), "{input:?}");
            }
            assert!(here.bodies[0].position != 0.0);
        }
        let (viscous, dry) = (
            Friction { viscous: 0.2, ..Friction::NONE },
            DryFriction { coulomb: 2.0, breakaway: 3.0, stribeck_velocity: 0.01 },
        );
        let dry = Friction { dry, ..viscous };
        for friction in [Friction::NONE, dry] {
            for count in 1..=MAX_BODIES {
                let bodies = (0..count).map(|k| body(0.3 + 0.7 * k as f64, friction)).collect();
                let links = vec![Link { stiffness: 3e4, damping: 2.0 }; count - 1];
                let chain = Chain::new(bodies, links).unwrap();
                let model = Model::Chain(chain.clone());
                let setup = MechanicsSetup { model, drive: Drive::Effort, step: 1.0 / 12_000.0, initial: vec![] };
                match states(&chain, false) + 1 {
                    0..=4 => compare::<4>(chain, &setup),
                    _ => compare::<8>(chain, &setup),
                }
            }
        }
    }
}
