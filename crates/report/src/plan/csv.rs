//! A plan as a table of samples.
use super::{NAMES, PlannedMove, STEPS};
use crate::error::ReportError;
use servobench_base::Setpoint;
use servobench_motion::position_profile::Command;
use servobench_planner::{PlanDetails, Reader};
use std::io::Write;

/// More rows than this (about 1 GB) are a mistake in the sample time rather than a table.
const MOST_ROWS: u64 = 10_000_000;
/// Suffix of the unit of each derivative, as in tables of points.
pub(super) const DERIVED: [&str; 5] = ["", "/s", "/s2", "/s3", "/s4"];

impl PlannedMove {
    /// Writes a row every `step` (s); without a step, one for each sample of a sampled plan, or at equal steps for any other plan: time,
    /// position and its derivatives, in SI, with a heading that readers of points recognise.
    ///
    /// # Errors
    /// [`ReportError::TooManyRows`] before anything is written, [`ReportError::Io`].
    pub fn write_csv(&self, step: Option<f64>, mut out: impl Write) -> Result<(), ReportError> {
        let duration = self.plan.duration();
        let samples = self.samples();
        let has_equal_steps = step.is_none() && samples.is_none();
        let (step, steps) = match (step, samples) {
            (Some(step), _) => (step, (duration / step - 1e-9).ceil().max(0.0)),
            (None, Some((time, samples))) => (time, samples as f64),
            (None, None) if duration == 0.0 => (0.0, 0.0),
            (None, None) => (duration / f64::from(STEPS), f64::from(STEPS)),
        };
        #[expect(
            clippy::cast_possible_truncation,
            clippy::cast_sign_loss,
            reason = "it saturates, and is refused then"
        )]
        let rows = (steps as u64).saturating_add(1);
        if rows > MOST_ROWS {
            return Err(ReportError::TooManyRows { rows, limit: MOST_ROWS, sample_time: step });
        }
        let columns = NAMES.iter().zip(DERIVED);
        let columns = columns.map(|(name, per)| format!(",{name} [{}{per}]", self.units.base()));
        writeln!(out, "time [s]{}", columns.collect::<String>())?;
        let mut reader = Reader::default();
        reader.look_up(&self.plan, 0.0);
        for k in 0..rows {
            let t = if has_equal_steps && k > 0 { duration * (k as f64 / steps) } else { k as f64 * step };
            if !reader.holds(t) {
                reader.look_up(&self.plan, t);
            }
            let Setpoint { x, v, a, j, s } = reader.at(t);
            writeln!(out, "{t},{x},{v},{a},{j},{s}")?;
        }
        Ok(out.flush()?)
    }

    /// Writes a row for each velocity command of a position profile: time of sending, velocity, acceleration, in SI. Returns true
    /// if there are commands at all.
    ///
    /// # Errors
    /// [`ReportError::Io`].
    pub fn write_commands(&self, mut out: impl Write) -> Result<bool, ReportError> {
        let PlanDetails::Commands { commands, .. } = self.plan.details() else { return Ok(false) };
        let unit = self.units.base();
        writeln!(out, "time [s],target velocity [{unit}/s],profile acceleration [{unit}/s2]")?;
        let start = commands.first().map_or(0.0, |command| command.t);
        for Command { t, velocity, acceleration } in commands {
            writeln!(out, "{},{velocity},{acceleration}", t - start)?;
        }
        out.flush()?;
        Ok(true)
    }
}

#[cfg(test)]
mod tests {
    use super::super::{PlannedMove, moves};
    use super::*;
    use servobench_motion::pvt::Knot;
    use servobench_motion::{Limits, Order};
    use servobench_planner::{Follow, Generator, TableMove, Velocities};
    use std::io;

    fn rows(plan: &PlannedMove) -> Vec<Vec<f64>> {
        let mut bytes = Vec::new();
        plan.write_csv(None, &mut bytes).unwrap();
        let text = String::from_utf8(bytes).unwrap();
        let (heading, rows) = text.split_once('\n').unwrap();
        assert_eq!(heading, "time [s],position [m],velocity [m/s],acceleration [m/s2],jerk [m/s3],snap [m/s4]");
        rows.lines().map(|row| row.split(',').map(|cell| cell.parse().unwrap()).collect()).collect()
    }

