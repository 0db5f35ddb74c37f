//! The error of the coupling, estimated from the exchanged values.
//!
//! Within a step a block has the polynomial p as input in place of the signal y. At the end of the step the defect d = p − y is known.
//! The block sees the mean of p − y over the step, to leading order
//!
//! ```text
//! extrapolated, order 0, 1, 2    d/2, 5·d/12, 3·d/8      the error grows as σ, σ(σ+1), σ(σ+1)(σ+2) over the step, σ = 0 … 1
//! its end announced              d/2 + ∇²y/12            a line to the announced value; ∇³y/24 for a parabola
//! ```
//! so that a mode of ωH per exchange has the relative error ωH/2 with inputs that are held, 5·(ωH)²/12 with order 1 and (ωH)²/12 if
//! the end is known: with order 1, 1 % takes about 40 exchanges per period.
//!
//! The errors of [`WINDOW`] exchanges are split into their median and the remainder. The remainder is compared with the standard
//! deviation of the signal in these exchanges, by the mean of its square roots, squared: a single jump, which is late by a step with any
//! method, hardly counts, and an unresolved mode does. The median is compared with the greatest value of the signal so far: a
//! constant acceleration gives a constant error of a force that is nearly constant itself.
//!
//! The worst window of the worst connection is the error of the coupling; a window in which the signal varies less than
//! [`LEAST`] of its variation in another, or less than rounding, does not count.
use crate::delay::Delay;
use crate::network::{Wire, Wiring};
use crate::polynomial::Order;
use crate::settings::{Method, Settings};

/// Exchanges in a window: six periods of a mode with 40 exchanges each. The delay of half a step of a held ramp is 0.8 % of it.
const WINDOW: usize = 256;
/// Fewest exchanges of a shorter run.
const FEWEST: usize = 20;
/// Factor from the mean of the errors by the standard deviation to the ratio of amplitudes in a sine: ((1/π)·∫√sin)² is 0.5818.
const OF_A_SINE: f64 = 1.0 / (0.5818 * std::f64::consts::SQRT_2);
/// Powers of two from the liveliest window down to windows that do not count: 2⁻¹⁰.
const LEAST: usize = 10;
/// Fraction of the greatest value that counts as rounding; signals may be of single precision.
const ROUNDING: f64 = 1e-6;

/// Estimated error of a coupling.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct EstimatedError {
    /// Index of the connection with the largest error.
    pub connection: usize,
    /// Error of its input within a step, relative to the variation of the signal.
    pub error: f64,
}

impl Settings {
    /// Relative error of an input that carries a mode, to leading order; `angle` is the phase of the mode per step, ωH (rad).
    #[must_use]
    pub fn error_of_a_mode(&self, angle: f64) -> f64 {
        match (&self.method, self.order) {
            (Method::Iterated(_), Order::Constant | Order::Linear) => angle.powi(2) / 12.0,
            (Method::Iterated(_), Order::Quadratic) => angle.powi(3) / 24.0,
            (_, Order::Constant) => angle / 2.0,
            (_, Order::Linear) => 5.0 * angle.powi(2) / 12.0,
            (_, Order::Quadratic) => 3.0 * angle.powi(3) / 8.0,
        }
    }
}

/// Errors of all connections whose signal is continuous.
pub(crate) struct Estimates {
    all: Vec<Estimate>,
    /// Value of each input at the end of the last step, as taken by its block.
    ends: Vec<f64>,
}

struct Estimate {
    connection: usize,
    from: usize,
    to: usize,
    output: usize,
    input: usize,
    /// Mean error per defect at the end.
    share: f64,
    /// Mean error from the difference of the signal between known values.
    between: Between,
    /// Last values of the signal, the newest first.
    last: [f64; 3],
    known: u32,
    window: Window,
    worst: Worst,
}

/// Error of a polynomial between known values.
#[derive(Clone, Copy)]
enum Between {
    /// The end is extrapolated.
    Nothing,
    /// A line: ∇²y/12.
    Line,
    /// A parabola: ∇³y/24.
    Parabola,
}

/// The exchanges of the current window.
struct Window {
    exchanges: usize,
    first: f64,
    sum: f64,
    squares: f64,
    errors: [f64; WINDOW],
}

/// The worst ratios by variation of the signal, in powers of two from the liveliest window down.
#[derive(Default)]
struct Worst {
    ratios: [f64; LEAST],
    liveliest: i32,
    greatest: f64,
    windows: u32,
}

impl Estimates {
    pub(crate) fn new(wiring: &Wiring, delays: &[Delay], order: Order) -> Self {
        let estimate = |delay: &Delay| {
            let connection = wiring.connections[delay.connection];
            let output = wiring.shapes[connection.from.block].first_output + connection.from.port;
            let (is_known, order) = (delay.steps == 0, delay.extrapolated.unwrap_or(order));
            let is_continuous = !connection.is_discrete && !wiring.discrete[output];
            is_continuous.then(|| Estimate {
                connection: delay.connection,
                from: connection.from.block,
                to: connection.to.block,
                output,
                input: wiring.shapes[connection.to.block].first_input + connection.to.port,
                share: match order {
                    _ if is_known => 1.0 / 2.0,
                    Order::Constant => 1.0 / 2.0,
                    Order::Linear => 5.0 / 12.0,
                    Order::Quadratic => 3.0 / 8.0,
                },
                between: match order {
                    _ if !is_known => Between::Nothing,
                    Order::Constant | Order::Linear => Between::Line,
                    Order::Quadratic => Between::Parabola,
                },
                last: [0.0; 3],
                known: 0,
                window: Window::default(),
                worst: Worst::default(),
            })
        };
        Self { all: delays.iter().filter_map(estimate).collect(), ends: vec![0.0; wiring.wires.len()] }
    }

