//! Effects of a real motor beside the equations of [`pmsm`](super): each is switched on by itself.
use super::phases::{self, PhaseMatrix};
use super::saturated::Saturated;
use super::temperature::ThermalSteps;
use super::varying::Varying;
use super::winding::{Span, Sums, Winding};
use super::{Cogging, FluxHarmonic, FluxMap, IronLoss, Output, Params, State, Temperature, Temperatures, Ticks, iron};
use servobench_base::{Dq, ParamError, Stateful};

/// The effects of a motor. None is switched on by default.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Effects {
    /// Harmonics of the cogging.
    pub cogging: Vec<Cogging>,
    /// Harmonics of the flux linkage.
    pub flux_harmonics: Vec<FluxHarmonic>,
    /// Loss in the iron.
    pub iron: Option<IronLoss>,
    /// Resistances of the phases a, b and c relative to that of the motor.
    pub phase_resistance: Option<[f64; 3]>,
    /// Temperature of winding and magnets.
    pub temperature: Option<Temperature>,
    /// Flux linkage by the currents, if the iron saturates: in place of inductances and flux linkage.
    pub flux_map: Option<FluxMap>,
}

impl Effects {
    /// # Errors
    /// [`ParamError`] names the first parameter that is out of its bound.
    pub fn check(&self) -> Result<(), ParamError> {
        self.cogging.iter().try_for_each(Cogging::check)?;
        self.flux_harmonics.iter().try_for_each(FluxHarmonic::check)?;
        self.iron.iter().try_for_each(IronLoss::check)?;
        self.phase_resistance.iter().try_for_each(phases::check)?;
        self.temperature.iter().try_for_each(Temperature::check)
    }

    /// The motor with the data `p` at the initial temperatures.
    #[must_use]
    pub fn at_the_beginning(&self, p: &Params) -> Params {
        self.temperature.map_or(*p, |temperature| temperature.motor(p, temperature.start))
    }

    /// True if winding and housing warm up.
    #[must_use]
    pub fn warms_up(&self) -> bool {
        self.temperature.is_some_and(|temperature| temperature.network.is_some())
    }

    /// True if the equations change with the angle or the time.
    fn vary(&self) -> bool {
        !self.flux_harmonics.is_empty() || self.phase_resistance.is_some() || self.warms_up() || self.flux_map.is_some()
    }

    /// True if no effect acts in a tick.
    fn are_none(&self) -> bool {
        self.cogging.is_empty() && self.iron.is_none() && !self.vary()
    }
}

/// Motion of the rotor in a tick, in the coordinate of the motor.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Travel {
    /// Position at the beginning of the tick (rad or m).
    pub position: f64,
    /// Mean speed over the tick (rad/s or m/s).
    pub speed: f64,
}

/// A motor with effects, and their state.
///
/// ```text
/// effort   = air-gap effort of the currents + cogging − drag of the iron
/// air gap  = effort·speed        iron = drag·speed        stored = of the inductances − cogging·speed
/// electrical = copper + iron + stored + air gap
/// ```
/// The energy of the magnets goes into `stored`, so that the powers balance, whatever is switched on.
#[derive(Debug, Clone, Stateful)]
pub struct RealMotor {
    #[state(constant)]
    effects: Effects,
    /// The motor by its data sheet.
    #[state(constant)]
    params: Params,
    #[state(constant)]
    phases: PhaseMatrix,
    #[state(fixed)]
    warming: Option<Warming>,
    /// Length of a tick (s).
    #[state(constant)]
    h: f64,
}

/// State of two bodies that warm up.
#[derive(Debug, Clone, Stateful)]
struct Warming {
    #[state(constant)]
    model: Temperature,
    #[state(constant)]
    steps: ThermalSteps,
    now: Temperatures,
}

impl RealMotor {
    /// The motor with the data `params` and with `effects`, in ticks of `h` (s); `None` if no effect acts in a tick.
    #[must_use]
    pub fn new(params: &Params, effects: &Effects, h: f64) -> Option<Self> {
        if effects.are_none() {
            return None;
        }
        let network = effects.temperature.and_then(|model| model.network.map(|network| (model, network)));
        Some(Self {
            effects: effects.clone(),
            params: *params,
            phases: effects.phase_resistance.map_or(PhaseMatrix::EQUAL, PhaseMatrix::of),
            warming: network.map(|(model, network)| Warming {
                model,
                steps: ThermalSteps::new(&network, h),
                now: model.start,
            }),
            h,
        })
    }

