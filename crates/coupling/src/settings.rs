//! Settings of a coupling.
use crate::network::NetworkError;
use crate::polynomial::Order;
use servobench_base::{Divider, Rate};
use servobench_config::choices;

/// Acceleration of the fixed-point iteration. With the residual r = G(x) − x:
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Acceleration {
    /// x ← x + ω·r. Converges where |1 − ω·(1 − λ)| < 1 for each eigenvalue λ of G'; ω = 1 is the plain fixed point.
    Relaxed(f64),
    /// ω from the last two residuals; the first is given. For loops with one signal it is the secant method.
    Aitken(f64),
    /// Interface quasi-Newton: the inverse of the Jacobian by least squares from the iterations so far, including those of
    /// previous steps. Directions not seen yet are relaxed by ω.
    QuasiNewton(f64),
}

/// Criteria for the end of an iteration.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Iteration {
    /// Tolerance of each signal (its own unit) …
    pub absolute: f64,
    /// … plus this fraction of its greatest magnitude among its last exchanges.
    pub relative: f64,
    /// Most evaluations of a step; at least 1.
    pub most: u32,
    /// Acceleration of the iteration.
    pub acceleration: Acceleration,
}

impl Default for Iteration {
    /// Quasi-Newton to 1e-9, at most 50 evaluations.
    fn default() -> Self {
        Self { absolute: 1e-12, relative: 1e-9, most: 50, acceleration: Acceleration::QuasiNewton(1.0) }
    }
}

impl Iteration {
    pub(crate) fn check(&self) -> Result<(), NetworkError> {
        let (Acceleration::Relaxed(omega) | Acceleration::Aitken(omega) | Acceleration::QuasiNewton(omega)) =
            self.acceleration;
        let refused = |field, bound, value| Err(NetworkError::Setting { field, bound, value });
        if !(self.absolute.is_finite() && self.absolute > 0.0) {
            refused("absolute", "finite and positive", self.absolute)
        } else if !(self.relative.is_finite() && self.relative >= 0.0) {
            refused("relative", "finite and not negative", self.relative)
        } else if self.most == 0 {
            refused("most", "at least 1", 0.0)
        } else if !(omega > 0.0 && omega <= 2.0) {
            refused("relaxation", "in (0, 2]", omega)
        } else {
            Ok(())
        }
    }
}

choices! {
    /// The kinds of [`Method`]s.
    pub enum MethodKind default GaussSeidel {
        /// all step at once, with the others' outputs at the start of the step
        Jacobi = "jacobi",
        /// one after the other, each with the new outputs of those before it
        GaussSeidel = "gauss-seidel",
        /// steps are repeated until inputs and outputs agree
        Iterated = "iterated",
    }
}

/// Order in which blocks perform a communication step, and the values they have from each other.
#[derive(Debug, Clone, PartialEq)]
pub enum Method {
    /// All with the values at its start.
    Jacobi,
    /// One after the other, in this order of all blocks; a later one sees the new values of an earlier one.
    GaussSeidel(Vec<usize>),
    /// Loops of blocks are repeated until the values exchanged at the end agree; blocks outside of loops follow their sources.
    Iterated(Iteration),
}

/// Settings for running a network.
#[derive(Debug, Clone, PartialEq)]
pub struct Settings {
    /// Base ticks per second.
    pub base_rate: Rate,
    /// The communication step H (base ticks).
    pub step: Divider,
    /// The method.
    pub method: Method,
    /// Degree of the polynomial that approximates a signal beyond its newest value. If its value at the end of the step is known,
    /// the degree is at least 1: a signal held at its future value would be ahead of its time.
    pub order: Order,
    /// Iteration that solves outputs that follow each other without a step; without it they are refused.
    pub algebraic: Option<Iteration>,
    /// True to end the run when a coupling grows by itself.
    pub watch: bool,
}
