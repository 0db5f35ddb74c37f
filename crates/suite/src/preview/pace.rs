//! How fast the loops are, and what comes late.
use servobench_scenario::{Actuator, CurrentGain, Drive, Scenario};

/// A loop of the drive.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct LoopBandwidth {
    /// `current`, `velocity`, `position`.
    pub name: &'static str,
    /// Bandwidth that its gain makes of what the drive believes (rad/s); `None` where it believes nothing.
    pub bandwidth: Option<f64>,
    /// Rate of its task (Hz).
    pub rate: f64,
}

/// Something that comes late.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Delay {
    /// What.
    pub name: &'static str,
    /// By how much (s).
    pub length: f64,
}

/// The loops of `scenario`, the fastest first; none without a drive.
pub(super) fn loops(scenario: &Scenario) -> Vec<LoopBandwidth> {
    let Some(drive) = scenario.actuator.drive() else { return Vec::new() };
    let mut loops = Vec::new();
    if let Actuator::Pmsm { current, .. } = &scenario.actuator {
        let bandwidth = match current.gain {
            CurrentGain::Bandwidth(bandwidth) => bandwidth,
            CurrentGain::PerAxis { d, q } => (d / current.motor.inductance_d).max(q / current.motor.inductance_q),
        };
        loops.push(LoopBandwidth { name: "current", bandwidth: Some(bandwidth), rate: current.rate.hertz().into() });
    }
    let (velocity, position) = (&drive.velocity, &drive.position);
    let inertia = believed_inertia(drive);
    let bandwidth = (inertia > 0.0).then(|| velocity.gain / inertia);
    loops.push(LoopBandwidth { name: "velocity", bandwidth, rate: velocity.rate.hertz().into() });
    let rate = position.rate.hertz().into();
    loops.push(LoopBandwidth { name: "position", bandwidth: Some(position.gain), rate });
    loops
}

/// Inertia as the drive believes that the motor feels it.
fn believed_inertia(drive: &Drive) -> f64 {
    let estimate = &drive.estimate;
    estimate.transmission.powi(2) * (estimate.motor_inertia + estimate.load_inertia)
}

/// What comes late in `scenario`, from the set-point to the voltage.
pub(super) fn delays(scenario: &Scenario) -> Vec<Delay> {
    let mut delays = Vec::new();
    let mut note = |name, length: f64| {
        if length > 0.0 {
            delays.push(Delay { name, length });
        }
    };
    if let Some(bus) = &scenario.bus {
        let cycle = f64::from(bus.cycle) * scenario.base_rate.period();
        note("motion task", f64::from(bus.motion_every) * cycle);
        note("bus", f64::from(bus.delay) * cycle);
    }
    let Some(drive) = scenario.actuator.drive() else { return delays };
    // Half a period on average until a task takes up what is new.
    note("position task", drive.position.rate.period() / 2.0);
    note("velocity task", drive.velocity.rate.period() / 2.0);
    note("velocity filter", drive.velocity.filter_time);
    if let Actuator::Pmsm { current, .. } = &scenario.actuator {
        // A period for the computation, half of one until the middle of the voltage.
        note("current loop", 1.5 * current.rate.period());
    }
    delays
}
