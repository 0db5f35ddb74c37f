//! `Recording`: the result of a run. Channels with unit, rate and writer, all sampled at one rate; the executed
//! moves; events; signals that have one value out of a few; log messages of the parts. As a file it
//! is Parquet, which every data tool opens.
//!
//! A row is written at tick k **before** the integration to k+1, so all its values belong to the same instant.

mod arrow;
mod channel;
mod chunk;
mod envelope;
mod error;
mod header;
mod log;
mod number;
mod pages;
mod read;
mod recorder;
mod recording;
mod seal;
mod table;
mod values;
mod whole_file;
mod write;

pub use channel::{Channel, ChannelSpec};
pub use envelope::envelope;
pub use error::TraceError;
pub use log::LogEntry;
pub use recorder::{BLOCK, Column, Mark, Recorder, Row, SignalId};
pub use recording::{
    About, BoundLimit, Call, CallFate, CouplingEstimate, Event, IncidentMark, LimitReversals, Move, Recording, Signal,
    of_axis,
};
pub use seal::{seal_of, verified_seal_of};
pub use servobench_base::Ending;
pub use table::{Cells, Table, TableColumn};
pub use values::{GrowingValues, IN_MEMORY, Values};
pub use whole_file::{PassingFile, stream_durably, stream_whole, unfinished_by, write_whole};

/// Column of a recording file that holds the instants (s).
const TIME: &str = "time";
