//! The tables of profile blocks: times from the start of the profile, and positions, velocities or accelerations.
use crate::diagnostic::Report;
use crate::file::TableOfPoints;
use crate::points::{PointsError, Profile, read_accelerations, read_points, read_velocities};
use crate::resolve::points;
use crate::resolve::refuse;
use crate::source::{At, Sources};
use servobench_planner::{Follow, FollowKind, VelocitiesKind};
use servobench_plcopen::{Follow as ProfileFollow, Pair};

/// Positions.
pub(super) fn positions(table: &At<TableOfPoints>, sources: &Sources, report: &mut Report) -> Option<Vec<Pair>> {
    let file = table.value.file.at()?;
    let points = points::read(file, "positions", sources, report, |text| {
        let points = read_points(text)?;
        Ok((points.motion, points))
    })?;
    if points.velocities.is_some() {
        let message = "MC_PositionProfile chooses the velocities itself: the column `velocity` is not used";
        report.warning(file.span, message, "`end_velocity` is that at the last position");
    }
    pairs(file, &points.times, &points.positions, report)
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
        Ok((profile.motion, profile))
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

/// How the axis goes from position to position.
pub(super) fn follow(table: &At<TableOfPoints>, report: &mut Report) -> Option<ProfileFollow> {
    let own = &table.value;
    let way = "it goes along the cubic spline, or by \"plateaus\"";
    if let Some(at) = own.velocities.at().filter(|at| at.value != VelocitiesKind::Continuous) {
        report.error(at.span, "MC_PositionProfile does not choose its velocities so", way);
    }
    let others = [("passes", own.passes.span()), ("command_rate", own.command_rate.span())];
    refuse(&others, "is not for MC_PositionProfile", way, report);
    match own.follow.optional().ok()?.copied() {
        Some(FollowKind::Plateaus) => {
            refuse(&[("velocities", own.velocities.span())], "is not for \"plateaus\"", "leave it out", report);
            let share = own.plateau_share.optional().ok()?.copied().unwrap_or(Follow::PLATEAU_SHARE);
            Some(ProfileFollow::Plateaus(share))
        }
        rule => {
            if let (Some(FollowKind::Steps), Some(span)) = (rule, own.follow.span()) {
                report.error(span, "MC_PositionProfile does not follow its table so", way);
            }
            refuse(&[("plateau_share", own.plateau_share.span())], "is for \"plateaus\"", "", report);
            Some(ProfileFollow::Spline)
        }
    }
}
