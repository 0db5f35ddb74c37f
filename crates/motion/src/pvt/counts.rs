//! From the units of the drive to SI and back.
use super::{Knot, Point, checked};
use crate::PlanError;
use crate::limits::in_range;
use servobench_base::positive;

/// Unit of a drive's velocity (counts/s).
const VELOCITY_UNIT: f64 = 0.1;

fn unit_in_range(unit: f64) -> Result<f64, PlanError> {
    in_range("unit", positive("unit", unit)?, "give the length or angle of one count in m or rad")
}

/// `points` as absolute knots in `knots`, of which as many as there are points are given back; the first point is at
/// t = 0.
///
/// `origin` is the position (counts) at which the move is started, `unit` the length or angle of a count (m or rad).
/// Times are added as whole milliseconds, so that the last of a million is as exact as the first.
///
/// # Errors
/// [`PlanError`] names the first point that ends the move before the last one, the last one if it does not, and a
/// point whose absolute position does not fit into the 32 bits of the drive's counter; fewer than two points and a
/// short slice are refused.
pub fn to_knots<'a>(
    points: &[Point],
    origin: i32,
    unit: f64,
    knots: &'a mut [Knot],
) -> Result<&'a mut [Knot], PlanError> {
    let unit = unit_in_range(unit)?;
    let (length, last) = (knots.len(), points.len().saturating_sub(1));
    if last == 0 {
        return Err(PlanError::TooFewPoints { points: points.len() });
    }
    let knots =
        knots.get_mut(..points.len()).ok_or(PlanError::ShortSlice { name: "knots", length, points: points.len() })?;
    let (mut position, mut time_ms) = (origin, 0_u64);
    for (i, (point, knot)) in points.iter().zip(knots.iter_mut()).enumerate() {
        let from = if point.relative { position } else { 0 };
        position = from.checked_add(point.position).ok_or(PlanError::Point {
            point: i,
            name: "position",
            value: f64::from(from) + f64::from(point.position),
            bound: "within the 32 bits of the drive's counter once it is made absolute",
            remedy: "shorten the relative way, or start the move nearer to zero",
        })?;
        *knot = Knot {
            t: time_ms as f64 / 1e3,
            x: f64::from(position) * unit,
            v: point.velocity.map(|velocity| f64::from(velocity) * VELOCITY_UNIT * unit),
        };
        let time = |bound, remedy| PlanError::Point {
            point: i,
            name: "time_ms",
            value: f64::from(point.time_ms),
            bound,
            remedy,
        };
        match (i == last, point.time_ms) {
            (false, 0) => {
                return Err(time("1 to 255 before the last point", "0 ends the move: drop the points behind it"));
            }
            (true, 1..) => {
                return Err(time("0 at the last point", "end the move there, or add the points that follow"));
            }
            (_, ms) => time_ms += u64::from(ms),
        }
    }
    Ok(knots)
}

/// `knots` as absolute points of the drive in `points`, of which as many as there are knots are given back.
///
/// `unit` is the length or angle of a count (m or rad). Positions and velocities are rounded to the nearest count and
/// 0.1 counts/s: half a count of error each, not accumulated.
///
/// # Errors
/// [`PlanError`] names the first point whose time to the next is not a whole number of milliseconds from 1 to 255 (to
/// 1 ns) or whose position or velocity does not fit into 32 bits; a table that [`Table::new`](super::Table::new)
/// refuses and a short slice are refused.
pub fn to_points<'a>(knots: &[Knot], unit: f64, points: &'a mut [Point]) -> Result<&'a mut [Point], PlanError> {
    let unit = unit_in_range(unit)?;
    checked(knots)?;
    let length = points.len();
    let points =
        points.get_mut(..knots.len()).ok_or(PlanError::ShortSlice { name: "points", length, points: knots.len() })?;
    for (i, (knot, point)) in knots.iter().zip(points.iter_mut()).enumerate() {
        *point = Point {
            position: whole(i, "position", knot.x / unit)?,
            velocity: knot.v.map(|v| whole(i, "velocity", v / unit / VELOCITY_UNIT)).transpose()?,
            time_ms: knots.get(i + 1).map_or(Ok(0), |next| milliseconds(i, (next.t - knot.t) * 1e3))?,
            relative: false,
        };
    }
    Ok(points)
}

/// `value` (counts or 0.1 counts/s) rounded to a value of 32 bits.
fn whole(point: usize, name: &'static str, value: f64) -> Result<i32, PlanError> {
    let rounded = libm::round(value);
    if (f64::from(i32::MIN)..=f64::from(i32::MAX)).contains(&rounded) {
        #[expect(clippy::cast_possible_truncation, reason = "a whole number within 32 bits")]
        return Ok(rounded as i32);
    }
    let (bound, remedy) = ("within 32 bits in the unit of the drive", "take a coarser unit, or correct it");
    Err(PlanError::Point { point, name, value, bound, remedy })
}

/// `time` (ms) as the whole number that it is.
fn milliseconds(point: usize, time: f64) -> Result<u8, PlanError> {
    let rounded = libm::round(time);
    if (1.0..=255.0).contains(&rounded) && (time - rounded).abs() <= 1e-6 {
        #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "a whole number from 1 to 255")]
        return Ok(rounded as u8);
    }
    let (bound, remedy) =
        ("a whole number from 1 to 255 ms", "divide a longer segment, or put the points on milliseconds");
    Err(PlanError::Point { point, name: "time_ms", value: time, bound, remedy })
}
