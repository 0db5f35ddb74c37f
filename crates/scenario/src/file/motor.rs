//! `[motor]`: the motor or source of the axis.
use crate::field::{Either, EitherMeasure};
use crate::file::motor_effects::{
    Cogging, Connection, FluxHarmonic, FluxMap, IronLoss, Saturation, Temperature, Thermal,
};
use crate::file::{Encoder, Mount};
use crate::list::Many;
use crate::simple::OneOf;
use crate::table::table;
use servobench_config::Kind::{Motor as InMotor, Plain};
use servobench_config::quantities::{
    BACK_EMF, EFFORT, FORCE_CONSTANT, INDUCTANCE, INERTIA, MASS, POSITION, SOURCE_GAIN, TORQUE_CONSTANT, VOLTAGE,
};
use servobench_config::{choices, positive};
use servobench_drive::current;
use servobench_plant::pmsm;

choices! {
    /// Kind of motor.
    pub(crate) enum MotorKind {
        /// a permanent-magnet synchronous motor, turning or linear, on an averaged inverter
        Pmsm = "pmsm",
        /// effort = gain × output, the output saturating at `limit`
        IdealSource = "ideal-source",
        /// the motor side follows the set-point exactly
        Prescribed = "prescribed",
    }
}

table! {
    /// The motor of the axis. Values of a synchronous motor are phase to neutral, flux linkage and currents are amplitudes
    /// inside; the unit distinguishes `Arms` from `Apk`.
    pub(crate) struct Motor {
        /// Name of a motor in `models/motors`, whose values the other keys override.
        model: String = (),
        /// Source of the values.
        source: String = (),
        /// Kind of motor.
        kind: MotorKind = OneOf,
        /// Pole pairs p of a motor that turns.
        pole_pairs: u32 = 1..=1000,
        /// Distance τ_p from a north pole to the next south pole of a linear motor, half an electrical period. Catalogues
        /// that give the pitch from north to north give twice that.
        pole_pitch: f64 = positive(Plain(&POSITION.linear), "16 mm"),
        resistance: f64 = pmsm::Parameter::RESISTANCE,
        /// Inductance of both axes, phase to neutral.
        inductance: f64 = positive(Plain(&INDUCTANCE), "0.2 mH"),
        inductance_d: f64 = pmsm::Parameter::INDUCTANCE_D,
        inductance_q: f64 = pmsm::Parameter::INDUCTANCE_Q,
        flux_linkage: f64 = pmsm::Parameter::FLUX_LINKAGE,
        /// Torque per current instead of the flux linkage: 1.5·p·ψ in Nm/Apk.
        torque_constant: f64 = positive(Plain(&TORQUE_CONSTANT), "0.3 Nm/Arms"),
        /// Force per current of a linear motor instead of the flux linkage: 1.5·(π/τ_p)·ψ in N/Apk.
        force_constant: f64 = positive(Plain(&FORCE_CONSTANT), "80 N/Arms"),
        /// Back-EMF per speed, line to line, instead of the flux linkage: √3·p·ψ in Vpk per rad/s; of a linear motor
        /// √3·(π/τ_p)·ψ in Vpk per m/s ("65 Vpk s/m").
        back_emf: f64 = positive(InMotor(&BACK_EMF), "4.64 Vpk/krpm"),
        /// Moment of inertia of the rotor.
        inertia: f64 = positive(Plain(&INERTIA), "0.00018 kg m2"),
        /// Mass of the moving part of a linear motor.
        mass: f64 = positive(Plain(&MASS), "3 kg"),
        /// : the drive requests no more.
        max_current: f64 = current::Parameter::MAX_CURRENT,
        /// Force or torque per volt of an ideal source; without it the output is the force or torque itself.
        gain: f64 = positive(InMotor(&SOURCE_GAIN), "35.1507 N/V"),
        /// Largest output of an ideal source, in volts or as force or torque; default: unlimited.
        limit: Either = EitherMeasure { first: Plain(&VOLTAGE), second: InMotor(&EFFORT), example: "10 V" },
        /// Harmonics of the cogging; `[[motor.cogging]]` for each.
        cogging: Many<Cogging> = (),
        /// Harmonics of the flux linkage; `[[motor.flux_harmonic]]` for each.
        flux_harmonic: Many<FluxHarmonic> = (),
        /// Loss in the iron.
        iron_loss: IronLoss = (),
        /// Resistances of the phases a, b and c as parts of `resistance`, [1, 1, 1.02]; default: equal.
        phase_resistance: Many<f64> = pmsm::PhaseParameter::RESISTANCE,
        /// Temperature of winding and magnets.
        temperature: Temperature = (),
        /// Warming of both by the losses; without it the temperatures are constant.
        thermal: Thermal = (),
        /// Saturation of the iron, by one figure of the data sheet.
        saturation: Saturation = (),
        /// Saturation of the iron, by a table of flux linkages.
        flux_map: FluxMap = (),
        /// Connection to the inverter; default: correct.
        connection: Connection = (),
        /// Encoder on the motor; default: ideal.
        encoder: Encoder = Mount::Motor,
    }
}
