//! Nodes of a table, each with the co-energy and its derivatives.
use super::{Coefficients, FluxData, FluxMapError, FluxPart, MOST_CURL};
use servobench_base::Dq;

/// Largest flux at i_q = 0 of a table that is mirrored there, relative to the largest one.
const NO_FLUX: f64 = 1e-3;

/// Data of a node.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
struct Node {
    coenergy: f64,
    flux: Dq,
    /// Mixed derivative of the co-energy.
    cross: f64,
}

#[derive(Debug, Clone)]
pub(super) struct Grid {
    pub(super) i_d: Vec<f64>,
    pub(super) i_q: Vec<f64>,
    /// Nodes of the first i_d, then those of the next one.
    nodes: Vec<Node>,
}

/// An edge from one node to another, and the gain of the co-energy along it.
struct Edge {
    from: usize,
    to: usize,
    gain: f64,
    weight: f64,
}

impl Grid {
    pub(super) fn new(data: &FluxData) -> Result<Self, FluxMapError> {
        check(data)?;
        let data = mirrored(data)?;
        let FluxData { i_d, i_q, psi_d, psi_q } = data;
        let flux = |at: usize| Dq { d: psi_d[at], q: psi_q[at] };
        let nodes = (0..psi_d.len()).map(|at| Node { flux: flux(at), ..Node::default() }).collect();
        let mut grid = Self { i_d, i_q, nodes };
        grid.check_growth()?;
        grid.set_cross();
        let edges = grid.edges();
        grid.check_curl(&edges)?;
        grid.set_coenergy(&edges);
        Ok(grid)
    }

    /// Cells along the d axis.
    pub(super) fn across(&self) -> usize {
        self.i_d.len() - 1
    }

    /// Cells along the q axis.
    pub(super) fn along(&self) -> usize {
        self.i_q.len() - 1
    }

    fn at(&self, j: usize, k: usize) -> usize {
        j * self.i_q.len() + k
    }

    fn node(&self, j: usize, k: usize) -> Node {
        self.nodes[self.at(j, k)]
    }

    /// Mean inductances over the table (H).
    pub(super) fn mean_inductance(&self) -> Dq {
        let (across, along) = (self.across(), self.along());
        let d: f64 = (0..=along).map(|k| self.node(across, k).flux.d - self.node(0, k).flux.d).sum();
        let q: f64 = (0..=across).map(|j| self.node(j, along).flux.q - self.node(j, 0).flux.q).sum();
        let per = |sum: f64, count: usize, axis: &[f64]| sum / (count as f64 * (axis[axis.len() - 1] - axis[0]));
        Dq { d: per(d, along + 1, &self.i_d), q: per(q, across + 1, &self.i_q) }
    }

    /// ψ_d along the d axis, with ψ_q along the q axis.
    fn lines(&self) -> impl Iterator<Item = (FluxPart, Vec<usize>)> {
        let (rows, columns) = (self.i_d.len(), self.i_q.len());
        let along_d = (0..columns).map(move |k| (FluxPart::FluxD, (0..rows).map(|j| j * columns + k).collect()));
        let along_q = (0..rows).map(move |j| (FluxPart::FluxQ, (0..columns).map(|k| j * columns + k).collect()));
        along_d.chain(along_q)
    }

    fn own_flux(&self, which: FluxPart, at: usize) -> f64 {
        if which == FluxPart::FluxD { self.nodes[at].flux.d } else { self.nodes[at].flux.q }
    }

    fn currents(&self, at: usize) -> [f64; 2] {
        [self.i_d[at / self.i_q.len()], self.i_q[at % self.i_q.len()]]
    }

    fn check_growth(&self) -> Result<(), FluxMapError> {
        for (which, line) in self.lines() {
            for ends in line.windows(2) {
                let flux = [ends[0], ends[1]].map(|at| self.own_flux(which, at));
                if flux[1] <= flux[0] {
                    let [from, to] = [ends[0], ends[1]].map(|at| self.currents(at));
                    return Err(FluxMapError::Falls { which, from, to, flux });
                }
            }
        }
        Ok(())
    }

