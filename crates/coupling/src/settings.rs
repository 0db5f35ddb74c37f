//! How blocks are coupled.
use crate::network::NetworkError;
use crate::polynomial::Order;
use servobench_base::{Divider, Rate};
use servobench_config::choices;

/// How the fixed point of an iteration is approached. With the residual r = G(x) − x:
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Acceleration {
    /// x ← x + ω·r. Converges where |1 − ω·(1 − λ)| < 1 for each eigenvalue λ of G'; ω = 1 is the plain fixed point.
    Relaxed(f64),
    /// ω from the last two residuals; the first is given. For loops with one signal it is the secant method.
    Aitken(f64),
    /// Interface quasi-Newton: the inverse of the Jacobian by least squares from what the iterations have shown, those of the
    /// steps before too. Directions not seen yet are relaxed by ω.
    QuasiNewton(f64),
}

/// When an iteration is over.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Iteration {
    /// Each signal is met to `absolute` (its own unit) …
    pub absolute: f64,
    /// … plus this part of its greatest magnitude among its last exchanges.
    pub relative: f64,
    /// Most evaluations of a step; at least 1.
    pub most: u32,
    /// The way to the fixed point.
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
        /// all step at once, with what the others gave at the start of the step
        Jacobi = "jacobi",
        /// one after the other, each with what those before it have just given
        GaussSeidel = "gauss-seidel",
        /// steps are repeated until inputs and outputs agree
        Iterated = "iterated",
    }
}

/// In which order blocks go through a communication step, and what they know of each other then.
#[derive(Debug, Clone, PartialEq)]
pub enum Method {
    /// All with the values of its start.
    Jacobi,
    /// One after the other, in this order of all blocks; a later one sees what an earlier one has just come to.
    GaussSeidel(Vec<usize>),
    /// Loops of blocks are repeated until what they exchange at the end agrees; what is in no loop follows its sources.
    Iterated(Iteration),
}

/// How a network is run.
#[derive(Debug, Clone, PartialEq)]
pub struct Settings {
    /// Base ticks per second.
    pub base_rate: Rate,
    /// The communication step H (base ticks).
    pub step: Divider,
    /// The method.
    pub method: Method,
    /// Degree of the polynomial that stands for a signal beyond its newest value. Where its value at the end of the step is known,
    /// the degree is at least 1: a signal that is held at what it will be is ahead of its time.
    pub order: Order,
    /// How outputs that follow each other without a step are solved for; they are refused without.
    pub algebraic: Option<Iteration>,
    /// Whether a coupling that grows by itself ends the run.
    pub watch: bool,
}
