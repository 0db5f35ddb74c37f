//! Construction of a co-energy from a table of flux linkages.
//!
//! ```text
//! along an edge   ∫ψ di = Δ·(ψ₀ + ψ₁)/2 − Δ²·(ψ₁′ − ψ₀′)/12       ψ′ by parabolas through three nodes, as steep as ψ stays monotone
//! around a cell   Γ = ∮ψ·di = Δi_d·Δi_q·(mean L_qd − mean L_dq)    zero for a magnetic circuit without loss
//! W' at the nodes: least squares of the gains along the edges      the flux linkages at the nodes stay those of the table
//! ```
//! The table is refused if Γ shows that the two cross inductances differ by more than [`MOST_CURL`] of √(L_d·L_q), the mean inductances
//! over the table: currents around the cell would create energy. It is refused if the matrix of the incremental
//! inductances is not positive definite, checked at five by five points of each cell: more current would make less flux.
//!
//! Around the table lies a frame of cells, up to half as wide as the table. In it the inductances of an edge continue, at least
//! the smallest one of that edge, while the cross-saturation fades; behind it the flux of each axis is linear in its own current. So all
//! currents have a flux, which grows with them.
mod error;
mod grid;

use super::table::{Axis, FluxTable};
use crate::pmsm::flux_map::Inductance;
pub use error::{FluxMapError, FluxPart};
use grid::Grid;
use servobench_base::Dq;

/// Flux linkages of a motor in a rectangular grid of currents.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct FluxData {
    /// Currents of the d axis (A, peak), increasing, with 0 among them.
    pub i_d: Vec<f64>,
    /// Currents of the q axis; a table that begins at 0 is mirrored.
    pub i_q: Vec<f64>,
    /// Flux linkage of the d axis (V·s, peak), all of the first i_d, then those of the next one.
    pub psi_d: Vec<f64>,
    /// Flux linkage of the q axis, in the same order.
    pub psi_q: Vec<f64>,
}

impl FluxData {
    /// Fewest currents of an axis: a parabola needs three.
    pub const FEWEST: usize = 3;
    /// Most currents of an axis.
    pub const MOST: usize = 65;
}

/// Largest difference of the cross inductances.
pub(super) const MOST_CURL: f64 = 0.1;
/// Smallest incremental inductance, relative to the mean one of its axis, and smallest determinant relative to the product of the
/// two: less cannot be distinguished from zero.
const LEAST_INDUCTANCE: f64 = 1e-3;
/// Points in a cell at which the inductances are checked.
const LOOKED_AT: [f64; 5] = [0.0, 0.25, 0.5, 0.75, 1.0];
/// Maximum number of times that the frame is halved while its inductances are not positive definite.
const HALVINGS: u32 = 12;

pub(super) fn table(data: &FluxData) -> Result<FluxTable, FluxMapError> {
    let grid = Grid::new(data)?;
    let mean = grid.mean_inductance();
    let cells = grid.cells();
    if let Some((j, k, at)) = first_bad(&grid, &cells, mean, 0..grid.across(), 0..grid.along()) {
        return Err(FluxMapError::NotIncreasing {
            d: [grid.i_d[j], grid.i_d[j + 1]],
            q: [grid.i_q[k], grid.i_q[k + 1]],
            inductance: [at.dd, at.dq, at.qq],
        });
    }
    let mut share = 0.5;
    for _ in 0..=HALVINGS {
        let (framed, beyond) = grid.framed(share);
        let cells = framed.cells();
        if frame_is_good(&framed, &cells, mean) {
            return Ok(FluxTable::new(Axis::new(&framed.i_d, beyond[0]), Axis::new(&framed.i_q, beyond[1]), cells));
        }
        share /= 2.0;
    }
    Err(FluxMapError::NoFrame)
}

fn frame_is_good(framed: &Grid, cells: &[Coefficients], mean: Dq) -> bool {
    let (across, along) = (framed.across(), framed.along());
    let sides = [(0..1, 0..along), (across - 1..across, 0..along), (0..across, 0..1), (0..across, along - 1..along)];
    sides.into_iter().all(|(d, q)| first_bad(framed, cells, mean, d, q).is_none())
}

/// c_ab of a cell.
type Coefficients = [[f64; 4]; 4];

/// The first of these cells in which the inductances are not positive definite, and their values there.
fn first_bad(
    grid: &Grid,
    cells: &[Coefficients],
    mean: Dq,
    d: core::ops::Range<usize>,
    q: core::ops::Range<usize>,
) -> Option<(usize, usize, Inductance)> {
    for j in d {
        for k in q.clone() {
            let (width_d, width_q) = (grid.i_d[j + 1] - grid.i_d[j], grid.i_q[k + 1] - grid.i_q[k]);
            for t in LOOKED_AT {
                for u in LOOKED_AT {
                    let at = curvature(&cells[j * grid.along() + k], t, u);
                    let Inductance { dd, dq, qq } = Inductance {
                        dd: at.dd / (width_d * width_d),
                        dq: at.dq / (width_d * width_q),
                        qq: at.qq / (width_q * width_q),
                    };
                    let is_good = dd > LEAST_INDUCTANCE * mean.d
                        && qq > LEAST_INDUCTANCE * mean.q
                        && dd * qq - dq * dq > LEAST_INDUCTANCE * dd * qq;
                    if !is_good {
                        return Some((j, k, Inductance { dd, dq, qq }));
                    }
                }
            }
        }
    }
    None
}

/// Second derivatives by t and u.
fn curvature(c: &Coefficients, t: f64, u: f64) -> Inductance {
    let [v, s, k] = [
        c.map(|row| row[0] + u * (row[1] + u * (row[2] + u * row[3]))),
        c.map(|row| row[1] + u * (2.0 * row[2] + u * 3.0 * row[3])),
        c.map(|row| 2.0 * row[2] + u * 6.0 * row[3]),
    ];
    Inductance {
        dd: 2.0 * v[2] + t * 6.0 * v[3],
        dq: s[1] + t * (2.0 * s[2] + t * 3.0 * s[3]),
        qq: k[0] + t * (k[1] + t * (k[2] + t * k[3])),
    }
}
