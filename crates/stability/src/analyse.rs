//! Analysis of a loop, which gives a report.
//!
//! The verdict is that of the whole loop. The unstable loop is identified by closing the loops from the inside: the current loop with the
//! shaft held, the velocity loop with the position loop open, the position loop; it is the first that is unstable.
use crate::boundary;
use crate::eigen::{self, Block, Eigenvalue};
use crate::equations::{Closed, Equations};
use crate::error::StabilityError;
use crate::model::{Loop, Source};
use crate::period::Period;
use crate::pole::Pole;
use crate::report::{Boundaries, Boundary, GainName, Instability, LoopName, LoopReport, Report, Slowest};
use nalgebra::Complex;
use servobench_base::Coordinate;
use servobench_base::Dq;
use servobench_drive::Stage;
use servobench_linear::{Factors, Running};
use std::f64::consts::TAU;

/// Depth of an analysis.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Depth {
    /// The verdict, and if unstable, the reason.
    Verdict,
    /// Also the boundaries of all gains and the least damped poles, which takes longer.
    Boundaries,
}

/// Analyses the loop `running`, which `model` describes.
///
/// # Errors
/// [`StabilityError`] names a parameter out of its bound, or the reason why the poles could not be computed.
pub fn analyse<'a>(model: &'a Loop, running: Box<dyn Running + 'a>, depth: Depth) -> Result<Report, StabilityError> {
    model.check()?;
    let mut analysis = Analysis::new(model, running)?;
    let poles = analysis.poles(analysis.whole())?;
    let unstable = poles.outside().map(|eigenvalue| poles.in_seconds(&analysis.equations, &eigenvalue));
    let is_unstable = unstable.is_some();
    let largest = unstable.or_else(|| poles.largest(&analysis.equations));
    let slowest = poles.that_fade_last(&analysis.equations);
    let instability = match unstable {
        Some(pole) => Some(analysis.instability(pole)?),
        None => None,
    };
    let mut loops = Vec::new();
    for name in [LoopName::Current, LoopName::Velocity, LoopName::Position] {
        if let Some(report) = analysis.report(name, is_unstable, depth)? {
            loops.push(report);
        }
    }
    Ok(Report { instability, largest, slowest, loops, warnings: model.warnings() })
}

/// The whole loop with the position loop that a master closes: the poles that decay last, and the factor on the gain of that loop, nearest
/// to 1, up to which it is stable: below 1 if it is not, and 0 if no gain makes it so. The factor is `None` if it is stable and only the
/// verdict is requested.
///
/// # Errors
/// [`StabilityError`] names a parameter out of its bound, or the reason why the poles could not be computed.
pub fn analyse_master<'a>(
    model: &'a Loop,
    running: Box<dyn Running + 'a>,
    depth: Depth,
) -> Result<(Slowest, Option<f64>), StabilityError> {
    model.check()?;
    let mut analysis = Analysis::new(model, running)?;
    let whole = analysis.whole();
    let poles = analysis.poles(whole)?;
    let (slowest, is_unstable) = (poles.that_fade_last(&analysis.equations), poles.outside().is_some());
    if depth == Depth::Verdict && !is_unstable {
        return Ok((slowest, None));
    }
    let [below, above] = boundary::nearest(&mut analysis.equations, whole, GainName::Position, is_unstable)?;
    let margin = if is_unstable { below.unwrap_or(0.0) } else { above.unwrap_or(f64::INFINITY) };
    Ok((slowest, Some(margin)))
}

/// The poles of the loops that a tick closes.
pub(crate) struct Poles {
    period: Period,
    blocks: Vec<Block>,
    /// Each pole with the index of its block.
    pub(crate) values: Vec<(usize, Complex<f64>)>,
}

impl Poles {
    pub(crate) fn new(equations: &mut Equations) -> Result<Self, StabilityError> {
        let period = Period::new(equations)?;
        let blocks = eigen::blocks(&period)?;
        let values = candidates(equations, &blocks);
        Ok(Self { period, blocks, values })
    }

