//! Runs of a motor at constant speed and under acceleration, tick by tick and by an oracle: for tests of every method of solution.
use crate::pmsm::flux_harmonics::FluxHarmonic;
use crate::pmsm::winding::Winding;
use crate::pmsm::{FluxMap, Input, Params, State, step_with_power};
use core::cell::Cell;
use servobench_base::{AlphaBeta, Dq, ElectricalAngle};

/// A run at constant speed and voltage.
#[derive(Clone, Copy)]
pub(crate) struct Run {
    pub(crate) voltage: AlphaBeta,
    pub(crate) begin: Dq,
    pub(crate) omega: f64,
    pub(crate) end: f64,
}

/// Results of a run: current, and the means of torque, copper loss and electrical power.
pub(crate) const NAMES: [&str; 5] = ["i_d", "i_q", "torque", "copper", "electrical"];

/// A motor by its equations in the stator frame, three phases one by one.
pub(crate) struct Equations<'a> {
    pub(crate) params: &'a Params,
    /// Constant inductances are a curve that is straight.
    pub(crate) map: &'a FluxMap,
    /// Flux linkage of the magnets in the map (V·s).
    pub(crate) magnets: f64,
    pub(crate) harmonics: &'a [FluxHarmonic],
    /// Resistance of each phase, relative to that of the motor.
    pub(crate) factors: [f64; 3],
}

impl Equations<'_> {
    /// By Runge and Kutta's method of order 4; the torque is the remaining energy over the speed: electrical less copper less stored.
    pub(crate) fn solve(&self, of: &Run, steps: u32) -> [f64; 5] {
        let p = self.params;
        let own = |theta: f64| {
            let sum = |of: fn(&FluxHarmonic, f64) -> f64| -> f64 {
                self.harmonics.iter().map(|one| of(one, f64::from(one.order) * theta + one.phase)).sum()
            };
            let d = p.flux_linkage * (1.0 + sum(|one, x| one.d * x.cos())) - self.magnets;
            Dq { d, q: p.flux_linkage * sum(|one, x| one.q * x.sin()) }
        };
        let near = Cell::new(of.begin);
        let current = |t: f64, flux: [f64; 2]| {
            let theta = 0.7 + of.omega * t;
            let own = own(theta);
            let linked = AlphaBeta { alpha: flux[0], beta: flux[1] }.to_dq(ElectricalAngle(theta).rotation());
            near.set(self.map.current(Dq { d: linked.d - own.d, q: linked.q - own.q }, near.get()).unwrap());
            near.get()
        };
        let slope = |t: f64, y: [f64; 4]| {
            let i = current(t, [y[0], y[1]]).to_alpha_beta(ElectricalAngle(0.7 + of.omega * t).rotation());
            let half = 3.0_f64.sqrt() / 2.0 * i.beta;
            let phases = [i.alpha, -i.alpha / 2.0 + half, -i.alpha / 2.0 - half];
            let drops: [f64; 3] = core::array::from_fn(|k| p.resistance * self.factors[k] * phases[k]);
            let star = (drops[0] + drops[1] + drops[2]) / 3.0;
            let copper: f64 = drops.iter().zip(phases).map(|(u, i)| u * i).sum();
            [
                of.voltage.alpha - (drops[0] - star),
                of.voltage.beta - (drops[1] - drops[2]) / 3.0_f64.sqrt(),
                copper / of.end,
                1.5 * (of.voltage.alpha * i.alpha + of.voltage.beta * i.beta) / of.end,
            ]
        };
        let (begin, own) = (self.map.flux(of.begin), own(0.7));
        let linked = Dq { d: begin.d + own.d, q: begin.q + own.q }.to_alpha_beta(ElectricalAngle(0.7).rotation());
        let y = runge_kutta([linked.alpha, linked.beta, 0.0, 0.0], of.end, steps, slope);
        let i = current(of.end, [y[0], y[1]]);
        let stored = self.map.stored(of.begin, i) / of.end;
        [i.d, i.q, (y[3] - y[2] - stored) * p.electrical_ratio / of.omega, y[2], y[3]]
    }

    /// Asserts that the error of `motor` relative to these equations, in ticks of `of.end`/128 and half of that, falls with the fourth
    /// order, `least` at least, to `share` of each value.
    pub(crate) fn assert_fourth_order(&self, motor: &impl Winding, of: &Run, share: f64, least: f64) {
        let oracle = self.solve(of, 40_000);
        let [coarse, fine] = [128, 256].map(|n| of.in_ticks(motor, n));
        for (at, name) in NAMES.into_iter().enumerate() {
            let [coarse, fine] = [coarse, fine].map(|found| (found[at] - oracle[at]).abs());
            let order = (coarse / fine).log2();
            println!("{name}: {fine:e} of {}, order {order}", oracle[at]);
            assert!(fine < share * oracle[at].abs().max(1.0), "{name}: off by {fine}");
            // Near 4; a value whose error happens to change its sign may fall faster.
            assert!(order > least, "{name}: observed order {order}, {coarse} {fine}");
        }
    }
}

