//! The way of a drive that is told targets, in profile position: its own profile to each, whatever profile the program has: a trapezoid of
//! velocity, or one of acceleration where its ramps are jerk-limited (6086h = 3, 60A4h).
use crate::error::BuildError;
use crate::program::Program;
use servobench_base::{Request, Setpoint};
use servobench_drive::device;
use servobench_drive::modes::profile::Ramp;
use servobench_motion::{Limits, Order, Profile};
use servobench_trace::Move;

/// A time so little after a cycle, as a share of it, is in that cycle.
const ROUNDING: f64 = 1e-6;

/// Targets with their times.
#[derive(Debug, Clone)]
pub(super) struct Targets {
    ways: Vec<Way>,
}

/// The way to a target.
#[derive(Debug, Clone, PartialEq)]
struct Way {
    /// When the program begins it, and when the drive does (s); from where.
    planned: f64,
    start: f64,
    from: f64,
    label: String,
    profile: Profile,
    /// Highest velocity, acceleration and jerk of it, `None` where there is no bound.
    limits: [Option<f64>; 3],
}

impl Targets {
    /// Those of `program`, each of which is told in the first cycle that comes to it; cycles are `period` (s) apart.
    ///
    /// # Errors
    /// [`BuildError::Plan`] of a way that `drive` cannot plan.
    pub(super) fn of(program: &Program, drive: &device::Params, period: f64) -> Result<Self, BuildError> {
        let told = |start: f64| (start / period - ROUNDING).ceil() * period;
        let (order, name, jerk) = match drive.profile.ramp {
            Ramp::Linear => (Order::Second, "2", f64::INFINITY),
            Ramp::JerkLimited(jerk) => (Order::Third, "3", jerk),
        };
        let way = |(index, (planned, from, plan)): (usize, (f64, f64, &servobench_planner::Plan))| {
            let [velocity, acceleration, ..] = plan.limits().map(|sides| sides.above);
            let velocity = velocity.min(drive.limits.profile_velocity);
            let limits = Limits { velocity, acceleration, jerk, snap: f64::INFINITY };
            let profile =
                Profile::plan(order, plan.end().x, &limits).map_err(|error| BuildError::Plan { index, error })?;
            let limits = [velocity, acceleration, jerk].map(|limit| limit.is_finite().then_some(limit));
            let label = program.label([from, from + plan.end().x], name);
            Ok::<_, BuildError>(Way { planned, start: told(planned), from, label, profile, limits })
        };
        Ok(Self { ways: program.plans().enumerate().map(way).collect::<Result<_, _>>()? })
    }

    /// The request `passed` seconds after the beginning of the program.
    pub(super) fn at(&self, passed: f64) -> Request {
        let begun = self.ways.partition_point(|way| way.start <= passed);
        begun.checked_sub(1).map_or(Request::Stand, |last| self.ways[last].at(passed))
    }

    /// The moves of the program as the drive makes them.
    pub(super) fn made(&self, moves: impl Iterator<Item = Move>) -> impl Iterator<Item = Move> {
        moves.zip(&self.ways).map(|(made, way)| {
            let Way { planned, start, label, profile, limits: [velocity, acceleration, jerk], .. } = way;
            let (made, duration) = (made.later(start - planned), profile.duration());
            let peaks = profile.peaks();
            Move {
                label: label.clone(),
                end: made.start + duration,
                cruise: (made.start + 0.5 * (duration - profile.cruise()), profile.cruise()),
                peaks: [peaks.velocity, peaks.acceleration, peaks.jerk, peaks.snap],
                limits: [*velocity, *acceleration, *jerk, None],
                ..made
            }
        })
    }
}

impl Way {
    fn at(&self, passed: f64) -> Request {
        let since = passed - self.start;
        if since >= self.profile.duration() {
            return Request::Rest(self.from + self.profile.distance());
        }
        let setpoint = self.profile.at(since);
        Request::Follow(Setpoint { x: self.from + setpoint.x, ..setpoint })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Oracle: 1 m at 0.5 m/s and 1 m/s²: half a second of ramp, 1.5 s at full velocity; and 0.16 m, which is a triangle of 0.8 s.
    #[test]
    fn a_way_is_a_trapezoid_or_a_triangle() {
        let limits = Limits { velocity: 0.5, acceleration: 1.0, jerk: f64::INFINITY, snap: f64::INFINITY };
        let way = |distance: f64| {
            let profile = Profile::plan(Order::Second, distance, &limits).unwrap();
            Targets {
                ways: vec![Way {
                    planned: 0.9,
                    start: 1.0,
                    from: 0.2,
                    label: String::new(),
                    profile,
                    limits: [None; 3],
                }],
            }
        };
        let x = |targets: &Targets, t: f64| match targets.at(t) {
            Request::Follow(setpoint) => (setpoint.x, setpoint.v),
            Request::Rest(x) => (x, 0.0),
            _ => (f64::NAN, f64::NAN),
        };
        assert_eq!(way(1.0).at(0.9), Request::Stand);
        for (distance, t, at, v) in [
            (1.0, 1.2, 0.02, 0.2),
            (1.0, 2.0, 0.375, 0.5),
            (1.0, 3.3, 0.98, 0.2),
            (1.0, 3.5, 1.0, 0.0),
            (-1.0, 2.0, -0.375, -0.5),
            (0.16, 1.4, 0.08, 0.4),
            (0.16, 1.8, 0.16, 0.0),
            (0.0, 1.0, 0.0, 0.0),
        ] {
            let (found, speed) = x(&way(distance), t);
            assert!((found - 0.2 - at).abs() < 1e-12 && (speed - v).abs() < 1e-12, "{distance} {t}: {found} {speed}");
        }
    }
}
