//! The way of a drive that is told targets, in profile position: a trapezoid of velocity to each, whatever profile the program has.
//!
//! ```text
//! v = min(6081h, √(a·d))      t_a = v/a      T = d/v + t_a      a = 6083h = 6084h
//! ```
use crate::program::Program;
use servobench_base::{Request, Setpoint};

/// A time so little after a cycle, as a share of it, is in that cycle.
const ROUNDING: f64 = 1e-6;

/// Targets with their times.
#[derive(Debug, Clone)]
pub(super) struct Targets {
    ways: Vec<Way>,
}

/// The way to a target.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Way {
    /// When it begins (s), from where and over which distance (m or rad).
    start: f64,
    from: f64,
    distance: f64,
    /// Its largest velocity, and its acceleration.
    velocity: f64,
    acceleration: f64,
}

impl Targets {
    /// Those of `program`, each of which is told in the first cycle that comes to it; cycles are `period` (s) apart.
    pub(super) fn of(program: &Program, period: f64) -> Self {
        let told = |start: f64| (start / period - ROUNDING).ceil() * period;
        let way = |(start, from, plan): (f64, f64, &servobench_planner::Plan)| {
            let [velocity, acceleration, ..] = plan.limits().map(|sides| sides.above);
            let distance = plan.end().x;
            let velocity = velocity.min((acceleration * distance.abs()).sqrt());
            Way { start: told(start), from, distance, velocity, acceleration }
        };
        Self { ways: program.plans().map(way).collect() }
    }

    /// The request `passed` seconds after the beginning of the program.
    pub(super) fn at(&self, passed: f64) -> Request {
        let begun = self.ways.partition_point(|way| way.start <= passed);
        begun.checked_sub(1).map_or(Request::Stand, |last| self.ways[last].at(passed))
    }
}

impl Way {
    fn at(&self, passed: f64) -> Request {
        let (size, a, since) = (self.distance.abs(), self.acceleration, passed - self.start);
        let ramp = self.velocity / a;
        let duration = size / self.velocity + ramp;
        // Without a distance the duration is not a number.
        if duration.is_nan() || since >= duration {
            return Request::Rest(self.from + self.distance);
        }
        let left = duration - since;
        let (x, v, a) = if since < ramp {
            (a * since * since / 2.0, a * since, a)
        } else if left < ramp {
            (size - a * left * left / 2.0, a * left, -a)
        } else {
            (self.velocity * (since - ramp / 2.0), self.velocity, 0.0)
        };
        let sign = self.distance.signum();
        Request::Follow(Setpoint { x: self.from + sign * x, v: sign * v, a: sign * a, ..Setpoint::default() })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Oracle: 1 m at 0.5 m/s and 1 m/s²: half a second of ramp, 1.5 s at full velocity; and 0.16 m, which is a triangle of 0.8 s.
    #[test]
    fn a_way_is_a_trapezoid_or_a_triangle() {
        let way = |distance: f64| {
            let velocity = 0.5_f64.min(distance.abs().sqrt());
            Targets { ways: vec![Way { start: 1.0, from: 0.2, distance, velocity, acceleration: 1.0 }] }
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
