//! The resolved scenario: derived gains, merged bodies, overridden models.
mod coupling;
mod files;
mod loops;
mod motor_effects;
mod motors;
mod moves;
mod sensors;
mod tables;

use servobench_base::{Coordinate, Dq, Setpoint};
use servobench_drive::current::{self, Gains, Tuning};
use servobench_drive::{Params, Stage, feedforward};
use servobench_metrics::{Limit, Name};
use servobench_motion::interpolate::Mode;
use servobench_motion::online::{DirectionalLimits, Effort, Sides, Target};
use servobench_motion::pvt::Knot;
use servobench_motion::rockwell::{Jerk, MaximumJerk, Move, Shape};
use servobench_motion::shape::Shaper;
use servobench_motion::{Limits, Order};
use servobench_planner::{
    Averages, CommandRate, Filter, Follow, Generator, Grid, Method, PointToPoint, Positioning, Replanning, Rockwell,
    Shaping, TableMove, Velocities,
};
use servobench_plant::{Body, Chain, Encoder, EngineName, IdealSource, SourceOutput, inverter, pmsm};
use servobench_scenario::*;
use std::f64::consts::{PI, TAU};
use std::path::Path;

fn scenario(text: &str) -> Scenario {
    parse("test.toml", text, None).unwrap_or_else(|e| panic!("{e}")).scenario
}

fn chain(scenario: &Scenario) -> &Chain {
    match &scenario.axis.mechanics {
        AxisMechanics::Bodies(chain) => chain,
        AxisMechanics::Mjcf(_) | AxisMechanics::InTheFmu => panic!("bodies"),
    }
}

fn bodies(scenario: &Scenario) -> &[Body] {
    chain(scenario).bodies()
}

/// The synchronous motor, its DC link and its current loop.
fn motor(scenario: &Scenario) -> (&pmsm::Params, f64, &current::Params) {
    match &scenario.actuator {
        Actuator::Pmsm { motor, dc_link, drive, .. } => (motor, *dc_link, drive.params.current_loop().unwrap().0),
        other => panic!("a synchronous motor, not {other:?}"),
    }
}

/// The ideal source and its gain as estimated by the drive.
fn source(scenario: &Scenario) -> (&IdealSource, f64) {
    match &scenario.actuator {
        Actuator::IdealSource { source, drive, .. } => match drive.params.stage {
            Stage::Direct { gain } => (source, gain),
            Stage::Current { .. } => panic!("a current loop"),
        },
        other => panic!("an ideal source, not {other:?}"),
    }
}

/// The samples of a move from rest to rest.
fn grid(step: &MoveStep) -> Grid {
    match step.request.generator {
        Generator::PointToPoint(PointToPoint { grid: Some(grid), .. }) => grid,
        _ => panic!("{step:?}"),
    }
}

fn drive(scenario: &Scenario) -> &Drive {
    scenario.actuator.drive().unwrap()
}

fn params(scenario: &Scenario) -> &Params {
    &drive(scenario).params
}

/// Equal up to a few roundings.
fn same(a: f64, b: f64) -> bool {
    (a - b).abs() <= 1e-14 * a.abs().max(b.abs())
}

const SCREW: &str = r#"
[run]
base_rate = "16 kHz"
[axis]
motion = "linear"
lead = "10 mm"
[axis.motor_side]
inertia = "1e-4 kg m2"
viscous = "1e-3 Nm s/rad"
coulomb = "0.05 Nm"
[axis.table]
mass = "30 kg"
viscous = "100 N s/m"
coulomb = "20 N"
static = "32 N"
stribeck_velocity = "2 mm/s"
bias = "9.81 N"
[axis.load]
mass = "10 kg"
stiffness = "2 N/um"
damping = "50 N s/m"
[motor]
model = "wittenstein-premo-1f"
encoder = { counts_per_rev = 1048576 }
[drive]
model = "servo-16khz"
load_encoder = { step = "0.1 um" }
position_feedback = "load"
"#;
