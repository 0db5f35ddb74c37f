//! Requirements on a user's own MJCF file: the axis and the drive that the scenario describes.
//!
//! A joint's coordinate is taken for the motor's, or the load's, as it is. A hinge in place of a slide would show its
//! radians as metres.
use crate::mechanics::MjcfModel;
use crate::refusal::{Refusal, RefusedAt};
use servobench_base::Coordinate;

/// The axis that a file must describe.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct MjcfAxis {
    /// Coordinate of the motor.
    pub motor: Coordinate,
    /// Coordinate of the load.
    pub load: Coordinate,
    /// Largest requested effort of the drive, in the motor's coordinate (N·m or N); infinite without a bound.
    pub max_effort: f64,
}

impl MjcfModel {
    /// Mismatches if motor joint and load joint are of these kinds; none if no axis is required.
    #[must_use]
    pub fn misfits(&self, motor: Coordinate, load: Coordinate) -> Vec<Refusal> {
        let Some(axis) = self.axis else { return Vec::new() };
        let joints = [
            (&self.motor_joint, axis.motor, motor, motor_help(axis)),
            (&self.load_joint, axis.load, load, load_help(axis)),
        ];
        // A single joint for both has the motor's coordinate, which the transmission converts to that of the load.
        let checked = if self.motor_joint == self.load_joint { 1 } else { 2 };
        let wrong = joints.into_iter().enumerate().take(checked).filter(|(_, (_, wanted, found, _))| wanted != found);
        wrong.map(|(i, (name, wanted, _, help))| misfit(name, i == 0, wanted, help)).collect()
    }

    /// Refusal if the drive requests more than the actuator gives within `range` (N·m or N on the joint).
    #[must_use]
    pub fn too_strong(&self, range: [f64; 2]) -> Option<Refusal> {
        // Equal values may differ by the rounding of a product.
        const ROUNDING: f64 = 1e-9;
        let max_effort = self.axis.map(|axis| axis.max_effort).filter(|effort| *effort > 0.0)?;
        let [low, high] = range;
        let beyond = max_effort * (1.0 - ROUNDING);
        if beyond <= high && -beyond >= low {
            return None;
        }
        let unit = self.axis?.motor.effort_unit();
        let name = &self.actuator;
        let asked = if max_effort.is_finite() { format!("up to {max_effort} {unit}") } else { "any effort".into() };
        let message = format!(
            "the drive requests {asked} of actuator `{name}`, and the model limits it to {low} … {high} {unit}; lower \
             the limit of the drive, or widen the range in the file"
        );
        Some(Refusal { place: RefusedAt::Name(name.clone()), message })
    }
}

fn misfit(name: &str, is_motor: bool, wanted: Coordinate, help: &str) -> Refusal {
    let part = if is_motor { "motor" } else { "load" };
    let message = match wanted {
        Coordinate::Linear if is_motor => {
            format!("joint `{name}` turns and the motor is linear: its radians would be taken for metres; {help}")
        }
        Coordinate::Linear => {
            format!("joint `{name}` turns and the axis is linear: its radians would be taken for metres; {help}")
        }
        Coordinate::Rotary => {
            format!("joint `{name}` slides and the {part} turns: its metres would be taken for radians; {help}")
        }
    };
    Refusal { place: RefusedAt::Joint { name: name.to_owned(), is_motor }, message }
}

/// Advice on a motor joint that does not fit.
const fn motor_help(axis: MjcfAxis) -> &'static str {
    match (axis.motor, axis.load) {
        (Coordinate::Linear, _) => "name a slide, or give the axis a `lead` and a motor that turns",
        (Coordinate::Rotary, Coordinate::Linear) => {
            "name a hinge that a tendon couples to the slide by the lead, or take a linear motor and no `lead`"
        }
        (Coordinate::Rotary, Coordinate::Rotary) => "name a hinge, or write `motion = \"linear\"` in `[axis]`",
    }
}

/// Advice on a load joint that does not fit.
const fn load_help(axis: MjcfAxis) -> &'static str {
    match axis.load {
        Coordinate::Linear => "name a slide, or write `motion = \"rotary\"` in `[axis]` with a motor that turns",
        Coordinate::Rotary => "name a hinge, or write `motion = \"linear\"` in `[axis]`, with a `lead`",
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use Coordinate::{Linear, Rotary};

    fn model(motor: Coordinate, load: Coordinate, joints: [&str; 2]) -> MjcfModel {
        let [motor_joint, load_joint] = joints.map(str::to_owned);
        let axis = Some(MjcfAxis { motor, load, max_effort: 7.3 });
        let actuator = "a".into();
        MjcfModel {
            xml: String::new(),
            path: "a.xml".into(),
            motor_joint,
            load_joint,
            actuator,
            transmission: 1.0,
            axis,
            is_smooth: false,
        }
    }

    #[test]
    fn each_joint_has_to_be_of_the_kind_of_its_coordinate() {
        let screw = model(Rotary, Linear, ["m", "l"]);
        assert_eq!(screw.misfits(Rotary, Linear), []);
        let all = screw.misfits(Linear, Rotary);
        let places: Vec<_> = all.iter().map(|refusal| refusal.place.clone()).collect();
        let at = |name: &str, is_motor| RefusedAt::Joint { name: name.into(), is_motor };
        assert_eq!(places, [at("m", true), at("l", false)]);
        assert!(all[0].message.starts_with("joint `m` slides and the motor turns"), "{}", all[0]);
        assert!(all[1].message.starts_with("joint `l` turns and the axis is linear"), "{}", all[1]);
        assert_eq!(MjcfModel { axis: None, ..screw }.misfits(Linear, Rotary), []);
    }

    #[test]
    fn one_joint_that_is_both_has_the_coordinate_of_the_motor() {
        assert_eq!(model(Rotary, Linear, ["m", "m"]).misfits(Rotary, Rotary), []);
        assert_eq!(model(Rotary, Linear, ["m", "m"]).misfits(Linear, Linear).len(), 1);
    }

    #[test]
    fn a_drive_may_ask_for_what_the_actuator_just_gives() {
        let model = model(Linear, Linear, ["m", "m"]);
        assert_eq!(model.too_strong([-7.3, 7.3]), None);
        assert_eq!(model.too_strong([f64::NEG_INFINITY, f64::INFINITY]), None);
        for range in [[-7.3, 7.29], [-7.29, 8.0], [0.0, 8.0]] {
            let refusal = model.too_strong(range).unwrap();
            assert!(refusal.message.contains("up to 7.3 N of"), "{refusal}");
        }
        let endless = MjcfModel { axis: Some(MjcfAxis { max_effort: f64::INFINITY, ..model.axis.unwrap() }), ..model };
        assert!(endless.too_strong([-5.0, 5.0]).unwrap().message.contains("any effort"));
        assert_eq!(endless.too_strong([f64::NEG_INFINITY, f64::INFINITY]), None);
    }
}
