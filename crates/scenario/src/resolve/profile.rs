//! The tables of profile blocks.
use crate::diagnostic::Report;
use crate::file::TableOfPoints;
use crate::points::{Column, read_profile};
use crate::resolve::{points, refuse};
use crate::scenario::TableMove;
use crate::source::{At, Sources};

/// Positions, and how they are followed.
pub(super) fn positions(table: &At<TableOfPoints>, sources: &Sources, report: &mut Report) -> Option<TableMove> {
    points::resolve(table, sources, report)
}

/// Times (s) and velocities.
pub(super) fn velocities(table: &At<TableOfPoints>, sources: &Sources, report: &mut Report) -> Option<Vec<(f64, f64)>> {
    values(table, Column::Velocity, sources, report)
}

/// Times (s) and accelerations.
pub(super) fn accelerations(
    table: &At<TableOfPoints>,
    sources: &Sources,
    report: &mut Report,
) -> Option<Vec<(f64, f64)>> {
    values(table, Column::Acceleration, sources, report)
}

fn values(
    table: &At<TableOfPoints>,
    column: Column,
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
    let words = if column == Column::Velocity { "velocities" } else { "accelerations" };
    let profile = points::read(file, words, sources, report, |text| {
        let profile = read_profile(text, column)?;
        Ok((profile.motion, profile))
    })?;
    Some(profile.times.into_iter().zip(profile.values).collect())
}
