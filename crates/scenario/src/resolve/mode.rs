//! Which steps of a program a mode of operation can carry in which the drive makes the way itself.
use crate::diagnostic::Report;
use crate::scenario::{BusMode, Filter, Follow, Goal, Method, MoveStep, OnlineMove, Step, TableMove, Way};
use crate::source::Span;

/// Objects to the step at `span` when a drive in `mode` cannot do it.
pub(super) fn refuse_step(mode: BusMode, step: &Step, span: Span, report: &mut Report) {
    let Step::Move(step) = step else { return };
    let (is_carried, name, carries) = match mode {
        BusMode::CyclicPosition | BusMode::CyclicVelocity => return,
        BusMode::ProfilePosition => {
            let goes = matches!(step.way, Way::Rest(_) | Way::Online(OnlineMove { goal: Goal::Position(..), .. }));
            (goes, "pp", "`move_to` and `move_by`")
        }
        BusMode::ProfileVelocity => {
            let goes = match &step.way {
                Way::Online(OnlineMove { goal: Goal::Velocity(..), .. }) => true,
                Way::Table(TableMove { follow, .. }) => *follow != Follow::Segments,
                Way::Online(_) | Way::Rest(_) | Way::Rockwell(_) => false,
            };
            (goes, "pv", "`reach_velocity`, and tables that are followed by \"plateaus\" or \"steps\"")
        }
        BusMode::InterpolatedPosition => {
            let goes = matches!(step.way, Way::Table(TableMove { follow: Follow::Segments, .. }));
            (goes, "ip", "tables that are followed by \"segments\"")
        }
    };
    if !is_carried {
        let message = format!("a drive in the mode \"{name}\" cannot do this step");
        report.error(span, message, format!("it does {carries}; \"csp\" does everything"));
    } else if is_planned_otherwise(step) {
        let message = format!("a drive in the mode \"{name}\" plans the way itself");
        report.error(span, message, "leave out `method`, samples, shaper, averages and `duration`, or write \"csp\"");
    }
}

/// Whether the step says how a master is to plan it.
fn is_planned_otherwise(step: &MoveStep) -> bool {
    let Filter { shaper, averages } = &step.filter;
    let is_sampled = match &step.way {
        Way::Rest(rest) => rest.grid.is_some() || rest.method != Method::Published,
        Way::Online(_) | Way::Rockwell(_) | Way::Table(_) => false,
    };
    is_sampled || shaper.is_some() || !averages.is_empty() || step.duration.is_some()
}
