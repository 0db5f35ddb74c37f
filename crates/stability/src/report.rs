//! Results of an analysis.
use crate::pole::Pole;
use servobench_base::Dq;
use servobench_linear::Factors;
use std::fmt::{self, Display, Formatter};

/// A loop of the cascade.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum LoopName {
    /// The current loop, which follows the effort requested by the velocity loop.
    Current,
    /// The velocity loop.
    Velocity,
    /// The position loop.
    Position,
}

/// A gain of the cascade.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum GainName {
    /// `drive.position.gain`, K_v (1/s).
    Position,
    /// `drive.velocity.gain`, k_p (N·m·s/rad or N·s/m).
    Velocity,
    /// `drive.current.bandwidth`, α/2π (Hz): both axes.
    CurrentBandwidth,
    /// `drive.current.gain_d`, k_p of the d axis (V/A).
    CurrentD,
    /// `drive.current.gain_q`, k_p of the q axis (V/A).
    CurrentQ,
}

/// A gain at which the loop changes from stable to unstable or back.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Boundary {
    /// Factor on the present gain.
    pub factor: f64,
    /// The gain, in the unit of the present gain.
    pub gain: f64,
}

/// The nearest changes of the verdict, with all other gains unchanged; integral times stay. `None`: none within a factor of 1000.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Boundaries {
    /// Downwards.
    pub below: Option<Boundary>,
    /// Upwards.
    pub above: Option<Boundary>,
    /// True if the loops around this one are open for it, because with them no gain made it stable.
    pub alone: bool,
}

/// A loop with its poles.
#[derive(Debug, Clone, PartialEq)]
pub struct LoopReport {
    /// Name of the loop.
    pub name: LoopName,
    /// Its gain; that of the q axis if each axis has its own.
    pub gain_name: GainName,
    /// Value of the gain.
    pub gain: f64,
    /// Unit of the value.
    pub unit: &'static str,
    /// Frequency at which it has the gain 1 with everything below it ideal (Hz), with the true inertia and motor of the axis;
    /// `None` with a gain of 0.
    pub bandwidth: Option<f64>,
    /// Boundaries of the whole loop; `None` if not requested, or the gain is 0.
    pub boundaries: Option<Boundaries>,
    /// The pole with the least damping while the loops around it are open (current loop: the shaft held); `None` if
    /// not requested, or the gain is 0.
    pub least_damped: Option<Pole>,
}

/// The reason why the loop is unstable.
#[derive(Debug, Clone, PartialEq)]
pub struct Instability {
    /// The loop that causes it: closed from the inside, the first that is unstable.
    pub name: LoopName,
    /// Gain of that loop.
    pub gain_name: GainName,
    /// Value of the gain.
    pub gain: f64,
    /// Unit of the value.
    pub unit: &'static str,
    /// The largest pole of the whole loop.
    pub pole: Pole,
    /// Gains at which the verdict changes.
    pub boundaries: Boundaries,
    /// Speed of the motor, with its unit, at which the drive's gain schedule has this gain; `None` at standstill.
    pub speed: Option<(f64, &'static str)>,
}

/// A loop that is faster than the one below it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Warning {
    /// The loop.
    pub outer: LoopName,
    /// Its bandwidth (Hz).
    pub outer_bandwidth: f64,
    /// The one below it.
    pub inner: LoopName,
    /// Its bandwidth (Hz).
    pub inner_bandwidth: f64,
}

/// The poles of a loop that decay last.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Slowest {
    /// The last of those that oscillate, with a damping ratio below [`Pole::RESONANT`].
    pub oscillating: Option<Pole>,
    /// The last of the real positive ones, which do not oscillate.
    pub real: Option<Pole>,
}

/// Result of an analysis.
#[derive(Debug, Clone, PartialEq)]
pub struct Report {
    /// The reason why the loop is unstable; `None`: no pole is outside of the unit circle.
    pub instability: Option<Instability>,
    /// The largest pole: the one that grows fastest or, in a stable loop, decays last. `None` if no loop is closed.
    pub largest: Option<Pole>,
    /// The poles that decay last.
    pub slowest: Slowest,
    /// Current, velocity and position loop, as far as they exist.
    pub loops: Vec<LoopReport>,
    /// Loops whose bandwidths are in an order in which cascades do not work.
    pub warnings: Vec<Warning>,
}

impl Report {
    /// True if no pole is outside of the unit circle.
    #[must_use]
    pub const fn is_stable(&self) -> bool {
        self.instability.is_none()
    }
}

impl Boundaries {
    /// True without a boundary in either direction.
    #[must_use]
    pub const fn is_none(&self) -> bool {
        self.below.is_none() && self.above.is_none()
    }
}

