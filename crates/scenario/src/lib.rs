//! The scenario file: schema, quantities with units, diagnostics with spans, lookup in `models/`.
//!
//! ```text
//! TOML → tree with places → merged with models → overrides → tables (`file`: quantities in SI) → `Scenario`
//! ```
//! The tables in `file` are the single description of the format: decoding, unknown keys, JSON Schema and the reference in
//! `docs/scenario.md` follow from them.

mod access;
mod argument;
mod axis_name;
mod block;
mod channel;
mod diagnostic;
mod display_units;
mod document;
mod field;
mod file;
mod flux_table;
mod foreign;
mod format;
mod key_range;
mod limit_table;
mod list;
mod load;
mod mjcf_files;
mod mjcf_size;
mod models;
mod name_table;
mod object_table;
mod overrides;
mod parameter_key;
mod parameters;
mod place;
mod points;
mod quantity;
mod random;
mod reading;
mod reference;
mod resolve;
mod scenario;
mod schema;
mod simple;
mod source;
mod sweep_file;
mod table;
mod tree;
mod unit;
mod when;

pub use access::{MOST_OF_A_SCENARIO, root_of};
pub use argument::{ArgumentError, Derivative, axis_quantity, frequency, metric_value, ratio, si_unit, time};
pub use diagnostic::{Diagnostic, Invalid, LoadError, MOST_MISTAKES, NamedFile, Shown, shown};
pub use document::Document;
pub use flux_table::{FluxTableError, FluxTableMistake, read_flux_table};
pub use key_range::{KeyRange, KeyRangeError};
pub use load::{Loaded, load, parse};
pub use models::{embedded_demo, embedded_model, embedded_models};
pub use overrides::{Key, Override, OverrideError};
pub use parameter_key::{parameter_key, switch_key};
pub use parameters::{Difference, Parameter, differences, written_values};
pub use points::{
    Column, Counts, MOST_POINTS, Points, PointsError, PointsMistake, Profile, read_accelerations, read_points,
    read_points_in, read_velocities,
};
pub use random::Seed;
pub use reference::{KeyFile, KeyReference, key_references, keys_named, value_of_schema};
pub use scenario::{
    Actuator, Axis, AxisMechanics, Bus, BusMode, Disturbance, DisturbedBody, Drive, DriveUnits, Feedback, Fmu,
    IdleMotor, Initial, InputSource, Interpolation, LONGEST_RUN, LoopSignal, MOST_TICKS, MoveStep, ObjectWrite, Plc,
    Record, Requirements, Scenario, Step, TimeBound,
};
pub use schema::{json_schema, sweep_schema};
pub use source::{SourceId, Sources};
pub use sweep_file::{SweepRequest, load_sweep, parse_sweep};
