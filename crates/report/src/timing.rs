//! A run as a timing diagram in the style of PLCopen's standard for its blocks: velocity and position over the outputs of
//! the blocks and the states of axis and drive, on one time axis. docs/timing.md explains how to read it.
mod curves;
mod group;
mod guides;
mod key;
mod sheet;
mod stretch;
mod trace;
mod window;

use crate::error::ReportError;
use group::Group;
use servobench_trace::Recording;
use sheet::Sheet;
use window::Window;

/// Smallest and largest width (pixels).
const LEAST: u32 = 480;
const MOST: u32 = 4000;

/// Options of a timing diagram.
#[derive(Debug, Clone, PartialEq)]
pub struct TimingOptions {
    /// Start (s); `None` for that of the recording.
    pub from: Option<f64>,
    /// End (s); `None` for that of the recording.
    pub to: Option<f64>,
    /// Width (pixels), from 480 to 4000.
    pub width: u32,
    /// Sources whose signals are shown, in the order of the recording; all if empty.
    pub sources: Vec<String>,
    /// True to show idle signals, which stay FALSE, 0 or none. They are shown anyway if there are no others.
    pub with_idle: bool,
}

impl Default for TimingOptions {
    /// The whole recording, 860 pixels wide; all sources, without idle signals.
    fn default() -> Self {
        Self { from: None, to: None, width: 860, sources: vec![], with_idle: false }
    }
}

/// `recording` as a timing diagram in SVG, self-contained and the same to the byte each time.
///
/// Its size is bounded by its width and the number of signals, however long the recording is: curves are drawn as the lowest and the
/// highest value in each column of pixels, and a signal that changes too often to be seen as a grey block.
///
/// # Errors
/// [`ReportError::NothingToDraw`], [`ReportError::UnknownSource`], [`ReportError::NoSuchTime`], [`ReportError::Width`].
pub fn timing_diagram(recording: &Recording, options: &TimingOptions) -> Result<String, ReportError> {
    if !(LEAST..=MOST).contains(&options.width) {
        return Err(ReportError::Width { width: options.width, least: LEAST, most: MOST });
    }
    let is_known = |name: &&String| sources(recording).contains(&name.as_str());
    if let Some(name) = options.sources.iter().find(|name| !is_known(name)) {
        return Err(ReportError::UnknownSource { name: name.clone(), known: sources_in_words(recording) });
    }
    let window = Window::of(recording, options.from, options.to)?;
    let curves = curves::panels(recording, window, f64::from(options.width));
    let all = Group::all(recording, &options.sources, window);
    if curves.is_empty() && all.is_empty() {
        return Err(ReportError::NothingToDraw);
    }
    let is_all_idle = curves.is_empty() && all.iter().all(Group::is_idle);
    let (groups, idle) = if options.with_idle || is_all_idle { (all, vec![]) } else { group::without_idle(all) };
    Ok(Sheet {
        about: &recording.about,
        axis: recording.axis(),
        window,
        width: f64::from(options.width),
        curves,
        groups,
        idle,
    }
    .to_svg())
}

/// Sources of signals, and the calls.
fn sources(recording: &Recording) -> Vec<&str> {
    let mut names: Vec<&str> = Vec::new();
    let all = recording.signals.iter().map(|signal| &signal.source);
    for name in all.chain(recording.calls.iter().map(|call| &call.name)) {
        if !names.contains(&name.as_str()) {
            names.push(name);
        }
    }
    names
}

/// The sources in words.
fn sources_in_words(recording: &Recording) -> String {
    let names = sources(recording);
    if names.is_empty() { "none at all".to_owned() } else { format!("those of `{}`", names.join("`, `")) }
}
