//! Steps of a program that a mode of operation can carry out when the drive generates the profile.
use crate::diagnostic::Report;
use crate::scenario::{BusMode, Step};
use crate::source::Span;
use servobench_motion::online::Target;
use servobench_planner::{Filter, Follow, Generator, Method, Replanning, Request, TableMove};

/// Refuses the step at `span` if a drive in `mode` cannot carry it out.
pub(super) fn refuse_step(mode: BusMode, step: &Step, span: Span, report: &mut Report) {
    let Step::Move(step) = step else { return };
    let generator = &step.request.generator;
    let (is_carried, name, carries) = match mode {
        BusMode::CyclicPosition | BusMode::CyclicVelocity => return,
        BusMode::ProfilePosition => {
            let goes = matches!(
                generator,
                Generator::PointToPoint(_) | Generator::Replanning(Replanning { target: Target::Position { .. }, .. })
            );
            (goes, "pp", "`move_to` and `move_by`")
        }
        BusMode::ProfileVelocity => {
            let goes = match generator {
                Generator::Replanning(Replanning { target: Target::Velocity(_), .. }) => true,
                Generator::Table(TableMove { follow, .. }) => *follow != Follow::Segments,
                Generator::Replanning(_) | Generator::PointToPoint(_) | Generator::Rockwell(_) => false,
            };
            (goes, "pv", "`reach_velocity`, and tables that are followed by \"plateaus\" or \"steps\"")
        }
        BusMode::InterpolatedPosition => {
            let goes = match generator {
                Generator::Table(TableMove { follow, .. }) => *follow == Follow::Segments,
                Generator::PointToPoint(_) | Generator::Rockwell(_) => true,
                Generator::Replanning(Replanning { target, .. }) => matches!(target, Target::Position { v: 0.0, .. }),
            };
            let does =
                "`move_to` and `move_by` to rest that abort nothing, and tables that are followed by \"segments\"";
            (goes && step.aborts_after.is_none(), "ip", does)
        }
    };
    if !is_carried {
        let message = format!("a drive in the mode \"{name}\" does not support this step");
        report.error(span, message, format!("it supports {carries}; \"csp\" supports every step"));
    } else if !is_sent_as_points(mode, generator) && is_planned_otherwise(&step.request) {
        let message = format!("a drive in the mode \"{name}\" plans the profile itself");
        report.error(span, message, "leave out `method`, samples, shaper, averages and `duration`, or write \"csp\"");
    }
}

/// True if the master plans the move and sends points of it.
const fn is_sent_as_points(mode: BusMode, generator: &Generator) -> bool {
    matches!(mode, BusMode::InterpolatedPosition) && !matches!(generator, Generator::Table(_))
}

/// True if the step contains keys for planning by a master.
fn is_planned_otherwise(request: &Request) -> bool {
    let Filter { shapers, averages } = &request.filter;
    let is_sampled = match &request.generator {
        Generator::PointToPoint(asked) => asked.grid.is_some() || asked.method != Method::Published,
        Generator::Replanning(_) | Generator::Rockwell(_) | Generator::Table(_) => false,
    };
    is_sampled || !shapers.is_empty() || averages.is_some() || request.duration.is_some()
}
