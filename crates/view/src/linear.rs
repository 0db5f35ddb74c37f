//! A linear axis in 3D: bodies on a rail, springs between them, a ruler in front.
use crate::run::Run;
use crate::scale::{Scale, nice_below};
use crate::scene::{Body, Poses, Scene};
use crate::style;
use rerun::{Boxes3D, FillMode, LineStrips3D, Points3D, RecordingStream, RecordingStreamResult, Transform3D};

/// Half the length of a body along the rail (travels).
const HALF_BODY: f32 = 0.055;
/// Gap between two bodies at rest (travels).
const GAP: f32 = 0.12;
/// Largest displayed deflection (travels): less than the gap, so that bodies never touch.
pub(crate) const ROOM: f64 = 0.08;
/// Distance between the rails of two runs (travels).
const LANE: f32 = 0.36;
/// Windings of a spring.
const WINDINGS: u8 = 7;
/// Height of the springs above the rail (travels).
const SPRING_HEIGHT: f32 = 0.06;
/// Ticks of the ruler, at least.
const TICKS: f64 = 4.0;

/// Camera for `runs` rails: place and target.
pub(crate) fn camera(runs: usize) -> ([f32; 3], [f32; 3]) {
    let depth = LANE * runs.saturating_sub(1) as f32;
    ([0.58, -0.78 - 0.2 * depth, 0.48 + 0.45 * depth], [0.58, 0.5 * depth, 0.0])
}

/// Logs one run.
pub(crate) fn log(
    stream: &RecordingStream,
    run: &Run<'_>,
    index: usize,
    scene: &Scene,
    poses: &Poses,
) -> RecordingStreamResult<()> {
    let y = LANE * index as f32;
    log_bed(stream, run, poses.bodies.len(), y)?;
    if index == 0 {
        log_ruler(stream, run, scene)?;
    }
    let mut before: Option<&Body> = None;
    let mut offset = 0.0;
    for (number, body) in poses.bodies.iter().enumerate() {
        if let Some(before) = before {
            let path = run.path(&["axis", "spring", body.name]);
            let start =
                before.positions.iter().map(|position| [scene.place(*position) + offset + HALF_BODY, y, SPRING_HEIGHT]);
            let stretch = body
                .positions
                .iter()
                .zip(&before.positions)
                .map(|(position, before)| [GAP + scene.length(position - before), 1.0, 1.0]);
            let transform = Transform3D::update_fields().with_many_translation(start).with_many_scale(stretch);
            poses.send(stream, path.clone(), transform)?;
            let shape = LineStrips3D::new([spring()]).with_colors([[200, 200, 200]]).with_radii([0.004]);
            stream.log_static(path, &shape)?;
            offset += 2.0 * HALF_BODY + GAP;
        }
        let path = run.path(&["axis", body.name]);
        let x = body.positions.iter().map(|position| [scene.place(*position) + offset, y, 0.0]);
        poses.send(stream, path.clone(), Transform3D::update_fields().with_many_translation(x))?;
        log_body(stream, path, body, number)?;
        before = Some(body);
    }
    if let Some(reference) = &poses.reference {
        let path = run.path(&["axis", "reference"]);
        let x = reference.iter().map(|position| [scene.place(*position), y, 0.0]);
        poses.send(stream, path.clone(), Transform3D::update_fields().with_many_translation(x))?;
        let pointer = LineStrips3D::new([[[0.0, -0.15, 0.0], [0.0, -0.085, 0.0]]])
            .with_colors([style::REFERENCE])
            .with_radii([0.006]);
        stream.log_static(path, &pointer)?;
    }
    Ok(())
}

fn log_body(
    stream: &RecordingStream,
    path: rerun::EntityPath,
    body: &Body,
    number: usize,
) -> RecordingStreamResult<()> {
    let half_height = if number == 0 { 0.06 } else { 0.08 };
    let shape = Boxes3D::from_centers_and_half_sizes([[0.0, 0.0, half_height]], [[HALF_BODY, 0.08, half_height]])
        .with_colors([body.colour])
        .with_fill_mode(FillMode::Solid);
    stream.log_static(path.clone(), &shape)?;
    // Labels stand at different heights, or they would cover each other.
    let height = 0.23 + 0.06 * number as f32;
    let label = body.label.as_ref().map(|label| {
        Points3D::new([[0.0, 0.0, height]])
            .with_radii([0.001])
            .with_colors([body.colour])
            .with_labels([label.as_str()])
            .with_show_labels(true)
    });
    label.map_or(Ok(()), |label| stream.log_static(path, &label))
}

/// The bed and its two rails.
fn log_bed(stream: &RecordingStream, run: &Run<'_>, bodies: usize, y: f32) -> RecordingStreamResult<()> {
    let coupled = bodies.saturating_sub(1) as f32 * (2.0 * HALF_BODY + GAP);
    let half = (1.0 + coupled + 5.0 * HALF_BODY) / 2.0;
    let middle = half - 2.5 * HALF_BODY;
    let bed = Boxes3D::from_centers_and_half_sizes(
        [[middle, y, -0.035], [middle, y - 0.05, -0.006], [middle, y + 0.05, -0.006]],
        [[half, 0.10, 0.025], [half, 0.008, 0.006], [half, 0.008, 0.006]],
    )
    .with_colors([[72, 77, 86], [140, 145, 154], [140, 145, 154]])
    .with_fill_mode(FillMode::Solid);
    stream.log_static(run.path(&["axis", "bed"]), &bed)
}

/// Where the motor is, in the unit of the axis.
fn log_ruler(stream: &RecordingStream, run: &Run<'_>, scene: &Scene) -> RecordingStreamResult<()> {
    let (low, high) = (scene.low, scene.low + scene.travel);
    let step = nice_below(scene.travel / TICKS);
    let scale = Scale::for_peak(&scene.unit, high.abs().max(low.abs()));
    let first = (low / step - 1e-9).ceil();
    // At most ten, as a nice number is more than two fifths of the value it is below.
    let positions = (0..=10).map(|tick| (first + f64::from(tick)) * step);
    let positions: Vec<f64> = positions.take_while(|position| *position <= high + 1e-9 * step).collect();
    let ticks = positions
        .iter()
        .map(|position| [[scene.place(*position), -0.155, -0.06], [scene.place(*position), -0.10, -0.06]]);
    // Six decimals hide the rounding of a nice number and keep ticks of a short move far from zero apart.
    let number = |position: &f64| (position * scale.factor * 1e6).round() / 1e6;
    let labels = positions.iter().map(|position| format!("{} {}", number(position), scale.unit));
    let ruler = LineStrips3D::new(ticks)
        .with_colors([style::REFERENCE])
        .with_radii([0.002])
        .with_labels(labels)
        .with_show_labels(true);
    stream.log_static(run.path(&["axis", "ruler"]), &ruler)
}

/// A spring from x = 0 to x = 1.
fn spring() -> Vec<[f32; 3]> {
    let steps = 2 * WINDINGS;
    let mut points = vec![[0.0, 0.0, 0.0]];
    for step in 0..steps {
        let x = (f32::from(step) + 0.5) / f32::from(steps);
        points.push([x, 0.0, if step % 2 == 0 { 0.03 } else { -0.03 }]);
    }
    points.push([1.0, 0.0, 0.0]);
    points
}
