//! Stops at the ends of the travel, which push the load back.
//!
//! ```text
//! F = −max(0, k·δ + d·v)    where δ = x − end > 0, at the positive end; mirrored at the negative one
//! ```
//! A stop pushes and does not pull, however fast the load leaves it. The force is held over a tick of length T and is therefore that
//! of its middle, δ = x + v·T/2 − end: held from the beginning of the tick it would be half a tick late, which takes k·T/2 from the
//! damping, and a load would leave an undamped stop faster than it came.
use crate::mechanics::BodyState;
use core::f64::consts::PI;
use servobench_config::Kind::Axis;
use servobench_config::quantities::{POSITION, STIFFNESS, VISCOUS};
use servobench_config::{Parameter, ParameterError, any, not_negative, positive};
use thiserror::Error;

/// Minimum number of ticks in a stop: half a period of the oscillation of the load on the stop.
const TICKS_IN_A_STOP: f64 = 10.0;
/// Largest share of its velocity that a load in a stop may lose in a tick.
const MOST_DAMPED: f64 = 0.5;

servobench_config::parameters! {
    /// A parameter of the end stops, in the axis coordinate.
    pub enum EndStopParameter {
        /// Position at which the stop at the negative end begins
        NEGATIVE "position of the negative end stop" = any(Axis(&POSITION), "-30 mm");
        /// Position at which the stop at the positive end begins
        POSITIVE "position of the positive end stop" = any(Axis(&POSITION), "530 mm");
        /// Stiffness of both stops
        STIFFNESS "stiffness of the end stops" = positive(Axis(&STIFFNESS), "10 N/um");
        /// Damping of both stops
        DAMPING "damping of the end stops" = not_negative(Axis(&VISCOUS), "3000 N s/m");
    }
}

/// Positions and parameters of the stops; constant during a run.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct EndStops {
    /// Beginning of the stop at the negative end (axis coordinate).
    pub negative: Option<f64>,
    /// Beginning of the stop at the positive end (axis coordinate).
    pub positive: Option<f64>,
    /// Stiffness of both, `k` (N/m or N·m/rad).
    pub stiffness: f64,
    /// Damping of both, `d` (N·s/m or N·m·s/rad).
    pub damping: f64,
}

/// Errors of stops that are impossible, or too fast with this load for ticks of this length.
#[derive(Debug, Clone, Copy, PartialEq, Error)]
pub enum EndStopError {
    /// A parameter is out of its bound.
    #[error(transparent)]
    Parameter(#[from] ParameterError),
    /// The motion in a stop is too fast for the ticks.
    #[error("`{name}` must be at most {most:.4e} with a load of {inertia} in ticks of {step} s, got {value:e}")]
    TooFast {
        /// The parameter.
        name: &'static Parameter,
        /// Its value.
        value: f64,
        /// Largest value for these ticks.
        most: f64,
        /// Mass or inertia of the load (axis coordinate).
        inertia: f64,
        /// Length of a tick (s).
        step: f64,
    },
}

impl EndStopError {
    /// The wrong parameter.
    #[must_use]
    pub const fn parameter(&self) -> &'static Parameter {
        match self {
            Self::Parameter(error) => error.name,
            Self::TooFast { name, .. } => name,
        }
    }
}

impl EndStops {
    /// Checks the parameters, and that ticks of `step` (s) resolve the motion of a load of `inertia` (axis coordinate) in a stop; without
    /// an inertia, the parameters alone.
    ///
    /// # Errors
    /// [`EndStopError`] names the first parameter out of its bound.
    pub fn check(&self, step: f64, inertia: Option<f64>) -> Result<(), EndStopError> {
        for (parameter, end) in
            [(EndStopParameter::NEGATIVE, self.negative), (EndStopParameter::POSITIVE, self.positive)]
        {
            end.map_or(Ok(0.0), |end| parameter.check(end))?;
        }
        EndStopParameter::STIFFNESS.check(self.stiffness)?;
        EndStopParameter::DAMPING.check(self.damping)?;
        let Some(inertia) = inertia else { return Ok(()) };
        let fastest = PI / (TICKS_IN_A_STOP * step);
        for (name, value, most) in [
            (EndStopParameter::STIFFNESS, self.stiffness, inertia * fastest * fastest),
            (EndStopParameter::DAMPING, self.damping, MOST_DAMPED * inertia / step),
        ] {
            if value > most {
                return Err(EndStopError::TooFast { name, value, most, inertia, step });
            }
        }
        Ok(())
    }

