//! Mechanics behind one trait: what the closed loop sees of a simulated axis, whichever engine computes it.
use crate::chain::Chain;
use crate::engine::EngineName;
use crate::fmu::FmuModel;
use crate::mjcf_axis::MjcfAxis;
use crate::refusal::{Refusal, in_one_line};
use servobench_base::state::{Damaged, Reader, Writer};
use servobench_base::{ParamError, Setpoint, Severity, Stateful, finite, positive};
use servobench_fmu_file::FmuMistake;
use std::path::PathBuf;
use thiserror::Error;

/// Position and velocity of one body.
///
/// The motor's are in the motor's own coordinate (rad and rad/s for a rotary motor, m and m/s for a linear one), those
/// of all other bodies in the axis coordinate (m or rad).
#[derive(Debug, Clone, Copy, PartialEq, Default, Stateful)]
pub struct BodyState {
    /// Position (m or rad).
    pub position: f64,
    /// Velocity (m/s or rad/s).
    pub velocity: f64,
}

/// Kind of drive of the motor body.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Drive {
    /// By an effort: a torque or a force.
    Effort,
    /// Exactly as prescribed, whatever force that takes. The closed forms of residual vibration need it.
    Prescribed,
}

/// Actuation of the motor body from tick k to k+1.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Actuation {
    /// Torque (N·m) or force (N) in the motor's coordinate, constant over the tick. For [`Drive::Effort`].
    Effort(f64),
    /// Motion of the motor body at tick k **in the axis coordinate**; it continues as in [`Setpoint::after`] until tick k+1. For
    /// [`Drive::Prescribed`].
    Motion(Setpoint),
}

/// Everything that acts on the mechanics from tick k to k+1.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Input {
    /// Actuation by the motor.
    pub actuation: Actuation,
    /// Disturbing force or torque on the motor body, in the motor's coordinate (N or N·m).
    pub motor_disturbance: f64,
    /// Disturbing force or torque on the load, in the axis coordinate (N or N·m).
    pub load_disturbance: f64,
}

impl Input {
    /// For an engine whose states do not tell: one that takes 0 for a number that is none, or that hands it on to foreign code.
    ///
    /// # Errors
    /// [`MechanicsError::Diverged`] of `engine` names the first number that is not finite: what computed it has diverged.
    pub fn check(&self, engine: EngineName) -> Result<(), MechanicsError> {
        let drive = match self.actuation {
            Actuation::Effort(effort) => effort,
            Actuation::Motion(now) => now.x + now.v + now.a + now.j + now.s,
        };
        // One test for all of them: a sum with something that is not finite is not finite.
        if (drive + self.motor_disturbance + self.load_disturbance).is_finite() {
            return Ok(());
        }
        self.name_what_is_not_finite(drive, engine)
    }

    /// None, when only their sum is too large.
    #[cold]
    fn name_what_is_not_finite(&self, drive: f64, engine: EngineName) -> Result<(), MechanicsError> {
        let drive = (if matches!(self.actuation, Actuation::Effort(_)) { "effort" } else { "set-point" }, drive);
        let disturbances =
            [("disturbance of the motor", self.motor_disturbance), ("disturbance of the load", self.load_disturbance)];
        let wrong = [drive].into_iter().chain(disturbances).find(|(_, value)| !value.is_finite());
        wrong.map_or(Ok(()), |(name, value)| {
            Err(MechanicsError::Diverged { engine, message: format!("the {name} is not finite: {value}") })
        })
    }
}

/// Position (m or rad) and velocity (per second) from which on a body is none of a machine: a double is 2 µm wide there. `MuJoCo` ends at
/// the same number (`mjMAXVAL`).
const FARTHEST: f64 = 1e10;

/// Ends a run at the first state that is none, before the sensors, the drive or the motor have to make something of it.
///
/// # Errors
/// [`MechanicsError::Diverged`] of `engine` when one of these positions and velocities is not finite, or is beyond 1e10 m or rad, or per
/// second.
#[inline]
pub fn check_states(engine: EngineName, bodies: impl Iterator<Item = BodyState>) -> Result<(), MechanicsError> {
    // One test for all of them: a sum with something that is not finite is not finite.
    let total: f64 = bodies.map(|body| body.position.abs() + body.velocity.abs()).sum();
    if total < FARTHEST { Ok(()) } else { Err(diverged(engine, total)) }
}

/// Error for states whose magnitudes sum up to `total`.
#[cold]
fn diverged(engine: EngineName, total: f64) -> MechanicsError {
    let message = if total.is_finite() {
        format!("a position or velocity has grown to {total:.1e} m or rad, or per second")
    } else {
        "a position or velocity is not finite".into()
    };
    MechanicsError::Diverged { engine, message }
}

/// A message of a foreign model, in its wording.
#[derive(Debug, Clone, PartialEq)]
pub struct LogMessage {
    /// Simulation time of the message (s).
    pub time: f64,
    /// Severity of the message.
    pub severity: Severity,
    /// A line of text.
    pub text: String,
}

