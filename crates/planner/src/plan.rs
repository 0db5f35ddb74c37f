//! A planned move.
use crate::analysis::{self, Binding, Peak, Span};
use crate::cascade::Sampled;
use crate::filter::Solved;
use crate::rest::Rest;
use crate::slowed::Slowed;
use servobench_base::{Setpoint, positive};
use servobench_motion::online::Sides;
use servobench_motion::position_profile::Command;
use servobench_motion::sampled::{Execution, Shortest};
use servobench_motion::shape::Impulse;
use servobench_motion::{Course, Order, Peaks, PlanError, Profile};
use std::fmt;
use std::sync::Arc;

/// A move as a set-point over time, in the axis unit (m or rad) and seconds from its start.
#[derive(Clone)]
pub struct Plan {
    course: Arc<dyn Course + Send + Sync>,
    /// Scaled and delayed parts of the trajectory: one of amplitude 1 without delay unless the plan is shaped.
    parts: Vec<Impulse>,
    /// Limits of velocity, acceleration, jerk, snap; infinite without a limit.
    limits: [Sides; 4],
    details: PlanDetails,
    /// Duration of the published profile (s), if the plan is another.
    published: Option<f64>,
    /// Length of its filter (s).
    filter: f64,
    /// Computation of set-points from a sampled profile.
    execution: Execution,
    /// Sample time (s), if each set-point is held until the next one instead of following its derivatives.
    held: Option<f64>,
}

/// Details of a plan that depend on its generator.
#[derive(Debug, Clone, PartialEq)]
pub enum PlanDetails {
    /// A profile from rest to rest.
    Profile(Box<Profile>),
    /// A sampled move with the fewest samples, of any shape.
    Shortest(Box<Shortest>),
    /// A trajectory from a state of motion.
    Transition {
        /// Its order.
        order: Order,
        /// Amount by which it exceeds the limits, relative to them.
        excess: f64,
    },
    /// A move by Rockwell's operands.
    Rockwell {
        /// Jerk of the acceleration (m/s³ or rad/s³).
        acceleration: f64,
        /// Jerk of the deceleration (m/s³ or rad/s³).
        deceleration: f64,
    },
    /// A move along the segments of a table.
    Table {
        /// The highest derivative without impulses: 1 where velocity jumps, 2 where acceleration does.
        order: usize,
    },
    /// A table followed by profile velocities.
    Commands {
        /// The commands.
        commands: Vec<Command>,
        /// Largest difference of position (m or rad): with plateaus from the points at their times, otherwise from the spline at any time.
        error: f64,
        /// Times of the commands.
        sending: Sending,
    },
}

/// Times at which velocity commands are sent.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Sending {
    /// At the beginning of the ramp from one plateau to the next.
    Plateaus {
        /// Share of a segment at either end in which velocity changes.
        share: f64,
    },
    /// This many times per second.
    Rate(f64),
}

/// Longest duration (s) to which a move can be stretched: its fourth power is still a normal number.
const LONGEST: f64 = 1e60;

impl Plan {
    pub(crate) fn of(course: impl Course + Send + Sync + 'static, details: PlanDetails) -> Self {
        let parts = vec![Impulse { time: 0.0, amplitude: 1.0 }];
        Self {
            course: Arc::new(course),
            parts,
            limits: [Sides::both(f64::INFINITY); 4],
            details,
            published: None,
            filter: 0.0,
            execution: Execution::ExactHold,
            held: None,
        }
    }

    /// The plan along `profile`.
    pub(crate) fn along(profile: &Profile, execution: Execution) -> Result<Self, PlanError> {
        let details = PlanDetails::Profile(Box::new(*profile));
        match (execution, profile.samples()) {
            (Execution::ForwardEuler, Some(samples)) => {
                let sampled = Sampled {
                    order: profile.order(),
                    distance: profile.distance(),
                    sample_time: samples.time,
                    samples: samples.total(),
                    duration: profile.duration(),
                };
                let plan = Self::of(sampled.cascade(profile.runs())?, details);
                Ok(Self { execution, held: Some(samples.time), ..plan })
            }
            _ => Ok(Self::of(*profile, details)),
        }
    }

