//! A linear axis in 3D: bodies on a rail, springs between them, a ruler in front.
use crate::curves::TIMELINE;
use crate::run::{Run, range};
use crate::scale::Scale;
use crate::scene::{Body, Poses, Scene};
use crate::style::{self, Rgb};
use rerun::{
    Arrows3D, Boxes3D, FillMode, LineStrips3D, Points3D, RecordingStream, RecordingStreamResult, TimeColumn,
    Transform3D,
};
use servobench_metrics::round_above;

/// Half the length of a body along the rail (travels).
const HALF_BODY: f32 = 0.055;
/// Gap between two bodies at rest (travels).
const GAP: f32 = 0.15;
/// Largest displayed deflection (travels): less than the gap, so that bodies never touch.
pub(crate) const ROOM: f64 = 0.08;
/// Distance between the rails of two runs (travels).
const LANE: f32 = 0.36;
/// Windings of a spring.
const WINDINGS: u8 = 7;
/// Height of the springs above the rail (travels).
const SPRING_HEIGHT: f32 = 0.06;
/// Most steps of the ruler, as more labels would not stand beside each other; a travel that overshoots by little has no more.
const STEPS: f64 = 5.2;
/// Part of a step by which the travel may miss a tick of the ruler.
const MISS: f64 = 0.02;
/// Length of the arrow of the largest force (travels).
const ARROW: f32 = 0.22;
/// Half the width of what the camera sees, in distances from it: a view half as high as wide.
const VIEW: f32 = 1.05;

/// Half the length of the bed under `bodies` bodies, and its middle (travels).
fn bed(bodies: usize) -> (f32, f32) {
    let coupled = bodies.saturating_sub(1) as f32 * (2.0 * HALF_BODY + GAP);
    let half = (1.0 + coupled + 5.0 * HALF_BODY) / 2.0;
    (half, half - 2.5 * HALF_BODY)
}

/// Camera for `runs` rails of `bodies` bodies: place and target.
pub(crate) fn camera(runs: usize, bodies: usize) -> ([f32; 3], [f32; 3]) {
    let (half, middle) = bed(bodies);
    let depth = LANE * runs.saturating_sub(1) as f32;
    // In a comparison the names of the runs stand at the left.
    let (half, middle) = if runs > 1 { (half + 0.12, middle - 0.12) } else { (half, middle) };
    let away = half / VIEW + 0.15 + 0.5 * depth;
    ([middle, 0.5 * depth - 0.85 * away, 0.55 * away + 0.15 * depth], [middle, 0.5 * depth, 0.04])
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
    if let Some(name) = run.label {
        // Further out for a rail further back, which the bodies before it would cover.
        let place = [-4.0 * HALF_BODY - 0.35 * y, y, 0.0];
        stream.log_static(run.path(&["axis", "name"]), &label(place, name, style::of_run(index)))?;
    }
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
    log_force(stream, run, poses)?;
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
    if !body.labelled {
        return Ok(());
    }
    // Labels stand at different heights, or they would cover each other.
    stream.log_static(path, &label([0.0, 0.0, 0.23 + 0.06 * number as f32], body.name, body.colour))
}

/// A word at `place`.
fn label(place: [f32; 3], word: &str, colour: Rgb) -> Points3D {
    Points3D::new([place]).with_radii([0.001]).with_colors([colour]).with_labels([word]).with_show_labels(true)
}

/// An arrow above the load, as long as it is pushed hard.
fn log_force(stream: &RecordingStream, run: &Run<'_>, poses: &Poses) -> RecordingStreamResult<()> {
    let (Some(force), Some(load)) = (&poses.force, poses.bodies.last()) else { return Ok(()) };
    let peak = range(force).map_or(0.0, |(low, high)| high.max(-low));
    // An arrow stays until the next one: only changes are written.
    let mut shown = 0.0;
    let (mut times, mut arrows, mut counts) = (Vec::new(), Vec::new(), Vec::new());
    for (time, force) in poses.times.iter().zip(force).filter(|(_, force)| force.is_finite()) {
        if force.to_bits() == f64::to_bits(shown) {
            continue;
        }
        shown = *force;
        times.push(*time);
        counts.push(usize::from(shown != 0.0));
        #[expect(clippy::cast_possible_truncation, reason = "rounds, to far less than a pixel")]
        arrows.extend((shown != 0.0).then_some(ARROW * (shown / peak) as f32));
    }
    let path = run.path(&["axis", load.name, "disturbance"]);
    let archetype = Arrows3D::from_vectors(arrows.iter().map(|length| [*length, 0.0, 0.0]))
        .with_origins(arrows.iter().map(|length| [-0.5 * length, 0.0, 0.19]));
    let times = TimeColumn::new_duration_secs(TIMELINE, times);
    stream.send_columns(path.clone(), [times], archetype.columns(counts)?)?;
    let style = Arrows3D::update_fields().with_colors([style::DISTURBANCE]).with_radii([0.012]);
    stream.log_static(path, &style)
}

/// The bed and its two rails.
fn log_bed(stream: &RecordingStream, run: &Run<'_>, bodies: usize, y: f32) -> RecordingStreamResult<()> {
    let (half, middle) = bed(bodies);
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
    let step = round_above(scene.travel / STEPS);
    let scale = Scale::for_peak(&scene.unit, high.abs().max(low.abs()));
    let first = (low / step - MISS).ceil();
    let positions = (0..=5).map(|tick| (first + f64::from(tick)) * step);
    let positions: Vec<f64> = positions.take_while(|position| *position <= high + MISS * step).collect();
    let ticks = positions
        .iter()
        .map(|position| [[scene.place(*position), -0.155, -0.06], [scene.place(*position), -0.10, -0.06]]);
    // Six decimals hide the rounding of a nice number and keep ticks of a short move far from zero apart.
    let number = |position: &f64| (position * scale.factor * 1e6).round() / 1e6;
    let mut labels: Vec<String> = positions.iter().map(|position| number(position).to_string()).collect();
    if let Some(last) = labels.last_mut() {
        *last = format!("{last} {}", scale.unit);
    }
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
