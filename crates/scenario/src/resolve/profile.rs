//! The tables of profile blocks.
use crate::diagnostic::Report;
use crate::file::TableOfPoints;
use crate::points::{PointsError, Profile, read_accelerations, read_velocities};
use crate::resolve::{points, refuse};
use crate::scenario::TableMove;
use crate::source::{At, Sources};

/// Positions, and how they are followed.
pub(super) fn positions(table: &At<TableOfPoints>, sources: &Sources, report: &mut Report) -> Option<TableMove> {
    points::resolve(table, sources, report)
}

/// Times (s) and velocities.
pub(super) fn velocities(table: &At<TableOfPoints>, sources: &Sources, report: &mut Report) -> Option<Vec<(f64, f64)>> {
    values(table, "velocities", read_velocities, sources, report)
}

/// Times (s) and accelerations.
pub(super) fn accelerations(
    table: &At<TableOfPoints>,
    sources: &Sources,
    report: &mut Report,
) -> Option<Vec<(f64, f64)>> {
    values(table, "accelerations", read_accelerations, sources, report)
}

fn values(
    table: &At<TableOfPoints>,
    words: &str,
    read: impl FnOnce(&str) -> Result<Profile, PointsError>,
    sources: &Sources,
    report: &mut Report,
) -> Option<Vec<(f64, f64)>> {
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
    Some(profile.times.into_iter().zip(profile.values).collect())
}