    fn refined(&self, (block, value): (usize, Complex<f64>)) -> Eigenvalue {
        self.blocks[block].refine(&self.period, value)
    }

    /// The largest pole outside of the unit circle, by more than rounding.
    pub(crate) fn outside(&self) -> Option<Eigenvalue> {
        let mut outside: Vec<_> = self.values.iter().copied().filter(|(_, value)| value.norm_sqr() > 1.0).collect();
        outside.sort_by(|(_, a), (_, b)| b.norm().total_cmp(&a.norm()));
        outside
            .into_iter()
            .map(|pole| self.refined(pole))
            .find(|eigenvalue| eigenvalue.value.norm() - 1.0 > eigenvalue.bound)
    }

    fn largest(&self, equations: &Equations) -> Option<Pole> {
        let largest = self.values.iter().max_by(|(_, a), (_, b)| a.norm().total_cmp(&b.norm()))?;
        Some(self.in_seconds(equations, &self.refined(*largest)))
    }

    fn that_fade_last(&self, equations: &Equations) -> Slowest {
        Slowest {
            oscillating: self.slowest(equations, |pole| pole.im != 0.0 || pole.re < 0.0, Pole::oscillates),
            real: self.slowest(equations, |pole| pole.im == 0.0 && pole.re > 0.0, |_| true),
        }
    }

    /// The pole that decays last among those of a kind; `is_kind` gets the pole over a period, `is_wanted` the pole in seconds.
    fn slowest(
        &self,
        equations: &Equations,
        is_kind: impl Fn(Complex<f64>) -> bool,
        is_wanted: impl Fn(&Pole) -> bool,
    ) -> Option<Pole> {
        // A pole at the origin is a delay; one of a pair stands for both.
        let of_kind = |value: Complex<f64>| value.im >= 0.0 && value.norm() > f64::EPSILON.sqrt() && is_kind(value);
        let mut found: Vec<_> = self.values.iter().copied().filter(|(_, value)| of_kind(*value)).collect();
        found.sort_by(|(_, a), (_, b)| b.norm().total_cmp(&a.norm()));
        found.into_iter().map(|pole| self.in_seconds(equations, &self.refined(pole))).find(is_wanted)
    }

    fn in_seconds(&self, equations: &Equations, eigenvalue: &Eigenvalue) -> Pole {
        Pole::new(&self.period, equations, eigenvalue)
    }

    /// Largest magnitude in a block with the state `index`.
    fn largest_with(&self, index: usize) -> f64 {
        let of_state = self.values.iter().filter(|(block, _)| self.blocks[*block].states.contains(&index));
        of_state.map(|(_, value)| value.norm()).fold(0.0, f64::max)
    }
}

/// The poles of all loops except the one that is known to be at 1.
fn candidates(equations: &Equations, blocks: &[Block]) -> Vec<(usize, Complex<f64>)> {
    let of_block =
        |(index, block): (usize, &Block)| block.eigenvalues.iter().map(|value| (index, *value)).collect::<Vec<_>>();
    let mut all: Vec<_> = blocks.iter().enumerate().flat_map(of_block).collect();
    if let Some(motor) = equations.motor_velocity().filter(|_| equations.turns_freely()) {
        let turns = |block: usize| blocks[block].states.contains(&motor);
        let to_one = |&(_, (_, value)): &(usize, (usize, Complex<f64>))| (value - 1.0).norm();
        let nearest = all
            .iter()
            .copied()
            .enumerate()
            .filter(|(_, (block, _))| turns(*block))
            .min_by(|a, b| to_one(a).total_cmp(&to_one(b)));
        if let Some((index, _)) = nearest {
            all.swap_remove(index);
        }
    }
    all
}

/// A loop under analysis, with the gains at a speed of the drive's schedule.
pub(crate) struct Analysis<'a> {
    model: &'a Loop,
    equations: Equations<'a>,
    /// Factors on position and velocity gain, and their speed (motor coordinate); `None` at standstill.
    scheduled: ((f64, f64), Option<f64>),
}

