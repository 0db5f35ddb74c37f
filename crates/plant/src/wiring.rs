//! The cable between inverter and motor: two swapped wires, a lost phase.
//!
//! ```text
//! swapped    u_motor = M·u_legs      i_legs = M·i_motor      M = [ cos 2φ   sin 2φ ]      φ: axis of the unchanged phase
//!                                                                [ sin 2φ  −cos 2φ ]
//! lost       i_x = 0: the remaining current is one of two phases in series, s along n, at right angles to the axis of phase x
//! ```
//! M exchanges two phases and is its own inverse; currents are measured at the legs, so that the drive sees the mirror image of its motor.
//! The legs of an inverter are alike, so the mirror image of the request replaces the mirror image of the output.
//!
//! A phase that opens while it has a current draws an arc. The flux linkage of the other two is continuous,
//!
//! ```text
//! s = nᵀ·L·i/(nᵀ·L·n)      W_arc = 3/4·(iᵀ·L·i − s²·nᵀ·L·n)
//! ```
//! and the arc takes its energy within the tick, counted with the copper loss. Source: Clarke's transformation (Krause, *Analysis of
//! Electric Machinery*, 3rd ed., ch. 3); constancy of flux linkages at a sudden change, ch. 1.
use crate::pmsm;
use servobench_base::{AlphaBeta, Dq, ElectricalAngle, ParamError, Rotation, Stateful};
use servobench_config::Kind::Plain;
use servobench_config::not_negative;
use servobench_config::quantities::TIME;

servobench_config::parameters! {
    /// A parameter of the cable.
    pub enum WiringParameter {
        /// Time from which the phase is lost
        OPEN_AT "loss of a motor phase" = not_negative(Plain(&TIME), "0.3 s");
    }
}

servobench_config::choices! {
    /// Two exchanged phases.
    pub enum Swap {
        /// a and b
        Ab = "ab",
        /// b and c
        Bc = "bc",
        /// c and a
        Ca = "ca",
    }
}

servobench_config::choices! {
    /// A phase of the motor.
    pub enum Phase {
        /// phase a
        A = "a",
        /// phase b
        B = "b",
        /// phase c
        C = "c",
    }
}

/// Connection of a motor; constant during a run.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Wiring {
    /// Phases that are exchanged.
    pub swapped: Option<Swap>,
    /// A lost phase of the motor, and the time of the loss (s).
    pub open: Option<(Phase, f64)>,
}

const HALF_SQRT_3: f64 = 0.866_025_403_784_438_6;

impl Swap {
    /// Twice the angle of the unchanged phase.
    const fn twice(self) -> Rotation {
        match self {
            Self::Ab => Rotation { sin: HALF_SQRT_3, cos: -0.5 },
            Self::Bc => Rotation { sin: 0.0, cos: 1.0 },
            Self::Ca => Rotation { sin: -HALF_SQRT_3, cos: -0.5 },
        }
    }

    fn mirror(self, AlphaBeta { alpha, beta }: AlphaBeta) -> AlphaBeta {
        let Rotation { sin, cos } = self.twice();
        AlphaBeta { alpha: cos * alpha + sin * beta, beta: sin * alpha - cos * beta }
    }
}

impl Phase {
    /// Direction of a current that does not flow through this phase.
    const fn across(self) -> AlphaBeta {
        match self {
            Self::A => AlphaBeta { alpha: 0.0, beta: 1.0 },
            Self::B => AlphaBeta { alpha: -HALF_SQRT_3, beta: -0.5 },
            Self::C => AlphaBeta { alpha: HALF_SQRT_3, beta: -0.5 },
        }
    }
}

impl Wiring {
    /// True if the wiring is correct.
    #[must_use]
    pub const fn is_right(&self) -> bool {
        self.swapped.is_none() && self.open.is_none()
    }

    /// # Errors
    /// [`ParamError`] names the parameter that is out of its bound.
    pub fn check(&self) -> Result<(), ParamError> {
        self.open.map_or(Ok(()), |(_, at)| WiringParameter::OPEN_AT.check_in_words(at).map(|_| ()))
    }
}

/// A cable at work: its state from tick to tick.
#[derive(Debug, Clone, Copy, PartialEq, Stateful)]
pub(crate) struct Cable {
    #[state(constant)]
    wiring: Wiring,
    /// Ticks so far.
    tick: u64,
    is_open: bool,
}

