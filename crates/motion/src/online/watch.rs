//! Compliance of a quantity with its limits on a path, or its return into them.
use super::second::Sides;

/// Relative excess over a limit that rounding may cause.
pub(crate) const ROUNDING: f64 = 1e-11;

/// Watches the values that a quantity has, at its turning points at least, in the order of time.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Watch {
    sides: Sides,
    /// Largest part by which it was beyond a limit; below zero while it was inside.
    pub(crate) most: f64,
    /// The same without the return from its first value.
    pub(crate) fault: f64,
    /// Excess and side while it comes back.
    returning: Option<(f64, f64)>,
}

impl Watch {
    /// Starts with its first value.
    pub(crate) fn new(sides: Sides, first: f64) -> Self {
        let (part, side) = parts(sides, first);
        let is_beyond = part > ROUNDING;
        let fault = if is_beyond { f64::NEG_INFINITY } else { part };
        Self { sides, most: part, fault, returning: is_beyond.then_some((part, side)) }
    }

    /// The next value.
    pub(crate) fn see(&mut self, value: f64) {
        let (part, side) = parts(self.sides, value);
        self.most = self.most.max(part);
        match self.returning {
            Some((last, same)) if side * same > 0.0 && part > ROUNDING && part <= last + ROUNDING => {
                self.returning = Some((part, side));
            }
            _ => {
                self.returning = None;
                self.fault = self.fault.max(part);
            }
        }
    }
}

/// Relative excess of `value` over its limit, and its side.
fn parts(sides: Sides, value: f64) -> (f64, f64) {
    let (excess, side) = sides.excess(value);
    (excess / sides.towards(side), side)
}
