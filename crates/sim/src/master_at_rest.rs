//! The position loop that a master closes over a bus (csv), at rest and in real numbers: frames without increments, with the delay of the
//! bus. Position loop and interpolation are those of every run; this module has only the path between them.
use servobench_base::{Countdown, Divider, Setpoint, Stateful};
use servobench_drive::device::CycleEvent;
use servobench_drive::modes::cyclic::velocity;
use servobench_drive::modes::{Actual, Moment, Targets};
use servobench_drive::{self as drive, Demand};
use servobench_fieldbus::link::{Law, PositionGains, PositionLoop};

/// Positions or velocities in transit in one direction, the newest first.
type Frames = [f64; FRAMES];

/// Most frames in transit on a bus.
const FRAMES: usize = 16;

/// A position loop that a master closes over a bus.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct MasterOverBus {
    /// Gains of the loop.
    pub gains: PositionGains,
    /// Base ticks of a cycle of the bus.
    pub cycle: Divider,
    /// Delay of a frame in cycles, below 16.
    pub delay: usize,
}

/// Master, bus, and the interpolation of the drive.
#[derive(Stateful)]
pub(crate) struct MasterAtRest {
    #[state(constant)]
    law: Law,
    /// Factor on the output of the loop.
    #[state(constant)]
    factor: f64,
    /// Base ticks of a cycle of the bus and of a step of the drive, and a base tick (s).
    #[state(constant)]
    every: ([Divider; 2], f64),
    /// Delay of a frame in cycles.
    #[state(constant)]
    delay: usize,
    turns: [Countdown; 2],
    tick: u64,
    position_loop: PositionLoop,
    to_master: Frames,
    to_drive: Frames,
    /// Position at the last step of the drive, and its demand.
    position: f64,
    interpolation: velocity::State,
    demand: Demand,
}

impl MasterAtRest {
    /// The loop over a bus to a drive with these parameters.
    pub(crate) fn new(&MasterOverBus { gains, cycle, delay }: &MasterOverBus, drive: &drive::Params) -> Self {
        let law = Law { gains, feedforward: 0.0, limit: f64::INFINITY };
        let mut master = Self {
            law,
            factor: 1.0,
            every: ([cycle, drive.position_every], drive.base_rate.period()),
            delay,
            turns: [Countdown::default(); 2],
            tick: 0,
            position_loop: PositionLoop::OPEN,
            to_master: [0.0; FRAMES],
            to_drive: [0.0; FRAMES],
            position: 0.0,
            interpolation: velocity::State::begin(&moment(0.0, 0.0, 0.0)),
            demand: Demand::Off,
        };
        // The integral begins with the first velocity.
        master.position_loop.velocity(&master.law, 0.0, 0.0);
        master
    }

    pub(crate) const fn set(&mut self, factor: f64) {
        self.factor = factor;
    }

    /// One base tick with the axis at `position`.
    pub(crate) fn step(&mut self, position: f64) -> Demand {
        let ([cycle, drive], h) = self.every;
        let [bus_turn, drive_turn] = &mut self.turns;
        let mut event = CycleEvent::Between;
        if bus_turn.is_due(cycle) {
            let now = self.tick;
            push(&mut self.to_master, self.position);
            self.position_loop.put_out(now, &Setpoint::default());
            self.position_loop.receive(&self.law.gains, self.to_master[self.delay], now, now, h);
            let (velocity, _) = self.position_loop.velocity(&self.law, 0.0, f64::from(cycle.ticks()) * h);
            push(&mut self.to_drive, self.factor * velocity);
            event = CycleEvent::Sample;
        }
        self.tick += 1;
        if drive_turn.is_due(drive) {
            self.position = position;
            let steps = cycle.ticks() / drive.ticks();
            let params = velocity::Params { steps, velocity: f64::INFINITY };
            let moment = moment(self.to_drive[self.delay], position, f64::from(drive.ticks()) * h);
            self.demand = velocity::step(&params, &mut self.interpolation, &moment, event).demand;
        }
        self.demand
    }
}

fn push(frames: &mut Frames, newest: f64) {
    frames.rotate_right(1);
    frames[0] = newest;
}

fn moment(velocity: f64, position: f64, period: f64) -> Moment {
    let (targets, actual) = (Targets { velocity, ..Targets::default() }, Actual { position, ..Actual::default() });
    Moment { targets, actual, demanded: Setpoint::default(), period }
}
