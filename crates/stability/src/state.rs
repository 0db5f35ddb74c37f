//! What a base tick of the linear loop leaves to the next one: deviations from the operating point.
//!
//! The states of a loop are as many of the fixed ones as its drive needs, and behind them what late sensors have under way.
use servobench_base::Dq;
use servobench_drive::filter;
use servobench_drive::measurement::observer;
use servobench_plant::Chain;

/// States of the mechanics: stretches and velocities of the longest chain.
pub(crate) const MECHANICS: usize = 2 * Chain::MAX_BODIES - 1;
/// Number of states of a loop without filters.
pub(crate) const STATES: usize = MECHANICS + 17;
/// Number of states with as many filters as there can be, two of each.
pub(crate) const FILTERED: usize = STATES + 2 * filter::MOST;
/// Number of states with all that a drive can have; those of parts that most drives have not come last.
pub(crate) const MOST_STATES: usize = FILTERED + 7;
/// First current of the motor.
pub(crate) const CURRENT: usize = MECHANICS + 2;
/// First state of the controllers; all behind it are.
pub(crate) const CONTROLLER: usize = MECHANICS + 5;

/// Deviations from the operating point.
#[derive(Debug, Clone, PartialEq, Default)]
pub(crate) struct State {
    /// Stretches of the links, then velocities of the bodies (axis coordinate, per tick).
    pub(crate) mechanics: [f64; MECHANICS],
    /// Position of the motor (axis coordinate). Only a position loop reads it, so that without one it is in no loop.
    pub(crate) position: f64,
    /// What the motor has travelled since the last velocity-loop cycle (motor coordinate): a difference of positions
    /// that does not depend on where the axis is.
    pub(crate) travelled: f64,
    /// Current of the motor (A).
    pub(crate) current: Dq,
    /// Speed of the motor a tick ago (motor coordinate), with which the power stage extrapolates.
    pub(crate) last_speed: f64,
    /// Output of the position loop (axis coordinate).
    pub(crate) velocity_reference: f64,
    /// Output of the velocity loop (motor coordinate).
    pub(crate) effort: f64,
    /// Integrator of the velocity loop (motor coordinate).
    pub(crate) velocity_integral: f64,
    /// Velocity behind the filter (motor coordinate).
    pub(crate) filtered_velocity: f64,
    /// Integrators of the current loop (V).
    pub(crate) current_integral: Dq,
    /// Voltage that goes out at the next current-loop cycle (V), in the rotor's frame of when it was computed.
    pub(crate) pending: Dq,
    /// What the motor has travelled since (motor coordinate).
    pub(crate) pending_travel: f64,
    /// Voltage that is out (V), in the rotor's frame of when it was computed.
    pub(crate) applied: Dq,
    /// What the motor has travelled since (motor coordinate).
    pub(crate) applied_travel: f64,
    /// Filters behind the velocity loop (motor coordinate).
    pub(crate) filters: filter::State,
    /// Integral of the position error (axis coordinate).
    pub(crate) position_integral: f64,
    /// Position that closes the loop at the last cycle of the position loop (axis coordinate).
    pub(crate) last_position: f64,
    /// Filtered rate of change of the position error (axis coordinate).
    pub(crate) position_rate: f64,
    /// Filtered acceleration (motor coordinate).
    pub(crate) acceleration: f64,
    /// The observer of the velocity (motor coordinate).
    pub(crate) observer: observer::State,
    /// What late sensors have under way ([`late`](crate::late)).
    pub(crate) late: Vec<f64>,
}

impl State {
    /// The fixed states in order.
    pub(crate) fn to_array(&self) -> [f64; MOST_STATES] {
        let mut array = [0.0; MOST_STATES];
        let (mechanics, others) = array.split_at_mut(MECHANICS);
        let (others, filters) = others.split_at_mut(STATES - MECHANICS);
        let (filters, parts) = filters.split_at_mut(FILTERED - STATES);
        parts.copy_from_slice(&[
            self.position_integral,
            self.last_position,
            self.position_rate,
            self.acceleration,
            self.observer.behind,
            self.observer.velocity,
            self.observer.disturbance,
        ]);
        filters.copy_from_slice(self.filters.memory.as_flattened());
        mechanics.copy_from_slice(&self.mechanics);
        others.copy_from_slice(&[
            self.position,
            self.travelled,
            self.current.d,
            self.current.q,
            self.last_speed,
            self.velocity_reference,
            self.effort,
            self.velocity_integral,
            self.filtered_velocity,
            self.current_integral.d,
            self.current_integral.q,
            self.pending.d,
            self.pending.q,
            self.pending_travel,
            self.applied.d,
            self.applied.q,
            self.applied_travel,
        ]);
        array
    }

    /// The state that is 1 in the entry `index` of all `fixed` and behind them `late` ones, and 0 elsewhere.
    pub(crate) fn unit(index: usize, fixed: usize, late: usize) -> Self {
        let mut state = if index < fixed { Self::fixed_unit(index) } else { Self::default() };
        state.late.resize(late, 0.0);
        if let Some(entry) = index.checked_sub(fixed).and_then(|index| state.late.get_mut(index)) {
            *entry = 1.0;
        }
        state
    }

    fn fixed_unit(index: usize) -> Self {
        let entry = |i: usize| if i == index { 1.0 } else { 0.0 };
        let other = |i: usize| entry(MECHANICS + i);
        let part = |i: usize| entry(FILTERED + i);
        Self {
            mechanics: std::array::from_fn(entry),
            position: other(0),
            travelled: other(1),
            current: Dq { d: other(2), q: other(3) },
            last_speed: other(4),
            velocity_reference: other(5),
            effort: other(6),
            velocity_integral: other(7),
            filtered_velocity: other(8),
            current_integral: Dq { d: other(9), q: other(10) },
            pending: Dq { d: other(11), q: other(12) },
            pending_travel: other(13),
            applied: Dq { d: other(14), q: other(15) },
            applied_travel: other(16),
            filters: filter::State { memory: std::array::from_fn(|i| [other(17 + 2 * i), other(18 + 2 * i)]) },
            position_integral: part(0),
            last_position: part(1),
            position_rate: part(2),
            acceleration: part(3),
            observer: observer::State { behind: part(4), velocity: part(5), disturbance: part(6) },
            late: Vec::new(),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_unit_state_is_one_in_its_own_entry_alone() {
        for index in 0..MOST_STATES {
            let array = State::unit(index, MOST_STATES, 3).to_array();
            assert!(
                array.iter().enumerate().all(|(i, entry)| entry.to_bits() == f64::from(u8::from(i == index)).to_bits())
            );
        }
        let late = State::unit(STATES + 1, STATES, 3);
        assert_eq!((late.to_array(), late.late), ([0.0; MOST_STATES], vec![0.0, 1.0, 0.0]));
    }

    /// Speed and current of the plant are not the controllers', everything that a loop puts out is.
    #[test]
    fn the_controllers_states_come_last() {
        let speed = State { last_speed: 1.0, ..State::default() }.to_array();
        let reference = State { velocity_reference: 1.0, ..State::default() }.to_array();
        assert_eq!(
            (speed[CONTROLLER - 1].to_bits(), reference[CONTROLLER].to_bits()),
            (1.0_f64.to_bits(), 1.0_f64.to_bits())
        );
        let current = State { current: Dq { d: 1.0, q: 2.0 }, position: 3.0, ..State::default() }.to_array();
        assert_eq!(
            [current[CURRENT], current[CURRENT + 1], current[MECHANICS]].map(f64::to_bits),
            [1.0, 2.0, 3.0].map(f64::to_bits)
        );
    }
}
