//! Factors on the gains of a cascade.
use servobench_base::Dq;

/// Factors on the gains of a cascade: 1 leaves a gain unchanged, 0 removes it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Factors {
    /// Factor on the gain of the position loop.
    pub position: f64,
    /// Factor on the gain of the velocity loop.
    pub velocity: f64,
    /// Factor on the part of the velocity loop besides its gain: the compensation of an observed disturbance.
    pub compensation: f64,
    /// Factors on the gains of both axes of the current loop.
    pub current: Dq,
}

impl Factors {
    /// Unchanged gains.
    pub const ONE: Self = Self { position: 1.0, velocity: 1.0, compensation: 1.0, current: Dq { d: 1.0, q: 1.0 } };

    /// Factors of 0 and 1 between which these lie, or beyond which they go, and their shares, which add up to 1. Both axes of the
    /// current loop share a corner if their factors are equal.
    pub(crate) fn corners(&self) -> Vec<(Self, f64)> {
        let mut corners = vec![(*self, 1.0)];
        let mut split = |value: f64, put: &dyn Fn(&mut Self, f64)| {
            if value == 0.0 || value.to_bits() == 1.0_f64.to_bits() {
                return;
            }
            let with = |(corner, share): &(Self, f64), at: f64, part: f64| {
                let mut corner = *corner;
                put(&mut corner, at);
                (corner, share * part)
            };
            corners =
                corners.iter().flat_map(|one| [with(one, 0.0, 1.0 - value), with(one, 1.0, value)]).collect::<Vec<_>>();
        };
        split(self.position, &|corner, at| corner.position = at);
        split(self.velocity, &|corner, at| corner.velocity = at);
        split(self.compensation, &|corner, at| corner.compensation = at);
        let Dq { d, q } = self.current;
        if d.to_bits() == q.to_bits() {
            split(d, &|corner, at| corner.current = Dq { d: at, q: at });
        } else {
            split(d, &|corner, at| corner.current.d = at);
            split(q, &|corner, at| corner.current.q = at);
        }
        corners
    }

    /// A bit for each factor that is not 0.
    pub(crate) fn bits(&self) -> u8 {
        let all = [self.position, self.velocity, self.compensation, self.current.d, self.current.q];
        all.iter().enumerate().map(|(bit, factor)| u8::from(*factor != 0.0) << bit).sum()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Oracle: a function that is affine in each factor equals the sum over its corners, weighted by their shares.
    #[test]
    fn corners_say_what_is_affine_in_each_factor() {
        let of = |f: &Factors| {
            let Factors { position: p, velocity: v, compensation: c, current: Dq { d, q } } = *f;
            3.0 + p - 2.0 * v + 5.0 * p * v + c * v + 7.0 * d - q * v * p
        };
        for factors in [
            Factors { position: 0.3, velocity: 4.0, ..Factors::ONE },
            Factors { velocity: 0.0, current: Dq { d: 2.5, q: 2.5 }, ..Factors::ONE },
            Factors { compensation: 0.0, current: Dq { d: 1.0, q: 0.25 }, ..Factors::ONE },
        ] {
            let corners = factors.corners();
            let found: f64 = corners.iter().map(|(corner, share)| share * of(corner)).sum();
            assert!((found - of(&factors)).abs() < 1e-12, "{factors:?}: {found}");
            assert!((corners.iter().map(|(_, share)| share).sum::<f64>() - 1.0).abs() < 1e-12);
        }
        assert_eq!(Factors::ONE.corners(), [(Factors::ONE, 1.0)]);
        assert_eq!(Factors { position: 0.0, ..Factors::ONE }.bits(), 0b11110);
    }
}