    /// Summing the snap of the samples up four times, forward Euler, gives the distance: the samples are those of the
    /// sampled plan. Each sum of 1354 terms of one sign at a time rounds by less than 1e-12.
    #[test]
    fn a_sampled_plan_has_a_row_for_each_sample() {
        let rows = rows(&moves::sampled(1e-3));
        assert_eq!(rows.len(), 1351);
        assert!((rows[1350][0] - 1.35).abs() < 1e-15 && (rows[1350][1] - 1.0).abs() < 1e-15);
        let [mut a, mut v, mut j, mut x] = [0.0_f64; 4];
        for snap in rows.iter().map(|row| row[5]).chain([0.0; 3]) {
            (x, v, a, j) = (x + 1e-3 * v, v + 1e-3 * a, a + 1e-3 * j, j + 1e-3 * snap);
        }
        assert!((x - 1.0).abs() < 1e-9 && v.abs() < 1e-9, "{x} {v}");
    }

    #[test]
    fn another_plan_has_equal_steps() {
        let rows = rows(&moves::lambrechts(Order::Fourth));
        assert_eq!((rows.len(), rows[500][1].to_bits()), (1001, 0.5_f64.to_bits()));
    }

    #[test]
    fn a_move_of_no_distance_has_one_row() {
        let limits = Limits { velocity: 1.0, acceleration: 1.0, jerk: 1.0, snap: 1.0 };
        assert_eq!(rows(&moves::published(Order::Third, 0.0, limits)), [vec![0.0; 6]]);
    }

    #[test]
    fn an_absurd_number_of_rows_is_refused_before_the_first() {
        let mut out = Vec::new();
        let error = moves::sampled(1e-12).write_csv(None, &mut out).unwrap_err().to_string();
        assert_eq!(
            error,
            "a table of 1350000000001 rows at a sample time of 1e-12 s; at most 10000000 are written: take a longer \
             sample time"
        );
        assert!(out.is_empty());
    }

    /// 0 … 1.35 s in steps of 0.1 s, and one more for the remainder.
    #[test]
    fn rows_are_as_far_apart_as_asked_for() {
        let mut bytes = Vec::new();
        moves::lambrechts(Order::Fourth).write_csv(Some(0.1), &mut bytes).unwrap();
        let text = String::from_utf8(bytes).unwrap();
        assert_eq!(text.lines().count(), 1 + 15);
        assert!(text.ends_with("1.4000000000000001,1,0,0,0,0\n"), "{text}");
    }

    /// α = 1/2 leaves no plateau: one command for each segment.
    #[test]
    fn commands_have_a_table_of_their_own() {
        let knots = vec![Knot::new(1.0, 0.0), Knot::new(2.0, 1.0)];
        let asked = TableMove { knots, velocities: Velocities::Given, follow: Follow::Plateaus { share: 0.5.into() } };
        let mut bytes = Vec::new();
        assert!(moves::of(Generator::Table(asked)).write_commands(&mut bytes).unwrap());
        let text = String::from_utf8(bytes).unwrap();
        // A triangle: to 2 m/s within half a second and back.
        assert_eq!(text, "time [s],target velocity [m/s],profile acceleration [m/s2]\n0,2,4\n0.5,0,4\n");
        assert!(!moves::lambrechts(Order::Fourth).write_commands(io::sink()).unwrap());
    }

    #[test]
    fn a_full_disk_is_an_error() {
        struct Full;
        impl Write for Full {
            fn write(&mut self, _: &[u8]) -> io::Result<usize> {
                Err(io::ErrorKind::StorageFull.into())
            }
            fn flush(&mut self) -> io::Result<()> {
                Ok(())
            }
        }
        assert!(matches!(moves::sampled(1e-3).write_csv(None, Full), Err(ReportError::Io(_))));
    }
}