    /// The mean of dψ_d/di_q and dψ_q/di_d.
    fn set_cross(&mut self) {
        let (rows, columns) = (self.i_d.len(), self.i_q.len());
        for j in 0..rows {
            for k in 0..columns {
                let of_d = slope(&self.i_q, k, |n| self.node(j, n).flux.d);
                let of_q = slope(&self.i_d, j, |n| self.node(n, k).flux.q);
                let at = self.at(j, k);
                self.nodes[at].cross = f64::midpoint(of_d, of_q);
            }
        }
    }

    fn edges(&self) -> Vec<Edge> {
        let mut edges = Vec::new();
        for (which, line) in self.lines() {
            let axis = if which == FluxPart::FluxD { &self.i_d } else { &self.i_q };
            let flux = |n: usize| self.own_flux(which, line[n]);
            for (n, ends) in line.windows(2).enumerate() {
                let width = axis[n + 1] - axis[n];
                let secant = (flux(n + 1) - flux(n)) / width;
                // A slope that is steeper than twice the secant would make the inductance negative at the other end.
                let [first, last] = [n, n + 1].map(|n| slope(axis, n, flux).clamp(0.0, 1.8 * secant));
                let gain = width * (f64::midpoint(flux(n), flux(n + 1)) - width * (last - first) / 12.0);
                edges.push(Edge { from: ends[0], to: ends[1], gain, weight: 1.0 / (width * width) });
            }
        }
        edges
    }

    fn check_curl(&self, edges: &[Edge]) -> Result<(), FluxMapError> {
        let (rows, columns) = (self.i_d.len(), self.i_q.len());
        let along_d = |j: usize, k: usize| edges[k * (rows - 1) + j].gain;
        let along_q = |j: usize, k: usize| edges[columns * (rows - 1) + j * (columns - 1) + k].gain;
        let mean = self.mean_inductance();
        for j in 0..rows - 1 {
            for k in 0..columns - 1 {
                let (d, q) = ([self.i_d[j], self.i_d[j + 1]], [self.i_q[k], self.i_q[k + 1]]);
                let round = along_d(j, k) + along_q(j + 1, k) - along_d(j, k + 1) - along_q(j, k);
                let curl = (round / ((d[1] - d[0]) * (q[1] - q[0]))).abs() / libm::sqrt(mean.d * mean.q);
                if curl > MOST_CURL {
                    return Err(FluxMapError::MakesEnergy { d, q, curl });
                }
            }
        }
        Ok(())
    }

    /// Minimises Σ weight·(W'_to − W'_from − gain)²: by conjugate gradients, starting from the gains along the first i_q.
    fn set_coenergy(&mut self, edges: &[Edge]) {
        let (rows, columns, count) = (self.i_d.len(), self.i_q.len(), self.nodes.len());
        let mut x = vec![0.0; count];
        for edge in edges.iter().take(rows - 1) {
            x[edge.to] = x[edge.from] + edge.gain;
        }
        for edge in edges.iter().skip(columns * (rows - 1)) {
            x[edge.to] = x[edge.from] + edge.gain;
        }
        let spread = |of: &dyn Fn(&Edge) -> f64| {
            let mut sums = vec![0.0; count];
            for edge in edges {
                let flow = edge.weight * of(edge);
                sums[edge.to] += flow;
                sums[edge.from] -= flow;
            }
            sums
        };
        let dot = |a: &[f64], b: &[f64]| -> f64 { a.iter().zip(b).map(|(a, b)| a * b).sum() };
        let mut residual = spread(&|edge| edge.gain - (x[edge.to] - x[edge.from]));
        let mut direction = residual.clone();
        let mut size = dot(&residual, &residual);
        let enough = 1e-24 * edges.iter().map(|edge| edge.weight * edge.weight * edge.gain * edge.gain).sum::<f64>();
        for _ in 0..10 * (rows + columns) {
            if size <= enough {
                break;
            }
            let through = spread(&|edge| direction[edge.to] - direction[edge.from]);
            let step = size / dot(&direction, &through);
            for ((x, residual), (direction, through)) in
                x.iter_mut().zip(&mut residual).zip(direction.iter().zip(&through))
            {
                *x += step * direction;
                *residual -= step * through;
            }
            let before = size;
            size = dot(&residual, &residual);
            for (direction, residual) in direction.iter_mut().zip(&residual) {
                *direction = residual + size / before * *direction;
            }
        }
        for (node, x) in self.nodes.iter_mut().zip(x) {
            node.coenergy = x;
        }
    }

