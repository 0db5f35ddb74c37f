//! Supervision of motor and power stage: DC link, commutation, stall, phases, speed. Each is active if its parameters are given.
//!
//! | finding | condition | 603Fh |
//! |---|---|---|
//! | over-voltage | the measured DC link is above `overvoltage` | 3210h |
//! | under-voltage | the measured DC link is below `undervoltage` | 3220h |
//! | over-current | the measured current of a leg is above `overcurrent` | 2310h |
//! | over-temperature | the measured winding is warmer than `winding_temperature` | 4310h |
//! | lost phase | a leg has had less than half of `current` for `time` while it could have had `current` or more | 3321h |
//! | stall | the loops demand more than their limit while the motor is slower than `speed`, for `time` | 7121h |
//! | commutation | against a torque-producing current of `current` or more the motor has gained `speed`, at once or in swings | 7122h |
//! | over-speed | the motor is faster than `overspeed` | 7310h |
//!
//! - **Commutation.** i_q·v < 0 and |i_q| ≥ `current`: the current brakes. Then |v| falls, unless the drive's q axis is wrong, or a load is
//!   stronger than the motor. The gain is counted from the lowest |v| since then. A trapped motor with little friction swings about an
//!   angle at which its torque changes sign, and gains less each time: gains of at least a quarter of `speed` add up, with a forgetting
//!   time of 0.5 s, if their sum is at least half of the losses meanwhile. A load on a spring also drives a healthy braking motor, but by
//!   less than it loses.
//! - **Stall.** A motor whose commutation is off by 90° has no torque either; by its sensors a drive cannot distinguish it from a blocked
//!   one.
//! - **Lost phase.** The time counts while the leg has a reference, behind a lag of first order with the bandwidth of the current loop, and
//!   restarts as soon as half of `current` flows. The lag is needed because no healthy leg follows the chatter that a coarse encoder causes
//!   in the reference from cycle to cycle. At standstill a leg whose reference is zero cannot be supervised.
//!
//! The rules are ours (assumed): the profile has codes for the findings and no rules of detection. Codes: IEC 61800-7-201, error codes of
//! the emergency message.
//!
//! A finding stays until the power goes off. Without power nothing is supervised.
use servobench_base::{AlphaBeta, Stateful};
use servobench_config::Kind::{Motor, Plain};
use servobench_config::quantities::{CURRENT, TEMPERATURE, TIME, VELOCITY, VOLTAGE};
use servobench_config::{Bound, Measure, ParameterError, positive};

servobench_config::parameters! {
    /// A parameter of the supervision of motor and power stage.
    pub enum Parameter {
        /// Measured DC link voltage below which the drive reports a fault
        UNDERVOLTAGE "under-voltage threshold" = positive(Plain(&VOLTAGE), "200 V");
        /// Measured DC link voltage above which it reports one
        OVERVOLTAGE "over-voltage threshold" = positive(Plain(&VOLTAGE), "400 V");
        /// Speed of the motor above which it reports one
        OVERSPEED "over-speed threshold" = positive(Motor(&VELOCITY), "6500 rpm");
        /// Current of a phase above which it reports one
        OVERCURRENT "over-current threshold" = positive(Plain(&CURRENT), "20 Arms");
        /// Temperature of the winding above which it reports one
        WINDING_TEMPERATURE "over-temperature threshold" = Measure { kind: Plain(&TEMPERATURE), bound: Bound::Within(-100.0, 500.0), example: "130 degC" };
        /// Speed that the motor gains against its torque-producing current
        COMMUTATION_SPEED "speed gained against the current" = positive(Motor(&VELOCITY), "200 rpm");
        /// Least torque-producing current that counts
        COMMUTATION_CURRENT "current of the commutation supervision" = positive(Plain(&CURRENT), "4 Arms");
        /// Speed below which the motor counts as stalled
        STALL_SPEED "speed of a stalled motor" = positive(Motor(&VELOCITY), "5 rpm");
        /// Time for which the loops are at their limit meanwhile
        STALL_TIME "time of a stalled motor" = positive(Plain(&TIME), "0.2 s");
        /// Least current reference of a leg that counts
        PHASE_CURRENT "current of the phase supervision" = positive(Plain(&CURRENT), "1 Arms");
        /// Time for which a leg has less than half of it
        PHASE_TIME "time of a lost phase" = positive(Plain(&TIME), "10 ms");
    }
}

/// Thresholds of the supervision; constant during a run.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Params {
    /// Lowest DC link (V).
    pub undervoltage: Option<f64>,
    /// Highest DC link (V).
    pub overvoltage: Option<f64>,
    /// Highest speed (motor coordinate, rad/s or m/s).
    pub overspeed: Option<f64>,
    /// Highest current of a leg (A, peak).
    pub overcurrent: Option<f64>,
    /// Highest temperature of the winding (°C).
    pub winding_temperature: Option<f64>,
    /// Commutation.
    pub commutation: Option<Commutation>,
    /// Stall.
    pub stall: Option<Stall>,
    /// Phases.
    pub phases: Option<Phases>,
}

