//! A rotary axis in 3D: discs on a shaft, a mark on each.
use crate::rerun::{
    Angle, Boxes3D, Cylinders3D, EntityPath, FillMode, LineStrips3D, Points3D, RecordingStream, RecordingStreamResult,
    RotationAxisAngle, Transform3D,
};
use crate::run::Run;
use crate::scene::{NAMED, Poses};
use crate::style;
use std::f32::consts::FRAC_PI_2;
use std::f64::consts::TAU;

/// Largest displayed deflection (rad).
pub(crate) const ROOM: f64 = 0.35;
/// Distance between two discs along the shaft (radii).
const SPACING: f32 = 2.2;
/// Half the thickness of a disc (radii).
const HALF_DISC: f32 = 0.16;
/// Distance along the shaft between the last disc of a run and the first of the next (radii).
const LANE: f32 = 2.8;
/// The shaft's direction.
const SHAFT: [f32; 3] = [1.0, 0.0, 0.0];

/// Camera for `runs` shafts of `bodies` discs: place and target.
pub(crate) fn camera(runs: usize, bodies: usize) -> ([f32; 3], [f32; 3]) {
    let middle = (start(runs, bodies) - LANE) / 2.0;
    if runs > NAMED {
        // From the front, or the discs at the far end would be too small; as far away as all of them need.
        let away = 1.2 * middle + 2.5;
        return ([middle - 0.5 * away, -0.85 * away, 0.25 * away], [middle, 0.0, 0.1]);
    }
    ([middle - 2.8, -2.2 - 0.6 * middle, 0.9 + 0.1 * middle], [middle, 0.0, 0.1])
}

/// Place of the first disc of run `index` along the shaft.
fn start(index: usize, bodies: usize) -> f32 {
    index as f32 * (SPACING * bodies.saturating_sub(1) as f32 + LANE)
}

/// Logs one run.
pub(crate) fn log(stream: &RecordingStream, run: &Run<'_>, index: usize, poses: &Poses) -> RecordingStreamResult<()> {
    let start = start(index, poses.bodies.len());
    let last = SPACING * poses.bodies.len().saturating_sub(1) as f32;
    let shaft = Cylinders3D::from_lengths_and_radii([last + 1.0], [0.07])
        .with_centers([[start + last / 2.0, 0.0, 0.0]])
        .with_rotation_axis_angles([along_shaft()])
        .with_colors([[130, 134, 142]])
        .with_fill_mode(FillMode::Solid);
    stream.log_static(run.path(&["axis", "shaft"]), &shaft)?;
    for (number, body) in poses.bodies.iter().enumerate() {
        let path = run.path(&["axis", body.name]);
        let place = [start + SPACING * number as f32, 0.0, 0.0];
        turn(stream, poses, &path, place, &body.positions)?;
        let disc = Cylinders3D::from_lengths_and_radii([2.0 * HALF_DISC], [1.0])
            .with_rotation_axis_angles([along_shaft()])
            .with_colors([body.colour])
            .with_fill_mode(FillMode::Solid);
        stream.log_static(path.clone(), &disc)?;
        // A mark on the face, without which the rotation of a disc is not visible.
        let mark = Boxes3D::from_centers_and_half_sizes([[0.0, 0.0, 0.5]], [[HALF_DISC + 0.02, 0.06, 0.45]])
            .with_colors([[245, 245, 245]])
            .with_fill_mode(FillMode::Solid);
        stream.log_static(path, &mark)?;
        if let Some(word) = body.label.as_ref().filter(|_| poses.name.is_none()) {
            // A separate entity, as it must not turn with the disc.
            let label = Points3D::new([[place[0], 0.0, 1.55]])
                .with_radii([0.001])
                .with_colors([body.ink])
                .with_labels([word.as_str()])
                .with_show_labels(true);
            stream.log_static(run.path(&["axis", "label", body.name]), &label)?;
        }
    }
    if let Some((name, colour)) = &poses.name {
        let label = Points3D::new([[start + last / 2.0, 0.0, 1.55]])
            .with_radii([0.001])
            .with_colors([*colour])
            .with_labels([name.as_str()])
            .with_show_labels(true);
        stream.log_static(run.path(&["axis", "name"]), &label)?;
    }
    if let Some(reference) = &poses.reference {
        let path = run.path(&["axis", "reference"]);
        turn(stream, poses, &path, [start, 0.0, 0.0], reference)?;
        let pointer =
            LineStrips3D::new([[[0.0, 0.0, 1.02], [0.0, 0.0, 1.3]]]).with_colors([style::REFERENCE]).with_radii([0.04]);
        stream.log_static(path, &pointer)?;
    }
    Ok(())
}

/// Turns a cylinder from its own direction, z, to the shaft's.
fn along_shaft() -> RotationAxisAngle {
    RotationAxisAngle::new([0.0, 1.0, 0.0], Angle::from_radians(FRAC_PI_2))
}

fn turn(
    stream: &RecordingStream,
    poses: &Poses,
    path: &EntityPath,
    place: [f32; 3],
    angles: &[f64],
) -> RecordingStreamResult<()> {
    // Within one turn, as f32 would lose the angle after many.
    #[expect(clippy::cast_possible_truncation, reason = "rounds, to a millionth of a turn")]
    let rotations = angles.iter().map(|angle| angle.rem_euclid(TAU) as f32);
    let rotations = rotations.map(|angle| RotationAxisAngle::new(SHAFT, Angle::from_radians(angle)));
    let places = std::iter::repeat_n(place, angles.len());
    let transforms =
        Transform3D::update_fields().with_many_translation(places).with_many_rotation_axis_angle(rotations);
    poses.send(stream, path.clone(), transforms)
}
