//! `[drive]`: the firmware.
use super::inverter::{Inverter, Link};
use super::supervision::Supervision;
use crate::field::{Either, EitherMeasure};
use crate::file::{
    CoggingHarmonic, CurrentSensor, DeadTimeCompensation, Encoder, GainSchedule, I2t, Mount, TorqueFilter,
};
use crate::list::{Automatic, Many, Share};
use crate::object_table::ObjectTable;
use crate::simple::OneOf;
use crate::table::table;
use servobench_base::Rate;
use servobench_config::Kind::{Axis as InAxis, Motor as InMotor, Plain};
use servobench_config::quantities::{
    BANDWIDTH, FORCE, INERTIAL, LEAD, POSITION_GAIN, RATIO, TIME, TORQUE, VISCOUS, VOLT_GAIN,
};
use servobench_config::{choices, not_negative, positive};
use servobench_drive::current::operating_point::{self, Strategy};
use servobench_drive::measurement::{Method, mt, observer};
use servobench_drive::{
    self as drive, BlockParameter, Blocks, EffortFeedforward, current, derivative, feedforward, position, velocity,
};

choices! {
    /// Encoder that closes the position loop.
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
    /// The firmware of the drive: position, velocity and current loops in a cascade. It knows the axis only by its sensors and its
    /// estimates.
    pub(crate) struct Drive {
        /// Name of a drive in `models/drives`, whose values the other keys override.
        model: String = (),
        /// Source of the values.
        source: String = (),
        /// Power stage on; default: true. Off: no current, no force, and the axis is free.
        enabled: bool = (),
        dc_link: f64 = current::Parameter::DC_LINK,
        /// Largest torque that the drive requests, besides the limit by the motor's current or the `limit` of an ideal source.
        max_torque: f64 = positive(Plain(&TORQUE), "12 Nm"),
        /// Largest force that the drive requests, with a linear motor.
        max_force: f64 = positive(Plain(&FORCE), "300 N"),
        /// Encoder that closes the position loop; default: the motor's.
        position_feedback: FeedbackEncoder = OneOf,
        /// Inverter of a synchronous motor; default: an ideal one.
        inverter: Inverter = (),
        /// DC link of that inverter; default: a constant voltage.
        link: Link = (),
        /// Current loop of a synchronous motor.
        current: Current = (),
        /// Velocity loop.
        velocity: Velocity = (),
        /// Position loop.
        position: Position = (),
        /// Filters in the torque path, one after the other; `[[drive.filter]]` for each.
        filter: Many<TorqueFilter> = (),
        /// Harmonics of cogging that the drive compensates by the measured position; `[[drive.cogging]]` for each, eight at most.
        cogging: Many<CoggingHarmonic> = (),
        /// Gains over speed; default: none.
        gain_schedule: GainSchedule = (),
        /// I²t of motor and drive; default: none.
        i2t: I2t = (),
        /// Supervision of motor and power stage; default: none.
        supervision: Supervision = (),
        /// Feedforward; default: none.
        feedforward: Feedforward = (),
        /// The firmware's model of the axis; default: the true values.
        estimate: Estimate = (),
        /// Encoder on the load; default: none.
        load_encoder: Encoder = Mount::Load,
        /// Values that the master writes to the drive's objects (CiA 402) before the first cycle of `[bus]`: whole numbers by index and
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
        /// instead of the bandwidth.
        gain_d: f64 = current::Parameter::GAIN_D,
        /// instead of the bandwidth.
        gain_q: f64 = current::Parameter::GAIN_Q,
        /// default: L/R of the estimated motor.
        integral_time_d: f64 = current::Parameter::INTEGRAL_TIME_D,
        /// default: L/R of the estimated motor.
        integral_time_q: f64 = current::Parameter::INTEGRAL_TIME_Q,
        /// default: 0. The torque or force per q-axis current is then that of 1.5·p·(ψ + (L_d − L_q)·i_d) of the
        /// estimated motor, and `max_current` bounds the vector of both.
        d_reference: f64 = current::Parameter::D_REFERENCE,
        /// Choice of the d-axis current for a torque or force; default: "d-reference".
        strategy: Strategy = OneOf,
        /// Field weakening by the d-axis current at the voltage limit, from the estimated motor and DC link; default: false.
        field_weakening: bool = (),
        /// default: 0.95.
        field_weakening_share: f64 = operating_point::Parameter::SHARE,
        /// default: none.
        field_weakening_feedback: f64 = operating_point::Parameter::FEEDBACK,
        /// Voltage limit from the measured DC link, not from the estimated one; default: false.
        measured_dc_link: bool = (),
        /// Compensation of the inverter's dead time; default: none.
        dead_time_compensation: DeadTimeCompensation = (),
        /// Sensors of the current; default: without error.
        sensor: CurrentSensor = (),
    }
}

