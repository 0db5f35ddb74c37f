//! Common parts of drawings: scales, round numbers along them, text in XML and its width, colours.
mod axis;
mod markup;
mod text_width;
mod ticks;

pub(crate) use axis::{Axis, unit_at, with_zero};
pub(crate) use markup::{COLOURS, STYLE, escaped};
pub(crate) use text_width::{fitted, text_width};
pub(crate) use ticks::{about_four, ticks};