impl Cable {
    /// # Errors
    /// [`ParamError`] names the parameter that is out of its bound.
    pub(crate) fn new(wiring: Wiring) -> Result<Self, ParamError> {
        wiring.check()?;
        Ok(Self { wiring, tick: 0, is_open: false })
    }

    /// Converts a vector of the legs to the motor, or of the motor to the legs.
    pub(crate) fn across(&self, of: AlphaBeta) -> AlphaBeta {
        self.wiring.swapped.map_or(of, |swap| swap.mirror(of))
    }

    /// Current at the legs from the `current` of a rotor at `angle`: that current, and its rotor.
    pub(crate) fn at_the_legs(
        &self,
        current: Dq,
        angle: ElectricalAngle,
        rotor: Rotation,
    ) -> (Dq, ElectricalAngle, Rotation) {
        let Some(swap) = self.wiring.swapped else { return (current, angle, rotor) };
        let twice = swap.twice();
        // M of a vector at θ is that vector with −q at 2φ − θ.
        let mirrored = Rotation {
            sin: twice.sin * rotor.cos - twice.cos * rotor.sin,
            cos: twice.cos * rotor.cos + twice.sin * rotor.sin,
        };
        let angle = ElectricalAngle(libm::atan2(twice.sin, twice.cos) - angle.0);
        (Dq { d: current.d, q: -current.q }, angle, mirrored)
    }

    /// Direction of the only current that flows, once a phase is lost.
    pub(crate) fn line(&self) -> Option<AlphaBeta> {
        self.wiring.open.and_then(|(phase, _)| self.is_open.then(|| phase.across()))
    }

    /// The current of a rotor at `rotor`: with a lost phase its direction is fixed in the stator.
    pub(crate) fn settled(&self, current: Dq, rotor: Rotation) -> Dq {
        self.line().map_or(current, |line| {
            let n = line.to_dq(rotor);
            let s = current.magnitude().copysign(n.d * current.d + n.q * current.q);
            Dq { d: s * n.d, q: s * n.q }
        })
    }

    /// Begins a tick of `h` (s) with `current` in the motor `params` and the rotor at `rotor`. Returns the energy of an arc (J).
    pub(crate) fn begin(&mut self, params: &pmsm::Params, current: &mut Dq, rotor: Rotation, h: f64) -> f64 {
        let opens = !self.is_open && self.wiring.open.is_some_and(|(_, at)| self.tick as f64 * h >= at);
        self.tick += 1;
        self.is_open |= opens;
        let Some(line) = self.line() else { return 0.0 };
        if !opens {
            *current = self.settled(*current, rotor);
            return 0.0;
        }
        let (n, l, i) = (line.to_dq(rotor), params.inductance, *current);
        let flux = n.d * l.d * i.d + n.q * l.q * i.q;
        let inductance = l.d * n.d * n.d + l.q * n.q * n.q;
        let s = flux / inductance;
        *current = Dq { d: s * n.d, q: s * n.q };
        0.75 * (l.d * i.d * i.d + l.q * i.q * i.q - inductance * s * s)
    }

