//! What the loops show the supervision of motor and power stage, and the voltage limit of the link that it measures.
use super::{Closed, Sensors, State};
use crate::{Blocks, current, supervision};

/// Largest voltage amplitude (V): that of the estimated DC link, or of the measured one.
#[inline(always)]
pub(super) fn voltage_limit(p: &current::Params, blocks: &Blocks, sensors: &Sensors) -> f64 {
    if blocks.measures_dc_link { current::voltage_limit(sensors.dc_link) } else { p.max_voltage }
}

#[cold]
pub(super) fn motion(p: &supervision::Params, x: &mut State, sensors: &Sensors, h: f64) {
    if x.closed == Closed::None {
        x.supervision = supervision::State::default();
        return;
    }
    let is_cut = x.held.effort.cut.is_some();
    let input = supervision::Motion {
        velocity: x.filtered_velocity,
        dc_link: sensors.dc_link,
        winding: sensors.winding,
        is_cut,
    };
    supervision::watch_motion(p, &mut x.supervision, &input, h);
}

#[cold]
pub(super) fn currents(
    p: &supervision::Params,
    loops: &current::Params,
    x: &mut State,
    input: &current::Input,
    h: f64,
) {
    let currents = supervision::Currents {
        velocity: x.filtered_velocity,
        q: x.held.current.current.q,
        reference: input.reference.to_alpha_beta(input.rotor),
        bandwidth: loops.gains.k_p.q / loops.motor.inductance.q,
        measured: input.current,
    };
    supervision::watch_currents(p, &mut x.supervision, &currents, h);
}

impl State {
    /// What the supervision of motor and power stage has found since the power is on.
    #[must_use]
    pub const fn finding(&self) -> Option<supervision::Finding> {
        self.supervision.found
    }
}