impl<'a> Analysis<'a> {
    /// The analysis at standstill.
    pub(crate) fn new(model: &'a Loop, running: Box<dyn Running + 'a>) -> Result<Self, StabilityError> {
        Ok(Self { model, equations: Equations::new(model, running)?, scheduled: ((1.0, 1.0), None) })
    }

    fn schedule(&mut self, factors: (f64, f64), speed: Option<f64>) {
        self.scheduled = (factors, speed);
        self.equations.schedule(factors);
    }

    /// The fastest growing pole of the whole loop with its gains scaled by `factors`.
    pub(crate) fn unstable_at(&mut self, factors: (f64, f64)) -> Result<Option<Pole>, StabilityError> {
        self.schedule(factors, None);
        self.unstable(self.whole())
    }

    /// The reason why the whole loop, whose largest pole is `pole`, is unstable at `speed`, where its gains are scaled by `factors`.
    pub(crate) fn instability_at(
        &mut self,
        factors: (f64, f64),
        speed: f64,
        pole: Pole,
    ) -> Result<Instability, StabilityError> {
        self.schedule(factors, Some(speed));
        self.instability(pole)
    }

    /// All loops with a gain.
    fn whole(&self) -> Closed {
        let closes_velocity = self.model.drive.velocity.k_p > 0.0;
        Closed { position: self.model.has_position_loop() && closes_velocity, velocity: closes_velocity, shaft: true }
    }

    /// The loop `name` with the loops around it open.
    fn alone(&self, name: LoopName) -> Closed {
        match name {
            LoopName::Current => Closed { position: false, velocity: false, shaft: false },
            LoopName::Velocity => Closed { position: false, ..self.whole() },
            LoopName::Position => self.whole(),
        }
    }

    fn poles(&mut self, closed: Closed) -> Result<Poles, StabilityError> {
        self.equations.with(closed, Factors::ONE);
        Poles::new(&mut self.equations)
    }

    fn unstable(&mut self, closed: Closed) -> Result<Option<Pole>, StabilityError> {
        let poles = self.poles(closed)?;
        Ok(poles.outside().map(|eigenvalue| poles.in_seconds(&self.equations, &eigenvalue)))
    }

    /// The reason why the whole loop, whose largest pole is `pole`, is unstable.
    fn instability(&mut self, pole: Pole) -> Result<Instability, StabilityError> {
        let whole = self.whole();
        if self.unstable(self.alone(LoopName::Current))?.is_some() {
            let gain_name = self.unstable_axis()?;
            return self.named(LoopName::Current, gain_name, pole);
        }
        if whole.position && self.unstable(self.alone(LoopName::Velocity))?.is_none() {
            return self.named(LoopName::Position, GainName::Position, pole);
        }
        if whole.velocity {
            let velocity = self.named(LoopName::Velocity, GainName::Velocity, pole)?;
            let open = Closed { position: false, velocity: false, shaft: true };
            if !velocity.boundaries.is_none() || self.unstable(open)?.is_none() {
                return Ok(velocity);
            }
        }
        // The decoupling of the back-EMF closes a loop over the shaft with no other gain than this one.
        let gain_name = self.current_gain_name();
        self.named(LoopName::Current, gain_name, pole)
    }

    fn named(&mut self, name: LoopName, gain_name: GainName, pole: Pole) -> Result<Instability, StabilityError> {
        let (gain, unit) = self.gain(gain_name);
        let mut boundaries = self.boundaries(self.whole(), gain_name, true)?;
        let alone = self.alone(name);
        if boundaries.is_none() && alone != self.whole() && self.unstable(alone)?.is_some() {
            boundaries = Boundaries { alone: true, ..self.boundaries(alone, gain_name, true)? };
        }
        let speed = self.scheduled.1.map(|speed| (speed, self.speed_unit()));
        Ok(Instability { name, gain_name, gain, unit, pole, boundaries, speed })
    }

