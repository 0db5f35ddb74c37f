//! The object dictionary of a master: one table for the drive, the documents and the exports.
//!
//! Names, types and defaults are those of IEC 61800-7-201 (CiA 402-2) and, below 2000h, of CiA 301; ranges are narrower to exclude
//! senseless values: a scale, an acceleration, a speed, a limit or a window of zero, and an option code, a mode or a homing method that the
//! drive does not support. 2010h to 2012h are those of Copley's drives.
//!
//! The master's side takes any index, any value and any bytes, and refuses with an [`SdoError`](crate::SdoError). The drive's side reads by
//! a [`Parameter`] and writes its own values by a [`Signal`], each a place found at compile time.
//!
//! ```
//! use servobench_cia402::objects::{self, Dictionary, Value, signal};
//! use servobench_cia402::units::Object;
//! use servobench_cia402::{AbortCode, PowerState};
//!
//! let mut dictionary = Dictionary::new();
//! let window = Object { index: 0x6065, subindex: 0 };
//! dictionary.write(window, Value::Unsigned32(2_000), PowerState::OperationEnabled)?;
//! assert_eq!(dictionary.get(objects::parameter::FOLLOWING_ERROR_WINDOW), 2_000);
//!
//! dictionary.set(signal::POSITION_ACTUAL_VALUE, -5);
//! let position = Object { index: 0x6064, subindex: 0 };
//! assert_eq!(dictionary.read(position)?, Value::Integer32(-5));
//!
//! let refused = dictionary.download(position, &[0; 4], PowerState::OperationEnabled).unwrap_err();
//! assert_eq!(refused.abort_code(), AbortCode::ReadOnly);
//! # Ok::<(), servobench_cia402::SdoError>(())
//! ```

mod dictionary;
mod eds;
mod entry;
mod json;
mod pdo;
mod place;
mod table;
mod value;

pub use dictionary::{Bytes, Dictionary};
pub use eds::{Eds, FileInfo};
pub use entry::{Access, Admitted, Contents, Entry, Mapping, ObjectDescription};
pub use json::Json;
pub use pdo::NODE_ID;
pub use place::{Parameter, Signal, entry_of, parameter, signal};
pub use table::{HOMING_METHODS, OBJECTS};
pub use value::{DataType, Value};
