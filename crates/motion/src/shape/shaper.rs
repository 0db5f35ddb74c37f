//! The input shapers by name.
use super::{Impulses, Vibration};
use crate::PlanError;

servobench_config::choices! {
    /// An input shaper against one vibration; the [module documentation](super) has their impulses.
    pub enum Shaper named ShaperKind {
        /// zero vibration: half a period longer
        Zv = "zv",
        /// modified zero vibration: three quarters of a period longer
        Mzv = "mzv",
        /// zero vibration and derivative: one period longer
        Zvd = "zvd",
        /// zero vibration and two derivatives: one and a half periods longer
        Zvdd = "zvdd",
        /// extra-insensitive, within `tolerable`: one period longer
        Ei {
            /// Part of the vibration that may be left.
            tolerable: f64,
        } = "ei",
        /// extra-insensitive with two humps within `tolerable`: about one and a half periods longer
        TwoHumpEi {
            /// Part of the vibration that may be left at the humps.
            tolerable: f64,
        } = "2hump-ei",
        /// extra-insensitive with three humps within `tolerable`: about two periods longer
        ThreeHumpEi {
            /// Part of the vibration that may be left at the humps.
            tolerable: f64,
        } = "3hump-ei",
    }
}

impl Shaper {
    /// Default of the part of the vibration that the extra-insensitive shapers leave.
    pub const TOLERABLE: f64 = 0.05;

    /// The shaper of this kind, with `tolerable` if it has that.
    #[must_use]
    pub const fn new(kind: ShaperKind, tolerable: f64) -> Self {
        match kind {
            ShaperKind::Zv => Self::Zv,
            ShaperKind::Mzv => Self::Mzv,
            ShaperKind::Zvd => Self::Zvd,
            ShaperKind::Zvdd => Self::Zvdd,
            ShaperKind::Ei => Self::Ei { tolerable },
            ShaperKind::TwoHumpEi => Self::TwoHumpEi { tolerable },
            ShaperKind::ThreeHumpEi => Self::ThreeHumpEi { tolerable },
        }
    }

    /// Part of the vibration that may be left, of the extra-insensitive shapers.
    #[must_use]
    pub const fn tolerable(&self) -> Option<f64> {
        match *self {
            Self::Zv | Self::Mzv | Self::Zvd | Self::Zvdd => None,
            Self::Ei { tolerable } | Self::TwoHumpEi { tolerable } | Self::ThreeHumpEi { tolerable } => Some(tolerable),
        }
    }

    /// Its impulses for `vibration`.
    ///
    /// # Errors
    /// As [`Impulses::ei`].
    pub fn impulses(&self, vibration: &Vibration) -> Result<Impulses, PlanError> {
        match *self {
            Self::Zv => Ok(Impulses::zv(vibration)),
            Self::Mzv => Ok(Impulses::mzv(vibration)),
            Self::Zvd => Ok(Impulses::zvd(vibration)),
            Self::Zvdd => Ok(Impulses::zvdd(vibration)),
            Self::Ei { tolerable } => Impulses::ei(vibration, tolerable),
            Self::TwoHumpEi { tolerable } => Impulses::two_hump_ei(vibration, tolerable),
            Self::ThreeHumpEi { tolerable } => Impulses::three_hump_ei(vibration, tolerable),
        }
    }
}

impl ShaperKind {
    /// True for an extra-insensitive shaper, which leaves a chosen part of the vibration.
    #[must_use]
    pub const fn has_tolerable(self) -> bool {
        Shaper::new(self, Shaper::TOLERABLE).tolerable().is_some()
    }
}
