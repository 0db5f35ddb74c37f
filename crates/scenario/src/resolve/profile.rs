//! The tables of profile blocks: times from the start of the profile, and positions, velocities or accelerations.
use crate::diagnostic::Report;
use crate::file::TableOfPoints;
use crate::list::Automatic;
use crate::points::{PointsError, Profile, read_accelerations, read_velocities};
use crate::resolve::points;
use crate::resolve::refuse;
use crate::source::{At, Sources};
use servobench_planner::{Follow, FollowKind, Positioning, VelocitiesKind};
use servobench_plcopen::{Follow as ProfileFollow, Pair};

/// Positions, and their origin.
pub(super) fn positions(
    table: &At<TableOfPoints>,
    sources: &Sources,
    report: &mut Report,
) -> Option<(Vec<Pair>, Positioning)> {
    let file = table.value.file.at()?;
    let points = points::points(&table.value, sources, report)?;
    let is_relative = points.is_relative || table.value.relative.optional().ok()?.copied().unwrap_or(false);
    if points.velocities.is_some() {
        let message = "MC_PositionProfile chooses the velocities itself: the column `velocity` is not used";
        report.warning(file.span, message, "`end_velocity` is that at the last position");
    }
    let positioning = if is_relative { Positioning::Relative } else { Positioning::Absolute };
    Some((pairs(file, &points.times, &points.positions, report)?, positioning))
}

/// Velocities.
pub(super) fn velocities(table: &At<TableOfPoints>, sources: &Sources, report: &mut Report) -> Option<Vec<Pair>> {
    values(table, "velocities", read_velocities, sources, report)
}

/// Accelerations.
pub(super) fn accelerations(table: &At<TableOfPoints>, sources: &Sources, report: &mut Report) -> Option<Vec<Pair>> {
    values(table, "accelerations", read_accelerations, sources, report)
}

fn values(
    table: &At<TableOfPoints>,
    words: &str,
    read: impl FnOnce(&str) -> Result<Profile, PointsError>,
    sources: &Sources,
    report: &mut Report,
) -> Option<Vec<Pair>> {
    let own = &table.value;
    let of_positions = [
        ("relative", own.relative.span()),
        ("velocities", own.velocities.span()),
        ("passes", own.passes.span()),
        ("follow", own.follow.span()),
        ("plateau_share", own.plateau_share.span()),
        ("command_rate", own.command_rate.span()),
    ];
    refuse(&of_positions, "is for a table of positions", "", report);
    let file = own.file.at()?;
    let profile = points::read(file, words, sources, report, |text| {
        let profile = read(text)?;
        Ok((profile.motion, profile.times.len(), profile))
    })?;
    pairs(file, &profile.times, &profile.values, report)
}

/// The pairs of a table with increasing times.
fn pairs(file: &At<String>, times: &[f64], values: &[f64], report: &mut Report) -> Option<Vec<Pair>> {
    if let Some(first) = times.first().filter(|first| **first < 0.0) {
        let message = format!("the table begins at {first} s, before the profile");
        report.error(file.span, message, "its times count from the start of the profile");
        return None;
    }
    let before = std::iter::once(&0.0).chain(times);
    let both = times.iter().zip(before).zip(values);
    Some(both.map(|((time, before), value)| Pair { delta_time: time - before, value: *value }).collect())
}

/// The method by which an axis follows positions; `is_told_velocities` is true if the drive receives velocities instead of positions.
pub(super) fn follow(
    table: &At<TableOfPoints>,
    is_told_velocities: bool,
    report: &mut Report,
) -> Option<ProfileFollow> {
    let own = &table.value;
    let way = if is_told_velocities {
        "it follows the cubic spline, by \"plateaus\", or by \"steps\" along the spline"
    } else {
        "it follows the cubic spline, or by \"plateaus\"; by \"steps\" over a bus with `mode = \"pv\"`"
    };
    if let Some(at) = own.velocities.at().filter(|at| at.value != VelocitiesKind::Continuous) {
        report.error(at.span, "MC_PositionProfile does not choose its velocities by this rule", way);
    }
    refuse(&[("passes", own.passes.span())], "is not for MC_PositionProfile", way, report);
    let kind = own.follow.optional().ok()?.copied();
    let steps = is_told_velocities && kind == Some(FollowKind::Steps);
    if !steps {
        refuse(
            &[("command_rate", own.command_rate.span())],
            "is for a table that is followed by \"steps\"",
            way,
            report,
        );
    }
    match kind {
        Some(FollowKind::Plateaus) => {
            refuse(&[("velocities", own.velocities.span())], "is not for \"plateaus\"", "leave it out", report);
            Some(ProfileFollow::Plateaus(match own.plateau_share.optional().ok()? {
                None => Some(Follow::PLATEAU_SHARE),
                Some(Automatic::Given(share)) => Some(*share),
                Some(Automatic::Auto) => None,
            }))
        }
        Some(FollowKind::Steps) if is_told_velocities => {
            refuse(&[("plateau_share", own.plateau_share.span())], "is for \"plateaus\"", "", report);
            // One velocity per cycle, or the given lower rate.
            Some(own.command_rate.optional().ok()?.map_or(ProfileFollow::Spline, |rate| ProfileFollow::Steps(*rate)))
        }
        rule => {
            if let (Some(FollowKind::Steps), Some(span)) = (rule, own.follow.span()) {
                report.error(span, "MC_PositionProfile does not follow its table by this method", way);
            }
            refuse(&[("plateau_share", own.plateau_share.span())], "is for \"plateaus\"", "", report);
            Some(ProfileFollow::Spline)
        }
    }
}