table! {
    /// Velocity loop, in the motor coordinate.
    pub(crate) struct Velocity sets Blocks {
        /// Task rate; it divides the rate of the current loop, or the base rate where there is none.
        rate: Rate = "8 kHz",
        /// P or PI; default: PI.
        kind: VelocityKind = OneOf,
        /// Closed-loop bandwidth ω, from which the gain follows: the estimated inertia times ω.
        bandwidth: f64 = positive(Plain(&BANDWIDTH), "100 Hz"),
        /// Proportional gain instead of the bandwidth: torque or force per velocity, or volts per velocity of an ideal
        /// source.
        gain: Either = EitherMeasure { first: InMotor(&VISCOUS), second: InMotor(&VOLT_GAIN), example: "243.45 V s/m" },
        /// default: 4/ω.
        integral_time: f64 = velocity::Parameter::INTEGRAL_TIME,
        /// default: none.
        filter_time: f64 = drive::Parameter::VELOCITY_FILTER_TIME,
        /// default: none.
        max_speed: f64 = BlockParameter::MAX_SPEED => max_speed,
        /// default: 1.
        reference_weight: f64 = BlockParameter::REFERENCE_WEIGHT => reference_weight,
        /// Method of measuring the motor's velocity; by default an encoder without increments and errors gives the velocity itself, and
        /// the drive takes differences of the positions of any other.
        measurement: Method = OneOf,
        /// (with "mt"); default: 100 ns.
        timer: f64 = mt::Parameter::TIMER,
        /// The observer (with "observer").
        observer: Observer = (),
        /// default: none.
        derivative_time: f64 = derivative::Parameter::VELOCITY_TIME,
        /// default: a tenth of `derivative_time`.
        derivative_filter_time: f64 = derivative::Parameter::VELOCITY_FILTER_TIME,
    }
}

table! {
    /// An observer of position, velocity and disturbance of the motor, by the estimated inertia and the effort that the drive requests.
    pub(crate) struct Observer requires ["bandwidth"] {
        bandwidth: f64 = observer::Parameter::OBSERVER_BANDWIDTH,
        /// default: 0.
        disturbance_compensation: f64 = observer::Parameter::COMPENSATION,
    }
}

table! {
    /// Position loop: proportional, with integral and derivative where their times are given.
    pub(crate) struct Position {
        /// Task rate; it divides the rate of the velocity loop.
        rate: Rate = "4 kHz",
        /// Closed-loop bandwidth; the gain is the same number in rad/s.
        bandwidth: f64 = positive(Plain(&BANDWIDTH), "20 Hz"),
        /// Proportional gain K_v instead of the bandwidth.
        gain: f64 = positive(Plain(&POSITION_GAIN), "160 1/s"),
        /// default: none.
        integral_time: f64 = position::Parameter::INTEGRAL_TIME,
        /// default: none.
        derivative_time: f64 = derivative::Parameter::POSITION_TIME,
        /// default: a tenth of `derivative_time`.
        derivative_filter_time: f64 = derivative::Parameter::POSITION_FILTER_TIME,
    }
}

table! {
    /// Feedforward from the set-point.
    pub(crate) struct Feedforward {
        /// Share of the reference velocity that is added to the velocity command; `true` is all of it; default: none.
        velocity: Share = (),
        /// Continues that velocity along the set-point between two cycles of a slower position loop, with one value for each cycle of
        /// the velocity loop; default: true. `false`: a staircase, which causes torque ripple.
        interpolate: bool = (),
        /// Model of the force or torque that is added; default: "off".
        effort: EffortFeedforward = OneOf,
        /// Adds estimated Coulomb friction and bias; default: false.
        friction: bool = (),
        /// Delay of the reference, which matches the feedforward path; default: "auto", the delay of that path.
        delay: Automatic = not_negative(Plain(&TIME), "125 us"),
    }
}

table! {
    /// The firmware's model of the axis, in the axis coordinate; default: the true values of the plant.
    pub(crate) struct Estimate {
        /// Travel per revolution of the screw, pinion or pulley.
        lead: f64 = positive(Plain(&LEAD), "10 mm"),
        /// Revolutions of the motor per revolution behind the gear.
        gear_ratio: f64 = positive(Plain(&RATIO), "5"),
        /// Mass or inertia on the motor's side of the softest spring, rotor included.
        motor_inertia: f64 = positive(InAxis(&INERTIAL), "20 kg"),
        load_inertia: f64 = feedforward::Parameter::LOAD_INERTIA,
        stiffness: f64 = feedforward::Parameter::STIFFNESS,
        motor_viscous: f64 = feedforward::Parameter::MOTOR_VISCOUS,
        load_viscous: f64 = feedforward::Parameter::LOAD_VISCOUS,
        coulomb: f64 = feedforward::Parameter::COULOMB,
        bias: f64 = feedforward::Parameter::BIAS,
        gain: f64 = drive::Parameter::DIRECT_GAIN,
        dc_link: f64 = current::Parameter::DC_LINK,
        /// The synchronous motor.
        motor: EstimatedMotor = (),
    }
}

table! {
    /// The firmware's model of the synchronous motor, phase to neutral.
    pub(crate) struct EstimatedMotor {
        resistance: f64 = current::Parameter::RESISTANCE,
        inductance_d: f64 = current::Parameter::INDUCTANCE_D,
        inductance_q: f64 = current::Parameter::INDUCTANCE_Q,
        flux_linkage: f64 = current::Parameter::FLUX_LINKAGE,
    }
}
