//! Colours and widths, the same in every view, distinguishable on a dark and on a light background.

/// Red, green, blue.
pub(crate) type Rgb = [u8; 3];

/// Reference position and set-point.
pub(crate) const REFERENCE: Rgb = [175, 175, 175];
/// Request of the task.
pub(crate) const REQUEST: Rgb = [200, 170, 40];
/// Motor side.
pub(crate) const MOTOR: Rgb = [66, 135, 245];
/// A body between motor and load.
pub(crate) const TABLE: Rgb = [46, 184, 150];
/// Load side.
pub(crate) const LOAD: Rgb = [245, 140, 40];
/// A second quantity beside the main one.
pub(crate) const AUXILIARY: Rgb = [160, 110, 230];
/// Iron losses.
pub(crate) const IRON: Rgb = [165, 110, 70];
/// Disturbances.
pub(crate) const DISTURBANCE: Rgb = [230, 90, 160];
/// Inactive state.
pub(crate) const IDLE: Rgb = [52, 56, 64];
/// A bound by motor, drive or plan, or an error.
pub(crate) const LIMIT: Rgb = [225, 70, 80];
/// A bound by which a run is judged.
pub(crate) const ALLOWED: Rgb = [200, 60, 190];
/// An instant that is marked.
pub(crate) const MARK: Rgb = [128, 134, 145];

/// One colour per run of a comparison; starts again after the last. All differ from those of bounds.
const RUNS: [Rgb; 6] = [LOAD, [40, 180, 220], [110, 190, 70], [160, 110, 230], [165, 110, 70], [200, 170, 40]];

/// Colour of a run in a comparison.
pub(crate) fn of_run(index: usize) -> Rgb {
    RUNS[index % RUNS.len()]
}
