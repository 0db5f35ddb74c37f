//! `[axis.fmu]`, `[[fmu]]` and `[coupling]`: parts that FMUs simulate.
use crate::name_table::{SignalTable, StartTable};
use crate::simple::OneOf;
use crate::table::table;
use servobench_config::Kind::Plain;
use servobench_config::positive;
use servobench_config::quantities::{RATIO, TIME};
use servobench_coupling::MethodKind;
use servobench_fmu_file::IsolationKind;

table! {
    /// A Functional Mock-up Unit (FMI 2.0 or 3.0, co-simulation).
    pub(crate) struct Fmu requires ["file"] {
        /// Name of the instance; default: the file's name without its ending.
        name: String = (),
        /// The file, relative to the file that names it.
        file: String = (),
        /// Communication step, a whole number of base ticks; default: one tick, or the step of `[coupling]`.
        step: f64 = positive(Plain(&TIME), "1 ms"),
        /// Isolation of the FMU; default: "process".
        isolation: IsolationKind = OneOf,
        /// Event mode of an FMU of FMI 3.0: used by default if it has one; with `false` the FMU handles events itself.
        event_mode: bool = (),
        /// Marks its efforts as excitation, like those of a `[[disturbance]]`, which explains an oscillation of the axis; default:
        /// false: they respond to the axis, as those of a load do. Not for the mechanics of an axis.
        excites: bool = (),
        /// Longest time of one of its calls (real time); default: 10 s.
        call_timeout: f64 = positive(Plain(&TIME), "10 s"),
        /// Megabytes of memory that its process may use; default: 2048.
        memory: u32 = 64..=1_048_576,
        /// Start values of its parameters and variables, in units that it can convert.
        parameters: StartTable = (),
        /// Its inputs, each with its signal: a channel of the recording, "shaft.position" or "shaft.velocity" of the motor in the motor
        /// coordinate, "time", or an output of another FMU as "name.variable". The mechanics of an axis take "effort.motor",
        /// "disturbance.motor" and "disturbance.load".
        inputs: SignalTable = (),
        /// Its outputs, each with its role in the loop: "disturbance.motor" or "disturbance.load", "setpoint.position" with its
        /// derivatives, "effort.motor" in place of drive and motor, "voltage.d" and "voltage.q" in place of the drive. The mechanics of
        /// an axis give "shaft.position", "shaft.velocity", "load.position" and "load.velocity".
        outputs: SignalTable = (),
    }
}

table! {
    /// Exchange of signals between FMUs and the axis.
    pub(crate) struct Coupling {
        /// Communication step, a whole number of base ticks; default: one tick.
        step: f64 = positive(Plain(&TIME), "0.5 ms"),
        /// Order of the steps; default: "gauss-seidel" in the order of the file, the axis last.
        method: MethodKind = OneOf,
        /// Order of the extrapolation of inputs within a step: 0 holds them; default: 1.
        extrapolation: u32 = 0..=2,
        /// Relative tolerance within which inputs and outputs agree in algebraic loops, and in the steps of "iterated"; numbers of
        /// single precision agree as far as they resolve it; default: 1e-9.
        tolerance: f64 = positive(Plain(&RATIO), "1e-9"),
        /// Largest number of evaluations of an algebraic loop, and of a step of "iterated"; default: 50.
        iterations: u32 = 1..=1000,
    }
}
