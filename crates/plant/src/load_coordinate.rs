//! Position of the load in a user's own MJCF file.
//!
//! A joint's coordinate is the motion of its body on the body that carries it. Where the motor moves that body too,
//! this is the deflection, and the load's position includes the joints below:
//!
//! ```text
//! x = Σ c_i·q_i      c_i = a_i·a_load
//! Q_i = c_i·f        so that the effort f on the load has the power f·ẋ
//! ```
//! over the load joint and the joints of its kind (slides, or hinges) below it, down to the body that carries
//! both motor joint and load joint. a_i are unit axes in the reference pose: c is 1 for the load joint itself, ±1 for
//! a parallel one, 0 for one at right angles to it. A scale along the load joint's axis reads this when it is fixed to
//! the body that carries both; for hinges an encoder does, exactly so when they are parallel.
use servobench_base::Coordinate;

/// Distance from 0, 1 or −1 within which cosines have that value: rotations in floating point leave some 1e-16 each.
const ROUNDING: f64 = 1e-12;

/// A joint with one degree of freedom, in the reference pose of its model.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PosedJoint {
    /// Number of the joint in the engine.
    pub number: usize,
    /// Slide or hinge.
    pub kind: Coordinate,
    /// Unit vector along its axis, in the world.
    pub axis: [f64; 3],
}

/// The load's coordinate as a sum over joints.
#[derive(Debug, Clone, PartialEq)]
pub struct LoadCoordinate {
    joint: usize,
    /// Joints below it, with their factors.
    below: Vec<(usize, f64)>,
}

impl LoadCoordinate {
    /// Coordinate of the joint `load` on the joints `below_load`, for a motor joint on the joints `below_motor`; both
    /// lists go from the world upwards.
    #[must_use]
    pub fn new(load: PosedJoint, below_load: &[PosedJoint], below_motor: &[PosedJoint]) -> Self {
        let carrying_both =
            below_load.iter().zip(below_motor).take_while(|(one, other)| one.number == other.number).count();
        let below = below_load[carrying_both..]
            .iter()
            .filter(|joint| joint.kind == load.kind)
            .map(|joint| (joint.number, cosine(joint.axis, load.axis)))
            .filter(|(_, cosine)| *cosine != 0.0)
            .collect();
        Self { joint: load.number, below }
    }

    /// Number of the load joint.
    #[must_use]
    pub const fn joint(&self) -> usize {
        self.joint
    }

    /// Joints in the sum for the load's position, with their factors.
    pub fn terms(&self) -> impl Iterator<Item = (usize, f64)> {
        self.below.iter().copied().chain([(self.joint, 1.0)])
    }

    /// The load's position (m or rad) from those of the joints; its velocity from their velocities.
    pub fn of(&self, joint: impl Fn(usize) -> f64) -> f64 {
        self.terms().map(|(number, share)| share * joint(number)).sum()
    }

    /// The load joint's own position that puts the load at `position`, with the other joints as they are; its
    /// velocity likewise.
    pub fn own(&self, position: f64, joint: impl Fn(usize) -> f64) -> f64 {
        self.below.iter().fold(position, |rest, &(number, share)| rest - share * joint(number))
    }
}

/// Cosine of the angle between two unit vectors.
fn cosine(a: [f64; 3], b: [f64; 3]) -> f64 {
    let product: f64 = a.iter().zip(b).map(|(a, b)| a * b).sum();
    let whole = product.round();
    if (product - whole).abs() < ROUNDING { whole } else { product }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::FRAC_PI_3;

    const X: [f64; 3] = [1.0, 0.0, 0.0];
    const Y: [f64; 3] = [0.0, 1.0, 0.0];

    fn slide(number: usize, axis: [f64; 3]) -> PosedJoint {
        PosedJoint { number, kind: Coordinate::Linear, axis }
    }

    fn hinge(number: usize, axis: [f64; 3]) -> PosedJoint {
        PosedJoint { kind: Coordinate::Rotary, ..slide(number, axis) }
    }

    fn terms(load: PosedJoint, below_load: &[PosedJoint], below_motor: &[PosedJoint]) -> Vec<(usize, f64)> {
        LoadCoordinate::new(load, below_load, below_motor).terms().collect()
    }

    #[test]
    fn joints_beside_each_other_count_alone() {
        assert_eq!(terms(slide(1, X), &[], &[]), [(1, 1.0)]);
        let base = slide(0, X);
        assert_eq!(terms(slide(2, X), &[base], &[base]), [(2, 1.0)], "a base that carries both");
    }

    #[test]
    fn a_load_on_the_motor_moves_with_it() {
        let (base, motor) = (slide(0, X), slide(1, X));
        assert_eq!(terms(slide(2, X), &[base, motor], &[base]), [(1, 1.0), (2, 1.0)]);
        assert_eq!(terms(slide(2, [-1.0, 0.0, 0.0]), &[motor], &[]), [(1, -1.0), (2, 1.0)]);
        assert_eq!(terms(motor, &[base], &[base]), [(1, 1.0)], "one joint is both");
    }

    #[test]
    fn a_joint_counts_by_the_cosine_and_by_its_kind() {
        let skew = [FRAC_PI_3.cos(), FRAC_PI_3.sin(), 0.0];
        let found = terms(slide(4, skew), &[slide(0, X), hinge(1, skew), slide(2, Y), slide(3, [0.0, 0.0, 1.0])], &[]);
        let [(0, half), (2, rest), (4, one)] = found[..] else { panic!("{found:?}") };
        assert!((half - 0.5).abs() < 1e-15 && (rest - 0.75_f64.sqrt()).abs() < 1e-15, "{found:?}");
        assert_eq!(one.to_bits(), 1.0_f64.to_bits());
        // A quarter turn in floating point: the cosine is 6e-17.
        let quarter = std::f64::consts::FRAC_PI_2;
        assert_eq!(terms(hinge(1, [quarter.cos(), quarter.sin(), 0.0]), &[hinge(0, X)], &[]), [(1, 1.0)]);
    }

    #[test]
    fn the_load_joint_takes_what_the_others_leave() {
        let load = LoadCoordinate::new(slide(2, X), &[slide(0, X), slide(1, [-1.0, 0.0, 0.0])], &[]);
        let joints = [0.5, 0.125, 0.25];
        // Powers of two: nothing is rounded.
        assert_eq!(load.of(|i| joints[i]).to_bits(), 0.625_f64.to_bits());
        assert_eq!(load.own(0.625, |i| joints[i]).to_bits(), 0.25_f64.to_bits());
    }
}
