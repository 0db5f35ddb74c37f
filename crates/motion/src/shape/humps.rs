//! Extra-insensitive shapers with several humps, of damped modes.
//!
//! A shaper of n humps has n + 2 impulses. Over the frequency its residual has n + 1 zeros, and between each two of them a hump
//! with its top at exactly v. With ω = 1 and
//!
//! ```text
//! Q(w) = Σ A_i·e^(ζw·(t_i − t_n+2) + j√(1−ζ²)·w·t_i)                  the residual of the modes of frequency w is |Q(w)|
//!
//! Q(w) = 0 (complex)                 at each of the n + 1 zeros        for A_2 … A_n+2 (A_1 the rest of one), t_2 … t_n+2 (t_1 = 0),
//! |Q(w)| = v and d|Q|/dw = 0         at each of the n tops             and zeros and tops except the middle one of them, which is 1
//! ```
//!
//! are 4n + 2 equations for as many unknowns. With two humps the mode is at the zero between them, with three at the top of
//! the middle one.
//!
//! Undamped |Q(w)| = v·|T_n+1(Y·cos(πw/2))|, T the Chebyshev polynomial that is 1/v at Y: the array of Dolph (*A Current
//! Distribution for Broadside Arrays Which Optimizes the Relationship between Beam Width and Side-Lobe Level*, Proc. IRE 34
//! (1946)), half a period apart. From there the damping ratio is raised in steps, each solved by Newton's method.
use super::Impulse;
use super::newton::damped;
use core::f64::consts::PI;

/// The impulses in the time unit 1/ω, of a shaper with `IMPULSES − 2` humps and so `N = 4·IMPULSES − 6` unknowns; `None` if no
/// solution with positive amplitudes is found.
pub(super) fn solve<const IMPULSES: usize, const N: usize>(zeta: f64, tolerable: f64) -> Option<[Impulse; IMPULSES]> {
    const { assert!(IMPULSES >= 3 && N == 4 * IMPULSES - 6, "as many equations as unknowns") };
    let equations = |y: &[f64; N], zeta: f64| Unknowns::<IMPULSES>::of(y).equations(zeta, tolerable);
    let is_shaper = |y: &[f64; N], _| Unknowns::<IMPULSES>::of(y).are_a_shaper();
    let y = damped(zeta, undamped::<IMPULSES, N>(tolerable), equations, is_shaper)?;
    Some(Unknowns::of(&y).impulses)
}

/// The unknowns by name.
struct Unknowns<'a, const IMPULSES: usize> {
    impulses: [Impulse; IMPULSES],
    /// Zeros and tops in turn, without the middle one.
    points: &'a [f64],
}

impl<'a, const IMPULSES: usize> Unknowns<'a, IMPULSES> {
    /// First the amplitudes, then the times, then zeros and tops.
    fn of(y: &'a [f64]) -> Self {
        let (amplitudes, rest) = y.split_at(IMPULSES - 1);
        let (times, points) = rest.split_at(IMPULSES - 1);
        let mut impulses = [Impulse { time: 0.0, amplitude: 1.0 - amplitudes.iter().sum::<f64>() }; IMPULSES];
        for (impulse, (amplitude, time)) in impulses[1..].iter_mut().zip(amplitudes.iter().zip(times)) {
            *impulse = Impulse { time: *time, amplitude: *amplitude };
        }
        Self { impulses, points }
    }

    /// Zeros and tops in turn.
    fn all_points(&self) -> impl Iterator<Item = f64> {
        let (below, above) = self.points.split_at(self.points.len() / 2);
        below.iter().copied().chain([1.0]).chain(above.iter().copied())
    }

    fn are_a_shaper(&self) -> bool {
        let is_positive = self.impulses.iter().all(|impulse| impulse.amplitude > 0.0);
        let is_in_time = self.impulses.is_sorted_by(|one, next| one.time < next.time);
        let are_within = self.all_points().all(|w| 0.0 < w && w < 2.0);
        is_positive && is_in_time && are_within && self.all_points().is_sorted_by(|one, next| one < next)
    }

    fn equations<const N: usize>(&self, zeta: f64, tolerable: f64) -> [f64; N] {
        let mut equations = [0.0; N];
        for (k, (w, pair)) in self.all_points().zip(equations.chunks_exact_mut(2)).enumerate() {
            let [re, im, re_slope, im_slope] = self.residual(w, zeta);
            let root = libm::hypot(re, im);
            let is_zero = k % 2 == 0;
            pair.copy_from_slice(&if is_zero {
                [re, im]
            } else {
                [root - tolerable, (re * re_slope + im * im_slope) / root]
            });
        }
        equations
    }

    /// Q(w) and its derivative, real and imaginary parts.
    fn residual(&self, w: f64, zeta: f64) -> [f64; 4] {
        let ring = libm::sqrt((1.0 - zeta) * (1.0 + zeta));
        let last = self.impulses[IMPULSES - 1].time;
        self.impulses.iter().fold([0.0; 4], |[re, im, re_slope, im_slope], Impulse { time, amplitude }| {
            let (decay, turn) = (zeta * (time - last), ring * time);
            let magnitude = amplitude * libm::exp(decay * w);
            let (x, y) = (magnitude * libm::cos(turn * w), magnitude * libm::sin(turn * w));
            [re + x, im + y, re_slope + decay * x - turn * y, im_slope + decay * y + turn * x]
        })
    }
}

/// The closed form of the unknowns for an undamped mode.
fn undamped<const IMPULSES: usize, const N: usize>(tolerable: f64) -> [f64; N] {
    let degree = IMPULSES - 1;
    let y = libm::cosh(libm::acosh(1.0 / tolerable) / degree as f64);
    // Samples of the array's factor at IMPULSES frequencies, whose Fourier transform its amplitudes are.
    let factor = |k: usize| tolerable * chebyshev(degree, y * libm::cos(PI * k as f64 / IMPULSES as f64));
    let amplitude = |i: usize| {
        let place = i as f64 - 0.5 * degree as f64;
        let turn = |k: usize| 2.0 * PI * (k as f64) * place / IMPULSES as f64;
        (0..IMPULSES).map(|k| factor(k) * libm::cos(turn(k))).sum::<f64>() / IMPULSES as f64
    };
    let mut unknowns = [0.0; N];
    let (impulses, points) = unknowns.split_at_mut(2 * degree);
    let (amplitudes, times) = impulses.split_at_mut(degree);
    for (i, (a, t)) in amplitudes.iter_mut().zip(times).enumerate() {
        (*a, *t) = (amplitude(i + 1), PI * (i + 1) as f64);
    }
    let humps = degree - 1;
    for (i, point) in points.iter_mut().enumerate() {
        // Without the middle one.
        let place = if i < humps { i } else { i + 1 };
        *point = 2.0 / PI * libm::acos(libm::cos(0.5 * PI * (place + 1) as f64 / degree as f64) / y);
    }
    unknowns
}

/// The Chebyshev polynomial of the first kind.
fn chebyshev(degree: usize, x: f64) -> f64 {
    let (mut before, mut last) = (1.0, x);
    for _ in 1..degree {
        (before, last) = (last, 2.0 * x * last - before);
    }
    last
}
