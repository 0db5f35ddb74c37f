//! The tick of a motor with effects, behind a cable with faults, or on an inverter or a link that is not ideal.
//!
//! ```text
//! cable (mirror image of the request, a phase that opens) → inverter (averaged: one voltage; switching: one from edge to edge)
//! → winding (currents, torque, losses) → rotor (cogging, drag of the iron, temperature)
//! → link (supplies the power of motor and devices)
//! ```
use super::Synchronous;
use crate::inverter::{self, Averaged, Bridge, LinkParams, LinkPower, LinkState, Modulation, Ripple, Switching};
use crate::pmsm::{self, Winding as _};
use servobench_base::{AlphaBeta, Dq, ElectricalAngle, ParamError, Stateful};
use std::sync::Arc;

/// Largest turn of the rotor in a tick (rad, electrical). Beyond it the rotor has diverged, and its windings, which are followed in
/// parts of a turn, would take longer for each tick the faster it gets: its effort is NaN, which ends the run.
const MOST_TURN: f64 = 1024.0;

/// An inverter on its link, and its results of the last tick.
#[derive(Debug, Clone, Stateful)]
#[state(fixed)]
pub(super) struct RealInverter {
    modulator: Modulator,
    #[state(fixed)]
    link: Option<Link>,
    /// Mean loss of the devices over the tick (W).
    loss: f64,
    /// Mean powers of the link over the tick (W).
    link_power: LinkPower,
    /// The current between the ends of the tick.
    ripple: Ripple,
}

/// A link at work.
#[derive(Debug, Clone, Stateful)]
struct Link {
    #[state(constant)]
    params: LinkParams,
    state: LinkState,
}

#[derive(Debug, Clone, Stateful)]
#[state(fixed)]
enum Modulator {
    Averaged(#[state(constant)] Arc<Averaged>),
    Switching(#[state(constant)] Arc<Switching>, Bridge),
}

impl RealInverter {
    /// An inverter for `motor`, in ticks of `h` (s); `None` if it would act as an ideal one.
    ///
    /// # Errors
    /// [`ParamError`] names the parameter that is out of its bound.
    pub(super) fn new(
        inverter: &inverter::Params,
        link: Option<&LinkParams>,
        motor: &pmsm::Params,
        h: f64,
    ) -> Result<Option<Self>, ParamError> {
        inverter.check()?;
        link.map_or(Ok(()), LinkParams::check)?;
        let modulator = match inverter.modulation {
            Modulation::Averaged => Modulator::Averaged(Arc::new(Averaged::new(inverter, motor, h))),
            Modulation::Switching => {
                Modulator::Switching(Arc::new(Switching::new(inverter, motor, h)?), Bridge::default())
            }
        };
        let is_real = !inverter.is_ideal() || link.is_some();
        let link = link.map(|params| Link { params: *params, state: params.at_first() });
        let (link_power, ripple) = (LinkPower::default(), Ripple::default());
        Ok(is_real.then_some(Self { modulator, link, loss: 0.0, link_power, ripple }))
    }

    pub(super) const fn loss(&self) -> f64 {
        self.loss
    }

    pub(super) const fn link_power(&self) -> LinkPower {
        self.link_power
    }

    pub(super) const fn ripple(&self) -> Ripple {
        self.ripple
    }

    pub(super) const fn has_link(&self) -> bool {
        self.link.is_some()
    }

    /// Voltage of the link without load (V).
    pub(super) fn link_voltage(&self) -> Option<f64> {
        self.link.as_ref().map(|link| link.params.voltage)
    }

    /// Supplies `power` (W) of the motor, and that of the devices, from the link over a tick of `h` (s). Returns the new voltage,
    /// if it changes.
    fn supply(&mut self, power: f64, h: f64) -> Option<f64> {
        let Link { params, state } = self.link.as_mut()?;
        self.link_power = params.step(state, power + self.loss, h);
        Some(state.voltage)
    }
}

impl Modulator {
    fn is_ideal(&self) -> bool {
        matches!(self, Self::Averaged(averaged) if averaged.is_ideal())
    }

    /// Resistance of the devices before each phase (Ω).
    fn resistance(&self) -> f64 {
        match self {
            Self::Averaged(averaged) => averaged.resistance(),
            Self::Switching(switching, _) => switching.resistance(),
        }
    }

    /// The winding of a motor without effects, behind that resistance.
    fn equations(&self) -> pmsm::Equations {
        match self {
            Self::Averaged(averaged) => *averaged.equations(),
            Self::Switching(switching, _) => *switching.equations(),
        }
    }

    fn step<const POWER: bool, W: pmsm::Winding>(
        &mut self,
        winding: &W,
        current: &mut Dq,
        input: &inverter::Input,
    ) -> inverter::Tick {
        match self {
            Self::Averaged(averaged) => averaged.step::<POWER, W>(winding, current, input),
            Self::Switching(switching, bridge) => switching.step::<POWER, W>(winding, bridge, current, input),
        }
    }
}

/// The winding in a tick: with effects, or without.
struct Winding<'a> {
    ticks: &'a pmsm::Ticks,
    real: Option<&'a pmsm::RealMotor>,
    /// Parameters at this tick.
    params: &'a pmsm::Params,
    /// Direction of the only current that flows, if a phase is lost.
    line: Option<AlphaBeta>,
    h: f64,
}

/// Results of winding and inverter in a tick.
struct Driven {
    output: pmsm::Output,
    /// Voltage in the frame of the rotor in the middle of the tick (V).
    voltage: Dq,
    shortens: bool,
    /// Loss of the devices (W).
    loss: f64,
    ripple: Ripple,
}

impl Winding<'_> {
    /// Advances on a voltage that is held over the tick.
    fn step(&self, x: &mut pmsm::State, input: &pmsm::Input) -> pmsm::Output {
        if let Some(open) = self.with_open_phase(0.0) {
            return open.step(x, input, self.h);
        }
        if let Some(varying) = self.real.and_then(|real| real.winding(self.params, 0.0)) {
            return varying.step(x, input, self.h);
        }
        let mut power = pmsm::Power::default();
        let torque = self.ticks.step_with_power(x, input, &mut power);
        pmsm::Output { torque, power }
    }

