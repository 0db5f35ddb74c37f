//! The words in which a drive gets its points, by the tables of the manuals.
use servobench_cia402::interpolated::Point;

mod segment_command;
mod serial;
mod settings;

fn linear(position: i32, ms: u32) -> Point {
    Point { position, is_relative: false, velocity: None, time: 1000 * ms }
}

fn cubic(position: i32, velocity: i32, ms: u32) -> Point {
    Point { velocity: Some(velocity), ..linear(position, ms) }
}

fn relative(point: Point) -> Point {
    Point { is_relative: true, ..point }
}
