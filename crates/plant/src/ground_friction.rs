//! Friction of the bodies of a chain against the ground, tick by tick: one loop for all engines.
//!
//! ```text
//! before the tick   velocities, efforts of everything else → bodies that friction holds, its force on the others
//! after the tick    velocities → bodies that came to rest within it
//! ```
//! [`Friction`] is the law of one body; this module has the bodies with friction, their memories and the velocities at the start of a tick.
#![expect(clippy::inline_always, reason = "what is inlined is compiled for the registers of its caller")]
use crate::chain::Chain;
use crate::friction::{Friction, Grip, Memory};
use crate::mechanics::Drive;
use servobench_base::Stateful;

/// Friction of up to `N` bodies, without the linear part ([`Friction::linear`]), which is integrated with the chain.
#[derive(Debug, Clone, Stateful)]
pub struct GroundFriction<const N: usize> {
    /// [`Friction::NONE`] for a body without friction.
    #[state(constant)]
    laws: [Friction; N],
    memories: [Memory; N],
    /// Bodies with more than linear friction, body i being bit i.
    #[state(constant)]
    felt: usize,
    /// Tick length (s).
    #[state(constant)]
    step: f64,
    /// Velocities at the start of the last tick (m/s or rad/s).
    #[state(derived)]
    before: [f64; N],
}

/// Friction in a tick, without the linear part.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Grips<const N: usize> {
    /// Held bodies, body i being bit i: neither their position nor their velocity changes.
    pub held: usize,
    /// Force on each of the others, constant over the tick (N or N·m); 0 on held ones.
    pub forces: [f64; N],
}

impl<const N: usize> GroundFriction<N> {
    /// Friction of `chain`, at most `N` bodies, in ticks of `step` (s). A prescribed base follows its set-point and has none.
    #[must_use]
    pub fn new(chain: &Chain, drive: Drive, step: f64) -> Self {
        let first = usize::from(drive == Drive::Prescribed);
        let law = |i: usize| chain.bodies().get(i).filter(|_| i >= first).map_or(Friction::NONE, |body| body.friction);
        let laws: [Friction; N] = std::array::from_fn(law);
        let memories = std::array::from_fn(|_| Memory::default());
        let felt = set(&laws, |law| !law.is_linear());
        Self { laws, memories, felt, step, before: [0.0; N] }
    }

    /// True if there is only linear friction: then the rest need not be called.
    #[must_use]
    #[inline(always)]
    pub const fn is_linear(&self) -> bool {
        self.felt == 0
    }

    /// Bodies that it may ever hold, body i being bit i.
    #[must_use]
    pub fn may_hold(&self) -> usize {
        set(&self.laws, Friction::holds)
    }

    /// Friction in the coming tick, given the velocities and the efforts of everything else at its start, each body in its own coordinate.
    #[inline(always)]
    pub fn before_tick(&mut self, velocities: [f64; N], efforts: [f64; N]) -> Grips<N> {
        let mut grips = Grips { held: 0, forces: [0.0; N] };
        for (i, (law, memory)) in self.laws.iter().zip(&self.memories).enumerate() {
            if self.felt & (1 << i) == 0 {
                continue;
            }
            match law.grip(memory, velocities[i], efforts[i], self.step) {
                Grip::Held => grips.held |= 1 << i,
                Grip::Force(force) => grips.forces[i] = force,
            }
        }
        self.before = velocities;
        grips
    }

    /// The bodies that came to rest within the tick, given the velocities at its end; body i is bit i. Their velocity is to be set to zero.
    #[inline(always)]
    #[must_use]
    pub fn after_tick(&mut self, velocities: [f64; N]) -> usize {
        let mut at_rest = 0;
        for (i, (law, memory)) in self.laws.iter().zip(&mut self.memories).enumerate() {
            if self.felt & (1 << i) != 0 && law.settle(memory, self.before[i], velocities[i], self.step) {
                at_rest |= 1 << i;
            }
        }
        at_rest
    }
}

/// The bodies whose law satisfies `is`, body i being bit i.
fn set<const N: usize>(laws: &[Friction; N], is: impl Fn(&Friction) -> bool) -> usize {
    laws.iter().enumerate().filter(|(_, law)| is(law)).fold(0, |set, (i, _)| set | 1 << i)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::chain::{Body, Link};
    use crate::friction::DryFriction;
    use servobench_base::Coordinate;

    const DRY: Friction =
        Friction { dry: DryFriction { coulomb: 2.0, breakaway: 3.0, stribeck_velocity: 0.0 }, ..Friction::NONE };

    fn chain(frictions: &[Friction]) -> Chain {
        let coordinate = Coordinate::Linear;
        let body = |friction: &Friction| Body {
            name: "body",
            coordinate,
            inertia: 1.0,
            transmission: 1.0,
            friction: *friction,
            bias: 0.0,
        };
        let links = vec![Link { stiffness: 1.0, damping: 0.0 }; frictions.len() - 1];
        Chain::new(frictions.iter().map(body).collect(), links).unwrap()
    }

    #[test]
    fn a_body_at_rest_is_held_until_breakaway_and_one_that_slides_is_braked() {
        let mut friction = GroundFriction::<4>::new(&chain(&[DRY, Friction::NONE, DRY, DRY]), Drive::Effort, 1e-3);
        assert_eq!((friction.is_linear(), friction.may_hold()), (false, 0b1101));
        let grips = friction.before_tick([0.0, 0.0, 0.0, -0.2], [3.0, 9.0, -3.1, 0.0]);
        assert_eq!(grips, Grips { held: 0b0001, forces: [0.0, 0.0, 2.0, 2.0] });
        // The first one is held, the second feels none, the third broke away, the last one turned round.
        assert_eq!(friction.after_tick([0.0, 1.0, -0.1, 0.1]), 0b1000);
    }

    #[test]
    fn a_prescribed_base_feels_none() {
        let both = chain(&[DRY, DRY]);
        let mut friction = GroundFriction::<2>::new(&both, Drive::Prescribed, 1e-3);
        assert_eq!(friction.may_hold(), 0b10);
        assert_eq!(friction.before_tick([0.1, 0.1], [0.0; 2]), Grips { held: 0, forces: [0.0, -2.0] });
        assert_eq!(friction.after_tick([-0.1, -0.1]), 0b10);
        let viscous = chain(&[DRY, Friction { viscous: 0.5, ..Friction::NONE }]);
        assert!(GroundFriction::<2>::new(&viscous, Drive::Prescribed, 1e-3).is_linear());
    }
}
