//! The drive's firmware: what it is set to and what it believes.
use super::motor::Encoder;
use servobench_base::Rate;

/// The drive's firmware, but for what belongs to the kind of motor.
#[derive(Debug, Clone, PartialEq)]
pub struct Drive {
    /// Largest effort it asks for (motor coordinate); infinite without a limit.
    pub max_effort: f64,
    /// Velocity loop.
    pub velocity: VelocityLoop,
    /// Position loop; its rate is a whole fraction of the velocity loop's.
    pub position: PositionLoop,
    /// Which encoder closes the position loop.
    pub position_feedback: Feedback,
    /// Feedforward.
    pub feedforward: Feedforward,
    /// What the firmware believes of the axis.
    pub estimate: Estimate,
}

/// Encoder that closes a loop.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Feedback {
    /// The one on the motor.
    Motor,
    /// This one, on the load.
    Load(Encoder),
}

/// Current loop in dq.
#[derive(Debug, Clone, PartialEq)]
pub struct CurrentLoop {
    /// Task rate; the velocity loop's is a whole fraction of it.
    pub rate: Rate,
    /// What the proportional gains follow from.
    pub gain: CurrentGain,
    /// Integral times (s) d and q; `None`: L/R of the estimated motor.
    pub integral_time: Option<(f64, f64)>,
    /// Reference of the d-axis current, peak (A).
    pub d_reference: f64,
    /// Largest length of the current reference, peak (A).
    pub max_current: f64,
    /// What the firmware believes of the motor.
    pub motor: MotorEstimate,
    /// DC-link voltage that it reckons with (V).
    pub dc_link: f64,
}

/// What the proportional gains of the current loop follow from.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum CurrentGain {
    /// The closed-loop bandwidth (rad/s) and the estimated motor.
    Bandwidth(f64),
    /// They are given.
    PerAxis {
        /// d axis (V/A).
        d: f64,
        /// q axis (V/A).
        q: f64,
    },
}

/// What the firmware believes of a synchronous motor, phase to neutral.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct MotorEstimate {
    /// Electrical angle per motor coordinate: pole pairs (rad/rad), or π/τ_p of a linear motor (rad/m).
    pub electrical_ratio: f64,
    /// Stator resistance (Ω).
    pub resistance: f64,
    /// d-axis inductance (H).
    pub inductance_d: f64,
    /// q-axis inductance (H).
    pub inductance_q: f64,
    /// Flux linkage, peak (V·s).
    pub flux_linkage: f64,
}

/// Velocity loop.
#[derive(Debug, Clone, PartialEq)]
pub struct VelocityLoop {
    /// Task rate.
    pub rate: Rate,
    /// Proportional gain in effort per velocity of the motor coordinate (N·s/m or N·m·s/rad).
    pub gain: f64,
    /// Integral time (s); `None` for a P controller.
    pub integral_time: Option<f64>,
    /// Time constant of the low-pass on the measured velocity (s); 0 for none.
    pub filter_time: f64,
}

/// Position loop.
#[derive(Debug, Clone, PartialEq)]
pub struct PositionLoop {
    /// Task rate.
    pub rate: Rate,
    /// Proportional gain, `K_v` (1/s).
    pub gain: f64,
}

/// Feedforward.
#[derive(Debug, Clone, PartialEq)]
pub struct Feedforward {
    /// Share of the reference velocity that is fed forward, 0 to 1.
    pub velocity: f64,
    /// Whether it goes on between two cycles of the position loop.
    pub interpolate: bool,
    /// Model behind the effort feedforward.
    pub effort: EffortFeedforward,
    /// Whether estimated Coulomb friction and bias are fed forward too.
    pub friction: bool,
    /// How long the reference waits for the feedforward path (s); `None`: as long as the effort path takes.
    pub delay: Option<f64>,
}

/// Model behind the effort feedforward.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum EffortFeedforward {
    /// None.
    Off,
    /// One rigid body: inertia and viscous friction.
    Rigid,
    /// Two bodies and a spring: velocity, acceleration, jerk and snap; the set-point is the load's.
    TwoMass,
}

/// What the firmware believes of the axis, in the axis coordinate unless said otherwise. The tool fills it from the
/// plant; a scenario overrides single values to express mismatch.
#[derive(Debug, Clone, PartialEq)]
pub struct Estimate {
    /// Axis coordinate per motor coordinate (m/rad, or 1).
    pub transmission: f64,
    /// Mass or inertia on the motor's side of the spring (two-mass), rotor included.
    pub motor_inertia: f64,
    /// Mass or inertia beyond the spring; 0 for a rigid axis.
    pub load_inertia: f64,
    /// Spring stiffness (N/m or N·m/rad); infinite for a rigid axis.
    pub stiffness: f64,
    /// Viscous friction on the motor's side.
    pub motor_viscous: f64,
    /// Viscous friction on the load.
    pub load_viscous: f64,
    /// Coulomb friction, all bodies.
    pub coulomb: f64,
    /// Constant resisting effort, all bodies.
    pub bias: f64,
}

impl CurrentLoop {
    /// Largest effort that the current limit leaves, as the firmware believes (N·m or N): 1.5·p·(ψ + (L_d − L_q)·i_d) times
    /// √(I² − i_d²).
    #[must_use]
    pub fn max_effort(&self) -> f64 {
        let MotorEstimate { electrical_ratio, flux_linkage, inductance_d, inductance_q, .. } = self.motor;
        let constant = 1.5 * electrical_ratio * (flux_linkage + (inductance_d - inductance_q) * self.d_reference);
        constant * self.max_q_current()
    }

    /// What the largest length leaves for the q axis (A, peak).
    #[must_use]
    pub fn max_q_current(&self) -> f64 {
        q_current(self.max_current, self.d_reference)
    }
}

/// What a current of at most `max` leaves for the q axis beside `d` (A).
pub(crate) fn q_current(max: f64, d: f64) -> f64 {
    if d == 0.0 { max } else { ((max - d) * (max + d)).max(0.0).sqrt() }
}
