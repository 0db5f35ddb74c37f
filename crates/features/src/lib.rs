//! No code: this crate makes every build of the workspace choose the same features of the dependencies that program and
//! tests share.
//!
//! Cargo compiles a crate anew for every set of features, and everything above it too. A test dependency that switches
//! on one more feature deep below would compile Rerun a second time: eight minutes on two cores.
