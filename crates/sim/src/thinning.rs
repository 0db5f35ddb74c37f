//! Thinning of a recording after it has been measured.
use servobench_base::Rate;
use servobench_signals::Signal;
use servobench_trace::{Channel, GrowingValues, Recording};
use std::io;

/// `recording` with rows at `rate` only: every n-th row, but for shares of saturated ticks the mean since the last row
/// that is kept. Unchanged when `rate` does not divide that of the rows.
///
/// # Errors
/// Errors of the file that holds a long recording: the disk is full.
pub fn thinned(recording: Recording, rate: Rate) -> io::Result<Recording> {
    let every = match recording.rate.divider(rate) {
        Ok(divider) if divider.ticks() > 1 => divider.ticks() as usize,
        _ => return Ok(recording),
    };
    let rows = recording.len().div_ceil(every);
    let thin = |Channel { spec, values }: Channel| {
        let mut kept = GrowingValues::with_room(rows);
        if spec.name.starts_with("saturation.") {
            kept.extend_from(means(&values, every))?;
        } else {
            kept.extend_from(values.iter().step_by(every).copied())?;
        }
        values.release();
        Ok(Channel { spec, values: kept.finish()? })
    };
    let channels = recording.channels.into_iter().map(thin).collect::<io::Result<_>>()?;
    Ok(Recording { rate, channels, ..recording })
}

/// At every n-th value the mean of the last n; at the first, itself.
fn means(values: &[f64], every: usize) -> impl Iterator<Item = f64> {
    let (first, later) = values.split_at(values.len().min(1));
    let mean = |values: &[f64]| values.iter().sum::<f64>() / values.len() as f64;
    first.iter().copied().chain(later.chunks_exact(every).map(mean))
}

/// `recording` with only the `wanted` channels; all when the list is empty. The channels by which a run is judged are recorded in
/// any case.
#[must_use]
pub fn selected(mut recording: Recording, wanted: &[Signal]) -> Recording {
    if !wanted.is_empty() {
        recording.channels.retain(|channel| wanted.iter().any(|signal| channel.spec.name == signal.name()));
    }
    recording
}

#[cfg(test)]
mod tests {
    use super::*;
    use servobench_trace::{About, ChannelSpec};

    fn recording(rows: u32) -> Recording {
        let rate = Rate::new(1000).unwrap();
        let channel = |name: &str, value: fn(u32) -> f64| Channel {
            spec: ChannelSpec { axis: None, name: name.into(), unit: String::new(), writer: "test".into(), rate },
            values: (0..rows).map(value).collect(),
        };
        Recording {
            about: About::default(),
            rate,
            channels: vec![
                channel("load.position", f64::from),
                channel("saturation.voltage", |k| f64::from(u32::from(k % 4 == 1))),
            ],
            moves: vec![],
            events: vec![],
            signals: vec![],
            calls: vec![],
            limit_reversals: vec![],
            log: vec![],
            coupling: None,
        }
    }

    /// As many rows as there are instants 0, n, 2n … among the ticks, each of its own instant; a quarter of the ticks stays
    /// a quarter.
    #[test]
    fn every_nth_row_stays() {
        for rows in [0, 1, 4, 5, 8, 9, 400, 401] {
            let thin = thinned(recording(rows), Rate::new(250).unwrap()).unwrap();
            let instants: Vec<f64> = (0..rows).step_by(4).map(f64::from).collect();
            let shares: Vec<f64> = (0..rows).step_by(4).map(|k| if k == 0 { 0.0 } else { 0.25 }).collect();
            assert_eq!(thin.channel("load.position"), Some(instants.as_slice()), "{rows}");
            assert_eq!(thin.channel("saturation.voltage"), Some(shares.as_slice()), "{rows}");
            assert_eq!(thin.rate.hertz(), 250);
        }
        assert_eq!(thinned(recording(9), Rate::new(1000).unwrap()).unwrap(), recording(9));
    }
}
