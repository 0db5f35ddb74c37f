//! A plan as a table of samples.
use super::{PlannedMove, STEPS};
use crate::error::ReportError;
use servobench_base::Setpoint;
use std::io::{self, Write};

/// More rows than this (about 1 GB) are a mistake in the sample time rather than a table.
const MOST_ROWS: u64 = 10_000_000;

impl PlannedMove {
    /// Writes one row for each sample of a sampled plan, of another one at equal steps: time, position and its
    /// derivatives, in SI.
    ///
    /// # Errors
    /// [`ReportError::TooManyRows`] before anything is written, [`ReportError::Io`].
    pub fn write_csv(&self, mut out: impl Write) -> Result<(), ReportError> {
        let samples = self.profile.samples();
        let rows = samples.map_or(u64::from(STEPS), |samples| samples.total()).saturating_add(1);
        if let Some(samples) = samples.filter(|_| rows > MOST_ROWS) {
            return Err(ReportError::TooManyRows { rows, limit: MOST_ROWS, sample_time: samples.time });
        }
        let unit = self.unit;
        writeln!(out, "time_s,position_{unit},velocity_{unit}_s,acceleration_{unit}_s2,jerk_{unit}_s3,snap_{unit}_s4")?;
        match samples {
            Some(samples) => (0..rows).try_for_each(|k| self.write_row(&mut out, k as f64 * samples.time)),
            None if self.profile.duration() == 0.0 => self.write_row(&mut out, 0.0),
            None => self.steps().try_for_each(|t| self.write_row(&mut out, t)),
        }?;
        Ok(out.flush()?)
    }

    fn write_row(&self, out: &mut impl Write, t: f64) -> io::Result<()> {
        let Setpoint { x, v, a, j, s } = self.profile.at(t);
        writeln!(out, "{t},{x},{v},{a},{j},{s}")
    }
}

#[cfg(test)]
mod tests {
    use super::super::{PlannedMove, moves};
    use super::*;
    use servobench_motion::{Limits, Order, Profile};

    fn rows(plan: &PlannedMove) -> Vec<Vec<f64>> {
        let mut bytes = Vec::new();
        plan.write_csv(&mut bytes).unwrap();
        let text = String::from_utf8(bytes).unwrap();
        let (heading, rows) = text.split_once('\n').unwrap();
        assert_eq!(heading, "time_s,position_m,velocity_m_s,acceleration_m_s2,jerk_m_s3,snap_m_s4");
        rows.lines().map(|row| row.split(',').map(|cell| cell.parse().unwrap()).collect()).collect()
    }

    /// Summing the snap of the samples up four times, forward Euler, lands on the distance: the samples are those of the
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
        let nothing = PlannedMove::new(Profile::plan(Order::Third, 0.0, &limits).unwrap(), limits, "m");
        assert_eq!(rows(&nothing), [vec![0.0; 6]]);
    }

    #[test]
    fn an_absurd_number_of_rows_is_refused_before_the_first() {
        let mut out = Vec::new();
        let error = moves::sampled(1e-12).write_csv(&mut out).unwrap_err().to_string();
        assert_eq!(
            error,
            "a table of 1350000000001 rows at a sample time of 1e-12 s; at most 10000000 are written: take a longer \
             sample time"
        );
        assert!(out.is_empty());
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
        assert!(matches!(moves::sampled(1e-3).write_csv(Full), Err(ReportError::Io(_))));
    }
}