    /// The winding behind `series` (Ω); `None` without a lost phase.
    fn with_open_phase(&self, series: f64) -> Option<pmsm::OpenPhase<'_>> {
        self.line.map(|line| pmsm::OpenPhase::new(self.params, self.real, series, line))
    }

    fn on_ideal(&self, x: &mut pmsm::State, wanted: AlphaBeta, u_dc: f64, input: pmsm::Input) -> Driven {
        let input = pmsm::Input { voltage: inverter::output(wanted, u_dc), ..input };
        let voltage = input.voltage_at_middle(self.h);
        Driven {
            output: self.step(x, &input),
            voltage,
            shortens: inverter::falls_short(input.voltage, wanted),
            loss: 0.0,
            ripple: Ripple::default(),
        }
    }

    fn on_real<const POWER: bool>(&self, on: &mut Modulator, x: &mut pmsm::State, input: &inverter::Input) -> Driven {
        let series = on.resistance();
        let winding = self.real.and_then(|real| real.winding(self.params, series));
        let tick = match (self.with_open_phase(series), winding) {
            (Some(open), _) => on.step::<POWER, _>(&open, &mut x.current, input),
            (None, Some(winding)) => on.step::<POWER, _>(&winding, &mut x.current, input),
            (None, None) => on.step::<POWER, _>(&on.equations(), &mut x.current, input),
        };
        Driven {
            output: pmsm::Output { torque: tick.torque, power: tick.power },
            voltage: tick.voltage.to_dq(input.rotor.ahead(input.omega_e * self.h / 2.0)),
            shortens: tick.shortened,
            loss: tick.loss,
            ripple: tick.ripple,
        }
    }
}

