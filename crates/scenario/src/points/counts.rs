//! Counts of a drive in the heading of a table.
use super::Column;
use crate::quantity::Scale;
use servobench_base::Coordinate;

/// Counts of a drive.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Counts {
    /// Counts per metre or radian; negative if they count against the axis.
    pub per: f64,
    /// Kind of the positions: lengths or angles.
    pub motion: Coordinate,
}

/// Unit of velocities in the points of drives.
const TENTHS: &str = "0.1 counts/s";

/// The scale of `unit`, if it is in counts, and the index of its quantity in the candidates of `column`; `None` for any other unit.
pub(super) fn read_unit(column: Column, unit: &str, counts: Option<Counts>) -> Option<Result<(Scale, usize), String>> {
    if !unit.contains("counts") {
        return None;
    }
    let expected = match column {
        Column::Time => return Some(Err(format!("write `{}`", column.proposal()))),
        Column::Position | Column::Step => "counts",
        Column::Velocity => "counts/s",
        Column::Acceleration => "counts/s2",
        Column::Jerk => "counts/s3",
        Column::Snap => "counts/s4",
    };
    let tens = if unit == expected {
        0
    } else if column == Column::Velocity && unit == TENTHS {
        -1
    } else {
        let or = if column == Column::Velocity { format!(", or `{TENTHS}` as drives take it") } else { String::new() };
        return Some(Err(format!("write `{expected}`{or}")));
    };
    let Some(Counts { per, motion }) = counts else {
        let unknown = "the size of a count on the axis is unknown: give --counts to `servobench plan`, or `units` to the `[bus]` \
                       of a scenario";
        return Some(Err(unknown.to_owned()));
    };
    Some(Ok((Scale::per(per, tens), usize::from(motion == Coordinate::Rotary))))
}