    /// c_ab of all cells.
    pub(super) fn cells(&self) -> Vec<Coefficients> {
        let cell = |j: usize, k: usize| {
            let (width_d, width_q) = (self.i_d[j + 1] - self.i_d[j], self.i_q[k + 1] - self.i_q[k]);
            // Only the difference from the first node matters.
            let base = self.node(j, k).coenergy;
            let node = |a: usize, b: usize| {
                let Node { coenergy, flux, cross } = self.node(j + a, k + b);
                [coenergy - base, width_d * flux.d, width_q * flux.q, width_d * width_q * cross]
            };
            // First by u at both t, values and slopes by t; then by t.
            let along = |a: usize, of: usize, slope: usize| {
                let (low, high) = (node(a, 0), node(a, 1));
                hermite([low[of], high[of]], [low[slope], high[slope]])
            };
            let (values, slopes) = ([along(0, 0, 2), along(1, 0, 2)], [along(0, 1, 3), along(1, 1, 3)]);
            let mut c = [[0.0; 4]; 4];
            for b in 0..4 {
                let column = hermite([values[0][b], values[1][b]], [slopes[0][b], slopes[1][b]]);
                for (row, entry) in c.iter_mut().zip(column) {
                    row[b] = entry;
                }
            }
            c
        };
        (0..self.across()).flat_map(|j| (0..self.along()).map(move |k| (j, k))).map(|(j, k)| cell(j, k)).collect()
    }

    /// Adds a frame, `share` times as wide as the table; returns it with the inductances behind it: of the d axis below and above, then
    /// of the q axis.
    pub(super) fn framed(&self, share: f64) -> (Self, [[f64; 2]; 2]) {
        let (wider, beyond_d) = self.with_sides(share);
        let (wider, beyond_q) = wider.transposed().with_sides(share);
        (wider.transposed(), [beyond_d, beyond_q])
    }

    /// The grid with d and q exchanged.
    fn transposed(&self) -> Self {
        let (rows, columns) = (self.i_d.len(), self.i_q.len());
        let node = |k: usize, j: usize| {
            let Node { coenergy, flux, cross } = self.node(j, k);
            Node { coenergy, flux: Dq { d: flux.q, q: flux.d }, cross }
        };
        let nodes = (0..columns).flat_map(|k| (0..rows).map(move |j| (k, j))).map(|(k, j)| node(k, j)).collect();
        Self { i_d: self.i_q.clone(), i_q: self.i_d.clone(), nodes }
    }

    /// Adds a row of cells below and above the d axis: W' = W'₀ + ψ_d·x + (ψ_out − ψ_d)·x²/(2·width), ψ_out the same for all i_q.
    fn with_sides(&self, share: f64) -> (Self, [f64; 2]) {
        let (rows, columns) = (self.i_d.len(), self.i_q.len());
        let width = share * (self.i_d[rows - 1] - self.i_d[0]);
        let side = |edge: usize, next: usize, out: f64| {
            let steps = (0..columns)
                .map(|k| (self.node(edge, k).flux.d - self.node(next, k).flux.d) / (self.i_d[edge] - self.i_d[next]));
            let least = steps.fold(f64::INFINITY, f64::min);
            let furthest = (0..columns).map(|k| out * self.node(edge, k).flux.d).fold(f64::NEG_INFINITY, f64::max);
            let outermost = out * (furthest + least * width);
            let nodes: Vec<Node> = (0..columns)
                .map(|k| {
                    let Node { coenergy, flux, cross } = self.node(edge, k);
                    let x = out * width;
                    Node {
                        coenergy: coenergy + x * f64::midpoint(flux.d, outermost),
                        flux: Dq { d: outermost, q: flux.q + x / 2.0 * cross },
                        cross: 0.0,
                    }
                })
                .collect();
            (nodes, least)
        };
        let ((below, least_below), (above, least_above)) = (side(0, 1, -1.0), side(rows - 1, rows - 2, 1.0));
        let mut i_d = vec![self.i_d[0] - width];
        i_d.extend(&self.i_d);
        i_d.push(self.i_d[rows - 1] + width);
        let nodes = below.into_iter().chain(self.nodes.iter().copied()).chain(above).collect();
        (Self { i_d, i_q: self.i_q.clone(), nodes }, [least_below, least_above])
    }
}

