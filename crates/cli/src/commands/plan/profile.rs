//! The profiles of a plan: a subcommand each, and without one the move from point to point.
use super::mistake::PlanMistake;
use super::point_to_point::PointToPointArgs;
use super::quantity::Axis;
use super::rockwell::RockwellArgs;
use super::table::{PositionArgs, PvtArgs};
use clap::{ArgMatches, Args, Command, FromArgMatches, Subcommand};
use servobench_motion::online::Sides;
use servobench_planner::{Filter, Generator, Request};
use servobench_scenario::Counts;
use std::path::Path;

/// Profile of a plan.
#[derive(Debug)]
pub(crate) enum Profile {
    /// Order 2, 3 or 4; from rest to rest, or from a state of motion.
    PointToPoint(Box<PointToPointArgs>),
    Named(NamedProfile),
}

#[derive(Debug, Subcommand)]
pub(crate) enum NamedProfile {
    /// Trapezoid or S-curve by the operands of Rockwell's axis move.
    #[command(after_help = ROCKWELL_EXAMPLE)]
    Rockwell(Box<RockwellArgs>),
    /// Through positions, times and, if given, velocities of a table.
    #[command(after_help = PVT_EXAMPLE)]
    Pvt(Box<PvtArgs>),
    /// Through a table by velocity commands, which a drive follows as they are.
    #[command(after_help = POSITION_EXAMPLE)]
    Position(Box<PositionArgs>),
}

const ROCKWELL_EXAMPLE: &str = "\
Example:
  servobench plan rockwell --distance \"100 mm\" --velocity \"0.2 m/s\"
      --acceleration \"10 m/s2\" --jerk-percent-of-time 25";

const PVT_EXAMPLE: &str = "\
Example:
  servobench plan pvt --points table.csv --velocities continuous

A table of points is a CSV file like
  time [ms],position [mm],velocity [mm/s]
  0,0,0
  10,5,750";

const POSITION_EXAMPLE: &str = "\
Example:
  servobench plan position --points table.csv --allowed-error \"10 um\"

A table of points is a CSV file like
  time [ms],position [mm]
  0,0
  10,5";

impl Args for Profile {
    fn augment_args(command: Command) -> Command {
        let command = NamedProfile::augment_subcommands(PointToPointArgs::augment_args(command));
        command.args_conflicts_with_subcommands(true).subcommand_negates_reqs(true)
    }

    fn augment_args_for_update(command: Command) -> Command {
        Self::augment_args(command)
    }
}

impl FromArgMatches for Profile {
    fn from_arg_matches(matches: &ArgMatches) -> Result<Self, clap::Error> {
        match matches.subcommand_name() {
            Some(_) => NamedProfile::from_arg_matches(matches).map(Self::Named),
            None => Box::from_arg_matches(matches).map(Self::PointToPoint),
        }
    }

    fn update_from_arg_matches(&mut self, matches: &ArgMatches) -> Result<(), clap::Error> {
        *self = Self::from_arg_matches(matches)?;
        Ok(())
    }
}

impl Profile {
    /// The requested move, in `duration` (s) if given, and its axis; a table may be in `counts`.
    pub(super) fn request(
        &self,
        duration: Option<f64>,
        counts: Option<Counts>,
    ) -> Result<(Request, Axis), Vec<PlanMistake>> {
        let mut axis = Axis::default();
        let generator = self.generator(counts, &mut axis);
        let filter = self.filter();
        let table_limits = self.table_limits(&mut axis);
        match (generator, filter) {
            (Ok(generator), Ok(filter)) if axis.mistakes.is_empty() => {
                let commands = if let Self::Named(NamedProfile::Position(args)) = self { args.cycle() } else { None };
                Ok((Request { generator, duration, filter, commands, table_limits }, axis))
            }
            (generator, filter) => {
                let others = generator.err().into_iter().chain(filter.err());
                Err(axis.mistakes.into_iter().chain(others).collect())
            }
        }
    }

    fn generator(&self, counts: Option<Counts>, axis: &mut Axis) -> Result<Generator, PlanMistake> {
        match self {
            Self::PointToPoint(args) => args.generator(axis),
            Self::Named(NamedProfile::Rockwell(args)) => args.generator(axis).map(Generator::Rockwell),
            Self::Named(NamedProfile::Pvt(args)) => args.generator(counts, axis),
            Self::Named(NamedProfile::Position(args)) => args.generator(counts, axis),
        }
    }

    /// Limits that velocity and acceleration of a table are checked against.
    fn table_limits(&self, axis: &mut Axis) -> [Sides; 2] {
        match self {
            Self::Named(NamedProfile::Pvt(args)) => args.limits(axis),
            Self::PointToPoint(_) | Self::Named(NamedProfile::Rockwell(_) | NamedProfile::Position(_)) => {
                [Sides::both(f64::INFINITY); 2]
            }
        }
    }

    fn filter(&self) -> Result<Filter, PlanMistake> {
        match self {
            Self::PointToPoint(args) => args.filter(),
            Self::Named(NamedProfile::Rockwell(args)) => args.filter(),
            Self::Named(NamedProfile::Pvt(args)) => args.filter(),
            Self::Named(NamedProfile::Position(_)) => Ok(Filter::NONE),
        }
    }

    /// True for a move through a table.
    pub(super) const fn is_table(&self) -> bool {
        matches!(self, Self::Named(NamedProfile::Pvt(_) | NamedProfile::Position(_)))
    }

    /// File of the table.
    pub(super) fn table(&self) -> Option<&Path> {
        match self {
            Self::PointToPoint(_) | Self::Named(NamedProfile::Rockwell(_)) => None,
            Self::Named(NamedProfile::Pvt(args)) => Some(args.file()),
            Self::Named(NamedProfile::Position(args)) => Some(args.file()),
        }
    }

    /// File for velocity commands.
    pub(super) fn commands(&self) -> Option<&Path> {
        if let Self::Named(NamedProfile::Position(args)) = self { args.commands.as_deref() } else { None }
    }
}
