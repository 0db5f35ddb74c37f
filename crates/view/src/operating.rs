//! Operating points of a motor against its capability: effort over speed in its envelope, current in the circle of the drive, voltage in
//! the hexagon of the inverter, and effort over the angle.
use crate::plane::{Axis, Curve, Plane};
use crate::rerun::EntityPath;
use crate::run::{Run, range};
use crate::scale::Scale;
use crate::style;
use servobench_base::{Coordinate, Dq, ElectricalAngle};
use servobench_plant::pmsm::Bounds;
use servobench_signals::Signal;
use servobench_trace::envelope;
use servobench_view_request::MotorLimits;
use std::f64::consts::{FRAC_PI_3, TAU};

/// First parts of the entity paths of the planes.
const EFFORT_OVER_SPEED: &str = "effort_over_speed";
const CURRENT_PLANE: &str = "current_plane";
const VOLTAGE_PLANE: &str = "voltage_plane";
const EFFORT_OVER_ANGLE: &str = "effort_over_angle";
#[cfg(test)]
pub(crate) const PATHS: [&str; 4] = [EFFORT_OVER_SPEED, CURRENT_PLANE, VOLTAGE_PLANE, EFFORT_OVER_ANGLE];

/// Points of a bound.
const OF_A_BOUND: u32 = 240;
/// Factor by which an envelope extends beyond the fastest point of a run, or beyond its corner.
const BEYOND: f64 = 1.25;
/// Share of the standstill effort that the corner of an envelope still has.
const CORNER: f64 = 0.98;
/// Largest speed at which an envelope is searched (electrical, rad/s).
const FASTEST: f64 = 1e6;

