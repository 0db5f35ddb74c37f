//! Everything together: logged data and their arrangement.
use crate::blueprint::{self, Parts};
use crate::curves;
use crate::error::ViewError;
use crate::layout::Layout;
use crate::operating;
use crate::plan;
use crate::plane::Plane;
use crate::planned::PlannedPlot;
use crate::reached::{self, Reached};
use crate::rerun::{RecordingStream, RecordingStreamBuilder, RecordingStreamResult};
use crate::run::Run;
use crate::scene::Scene;
use crate::signals;
use crate::timeline_events::{self, Happenings};
use crate::verdict::Head;
use servobench_trace::Recording;
use servobench_view_request::{ViewOptions, check_labels};

/// Application id of all our recordings: the viewer keeps one blueprint for them.
const APPLICATION: &str = "servobench";

/// One run, or several overlaid, ready for any Rerun stream: a file, or an open viewer.
#[derive(Debug)]
pub struct Presentation<'a> {
    name: String,
    runs: Vec<Run<'a>>,
    plots: Vec<PlannedPlot<'a>>,
    scene: Option<Scene>,
    planes: Vec<Plane>,
    head: Head,
    max_instants: usize,
}

impl<'a> Presentation<'a> {
    /// One run. Entities are `/position/load`, `/current/q`, `/axis/motor` and so on; of an axis named `x` `/x/position/load`.
    #[must_use]
    pub fn of_run(recording: &'a Recording, options: &ViewOptions) -> Self {
        let name = recording.title();
        Self::plan(name, vec![Run { label: None, recording }], options)
    }

    /// Several runs overlaid, all starting at time 0. Entities are `/jerk/position/load`, `/snap/position/load` and so on for runs labelled
    /// `jerk` and `snap`; a plot shows the same curve of every run.
    ///
    /// # Errors
    /// [`ViewError::TooFewRuns`]; [`ViewError::Label`] for a label that is empty, reserved or used twice.
    pub fn of_comparison(runs: &[(&'a str, &'a Recording)], options: &ViewOptions) -> Result<Self, ViewError> {
        if runs.len() < 2 {
            return Err(ViewError::TooFewRuns { found: runs.len() });
        }
        let labels: Vec<&str> = runs.iter().map(|(label, _)| *label).collect();
        check_labels(&labels)?;
        let labels = labels.join(" against ");
        let mut engines: Vec<&str> = runs.iter().map(|(_, recording)| recording.about.engine.as_str()).collect();
        engines.dedup();
        // Labels distinguish variants of one scenario.
        let first = &runs[0].1.about;
        let is_of_all = runs.iter().all(|(_, recording)| recording.about.overrides == first.overrides);
        let overridden = if is_of_all { first.overridden() } else { String::new() };
        let name = format!("{labels} on {}{overridden}", engines.join(" and "));
        let runs = runs.iter().map(|(label, recording)| Run { label: Some(label), recording });
        Ok(Self::plan(name, runs.collect(), options))
    }

    fn plan(name: String, runs: Vec<Run<'a>>, options: &ViewOptions) -> Self {
        let plots = plan::plots(&runs, options);
        let scene = Scene::of(&name, &runs, options);
        let head = Head::of(name.clone(), &runs, options);
        let planes =
            options.motor.map_or_else(Vec::new, |motor| operating::planes(&runs, &motor, options.max_instants));
        Self { name, runs, plots, scene, planes, head, max_instants: options.max_instants }
    }

    /// Its arrangement in the viewer.
    #[must_use]
    pub fn blueprint(&self) -> Layout {
        let duration = self.runs.iter().map(Run::end).fold(0.0, f64::max);
        blueprint::layout(Parts {
            plots: &self.plots,
            scene: self.scene.as_ref(),
            timeline_events: Happenings::of(&self.runs),
            signals: signals::lanes(&self.runs),
            reached: Reached::of(&self.runs),
            planes: &self.planes,
            head: &self.head,
            duration,
        })
    }

    /// Logs verdict, curves, 3D view, moves, events, signals and limits that were reached.
    ///
    /// # Errors
    /// [`ViewError::Rerun`].
    pub fn log(&self, stream: &RecordingStream) -> Result<(), ViewError> {
        let action = "log the recording";
        self.log_all_but_curves(stream).map_err(ViewError::rerun(action))?;
        // Static data wait in a batch. Without this the curves would come first, and a viewer would show them, while it reads a large file,
        // in default colours and without axis.
        stream.flush_blocking().map_err(ViewError::rerun(action))?;
        self.plots
            .iter()
            .try_for_each(|plot| curves::log(stream, plot, self.max_instants))
            .map_err(ViewError::rerun(action))
    }

    fn log_all_but_curves(&self, stream: &RecordingStream) -> RecordingStreamResult<()> {
        self.head.log(stream)?;
        self.plots.iter().try_for_each(|plot| curves::log_styles(stream, plot))?;
        self.runs.iter().enumerate().try_for_each(|(index, run)| timeline_events::log(stream, run, index))?;
        self.runs.iter().try_for_each(|run| signals::log(stream, run))?;
        self.runs.iter().try_for_each(|run| reached::log(stream, run))?;
        self.planes.iter().try_for_each(|plane| plane.log(stream))?;
        self.scene.as_ref().map_or(Ok(()), |scene| scene.log(stream, &self.runs))
    }

    /// The bytes of an `.rrd` file: blueprint and data.
    ///
    /// # Errors
    /// [`ViewError::Rerun`].
    pub fn to_rrd(&self) -> Result<Vec<u8>, ViewError> {
        let builder = RecordingStreamBuilder::new(APPLICATION).recording_name(self.name.as_str());
        let (stream, storage) = builder.enabled(true).memory().map_err(ViewError::rerun("open a stream"))?;
        self.blueprint().send(&stream)?;
        self.log(&stream)?;
        stream.flush_blocking().map_err(ViewError::rerun("flush the stream"))?;
        storage.drain_as_bytes().map_err(ViewError::rerun("encode the file"))
    }
}

#[cfg(test)]
mod tests {
    use crate::catalogue::BOUND;
    use crate::operating;
    use crate::planned::{ALLOWED, WINDOW};
    use servobench_view_request::RESERVED;

    #[test]
    fn roots_of_other_entities_are_reserved() {
        assert_eq!([&[BOUND, ALLOWED, WINDOW][..], &operating::PATHS].concat(), RESERVED);
    }
}
