//! A linear axis in 3D: the motor's body on a rail, the others above it on leaf springs, a ruler in front.
//!
//! All bodies share one scale, that of the ruler: a body at 105 mm stands above the mark of 105 mm. Only the deflection relative to the
//! motor is enlarged, by the factor in the title; a pointer at the ruler shows the true position of the load.
use crate::curves::TIMELINE;
use crate::rerun::Mat3x3;
use crate::rerun::{
    Arrows3D, Boxes3D, EntityPath, FillMode, LineStrips3D, Points3D, RecordingStream, RecordingStreamResult,
    TimeColumn, Transform3D,
};
use crate::run::{Run, range};
use crate::scale::{Scale, short};
use crate::scene::{Body, NAMED, Poses, Scene};
use crate::style::{self, Rgb};
use servobench_metrics::round_above;

/// Half the length of a body along the rail, and across it (travels).
const HALF_BODY: f32 = 0.055;
const HALF_WIDTH: f32 = 0.08;
/// Height of the motor's body, and of the others (travels).
const HEIGHTS: (f32, f32) = (0.05, 0.08);
/// Height of the leaf springs between two bodies (travels).
const LEAF: f32 = 0.065;
/// Largest displayed deflection (travels): about half a body.
pub(crate) const ROOM: f64 = 0.08;
/// Distance between the rails of two runs, and of more (travels).
const LANES: (f32, f32) = (0.7, 0.45);
/// Space for the names of runs beside their rails (travels).
const RUN_NAMES: f32 = 0.5;
/// Space for the names beside the bodies (travels).
const NAMES: f32 = 0.2;
/// Largest number of steps of the ruler, as more labels would overlap; a travel with a small overshoot has the same number.
const STEPS: f64 = 5.2;
/// Share of a step by which the travel may miss a tick of the ruler.
const MISS: f64 = 0.02;
/// Length of the arrow of the largest force (travels).
const ARROW: f32 = 0.22;
/// Half the width of the camera's view, in distances from it: a view half as high as wide.
const VIEW: f32 = 1.05;

/// Half the length of the bed.
const HALF_BED: f32 = 0.5 + 2.5 * HALF_BODY;

/// Height of the bottom of body `number`, and half its own height (travels).
fn storey(number: usize) -> (f32, f32) {
    let (motor, other) = HEIGHTS;
    let below = |number: usize| motor + LEAF + (other + LEAF) * (number - 1) as f32;
    if number == 0 { (0.0, motor / 2.0) } else { (below(number), other / 2.0) }
}

/// Place of the rail of run `index` of `runs`.
fn lane(index: usize, runs: usize) -> f32 {
    let (apart, close) = LANES;
    index as f32 * if runs > NAMED { close } else { apart }
}

/// Camera for `runs` rails of `bodies` bodies: place and target.
pub(crate) fn camera(runs: usize, bodies: usize) -> ([f32; 3], [f32; 3]) {
    let depth = lane(runs.saturating_sub(1), runs);
    let (bottom, half) = storey(bodies.saturating_sub(1));
    // Of two runs, the names of one stand at the left and of the other at the right.
    let middle = match runs {
        0 | 1 => 0.5 - NAMES / 2.0,
        2 => 0.5,
        _ => 0.5 - RUN_NAMES / 2.0,
    };
    let height = 0.4 * (bottom + 2.0 * half);
    let away = (HALF_BED + NAMES / 2.0) / VIEW + 0.2 + 0.5 * depth;
    // Steeper for several rails, or the bodies in front would hide those behind.
    let (back, up) = if runs > 1 { (0.72, 0.7) } else { (0.9, 0.45) };
    // Near objects take more of the picture than far ones.
    let target = if runs > NAMED { 0.3 } else { 0.42 } * depth;
    ([middle, target - back * away, height + up * away], [middle, target, height])
}

/// Logs one run.
pub(crate) fn log(
    stream: &RecordingStream,
    run: &Run<'_>,
    index: usize,
    scene: &Scene,
    poses: &Poses,
) -> RecordingStreamResult<()> {
    let y = lane(index, scene.roots.len());
    log_bed(stream, run, y)?;
    if index == 0 {
        log_ruler(stream, run, scene)?;
    }
    let mut below: Option<&Body> = None;
    for (number, body) in poses.bodies.iter().enumerate() {
        if let Some(below) = below {
            log_leaves(stream, run, scene, poses, (below, body), [y, storey(number).0 - LEAF])?;
        }
        let path = run.path(&["axis", body.name]);
        let x = body.positions.iter().map(|position| [scene.place(*position), y, 0.0]);
        poses.send(stream, path.clone(), Transform3D::update_fields().with_many_translation(x))?;
        log_body(stream, path.clone(), body, number)?;
        if let Some(word) = body.label.as_ref().filter(|_| poses.name.is_none()) {
            stream.log_static(path, &label(beside(run, [index, number]), word, body.ink))?;
        }
        below = Some(body);
    }
    log_force(stream, run, poses)?;
    if let Some((name, colour)) = &poses.name {
        let place = [0.5 - HALF_BED - RUN_NAMES / 2.0, y, 0.0];
        stream.log_static(run.path(&["axis", "name"]), &label(place, name, *colour))?;
    }
    let load = poses.bodies.last().filter(|load| load.actual != load.positions);
    let pointers = [
        ("reference", poses.reference.as_ref(), style::REFERENCE),
        ("load_position", load.map(|load| &load.actual), load.map_or(style::LOAD, |load| load.colour)),
    ];
    for (name, positions, colour) in pointers {
        let Some(positions) = positions else { continue };
        let path = run.path(&["axis", name]);
        let x = positions.iter().map(|position| [scene.place(*position), y, 0.0]);
        poses.send(stream, path.clone(), Transform3D::update_fields().with_many_translation(x))?;
        let pointer =
            LineStrips3D::new([[[0.0, -0.15, 0.0], [0.0, -0.085, 0.0]]]).with_colors([colour]).with_radii([0.006]);
        stream.log_static(path, &pointer)?;
    }
    Ok(())
}

