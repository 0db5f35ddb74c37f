//! The 3D view: the axis and its load move, their deflection enlarged.
use crate::curves::TIMELINE;
use crate::linear;
use crate::rerun::{EntityPath, RecordingStream, RecordingStreamResult, TimeColumn, Transform3D, ViewCoordinates};
use crate::rotary;
use crate::run::{Run, range};
use crate::style::{self, Rgb};
use servobench_metrics::round_below;
use servobench_signals::Signal;
use servobench_view_request::ViewOptions;

/// Largest number of poses per run: a screen shows far fewer.
const POSES: usize = 4_000;

/// Content and camera of the 3D view. Its unit of length is the travel of a linear axis, or the radius of a rotary axis.
#[derive(Debug, Clone)]
pub(crate) struct Scene {
    /// Subject of the runs, and the enlargement.
    pub(crate) title: String,
    /// Top entity of each run.
    pub(crate) roots: Vec<EntityPath>,
    /// Place of the camera.
    pub(crate) eye: [f32; 3],
    /// Target of the camera.
    pub(crate) target: [f32; 3],
    /// True if the axis is rotary.
    rotary: bool,
    /// Smallest position of all runs, reference or actual (axis unit).
    pub(crate) low: f64,
    /// Travel of all runs (axis unit).
    pub(crate) travel: f64,
    /// Enlargement of the deflection.
    pub(crate) exaggeration: f64,
    /// Unit of the axis.
    pub(crate) unit: String,
}

/// Positions of the bodies of one run at the instants that are shown.
#[derive(Debug)]
pub(crate) struct Poses {
    /// The instants (s).
    pub(crate) times: Vec<f64>,
    /// Reference position (axis unit).
    pub(crate) reference: Option<Vec<f64>>,
    /// Effort of the disturbance on the load (N or N·m).
    pub(crate) force: Option<Vec<f64>>,
    /// The bodies, the motor's first.
    pub(crate) bodies: Vec<Body>,
    /// Name of the run and its colour, where it replaces the names of the bodies.
    pub(crate) name: Option<(String, Rgb)>,
}

/// One body of one run.
#[derive(Debug)]
pub(crate) struct Body {
    /// `motor`, `table` or `load`, or `body` when it is all of them.
    pub(crate) name: &'static str,
    /// Text beside it, in a comparison with the label of its run.
    pub(crate) label: Option<String>,
    /// Its colour.
    pub(crate) colour: Rgb,
    /// Colour of its label: that of its run in a comparison, without a shade.
    pub(crate) ink: Rgb,
    /// Positions (axis unit), the deflection enlarged.
    pub(crate) positions: Vec<f64>,
    /// True positions (axis unit).
    pub(crate) actual: Vec<f64>,
}

/// Largest number of runs with a name beside each body: of more, each has one name beside the rail or the shaft.
pub(crate) const NAMED: usize = 2;
/// A longer subject is left out of the title; it stands above the page.
const SUBJECT: usize = 50;
/// Largest enlargement: a smaller deflection is not worth showing.
const ENLARGED: f64 = 10_000.0;
const REFERENCES: [&str; 2] = [Signal::ReferencePosition.name(), Signal::SetpointPosition.name()];
/// Channels of the bodies, the motor's first.
const BODIES: [&str; 3] = [Signal::MotorPosition.name(), Signal::TablePosition.name(), Signal::LoadPosition.name()];