    /// Advances by a tick without current.
    pub(crate) const fn rest(&mut self) {
        self.tick += 1;
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::inverter::{legs, vector};
    use proptest::prelude::*;

    const SWAPS: [(Swap, [usize; 3]); 3] = [(Swap::Ab, [1, 0, 2]), (Swap::Bc, [0, 2, 1]), (Swap::Ca, [2, 1, 0])];

    fn near(one: AlphaBeta, other: AlphaBeta) -> bool {
        // A dozen roundings of numbers up to 1e2.
        (one.alpha - other.alpha).abs() < 1e-13 * 1e2 && (one.beta - other.beta).abs() < 1e-13 * 1e2
    }

    proptest! {
        /// Oracle: the legs themselves, exchanged.
        #[test]
        fn a_swap_exchanges_two_legs(alpha in -50.0..50.0_f64, beta in -50.0..50.0_f64, theta in -9.0..9.0_f64) {
            for (swap, order) in SWAPS {
                let cable = Cable::new(Wiring { swapped: Some(swap), open: None }).unwrap();
                let of = AlphaBeta { alpha, beta };
                let before = legs(of);
                let expected = vector(order.map(|x| before[x]));
                prop_assert!(near(cable.across(of), expected), "{swap:?}");
                prop_assert!(near(cable.across(cable.across(of)), of));
                let (angle, current) = (ElectricalAngle(theta), Dq { d: alpha, q: beta });
                let at_motor = current.to_alpha_beta(angle.rotation());
                let (seen, at, rotor) = cable.at_the_legs(current, angle, angle.rotation());
                prop_assert!(near(seen.to_alpha_beta(rotor), cable.across(at_motor)), "{swap:?}");
                prop_assert!(near(seen.to_alpha_beta(at.rotation()), cable.across(at_motor)), "{swap:?}");
            }
        }

        /// Oracle: the current of that leg, and the least energy that the flux linkage of the other two allows.
        #[test]
        fn a_phase_that_opens_keeps_the_flux_of_the_other_two(d in -9.0..9.0_f64, q in -9.0..9.0_f64, theta in -9.0..9.0_f64) {
            let params = pmsm::Params {
                electrical_ratio: 3.0,
                resistance: 3.6,
                inductance: Dq { d: 36e-3, q: 51e-3 },
                flux_linkage: 0.545,
            };
            for (open, phase) in [Phase::A, Phase::B, Phase::C].into_iter().enumerate() {
                let mut cable = Cable::new(Wiring { swapped: None, open: Some((phase, 1.5e-3)) }).unwrap();
                let (rotor, mut current) = (ElectricalAngle(theta).rotation(), Dq { d, q });
                for _ in 0..2 {
                    cable.begin(&params, &mut current, rotor, 1e-3);
                    prop_assert_eq!((cable.line(), current), (None, Dq { d, q }));
                }
                let before = params.stored_energy(current);
                let arc = cable.begin(&params, &mut current, rotor, 1e-3);
                let after = legs(current.to_alpha_beta(rotor));
                prop_assert!(after[open].abs() < 1e-13, "{after:?}");
                prop_assert!(arc > -1e-15 && (before - params.stored_energy(current) - arc).abs() < 1e-14, "{arc}");
                // Flux linkage between the other two phases, λ_y − λ_z.
                let linked = |i: Dq| {
                    let l = params.inductance;
                    let flux = legs(Dq { d: l.d * i.d, q: l.q * i.q }.to_alpha_beta(rotor));
                    flux[(open + 1) % 3] - flux[(open + 2) % 3]
                };
                let kept = linked(Dq { d, q }) - linked(current);
                prop_assert!(kept.abs() < 1e-14);
                let turned = ElectricalAngle(theta + 0.3).rotation();
                let settled = cable.settled(current, turned);
                prop_assert!(legs(settled.to_alpha_beta(turned))[open].abs() < 1e-13);
                prop_assert!((settled.magnitude() - current.magnitude()).abs() < 1e-13);
            }
        }
    }

    /// Oracle: by hand, −cos(2·(θ − φ)) with φ = 0 for the phase a, 120° for b, 240° for c.
    #[test]
    fn a_swapped_motor_has_torque_of_either_sign() {
        for (swap, phi) in [(Swap::Bc, 0.0), (Swap::Ca, 120.0_f64.to_radians()), (Swap::Ab, 240.0_f64.to_radians())] {
            let cable = Cable::new(Wiring { swapped: Some(swap), open: None }).unwrap();
            for theta in [0.0, 0.37, 1.9, -2.6, 4.4] {
                let rotor = ElectricalAngle(theta).rotation();
                let found = cable.across(Dq { d: 0.0, q: 3.3 }.to_alpha_beta(rotor)).to_dq(rotor).q;
                assert!((found + 3.3 * (2.0 * (theta - phi)).cos()).abs() < 1e-13, "{swap:?}, {theta}: {found}");
            }
        }
    }

    #[test]
    fn what_is_out_of_its_bound_is_named() {
        let wrong = Wiring { swapped: None, open: Some((Phase::A, -1.0)) };
        assert_eq!(wrong.check().unwrap_err().name, WiringParameter::OPEN_AT.name);
        assert!(Wiring::default().is_right() && !wrong.is_right());
    }
}