/// Four leaf springs between a body and the one above it, with their feet at `y` and `z`.
fn log_leaves(
    stream: &RecordingStream,
    run: &Run<'_>,
    scene: &Scene,
    poses: &Poses,
    (below, above): (&Body, &Body),
    [y, z]: [f32; 2],
) -> RecordingStreamResult<()> {
    let path = run.path(&["axis", "spring", above.name]);
    let feet = below.positions.iter().map(|position| [scene.place(*position), y, z]);
    // Upright edges lean towards the upper body.
    let lean = above.positions.iter().zip(&below.positions).map(|(above, below)| scene.length(above - below));
    let matrices = lean.map(|lean| Mat3x3::from([[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [lean, 0.0, LEAF]]));
    poses.send(
        stream,
        path.clone(),
        Transform3D::update_fields().with_many_translation(feet).with_many_mat3x3(matrices),
    )?;
    let (x, y) = (0.8 * HALF_BODY, 0.8 * HALF_WIDTH);
    let leaf = |x: f32, y: f32| [[x, y, 0.0], [x, y, 1.0]];
    let leaves = LineStrips3D::new([leaf(-x, -y), leaf(-x, y), leaf(x, -y), leaf(x, y)])
        .with_colors([[165, 170, 178]])
        .with_radii([0.006]);
    stream.log_static(path, &leaves)
}

fn log_body(stream: &RecordingStream, path: EntityPath, body: &Body, number: usize) -> RecordingStreamResult<()> {
    let (bottom, half) = storey(number);
    let shape = Boxes3D::from_centers_and_half_sizes([[0.0, 0.0, bottom + half]], [[HALF_BODY, HALF_WIDTH, half]])
        .with_colors([body.colour])
        .with_fill_mode(FillMode::Solid);
    stream.log_static(path, &shape)
}

/// Place of the name of body `number` of run `index`, from that of the body.
fn beside(run: &Run<'_>, [index, number]: [usize; 2]) -> [f32; 3] {
    let (bottom, half) = storey(number);
    // Names of a run must not cover those of the run behind it.
    let side = if index.is_multiple_of(2) { -1.0 } else { 1.0 };
    // With the name of a run in front they are longer, and those of rails further away.
    let (away, height) = if run.label.is_some() { (1.6 * NAMES, 0.19 * number as f32) } else { (NAMES, bottom + half) };
    [side * (HALF_BODY + away / 2.0), 0.0, height]
}

/// A word at `place`.
fn label(place: [f32; 3], word: &str, colour: Rgb) -> Points3D {
    Points3D::new([place]).with_radii([0.001]).with_colors([colour]).with_labels([word]).with_show_labels(true)
}

/// An arrow above the load, with a length in proportion to the force.
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
    let (bottom, half) = storey(poses.bodies.len() - 1);
    let top = bottom + 2.0 * half + 0.03;
    let archetype = Arrows3D::from_vectors(arrows.iter().map(|length| [*length, 0.0, 0.0]))
        .with_origins(arrows.iter().map(|length| [-0.5 * length, 0.0, top]));
    let times = TimeColumn::new_duration_secs(TIMELINE, times);
    stream.send_columns(path.clone(), [times], archetype.columns(counts)?)?;
    let style = Arrows3D::update_fields().with_colors([style::DISTURBANCE]).with_radii([0.012]);
    stream.log_static(path, &style)
}

/// The bed and its two rails.
fn log_bed(stream: &RecordingStream, run: &Run<'_>, y: f32) -> RecordingStreamResult<()> {
    let (half, middle) = (HALF_BED, 0.5);
    let bed = Boxes3D::from_centers_and_half_sizes(
        [[middle, y, -0.035], [middle, y - 0.05, -0.006], [middle, y + 0.05, -0.006]],
        [[half, 0.10, 0.025], [half, 0.008, 0.006], [half, 0.008, 0.006]],
    )
    .with_colors([[72, 77, 86], [140, 145, 154], [140, 145, 154]])
    .with_fill_mode(FillMode::Solid);
    stream.log_static(run.path(&["axis", "bed"]), &bed)
}

/// Ruler of the positions of the bodies, in the unit of the axis.
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
    let mut labels: Vec<String> = positions.iter().map(|position| short(number(position))).collect();
    if let Some(last) = labels.last_mut() {
        *last = format!("{last} {}", scale.unit);
    }
    let ruler = LineStrips3D::new(ticks)
        .with_colors([style::MARK])
        .with_radii([0.002])
        .with_labels(labels)
        .with_show_labels(true);
    stream.log_static(run.path(&["axis", "ruler"]), &ruler)
}
