//! Modes of a chain: their frequencies and damping.
//!
//! ```text
//! M·ẍ + D·ẋ + K·x = 0                        x axis coordinates, M_i = m_i/r_i², dry friction left out
//! K·φ = ω²·M·φ                               undamped frequencies, of the symmetric M^(−½)·K·M^(−½)
//! s' = V·v,  v' = −M⁻¹·(Vᵀ·C·s + D·v)        s link stretches: eigenvalues λ of the damped chain
//! ζ = −Re λ/|λ|
//! ```
//! In stretches the free chain has no double zero eigenvalue, which numerical methods handle badly. A mode whose damped
//! eigenvalues are real, or ambiguous, has the damping of its own shape, ζ = φᵀ·D·φ/(2ω). Source: Meirovitch,
//! *Fundamentals of Vibrations*, §7.
use crate::chain::Chain;
use nalgebra::{Complex, DMatrix, DVector, Schur, SymmetricEigen};
use servobench_base::HeldMode;

/// A mode.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Mode {
    /// Undamped frequency ω (rad/s).
    pub omega: f64,
    /// Damping ratio ζ; a mode of 1 and above does not ring.
    pub damping: f64,
}

/// Maximum iterations of the QR method for an eigenvalue; if it has not converged by then, it does not.
const MOST_TURNS: usize = 1000;
/// A frequency below this share of the highest is that of the free chain as a whole: zero.
const AT_REST: f64 = 1e-6;

/// Masses, dampers and springs, without held bodies.
struct Matrices {
    /// M^(−½)·K·M^(−½) and M^(−½)·D·M^(−½).
    stiffness: DMatrix<f64>,
    damping: DMatrix<f64>,
    /// Stretch of each link per velocity coordinate M^½·v.
    stretches: DMatrix<f64>,
    /// Stiffness of each link.
    springs: DVector<f64>,
}

impl Chain {
    /// The modes that ring, the slowest first; with the motor `held` those of the rest of the chain.
    #[must_use]
    pub fn modes(&self, held: bool) -> Vec<Mode> {
        let matrices = self.matrices(held);
        if matrices.stiffness.is_empty() {
            return Vec::new();
        }
        let SymmetricEigen { eigenvalues, eigenvectors } = matrices.stiffness.clone().symmetric_eigen();
        let highest = eigenvalues.iter().copied().fold(0.0, f64::max).sqrt();
        let mut modes: Vec<Mode> = eigenvalues
            .iter()
            .enumerate()
            .filter(|(_, squared)| **squared > (AT_REST * highest).powi(2))
            .map(|(i, squared)| {
                let (omega, shape) = (squared.sqrt(), eigenvectors.column(i));
                Mode { omega, damping: (&matrices.damping * shape).dot(&shape) / (2.0 * omega) }
            })
            .collect();
        modes.sort_by(|one, other| one.omega.total_cmp(&other.omega));
        let mut ringing: Vec<_> = self.eigenvalues(held).into_iter().filter(|value| value.im > 0.0).collect();
        ringing.sort_by(|one, other| one.norm().total_cmp(&other.norm()));
        if ringing.len() == modes.len() {
            for (mode, value) in modes.iter_mut().zip(&ringing) {
                mode.damping = (-value.re / value.norm()).max(0.0);
            }
        }
        modes
    }

    /// The modes in which the load, the last body, follows the motor. Damping that couples modes is left out.
    #[must_use]
    pub fn held_modes(&self) -> Vec<HeldMode> {
        let Some(first) = self.links().first() else { return Vec::new() };
        let matrices = self.matrices(true);
        let SymmetricEigen { eigenvalues, eigenvectors } = matrices.stiffness.clone().symmetric_eigen();
        let root = |body: &crate::chain::Body| body.inertia.sqrt() / body.transmission;
        let (near, far) = (root(&self.bodies()[1]), root(&self.bodies()[self.bodies().len() - 1]));
        let modes = eigenvalues.iter().zip(eigenvectors.column_iter()).map(|(squared, shape)| HeldMode {
            weight: shape[0] / near * shape[shape.len() - 1] / far * first.stiffness / squared,
            omega: squared.sqrt(),
            decay: (&matrices.damping * shape).dot(&shape),
            lead: first.damping / first.stiffness,
        });
        modes.collect()
    }

