//! `[axis]`: the mechanics.
use super::fmu::Fmu;
use crate::field::Slot;
use crate::simple::OneOf;
use crate::table::table;
use servobench_base::{AxisName, Coordinate};
use servobench_config::Kind::{Axis as InAxis, Plain};
use servobench_config::quantities::{FREQUENCY, INERTIA, LEAD, MASS, POSITION, RATIO};
use servobench_config::{any, not_negative, positive};
use servobench_plant::{ChainParameter, EndStopParameter, FrictionParameter};

table! {
    /// The mechanics: up to three bodies in a row, `motor_side` – `table` – `load`, or a user's MJCF file.
    pub(crate) struct Axis {
        /// Name of this axis: signals may then be called `x.load.position` beside `load.position`. Recording, results and viewer show it.
        /// 1 to 32 letters, digits, `_` and `-`; default: none.
        name: AxisName = (),
        /// Name of an axis in `models/axes`, whose values the other keys override.
        model: String = (),
        /// Source of the values.
        source: String = (),
        /// Motion of the load: along a line, or turning.
        motion: Coordinate = OneOf,
        /// Travel per revolution of a screw, pinion or pulley. Without it a linear axis has a linear motor.
        lead: f64 = positive(Plain(&LEAD), "10 mm"),
        /// Revolutions of the motor per revolution behind the gear; default: 1.
        gear_ratio: f64 = positive(Plain(&RATIO), "5"),
        /// Body that moves with the rotor, in the motor coordinate. The rotor's inertia is added to it.
        motor_side: MotorSide = (),
        /// The body behind the coupling or screw (axis coordinate).
        table: Body = (),
        /// The body that the axis is to position (axis coordinate).
        load: Body = (),
        /// A user's MJCF file instead of bodies.
        mjcf: Mjcf = (),
        /// The mechanics as an FMU, for the engine "fmu"; bodies given as well are for the other engines.
        fmu: Fmu = (),
        /// Period of a modulo axis, which turns without end; default: none, the axis has ends. Function blocks use it.
        modulo: f64 = positive(InAxis(&POSITION), "360 deg"),
        /// Switches along the axis, which a drive on a fieldbus sees.
        switches: Switches = (),
        /// Stops that push the load back at the ends of its travel; default: none, unlimited travel.
        end_stops: EndStops = (),
    }
}

table! {
    /// Switches along the axis and the index pulse of its motor, which a drive on a fieldbus sees.
    pub(crate) struct Switches {
        /// Switch of the negative end: active here and below; default: none.
        negative: f64 = any(InAxis(&POSITION), "-20 mm"),
        /// Switch of the positive end: active here and above; default: none.
        positive: f64 = any(InAxis(&POSITION), "520 mm"),
        /// Home switch; default: none.
        home: HomeSwitch = (),
        /// Angle of the index pulse in each revolution of the motor; default: 0. A linear motor has none.
        index: f64 = any(Plain(&POSITION.rotary), "90 deg"),
    }
}

table! {
    /// Stops at the ends of the travel of the load: springs with dampers that push it back and do not hold it.
    pub(crate) struct EndStops requires ["stiffness"] {
        /// default: none there.
        negative: f64 = EndStopParameter::NEGATIVE,
        /// default: none there.
        positive: f64 = EndStopParameter::POSITIVE,
        stiffness: f64 = EndStopParameter::STIFFNESS,
        /// default: none, the load bounces.
        damping: f64 = EndStopParameter::DAMPING,
    }
}

table! {
    /// Home switch: active from one position to the other.
    pub(crate) struct HomeSwitch requires ["from", "to"] {
        /// Lower end.
        from: f64 = any(InAxis(&POSITION), "0 mm"),
        /// Upper end.
        to: f64 = any(InAxis(&POSITION), "10 mm"),
    }
}

table! {
    /// Body that moves with the rotor, in the motor coordinate.
    pub(crate) struct MotorSide {
        /// Moment of inertia, for a rotary motor.
        inertia: f64 = positive(Plain(&INERTIA), "0.00018 kg m2"),
        /// Mass, for a linear motor.
        mass: f64 = positive(Plain(&MASS), "20 kg"),
        viscous: f64 = FrictionParameter::VISCOUS.of_motor("0.001 Nm s/rad"),
        coulomb: f64 = FrictionParameter::COULOMB.of_motor("0.05 Nm"),
        /// default: equal to it.
        breakaway as "static": f64 = FrictionParameter::BREAKAWAY.of_motor("0.08 Nm"),
        /// default: at once.
        stribeck_velocity: f64 = FrictionParameter::STRIBECK_VELOCITY.of_motor("10 rpm"),
        bias: f64 = ChainParameter::BIAS.of_motor("0.1 Nm"),
    }
}

table! {
    /// A body, in the axis coordinate.
    pub(crate) struct Body {
        /// Mass, on a linear axis.
        mass: f64 = positive(Plain(&MASS), "40 kg"),
        /// Moment of inertia, on a rotary axis.
        inertia: f64 = positive(Plain(&INERTIA), "0.005 kg m2"),
        /// default: rigid.
        stiffness: f64 = ChainParameter::STIFFNESS,
        /// Natural frequency of the body on its coupling, with the body before it held; an alternative to `stiffness`, m·(2πf)².
        frequency: f64 = positive(Plain(&FREQUENCY), "17.5 Hz"),
        damping: f64 = ChainParameter::DAMPING,
        /// Damping ratio of the body on its coupling, with the body before it held; an alternative to `damping`, 2ζ·√(stiffness·m).
        damping_ratio: f64 = not_negative(Plain(&RATIO), "0.02"),
        /// against the ground.
        viscous: f64 = FrictionParameter::VISCOUS,
        /// against the ground.
        coulomb: f64 = FrictionParameter::COULOMB,
        /// default: equal to it.
        breakaway as "static": f64 = FrictionParameter::BREAKAWAY,
        /// default: at once.
        stribeck_velocity: f64 = FrictionParameter::STRIBECK_VELOCITY,
        bias: f64 = ChainParameter::BIAS,
    }
}

/// The keys of the friction of a body, in its own coordinate.
pub(crate) struct FrictionKeys<'a> {
    pub(crate) viscous: &'a Slot<f64>,
    pub(crate) coulomb: &'a Slot<f64>,
    pub(crate) breakaway: &'a Slot<f64>,
    pub(crate) stribeck_velocity: &'a Slot<f64>,
}

impl MotorSide {
    pub(crate) const fn friction(&self) -> FrictionKeys<'_> {
        let Self { viscous, coulomb, breakaway, stribeck_velocity, .. } = self;
        FrictionKeys { viscous, coulomb, breakaway, stribeck_velocity }
    }
}

impl Body {
    pub(crate) const fn friction(&self) -> FrictionKeys<'_> {
        let Self { viscous, coulomb, breakaway, stribeck_velocity, .. } = self;
        FrictionKeys { viscous, coulomb, breakaway, stribeck_velocity }
    }
}

table! {
    /// A user's MJCF file, and the parts of it that are the axis.
    pub(crate) struct Mjcf requires ["file", "motor_joint", "load_joint", "actuator"] {
        /// The file, relative to the file that names it.
        file: String = (),
        /// Joint whose coordinate is the motor's.
        motor_joint: String = (),
        /// Joint of the load. The load's position includes the joints of the same kind below this one, down to the body that carries
        /// motor and load.
        load_joint: String = (),
        /// Motor actuator that applies the drive's torque or force.
        actuator: String = (),
    }
}
