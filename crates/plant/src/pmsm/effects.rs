//! What a real motor does beside the equations of [`pmsm`](super): each effect is switched on by itself.
use super::phases::{self, PhaseMatrix};
use super::temperature::ThermalSteps;
use super::varying::Varying;
use super::{
    Cogging, FluxHarmonic, Input, IronLoss, Output, Params, Power, State, Temperature, Temperatures, Ticks, iron,
};
use servobench_base::ParamError;

/// The effects of a motor. None is switched on by default.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Effects {
    /// Harmonics of the cogging.
    pub cogging: Vec<Cogging>,
    /// Harmonics of the flux linkage.
    pub flux_harmonics: Vec<FluxHarmonic>,
    /// Loss in the iron.
    pub iron: Option<IronLoss>,
    /// Resistances of the phases a, b and c as parts of that of the motor.
    pub phase_resistance: Option<[f64; 3]>,
    /// Temperature of winding and magnets.
    pub temperature: Option<Temperature>,
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

    /// The motor with the data `p` at the temperatures of the beginning.
    #[must_use]
    pub fn at_the_beginning(&self, p: &Params) -> Params {
        self.temperature.map_or(*p, |temperature| temperature.motor(p, temperature.start))
    }

    /// Whether winding and housing warm up.
    #[must_use]
    pub fn warms_up(&self) -> bool {
        self.temperature.is_some_and(|temperature| temperature.network.is_some())
    }

    /// Whether the equations change with the angle or the time.
    fn vary(&self) -> bool {
        !self.flux_harmonics.is_empty() || self.phase_resistance.is_some() || self.warms_up()
    }

    /// Whether there is nothing to do in a tick.
    fn are_none(&self) -> bool {
        self.cogging.is_empty() && self.iron.is_none() && !self.vary()
    }
}

/// How the rotor goes through a tick, in the coordinate of the motor.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Travel {
    /// Position when the tick begins (rad or m).
    pub position: f64,
    /// Mean speed over the tick (rad/s or m/s).
    pub speed: f64,
}

/// Ticks of a motor with effects, and their state.
///
/// ```text
/// effort   = air-gap effort of the currents + cogging − drag of the iron
/// air gap  = effort·speed        iron = drag·speed        stored = of the inductances − cogging·speed
/// electrical = copper + iron + stored + air gap
/// ```
/// The energy of the magnets goes into `stored`, so that what goes in is what comes out, whatever is switched on.
#[derive(Debug, Clone)]
pub struct RealTicks {
    effects: Effects,
    /// The motor as its data sheet has it.
    params: Params,
    phases: PhaseMatrix,
    warming: Option<Warming>,
    /// Length of a tick (s).
    h: f64,
}

/// Two bodies under way.
#[derive(Debug, Clone)]
struct Warming {
    model: Temperature,
    steps: ThermalSteps,
    now: Temperatures,
}

impl RealTicks {
    /// Ticks of `h` (s) of the motor with the data `params` and with `effects`; `None` when there is nothing to do in a tick.
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

    /// Temperatures at this tick; `None` where nothing warms up.
    #[must_use]
    pub fn temperatures(&self) -> Option<Temperatures> {
        self.warming.as_ref().map(|warming| warming.now)
    }

    /// Advances the currents to tick k+1 and returns the mean effort over the tick with the powers. `ticks` are those of the motor at the
    /// beginning.
    #[cold]
    pub fn step(&mut self, ticks: &Ticks, x: &mut State, u: &Input, travel: Travel) -> Output {
        let before = *x;
        let params = self.warming.as_ref().map_or(*ticks.params(), |warm| warm.model.motor(&self.params, warm.now));
        let output = if self.effects.vary() {
            let harmonics = &self.effects.flux_harmonics;
            Varying { params: &params, harmonics, phases: &self.phases }.step(x, u, self.h)
        } else {
            let mut power = Power::default();
            let torque = ticks.step_with_power(x, u, &mut power);
            Output { torque, power }
        };
        self.on_the_rotor(&params, output, [before, *x], travel)
    }

    /// What acts on the rotor over a tick in which the currents go from `x` to zero; the inductances give back `returned` (W).
    #[cold]
    pub fn step_to_no_current(&mut self, ticks: &Ticks, x: State, returned: f64, travel: Travel) -> Output {
        let params = self.warming.as_ref().map_or(*ticks.params(), |warm| warm.model.motor(&self.params, warm.now));
        let power = Power { electrical: returned, stored: returned, ..Power::default() };
        self.on_the_rotor(&params, Output { torque: 0.0, power }, [x, State::default()], travel)
    }

    fn on_the_rotor(&mut self, p: &Params, mut output: Output, x: [State; 2], travel: Travel) -> Output {
        let Travel { position, speed } = travel;
        let cogging: f64 = self.effects.cogging.iter().map(|one| one.mean_effort(position, speed * self.h)).sum();
        let flux = || iron::relative_flux(p, self.params.flux_linkage, x);
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

#[cfg(test)]
mod tests;
