//! Cyclic synchronous position (csp).
//!
//! A target is the sum of target position (607Ah) and position offset (60B0h). The position between two targets follows
//! [`interpolate`](servobench_motion::interpolate), in one of three modes:
//!
//! | interpolation | from | target reached after |
//! |---|---|---|
//! | linear | the targets | a cycle |
//! | cubic | the targets, and the velocity offsets (60B1h) as their velocities | a cycle |
//! | cubic B-spline | the targets as control points | two cycles; passed at a distance, in a curve |
//!
//! The highest velocity limits the targets: an excess is cut, and the drive reports it (bit 11). A cubic that would exceed it between two
//! targets is replaced by the line. A B-spline needs no such check: its velocity is a mean of the slopes between its control points, with
//! nonnegative weights. It could not be replaced either, as the line from the last target is a cycle ahead of it. Rounding of a velocity
//! exactly at the limit does not count as an excess.
use super::{Linear, Progress};
use crate::Demand;
use crate::device::CycleEvent;
use crate::modes::reach::Reach;
use crate::modes::{Answer, Moment};
use servobench_base::{ParamError, Setpoint, Stateful, limit};
use servobench_motion::interpolate::{Interval, Mode, Sample};

/// Interpolation of the drive.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Params {
    /// Linear, cubic or cubic B-spline.
    pub interpolation: Mode,
    /// Steps of the drive per cycle.
    pub steps: u32,
    /// Highest velocity (6080h), a magnitude; may be infinite.
    pub velocity: f64,
}

impl Params {
    /// # Errors
    /// [`ParamError`] names the first parameter out of its bound.
    pub fn check(&self) -> Result<(), ParamError> {
        if !matches!(self.interpolation, Mode::Linear | Mode::Cubic | Mode::CubicBSpline) {
            let value = Mode::ALL.iter().position(|mode| *mode == self.interpolation).map_or(0.0, |i| i as f64 + 1.0);
            return Err(ParamError {
                name: "interpolation",
                value,
                bound: "1 (linear), 2 (cubic) or 4 (cubic B-spline)",
            });
        }
        limit("max_motor_speed", self.velocity).map(|_| ())
    }
}

/// State from tick to tick.
#[derive(Debug, Clone, Copy, PartialEq, Stateful)]
pub struct State {
    /// Last targets, the newest last: as many as the interpolation needs.
    points: [Sample; 4],
    has_begun: bool,
    /// Set-point at the beginning of the cycle; its derivatives hold for the whole cycle.
    start: Setpoint,
    progress: Progress,
    velocity_offset: Linear,
    effort_offset: Linear,
    is_limited: bool,
}

impl State {
    /// Continues the present motion until the first target. The offsets begin with those of the previous frame: a velocity offset sent for
    /// an axis that moves when it is enabled applies at once, not a cycle later.
    #[must_use]
    pub const fn begin(p: &Params, now: &Moment) -> Self {
        let start = Setpoint { x: now.demanded.x, v: now.demanded.v, ..Setpoint::at_rest(0.0) };
        Self {
            points: [Sample { x: 0.0, v: 0.0, a: 0.0, torque: 0.0 }; 4],
            has_begun: false,
            start,
            progress: Progress { steps: 0 },
            velocity_offset: Linear::resting(now.targets.velocity_offset.clamp(-p.velocity, p.velocity)),
            effort_offset: Linear::resting(now.targets.effort_offset),
            is_limited: false,
        }
    }

    /// True if the last target exceeded the highest velocity.
    #[must_use]
    pub const fn is_limited(&self) -> bool {
        self.is_limited
    }

    /// Heads for `target` in the next cycle.
    fn go_to(&mut self, p: &Params, cycle: f64, target: Sample) {
        let [_, b, c, d] = self.points;
        let way = target.x - d.x;
        let reach = Reach::new(p.velocity, cycle, target.x.abs() + d.x.abs());
        let cut = reach.cut(way);
        let x = cut.map_or(target.x, |way| d.x + way);
        self.points = [b, c, d, Sample { x, v: reach.velocity(target.v), ..target }];
        let is_slow_enough = |curve: &Setpoint| p.interpolation != Mode::Cubic || !reach.is_passed_by(curve);
        let curve = self.along(p.interpolation, cycle).filter(is_slow_enough);
        self.is_limited = cut.is_some() || reach.is_exceeded_by(target.v) || curve.is_none();
        let curve = curve.or_else(|| self.along(Mode::Linear, cycle));
        // Targets are finite: they are whole numbers of drive units.
        self.start = curve.unwrap_or(Setpoint::at_rest(d.x));
        self.progress = Progress::default();
    }

    /// Set-point at the beginning of the path between the targets.
    fn along(&self, mode: Mode, cycle: f64) -> Option<Setpoint> {
        if mode == Mode::Linear {
            // Same result as below in a tenth of the time.
            let [.., from, to] = self.points;
            return Some(Setpoint { v: (to.x - from.x) / cycle, ..Setpoint::at_rest(from.x) });
        }
        let interval = Interval::new(mode, cycle, &self.points).ok()?;
        interval.at(0.0).ok().map(|command| command.setpoint)
    }

    /// Sets the targets before the first one so that every interpolation begins at the position and velocity of the axis.
    fn lay(&mut self, cycle: f64, now: Setpoint, mode: Mode) {
        let sample = |cycles: f64| Sample { x: now.x + cycles * cycle * now.v, v: now.v, ..Sample::default() };
        self.points = match mode {
            Mode::CubicBSpline => [-2.0, -1.0, 0.0, 1.0],
            _ => [-3.0, -2.0, -1.0, 0.0],
        }
        .map(sample);
        self.has_begun = true;
    }
}

/// Demand of a step.
#[inline]
pub fn step(p: &Params, x: &mut State, now: &Moment, event: CycleEvent) -> Answer {
    let cycle = f64::from(p.steps) * now.period;
    let broken_off = x.progress.broken_off(event, p.steps);
    if event == CycleEvent::Late || event != CycleEvent::Between && !x.has_begun {
        x.lay(cycle, now.demanded, p.interpolation);
    }
    match event {
        CycleEvent::Between => {}
        CycleEvent::Sample | CycleEvent::Late => {
            let targets = &now.targets;
            x.go_to(p, cycle, Sample { x: targets.position, v: targets.velocity_offset, ..Sample::default() });
            x.velocity_offset.go_to(targets.velocity_offset.clamp(-p.velocity, p.velocity), broken_off);
            x.effort_offset.go_to(targets.effort_offset, broken_off);
        }
        CycleEvent::Missed => {
            let [.., before, last] = x.points;
            x.go_to(p, cycle, Sample { x: last.x + (last.x - before.x), ..last });
            x.velocity_offset.go_to(x.velocity_offset.to, None);
            x.effort_offset.go_to(x.effort_offset.to, None);
        }
    }
    let passed = x.progress.next(p.steps);
    let demand = Demand::Position {
        setpoint: x.start.after(passed * cycle),
        velocity_offset: x.velocity_offset.at(passed),
        effort_offset: x.effort_offset.at(passed),
    };
    Answer { demand, target_reached: false, bit_12: true, bit_13: false }
}
