//! Paths and programs that the tests of this folder share.
