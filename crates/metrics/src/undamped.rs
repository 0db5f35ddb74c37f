//! Closed form of the residual vibration after a rest-to-rest profile.
/// Amplitude (unit of `distance`) with which an undamped mode of angular frequency `omega` (rad/s) rings after its
/// base has followed a rest-to-rest profile exactly:
///
/// ```text
/// A = |X|·∏ |sin(ω·T_k/2)/(ω·T_k/2)|
/// ```
/// `boxes` are the lengths T_k (s) of the moving averages whose convolution is the velocity: x/v, v/a, a/j, j/s when every bound
/// is reached. The mode sees its base through `1 − s²/(s² + ω²)`, so what remains is the spectrum of the velocity at
/// ω; a convolution of moving averages has a product of sincs.
/// Source of the moving averages: Lambrechts, Boerlage, Steinbuch, *Trajectory planning and feedforward design for
/// electromechanical motion systems*, Control Engineering Practice 13, 2005.
#[must_use]
pub fn undamped_residual(distance: f64, omega: f64, boxes: &[f64]) -> f64 {
    boxes.iter().fold(distance.abs(), |amplitude, &length| {
        let half = omega * length / 2.0;
        // Close to zero sin(x)/x is 1 − x²/6, below the last digit here.
        if half.abs() < 1e-8 { amplitude } else { amplitude * (libm::sin(half) / half).abs() }
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The 1 m move of Lambrechts (2004) at √(c/m₂) = √(6e5/10) rad/s, 38.985 Hz: 0.2419 µm jerk-limited and 0.0063 µm
    /// snap-limited, computed independently and rounded to the last digit given.
    #[test]
    fn lambrechts_move() {
        let omega = 6e4_f64.sqrt();
        let jerk = undamped_residual(1.0, omega, &[1.0, 0.2, 0.1]);
        let snap = undamped_residual(-1.0, omega, &[1.0, 0.2, 0.1, 0.05]);
        assert!((jerk - 0.2419e-6).abs() < 0.5e-10, "{jerk}");
        assert!((snap - 0.0063e-6).abs() < 0.5e-10, "{snap}");
    }

    #[test]
    fn a_step_leaves_its_own_height() {
        assert!((undamped_residual(2e-6, 100.0, &[]) - 2e-6).abs() < 1e-21);
        assert!((undamped_residual(2e-6, 100.0, &[0.0]) - 2e-6).abs() < 1e-21);
    }
}
