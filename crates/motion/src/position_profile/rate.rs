//! Rate of the commands.
use super::Spline;
use crate::PlanError;
use crate::limits::in_range;
use servobench_base::positive;

/// √3/216: the largest |B3(θ)|/6.
const KERNEL: f64 = 1.732_050_807_568_877_2 / 216.0;

impl Spline<'_> {
    /// The lowest whole number of commands per second (1/s) at which the drive stays within `allowed` (m or rad) of
    /// the spline, by [`Stepped::largest_error`](super::Stepped::largest_error); at one command per
    /// second less it would not.
    ///
    /// The error depends on the positions of the points between the commands, and may therefore be small by chance at a
    /// still lower rate. The search begins at the rate at which it is small for all positions,
    ///
    /// ```text
    /// |E| ≤ h²/12·max|a − a(t_0)| + h³·(√3/216·Σ|Δj| + max|j|/12),
    /// ```
    ///
    /// and bisects downwards from there.
    ///
    /// # Errors
    /// [`PlanError`] if `allowed` is not positive, or so small that it needs more commands per second than 2^32, or than the resolution
    /// of the table's times permits.
    pub fn lowest_rate(self, allowed: f64) -> Result<u32, PlanError> {
        let allowed = in_range("allowed", positive("allowed", allowed)?, "give the error in m or rad")?;
        let (square, cube) = self.error_bound();
        // Half of the allowed error for either term.
        let sure = libm::sqrt(square * 2.0 / allowed).max(libm::cbrt(cube * 2.0 / allowed));
        let highest = f64::from(u32::MAX).min(libm::floor(self.highest_rate()));
        let sure = if sure <= highest {
            sure
        } else if highest >= 1.0 && self.stepped(highest)?.largest_error() <= allowed {
            highest
        } else {
            // No lower error can be guaranteed.
            let lowest = square / (highest * highest) + cube / (highest * highest * highest);
            let remedy = if highest < f64::from(u32::MAX) {
                "allow a larger error, or let the table begin at time 0"
            } else {
                "allow a larger error, or give the move more time"
            };
            return Err(PlanError::OutOfRange {
                name: "allowed",
                value: allowed,
                lowest,
                highest: f64::INFINITY,
                remedy,
            });
        };
        #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "a whole number within 32 bits")]
        let (mut enough, mut too_few) = ((libm::ceil(sure) as u32).max(1), 0);
        while enough - too_few > 1 {
            let middle = too_few + (enough - too_few) / 2;
            if self.stepped(f64::from(middle))?.largest_error() <= allowed {
                enough = middle;
            } else {
                too_few = middle;
            }
        }
        Ok(enough)
    }

    /// Coefficients of h² and h³ in the bound for all positions of the points between the commands.
    fn error_bound(self) -> (f64, f64) {
        let (table, last) = (self.table(), self.table().knots().len() - 1);
        let first = table.segment(0);
        let (mut swing, mut jump, mut jerk, mut before) = (0.0_f64, 0.0, 0.0_f64, first.j);
        for i in 0..last {
            let (state, length) = (table.segment(i), table.knots()[i + 1].t - table.knots()[i].t);
            swing = swing.max((state.a - first.a).abs()).max((state.a + state.j * length - first.a).abs());
            jump += (state.j - before).abs();
            jerk = jerk.max(state.j.abs());
            before = state.j;
        }
        (swing / 12.0, KERNEL * jump + jerk / 12.0)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::pvt::Knot;
    use servobench_base::Setpoint;

    /// The table with the worst jumps of jerk: one command per second meets every rise of the jerk where B3 is
    /// largest, θ = 1/2 − √3/6, and every fall where it is smallest, 1/2 + √3/6, so that all of them add up. The
    /// acceleration returns to the same two values, and the path itself is the spline through its points.
    #[test]
    fn the_bound_holds_and_is_reached_within_a_tenth() {
        let theta = 0.5 - 3.0_f64.sqrt() / 6.0;
        let (high, low) = (2.0 - 2.0 * theta, 1.0 + 2.0 * theta);
        let mut state = Setpoint { v: 1.0, ..Setpoint::default() };
        let (mut t, mut knots) = (0.0, vec![Knot::new(0.0, 0.0)]);
        for i in 0..400 {
            let (jerk, length) = match i {
                0 => (-high / low, 1.0 + theta),
                i if i % 2 == 1 => (1.0, high),
                _ => (-high / low, low),
            };
            state = Setpoint { j: jerk, ..state }.after(length);
            t += length;
            knots.push(Knot::new(t, state.x));
        }
        let spline = Spline::solve(&mut knots, 1.0, state.v, &mut [0.0; 401]).unwrap();
        let (square, cube) = spline.error_bound();
        let ratio = spline.stepped(1.0).unwrap().largest_error() / (square + cube);
        assert!((0.9..1.0).contains(&ratio), "{ratio} of the bound");
    }
}