/// `y` after `end`, with its derivative `slope`, by Runge and Kutta's method of order 4.
pub(crate) fn runge_kutta<const N: usize>(
    mut y: [f64; N],
    end: f64,
    steps: u32,
    slope: impl Fn(f64, [f64; N]) -> [f64; N],
) -> [f64; N] {
    let h = end / f64::from(steps);
    for k in 0..steps {
        let t = f64::from(k) * h;
        let ahead = |by: f64, k: [f64; N]| core::array::from_fn(|n| y[n] + by * k[n]);
        let k1 = slope(t, y);
        let k2 = slope(t + h / 2.0, ahead(h / 2.0, k1));
        let k3 = slope(t + h / 2.0, ahead(h / 2.0, k2));
        let k4 = slope(t + h, ahead(h, k3));
        y = core::array::from_fn(|n| y[n] + h / 6.0 * (k1[n] + 2.0 * (k2[n] + k3[n]) + k4[n]));
    }
    y
}

impl Run {
    /// The same from `n` ticks of `motor`.
    pub(crate) fn in_ticks(&self, motor: &impl Winding, n: u32) -> [f64; 5] {
        let (h, mut x) = (self.end / f64::from(n), State { current: self.begin });
        let mut means = [0.0; 3];
        for k in 0..n {
            let rotor = ElectricalAngle(0.7 + self.omega * h * f64::from(k)).rotation();
            let output = motor.step(&mut x, &Input { voltage: self.voltage, rotor, omega_e: self.omega }, h);
            for (mean, one) in means.iter_mut().zip([output.torque, output.power.copper, output.power.electrical]) {
                *mean += one / f64::from(n);
            }
        }
        [x.current.d, x.current.q, means[0], means[1], means[2]]
    }
}

/// Asserts that a tick of `h` (s) of `motor`, whose rotor turns by `turn` (rad) in it, equals that of the motor with constant parameters
/// `p`, which is solved exactly.
pub(crate) fn assert_solved_exactly(motor: &impl Winding, p: &Params, h: f64, turn: f64) {
    let rotor = ElectricalAngle(0.7).rotation();
    let omega_e = turn / h;
    let voltage = Dq { d: -7.0, q: 11.0 + omega_e * p.flux_linkage }.to_alpha_beta(rotor);
    let input = Input { voltage, rotor, omega_e };
    let [mut x, mut y] = [State { current: Dq { d: -1.3, q: 2.4 } }; 2];
    let ours = motor.step(&mut x, &input, h);
    let exact = step_with_power(p, &mut y, input, h);
    let through = 1.0 / (p.resistance + p.inductance.d / h);
    let scale = 3.0 + (20.0 + (omega_e * p.flux_linkage).abs()) * through;
    let off = (x.current.d - y.current.d).abs().max((x.current.q - y.current.q).abs());
    // (1/4)⁴/720 of a transient for each part of the tick, which survives 24 of them at most.
    assert!(off < 2e-5 * scale, "{p:?} {turn}: off by {off} of {scale}");
    let most = 1.5 * p.electrical_ratio * (p.flux_linkage + (p.inductance.q - p.inductance.d) * scale) * scale;
    // A product of two currents that each change by a quarter in a part.
    assert!((ours.torque - exact.torque).abs() < 2e-5 * most, "{turn}: {} {}", ours.torque, exact.torque);
}

/// Asserts that a tick of `motor` at the mean of a changing speed is of second order, against a finer tick.
pub(crate) fn assert_second_order_under_acceleration(motor: &impl Winding) {
    let (omega, acceleration) = (300.0, 4e5);
    let end = |n: u32| {
        let (h, mut x) = (2e-3 / f64::from(n), State::default());
        for k in 0..n {
            let t = f64::from(k) * h;
            let rotor = ElectricalAngle(omega * t + acceleration * t * t / 2.0).rotation();
            let voltage = AlphaBeta { alpha: -60.0, beta: 41.0 };
            motor.step(&mut x, &Input { voltage, rotor, omega_e: omega + acceleration * (t + h / 2.0) }, h);
        }
        x.current.q
    };
    let exact = end(4096);
    let order = ((end(32) - exact) / (end(64) - exact)).log2();
    assert!((order - 2.0).abs() < 0.15, "observed order {order}");
}
