//! `[drive]`: the firmware.
use crate::field::{Either, EitherMeasure};
use crate::list::{AutoTime, Share};
use crate::object_table::ObjectTable;
use crate::simple::OneOf;
use crate::table::table;
use servobench_base::Rate;
use servobench_config::Kind::{Axis as InAxis, Motor as InMotor, Plain};
use servobench_config::quantities::{
    BANDWIDTH, CURRENT, CURRENT_GAIN, EFFORT, FLUX_LINKAGE, FORCE, INDUCTANCE, INERTIAL, LEAD, POSITION, POSITION_GAIN,
    RATIO, RESISTANCE, SOURCE_GAIN, STIFFNESS, TIME, TORQUE, VISCOUS, VOLT_GAIN, VOLTAGE,
};
use servobench_config::{any, choices, not_negative, positive};
use servobench_drive::EffortFeedforward;

choices! {
    /// Which encoder closes the position loop.
    pub(crate) enum FeedbackEncoder {
        /// the encoder on the motor
        Motor = "motor",
        /// the encoder on the load
        Load = "load",
    }
}

choices! {
    /// P or PI.
    pub(crate) enum VelocityKind {
        /// proportional
        P = "p",
        /// proportional and integral
        Pi = "pi",
    }
}

table! {
    /// The firmware of the drive: position, velocity and current loops in a cascade. It knows the axis by its sensors and
    /// its own estimates only.
    pub(crate) struct Drive {
        /// Name of a drive in `models/drives`, whose values the other keys override.
        model: String = (),
        /// Where the values come from.
        source: String = (),
        /// Whether the power stage is on; it is unless given. Off: no current, no force, and the axis is free.
        enabled: bool = (),
        /// Voltage of the DC link.
        dc_link: f64 = positive(Plain(&VOLTAGE), "540 V"),
        /// Largest torque that the drive asks for, besides what the current limit of the motor or the `limit` of an ideal
        /// source allows.
        max_torque: f64 = positive(Plain(&TORQUE), "12 Nm"),
        /// Largest force that the drive asks for, with a linear motor.
        max_force: f64 = positive(Plain(&FORCE), "300 N"),
        /// Encoder that closes the position loop; the motor's unless given.
        position_feedback: FeedbackEncoder = OneOf,
        /// Current loop of a synchronous motor.
        current: Current = (),
        /// Velocity loop.
        velocity: Velocity = (),
        /// Position loop.
        position: Position = (),
        /// Feedforward; none unless given.
        feedforward: Feedforward = (),
        /// What the firmware believes of the axis; the truth unless given.
        estimate: Estimate = (),
        /// Encoder on the load; there is none unless given.
        load_encoder: LoadEncoder = (),
        /// What the master writes into the drive's objects (CiA 402) before the first cycle of `[bus]`: whole numbers by index and
        /// sub-index.
        objects: ObjectTable = (),
    }
}

table! {
    /// Current loop in dq: PI per axis, decoupled.
    pub(crate) struct Current {
        /// Task rate; it divides the base rate.
        rate: Rate = "16 kHz",
        /// Closed-loop bandwidth α, from which the gains follow: k_p = α·L, T_i = L/R.
        bandwidth: f64 = positive(Plain(&BANDWIDTH), "1 kHz"),
        /// Proportional gain of the d axis instead of the bandwidth.
        gain_d: f64 = positive(Plain(&CURRENT_GAIN), "12 V/A"),
        /// Proportional gain of the q axis instead of the bandwidth.
        gain_q: f64 = positive(Plain(&CURRENT_GAIN), "12 V/A"),
        /// Integral time of the d axis; L/R of the estimated motor unless given.
        integral_time_d: f64 = positive(Plain(&TIME), "5 ms"),
        /// Integral time of the q axis; L/R of the estimated motor unless given.
        integral_time_q: f64 = positive(Plain(&TIME), "5 ms"),
        /// Reference of the d-axis current; 0 unless given. The torque or force per q-axis current is then that of
        /// 1.5·p·(ψ + (L_d − L_q)·i_d) of the estimated motor, and `max_current` bounds the vector of both.
        d_reference: f64 = any(Plain(&CURRENT), "-20 Arms"),
    }
}

