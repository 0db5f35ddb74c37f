//! The Gauss method of two stages, of fourth order: the part common to all windings that are solved by it. Source: Hairer, Lubich and
//! Wanner, *Geometric Numerical Integration*, 2nd ed., ch. II.1.
use super::FluxHarmonic;

/// Largest turn of a harmonic in a part of a tick (rad).
const LARGEST_TURN_OF_A_HARMONIC: f64 = 0.5;
/// Largest turn of the rotor (rad), and largest decay of a current, in a part.
const LARGEST_PART: f64 = 0.25;
/// Largest number of parts of a tick: a rotor so fast turns through a thousand radians in a tick.
pub(super) const MOST_PARTS: f64 = 4096.0;

/// √3/6.
pub(super) const OFF_THE_MIDDLE: f64 = 0.288_675_134_594_812_9;
/// Instants of the stages in a part.
pub(super) const STAGES: [f64; 2] = [0.5 - OFF_THE_MIDDLE, 0.5 + OFF_THE_MIDDLE];
/// a_jn.
pub(super) const WEIGHTS: [[f64; 2]; 2] = [[0.25, 0.25 - OFF_THE_MIDDLE], [0.25 + OFF_THE_MIDDLE, 0.25]];

/// Number of parts of a time in which a current decays by `decay`, the rotor turns by `turn` (rad) past these harmonics, and other changes
/// need `others` parts.
pub(super) fn parts(decay: f64, turn: f64, harmonics: &[FluxHarmonic], others: f64) -> u32 {
    let order = harmonics.iter().map(|harmonic| harmonic.order).max().unwrap_or(0);
    let of_harmonics = f64::from(order) * turn.abs() / LARGEST_TURN_OF_A_HARMONIC;
    let parts = of_harmonics.max(decay.max(turn.abs()) / LARGEST_PART).max(others).clamp(1.0, MOST_PARTS);
    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "from 1 to 4096")]
    let whole = libm::ceil(parts) as u32;
    whole.max(1)
}

/// Gaussian elimination with the largest pivot of each column.
pub(super) fn solved(mut system: [[f64; 5]; 4]) -> [f64; 4] {
    for column in 0..4 {
        let mut largest = column;
        for row in column + 1..4 {
            if system[row][column].abs() > system[largest][column].abs() {
                largest = row;
            }
        }
        system.swap(column, largest);
        let pivot = system[column];
        for row in &mut system[column + 1..] {
            let factor = row[column] / pivot[column];
            for (entry, above) in row.iter_mut().zip(pivot).skip(column) {
                *entry -= factor * above;
            }
        }
    }
    let mut x = [0.0; 4];
    for row in (0..4).rev() {
        let known: f64 = (row + 1..4).map(|n| system[row][n] * x[n]).sum();
        x[row] = (system[row][4] - known) / system[row][row];
    }
    x
}
