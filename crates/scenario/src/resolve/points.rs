//! A table of points, and how it is followed.
use crate::diagnostic::{NamedFile, Report};
use crate::field::Slot;
use crate::file::{FollowRule, TableOfPoints, VelocityRule};
use crate::models::read_beside;
use crate::points::{PointsError, read_points};
use crate::resolve::refuse;
use crate::scenario::{Follow, TableMove, Velocities};
use crate::source::{At, Sources};
use servobench_base::Coordinate;

/// Passes of smoothing unless something is said: what the source of the formulas shows.
const PASSES: u32 = 2;
/// Share of a segment in which the velocity of plateaus changes, unless something is said.
pub(super) const PLATEAU_SHARE: f64 = 0.25;

pub(super) fn resolve(table: &At<TableOfPoints>, sources: &Sources, report: &mut Report) -> Option<TableMove> {
    let own = &table.value;
    let velocities = velocities(own, report);
    let follow = follow(own, report);
    let is_relative = own.relative.optional().ok()?.copied().unwrap_or(false);
    let points = points(own, sources, report);
    Some(TableMove { points: points?, is_relative, velocities: velocities?, follow: follow? })
}

/// The points of the file: time, position, velocity.
fn points(own: &TableOfPoints, sources: &Sources, report: &mut Report) -> Option<Vec<(f64, f64, Option<f64>)>> {
    let file = own.file.at()?;
    let points = read(file, "positions", sources, report, |text| {
        let points = read_points(text)?;
        Ok((points.motion, points))
    })?;
    let velocity = |i: usize| points.velocities.as_ref().and_then(|all| all[i]);
    let both = points.times.iter().zip(&points.positions).enumerate();
    Some(both.map(|(i, (t, x))| (*t, *x, velocity(i))).collect())
}

/// What `read` makes of the text of `file`, when it is for an axis of this kind; `values` are its values in words.
pub(super) fn read<T>(
    file: &At<String>,
    values: &str,
    sources: &Sources,
    report: &mut Report,
    read: impl FnOnce(&str) -> Result<(Coordinate, T), PointsError>,
) -> Option<T> {
    let place = sources.place(file.span.source)?;
    let (path, text) = match read_beside(&file.value, place) {
        Ok(found) => found,
        Err(why) => {
            report.error(file.span, why, "the path is relative to this file");
            return None;
        }
    };
    let found = NamedFile { named: file.value.clone(), text: text.clone() };
    if !report.tables.contains(&found) {
        report.tables.push(found);
    }
    let (motion, table) = match read(&text) {
        Ok(read) => read,
        Err(error) => {
            report.error(file.span, format!("{}:{error}", path.display()), "");
            return None;
        }
    };
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
    let rule = own.velocities.optional().ok()?.copied().unwrap_or(VelocityRule::Given);
    if rule != VelocityRule::Smooth {
        refuse(&[("passes", own.passes.span())], "is for velocities that are \"smooth\"", "", report);
    }
    Some(match rule {
        VelocityRule::Given => Velocities::Given,
        VelocityRule::Average => Velocities::Average,
        VelocityRule::Smooth => Velocities::Smooth(own.passes.optional().ok()?.copied().unwrap_or(PASSES)),
        VelocityRule::Continuous => Velocities::Continuous,
    })
}

fn follow(own: &TableOfPoints, report: &mut Report) -> Option<Follow> {
    let rule = own.follow.optional().ok()?.copied().unwrap_or(FollowRule::Segments);
    let (share, rate) = (("plateau_share", own.plateau_share.span()), ("command_rate", own.command_rate.span()));
    if rule != FollowRule::Plateaus {
        refuse(&[share], "is for a table that is followed by \"plateaus\"", "", report);
    }
    if rule != FollowRule::Steps {
        refuse(&[rate], "is for a table that is followed by \"steps\"", "", report);
    }
    if rule != FollowRule::Segments {
        let help = "position profiles choose their velocities themselves";
        refuse(
            &[("velocities", own.velocities.span())],
            "is for a table that is followed by \"segments\"",
            help,
            report,
        );
    }
    match rule {
        FollowRule::Segments => Some(Follow::Segments),
        FollowRule::Plateaus => {
            Some(Follow::Plateaus(own.plateau_share.optional().ok()?.copied().unwrap_or(PLATEAU_SHARE)))
        }
        FollowRule::Steps => {
            if matches!(own.command_rate, Slot::Absent) {
                let help = "how often a velocity is sent; `servobench plan` finds the lowest for an allowed error";
                report.missing_with_help("table", "command_rate", own.span, help);
            }
            Some(Follow::Steps(*own.command_rate.given()?))
        }
    }
}