    /// The eigenvalues λ of the damped chain (1/s): of velocities and stretches, so that the position of the whole is not one of
    /// them. Empty when the iteration does not converge.
    #[must_use]
    pub fn eigenvalues(&self, held: bool) -> Vec<Complex<f64>> {
        let Matrices { damping, stretches, springs, .. } = self.matrices(held);
        let (links, free) = stretches.shape();
        if free == 0 {
            return Vec::new();
        }
        // Stretches times the square root of their stiffness: energies, so that the matrix is balanced.
        let coupled = DMatrix::from_diagonal(&springs.map(f64::sqrt)) * stretches;
        let mut matrix = DMatrix::zeros(links + free, links + free);
        matrix.view_mut((0, links), (links, free)).copy_from(&coupled);
        matrix.view_mut((links, 0), (free, links)).copy_from(&-coupled.transpose());
        matrix.view_mut((links, links), (free, free)).copy_from(&-damping);
        let scale = matrix.amax();
        if scale == 0.0 || !scale.is_finite() {
            return Vec::new();
        }
        let schur = Schur::try_new(matrix / scale, f64::EPSILON, MOST_TURNS);
        schur.map_or_else(Vec::new, |schur| schur.complex_eigenvalues().iter().map(|value| value * scale).collect())
    }