/// Threshold of wrong commutation.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Commutation {
    /// Speed gained against the current (motor coordinate).
    pub speed: f64,
    /// Least current for the detection (A, peak).
    pub current: f64,
}

/// Threshold of a blocked motor.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Stall {
    /// Speed below which the motor stands (motor coordinate).
    pub speed: f64,
    /// Duration (s).
    pub time: f64,
}

/// Threshold of a lost phase.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Phases {
    /// Least reference of a leg for the detection (A, peak).
    pub current: f64,
    /// Duration with less than half of that (s).
    pub time: f64,
}

/// Fault found by the supervision.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Stateful)]
pub enum Finding {
    /// The DC link is too high.
    OverVoltage,
    /// The DC link is too low.
    UnderVoltage,
    /// A leg has no current.
    LostPhase,
    /// The motor stands although the loops are at their limit.
    Stall,
    /// The motor gains speed against its current.
    Commutation,
    /// The motor is too fast.
    OverSpeed,
    /// A leg has too much current.
    OverCurrent,
    /// The winding is too warm.
    OverTemperature,
}

impl Finding {
    /// True if no loop can brake the axis any more: the current drives instead of braking, only two phases are left, or regenerated energy
    /// charges the link further.
    #[must_use]
    pub const fn leaves_no_brake(self) -> bool {
        matches!(self, Self::Commutation | Self::LostPhase | Self::OverVoltage)
    }
}

/// Time constant with which gains and losses of speed are forgotten (s).
const FORGOTTEN: f64 = 0.5;
/// Least gain that adds up, as a part of the threshold of speed.
const LEAST: f64 = 0.25;
/// Least gain of speed for a finding, as a share of the loss.
const OF_LOST: f64 = 0.5;

/// Course of the speed between turning points while the current brakes.
#[derive(Debug, Clone, Copy, PartialEq, Stateful)]
struct Braked {
    /// Last turning point, and the farthest speed from there.
    turn: f64,
    farthest: f64,
    rises: bool,
}

/// Speed gained and lost against the current, gradually forgotten.
#[derive(Debug, Clone, Copy, PartialEq, Default, Stateful)]
struct Swings {
    now: Option<Braked>,
    gained: f64,
    lost: f64,
}

impl Swings {
    /// Advances by a cycle of `h` (s) at this `speed`; `brakes`: the current brakes; swings count from `least` on. Returns the present
    /// gain.
    fn step(&mut self, speed: f64, brakes: bool, least: f64, h: f64) -> f64 {
        let kept = 1.0 - h / FORGOTTEN;
        (self.gained, self.lost) = (kept * self.gained, kept * self.lost);
        if !brakes {
            if let Some(braked) = self.now.take() {
                self.add(braked, least);
            }
            return 0.0;
        }
        let mut braked = self.now.unwrap_or(Braked { turn: speed, farthest: speed, rises: false });
        braked.farthest = if braked.rises { braked.farthest.max(speed) } else { braked.farthest.min(speed) };
        if (speed - braked.farthest).abs() >= least {
            self.add(braked, least);
            braked = Braked { turn: braked.farthest, farthest: speed, rises: !braked.rises };
        }
        self.now = Some(braked);
        if braked.rises { braked.farthest - braked.turn } else { speed - braked.farthest }
    }

    fn add(&mut self, Braked { turn, farthest, rises }: Braked, least: f64) {
        match (farthest - turn).abs() {
            size if size < least => {}
            size if rises => self.gained += size,
            size => self.lost += size,
        }
    }

    /// True if `speed` was gained in swings, including the present gain `now`.
    fn has_gained(&self, speed: f64, now: f64) -> bool {
        self.gained + now >= speed && self.gained + now >= OF_LOST * self.lost
    }
}

/// State from tick to tick.
#[derive(Debug, Clone, Copy, PartialEq, Default, Stateful)]
pub struct State {
    /// First finding.
    pub found: Option<Finding>,
    /// Speed against the current.
    swings: Swings,
    /// Cycles in which the motor stood at the limit.
    stalled: u32,
    /// Current of a healthy motor for the reference (A, peak).
    followed: AlphaBeta,
    /// Cycles in which a leg lacked the current of its reference.
    without_current: [u32; 3],
}