    /// The plan along `shortest`.
    pub(crate) fn along_shortest(shortest: Shortest, execution: Execution) -> Result<Self, PlanError> {
        let sample_time = shortest.sample_time();
        let details = PlanDetails::Shortest(Box::new(shortest.clone()));
        match execution {
            Execution::ExactHold => Ok(Self::of(shortest, details)),
            Execution::ForwardEuler => {
                let sampled = Sampled {
                    order: shortest.order(),
                    distance: shortest.distance(),
                    sample_time,
                    samples: shortest.samples(),
                    duration: shortest.duration(),
                };
                Ok(Self { execution, held: Some(sample_time), ..Self::of(sampled.cascade(shortest.runs())?, details) })
            }
        }
    }

    pub(crate) fn within(self, limits: [Sides; 4]) -> Self {
        Self { limits, ..self }
    }

    pub(crate) fn instead_of(self, published: Option<f64>) -> Self {
        Self { published, ..self }
    }

    /// The same trajectory in `duration` seconds including the length of its filter; every derivative is reduced in proportion.
    pub(crate) fn stretched_to(mut self, duration: f64, filter: f64) -> Result<Self, PlanError> {
        let shortest = self.course.duration() + filter;
        let inner = positive("duration", duration)? - filter;
        if inner < self.course.duration() * (1.0 - 1e-12) {
            return Err(PlanError::TooShort { duration, shortest });
        }
        // The published profile would also be slowed.
        self.published = None;
        if matches!(self.details, PlanDetails::Shortest(_)) {
            // The duration is its own, see `Request::slowed`.
            return Ok(self);
        }
        if let PlanDetails::Profile(profile) = &self.details {
            return Ok(Self::along(&profile.stretched_to(inner)?, self.execution)?.within(self.limits));
        }
        if self.course.duration() > 0.0 {
            if duration > LONGEST {
                let (lowest, remedy) = (shortest, "correct its unit");
                return Err(PlanError::OutOfRange {
                    name: "duration",
                    value: duration,
                    lowest,
                    highest: LONGEST,
                    remedy,
                });
            }
            let factor = (inner / self.course.duration()).max(1.0);
            self.course = Arc::new(Slowed { course: self.course, factor });
            self.details.slow(factor);
        }
        Ok(self)
    }

    /// The remainder of an unfiltered plan from `start` (s) on, as a plan whose times and positions count from there.
    #[must_use]
    pub fn rest(&self, start: f64) -> Self {
        Self { course: Arc::new(Rest::of(Arc::clone(&self.course), start)), ..self.clone() }
    }

    /// The same move after `filter`.
    pub(crate) fn filtered(mut self, filter: &Solved<'_>) -> Result<Self, PlanError> {
        if let Some(impulses) = &filter.impulses {
            self.parts = impulses.iter().collect();
        }
        if let Some(averages) = filter.averages {
            self.course = Arc::new(averages.of(&self)?);
            self.held = Some(averages.sample_time);
            self.parts = vec![Impulse { time: 0.0, amplitude: 1.0 }];
        }
        self.filter = filter.length();
        Ok(self)
    }

    /// Duration (s).
    #[must_use]
    pub fn duration(&self) -> f64 {
        self.course.duration() + self.parts.last().map_or(0.0, |last| last.time)
    }

    /// Share of the duration that is due to its filter (s).
    #[must_use]
    pub const fn filter_length(&self) -> f64 {
        self.filter
    }

    /// Sample time (s) of a plan whose set-points are held until the next one.
    #[must_use]
    pub const fn held(&self) -> Option<f64> {
        self.held
    }

    /// The set-point at `t` (s); before the start that of the start, after the end that of the end, continued at its velocity.
    ///
    /// For many times in ascending order: [`Reader`](crate::Reader).
    #[must_use]
    pub fn at(&self, t: f64) -> Setpoint {
        self.reader_at(t).at(t)
    }

    /// Set-point at the start.
    #[must_use]
    pub fn start(&self) -> Setpoint {
        self.at(0.0)
    }

    /// Set-point at the end.
    #[must_use]
    pub fn end(&self) -> Setpoint {
        self.at(self.duration())
    }

