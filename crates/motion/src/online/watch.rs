//! Whether a quantity keeps its limits on a way, or comes back into them.
use super::second::Sides;

/// What rounding may add to a limit, as a part of it.
pub(crate) const ROUNDING: f64 = 1e-11;

/// Watches the values that a quantity has, at its turning points at least, in the order of time.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Watch {
    sides: Sides,
    /// Largest part by which it was beyond a limit; below zero while it was inside.
    pub(crate) most: f64,
    /// The same without the way back from where it began.
    pub(crate) fault: f64,
    /// While it comes back: how far it still is beyond, and on which side.
    returning: Option<(f64, f64)>,
}

impl Watch {
    /// From its first value on.
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

/// How far `value` is beyond its limit, as a part of that, and on which side.
fn parts(sides: Sides, value: f64) -> (f64, f64) {
    let (excess, side) = sides.excess(value);
    (excess / sides.towards(side), side)
}
