//! Fuzz targets: what a master could send (docs/testing.md).

mod writes;
