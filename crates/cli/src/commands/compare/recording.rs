//! The single recording that overlays all runs.
use super::variants::Wanted;
use crate::error::CliError;
use crate::interrupt;
use crate::output;
use crate::outputs::OutputFolder;
use crate::view_program::ViewProgram;
use servobench::Run;
use servobench_suite::file_name;
use servobench_trace::PassingFile;
use servobench_view_request::{Request, ViewOptions};
use std::path::Path;

/// Most runs named in the file name of the recording; for more, the first and the number of others.
const MOST_NAMED: usize = 4;

/// File name of the recording.
pub(super) fn name(wanted: &[Wanted]) -> String {
    let labels: Vec<&str> = wanted.iter().map(|one| one.label.as_str()).collect();
    let name = match labels.as_slice() {
        [first, others @ ..] if labels.len() > MOST_NAMED => format!("{first}-against-{}-others", others.len()),
        few => few.join("-against-"),
    };
    format!("{}.rrd", file_name(&name))
}

/// Draws the recording as the file `name`.
pub(super) fn write(
    program: &ViewProgram,
    out: &OutputFolder,
    name: &str,
    wanted: &[Wanted],
    runs: &[Run],
) -> Result<(), CliError> {
    let options = wanted.iter().map(|one| output::view_options(&one.job.scenario));
    let options = options.reduce(|one, other| agreed(one, &other)).unwrap_or_default();
    let verdicts = runs.iter().map(|run| output::shown(&run.recording, &run.metrics, &run.verdict)).collect();
    let options = ViewOptions { verdicts, ..options };
    let labels = match wanted {
        [_] => Vec::new(),
        all => all.iter().map(|one| one.label.clone()).collect(),
    };
    let place = out.place(name)?;
    let recordings = runs.iter().map(|run| run.recording.write_passing(&place).map_err(CliError::WriteRecording));
    let recordings: Vec<PassingFile> = recordings.collect::<Result<_, _>>()?;
    let paths: Vec<&Path> = recordings.iter().map(PassingFile::path).collect();
    program.draw(&paths, &Request { labels, options }, &out.file(name)?)?;
    interrupt::written(&place);
    Ok(())
}

/// Limits common to both: a line drawn over all runs must not be the bound of one of them.
fn agreed(mut one: ViewOptions, other: &ViewOptions) -> ViewOptions {
    one.limits.retain(|limit| other.limits.contains(limit));
    one.allowed.retain(|allowed| other.allowed.contains(allowed));
    one.window = one.window.filter(|_| one.window == other.window);
    one.motor = one.motor.filter(|_| one.motor == other.motor);
    one.residual_from = one.residual_from.filter(|_| one.residual_from == other.residual_from);
    one
}

#[cfg(test)]
mod tests {
    use super::*;
    use servobench_metrics::Name;

    #[test]
    fn a_bound_of_one_run_is_not_drawn_over_all() {
        let options = |most, window| ViewOptions {
            limits: vec![("current.q".into(), 18.0)],
            allowed: vec![(Name::SettlingTime, most), (Name::CurrentPeak, 18.0)],
            window: Some(window),
            ..ViewOptions::default()
        };
        let drawn = agreed(options(0.02, 5e-6), &options(0.9, 1e-5));
        assert_eq!(drawn.limits, [("current.q".to_owned(), 18.0)]);
        assert_eq!((drawn.allowed, drawn.window), (vec![(Name::CurrentPeak, 18.0)], None));
        let same = options(0.02, 5e-6);
        assert_eq!(agreed(same.clone(), &same), same);
    }
}