impl GainName {
    /// Factors that scale this gain by `factor`, and leave the others unchanged.
    pub(crate) const fn factors(self, factor: f64) -> Factors {
        let one = Factors::ONE;
        match self {
            Self::Position => Factors { position: factor, ..one },
            Self::Velocity => Factors { velocity: factor, ..one },
            Self::CurrentBandwidth => Factors { current: Dq { d: factor, q: factor }, ..one },
            Self::CurrentD => Factors { current: Dq { d: factor, q: 1.0 }, ..one },
            Self::CurrentQ => Factors { current: Dq { d: 1.0, q: factor }, ..one },
        }
    }
}

impl Display for LoopName {
    fn fmt(&self, f: &mut Formatter) -> fmt::Result {
        f.write_str(match self {
            Self::Current => "current loop",
            Self::Velocity => "velocity loop",
            Self::Position => "position loop",
        })
    }
}

impl Display for GainName {
    fn fmt(&self, f: &mut Formatter) -> fmt::Result {
        f.write_str(match self {
            Self::Position | Self::Velocity => "gain",
            Self::CurrentBandwidth => "bandwidth",
            Self::CurrentD => "gain of the d axis",
            Self::CurrentQ => "gain of the q axis",
        })
    }
}

impl Display for Instability {
    fn fmt(&self, f: &mut Formatter) -> fmt::Result {
        let Self { name, gain_name, gain, unit, pole, boundaries, speed } = self;
        f.write_str("the loop is unstable")?;
        if let Some((speed, unit)) = speed {
            write!(f, " at {} {unit} of the motor (gain schedule)", Rounded(*speed))?;
        }
        write!(f, ": {name}, {gain_name} {} {unit}: ", Rounded(*gain))?;
        write!(f, "a pole of |λ| {} at {} ", Magnitude(pole.magnitude), Hertz(pole.frequency))?;
        write!(f, "grows at a rate of {} 1/s; ", Rounded(pole.growth))?;
        let at = |side: &str, boundary: &Boundary| {
            format!("{side} {} {unit} ({} ×)", Rounded(boundary.gain), Rounded(boundary.factor))
        };
        let sides: Vec<String> = [("below", boundaries.below), ("above", boundaries.above)]
            .into_iter()
            .filter_map(|(side, boundary)| Some(at(side, &boundary?)))
            .collect();
        let whose = if boundaries.alone { "by itself, the loops around it open, it is " } else { "" };
        if sides.is_empty() {
            write!(f, "no {gain_name} from a thousandth to a thousand times this one makes it stable")
        } else {
            write!(f, "{whose}stable {}", sides.join(" and "))
        }
    }
}

impl Display for Warning {
    fn fmt(&self, f: &mut Formatter) -> fmt::Result {
        let Self { outer, outer_bandwidth, inner, inner_bandwidth } = self;
        let (fast, slow) = (Hertz(*outer_bandwidth), Hertz(*inner_bandwidth));
        write!(f, "the bandwidth of the {outer} ({fast}) is above that of the {inner} ({slow}): ")?;
        write!(f, "the {inner} does not follow what the {outer} asks for as fast as it asks, so that both swing")
    }
}

/// Three significant digits.
struct Rounded(f64);

impl Display for Rounded {
    fn fmt(&self, f: &mut Formatter) -> fmt::Result {
        let Self(value) = *self;
        if value == 0.0 || !value.is_finite() {
            return write!(f, "{value}");
        }
        #[expect(clippy::cast_possible_truncation, reason = "a decimal exponent")]
        let exponent = value.abs().log10().floor() as i32;
        if (-3..6).contains(&exponent) {
            let decimals = usize::try_from(2 - exponent).unwrap_or(0);
            let text = format!("{value:.decimals$}");
            let shorter = if text.contains('.') { text.trim_end_matches('0').trim_end_matches('.') } else { &text };
            f.write_str(shorter)
        } else {
            write!(f, "{value:.2e}")
        }
    }
}

/// A magnitude of at least 1, with enough digits to show by how much it exceeds 1.
struct Magnitude(f64);

impl Display for Magnitude {
    fn fmt(&self, f: &mut Formatter) -> fmt::Result {
        let above = self.0 - 1.0;
        if above >= 1.0 {
            Rounded(self.0).fmt(f)
        } else if above >= 1e-3 {
            write!(f, "{:.3}", self.0)
        } else {
            write!(f, "1 + {}", Rounded(above))
        }
    }
}

/// A frequency.
struct Hertz(f64);

impl Display for Hertz {
    fn fmt(&self, f: &mut Formatter) -> fmt::Result {
        if self.0 >= 1e3 { write!(f, "{} kHz", Rounded(self.0 / 1e3)) } else { write!(f, "{} Hz", Rounded(self.0)) }
    }
}