/// A simulated axis.
///
/// `advance` goes from tick k to k+1; before the first call the state is that of tick 0. Neither `bodies` nor `advance` allocates memory;
/// what a foreign engine does inside its own step is its own (Rapier allocates in each).
pub trait Mechanics: Send {
    /// The bodies at the present tick: the motor first, the load last; one body is both.
    fn bodies(&self) -> &[BodyState];

    /// One base tick.
    ///
    /// # Errors
    /// [`MechanicsError::Diverged`] or [`MechanicsError::Native`]; the mechanics must not be used afterwards.
    fn advance(&mut self, input: &Input) -> Result<(), MechanicsError>;

    /// The state at the present tick, [`Identity`](crate::Identity) first; `None` where it cannot be saved.
    fn state(&mut self) -> Option<&mut dyn Stateful> {
        None
    }

    /// Brings what follows from the state to it, after it was restored.
    ///
    /// # Errors
    /// [`MechanicsError`] where it cannot.
    fn restored(&mut self) -> Result<(), MechanicsError> {
        Ok(())
    }

    /// True where [`save`](Self::save) and [`restore`](Self::restore) can do it.
    fn saves(&mut self) -> bool {
        self.state().is_some()
    }

    /// Writes the state at the present tick.
    ///
    /// # Errors
    /// [`MechanicsError`], also where the engine cannot.
    fn save(&mut self, to: &mut dyn Writer) -> Result<(), MechanicsError> {
        self.state().ok_or(MechanicsError::NotSaved)?.save(to);
        Ok(())
    }

    /// Takes the state that [`save`](Self::save) of mechanics of the same setup has written.
    ///
    /// # Errors
    /// [`MechanicsError`], also of numbers that are not a state of them; they must not be used then but to restore another.
    fn restore(&mut self, from: &mut Reader<'_>) -> Result<(), MechanicsError> {
        self.state().ok_or(MechanicsError::NotSaved)?.restore(from)?;
        self.restored()
    }

    /// Frees foreign resources, after which only the log is taken. Failures of this are in the log.
    fn end(&mut self) {}

    /// Messages since the last call, also after an error.
    fn take_log(&mut self) -> Vec<LogMessage> {
        Vec::new()
    }

    /// The limits that the model gives its joints, in an order that never changes, and which of them bind at the present
    /// tick.
    fn joint_limits(&self) -> &[JointLimit] {
        &[]
    }
}

/// An end of a joint's range in a user's model.
#[derive(Debug, Clone, PartialEq)]
pub struct JointLimit {
    /// Statement that is true while it binds: "joint `x` is at the upper end of its range, 0.3 m".
    pub text: String,
    /// True while it binds.
    pub binds: bool,
}

/// A model that an engine simulates.
#[derive(Debug, Clone, PartialEq)]
pub enum Model {
    /// A chain of lumped bodies.
    Chain(Chain),
    /// A user's MJCF file.
    Mjcf(MjcfModel),
    /// An FMU.
    Fmu(Box<FmuModel>),
}

/// Kinds of [`Model`]s.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum ModelKind {
    /// [`Model::Chain`].
    Chain,
    /// [`Model::Mjcf`].
    Mjcf,
    /// [`Model::Fmu`].
    Fmu,
}

impl Model {
    /// Kind of the model.
    #[must_use]
    pub const fn kind(&self) -> ModelKind {
        match self {
            Self::Chain(_) => ModelKind::Chain,
            Self::Mjcf(_) => ModelKind::Mjcf,
            Self::Fmu(_) => ModelKind::Fmu,
        }
    }
}

/// A user's MJCF file, and the parts of it that are the axis.
#[derive(Debug, Clone, PartialEq)]
pub struct MjcfModel {
    /// The file's text.
    pub xml: String,
    /// Path of the file, for messages and for the files it includes.
    pub path: PathBuf,
    /// Joint whose coordinate is the motor's (hinge: rad, slide: m).
    pub motor_joint: String,
    /// Joint of the load, whose position in the axis coordinate is that of [`LoadCoordinate`](crate::LoadCoordinate):
    /// joints between it and the body that carries both motor and load count too.
    pub load_joint: String,
    /// Motor actuator (`<motor>`) that the drive's torque or force goes to.
    pub actuator: String,
    /// Axis coordinate per motor coordinate: where one joint is both motor and load, an effort on the load acts through
    /// it.
    pub transmission: f64,
    /// Axis that the file has to fit; `None` if unknown.
    pub axis: Option<MjcfAxis>,
    /// True where dry friction, contacts and the ends of joints' ranges are left out.
    pub is_smooth: bool,
}

