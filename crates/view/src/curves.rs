//! Logs the lines of the plots, column by column.
use crate::planned::PlannedPlot;
use crate::rerun::InterpolationMode;
use crate::rerun::{RecordingStream, RecordingStreamResult, Scalars, SeriesLines, TimeColumn};
use crate::scale::Scale;
use crate::series::{Series, Values};
use servobench_trace::envelope;

/// Time difference between the lower and the upper end of an upright line (s).
const UPRIGHT: f64 = 1e-9;
/// The one timeline: seconds since the start of the run.
pub(crate) const TIMELINE: &str = "time";

/// Logs names and colours of all lines of `plot`. Without them a viewer shows the data read so far in default colours.
pub(crate) fn log_styles(stream: &RecordingStream, plot: &PlannedPlot<'_>) -> RecordingStreamResult<()> {
    plot.series.iter().try_for_each(|series| stream.log_static(series.path.clone(), &style(series, plot.held)))
}

/// Logs all lines of `plot`, each of at most `max_instants` points.
pub(crate) fn log(stream: &RecordingStream, plot: &PlannedPlot<'_>, max_instants: usize) -> RecordingStreamResult<()> {
    for series in &plot.series {
        let (times, values) = points(series, &plot.scale, max_instants);
        let times = TimeColumn::new_duration_secs(TIMELINE, times);
        let columns = Scalars::new(values).columns_of_unit_batches()?;
        stream.send_columns(series.path.clone(), [times], columns)?;
    }
    Ok(())
}

fn style(series: &Series<'_>, held: bool) -> SeriesLines {
    let mode = if held { InterpolationMode::StepAfter } else { InterpolationMode::Linear };
    let lines = SeriesLines::new().with_names([series.name.as_str()]).with_colors([series.colour]);
    lines.with_widths([series.width]).with_interpolation_mode(mode)
}

/// Times (s) and values (in the plot's unit); non-finite values are left out.
fn points(series: &Series<'_>, scale: &Scale, max_instants: usize) -> (Vec<f64>, Vec<f64>) {
    match series.values {
        Values::Channel { run, values, first, origin } => {
            let values = &values[first..];
            // Two per bucket, and the first and the last.
            let buckets = max_instants.saturating_sub(2) / 2;
            let kept: Vec<usize> =
                if values.len() > max_instants { envelope(values, buckets) } else { (0..values.len()).collect() };
            let finite = kept.into_iter().filter(|index| values[*index].is_finite());
            finite.map(|index| (run.recording.time_of(first + index), (values[index] - origin) * scale.factor)).unzip()
        }
        Values::Level { value, span: (from, to) } => (vec![from, to], vec![value * scale.factor; 2]),
        // Rerun shows the last of two values at one instant.
        Values::Instant { time, range: (low, high) } => {
            (vec![time, time + UPRIGHT], vec![low * scale.factor, high * scale.factor])
        }
    }
}