    /// Notes the value of an input at the end of a step.
    pub(crate) fn note_end(&mut self, input: usize, value: f64) {
        self.ends[input] = value;
    }

    /// Evaluates the exchange `now`: `reached` are the steps that the blocks have reached, `newest` gives the values of outputs.
    pub(crate) fn judge(&mut self, now: u64, reached: &[u64], wires: &[Wire], newest: impl Fn(usize) -> f64) {
        for estimate in &mut self.all {
            // Blocks of different steps are compared where both have reached the end of one.
            if reached[estimate.from] == now && reached[estimate.to] == now {
                let Wire { gain, offset, .. } = wires[estimate.input];
                let value = gain * newest(estimate.output) + offset;
                estimate.push(value, self.ends[estimate.input] - value);
            }
        }
    }

    /// The largest error so far; `None` if no continuous signal was exchanged often enough.
    pub(crate) fn largest(&self) -> Option<EstimatedError> {
        let errors = self
            .all
            .iter()
            .filter_map(|estimate| Some(EstimatedError { connection: estimate.connection, error: estimate.error()? }));
        errors.reduce(|one, other| if other.error > one.error { other } else { one })
    }
}

impl Estimate {
    /// Adds a value with the defect of the input.
    fn push(&mut self, value: f64, defect: f64) {
        let [y1, y2, y3] = self.last;
        let between = match self.between {
            Between::Line if self.known >= 2 => (value - 2.0 * y1 + y2) / 12.0,
            Between::Parabola if self.known >= 3 => (value - 3.0 * y1 + 3.0 * y2 - y3) / 24.0,
            _ => 0.0,
        };
        (self.last, self.known) = ([value, y1, y2], self.known.saturating_add(1));
        self.worst.greatest = self.worst.greatest.max(value.abs());
        self.window.push(value, self.share * defect + between);
        if self.window.exchanges == WINDOW {
            self.worst.push(&self.window);
            self.window = Window { errors: self.window.errors, ..Window::default() };
        }
    }

    /// The error; for a run shorter than a window that of its exchanges.
    fn error(&self) -> Option<f64> {
        if self.worst.windows > 0 {
            return Some(self.worst.ratio());
        }
        let mut worst = Worst { greatest: self.worst.greatest, ..Worst::default() };
        (self.window.exchanges >= FEWEST).then(|| {
            worst.push(&self.window);
            worst.ratio()
        })
    }
}

impl Default for Window {
    fn default() -> Self {
        Self { exchanges: 0, first: 0.0, sum: 0.0, squares: 0.0, errors: [0.0; WINDOW] }
    }
}

impl Window {
    fn push(&mut self, value: f64, error: f64) {
        if self.exchanges == 0 {
            self.first = value;
        }
        let deviation = value - self.first;
        self.errors[self.exchanges] = error;
        self.exchanges += 1;
        self.sum += deviation;
        self.squares += deviation * deviation;
    }

    /// Standard deviation of the signal.
    fn deviation(&self) -> f64 {
        let count = self.exchanges as f64;
        ((self.squares - self.sum * self.sum / count).max(0.0) / count).sqrt()
    }

    /// Error relative to the variation of the signal, given its standard `deviation` and its `greatest` value so far.
    fn ratio(&self, deviation: f64, greatest: f64) -> f64 {
        let count = self.exchanges as f64;
        let mut sorted = self.errors;
        let (_, median, _) = sorted[..self.exchanges].select_nth_unstable_by(self.exchanges / 2, f64::total_cmp);
        let median = *median;
        let roots: f64 = self.errors[..self.exchanges].iter().map(|error| (error - median).abs().sqrt()).sum();
        (OF_A_SINE * (roots / count).powi(2) / deviation).max(median.abs() / greatest.max(deviation))
    }
}

impl Worst {
    fn push(&mut self, window: &Window) {
        self.windows = self.windows.saturating_add(1);
        let deviation = window.deviation();
        if deviation <= ROUNDING * self.greatest || !deviation.is_normal() {
            return;
        }
        let exponent = exponent(deviation);
        let is_first = self.ratios.iter().all(|ratio| *ratio == 0.0);
        if is_first {
            self.liveliest = exponent;
        }
        if exponent > self.liveliest {
            // Beyond the last place nothing counts any more.
            let by = usize::try_from(exponent - self.liveliest).unwrap_or(LEAST).min(LEAST);
            self.ratios.copy_within(..LEAST - by, by);
            self.ratios[..by].fill(0.0);
            self.liveliest = exponent;
        }
        let place = usize::try_from(self.liveliest - exponent).unwrap_or(LEAST);
        if let Some(ratio) = self.ratios.get_mut(place) {
            *ratio = ratio.max(window.ratio(deviation, self.greatest));
        }
    }

    fn ratio(&self) -> f64 {
        self.ratios.iter().fold(0.0, |most: f64, ratio| most.max(*ratio))
    }
}

/// The power of two at or below a normal number.
fn exponent(value: f64) -> i32 {
    i32::try_from(value.to_bits() >> 52 & 0x7ff).unwrap_or(0) - 1023
}
