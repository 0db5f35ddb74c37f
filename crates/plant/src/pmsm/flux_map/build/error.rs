//! Errors of a table of flux linkages.
use super::{FluxData, MOST_CURL};
use core::fmt;

/// A part of a table.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum FluxPart {
    /// Currents of the d axis.
    CurrentD,
    /// Currents of the q axis.
    CurrentQ,
    /// Flux linkage of the d axis.
    FluxD,
    /// Flux linkage of the q axis.
    FluxQ,
}

impl fmt::Display for FluxPart {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::CurrentD => "i_d",
            Self::CurrentQ => "i_q",
            Self::FluxD => "psi_d",
            Self::FluxQ => "psi_q",
        })
    }
}

/// Reasons why a table is not the flux linkage of a motor. Currents in A, flux linkages in V·s, inductances in H.
#[derive(Debug, Clone, Copy, PartialEq, thiserror::Error)]
pub enum FluxMapError {
    /// An axis is too short or too long.
    #[error("`{which}` must have from {} to {} values, got {count}", FluxData::FEWEST, FluxData::MOST)]
    Count {
        /// The axis.
        which: FluxPart,
        /// Number of its values.
        count: usize,
    },
    /// A flux linkage is not given for all currents.
    #[error("`{which}` must have a value at each of the {expected} pairs of currents, got {count}")]
    Size {
        /// The flux linkage.
        which: FluxPart,
        /// Number of its values.
        count: usize,
        /// Required number.
        expected: usize,
    },
    /// A value is not a number, or infinite.
    #[error("`{which}` must be finite, got {value}")]
    NotFinite {
        /// The part of the table.
        which: FluxPart,
        /// The value.
        value: f64,
    },
    /// An axis does not increase.
    #[error("`{which}` must increase, got {after} A after {before} A")]
    Order {
        /// The axis.
        which: FluxPart,
        /// A value.
        before: f64,
        /// The next one.
        after: f64,
    },
    /// The currents at rest are outside.
    #[error("`{which}` must reach from 0 A or below to 0 A or above, got {} A to {} A", .range[0], .range[1])]
    WithoutZero {
        /// The axis.
        which: FluxPart,
        /// Its ends.
        range: [f64; 2],
    },
    /// The q axis begins at 0, where it has a flux linkage.
    #[error(
        "a table that begins at i_q = 0 is mirrored there, where `psi_q` must be 0; it is {flux} V s at i_d = {current} A"
    )]
    NoMirror {
        /// i_d.
        current: f64,
        /// ψ_q.
        flux: f64,
    },
    /// Flux linkage falls from one current to the next.
    #[error("`{which}` must grow with its own current, but from ({}, {}) A to ({}, {}) A it goes from {} to {} V s",
        .from[0], .from[1], .to[0], .to[1], .flux[0], .flux[1])]
    Falls {
        /// The flux linkage.
        which: FluxPart,
        /// i_d and i_q.
        from: [f64; 2],
        /// i_d and i_q.
        to: [f64; 2],
        /// Flux linkages there.
        flux: [f64; 2],
    },
    /// A closed cycle makes energy.
    #[error("the table would generate energy: between i_d = {} and {} A, i_q = {} and {} A, the cross inductances dpsi_d/di_q and \
             dpsi_q/di_d differ by {} % \
             of the mean inductance, {} % are allowed", .d[0], .d[1], .q[0], .q[1], percent(*.curl), percent(MOST_CURL))]
    MakesEnergy {
        /// The cell, i_d.
        d: [f64; 2],
        /// The cell, i_q.
        q: [f64; 2],
        /// Difference of the cross inductances, as a part of the mean inductance.
        curl: f64,
    },
    /// Somewhere in a cell, more current would make less flux.
    #[error("between i_d = {} and {} A, i_q = {} and {} A, the incremental inductances are not positive definite: L_dd {}, L_dq {}, L_qq {} mH",
        .d[0], .d[1], .q[0], .q[1], .inductance[0] * 1e3, .inductance[1] * 1e3, .inductance[2] * 1e3)]
    NotIncreasing {
        /// The cell, i_d.
        d: [f64; 2],
        /// The cell, i_q.
        q: [f64; 2],
        /// L_dd, L_dq and L_qq.
        inductance: [f64; 3],
    },
    /// The table cannot be continued beyond its edges.
    #[error("no flux linkage that grows with the currents continues where the table ends")]
    NoFrame,
}

impl FluxMapError {
    /// The remedy, in words.
    #[must_use]
    pub const fn way_out(&self) -> &'static str {
        match self {
            Self::Count { .. } => "leave out currents between which the flux linkages are nearly straight, or add some",
            Self::Size { .. } => "give one row for each pair of currents",
            Self::NotFinite { .. } | Self::Order { .. } => "",
            Self::WithoutZero { .. } => "the currents begin at zero; let the table begin or end there",
            Self::NoMirror { .. } => "give negative i_q, too, or set psi_q to 0 where i_q is 0",
            Self::Falls { .. } => "look for a wrong sign, or for psi_d and psi_q that are exchanged",
            Self::MakesEnergy { .. } => "look for rows and columns that are exchanged, or smooth the measured values",
            Self::NotIncreasing { .. } => "smooth the measured values, or use fewer currents",
            Self::NoFrame => "smooth the measured values at the ends of the table",
        }
    }
}

fn percent(part: f64) -> f64 {
    (part * 1e3).round() / 10.0
}