table! {
    /// Velocity loop, in the motor coordinate.
    pub(crate) struct Velocity {
        /// Task rate; it divides the rate of the current loop, or the base rate where there is none.
        rate: Rate = "8 kHz",
        /// P or PI; PI unless given.
        kind: VelocityKind = OneOf,
        /// Closed-loop bandwidth ω, from which the gain follows: the estimated inertia times ω.
        bandwidth: f64 = positive(Plain(&BANDWIDTH), "100 Hz"),
        /// Proportional gain instead of the bandwidth: torque or force per velocity, or volts per velocity of an ideal
        /// source.
        gain: Either = EitherMeasure { first: InMotor(&VISCOUS), second: InMotor(&VOLT_GAIN), example: "243.45 V s/m" },
        /// Integral time of a PI; 4/ω unless given.
        integral_time: f64 = positive(Plain(&TIME), "6 ms"),
        /// Time constant of the low-pass on the measured velocity; none unless given.
        filter_time: f64 = not_negative(Plain(&TIME), "0.1 ms"),
    }
}

table! {
    /// Position loop: proportional.
    pub(crate) struct Position {
        /// Task rate; it divides the rate of the velocity loop.
        rate: Rate = "4 kHz",
        /// Closed-loop bandwidth; the gain is the same number in rad/s.
        bandwidth: f64 = positive(Plain(&BANDWIDTH), "20 Hz"),
        /// Proportional gain K_v instead of the bandwidth.
        gain: f64 = positive(Plain(&POSITION_GAIN), "160 1/s"),
    }
}

table! {
    /// Feedforward from the set-point.
    pub(crate) struct Feedforward {
        /// Share of the reference velocity that is added to the velocity command; `true` is all of it. None unless given.
        velocity: Share = (),
        /// Whether that velocity goes on along the set-point between two cycles of a slower position loop, one value for each
        /// cycle of the velocity loop; it does unless given. `false`: a staircase, which costs torque ripple.
        interpolate: bool = (),
        /// Model of the force or torque that is added; "off" unless given.
        effort: EffortFeedforward = OneOf,
        /// Whether estimated Coulomb friction and bias are added too; they are not unless given.
        friction: bool = (),
        /// How long the reference waits for the feedforward path; "auto", as long as that path takes, unless given.
        delay: AutoTime = (),
    }
}

table! {
    /// What the firmware believes of the axis, in the axis coordinate. Each value is the plant's own unless given.
    pub(crate) struct Estimate {
        /// Travel per revolution of the screw, pinion or pulley.
        lead: f64 = positive(Plain(&LEAD), "10 mm"),
        /// Revolutions of the motor per revolution behind the gear.
        gear_ratio: f64 = positive(Plain(&RATIO), "5"),
        /// Mass or inertia on the motor's side of the softest spring, rotor included.
        motor_inertia: f64 = positive(InAxis(&INERTIAL), "20 kg"),
        /// Mass or inertia beyond that spring.
        load_inertia: f64 = not_negative(InAxis(&INERTIAL), "10 kg"),
        /// Stiffness of that spring.
        stiffness: f64 = positive(InAxis(&STIFFNESS), "0.6 N/um"),
        /// Viscous friction on the motor's side.
        motor_viscous: f64 = not_negative(InAxis(&VISCOUS), "10 N s/m"),
        /// Viscous friction on the load.
        load_viscous: f64 = not_negative(InAxis(&VISCOUS), "10 N s/m"),
        /// Coulomb friction of all bodies.
        coulomb: f64 = not_negative(InAxis(&EFFORT), "20 N"),
        /// Constant resisting force or torque on all bodies.
        bias: f64 = any(InAxis(&EFFORT), "-3 N"),
        /// Force or torque per volt of an ideal source.
        gain: f64 = positive(InMotor(&SOURCE_GAIN), "35.1507 N/V"),
        /// Voltage of the DC link.
        dc_link: f64 = positive(Plain(&VOLTAGE), "540 V"),
        /// The synchronous motor.
        motor: EstimatedMotor = (),
    }
}

table! {
    /// What the firmware believes of the synchronous motor, phase to neutral.
    pub(crate) struct EstimatedMotor {
        /// Stator resistance.
        resistance: f64 = positive(Plain(&RESISTANCE), "0.36 Ohm"),
        /// Inductance of the d axis.
        inductance_d: f64 = positive(Plain(&INDUCTANCE), "36 mH"),
        /// Inductance of the q axis.
        inductance_q: f64 = positive(Plain(&INDUCTANCE), "51 mH"),
        /// Flux linkage, amplitude.
        flux_linkage: f64 = positive(Plain(&FLUX_LINKAGE), "0.545 V s"),
    }
}

table! {
    /// Encoder on the load: give one of the two, or none for an ideal one.
    pub(crate) struct LoadEncoder {
        /// Increments per revolution, on a rotary axis.
        counts_per_rev: u32 = 1..=u32::MAX,
        /// One increment.
        step: f64 = positive(InAxis(&POSITION), "0.1 um"),
    }
}
