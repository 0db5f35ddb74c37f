//! Two masses with a spring and a damper between them, split by force and displacement.
//!
//! ```text
//! block 0: m₁·ẍ₁ = F(t) + f            outputs x₁, v₁; input f
//! block 1: m₂·ẍ₂ = −f                  output f = −c·(x₁ − x₂) − d·(v₁ − v₂); inputs x₁, v₁
//! F = F₀·(3/2 − 2·cos wt + ½·cos 2wt) = F₀·(1 − cos wt)²: its first three derivatives are 0 at t = 0
//! ```
//! The force is a linear system of its own in block 0: a constant and two oscillators.
use super::linear::{Linear, Matrix, Model, connect, member};
use servobench_base::{Divider, Rate};
use servobench_coupling::{Master, Method, Network, Order, Settings};

/// Masses (kg), stiffness (N/m), damping (N·s/m).
#[derive(Debug, Clone, Copy)]
pub(crate) struct TwoMasses {
    pub(crate) m1: f64,
    pub(crate) m2: f64,
    pub(crate) c: f64,
    pub(crate) d: f64,
    /// Amplitude (N) and angular frequency (rad/s) of the force.
    pub(crate) force: (f64, f64),
    /// Velocity of the first mass at the beginning (m/s).
    pub(crate) v1: f64,
}

/// The modes of these: ω² = c·(1/m₁ + 1/m₂) = 150 s⁻², ω = 12.2 rad/s.
pub(crate) const RESOLVED: TwoMasses = TwoMasses { m1: 1.0, m2: 2.0, c: 100.0, d: 2.0, force: (50.0, 8.0), v1: 0.0 };

impl TwoMasses {
    /// x₁, v₁, constant, cos wt, sin wt, cos 2wt, sin 2wt.
    fn first(&self) -> Linear {
        let (amplitude, w) = self.force;
        let (mut a, mut b) = (vec![vec![0.0; 7]; 7], vec![vec![0.0]; 7]);
        a[0][1] = 1.0;
        for (state, share) in [(2, 1.5), (3, -2.0), (5, 0.5)] {
            a[1][state] = amplitude * share / self.m1;
        }
        (a[3][4], a[4][3], a[5][6], a[6][5]) = (-w, w, -2.0 * w, 2.0 * w);
        b[1][0] = 1.0 / self.m1;
        let mut c = vec![vec![0.0; 7]; 2];
        (c[0][0], c[1][1]) = (1.0, 1.0);
        Linear::new(Model { a, b, c, d: vec![vec![0.0]; 2] }, &[0.0, self.v1, 1.0, 1.0, 0.0, 1.0, 0.0])
    }

    fn second(&self) -> Linear {
        let Self { m2, c, d, .. } = *self;
        let model = Model {
            a: vec![vec![0.0, 1.0], vec![-c / m2, -d / m2]],
            b: vec![vec![0.0, 0.0], vec![c / m2, d / m2]],
            c: vec![vec![c, d]],
            d: vec![vec![-c, -d]],
        };
        Linear::new(model, &[0.0, 0.0])
    }

    /// Both blocks, the force as connection 0, the displacement as 1, the velocity as 2.
    pub(crate) fn network(&self) -> Network<Linear> {
        Network {
            members: vec![member("first", self.first(), 1, 2), member("second", self.second(), 2, 1)],
            connections: vec![connect((1, 0), (0, 0)), connect((0, 0), (1, 0)), connect((0, 1), (1, 1))],
        }
    }

    /// x₁, v₁, x₂, v₂ at `t` (s) of both together.
    pub(crate) fn exact(&self, t: f64) -> [f64; 4] {
        let (first, second) = (self.first(), self.second());
        let mut whole = Matrix::zeros(9);
        for row in 0..7 {
            (0..7).for_each(|k| *whole.at(row, k) = first.model.a[row][k]);
        }
        for (k, share) in [(0, -self.c), (1, -self.d), (7, self.c), (8, self.d)] {
            *whole.at(1, k) += share / self.m1;
            *whole.at(8, k) -= share / self.m2;
        }
        *whole.at(7, 8) = 1.0;
        let start: Vec<f64> = first.x.iter().chain(&second.x).copied().collect();
        let mut end = [0.0; 9];
        whole.exponential(t).apply(&start, &mut end);
        [end[0], end[1], end[7], end[8]]
    }
}

/// Base ticks per second of all tests.
pub(crate) const RATE: u32 = 8192;

pub(crate) fn settings(method: Method, order: Order, ticks: u32) -> Settings {
    Settings {
        base_rate: Rate::new(RATE).unwrap(),
        step: Divider::new(ticks).unwrap(),
        method,
        order,
        algebraic: None,
        watch: true,
    }
}

/// x₁, v₁, x₂, v₂ now.
pub(crate) fn state(master: &Master<Linear>) -> [f64; 4] {
    let (first, second) = (master.block(0), master.block(1));
    [first.x[0], first.x[1], second.x[0], second.x[1]]
}
