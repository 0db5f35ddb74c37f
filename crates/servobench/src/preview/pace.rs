//! Bandwidths of the loops, and delays.
use servobench_base::Dq;
use servobench_drive::current::Tuning;
use servobench_scenario::{BusMode, Scenario};
use servobench_sim::replaces_the_drive;

/// A loop of the drive.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct LoopBandwidth {
    /// `current`, `velocity`, `position`, or `master's position`.
    pub name: &'static str,
    /// Bandwidth from its gain and the drive's estimates (rad/s); `None` without an estimate.
    pub bandwidth: Option<f64>,
    /// Rate of its task (Hz).
    pub rate: f64,
}

/// A delay between set-point and voltage.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Delay {
    /// Name of its cause.
    pub name: &'static str,
    /// Length (s).
    pub length: f64,
}

/// The loops of `scenario`, the fastest first; none without a drive, and with an FMU in its place.
pub(super) fn loops(scenario: &Scenario) -> Vec<LoopBandwidth> {
    let Some(drive) = scenario.actuator.drive().filter(|_| !replaces_the_drive(scenario)) else { return Vec::new() };
    let mut loops = Vec::new();
    let params = &drive.params;
    if let (Some((current, rate)), Some(tuning)) = (params.current_loop(), drive.current_tuning) {
        let bandwidth = match tuning {
            Tuning::Bandwidth(bandwidth) => bandwidth,
            Tuning::Gains(Dq { d, q }) => (d / current.motor.inductance.d).max(q / current.motor.inductance.q),
        };
        loops.push(LoopBandwidth { name: "current", bandwidth: Some(bandwidth), rate: rate.hertz().into() });
    }
    let inertia = drive.estimate.inertia_at_the_motor();
    let bandwidth = (inertia > 0.0).then(|| params.velocity.k_p / inertia);
    loops.push(LoopBandwidth { name: "velocity", bandwidth, rate: params.velocity_rate().hertz().into() });
    let rate = params.position_rate().hertz().into();
    let bus = scenario.bus.as_ref();
    match bus.map(|bus| (bus.mode, bus.position_loop)) {
        Some((BusMode::CyclicVelocity, Some(gains))) => {
            let rate = f64::from(scenario.base_rate.hertz()) / bus.map_or(1.0, |bus| bus.cycle.into());
            loops.push(LoopBandwidth { name: "master's position", bandwidth: Some(gains.gain), rate });
        }
        Some((BusMode::ProfileVelocity, _)) => {}
        _ => loops.push(LoopBandwidth { name: "position", bandwidth: Some(params.position_gain), rate }),
    }
    loops
}

/// Delays in `scenario`, from the set-point to the voltage.
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
    let drive = scenario.actuator.drive().filter(|_| !replaces_the_drive(scenario));
    let Some(drive) = drive.map(|drive| &drive.params) else { return delays };
    // Half a period on average until a task reads a new value.
    note("position task", drive.position_rate().period() / 2.0);
    note("velocity task", drive.velocity_rate().period() / 2.0);
    note("velocity filter", drive.velocity_filter_time);
    if let Some((_, rate)) = drive.current_loop() {
        // A period for the computation, half a period until the middle of the voltage pulse.
        note("current loop", 1.5 * rate.period());
    }
    delays
}
