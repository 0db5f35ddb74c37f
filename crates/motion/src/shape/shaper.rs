//! The input shapers by their names.
use super::{Impulses, Vibration};
use crate::PlanError;

servobench_config::choices! {
    /// An input shaper against one vibration; the [module documentation](super) has their impulses.
    pub enum Shaper named ShaperKind {
        /// zero vibration: half a period longer
        Zv = "zv",
        /// zero vibration and derivative: one period longer
        Zvd = "zvd",
        /// zero vibration and two derivatives: one and a half periods longer
        Zvdd = "zvdd",
        /// extra-insensitive, within `tolerable`: one period longer
        Ei {
            /// Part of the vibration that may be left.
            tolerable: f64,
        } = "ei",
    }
}

impl Shaper {
    /// Part of the vibration that [`Ei`](Self::Ei) leaves by default.
    pub const TOLERABLE: f64 = 0.05;

    /// The shaper of this kind, with `tolerable` where it has that.
    #[must_use]
    pub const fn new(kind: ShaperKind, tolerable: f64) -> Self {
        match kind {
            ShaperKind::Zv => Self::Zv,
            ShaperKind::Zvd => Self::Zvd,
            ShaperKind::Zvdd => Self::Zvdd,
            ShaperKind::Ei => Self::Ei { tolerable },
        }
    }

    /// Its impulses for `vibration`.
    ///
    /// # Errors
    /// As [`Impulses::ei`].
    pub fn impulses(&self, vibration: &Vibration) -> Result<Impulses, PlanError> {
        match *self {
            Self::Zv => Ok(Impulses::zv(vibration)),
            Self::Zvd => Ok(Impulses::zvd(vibration)),
            Self::Zvdd => Ok(Impulses::zvdd(vibration)),
            Self::Ei { tolerable } => Impulses::ei(vibration, tolerable),
        }
    }
}
