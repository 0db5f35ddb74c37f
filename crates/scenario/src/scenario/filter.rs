//! What stands between a generator of set-points and the drive.

/// What stands between a generator and the drive: a shaper, then averages.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Filter {
    /// Input shaper.
    pub shaper: Option<Shaper>,
    /// Lengths of moving averages (s), one after the other, whole numbers of base ticks.
    pub averages: Vec<f64>,
}

/// An input shaper against one mode.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Shaper {
    /// Which one.
    pub kind: ShaperKind,
    /// Natural frequency of the mode (Hz).
    pub frequency: f64,
    /// Damping ratio of the mode.
    pub damping: f64,
}

/// Which input shaper.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum ShaperKind {
    /// Zero vibration.
    Zv,
    /// Zero vibration and derivative.
    Zvd,
    /// Zero vibration and two derivatives.
    Zvdd,
    /// Extra-insensitive; the part of the vibration that may be left.
    Ei(f64),
}

/// Between a slow task that commands and the drive.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Interpolation {
    /// How values between two commands are found.
    pub mode: InterpolationMode,
    /// Time between two commands (s), a whole number of base ticks.
    pub period: f64,
}

/// How values between two commands are found.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum InterpolationMode {
    /// Position linear, velocity its slope.
    Linear,
    /// By positions and velocities.
    Cubic,
    /// By positions, velocities and accelerations.
    Quintic,
    /// Positions as control points of a cubic B-spline.
    CubicBSpline,
    /// Positions as control points of a quintic B-spline.
    QuinticBSpline,
    /// Position, velocity and acceleration each linear.
    AllLinear,
    /// Position and velocity each cubic.
    AllCubic,
}