    /// Force or torque (axis coordinate) on a load with the state `load` at the beginning of a tick of `step` (s), held over the tick.
    #[inline]
    #[must_use]
    pub fn effort(&self, load: BodyState, step: f64) -> f64 {
        let middle = load.position + 0.5 * step * load.velocity;
        let push = |depth: f64, speed: f64| {
            if depth > 0.0 { (self.stiffness * depth + self.damping * speed).max(0.0) } else { 0.0 }
        };
        let forward = self.negative.map_or(0.0, |end| push(end - middle, -load.velocity));
        let backward = self.positive.map_or(0.0, |end| push(middle - end, load.velocity));
        forward - backward
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    const MASS: f64 = 12.0;

    /// A free load that meets a stop with `speed` (m/s), from just before the contact until just after it: its velocity at the end, and
    /// its largest depth in the stop.
    fn bounce(stops: &EndStops, end: f64, direction: f64, speed: f64, step: f64) -> (f64, f64) {
        let mut load = BodyState { position: end - direction * 0.3 * speed * step, velocity: direction * speed };
        let mut deepest: f64 = 0.0;
        loop {
            let acceleration = stops.effort(load, step) / MASS;
            load.position += step * (load.velocity + 0.5 * step * acceleration);
            load.velocity += step * acceleration;
            deepest = deepest.max(direction * (load.position - end));
            if direction * (load.position - end) < 0.0 && direction * load.velocity < 0.0 {
                return (-direction * load.velocity, deepest);
            }
        }
    }

    fn stops(stiffness: f64, damping: f64) -> EndStops {
        EndStops { negative: Some(-0.1), positive: Some(0.4), stiffness, damping }
    }

    /// Oracle: the half oscillation of an undamped spring: as fast out as in, v/ω deep.
    #[test]
    fn an_undamped_stop_gives_back_what_it_took() {
        let undamped = stops(1e6, 0.0);
        let omega = (1e6 / MASS).sqrt();
        for (end, direction) in [(-0.1, -1.0), (0.4, 1.0)] {
            let (speed, deepest) = bounce(&undamped, end, direction, 0.37, 1e-6);
            assert!((speed / 0.37 - 1.0).abs() < 1e-3, "{speed}");
            assert!((deepest * omega / 0.37 - 1.0).abs() < 1e-3, "{deepest}");
        }
    }

    /// Oracle: with m·δ̈ + d·δ̇ + k·δ = 0 from δ = 0 the force k·δ + d·v is zero when the load leaves, at ω_d·t = π − 2·asin ζ; it has
    /// e^(−ζ·ω·t) of its velocity then.
    #[test]
    fn a_damped_stop_takes_what_its_damping_says() {
        for ratio in [0.1_f64, 0.3, 0.6] {
            let omega = (1e6 / MASS).sqrt();
            let damped = stops(1e6, 2.0 * ratio * (1e6 * MASS).sqrt());
            let (speed, _) = bounce(&damped, 0.4, 1.0, 0.37, 1e-6);
            let damped_omega = omega * (1.0 - ratio * ratio).sqrt();
            let leaves = 2.0 * ratio.acos() / damped_omega;
            let expected = (-ratio * omega * leaves).exp();
            println!("{ratio}: {} of {expected}", speed / 0.37);
            assert!((speed / 0.37 - expected).abs() < 2e-3, "{ratio}: {speed}");
        }
    }

    proptest! {
        /// In the coarsest permitted ticks, wherever in a tick it comes, a load does not leave faster than it came, except for the effect
        /// of a tick that is half inside, and it is pushed outwards only.
        #[test]
        fn a_stop_adds_no_energy_and_does_not_pull(
            share in 0.05..1.0_f64, damped in 0.0..1.0_f64, speed in 1e-3..2.0_f64, depth in -1e-3..1e-3_f64,
        ) {
            let step = 62.5e-6;
            let most = MASS * (PI / (TICKS_IN_A_STOP * step)).powi(2);
            let stops = stops(share * most, damped * MOST_DAMPED * MASS / step);
            prop_assert!(stops.check(step, Some(MASS)).is_ok());
            let (leaves, _) = bounce(&stops, 0.4, 1.0, speed, step);
            prop_assert!(leaves <= 1.05 * speed, "{leaves} after {speed}");
            for velocity in [-speed, 0.0, speed] {
                let at = |position| stops.effort(BodyState { position, velocity }, step);
                let [positive, negative, between] = [0.4 + depth, -0.1 - depth, 0.2].map(at);
                prop_assert!(positive <= 0.0 && negative >= 0.0 && between.abs() <= 0.0);
            }
        }
    }

    #[test]
    fn what_the_ticks_do_not_resolve_is_refused_with_the_most_that_they_do() {
        let refusal = |stops: EndStops, inertia| stops.check(62.5e-6, inertia).unwrap_err();
        let stiff = refusal(stops(1e9, 0.0), Some(12.0));
        assert_eq!(stiff.parameter(), EndStopParameter::STIFFNESS);
        let message =
            "`stiffness of the end stops` must be at most 3.0319e8 with a load of 12 in ticks of 0.0000625 s, got 1e9";
        assert_eq!(stiff.to_string(), message);
        assert_eq!(refusal(stops(1e6, 1e6), Some(12.0)).parameter(), EndStopParameter::DAMPING);
        assert!(stops(1e9, 1e6).check(62.5e-6, None).is_ok(), "of an unknown load");
        assert_eq!(refusal(stops(0.0, 0.0), None).parameter(), EndStopParameter::STIFFNESS);
        assert_eq!(refusal(stops(1.0, f64::NAN), None).parameter(), EndStopParameter::DAMPING);
        let nowhere = EndStops { positive: Some(f64::INFINITY), ..stops(1.0, 0.0) };
        assert_eq!(refusal(nowhere, None).parameter(), EndStopParameter::POSITIVE);
    }
}