/// Parameters to build mechanics.
#[derive(Debug, Clone, PartialEq)]
pub struct MechanicsSetup {
    /// The bodies and their couplings.
    pub model: Model,
    /// Kind of drive of the motor body.
    pub drive: Drive,
    /// Length of a base tick (s).
    pub step: f64,
    /// State of each body at tick 0; empty for all at rest at zero. For MJCF models: motor, then load. For an FMU always empty:
    /// its start values set its initial state.
    pub initial: Vec<BodyState>,
}

impl MechanicsSetup {
    /// Checks the requirements of every engine; each calls it in [`Engine::build`](crate::Engine::build).
    ///
    /// # Errors
    /// [`ParamError`] names the first field that is wrong.
    pub fn check(&self) -> Result<(), ParamError> {
        positive("step", self.step)?;
        let (most, bound) = match &self.model {
            Model::Chain(chain) => (chain.bodies().len(), "none, or one for each body"),
            Model::Mjcf(file) if file.motor_joint == file.load_joint => (1, "none, or one: one joint is both"),
            Model::Mjcf(_) => (2, "none, or those of motor and load"),
            Model::Fmu(_) => (0, "none: the start values of the FMU set its initial state"),
        };
        let count = self.initial.len();
        if count != 0 && count != most {
            return Err(ParamError { name: "initial", value: count as f64, bound });
        }
        for state in &self.initial {
            finite("initial position", state.position)?;
            finite("initial velocity", state.velocity)?;
        }
        Ok(())
    }
}

/// Reason why an engine could not be built or could not continue.
#[derive(Debug, Clone, PartialEq, Error)]
pub enum MechanicsError {
    /// A parameter of the chain is out of its bound.
    #[error(transparent)]
    Parameter(#[from] ParamError),
    /// The engine lacks a feature.
    #[error("engine `{engine}` does not support {what}; {help}")]
    Unsupported {
        /// Engine name.
        engine: EngineName,
        /// The feature.
        what: String,
        /// The way out.
        help: String,
    },
    /// Elements of a user's MJCF file that the engine does not simulate.
    #[error("engine `{engine}` refuses {}: {}; {help}", path.display(), in_one_line(refusals))]
    Refused {
        /// Engine name.
        engine: EngineName,
        /// The file.
        path: PathBuf,
        /// The refused elements, at least one.
        refusals: Vec<Refusal>,
        /// The way out.
        help: &'static str,
    },
    /// An FMU does not fit: all its mistakes.
    #[error("engine `{engine}` refuses {}: {}", path.display(), in_one_line(mistakes))]
    Fmu {
        /// Engine name.
        engine: EngineName,
        /// The file.
        path: PathBuf,
        /// The mistakes, at least one.
        mistakes: Vec<FmuMistake>,
    },
    /// The model text is wrong.
    #[error("engine `{engine}` cannot read the model: {message}")]
    Model {
        /// Engine name.
        engine: EngineName,
        /// Message of the engine.
        message: String,
    },
    /// A state left the finite numbers, or the engine warned that it would.
    #[error("engine `{engine}` diverged: {message}")]
    Diverged {
        /// Engine name.
        engine: EngineName,
        /// Observation, in words.
        message: String,
    },
    /// The mechanics cannot save or restore their state, or nothing is saved yet.
    #[error("engine `mechanics` failed: it has no saved state to restore")]
    NotSaved,
    /// The engine keeps its last state only, and another one is to be restored.
    #[error(
        "engine `{engine}` keeps its last state only, and an older one, or that of another model, is to be restored"
    )]
    Superseded {
        /// Engine name.
        engine: EngineName,
    },
    /// A state that is to be restored is of other mechanics.
    #[error(transparent)]
    Damaged(#[from] Damaged),
    /// The engine's library failed.
    #[error("engine `{engine}` failed: {message}")]
    Native {
        /// Engine name.
        engine: EngineName,
        /// The library's own words.
        message: String,
    },
}

impl MechanicsError {
    /// `model` is none that `engine` simulates.
    #[must_use]
    pub fn not_simulated(engine: EngineName, model: &Model) -> Self {
        let (what, help) = match model {
            _ if engine.simulates(ModelKind::Fmu) => {
                ("mechanics that are described by bodies or MJCF".into(), "choose another engine, or give an FMU")
            }
            Model::Fmu(_) => {
                ("an FMU as the mechanics".into(), "choose the engine `fmu`, or describe the axis by its bodies")
            }
            Model::Mjcf(model) => (
                format!("MJCF files ({})", model.path.display()),
                "choose the engine `mujoco` or `rapier`, or describe the axis by its bodies",
            ),
            Model::Chain(_) => ("bodies in a row".into(), "choose the engine `exact`"),
        };
        Self::Unsupported { engine, what, help: help.into() }
    }

    /// The actuation is not the one that the mechanics of `engine` were built for.
    #[must_use]
    pub fn wrong_actuation(engine: EngineName) -> Self {
        Self::Unsupported {
            engine,
            what: "an actuation other than the one it was built for".into(),
            help: "use efforts with `Drive::Effort` and motions with `Drive::Prescribed`".into(),
        }
    }
}
