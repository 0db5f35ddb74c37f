//! One base tick of the linear loop, in the order of events of a run: power stage and mechanics go from tick k to k+1, then
//! the loops that are due at k+1 turn.
//!
//! The equations are those of `drive::firmware`, `drive::{velocity, current}` and of the power stage of `sim`, around the
//! operating point at standstill: no set-point, no limit, no rounding of encoders. A loop that is opened puts out nothing.
use crate::electrical::Electrical;
use crate::late::{CurrentLine, Line, Passage, rotated, times};
use crate::model::{Loop, PositionFeedback, Source, VelocitySignal};
use crate::state::{MECHANICS, MOST_STATES, STATES, State};
use nalgebra::DMatrix;
use servobench_base::{Divider, Dq};
use servobench_drive::measurement::{self, observer};
use servobench_drive::{Stage, derivative, filter};
use servobench_linear::Factors;
use servobench_plant::transition;

/// Which loops have their turn at a tick.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct Due {
    pub(crate) position: bool,
    pub(crate) velocity: bool,
    pub(crate) current: bool,
}

/// Which loops are closed; the current loop always is.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct Closed {
    pub(crate) position: bool,
    pub(crate) velocity: bool,
    /// Whether the shaft turns; a current loop by itself is looked at with the shaft held.
    pub(crate) shaft: bool,
}

/// All that a tick needs.
pub(crate) struct Tick<'a> {
    model: &'a Loop,
    closed: Closed,
    factors: Factors,
    electrical: Option<Electrical>,
    /// `[Φ Γ]` of the mechanics with the travel.
    transition: DMatrix<f64>,
    bodies: usize,
    /// Axis coordinate per motor coordinate of the mechanics.
    transmission: f64,
    /// Base tick (s).
    h: f64,
    /// Late encoders of motor and load, and late current sensors.
    late: (Option<Line>, Option<Line>, Option<CurrentLine>),
    late_states: usize,
    /// Current that the drive takes for one that flows, as a complex number.
    current_ratio: Dq,
    /// Factors of the gain schedule on the gains of position and velocity loop.
    scheduled: (f64, f64),
}

impl<'a> Tick<'a> {
    pub(crate) fn new(model: &'a Loop) -> Self {
        let h = model.drive.base_rate.period();
        let (bodies, drive, sensors) = (model.mechanics.bodies(), &model.drive, &model.sensors);
        let mut late_states = 0;
        let mut line = |latency, every: Divider| {
            let line = Line::new(latency, every.ticks(), h, late_states);
            late_states += line.map_or(0, |line| line.states());
            line
        };
        let motor = line(sensors.motor_latency, drive.velocity_every);
        let load = match model.position_feedback {
            PositionFeedback::Motor => None,
            PositionFeedback::Load => line(sensors.load_latency, drive.position_every),
        };
        let current = match drive.stage {
            Stage::Current { .. } => CurrentLine::new(sensors, h, late_states),
            Stage::Direct { .. } => None,
        };
        late_states += current.map_or(0, |line| line.states());
        Self {
            model,
            closed: Closed { position: model.closes_position, velocity: true, shaft: true },
            factors: Factors::ONE,
            electrical: match &model.source {
                Source::Pmsm(motor) => Some(Electrical::new(motor, model.point.current, h)),
                Source::Ideal { .. } => None,
            },
            transition: transition(&model.mechanics, h),
            bodies: bodies.len(),
            transmission: bodies[0].transmission,
            h,
            late: (motor, load, current),
            late_states,
            current_ratio: sensors.current_ratio(),
            scheduled: (1.0, 1.0),
        }
    }

    /// The same loop with these loops closed and gains so much larger.
    pub(crate) fn with(&mut self, closed: Closed, factors: Factors) {
        (self.closed, self.factors) = (closed, factors);
    }

    /// The same loop with the gains of position and velocity loop by these factors of a gain schedule.
    pub(crate) const fn schedule(&mut self, factors: (f64, f64)) {
        self.scheduled = factors;
    }

    pub(crate) const fn closed(&self) -> Closed {
        self.closed
    }

