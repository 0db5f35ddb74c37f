//! A request from rest to rest, checked.
use crate::limits::in_range;
use crate::{Limits, Order, PlanError};
use servobench_base::{finite, positive};

/// A checked request.
pub(crate) struct Request {
    /// Signed distance (m or rad), a positive zero or in range.
    pub(crate) distance: f64,
    /// Limits from the highest derivative down, then |distance|.
    pub(crate) bounds: [f64; 5],
}

impl Request {
    /// In SI units.
    ///
    /// # Errors
    /// As [`Profile::plan`](crate::Profile::plan).
    pub(crate) fn new(order: Order, distance: f64, limits: &Limits) -> Result<Self, PlanError> {
        let mut bounds = [f64::INFINITY; 5];
        bounds[..4].copy_from_slice(&limits.descending(order)?);
        // Adding zero makes −0 a positive zero.
        let mut distance = finite("distance", distance)? + 0.0;
        if distance != 0.0 {
            distance = in_range("distance", distance, "correct its unit, or request a distance of 0")?;
        }
        bounds[order.derivative()] = distance.abs();
        Ok(Self { distance, bounds })
    }

    /// In units of the sample time: the k-th derivative times Ts^k.
    ///
    /// # Errors
    /// As [`Profile::plan_sampled`](crate::Profile::plan_sampled).
    pub(crate) fn sampled(order: Order, distance: f64, limits: &Limits, sample_time: f64) -> Result<Self, PlanError> {
        let mut request = Self::new(order, distance, limits)?;
        let sample_time = in_range("sample_time", positive("sample_time", sample_time)?, "correct its unit")?;
        let mut scale = 1.0;
        for bound in request.bounds[..order.derivative()].iter_mut().rev() {
            scale *= sample_time;
            *bound *= scale;
        }
        Ok(request)
    }
}
