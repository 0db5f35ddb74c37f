//! The drive as a master sees it: frames in, demands and frames out, over an axis that follows every demand.
mod axis;
mod cyclic;
mod ends;
mod halt;
mod handshake;
mod highest_velocity;
mod homing;
mod interpolated;
mod modulo;
mod power;
mod profile_position;
mod profile_velocity;
mod random;
mod settings;
mod supervision;
mod turned;
mod units;
