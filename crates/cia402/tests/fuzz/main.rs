//! Fuzz targets: what a master could send (docs/testing.md).

mod points;
mod writes;
