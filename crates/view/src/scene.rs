//! The 3D view: the axis and its load move, their deflection enlarged.
use crate::curves::TIMELINE;
use crate::linear;
use crate::options::ViewOptions;
use crate::rotary;
use crate::run::{Run, range};
use crate::scale::nice_below;
use crate::style::{self, Rgb};
use rerun::{EntityPath, RecordingStream, RecordingStreamResult, TimeColumn, Transform3D, ViewCoordinates};

/// Largest number of poses per run: a screen shows far fewer.
const POSES: usize = 4_000;

/// What the 3D view shows and from where. One unit of length in it is the travel of a linear axis, or the radius of a
/// rotary axis.
#[derive(Debug, Clone)]
pub(crate) struct Scene {
    /// Title with the enlargement.
    pub(crate) title: String,
    /// Entity above everything, one per run.
    pub(crate) roots: Vec<EntityPath>,
    /// Place of the camera.
    pub(crate) eye: [f32; 3],
    /// What it looks at.
    pub(crate) target: [f32; 3],
    /// Whether the bodies turn.
    rotary: bool,
    /// Smallest position of all runs (axis unit).
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
    times: Vec<f64>,
    /// Position of what was asked for (axis unit).
    pub(crate) reference: Option<Vec<f64>>,
    /// The bodies, the motor's first.
    pub(crate) bodies: Vec<Body>,
}

/// One body of one run.
#[derive(Debug)]
pub(crate) struct Body {
    /// `motor`, `table` or `load`.
    pub(crate) name: &'static str,
    /// What stands above it, if anything.
    pub(crate) label: Option<String>,
    /// Its colour.
    pub(crate) colour: Rgb,
    /// Positions (axis unit), the deflection enlarged.
    pub(crate) positions: Vec<f64>,
}

const REFERENCES: [&str; 2] = ["reference.position", "setpoint.position"];
const BODIES: [&str; 3] = ["motor.position", "table.position", "load.position"];

impl Scene {
    /// The scene of `runs`; `None` when no position was recorded.
    pub(crate) fn of(runs: &[Run<'_>], options: &ViewOptions) -> Option<Self> {
        let ranges = runs.iter().filter_map(|run| run.range(&BODIES));
        let (low, high) = ranges.reduce(|one, two| (one.0.min(two.0), one.1.max(two.1)))?;
        let unit = runs.first()?.recording.about.axis_unit.clone();
        let rotary = unit == "rad";
        let span = if high > low { high - low } else { 1.0 };
        let deflection = runs.iter().map(largest_deflection).fold(0.0, f64::max);
        let recorded = |run: &Run<'_>| BODIES.iter().filter(|name| run.recording.channel(name).is_some()).count();
        let bodies = runs.iter().map(recorded).max().unwrap_or(0);
        // As far as the gap between two boxes allows, or about 20° of a disc.
        let room = if rotary { rotary::ROOM } else { linear::ROOM * span };
        let fitting = if deflection > 0.0 { nice_below(room / deflection).max(1.0) } else { 1.0 };
        let exaggeration = options.exaggeration.unwrap_or(fitting);
        // Where the deflection is most of the motion (a ring-down), the rail is as long as it takes for bodies to stay apart.
        let travel = span.max(exaggeration * deflection / linear::ROOM);
        let title = if deflection > 0.0 { format!("Axis, deflection × {exaggeration}") } else { "Axis".into() };
        let (eye, target) = if rotary { rotary::camera(runs.len(), bodies) } else { linear::camera(runs.len()) };
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
            let poses = poses(run, index, self.exaggeration);
            if self.rotary {
                rotary::log(stream, run, index, &poses)?;
            } else {
                linear::log(stream, run, index, self, &poses)?;
            }
        }
        Ok(())
    }
}

/// Largest deflection of a body against the motor (axis unit).
fn largest_deflection(run: &Run<'_>) -> f64 {
    let Some(motor) = run.recording.channel(BODIES[0]) else { return 0.0 };
    let others = BODIES[1..].iter().filter_map(|name| run.recording.channel(name));
    let peaks = others.filter_map(|body| {
        let deflections: Vec<f64> = body.iter().zip(motor).map(|(body, motor)| body - motor).collect();
        range(&deflections).map(|(low, high)| high.max(-low))
    });
    peaks.fold(0.0, f64::max)
}

/// Every n-th instant and the last, where all positions are finite: bodies must be seen at the same instant, so an envelope of each would not do.
fn poses(run: &Run<'_>, index: usize, exaggeration: f64) -> Poses {
    let recording = run.recording;
    let channels: Vec<&[f64]> = BODIES.iter().filter_map(|name| recording.channel(name)).collect();
    let whole = |index: &usize| channels.iter().all(|values| values.get(*index).is_some_and(|value| value.is_finite()));
    let stride = recording.len().div_ceil(POSES).max(1);
    let last = recording.len().checked_sub(1).filter(|last| !last.is_multiple_of(stride));
    let kept: Vec<usize> = (0..recording.len()).step_by(stride).chain(last).filter(whole).collect();
    let pick = |values: &[f64]| kept.iter().map(|index| values[*index]).collect::<Vec<f64>>();
    let mut bodies: Vec<Body> = Vec::new();
    let outermost = BODIES.into_iter().rfind(|name| recording.channel(name).is_some());
    for (channel, colour) in BODIES.into_iter().zip(colours(run, index)) {
        let Some(values) = recording.channel(channel) else { continue };
        let mut positions = pick(values);
        if let Some(motor) = bodies.first() {
            for (position, motor) in positions.iter_mut().zip(&motor.positions) {
                *position = motor + exaggeration * (*position - motor);
            }
        }
        let name = channel.trim_end_matches(".position");
        let is_outermost = Some(channel) == outermost;
        let label = match run.label {
            None if is_outermost && !bodies.is_empty() => Some(format!("{name}, deflection × {exaggeration}")),
            None => Some(name.to_owned()),
            // In a comparison one label per run is enough to read.
            Some(label) => is_outermost.then(|| label.to_owned()),
        };
        bodies.push(Body { name, label, colour, positions });
    }
    let reference = REFERENCES.into_iter().find_map(|name| recording.channel(name));
    let reference = reference.filter(|values| values.len() == recording.len()).map(pick);
    Poses { times: kept.iter().map(|index| recording.time_of(*index)).collect(), reference, bodies }
}

/// Colours of motor, table and load; shades of the run's colour in a comparison.
fn colours(run: &Run<'_>, index: usize) -> [Rgb; 3] {
    if run.label.is_none() {
        return [style::MOTOR, style::TABLE, style::LOAD];
    }
    let shade = |percent: u16| {
        style::of_run(index).map(|part| u8::try_from(u16::from(part) * percent / 100).unwrap_or(u8::MAX))
    };
    [shade(50), shade(75), shade(100)]
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
