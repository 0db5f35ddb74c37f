//! Saturation by one figure of a data sheet: the remaining torque per ampere at a large current.
//!
//! ```text
//! m² = x² + κ·i_q²                x = i_d + i_m, i_m the current that the magnets stand for
//! W' = A·(s·m²/2 + (1 − s)·(√(1 + g·m²) − 1)/g)
//! ψ_d = A·x·φ(m)      ψ_q = A·κ·i_q·φ(m)      φ = s + (1 − s)/√(1 + g·m²)
//! ```
//! One main flux of all ampere-turns saturates, in both axes by the same factor φ; the part s never does. W' is convex for all currents. φ
//! is a smooth form of Fröhlich's magnetisation curve (assumed; it has 1 + |m| where this has √(1 + m²)); one factor for both axes is the
//! classical model of salient machines: de Jong, *IEE Proceedings B* 129, 1982.
//!
//! A, κ, i_m and g follow from the data sheet: ψ and both inductances without current, and φ(i_d = 0, i_q = I)/φ(0, 0) = k, the share
//! of the torque per ampere, and of L_q, that remains at the current I.
//!
//! ```text
//! ψ = A·i_m·φ(i_m)      L_d = A·(φ(i_m) + i_m·φ'(i_m))      L_q = A·κ·φ(i_m)
//! ```
use super::{FluxPoint, Inductance};
use servobench_base::{Dq, ParamError};
use servobench_config::Bound::Within;
use servobench_config::Kind::Plain;
use servobench_config::quantities::{CURRENT, RATIO};
use servobench_config::{Measure, positive};

const fn share(low: f64, example: &'static str) -> Measure {
    Measure { kind: Plain(&RATIO), bound: Within(low, 1.0), example }
}

servobench_config::parameters! {
    /// A parameter of the saturation.
    pub enum SaturationParameter {
        /// Current in the q axis for which `share` is given, with i_d = 0
        CURRENT "current of the saturation" = positive(Plain(&CURRENT), "30 Apk");
        /// Torque or force per ampere at that current, as a share of that without current: K_T(peak)/K_T(small)
        SHARE "share of the effort per ampere" = share(0.3, "0.85");
        /// Share of the inductances that never saturates
        RESIDUAL "residual share of the inductance" = share(0.0, "0.1");
    }
}

/// Saturation of the iron.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Saturation {
    /// Current in the q axis, without any in the d axis (A, peak).
    pub current: f64,
    /// Remaining effort per ampere there, as a share.
    pub share: f64,
    /// Share of the inductances that never saturates.
    pub residual: f64,
}

/// The curve of one motor.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Curve {
    /// A.
    inductance: f64,
    /// κ.
    saliency: f64,
    /// i_m.
    magnets: f64,
    /// g.
    knee: f64,
    /// s.
    residual: f64,
}

impl Saturation {
    /// Default share of the inductances that never saturates.
    pub const RESIDUAL: f64 = 0.1;

    /// φ at g·m².
    fn factor(&self, square: f64) -> f64 {
        self.residual + (1.0 - self.residual) / libm::sqrt(1.0 + square)
    }

    /// The curve with the knee `g`, in which the magnets stand for the current `i_m` that gives ψ and L_d.
    fn with_knee(&self, g: f64, flux_linkage: f64, inductance: Dq) -> Curve {
        // ψ/L_d = i_m·φ/(φ + i_m·φ'), which grows with i_m and is above it.
        let ratio = |i_m: f64| {
            let square = g * i_m * i_m;
            let root = libm::sqrt(1.0 + square);
            i_m * self.factor(square) / (self.residual + (1.0 - self.residual) / (root * root * root))
        };
        let wanted = flux_linkage / inductance.d;
        let magnets = halved([0.0, wanted], |i_m| ratio(i_m) < wanted);
        let factor = self.factor(g * magnets * magnets);
        let own = flux_linkage / (magnets * factor);
        Curve { inductance: own, saliency: inductance.q / (own * factor), magnets, knee: g, residual: self.residual }
    }

