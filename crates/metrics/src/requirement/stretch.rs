//! Stretches of a run, and the comparison of load, request and response of the loop in them: one pass over the rows.
use super::Rules;
use super::held_modes::FlexibleLoad;
use super::phases::RequestPhase;
use super::rules::Driven;
use super::servo::Response;
use servobench_base::RequestKind;
use servobench_signals::Signal;
use servobench_trace::Recording;
use std::ops::Range;

/// Rows of one phase, and their measured values.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Stretch {
    /// Its rows, at least one.
    pub(super) rows: Range<usize>,
    /// Lowest and highest response.
    pub(super) response: (f64, f64),
    /// Largest distance of the load from the response, and its row.
    pub(super) worst: (f64, usize),
    /// Largest distance of the response from the request.
    pub(super) lag: f64,
    /// Mean of load less request, and of request less response.
    pub(super) load_off: f64,
    pub(super) response_off: f64,
    /// Mean velocity of load and response.
    pub(super) load_velocity: f64,
    pub(super) response_velocity: f64,
}

/// Channels of the pass.
#[derive(Debug, Clone, Copy)]
pub(super) struct Rows<'a> {
    pub(super) request: &'a [f64],
    pub(super) request_velocity: &'a [f64],
    pub(super) load: &'a [f64],
    /// Period of the rows (s).
    pub(super) h: f64,
}

impl<'a> Rows<'a> {
    /// The channels of `recording`; `None` if it lacks one.
    pub(super) fn of(recording: &'a Recording) -> Option<Self> {
        Some(Self {
            request: recording.channel(Signal::RequestPosition)?,
            request_velocity: recording.channel(Signal::RequestVelocity)?,
            load: recording.channel(Signal::LoadPosition)?,
            h: recording.rate.period(),
        })
    }

    /// Velocity of the load between the rows `from` and `to`; 0 if they coincide.
    pub(super) fn load_velocity(&self, from: usize, to: usize) -> f64 {
        if to <= from { 0.0 } else { (self.load[to] - self.load[from]) / ((to - from) as f64 * self.h) }
    }
}

impl Stretch {
    /// A stretch of these rows, not measured yet.
    pub(super) const fn new(rows: Range<usize>) -> Self {
        Self {
            response: (f64::INFINITY, f64::NEG_INFINITY),
            worst: (0.0, rows.start),
            lag: 0.0,
            load_off: 0.0,
            response_off: 0.0,
            load_velocity: 0.0,
            response_velocity: 0.0,
            rows,
        }
    }

    /// Span of the response.
    pub(super) fn span(&self) -> f64 {
        self.response.1 - self.response.0
    }

    fn take(&mut self, row: usize, load: f64, request: f64, response: f64) {
        self.response = (self.response.0.min(response), self.response.1.max(response));
        let (of_response, of_request) = (load - response, load - request);
        // An axis nearer to the request than the linear loop follows even better.
        let is_between = of_response * of_request <= 0.0;
        let off = if is_between { 0.0 } else { of_response.abs().min(of_request.abs()) };
        // A not-a-number value is infinitely far off.
        if off > self.worst.0 || off.is_nan() && self.worst.0.is_finite() {
            self.worst = (if off.is_nan() { f64::INFINITY } else { off }, row);
        }
        self.lag = self.lag.max((request - response).abs());
        self.load_off += load - request;
        self.response_off += request - response;
        self.response_velocity = if row == self.rows.start { response } else { self.response_velocity };
    }

    fn finish(&mut self, rows: &Rows<'_>, last_response: f64) {
        let count = self.rows.len() as f64;
        self.load_off /= count;
        self.response_off /= count;
        let last = self.rows.end - 1;
        self.load_velocity = rows.load_velocity(self.rows.start, last);
        let time = (last - self.rows.start) as f64 * rows.h;
        self.response_velocity = if time > 0.0 { (last_response - self.response_velocity) / time } else { 0.0 };
    }
}