    /// Limits of velocity, acceleration, jerk and snap of the planning; infinite without a limit.
    #[must_use]
    pub const fn limits(&self) -> &[Sides; 4] {
        &self.limits
    }

    /// Details that depend on its generator.
    #[must_use]
    pub const fn details(&self) -> &PlanDetails {
        &self.details
    }

    /// Duration of the published profile for the same request (s), if the plan is another.
    #[must_use]
    pub const fn published_duration(&self) -> Option<f64> {
        self.published
    }

    /// The highest derivative of position without impulses: 1 to 4.
    #[must_use]
    pub fn order(&self) -> usize {
        match &self.details {
            PlanDetails::Profile(profile) => profile.order().derivative(),
            PlanDetails::Shortest(shortest) => shortest.order().derivative(),
            PlanDetails::Transition { order, .. } => order.derivative(),
            PlanDetails::Table { order } => *order,
            PlanDetails::Rockwell { .. } => 3,
            PlanDetails::Commands { .. } => 2,
        }
    }

    /// Its polynomials in the order of time.
    pub fn spans(&self) -> impl Iterator<Item = Span> {
        analysis::spans(self)
    }

    /// The extreme values of velocity, acceleration, jerk and snap; infinite for those above its order, which are impulses.
    #[must_use]
    pub fn peaks(&self) -> [Peak; 4] {
        analysis::peaks(self)
    }

    /// The lowest and the highest position: beyond start and end if the move reverses.
    #[must_use]
    pub fn positions(&self) -> Peak {
        analysis::positions(self)
    }

    /// The largest magnitudes of velocity, acceleration, jerk and snap; infinite above its order. For an unfiltered profile from its
    /// closed forms.
    #[must_use]
    pub fn largest(&self) -> [f64; 4] {
        if let Some(profile) = self.plain_profile() {
            let Peaks { velocity, acceleration, jerk, snap } = profile.peaks();
            return [velocity, acceleration, jerk, snap];
        }
        self.peaks().map(|Peak { lowest, highest }| highest.max(-lowest))
    }

    /// Times at which velocity, acceleration, jerk and snap are at their limits.
    #[must_use]
    pub fn bindings(&self) -> Vec<Binding> {
        analysis::bindings(self)
    }

    /// Start and length (s) of the longest part at constant velocity; length 0 without one.
    ///
    /// For a profile without one the start is its middle.
    #[must_use]
    pub fn cruise(&self) -> (f64, f64) {
        match self.plain_profile() {
            Some(profile) => ((profile.duration() - profile.cruise()) / 2.0, profile.cruise()),
            None => analysis::cruise(self),
        }
    }

    /// The profile, if it is not filtered.
    fn plain_profile(&self) -> Option<&Profile> {
        match &self.details {
            PlanDetails::Profile(profile) if self.filter == 0.0 && self.held.is_none() => Some(profile),
            _ => None,
        }
    }

    pub(crate) fn course(&self) -> &(dyn Course + Send + Sync) {
        &*self.course
    }

    pub(crate) fn parts(&self) -> &[Impulse] {
        &self.parts
    }
}

impl PlanDetails {
    /// Changes them to those of the same move in `factor` times the time.
    fn slow(&mut self, factor: f64) {
        match self {
            Self::Rockwell { acceleration, deceleration } => {
                for jerk in [acceleration, deceleration] {
                    *jerk /= factor * factor * factor;
                }
            }
            Self::Commands { commands, sending, .. } => {
                let start = commands.first().map_or(0.0, |command| command.t);
                for command in commands {
                    command.t = start + (command.t - start) * factor;
                    command.velocity /= factor;
                    command.acceleration /= factor * factor;
                }
                if let Sending::Rate(rate) = sending {
                    *rate /= factor;
                }
            }
            Self::Profile(_) | Self::Shortest(_) | Self::Transition { .. } | Self::Table { .. } => {}
        }
    }
}

impl fmt::Debug for Plan {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { course, parts, limits, details, published, filter, execution, held } = self;
        f.debug_struct("Plan")
            .field("duration", &course.duration())
            .field("parts", parts)
            .field("limits", limits)
            .field("details", details)
            .field("published", published)
            .field("filter", filter)
            .field("execution", execution)
            .field("held", held)
            .finish()
    }
}
