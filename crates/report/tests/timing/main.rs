//! Timing diagrams: every change and every curve at its place, XML that can be read, nothing that grows without bound.
mod calls;
mod drawn;
mod places;
mod random;
mod recordings;
mod snapshot;
mod words;