    fn boundaries(
        &mut self,
        closed: Closed,
        gain_name: GainName,
        is_unstable: bool,
    ) -> Result<Boundaries, StabilityError> {
        let (gain, _) = self.gain(gain_name);
        let [below, above] = boundary::nearest(&mut self.equations, closed, gain_name, is_unstable)?
            .map(|factor| factor.map(|factor| Boundary { factor, gain: factor * gain }));
        Ok(Boundaries { below, above, alone: false })
    }

    /// The gain of the current loop that is too large, if the loop by itself is unstable.
    fn unstable_axis(&mut self) -> Result<GainName, StabilityError> {
        if self.model.has_bandwidth() {
            return Ok(GainName::CurrentBandwidth);
        }
        let poles = self.poles(self.alone(LoopName::Current))?;
        let [d, q] = self.equations.currents().map(|axis| axis.map_or(0.0, |axis| poles.largest_with(axis)));
        Ok(if d > q { GainName::CurrentD } else { GainName::CurrentQ })
    }

    const fn current_gain_name(&self) -> GainName {
        if self.model.has_bandwidth() { GainName::CurrentBandwidth } else { GainName::CurrentQ }
    }

    /// Value and unit of a gain.
    fn gain(&self, name: GainName) -> (f64, &'static str) {
        let p = &self.model.drive;
        let Stage::Current { params, .. } = &p.stage else {
            return self.outer_gain(name);
        };
        let (Dq { d, q }, inductance) = (params.gains.k_p, params.motor.inductance);
        match name {
            GainName::CurrentBandwidth => (q / inductance.q / TAU, "Hz"),
            GainName::CurrentD => (d, "V/A"),
            GainName::CurrentQ => (q, "V/A"),
            GainName::Position | GainName::Velocity => self.outer_gain(name),
        }
    }

    fn outer_gain(&self, name: GainName) -> (f64, &'static str) {
        let (p, (position, velocity)) = (&self.model.drive, self.scheduled.0);
        match (name, self.model.mechanics.coordinate()) {
            (GainName::Position, _) => (position * p.position_gain, "1/s"),
            (_, Coordinate::Rotary) => (velocity * p.velocity.k_p, "N·m·s/rad"),
            (_, Coordinate::Linear) => (velocity * p.velocity.k_p, "N·s/m"),
        }
    }

    fn speed_unit(&self) -> &'static str {
        match self.model.mechanics.coordinate() {
            Coordinate::Rotary => "rad/s",
            Coordinate::Linear => "m/s",
        }
    }

    fn report(
        &mut self,
        name: LoopName,
        is_unstable: bool,
        depth: Depth,
    ) -> Result<Option<LoopReport>, StabilityError> {
        let (gain_name, is_closed) = match name {
            LoopName::Position if !self.model.closes_position => return Ok(None),
            LoopName::Current if matches!(self.model.source, Source::Ideal { .. }) => return Ok(None),
            LoopName::Position => (GainName::Position, self.whole().position),
            LoopName::Velocity => (GainName::Velocity, self.whole().velocity),
            LoopName::Current => (self.current_gain_name(), true),
        };
        let (gain, unit) = self.gain(gain_name);
        let is_asked = is_closed && depth == Depth::Boundaries;
        let boundaries = is_asked.then(|| self.boundaries(self.whole(), gain_name, is_unstable)).transpose()?;
        let least_damped = if is_asked { self.least_damped(self.alone(name))? } else { None };
        let bandwidth = self.model.bandwidth(name);
        Ok(Some(LoopReport { name, gain_name, gain, unit, bandwidth, boundaries, least_damped }))
    }

    fn least_damped(&mut self, closed: Closed) -> Result<Option<Pole>, StabilityError> {
        let all = self.poles(closed)?;
        let poles = all
            .values
            .iter()
            // A pole at the origin is a delay.
            .filter(|(_, value)| value.im >= 0.0 && value.norm() > f64::EPSILON.sqrt())
            .map(|pole| all.in_seconds(&self.equations, &all.refined(*pole)));
        Ok(poles.min_by(|a, b| a.damping().total_cmp(&b.damping()).then(b.magnitude.total_cmp(&a.magnitude))))
    }
}