/// The planes of `runs`, all on the motor of `limits`, with about `most` points of each run.
pub(crate) fn planes(runs: &[Run<'_>], limits: &MotorLimits, most: usize) -> Vec<Plane> {
    let all = [
        effort_over_speed(runs, limits, most),
        currents(runs, limits, most),
        voltages(runs, limits, most),
        over_angle(runs, limits, most),
    ];
    all.into_iter().flatten().collect()
}

fn effort_over_speed(runs: &[Run<'_>], limits: &MotorLimits, most: usize) -> Option<Plane> {
    let ratio = limits.motor.electrical_ratio;
    let of_runs = curves(runs, EFFORT_OVER_SPEED, |run| {
        let (speed, effort) =
            (run.recording.channel(Signal::MotorVelocity)?, run.recording.channel(Signal::EffortMotor)?);
        Some(strips(speed.len(), most, |k| [speed[k] / limits.transmission, effort[k]]))
    })?;
    let fastest = largest(&of_runs, 0);
    let bounds = limits.bounds;
    let standing = limits.motor.most_effort(bounds, 0.0)?.effort;
    let end = limits.motor.fastest_with(bounds, 0.0, FASTEST) / ratio;
    let corner = limits.motor.fastest_with(bounds, CORNER * standing.min(limits.effort), FASTEST) / ratio;
    let to = (BEYOND * fastest.max(corner)).min(end);
    let given = |speed: f64| limits.motor.most_effort(bounds, ratio * speed).map(|most| most.effort.min(limits.effort));
    // From standstill in both directions, driving and braking: it ends at the motor's largest speed, or beyond the speeds of all runs.
    let ways = [(1.0, 1.0), (1.0, -1.0), (-1.0, 1.0), (-1.0, -1.0)];
    let quarters = ways.map(|(way, side)| {
        let speeds = (0..=OF_A_BOUND).map(|k| way * to * f64::from(k) / f64::from(OF_A_BOUND));
        speeds.filter_map(|speed| Some([speed, side * given(side * speed)?])).collect()
    });
    let envelope = bound(&[EFFORT_OVER_SPEED, "envelope"], "most that motor and drive give", quarters.to_vec());
    let motion = limits.motion;
    Some(Plane {
        title: format!("{} over speed", effort_name(motion)),
        path: EntityPath::from(EFFORT_OVER_SPEED),
        axes: [speed_axis(motion), effort_axis(motion)],
        is_isometric: false,
        curves: [vec![envelope], of_runs].concat(),
    })
}

fn currents(runs: &[Run<'_>], limits: &MotorLimits, most: usize) -> Option<Plane> {
    let of_runs = curves(runs, CURRENT_PLANE, |run| {
        let (d, q) = (run.recording.channel(Signal::CurrentD)?, run.recording.channel(Signal::CurrentQ)?);
        Some(strips(d.len(), most, |k| [d[k], q[k]]))
    })?;
    let Bounds { current, .. } = limits.bounds;
    let mut bounds = Vec::new();
    if current.is_finite() {
        bounds.push(bound(&[CURRENT_PLANE, "limit"], "largest current", vec![circle(current)]));
    }
    let scale = Scale { factor: 1.0, unit: "Apk".into() };
    Some(Plane {
        title: "Current in the rotor's frame: q over d (Apk)".into(),
        path: EntityPath::from(CURRENT_PLANE),
        axes: [Axis { name: "d", scale: scale.clone() }, Axis { name: "q", scale }],
        is_isometric: true,
        curves: [bounds, of_runs].concat(),
    })
}

fn voltages(runs: &[Run<'_>], limits: &MotorLimits, most: usize) -> Option<Plane> {
    let of_runs = curves(runs, VOLTAGE_PLANE, |run| {
        let [d, q] = [Signal::VoltageD, Signal::VoltageQ].map(|signal| run.recording.channel(signal));
        let [position, velocity] =
            [Signal::MotorPosition, Signal::MotorVelocity].map(|signal| run.recording.channel(signal));
        let (d, q, position, velocity) = (d?, q?, position?, velocity?);
        let half_a_tick = 0.5 * run.recording.rate.period();
        let in_the_stator = |k: usize| {
            // The voltage applies to the middle of a tick.
            let motor = (position[k] + half_a_tick * velocity[k]) / limits.transmission;
            let angle = ElectricalAngle::from_mechanical(motor, limits.motor.electrical_ratio);
            let voltage = Dq { d: d[k], q: q[k] }.to_alpha_beta(angle.rotation());
            [voltage.alpha, voltage.beta]
        };
        Some(strips(d.len(), most, in_the_stator))
    })?;
    let corner = |k: u32| {
        let (sin, cos) = (f64::from(k) * FRAC_PI_3).sin_cos();
        [cos, sin].map(|part| 2.0 / 3.0 * limits.dc_link * part)
    };
    // From the middle of its lower side, where its name has room.
    let start = [0.0, -limits.dc_link / 3_f64.sqrt()];
    let hexagon = vec![std::iter::once(start).chain((5..=10).map(corner)).chain([start]).collect()];
    let scale = Scale { factor: 1.0, unit: "Vpk".into() };
    Some(Plane {
        title: "Voltage in the stator's frame: β over α (Vpk)".into(),
        path: EntityPath::from(VOLTAGE_PLANE),
        axes: [Axis { name: "α", scale: scale.clone() }, Axis { name: "β", scale }],
        is_isometric: true,
        curves: [
            vec![
                bound(&[VOLTAGE_PLANE, "hexagon"], "hexagon of the DC link", hexagon),
                bound(&[VOLTAGE_PLANE, "circle"], "circle: in every direction", vec![circle(limits.bounds.voltage)]),
            ],
            of_runs,
        ]
        .concat(),
    })
}

/// Effort over the angle within a turn of the motor, or within two poles of a linear one.
fn over_angle(runs: &[Run<'_>], limits: &MotorLimits, most: usize) -> Option<Plane> {
    let period = match limits.motion {
        Coordinate::Rotary => TAU,
        Coordinate::Linear => TAU / limits.motor.electrical_ratio,
    };
    let of_runs = curves(runs, EFFORT_OVER_ANGLE, |run| {
        let (position, effort) =
            (run.recording.channel(Signal::MotorPosition)?, run.recording.channel(Signal::EffortMotor)?);
        let (low, high) = range(position)?;
        if (high - low) / limits.transmission.abs() < period {
            return None;
        }
        let turn = |k: usize| (position[k] / limits.transmission / period).floor();
        let angle = |k: usize| position[k] / limits.transmission - turn(k) * period;
        let all = strips(position.len(), most, |k| [angle(k), effort[k]]);
        // A line does not cross the plane backwards where a turn ends.
        let is_whole = |pair: &[f64; 2], next: &[f64; 2]| (pair[0] - next[0]).abs() < 0.5 * period;
        Some(all.iter().flat_map(|strip| strip.chunk_by(is_whole).map(<[_]>::to_vec)).collect())
    })?;
    let (name, scale) = match limits.motion {
        Coordinate::Rotary => ("angle of the motor", Scale { factor: 1_f64.to_degrees(), unit: "°".into() }),
        Coordinate::Linear => ("place within a pole pair", Scale::for_peak("m", period)),
    };
    Some(Plane {
        title: format!("{} over {}", effort_name(limits.motion), scale.title(name)),
        path: EntityPath::from(EFFORT_OVER_ANGLE),
        axes: [Axis { name, scale }, effort_axis(limits.motion)],
        is_isometric: false,
        curves: of_runs,
    })
}

fn speed_axis(motion: Coordinate) -> Axis {
    let scale = match motion {
        Coordinate::Rotary => Scale { factor: 60.0 / TAU, unit: "rpm".into() },
        Coordinate::Linear => Scale { factor: 1.0, unit: "m/s".into() },
    };
    Axis { name: "speed", scale }
}

fn effort_axis(motion: Coordinate) -> Axis {
    let unit = match motion {
        Coordinate::Rotary => "N·m",
        Coordinate::Linear => "N",
    };
    Axis { name: "effort", scale: Scale { factor: 1.0, unit: unit.into() } }
}

const fn effort_name(motion: Coordinate) -> &'static str {
    match motion {
        Coordinate::Rotary => "Torque",
        Coordinate::Linear => "Force",
    }
}

/// A curve for each run that has one; `None` where none has.
fn curves(
    runs: &[Run<'_>],
    plane: &str,
    strips: impl Fn(&Run<'_>) -> Option<Vec<Vec<[f64; 2]>>>,
) -> Option<Vec<Curve>> {
    let all = runs.iter().enumerate().filter_map(|(index, run)| {
        let strips = strips(run)?;
        let colour = run.label.map_or(style::MOTOR, |_| style::of_run(index));
        let label = run.label.map(str::to_owned);
        (!strips.is_empty()).then(|| Curve { path: run.path(&[plane, "run"]), label, colour, width: 1.5, strips })
    });
    let all: Vec<Curve> = all.collect();
    (!all.is_empty()).then_some(all)
}

/// `count` points in lines that end at non-finite values. Of more than `most` points the extremes of both quantities stay, each at its
/// place, so that no ripple is lost.
fn strips(count: usize, most: usize, point: impl Fn(usize) -> [f64; 2]) -> Vec<Vec<[f64; 2]>> {
    let points: Vec<[f64; 2]> = (0..count).map(point).collect();
    let extremes = |axis: usize| envelope(&points.iter().map(|point| point[axis]).collect::<Vec<f64>>(), most / 4);
    let mut kept = [extremes(0), extremes(1)].concat();
    kept.sort_unstable();
    kept.dedup();
    let kept: Vec<[f64; 2]> = kept.into_iter().map(|index| points[index]).collect();
    let is_finite = |point: &[f64; 2]| point.iter().all(|value| value.is_finite());
    kept.split(|point| !is_finite(point)).filter(|line| line.len() > 1).map(<[_]>::to_vec).collect()
}

fn bound(path: &[&str], label: &str, strips: Vec<Vec<[f64; 2]>>) -> Curve {
    let path = EntityPath::from(path.join("/"));
    Curve { path, label: Some(label.to_owned()), colour: style::LIMIT, width: 1.5, strips }
}

fn circle(radius: f64) -> Vec<[f64; 2]> {
    (0..=OF_A_BOUND)
        .map(|k| (TAU * f64::from(k) / f64::from(OF_A_BOUND)).sin_cos())
        .map(|(sin, cos)| [radius * sin, radius * cos])
        .collect()
}

/// The largest magnitude of all points on an axis.
fn largest(curves: &[Curve], axis: usize) -> f64 {
    let points = curves.iter().flat_map(|curve| curve.strips.iter().flatten());
    points.map(|point| point[axis].abs()).fold(0.0, f64::max)
}
