//! An ideal drive in profile velocity mode: it ramps to the commanded velocity, and stays there exactly.
use servobench_motion::position_profile::Command;

pub(crate) struct Drive {
    t: f64,
    pub(crate) x: f64,
    pub(crate) v: f64,
    command: Command,
}

impl Drive {
    pub(crate) fn new(t: f64, x: f64, v: f64) -> Self {
        Self { t, x, v, command: Command { t, velocity: v, acceleration: 0.0 } }
    }

    pub(crate) fn send(&mut self, command: Command) {
        self.run_to(command.t);
        self.command = command;
    }

    /// Ramps until the velocity or the time `t` is reached, then continues at that velocity.
    pub(crate) fn run_to(&mut self, t: f64) {
        let left = t - self.t;
        let missing = self.command.velocity - self.v;
        let ramp = if missing == 0.0 { 0.0 } else { (missing.abs() / self.command.acceleration).min(left) };
        let reached = if ramp < left {
            self.command.velocity
        } else {
            self.v + missing.signum() * self.command.acceleration * ramp
        };
        self.x += ramp * (self.v + reached) / 2.0 + (left - ramp) * reached;
        (self.t, self.v) = (t, reached);
    }
}

/// Position and velocity of the drive at each of `times`, when it is sent `commands`.
pub(crate) fn follow(
    commands: impl Iterator<Item = Command>,
    (t, x, v): (f64, f64, f64),
    times: impl Iterator<Item = f64>,
) -> Vec<(f64, f64)> {
    let (mut drive, mut commands) = (Drive::new(t, x, v), commands.peekable());
    times
        .map(|t| {
            while let Some(command) = commands.next_if(|command| command.t <= t) {
                drive.send(command);
            }
            drive.run_to(t);
            (drive.x, drive.v)
        })
        .collect()
}
