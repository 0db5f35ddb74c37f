//! A table of points, and the method by which it is followed.
use crate::access::Refused;
use crate::diagnostic::Report;
use crate::field::Slot;
use crate::file::TableOfPoints;
use crate::list::Automatic;
use crate::models::read_beside;
use crate::points::{MOST_POINTS, Points, PointsError, read_points_in};
use crate::resolve::refuse;
use crate::source::{At, Sources};
use servobench_base::Coordinate;
use servobench_files::FileRole;
use servobench_motion::position_profile::PlateauShare;
use servobench_motion::pvt::Knot;
use servobench_planner::{CommandRate, Follow, FollowKind, Positioning, TableMove, Velocities, VelocitiesKind};

/// The move, and the origin of its positions; `limits` are velocity and acceleration, needed if [`chooses_by_limits`].
pub(super) fn resolve(
    table: &At<TableOfPoints>,
    limits: Option<[f64; 2]>,
    sources: &Sources,
    report: &mut Report,
) -> Option<(TableMove, Positioning)> {
    let own = &table.value;
    let velocities = velocities(own, report);
    let follow = follow(own, limits, report);
    let is_relative = own.relative.optional().ok()?.copied().unwrap_or(false);
    let points = points(own, sources, report);
    let is_relative = is_relative || points.as_ref().is_some_and(|points| points.is_relative);
    let positioning = if is_relative { Positioning::Relative } else { Positioning::Absolute };
    Some((TableMove { knots: knots(&points?), velocities: velocities?, follow: follow? }, positioning))
}

/// True if the method depends on limits of velocity and acceleration.
pub(super) fn chooses_by_limits(table: &TableOfPoints) -> bool {
    matches!(table.plateau_share.given(), Some(Automatic::Auto))
}

/// The points of the file, in lengths, angles or counts of the bus.
pub(super) fn points(own: &TableOfPoints, sources: &Sources, report: &mut Report) -> Option<Points> {
    let (file, counts) = (own.file.at()?, report.counts);
    let points = read(file, "positions", sources, report, |text| {
        let points = read_points_in(counts, text)?;
        Ok((points.motion, points.times.len(), points))
    })?;
    if points.is_relative
        && let Some(At { value: false, span }) = own.relative.at()
    {
        report.error(*span, "a table of steps counts from where the axis is", "leave `relative` out");
    }
    Some(points)
}

fn knots(points: &Points) -> Vec<Knot> {
    let velocity = |i: usize| points.velocities.as_ref().and_then(|all| all[i]);
    let both = points.times.iter().zip(&points.positions).enumerate();
    both.map(|(i, (t, x))| Knot { t: *t, x: *x, v: velocity(i) }).collect()
}

/// Result of `read` for the text of `file`, if it fits the coordinate of the axis; `values` names its values in words.
pub(super) fn read<T>(
    file: &At<String>,
    values: &str,
    sources: &Sources,
    report: &mut Report,
    read: impl FnOnce(&str) -> Result<(Coordinate, usize, T), PointsError>,
) -> Option<T> {
    let place = sources.place(file.span.source)?;
    let (path, text) = match read_beside(&file.value, FileRole::Table, place, &mut report.files) {
        Ok(found) => found,
        Err(Refused { message, help }) => {
            report.error(file.span, message, help);
            return None;
        }
    };
    report.note_table(&file.value, &text);
    let (motion, points, table) = match read(&text) {
        Ok(read) => read,
        Err(error) => {
            report.error(file.span, format!("{}:{error}", path.display()), "");
            return None;
        }
    };
    report.points = report.points.saturating_add(points);
    if report.points > MOST_POINTS {
        let message = format!("with this table the scenario has {} points, it may have {MOST_POINTS}", report.points);
        report.error(file.span, message, "use fewer or shorter tables, or several scenarios");
        return None;
    }
    if let Some(axis) = report.axis.filter(|axis| *axis != motion) {
        let (is, needs) = match axis {
            Coordinate::Linear => ("angles", "lengths"),
            Coordinate::Rotary => ("lengths", "angles"),
        };
        let message = format!("the {values} in {} are {is}, this axis needs {needs}", path.display());
        report.error(file.span, message, "change the units of its heading");
        return None;
    }
    Some(table)
}

fn velocities(own: &TableOfPoints, report: &mut Report) -> Option<Velocities> {
    let kind = own.velocities.optional().ok()?.copied().unwrap_or_default();
    if kind != VelocitiesKind::Smooth {
        refuse(&[("passes", own.passes.span())], "is for velocities that are \"smooth\"", "", report);
    }
    Some(match kind {
        VelocitiesKind::Given => Velocities::Given,
        VelocitiesKind::Average => Velocities::Average,
        VelocitiesKind::Smooth => {
            Velocities::Smooth { passes: own.passes.optional().ok()?.copied().unwrap_or(Velocities::PASSES) }
        }
        VelocitiesKind::Continuous => Velocities::Continuous,
    })
}

fn follow(own: &TableOfPoints, limits: Option<[f64; 2]>, report: &mut Report) -> Option<Follow> {
    let kind = own.follow.optional().ok()?.copied().unwrap_or_default();
    let (share, rate) = (("plateau_share", own.plateau_share.span()), ("command_rate", own.command_rate.span()));
    if kind != FollowKind::Plateaus {
        refuse(&[share], "is for a table that is followed by \"plateaus\"", "", report);
    }
    if kind != FollowKind::Steps {
        refuse(&[rate], "is for a table that is followed by \"steps\"", "", report);
    }
    if kind != FollowKind::Segments {
        let help = "position profiles choose their velocities themselves";
        refuse(
            &[("velocities", own.velocities.span())],
            "is for a table that is followed by \"segments\"",
            help,
            report,
        );
    }
    match kind {
        FollowKind::Segments => Some(Follow::Segments),
        FollowKind::Plateaus => {
            let share = match own.plateau_share.optional().ok()? {
                None => PlateauShare::Given(Follow::PLATEAU_SHARE),
                Some(Automatic::Given(share)) => PlateauShare::Given(*share),
                Some(Automatic::Auto) => {
                    let [velocity, acceleration] = limits?;
                    PlateauShare::SmallestPartOf { velocity, acceleration }
                }
            };
            Some(Follow::Plateaus { share })
        }
        FollowKind::Steps => {
            if matches!(own.command_rate, Slot::Absent) {
                let help = "how often a velocity is sent; `servobench plan` finds the lowest for an allowed error";
                report.missing_with_help("table", "command_rate", own.span, help);
            }
            Some(Follow::Steps { rate: CommandRate::Given(*own.command_rate.given()?) })
        }
    }
}
