//! A co-energy that is interpolated in a rectangular grid: bicubic in each cell, with its value, both its derivatives (the flux linkages)
//! and the mixed one (the cross inductance) at every node.
//!
//! ```text
//! W'(t, u) = Σ c_ab·t^a·u^b      a, b = 0 … 3      t, u from 0 to 1 in a cell
//! ```
//! Flux linkages are continuous and those of the table at its nodes; the inductances are continuous within a cell. Beyond the outermost
//! nodes, ψ_d continues with a constant L_dd and ψ_q with a constant L_qq, each independently; the builder makes ψ_d constant along
//! the outermost lines of i_d, and ψ_q along those of i_q. Bicubic Hermite interpolation: Press et al., *Numerical Recipes*, 3rd ed., §3.6.
use super::{FluxPoint, Inductance};
use servobench_base::Dq;

/// Lines of the grid along one axis, including one at either infinity.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Axis {
    lines: Vec<f64>,
    /// Inductance beyond the first and the last node (H).
    beyond: [f64; 2],
}

/// Position of a current along an axis.
#[derive(Debug, Clone, Copy)]
struct Place {
    /// From 0 to 1.
    t: f64,
    /// 1/width.
    per: f64,
    /// Distance beyond the grid, and the inductance there.
    out: Option<(f64, f64)>,
}

impl Axis {
    /// An axis with increasing nodes, and the inductances beyond the first and the last one.
    pub(super) fn new(nodes: &[f64], beyond: [f64; 2]) -> Self {
        let lines = core::iter::once(f64::NEG_INFINITY).chain(nodes.iter().copied()).chain([f64::INFINITY]).collect();
        Self { lines, beyond }
    }

    /// Cells of the grid.
    fn inner(&self) -> usize {
        self.lines.len() - 3
    }

    /// The cell of a current: 0 is beyond the first node, the last one beyond the last node.
    fn cell(&self, i: f64) -> usize {
        self.lines.partition_point(|line| *line <= i).saturating_sub(1).min(self.lines.len() - 2)
    }

    /// Position of a current in the cell, and the cell of the grid by which it is computed.
    #[expect(clippy::inline_always, reason = "what is inlined is compiled for the registers of its caller")]
    #[inline(always)]
    fn place(&self, cell: usize, i: f64) -> (usize, Place) {
        let inner = cell.clamp(1, self.inner());
        let (low, high) = (self.lines[inner], self.lines[inner + 1]);
        let per = 1.0 / (high - low);
        let (t, out) = match cell.cmp(&inner) {
            core::cmp::Ordering::Less => (0.0, Some((i - low, self.beyond[0]))),
            core::cmp::Ordering::Equal => ((i - low) * per, None),
            core::cmp::Ordering::Greater => (1.0, Some((i - high, self.beyond[1]))),
        };
        (inner - 1, Place { t, per, out })
    }
}

/// A table that is a co-energy.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct FluxTable {
    d: Axis,
    q: Axis,
    /// c_ab of each cell, first those of the first i_d.
    cells: Vec<[[f64; 4]; 4]>,
}

/// Points of Gauss and Legendre's rule from 0 to 1, exact up to the fifth power, and their weights (Abramowitz & Stegun, table 25.4).
const POINTS: [f64; 3] = [0.112_701_665_379_258_31, 0.5, 0.887_298_334_620_741_7];
const WEIGHTS: [f64; 3] = [5.0 / 18.0, 4.0 / 9.0, 5.0 / 18.0];

impl FluxTable {
    /// A table with coefficients from the builder.
    pub(super) const fn new(d: Axis, q: Axis, cells: Vec<[[f64; 4]; 4]>) -> Self {
        Self { d, q, cells }
    }

    pub(super) fn at(&self, i: Dq) -> FluxPoint {
        self.in_cell([self.d.cell(i.d), self.q.cell(i.q)], i)
    }

    #[expect(clippy::many_single_char_names, reason = "the polynomial's own")]
    fn in_cell(&self, [cell_d, cell_q]: [usize; 2], i: Dq) -> FluxPoint {
        let ((at_d, Place { t, per: per_d, out: out_d }), (at_q, Place { t: u, per: per_q, out: out_q })) =
            (self.d.place(cell_d, i.d), self.q.place(cell_q, i.q));
        let c = &self.cells[at_d * self.q.inner() + at_q];
        // Rows by u: value, slope and curvature.
        let v = c.map(|row| row[0] + u * (row[1] + u * (row[2] + u * row[3])));
        let s = c.map(|row| row[1] + u * (2.0 * row[2] + u * (3.0 * row[3])));
        let k = c.map(|row| 2.0 * row[2] + u * (6.0 * row[3]));
        let by_t = |row: [f64; 4]| row[0] + t * (row[1] + t * (row[2] + t * row[3]));
        let slope_t = |row: [f64; 4]| row[1] + t * (2.0 * row[2] + t * (3.0 * row[3]));
        let mut flux = Dq { d: per_d * slope_t(v), q: per_q * by_t(s) };
        let mut inductance = Inductance {
            dd: per_d * per_d * (2.0 * v[2] + t * (6.0 * v[3])),
            dq: per_d * per_q * slope_t(s),
            qq: per_q * per_q * by_t(k),
        };
        if let Some((by, constant)) = out_d {
            flux.d += constant * by;
            (inductance.dd, inductance.dq) = (constant, 0.0);
        }
        if let Some((by, constant)) = out_q {
            flux.q += constant * by;
            (inductance.qq, inductance.dq) = (constant, 0.0);
        }
        FluxPoint { flux, inductance }
    }

    /// ∫ s·Δiᵀ·L(i₀ + s·Δi)·Δi ds from 0 to 1, from line to line of the grid: between them a polynomial of the fifth power, so that the
    /// rule is exact.
    pub(super) fn beyond(&self, before: Dq, after: Dq) -> f64 {
        let change = Dq { d: after.d - before.d, q: after.q - before.q };
        let mut cell = [self.d.cell(before.d), self.q.cell(before.q)];
        let (mut sum, mut begin) = (0.0, 0.0);
        // Each line of either axis is crossed once.
        for _ in 0..=self.d.lines.len() + self.q.lines.len() {
            let exits = [(&self.d, cell[0], before.d, change.d), (&self.q, cell[1], before.q, change.q)]
                .map(|(axis, cell, from, change)| exit(axis, cell, from, change));
            let end = exits[0].min(exits[1]).min(1.0);
            if end > begin {
                let width = end - begin;
                for (point, weight) in POINTS.into_iter().zip(WEIGHTS) {
                    let s = begin + width * point;
                    let i = Dq { d: before.d + s * change.d, q: before.q + s * change.q };
                    let Inductance { dd, dq, qq } = self.in_cell(cell, i).inductance;
                    let form = dd * change.d * change.d + 2.0 * dq * change.d * change.q + qq * change.q * change.q;
                    sum += width * weight * s * form;
                }
                begin = end;
            }
            if end >= 1.0 {
                break;
            }
            for (at, (cell, change)) in cell.iter_mut().zip([change.d, change.q]).enumerate() {
                if exits[at] <= end {
                    *cell = if change > 0.0 { *cell + 1 } else { cell.saturating_sub(1) };
                }
            }
        }
        sum
    }
}

/// Share of the path, from 0 on, up to the line that ends the cell.
fn exit(axis: &Axis, cell: usize, from: f64, change: f64) -> f64 {
    if change > 0.0 {
        (axis.lines[cell + 1] - from) / change
    } else if change < 0.0 {
        (axis.lines[cell] - from) / change
    } else {
        f64::INFINITY
    }
}