    fn matrices(&self, held: bool) -> Matrices {
        let (bodies, links, first) = (self.bodies(), self.links(), usize::from(held));
        let n = bodies.len() - first;
        let own = |i: usize| &bodies[i + first];
        let roots = DVector::from_fn(n, |i, _| own(i).inertia.sqrt() / own(i).transmission);
        let stretches = DMatrix::from_fn(links.len(), n, |link, i| match (i + first).checked_sub(link) {
            Some(0) => 1.0 / roots[i],
            Some(1) => -1.0 / roots[i],
            _ => 0.0,
        });
        let of_links = |value: fn(&crate::chain::Link) -> f64| {
            let values = DVector::from_iterator(links.len(), links.iter().map(value));
            stretches.transpose() * DMatrix::from_diagonal(&values) * &stretches
        };
        let to_ground = DVector::from_fn(n, |i, _| own(i).friction.linear() / own(i).inertia);
        Matrices {
            stiffness: of_links(|link| link.stiffness),
            damping: of_links(|link| link.damping) + DMatrix::from_diagonal(&to_ground),
            springs: DVector::from_iterator(links.len(), links.iter().map(|link| link.stiffness)),
            stretches,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::chain::{Body, Link};
    use crate::friction::Friction;
    use servobench_base::Coordinate;
    use std::f64::consts::TAU;

    fn body(inertia: f64, transmission: f64, viscous: f64) -> Body {
        let (coordinate, friction) = (Coordinate::Linear, Friction { viscous, ..Friction::NONE });
        Body { name: "body", coordinate, inertia, transmission, friction, bias: 0.0 }
    }

    fn hertz(modes: &[Mode]) -> Vec<f64> {
        modes.iter().map(|mode| mode.omega / TAU).collect()
    }

    /// Oracle: ω = √(K/J_L) held and √(K·(1/J_M + 1/J_L)) free; published 59.55 Hz and 84.22 Hz (Saarakkala, Hinkkanen),
    /// 38.985 Hz and 47.746 Hz (Lambrechts).
    #[test]
    fn two_masses_ring_at_the_published_frequencies() {
        for (inertias, stiffness, held, free) in
            [([0.005, 0.005], 700.0, 59.55, 84.22), ([20.0, 10.0], 6e5, 38.985, 47.746)]
        {
            let bodies = inertias.map(|inertia| body(inertia, 1.0, 0.0)).to_vec();
            let chain = Chain::new(bodies, vec![Link { stiffness, damping: 0.0 }]).unwrap();
            let [found_held, found_free] = [true, false].map(|is_held| chain.modes(is_held));
            // Half a unit of the last published digit.
            assert!((hertz(&found_held)[0] - held).abs() < 0.005 && found_held.len() == 1, "{found_held:?}");
            assert!((hertz(&found_free)[0] - free).abs() < 0.005 && found_free.len() == 1, "{found_free:?}");
            assert!(found_held[0].damping < 1e-14 && found_free[0].damping < 1e-14, "{found_free:?}");
        }
    }

    /// Oracle: s² + (d/m + b/m)·s + k/m = 0 for a load behind a held motor, also through a screw.
    #[test]
    fn damping_is_that_of_the_characteristic_polynomial() {
        let (mass, stiffness, damping, viscous) = (17.0, 3e5, 410.0, 23.0);
        let bodies = vec![body(3e-4, 0.013 / TAU, 1e-3), body(mass, 1.0, viscous)];
        let chain = Chain::new(bodies, vec![Link { stiffness, damping }]).unwrap();
        let [mode] = chain.modes(true)[..] else { panic!("one mode") };
        let omega = (stiffness / mass).sqrt();
        assert!((mode.omega / omega - 1.0).abs() < 1e-13, "{mode:?}");
        assert!((mode.damping / ((damping + viscous) / (2.0 * mass * omega)) - 1.0).abs() < 1e-12, "{mode:?}");
    }

    /// Oracle: the trace of the state matrix is the sum of its eigenvalues, −Σ of D/M; and ω² > 0 only between bodies.
    #[test]
    fn three_bodies_have_two_modes_and_lose_what_the_dampers_take() {
        let bodies = vec![body(2e-3, 0.01, 1e-2), body(40.0, 1.0, 90.0), body(11.0, 1.0, 5.0)];
        let links = vec![Link { stiffness: 9e6, damping: 2e3 }, Link { stiffness: 4e5, damping: 300.0 }];
        let chain = Chain::new(bodies, links).unwrap();
        assert_eq!((chain.modes(false).len(), chain.modes(true).len()), (2, 2));
        let trace: f64 = chain.eigenvalues(false).iter().map(|value| value.re).sum();
        let motor = 2e-3 / 1e-4;
        let lost = (1e-2 / 1e-4 + 2e3) / motor + (90.0 + 2e3 + 300.0) / 40.0 + (5.0 + 300.0) / 11.0;
        assert!((trace / -lost - 1.0).abs() < 1e-11, "{trace} {lost}");
    }

    /// Oracles: at rest, load and motor have the same position; at any position the coupling to the body before it accelerates it,
    /// Σ weight·ω² = 0 where that is not the motor; one load has the coefficients of its equation of motion.
    #[test]
    fn a_load_follows_the_motor_in_its_modes() {
        let bodies = vec![body(2e-3, 0.01, 0.0), body(40.0, 1.0, 90.0), body(11.0, 1.0, 5.0)];
        let links = vec![Link { stiffness: 9e6, damping: 2e3 }, Link { stiffness: 4e5, damping: 300.0 }];
        let modes = Chain::new(bodies, links).unwrap().held_modes();
        let sum = |of: fn(&HeldMode) -> f64| modes.iter().map(of).sum::<f64>();
        assert!((sum(|mode| mode.weight) - 1.0).abs() < 1e-12, "{modes:?}");
        let largest = modes.iter().map(|mode| mode.omega.powi(2)).fold(0.0, f64::max);
        assert!(sum(|mode| mode.weight * mode.omega.powi(2)).abs() < 1e-12 * largest, "{modes:?}");
        let one =
            Chain::new(vec![body(1.0, 1.0, 0.0), body(17.0, 1.0, 23.0)], vec![Link { stiffness: 3e5, damping: 410.0 }]);
        let [mode] = one.unwrap().held_modes()[..] else { panic!("one mode") };
        assert!((mode.weight - 1.0).abs() < 1e-14 && (mode.omega.powi(2) * 17.0 / 3e5 - 1.0).abs() < 1e-14, "{mode:?}");
        assert!((mode.decay - 433.0 / 17.0).abs() < 1e-12 && (mode.lead - 410.0 / 3e5).abs() < 1e-15, "{mode:?}");
    }

    #[test]
    fn a_rigid_axis_has_no_mode_and_an_overdamped_one_does_not_ring() {
        let rigid = Chain::new(vec![body(3.0, 1.0, 7.0)], Vec::new()).unwrap();
        assert!(rigid.modes(false).is_empty() && rigid.modes(true).is_empty());
        let slow =
            Chain::new(vec![body(1.0, 1.0, 0.0), body(1.0, 1.0, 0.0)], vec![Link { stiffness: 100.0, damping: 30.0 }]);
        // ζ = d/(2·√(k·m)) of the load behind the held motor: 30/20.
        let [mode] = slow.unwrap().modes(true)[..] else { panic!("one mode") };
        assert!((mode.damping - 1.5).abs() < 1e-12, "{mode:?}");
    }
}
