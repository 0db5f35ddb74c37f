//! The move as points: as a table, and as the words sent to a drive.
use super::mistake::PlanMistake;
use super::quantity::{Axis, AxisQuantity, COUNTS, Counts, POSITION, positive_time};
use crate::args::{choice, file};
use clap::Args;
use servobench_fieldbus::trajectory::PointTransfer;
use servobench_report::{PlannedMove, PointChoice, Unsent};
use std::path::PathBuf;

/// Heading of what makes points of a move.
#[derive(Debug, Args)]
#[command(next_help_heading = "Points of the move (PVT)")]
pub(crate) struct PointArgs {
    /// Write time, position and velocity at points of the move (SI), as --points reads them.
    #[arg(long, value_name = "FILE", value_parser = file(), global = true)]
    pub(super) pvt: Option<PathBuf>,
    /// Time from point to point [default: 10 ms, those of a table its own].
    #[arg(long, value_name = "TIME", value_parser = positive_time, global = true)]
    point_time: Option<f64>,
    /// Or the longest one, of whole milliseconds up to 255, with which the way through the points stays so near to the move, as
    /// "10 um".
    #[arg(long, value_name = "DISTANCE", value_parser = POSITION, conflicts_with = "point_time", global = true)]
    allowed_deviation: Option<AxisQuantity>,
    /// Write the points as a drive is sent them, in hexadecimal digits with what they mean.
    #[arg(long, value_name = "FILE", value_parser = file(), requires = "counts", global = true)]
    pub(super) words: Option<PathBuf>,
    /// Object or serial parameter that takes the words.
    #[arg(long, value_parser = choice::<PointTransfer>(), requires = "words", global = true)]
    trajectory_buffer: Option<PointTransfer>,
    /// Counts of the drive, as "1048576/rev" or "10000/5 mm", of --words and of a table in counts; below zero if it
    /// counts against the axis.
    #[arg(long, value_name = "COUNTS", value_parser = COUNTS, allow_hyphen_values = true, global = true)]
    counts: Option<Counts>,
}

/// Requested points.
#[derive(Debug)]
pub(super) struct AskedPoints {
    choice: PointChoice,
    sent: Option<(PointTransfer, f64)>,
}

impl PointArgs {
    /// Counts of the drive.
    pub(super) fn counts(&self) -> Option<servobench_scenario::Counts> {
        self.counts.as_ref().map(Counts::of_axis)
    }

    /// True if counts are given but not used; a table may use them.
    pub(super) const fn has_unused_counts(&self, is_table: bool) -> bool {
        self.counts.is_some() && self.words.is_none() && !is_table
    }

    /// The requested points, if any.
    pub(super) fn asked(&self, axis: &mut Axis) -> Option<AskedPoints> {
        let Self { pvt, point_time, allowed_deviation, words, trajectory_buffer, counts } = self;
        let counts = counts.as_ref().map(|counts| axis.counts(counts));
        // Read in its own unit, which positions do not take over.
        let choice = match (point_time, allowed_deviation) {
            (Some(time), _) => PointChoice::Every(*time),
            (None, Some(allowed)) => PointChoice::FewestWithin(axis.value(allowed)),
            (None, None) => PointChoice::Own,
        };
        let sent = words.as_ref().and(counts).map(|counts| (trajectory_buffer.unwrap_or_default(), counts));
        let is_asked = pvt.is_some() || words.is_some() || choice != PointChoice::Own;
        is_asked.then_some(AskedPoints { choice, sent })
    }
}

impl AskedPoints {
    /// `planned` with its points.
    pub(super) fn of(&self, planned: PlannedMove) -> Result<PlannedMove, PlanMistake> {
        let planned = planned.in_points(self.choice).map_err(PlanMistake::Refused)?;
        match self.sent {
            Some((transfer, counts)) => planned.sent_by(transfer, counts).map_err(|error| match error {
                Unsent::Plan(error) => PlanMistake::Refused(error),
                error => PlanMistake::Unsent(error),
            }),
            None => Ok(planned),
        }
    }
}
