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
        /// From exchange to exchange, a whole number of base ticks; default: one tick, or the step of `[coupling]`.
        step: f64 = positive(Plain(&TIME), "1 ms"),
        /// Where it runs; default: "process".
        isolation: IsolationKind = OneOf,
        /// Whether the event mode of an FMU of FMI 3.0 is used; if it has one, it is unless this is `false`: then the FMU deals with
        /// events by itself.
        event_mode: bool = (),
        /// Whether its efforts excite the axis, as a `[[disturbance]]` does, so that they explain that it swings; default: false: they
        /// answer to the axis, as those of a load do. Not for the mechanics of an axis.
        excites: bool = (),
        /// How long one of its calls may take (real time); default: 10 s.
        call_timeout: f64 = positive(Plain(&TIME), "10 s"),
        /// Megabytes of memory that its process may take; default: 2048.
        memory: u32 = 64..=1_048_576,
        /// Start values of its parameters and variables, in units that it can convert.
        parameters: StartTable = (),
        /// Its inputs, each with the signal that it is given: a channel of the recording, "shaft.position" or "shaft.velocity" of
        /// the motor in its own coordinate, "time", or an output of another FMU as "name.variable". The mechanics of an axis take
        /// "effort.motor", "disturbance.motor" and "disturbance.load".
        inputs: SignalTable = (),
        /// Its outputs, each with what it is in the loop: "disturbance.motor" or "disturbance.load", "setpoint.position" with
        /// its derivatives, in place of drive and motor "effort.motor", in place of the drive "voltage.d" and "voltage.q". The
        /// mechanics of an axis give "shaft.position", "shaft.velocity", "load.position" and "load.velocity".
        outputs: SignalTable = (),
    }
}

table! {
    /// How FMUs and the axis exchange what they give.
    pub(crate) struct Coupling {
        /// From exchange to exchange, a whole number of base ticks; default: one tick.
        step: f64 = positive(Plain(&TIME), "0.5 ms"),
        /// Who steps when; default: "gauss-seidel" in the order of the file, the axis last.
        method: MethodKind = OneOf,
        /// Order with which inputs go on within a step: 0 holds them; default: 1.
        extrapolation: u32 = 0..=2,
        /// How well inputs and outputs agree in algebraic loops, and in the steps of "iterated", relative to their size; numbers of single
        /// precision agree as far as they resolve it; default: 1e-9.
        tolerance: f64 = positive(Plain(&RATIO), "1e-9"),
        /// How many evaluations an algebraic loop may take, and a step of "iterated"; default: 50.
        iterations: u32 = 1..=1000,
    }
}