impl Params {
    /// # Errors
    /// [`ParameterError`] names the first parameter out of its bound.
    pub fn check(&self) -> Result<(), ParameterError> {
        let Self { undervoltage, overvoltage, overspeed, overcurrent, winding_temperature, commutation, stall, phases } =
            *self;
        for (parameter, value) in [
            (Parameter::UNDERVOLTAGE, undervoltage),
            (Parameter::OVERVOLTAGE, overvoltage),
            (Parameter::OVERSPEED, overspeed),
            (Parameter::OVERCURRENT, overcurrent),
            (Parameter::WINDING_TEMPERATURE, winding_temperature),
            (Parameter::COMMUTATION_SPEED, commutation.map(|one| one.speed)),
            (Parameter::COMMUTATION_CURRENT, commutation.map(|one| one.current)),
            (Parameter::STALL_SPEED, stall.map(|one| one.speed)),
            (Parameter::STALL_TIME, stall.map(|one| one.time)),
            (Parameter::PHASE_CURRENT, phases.map(|one| one.current)),
            (Parameter::PHASE_TIME, phases.map(|one| one.time)),
        ] {
            if let Some(value) = value {
                parameter.check(value)?;
            }
        }
        Ok(())
    }
}

/// Input of a cycle of the velocity loop.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Motion {
    /// Measured speed (motor coordinate).
    pub velocity: f64,
    /// Measured DC link (V).
    pub dc_link: f64,
    /// Measured temperature of the winding (°C).
    pub winding: f64,
    /// True if the effort was cut at the last cycle.
    pub is_cut: bool,
}

/// Input of a cycle of the current loop.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Currents {
    /// Measured speed (motor coordinate).
    pub velocity: f64,
    /// Measured torque-producing current (A, peak).
    pub q: f64,
    /// Reference of the current, in the stator frame (A, peak).
    pub reference: AlphaBeta,
    /// Bandwidth of the current loop (rad/s).
    pub bandwidth: f64,
    /// Measured current in the stator frame (A, peak).
    pub measured: AlphaBeta,
}

/// Supervises a cycle of the velocity loop of `h` (s).
#[cold]
pub fn watch_motion(p: &Params, x: &mut State, u: &Motion, h: f64) {
    let speed = u.velocity.abs();
    let stands = p.stall.is_some_and(|stall| u.is_cut && speed <= stall.speed);
    x.stalled = if stands { x.stalled.saturating_add(1) } else { 0 };
    let is_beyond = |limit: Option<f64>, beyond: fn(f64, f64) -> bool, value| limit.is_some_and(|at| beyond(value, at));
    let found = if is_beyond(p.overvoltage, |u, at| u > at, u.dc_link) {
        Some(Finding::OverVoltage)
    } else if is_beyond(p.undervoltage, |u, at| u < at, u.dc_link) {
        Some(Finding::UnderVoltage)
    } else if is_beyond(p.overspeed, |v, at| v > at, speed) {
        Some(Finding::OverSpeed)
    } else if is_beyond(p.winding_temperature, |warm, at| warm > at, u.winding) {
        Some(Finding::OverTemperature)
    } else {
        p.stall.filter(|stall| has_lasted(x.stalled, stall.time, h)).map(|_| Finding::Stall)
    };
    x.found = x.found.or(found);
}

/// Supervises a cycle of the current loop of `h` (s).
#[cold]
pub fn watch_currents(p: &Params, x: &mut State, u: &Currents, h: f64) {
    if let Some(commutation) = p.commutation {
        let speed = u.velocity.abs();
        let brakes = u.q * u.velocity < 0.0 && u.q.abs() >= commutation.current;
        let now = x.swings.step(speed, brakes, LEAST * commutation.speed, h);
        if now >= commutation.speed || x.swings.has_gained(commutation.speed, now) {
            x.found = x.found.or(Some(Finding::Commutation));
        }
    }
    if p.overcurrent.is_some_and(|most| legs(u.measured).iter().any(|current| current.abs() > most)) {
        x.found = x.found.or(Some(Finding::OverCurrent));
    }
    if let Some(phases) = p.phases {
        let step = u.bandwidth * h / (1.0 + u.bandwidth * h);
        x.followed.alpha += step * (u.reference.alpha - x.followed.alpha);
        x.followed.beta += step * (u.reference.beta - x.followed.beta);
        let (asked, measured) = (legs(x.followed), legs(u.measured));
        for (leg, cycles) in x.without_current.iter_mut().enumerate() {
            if measured[leg].abs() >= 0.5 * phases.current {
                *cycles = 0;
            } else if asked[leg].abs() >= phases.current {
                *cycles = cycles.saturating_add(1);
                if has_lasted(*cycles, phases.time, h) {
                    x.found = x.found.or(Some(Finding::LostPhase));
                }
            }
        }
    }
}

/// True if `cycles` cycles of `h` (s) last `time` (s); rounding does not require one more.
fn has_lasted(cycles: u32, time: f64, h: f64) -> bool {
    f64::from(cycles) * h >= time * (1.0 - 1e-12)
}

const HALF_SQRT_3: f64 = 0.866_025_403_784_438_6;

fn legs(AlphaBeta { alpha, beta }: AlphaBeta) -> [f64; 3] {
    [alpha, HALF_SQRT_3 * beta - 0.5 * alpha, -HALF_SQRT_3 * beta - 0.5 * alpha]
}

#[cfg(test)]
mod tests;