    /// Temperatures at this tick; `None` without warming.
    #[must_use]
    pub fn temperatures(&self) -> Option<Temperatures> {
        self.warming.as_ref().map(|warming| warming.now)
    }

    /// The motor at this tick. `ticks` are those of the motor at the beginning.
    #[must_use]
    pub fn params(&self, ticks: &Ticks) -> Params {
        self.warming.as_ref().map_or(*ticks.params(), |warm| warm.model.motor(&self.params, warm.now))
    }

    /// True if the losses must be known, even if they are not recorded.
    #[must_use]
    pub const fn needs_losses(&self) -> bool {
        self.warming.is_some()
    }

    /// True if its inductances depend on the currents.
    #[must_use]
    pub const fn saturates(&self) -> bool {
        self.effects.flux_map.is_some()
    }

    /// The winding of the motor that is `params` at this tick, behind `series` (Ω); `None` if its equations are those of the ideal one.
    pub(crate) fn winding<'a>(&'a self, params: &'a Params, series: f64) -> Option<RealWinding<'a>> {
        let (harmonics, phases) = (&*self.effects.flux_harmonics, &self.phases);
        if let Some(map) = &self.effects.flux_map {
            let magnets = self.params.flux_linkage;
            return Some(RealWinding::Saturated(Saturated { params, map, magnets, harmonics, phases, series }));
        }
        self.effects.vary().then_some(RealWinding::Varying(Varying { params, harmonics, phases, series }))
    }

    /// Energy in the field at `current` (J), for the motor that is `params` at this tick.
    #[must_use]
    pub fn stored_energy(&self, params: &Params, current: Dq) -> f64 {
        self.effects
            .flux_map
            .as_ref()
            .map_or_else(|| params.stored_energy(current), |map| map.stored(Dq::default(), current))
    }

    /// Harmonics and phase resistances, for another kind of winding.
    pub(super) fn harmonics_and_phases(&self) -> (&[FluxHarmonic], PhaseMatrix) {
        (&self.effects.flux_harmonics, self.phases)
    }

    /// Effort on the rotor over a tick with the result of the `winding` in it, and the powers. The currents change from the first of `x` to
    /// the second.
    pub(crate) fn on_the_rotor(&mut self, p: &Params, winding: Output, x: [State; 2], travel: Travel) -> Output {
        let mut output = winding;
        let Travel { position, speed } = travel;
        let cogging: f64 = self.effects.cogging.iter().map(|one| one.mean_effort(position, speed * self.h)).sum();
        let flux = || iron::relative_flux(p, self.params.flux_linkage, self.effects.flux_map.as_ref(), x);
        let drag = self.effects.iron.map_or(0.0, |iron| iron.drag(speed, flux()));
        output.torque += cogging - drag;
        output.power.iron = drag * speed;
        output.power.air_gap += (cogging - drag) * speed;
        output.power.stored -= cogging * speed;
        if let Some(Warming { steps, now, .. }) = &mut self.warming {
            *now = steps.after(*now, output.power.copper, output.power.iron);
        }
        output
    }
}

/// A winding whose equations differ from those of the ideal one.
#[derive(Debug, Clone, Copy)]
pub(crate) enum RealWinding<'a> {
    /// Its inductances are constant.
    Varying(Varying<'a>),
    /// Its inductances depend on the currents.
    Saturated(Saturated<'a>),
}

impl Winding for RealWinding<'_> {
    fn advance<const POWER: bool>(&self, i: Dq, over: &Span, sums: &mut Sums) -> Dq {
        match self {
            Self::Varying(varying) => varying.advance::<POWER>(i, over, sums),
            Self::Saturated(saturated) => saturated.advance::<POWER>(i, over, sums),
        }
    }

    fn electrical_ratio(&self) -> f64 {
        match self {
            Self::Varying(varying) => varying.electrical_ratio(),
            Self::Saturated(saturated) => saturated.electrical_ratio(),
        }
    }

    fn stored(&self, before: Dq, after: Dq) -> f64 {
        match self {
            Self::Varying(varying) => varying.stored(before, after),
            Self::Saturated(saturated) => saturated.stored(before, after),
        }
    }
}

#[cfg(test)]
mod tests;