/// Coefficients of the cubic from 0 to 1 with these values and slopes at its ends.
fn hermite([low, high]: [f64; 2], [first, last]: [f64; 2]) -> [f64; 4] {
    let rise = high - low;
    [low, first, 3.0 * rise - 2.0 * first - last, first + last - 2.0 * rise]
}

/// Slope at a node, of the parabola through it and its neighbours.
fn slope(x: &[f64], n: usize, y: impl Fn(usize) -> f64) -> f64 {
    let middle = n.clamp(1, x.len() - 2);
    let secant = |n: usize| (y(n + 1) - y(n)) / (x[n + 1] - x[n]);
    let (before, after) = (secant(middle - 1), secant(middle));
    let bend = (after - before) / (x[middle + 1] - x[middle - 1]);
    // y = y₀ + before·(x − x₀) + bend·(x − x₀)·(x − x₁).
    before + bend * ((x[n] - x[middle - 1]) + (x[n] - x[middle]))
}

fn check(data: &FluxData) -> Result<(), FluxMapError> {
    for (which, axis) in [(FluxPart::CurrentD, &data.i_d), (FluxPart::CurrentQ, &data.i_q)] {
        if !(FluxData::FEWEST..=FluxData::MOST).contains(&axis.len()) {
            return Err(FluxMapError::Count { which, count: axis.len() });
        }
    }
    let expected = data.i_d.len() * data.i_q.len();
    for (which, flux) in [(FluxPart::FluxD, &data.psi_d), (FluxPart::FluxQ, &data.psi_q)] {
        if flux.len() != expected {
            return Err(FluxMapError::Size { which, count: flux.len(), expected });
        }
    }
    let all = [
        (FluxPart::CurrentD, &data.i_d),
        (FluxPart::CurrentQ, &data.i_q),
        (FluxPart::FluxD, &data.psi_d),
        (FluxPart::FluxQ, &data.psi_q),
    ];
    for (which, values) in all {
        if let Some(value) = values.iter().copied().find(|value| !value.is_finite()) {
            return Err(FluxMapError::NotFinite { which, value });
        }
    }
    for (which, axis) in [(FluxPart::CurrentD, &data.i_d), (FluxPart::CurrentQ, &data.i_q)] {
        if let Some(pair) = axis.windows(2).find(|pair| pair[1] <= pair[0]) {
            return Err(FluxMapError::Order { which, before: pair[0], after: pair[1] });
        }
        let range = [axis[0], axis[axis.len() - 1]];
        if range[0] > 0.0 || range[1] < 0.0 {
            return Err(FluxMapError::WithoutZero { which, range });
        }
    }
    Ok(())
}

/// Adds the other half of a table that begins at i_q = 0: ψ_d is even in i_q, ψ_q is odd.
fn mirrored(data: &FluxData) -> Result<FluxData, FluxMapError> {
    if data.i_q[0] != 0.0 {
        return Ok(data.clone());
    }
    let columns = data.i_q.len();
    let largest = data.psi_q.iter().fold(0.0, |most: f64, flux| most.max(flux.abs()));
    let both = |row: &[f64], sign: f64| -> Vec<f64> {
        row[1..].iter().rev().map(|value| sign * value).chain(row.iter().copied()).collect()
    };
    let (mut psi_d, mut psi_q) = (Vec::new(), Vec::new());
    for (j, current) in data.i_d.iter().enumerate() {
        let row = j * columns..(j + 1) * columns;
        let mut of_q = data.psi_q[row.clone()].to_vec();
        if of_q[0].abs() > NO_FLUX * largest {
            return Err(FluxMapError::NoMirror { current: *current, flux: of_q[0] });
        }
        of_q[0] = 0.0;
        psi_d.extend(both(&data.psi_d[row], 1.0));
        psi_q.extend(both(&of_q, -1.0));
    }
    Ok(FluxData { i_d: data.i_d.clone(), i_q: both(&data.i_q, -1.0), psi_d, psi_q })
}