impl Synchronous {
    /// Current measured by sensors at the legs, with the rotor at `angle`.
    #[cold]
    pub(super) fn measured_at_the_legs(&mut self, angle: ElectricalAngle) -> AlphaBeta {
        let rotor = self.rotor.rotation();
        let Some(cable) = &self.cable else { return self.state.current.to_alpha_beta(rotor) };
        self.state.current = cable.settled(self.state.current, rotor);
        let (current, angle, rotor) = cable.at_the_legs(self.state.current, angle, rotor);
        match &mut self.sensor {
            None => current.to_alpha_beta(rotor),
            Some(sensor) => sensor.read(current, angle, rotor),
        }
    }

    /// [`Synchronous::advance`] with effects, behind a cable, or on an inverter or a link that is not ideal.
    #[cold]
    pub(super) fn advance_real(&mut self, wanted: AlphaBeta, travel: pmsm::Travel, h: f64) -> f64 {
        let params = self.effects.as_ref().map_or(*self.motor.params(), |real| real.params(&self.motor));
        let (rotor, omega_e) = (self.rotor.rotation(), params.electrical_ratio * travel.speed);
        // A not-a-number turn is refused, too.
        if !(-MOST_TURN..=MOST_TURN).contains(&(omega_e * h)) {
            return f64::NAN;
        }
        let (before, u_dc, x) = (self.state, self.u_dc, &mut self.state);
        let (mut wanted, mut line, mut arc) = (wanted, None, 0.0);
        if let Some(cable) = &mut self.cable {
            wanted = cable.across(wanted);
            arc = cable.begin(&params, &mut x.current, rotor, h) / h;
            line = cable.line();
        }
        let winding = Winding { ticks: &self.motor, real: self.effects.as_deref(), params: &params, line, h };
        let mut driven = match self.inverter.as_mut().map(|inverter| &mut inverter.modulator) {
            Some(modulator) if !modulator.is_ideal() => {
                let input = inverter::Input { wanted, u_dc, rotor, omega_e };
                let needs_losses = self.effects.as_ref().is_some_and(|real| real.needs_losses());
                if self.power.is_some() || needs_losses {
                    winding.on_real::<true>(modulator, x, &input)
                } else {
                    winding.on_real::<false>(modulator, x, &input)
                }
            }
            _ => winding.on_ideal(x, wanted, u_dc, pmsm::Input { voltage: wanted, rotor, omega_e }),
        };
        if arc > 0.0 {
            driven.output.power.copper += arc;
            driven.output.power.stored -= arc;
        }
        (self.voltage, self.shortens) = (driven.voltage, driven.shortens);
        self.account(&params, driven.output, before, travel, (driven.loss, driven.ripple), h).torque
    }

    /// Advances by a tick without power, in which the winding gives `output`.
    #[cold]
    pub(super) fn rest(&mut self, output: pmsm::Output, travel: pmsm::Travel, h: f64) -> pmsm::Output {
        if let Some(Modulator::Switching(switching, bridge)) = self.inverter.as_mut().map(|one| &mut one.modulator) {
            switching.rest(bridge);
        }
        let params = self.effects.as_ref().map_or(*self.motor.params(), |real| real.params(&self.motor));
        let before = self.state;
        self.state = pmsm::State::default();
        self.account(&params, output, before, travel, (0.0, Ripple::default()), h)
    }

    /// Adds the effects on the rotor beside the winding, and the supply by the link.
    fn account(
        &mut self,
        params: &pmsm::Params,
        winding: pmsm::Output,
        before: pmsm::State,
        travel: pmsm::Travel,
        (loss, ripple): (f64, Ripple),
        h: f64,
    ) -> pmsm::Output {
        let currents = [before, self.state];
        let output = self.effects.as_mut().map_or(winding, |real| real.on_the_rotor(params, winding, currents, travel));
        self.power = self.power.map(|_| output.power);
        if let Some(inverter) = &mut self.inverter {
            (inverter.loss, inverter.ripple) = (loss, ripple);
            self.u_dc = inverter.supply(output.power.electrical, h).unwrap_or(self.u_dc);
        }
        output
    }
}

#[cfg(test)]
mod tests;