impl Scene {
    /// The scene of `runs`, described by `subject`; `None` when no position was recorded.
    pub(crate) fn of(subject: &str, runs: &[Run<'_>], options: &ViewOptions) -> Option<Self> {
        let ranges = runs.iter().filter_map(shown_range);
        let (low, high) = ranges.reduce(|one, two| (one.0.min(two.0), one.1.max(two.1)))?;
        let unit = runs.first()?.recording.about.axis_unit.clone();
        let rotary = unit == "rad";
        let span = if high > low { high - low } else { 1.0 };
        let deflection = runs.iter().map(largest_deflection).fold(0.0, f64::max);
        let bodies = runs.iter().map(|run| bodies(run).len()).max().unwrap_or(0);
        // Up to the overhang of one body above the one below it, or about 20° of a disc.
        let room = if rotary { rotary::ROOM } else { linear::ROOM * span };
        let fitting = if deflection > 0.0 { round_below(room / deflection).clamp(1.0, ENLARGED) } else { 1.0 };
        let exaggeration = options.exaggeration.unwrap_or(fitting);
        // Where the deflection is most of the motion (a ring-down), the rail is long enough for bodies to stay above each other.
        let travel = span.max(exaggeration * deflection / linear::ROOM);
        let enlarged = deflection > 0.0 && (exaggeration - 1.0).abs() > 0.0;
        let enlargement = if enlarged { format!(", deflection × {exaggeration}") } else { String::new() };
        let subject = if subject.chars().count() > SUBJECT { String::new() } else { format!(": {subject}") };
        let title = format!("Axis{enlargement}{subject}");
        let (eye, target) =
            if rotary { rotary::camera(runs.len(), bodies) } else { linear::camera(runs.len(), bodies) };
        let roots = runs.iter().map(|run| run.path(&["axis"])).collect();
        Some(Self { title, roots, eye, target, rotary, low, travel, exaggeration, unit })
    }

    /// Place of a position (axis unit) along the rail (travels).
    pub(crate) fn place(&self, position: f64) -> f32 {
        self.length(position - self.low)
    }

    /// Length of a distance (axis unit) along the rail (travels).
    #[expect(clippy::cast_possible_truncation, reason = "rounds, to far less than a pixel")]
    pub(crate) fn length(&self, distance: f64) -> f32 {
        (distance / self.travel) as f32
    }

    /// Logs `runs`.
    pub(crate) fn log(&self, stream: &RecordingStream, runs: &[Run<'_>]) -> RecordingStreamResult<()> {
        for (index, run) in runs.iter().enumerate() {
            stream.log_static(run.path(&["axis"]), &ViewCoordinates::RIGHT_HAND_Z_UP())?;
            let mut poses = poses(run, index, self.exaggeration);
            poses.name = run.label.filter(|_| runs.len() > NAMED).map(|label| (label.to_owned(), style::of_run(index)));
            if self.rotary {
                rotary::log(stream, run, index, &poses)?;
            } else {
                linear::log(stream, run, index, self, &poses)?;
            }
        }
        Ok(())
    }
}

/// Name and positions of the bodies of `run`, the motor's first; one when motor and load are one.
fn bodies<'a>(run: &Run<'a>) -> Vec<(&'static str, &'a [f64])> {
    let recorded = BODIES.into_iter().filter_map(|name| Some((name, run.recording.channel(name)?)));
    let mut bodies = recorded.map(|(channel, positions)| (channel.trim_end_matches(".position"), positions));
    if run.is_rigid() {
        return bodies.next_back().map(|(_, positions)| ("body", positions)).into_iter().collect();
    }
    bodies.collect()
}

/// Range of the bodies and of the reference of `run`: beside the reference, an axis that does not move is recognisable.
fn shown_range(run: &Run<'_>) -> Option<(f64, f64)> {
    let ranges = bodies(run).into_iter().filter_map(|(_, positions)| range(positions));
    let of_bodies = ranges.reduce(|one, two| (one.0.min(two.0), one.1.max(two.1)))?;
    let asked = reference(run).and_then(range).unwrap_or(of_bodies);
    Some((of_bodies.0.min(asked.0), of_bodies.1.max(asked.1)))
}

/// The reference position.
fn reference<'a>(run: &Run<'a>) -> Option<&'a [f64]> {
    let recorded = REFERENCES.into_iter().find_map(|name| run.recording.channel(name));
    recorded.filter(|values| values.len() == run.recording.len())
}

/// Largest deflection of a body against the motor (axis unit).
fn largest_deflection(run: &Run<'_>) -> f64 {
    let bodies = bodies(run);
    let Some((("motor", motor), others)) = bodies.split_first() else { return 0.0 };
    let peaks = others.iter().filter_map(|(_, body)| {
        let deflections: Vec<f64> = body.iter().zip(*motor).map(|(body, motor)| body - motor).collect();
        range(&deflections).map(|(low, high)| high.max(-low))
    });
    peaks.fold(0.0, f64::max)
}

/// Every n-th instant and the last, where all positions are finite: bodies must be shown at the same instant, which an envelope of each
/// would not give.
fn poses(run: &Run<'_>, index: usize, exaggeration: f64) -> Poses {
    let recording = run.recording;
    let recorded = bodies(run);
    let is_whole =
        |index: &usize| recorded.iter().all(|(_, values)| values.get(*index).is_some_and(|value| value.is_finite()));
    let stride = recording.len().div_ceil(POSES).max(1);
    let last = recording.len().checked_sub(1).filter(|last| !last.is_multiple_of(stride));
    let kept: Vec<usize> = (0..recording.len()).step_by(stride).chain(last).filter(is_whole).collect();
    let pick = |values: &[f64]| kept.iter().map(|index| values[*index]).collect::<Vec<f64>>();
    let mut bodies: Vec<Body> = Vec::new();
    for (name, values) in recorded {
        let actual = pick(values);
        let mut positions = actual.clone();
        if let Some(motor) = bodies.first() {
            for (position, motor) in positions.iter_mut().zip(&motor.positions) {
                *position = motor + exaggeration * (*position - motor);
            }
        }
        let label = if name == "body" { run.label.map(str::to_owned) } else { Some(run.labelled(name)) };
        let colour = colour(run, index, name);
        let ink = run.label.map_or(colour, |_| style::of_run(index));
        bodies.push(Body { name, label, colour, ink, positions, actual });
    }
    let reference = reference(run).map(pick);
    let force = recording.channel(Signal::DisturbanceLoad).filter(|values| values.len() == recording.len()).map(pick);
    Poses { times: kept.iter().map(|index| recording.time_of(*index)).collect(), reference, force, bodies, name: None }
}

/// Colour of the body `name`; a shade of the run's colour in a comparison.
fn colour(run: &Run<'_>, index: usize, name: &str) -> Rgb {
    let (own, percent) = match name {
        "motor" => (style::MOTOR, 50),
        "table" => (style::TABLE, 75),
        _ => (style::LOAD, 100),
    };
    let shade = |part: u8| u8::try_from(u16::from(part) * percent / 100).unwrap_or(u8::MAX);
    run.label.map_or(own, |_| style::of_run(index).map(shade))
}

impl Poses {
    /// Logs a transform that changes over time.
    pub(crate) fn send(
        &self,
        stream: &RecordingStream,
        path: EntityPath,
        transforms: Transform3D,
    ) -> RecordingStreamResult<()> {
        let times = TimeColumn::new_duration_secs(TIMELINE, self.times.iter().copied());
        stream.send_columns(path, [times], transforms.columns_of_unit_batches()?)
    }
}
