//! Interpolated position: moves through the trajectory buffer, and its errors.

mod adapted;
mod axis;
mod broken_off;
mod buffer;
mod encodings;
mod fuzz;
mod limited;
mod starts;
mod streamed;