    /// Remaining torque per ampere by the curve, as a share.
    fn left(&self, curve: &Curve) -> f64 {
        let square = curve.magnets * curve.magnets;
        self.factor(curve.knee * (square + curve.saliency * self.current * self.current))
            / self.factor(curve.knee * square)
    }
}

/// Point between `ends` up to which the condition `holds`, to the rounding.
fn halved([mut low, mut high]: [f64; 2], holds: impl Fn(f64) -> bool) -> f64 {
    for _ in 0..200 {
        let middle = low + (high - low) / 2.0;
        if middle <= low || middle >= high {
            break;
        }
        if holds(middle) { low = middle } else { high = middle }
    }
    high
}

impl Curve {
    pub(super) fn new(saturation: &Saturation, flux_linkage: f64, inductance: Dq) -> Result<Self, ParamError> {
        use SaturationParameter as P;
        P::CURRENT.check_in_words(saturation.current)?;
        P::SHARE.check_in_words(saturation.share)?;
        P::RESIDUAL.check_in_words(saturation.residual)?;
        let of = |g: f64| saturation.with_knee(g, flux_linkage, inductance);
        if saturation.share >= 1.0 {
            return Ok(of(0.0));
        }
        let left =
            |exponent: f64| saturation.left(&of(libm::exp2(exponent) / (saturation.current * saturation.current)));
        // The torque falls with the knee, then rises as the magnets alone saturate the iron: the side before that.
        let mut high = -30.0;
        while left(high) > saturation.share {
            high += 0.25;
            if high > 30.0 || left(high) > left(high - 0.25) {
                return Err(ParamError {
                    name: P::SHARE.name,
                    value: saturation.share,
                    bound: "within what these magnets and inductances allow (a larger share, or a larger current)",
                });
            }
        }
        let exponent = halved([high - 0.25, high], |exponent| left(exponent) > saturation.share);
        Ok(of(libm::exp2(exponent) / (saturation.current * saturation.current)))
    }

    pub(super) fn at(&self, i: Dq) -> FluxPoint {
        let Self { inductance, saliency, magnets, knee, residual } = *self;
        let x = i.d + magnets;
        let per = 1.0 / libm::sqrt(1.0 + knee * (x * x + saliency * i.q * i.q));
        let falls = (1.0 - residual) * per;
        let (factor, slope) = (residual + falls, knee * falls * per * per);
        FluxPoint {
            flux: Dq { d: inductance * x * factor, q: inductance * saliency * i.q * factor },
            inductance: Inductance {
                // φ − g·x²·(1 − s)/√³, which is s + (1 − s)·(1 + g·κ·i_q²)/√³.
                dd: inductance * (residual + falls * per * per * (1.0 + knee * saliency * i.q * i.q)),
                dq: -inductance * saliency * slope * x * i.q,
                qq: inductance * saliency * (residual + falls * per * per * (1.0 + knee * x * x)),
            },
        }
    }

    /// With y = √g·(x, √κ·i_q): (√(1 + y₀²)·√(1 + y₁²) − 1 − y₀·y₁)/√(1 + y₁²), in which nothing cancels after expansion by its
    /// conjugate.
    pub(super) fn beyond(&self, before: Dq, after: Dq) -> f64 {
        let Self { inductance, saliency, magnets, knee, residual } = *self;
        let (x, change) = (before.d + magnets, Dq { d: after.d - before.d, q: after.q - before.q });
        let root = |x: f64, q: f64| libm::sqrt(1.0 + knee * (x * x + saliency * q * q));
        let (first, last) = (root(x, before.q), root(after.d + magnets, after.q));
        let square = change.d * change.d + saliency * change.q * change.q;
        let across = x * change.q - before.q * change.d;
        let along = x * (after.d + magnets) + saliency * before.q * after.q;
        let curved = (square + knee * saliency * across * across) / (last * (first * last + 1.0 + knee * along));
        inductance * (0.5 * residual * square + (1.0 - residual) * curved)
    }
}