/// Measures `stretches`, which are in order, do not overlap and are each within phases that request a position, or one that requests a
/// velocity.
pub(super) fn measure(rows: &Rows<'_>, phases: &[RequestPhase], rules: &Rules<'_>, stretches: &mut [Stretch]) {
    let mut follower = Follower::new(rules, rows.h);
    let mut before = RequestKind::Nothing;
    let mut waiting = stretches.iter_mut();
    let mut now = waiting.next();
    for phase in phases {
        follower.begin(rows, phase, before);
        before = phase.kind;
        if !matches!(phase.kind, RequestKind::Follow | RequestKind::Rest | RequestKind::Velocity) {
            continue;
        }
        for row in phase.rows.clone() {
            let (request, response) = follower.at(rows, phase.kind, row);
            if let Some(stretch) = now.as_mut().filter(|stretch| stretch.rows.start <= row) {
                stretch.take(row, rows.load[row], request, response);
                if stretch.rows.end == row + 1 {
                    stretch.finish(rows, response);
                    now = waiting.next();
                }
            }
            follower.step(rows, phase.kind, row);
        }
    }
}

/// The response of motor and load, and their requested position.
struct Follower {
    motor: Option<Response>,
    load: FlexibleLoad,
    wanted: f64,
}

impl Follower {
    fn new(rules: &Rules<'_>, h: f64) -> Self {
        let motor = rules.servo.map(|servo| Response::new(servo, h));
        let is_known = motor.is_some() || rules.driven == Driven::Exactly;
        Self { motor, load: FlexibleLoad::new(if is_known { &rules.held_modes } else { &[] }, h), wanted: 0.0 }
    }

    /// At the beginning of a request for a position or a velocity, the response starts at the position of the load.
    fn begin(&mut self, rows: &Rows<'_>, phase: &RequestPhase, before: RequestKind) {
        let row = phase.rows.start;
        let wants = |kind| matches!(kind, RequestKind::Follow | RequestKind::Rest);
        let goes_on = match phase.kind {
            RequestKind::Follow | RequestKind::Rest | RequestKind::Velocity if wants(before) => return,
            RequestKind::Follow | RequestKind::Rest => before == RequestKind::Velocity,
            RequestKind::Velocity => false,
            RequestKind::Nothing | RequestKind::Stand | RequestKind::Effort => return,
        };
        self.wanted = rows.load[row];
        let velocity = rows.load_velocity(row.saturating_sub(1), row);
        self.load.put(rows.load[row], velocity);
        if let Some(motor) = &mut self.motor {
            motor.put(rows.load[row], velocity, goes_on);
        }
    }

    /// Request and response at `row`.
    fn at(&mut self, rows: &Rows<'_>, kind: RequestKind, row: usize) -> (f64, f64) {
        if kind != RequestKind::Velocity {
            self.wanted = rows.request[row];
        }
        // A loop that is not stable has no response: the load is judged by the request.
        let response = Some(self.load.position()).filter(|position| position.is_finite());
        (self.wanted, response.unwrap_or(self.wanted))
    }

    fn step(&mut self, rows: &Rows<'_>, kind: RequestKind, row: usize) {
        let velocity = rows.request_velocity[row];
        let next = rows.request_velocity.get(row + 1).copied().unwrap_or(velocity);
        let mut goes_to = self.wanted;
        if kind == RequestKind::Velocity {
            goes_to += rows.h * velocity;
        } else if let Some(next) = rows.request.get(row + 1) {
            goes_to = *next;
        }
        if let Some(motor) = &mut self.motor {
            let measured = if motor.is_closed_at_the_load() { self.load.position() } else { motor.position() };
            motor.step(self.wanted, velocity, next - velocity, measured);
        }
        self.load.step(self.motor.as_ref().map_or(goes_to, Response::position));
        if kind == RequestKind::Velocity {
            self.wanted = goes_to;
        }
    }
}