    pub(crate) const fn model(&self) -> &'a Loop {
        self.model
    }

    /// Number of states.
    pub(crate) fn states(&self) -> usize {
        self.fixed_states() + self.late_states
    }

    /// Number of states of late sensors.
    pub(crate) const fn late_states(&self) -> usize {
        self.late_states
    }

    /// Number of all other states: two more for each filter, and all of them with parts that most drives have not.
    pub(crate) fn fixed_states(&self) -> usize {
        let blocks = &self.model.drive.blocks;
        if blocks.position.is_some() || blocks.acceleration.is_some() || blocks.observer().is_some() {
            return MOST_STATES;
        }
        STATES + 2 * self.model.drive.blocks.filters.sections().len()
    }

    /// Speed of the motor (its own coordinate).
    fn motor_speed(&self, x: &State) -> f64 {
        x.mechanics[self.bodies - 1] / (self.h * self.transmission)
    }

    /// Position of the last body (axis coordinate): each stretch is by how much a body lags behind the one before it.
    fn load_position(&self, x: &State) -> f64 {
        x.mechanics[..self.bodies - 1].iter().fold(x.position, |position, stretch| position - stretch)
    }

    /// The loops that are due, the slower ones first: what they say reaches the faster ones in the same tick.
    pub(crate) fn control(&self, x: &mut State, due: Due) {
        if due.velocity {
            self.sample_motor(x);
        }
        if due.position {
            self.sample_load(x);
            self.position_loop(x);
        }
        if due.velocity {
            self.velocity_loop(x);
        }
        if due.current {
            self.current_loop(x);
        }
    }

    /// The travel that the drive sees at a cycle of the velocity loop is that of a latency ago.
    fn sample_motor(&self, x: &mut State) {
        if let Some(line) = &self.late.0 {
            x.travelled = line.sample(&mut x.late) / self.transmission;
        }
    }

    fn sample_load(&self, x: &mut State) {
        if let Some(line) = &self.late.1 {
            line.sample(&mut x.late);
        }
    }

    /// Position that closes the position loop (axis coordinate).
    fn position_read(&self, x: &State) -> f64 {
        let p = &self.model.drive;
        match (self.model.position_feedback, &self.late) {
            (PositionFeedback::Motor, (None, ..)) => p.transmission / self.transmission * x.position,
            (PositionFeedback::Motor, (Some(line), ..)) => p.transmission / self.transmission * line.position(&x.late),
            (PositionFeedback::Load, (_, None, _)) => self.load_position(x),
            (PositionFeedback::Load, (_, Some(line), _)) => line.position(&x.late),
        }
    }

    fn position_loop(&self, x: &mut State) {
        let p = &self.model.drive;
        let position = self.position_read(x);
        let gain = self.factors.position * self.scheduled.0 * p.position_gain;
        let gain = if self.closed.position { gain } else { 0.0 };
        let Some(parts) = &p.blocks.position else {
            x.velocity_reference = -gain * position;
            return;
        };
        let h = p.period(p.position_every);
        let derivative = parts.derivative.map_or(0.0, |derivative| {
            let mut of_error = derivative::State { last: Some(-x.last_position), rate: x.position_rate };
            let derivative = derivative::step(&derivative, &mut of_error, -position, h);
            (x.last_position, x.position_rate) = (position, of_error.rate);
            derivative
        });
        x.velocity_reference = gain * (-position + x.position_integral + derivative);
        if let Some(integral_time) = parts.integral_time {
            x.position_integral -= h / integral_time * position;
        }
    }

    fn velocity_loop(&self, x: &mut State) {
        let p = &self.model.drive;
        let h = p.period(p.velocity_every);
        let method = p.blocks.measurement.as_ref();
        let measured = match (method, self.model.velocity_signal) {
            (None, VelocitySignal::Encoder) => self.motor_speed(x),
            (Some(measurement::Params::Observer(observer)), _) => {
                let travelled = std::mem::take(&mut x.travelled);
                observer::step(observer, &mut x.observer, travelled, x.effort)
            }
            (None | Some(measurement::Params::Difference | measurement::Params::Mt(_)), _) => {
                std::mem::take(&mut x.travelled) / h
            }
        };
        let last = x.filtered_velocity;
        x.filtered_velocity += h / (h + p.velocity_filter_time) * (measured - x.filtered_velocity);
        let gain = self.factors.velocity * self.scheduled.1 * p.velocity.k_p;
        let gain = if self.closed.velocity { gain } else { 0.0 };
        let reference = x.velocity_reference / p.transmission;
        let mut proportional = gain * (p.blocks.reference_weight * reference - x.filtered_velocity);
        if let Some(acceleration) = &p.blocks.acceleration {
            let mut of_velocity = derivative::State { last: Some(last), rate: x.acceleration };
            proportional -= gain * derivative::step(acceleration, &mut of_velocity, x.filtered_velocity, h);
            x.acceleration = of_velocity.rate;
        }
        if let Some(observer) = p.blocks.observer()
            && self.closed.velocity
        {
            proportional -= observer.compensation * x.observer.disturbance;
        }
        x.effort = filter::step(&p.blocks.filters, &mut x.filters, proportional + x.velocity_integral);
        if let Some(integral_time) = p.velocity.integral_time {
            x.velocity_integral += h / integral_time * (gain * (reference - x.filtered_velocity));
        }
    }

    fn current_loop(&self, x: &mut State) {
        let (Stage::Current { params: p, every }, Some(electrical)) = (&self.model.drive.stage, &self.electrical)
        else {
            return;
        };
        let h = self.model.drive.period(*every);
        let factors = self.factors.current;
        let current = match &self.late.2 {
            None => x.current,
            Some(line) => line.sample(&mut x.late, x.current),
        };
        let current = times(current, self.current_ratio);
        let error = Dq { d: -current.d, q: x.effort / p.motor.effort_constant(p.d_reference) - current.q };
        let omega_e = p.motor.electrical_ratio * x.filtered_velocity;
        let Dq { d: i_d, q: i_q } = self.model.point.current;
        let decoupling = Dq {
            d: -omega_e * (p.motor.inductance.q * i_q),
            q: omega_e * (p.motor.inductance.d * i_d + p.motor.flux_linkage),
        };
        let computed = Dq {
            d: factors.d * p.gains.k_p.d * error.d + x.current_integral.d + decoupling.d,
            q: factors.q * p.gains.k_p.q * error.q + x.current_integral.q + decoupling.q,
        };
        x.current_integral.d += h * factors.d * p.gains.k_i.d * error.d;
        x.current_integral.q += h * factors.q * p.gains.k_i.q * error.q;
        // What was computed a cycle ago goes out; the voltage of the operating point is turned ahead by 1.5·h·ω.
        (x.applied, x.applied_travel) = (x.pending, x.pending_travel);
        let ahead = turned(electrical.voltage, 1.5 * h * omega_e);
        let out = rotated(computed, self.model.sensors.commutation);
        x.pending = Dq { d: out.d + ahead.d, q: out.q + ahead.q };
        x.pending_travel = 0.0;
    }

    /// Power stage and mechanics from this tick to the next.
    pub(crate) fn plant(&self, x: &mut State) {
        let current = x.current;
        let effort = self.power_stage(x);
        if !self.closed.shaft {
            self.pass_current(x, current, 0.0);
            (x.mechanics, x.position, x.last_speed) = ([0.0; MECHANICS], 0.0, 0.0);
            return;
        }
        let states = 2 * self.bodies - 1;
        let row = |row: usize| {
            let passive: f64 = (0..states).map(|column| self.transition[(row, column)] * x.mechanics[column]).sum();
            passive + self.transition[(row, states)] * effort
        };
        let next = std::array::from_fn(|i| if i < states { row(i) } else { 0.0 });
        let travel = row(states);
        let before = std::mem::replace(&mut x.mechanics, next);
        x.position += travel;
        for travelled in [&mut x.travelled, &mut x.pending_travel, &mut x.applied_travel] {
            *travelled += travel / self.transmission;
        }
        self.pass_encoders(x, travel, &before);
        self.pass_current(x, current, travel / self.transmission);
    }

    /// The tick, with the motor's `travel` and the mechanics `before` it, passes for late encoders.
    fn pass_encoders(&self, x: &mut State, travel: f64, before: &[f64; MECHANICS]) {
        let last = self.bodies - 1;
        let passage = |now: &[f64; MECHANICS], body: usize, travel: f64| Passage {
            travel,
            before: before[last + body],
            after: now[last + body],
        };
        if let Some(line) = &self.late.0 {
            line.tick(&mut x.late, passage(&x.mechanics, 0, travel));
        }
        if let Some(line) = &self.late.1 {
            let stretched = |stretches: &[f64; MECHANICS]| stretches[..last].iter().sum::<f64>();
            let travel = travel - (stretched(&x.mechanics) - stretched(before));
            line.tick(&mut x.late, passage(&x.mechanics, last, travel));
        }
    }

    /// The tick passes for samples of the current, which was `current` before; the rotor has turned by `travel` (motor coordinate).
    fn pass_current(&self, x: &mut State, current: Dq, travel: f64) {
        if let (Some(line), Source::Pmsm(motor)) = (&self.late.2, &self.model.source) {
            let back = turned(self.model.point.current, -motor.electrical_ratio * travel);
            line.tick(&mut x.late, current, back);
        }
    }

    /// Mean effort over the tick (motor coordinate).
    fn power_stage(&self, x: &mut State) -> f64 {
        match (&self.model.source, &self.electrical, &self.model.drive.stage) {
            (Source::Pmsm(motor), Some(electrical), _) => {
                let speed = self.motor_speed(x);
                // Straight on from the last two ticks.
                let mean_speed = speed + (speed - x.last_speed) / 2.0;
                x.last_speed = speed;
                // Held in the stator frame: in the rotor's it turns back.
                let back = turned(electrical.voltage, -motor.electrical_ratio * x.applied_travel);
                let voltage = Dq { d: x.applied.d + back.d, q: x.applied.q + back.q };
                let (current, torque) = electrical.step(x.current, voltage, motor.electrical_ratio * mean_speed);
                x.current = current;
                torque
            }
            (Source::Ideal { gain }, _, Stage::Direct { gain: estimated }) => gain * (x.effort / estimated),
            _ => 0.0,
        }
    }
}

/// By how much a small turn `angle` (rad) changes `vector`.
fn turned(vector: Dq, angle: f64) -> Dq {
    Dq { d: -vector.q * angle, q: vector.d * angle }
}
