//! Position encoder: ideal, or with a resolution.
use servobench_base::ParamError;
use servobench_config::Kind::Axis;
use servobench_config::positive;
use servobench_config::quantities::POSITION;

servobench_config::parameters! {
    /// A parameter of an encoder, on the load in the axis coordinate, on the motor in its own.
    pub enum EncoderParameter {
        /// One increment
        STEP "encoder step" = positive(Axis(&POSITION), "0.1 um");
    }
}

/// A position encoder.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Encoder {
    /// One increment (rad or m); `None` for an ideal encoder, which gives the velocity too.
    pub increment: Option<f64>,
}

/// What an encoder tells the drive at tick k.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Reading {
    /// Position (rad or m).
    pub position: f64,
    /// Velocity (rad/s or m/s), from an ideal encoder only; otherwise the drive forms differences.
    pub velocity: Option<f64>,
}

impl Encoder {
    /// # Errors
    /// [`ParamError`] when the increment is not finite and positive.
    pub fn check(&self) -> Result<(), ParamError> {
        self.increment.map_or(Ok(()), |increment| EncoderParameter::STEP.check_in_words(increment).map(|_| ()))
    }

    /// Reads, to the nearest increment, `position` and `velocity` of the body it sits on.
    #[must_use]
    pub fn read(&self, position: f64, velocity: f64) -> Reading {
        match self.increment {
            None => Reading { position, velocity: Some(velocity) },
            Some(step) => Reading { position: libm::floor(position / step + 0.5) * step, velocity: None },
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_resolution_rounds_to_the_nearest_increment_and_hides_the_velocity() {
        let encoder = Encoder { increment: Some(0.25) };
        for (position, read) in [(0.37, 0.25), (0.38, 0.5), (-0.12, 0.0), (-0.13, -0.25)] {
            assert_eq!(encoder.read(position, 1.0), Reading { position: read, velocity: None }, "{position}");
        }
        assert_eq!(Encoder::default().read(0.1, 2.0), Reading { position: 0.1, velocity: Some(2.0) });
        assert!(Encoder { increment: Some(0.0) }.check().is_err());
    }
}
