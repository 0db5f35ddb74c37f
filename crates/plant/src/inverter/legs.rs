//! The three legs of a bridge, and their conversion to and from the space vector.
//!
//! ```text
//! a = α    b = −α/2 + √3/2·β    c = −α/2 − √3/2·β        α = (2a − b − c)/3    β = (b − c)/√3
//! ```
//! A star point that is not connected takes the common component of the legs, so no vector shows it. Source: Krause, *Analysis of Electric
//! Machinery*, ch. 3.
#![expect(clippy::inline_always, reason = "what is inlined is compiled for the registers of its caller")]
use servobench_base::AlphaBeta;

const HALF_SQRT_3: f64 = 0.866_025_403_784_438_6;
const SQRT_3: f64 = 1.732_050_807_568_877_2;

/// One value for each leg: currents out of it, or voltages of it.
pub(crate) type Legs = [f64; 3];

/// The legs of a vector, without a common component.
#[inline(always)]
pub(crate) fn legs(of: AlphaBeta) -> Legs {
    let (half, quadrature) = (-0.5 * of.alpha, HALF_SQRT_3 * of.beta);
    [of.alpha, half + quadrature, half - quadrature]
}

/// The vector of the legs.
#[inline(always)]
pub(crate) fn vector([a, b, c]: Legs) -> AlphaBeta {
    AlphaBeta { alpha: (2.0 * a - b - c) / 3.0, beta: (b - c) / SQRT_3 }
}

/// Power of the currents `i` at the voltages `u`.
#[cfg(test)]
pub(crate) fn product(u: Legs, i: Legs) -> f64 {
    u[0] * i[0] + u[1] * i[1] + u[2] * i[2]
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Oracle: by hand, cosines of 0 and ±120°. The power of the legs is 3/2 of that of the vectors.
    #[test]
    fn a_vector_is_its_legs_and_nothing_in_common() {
        let along_b = AlphaBeta { alpha: -0.5, beta: HALF_SQRT_3 };
        let found = legs(along_b);
        for (found, expected) in found.iter().zip([-0.5, 1.0, -0.5]) {
            assert!((found - expected).abs() < 1e-15, "{found} {expected}");
        }
        let back = vector(found.map(|leg| leg + 17.0));
        assert!((back.alpha - along_b.alpha).abs() < 1e-14 && (back.beta - along_b.beta).abs() < 1e-14, "{back:?}");
        let (u, i) = (AlphaBeta { alpha: 3.0, beta: -7.0 }, AlphaBeta { alpha: 0.4, beta: 1.1 });
        let power = 1.5 * (u.alpha * i.alpha + u.beta * i.beta);
        assert!((product(legs(u), legs(i)) - power).abs() < 1e-14 * 10.0);
    }
}
