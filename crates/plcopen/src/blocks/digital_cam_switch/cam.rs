//! State of one cam: true if its switch is on at the position of the axis.
use super::{CamDirection, CamEnd, CamSwitch, TrackOptions, ValueSource};
use crate::axis::Axis;
use crate::state::AxisState;
use servobench_base::Stateful;

/// State of a switch.
#[derive(Debug, Clone, Copy, PartialEq, Default, Stateful)]
pub struct CamState {
    is_on: bool,
    /// Edge at which the switch has switched, until the axis has left it by the hysteresis.
    held: Option<Edge>,
    /// Direction of the last motion, 1 or −1; 0 before it.
    direction: f64,
    /// Distance that the axis has come back since.
    back: f64,
    /// Cycles since FirstOnPosition was passed.
    cycles: Option<u64>,
}

/// Position of the axis in a cycle.
#[derive(Debug, Clone, Copy, PartialEq, Stateful)]
pub(super) struct Place {
    x: f64,
    v: f64,
    /// Origin of the positions: the program's offset, and true if the drive is about to set it.
    offset: f64,
    is_homing: bool,
}

impl Place {
    pub(super) fn of(axis: &Axis, source: ValueSource) -> Self {
        let (x, v) = match source {
            ValueSource::SetPoint => (axis.commanded().x, axis.commanded().v),
            ValueSource::Actual => (axis.actual().position, axis.actual().velocity),
        };
        Self { x, v, offset: axis.offset(), is_homing: axis.state() == AxisState::Homing }
    }

    /// True if the axis has moved from `before` to here, without a jump.
    pub(super) fn continues(&self, before: &Self) -> bool {
        let is_known = (self.x - before.x).is_finite() && self.v.is_finite() && before.v.is_finite();
        is_known && self.offset.to_bits() == before.offset.to_bits() && !self.is_homing && !before.is_homing
    }

    /// Tolerance for rounding in a distance to `edge`.
    fn rounding(&self, edge: f64, modulo: Option<f64>) -> f64 {
        1e-12 * (self.x.abs() + edge.abs() + modulo.unwrap_or(0.0))
    }
}

/// Shortest equivalent of `distance` on a modulo axis.
fn nearest(distance: f64, modulo: Option<f64>) -> f64 {
    modulo.map_or(distance, |period| distance - period * libm::round(distance / period))
}

/// An end of a window.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Stateful)]
enum Edge {
    /// FirstOnPosition.
    First,
    /// LastOnPosition.
    Last,
}

/// A switch with the options of its track, and the direction of the axis.
struct Cam<'a> {
    switch: &'a CamSwitch,
    options: TrackOptions,
    modulo: Option<f64>,
    /// 1 upwards, −1 downwards.
    direction: f64,
}

impl Cam<'_> {
    /// Edge at which the cam switches on; with a duration it is the same in both directions.
    fn on_edge(&self) -> Edge {
        if self.direction < 0.0 && matches!(self.switch.end, CamEnd::Position(_)) { Edge::Last } else { Edge::First }
    }

    /// Position of `edge` for an axis at `place`, shifted by the compensation.
    fn position(&self, edge: Edge, place: &Place) -> f64 {
        let position = match (edge, self.switch.end) {
            (Edge::Last, CamEnd::Position(last)) => last,
            _ => self.switch.first,
        };
        let is_on = edge == self.on_edge();
        position + place.v * if is_on { self.options.on_compensation } else { self.options.off_compensation }
    }

    /// Distance of the axis beyond `edge` in its direction.
    fn beyond(&self, edge: Edge, place: &Place) -> f64 {
        self.direction * nearest(place.x - self.position(edge, place), self.modulo)
    }

    /// True if the axis has passed `edge` since `before`.
    fn passes(&self, edge: Edge, before: &Place, place: &Place) -> bool {
        let rounding = place.rounding(self.position(edge, place), self.modulo);
        let (from, to) = (self.beyond(edge, before), self.beyond(edge, place));
        // A distance of half a period or more lies on the other side of the circle.
        let is_near = self.modulo.is_none_or(|period| to - from < 0.5 * period);
        from < -rounding && to >= -rounding && is_near
    }

    /// True if the axis is in the window, or has passed it.
    fn contains(&self, before: Option<&Place>, place: &Place) -> bool {
        let CamEnd::Position(last) = self.switch.end else { return false };
        let [on_edge, off_edge] =
            if self.direction < 0.0 { [Edge::Last, Edge::First] } else { [Edge::First, Edge::Last] };
        let TrackOptions { on_compensation, off_compensation, .. } = self.options;
        let uncompensated = match self.modulo {
            Some(period) if last < self.switch.first => last - self.switch.first + period,
            _ => last - self.switch.first,
        };
        let length = uncompensated + self.direction * place.v * (off_compensation - on_compensation);
        let rounding = place.rounding(self.position(on_edge, place), self.modulo);
        if length < -rounding {
            return false;
        }
        if before.is_some_and(|before| self.passes(on_edge, before, place)) {
            return true;
        }
        let beyond = self.beyond(on_edge, place);
        match self.modulo {
            // Position on the circle, counted from the edge.
            Some(period) => {
                let beyond = if beyond < -rounding { beyond + period } else { beyond };
                beyond <= length + rounding
            }
            None => beyond >= -rounding && self.beyond(off_edge, place) <= rounding,
        }
    }
}

impl CamState {
    /// State for an axis in this direction, 1 or −1, or 0 before the first motion.
    pub(super) const fn going(direction: f64) -> Self {
        Self { is_on: false, held: None, direction, back: 0.0, cycles: None }
    }

    /// Tracks the direction of an axis that has `moved`.
    fn turn(&mut self, moved: f64, hysteresis: f64) {
        if self.direction == 0.0 {
            self.back += moved;
            if self.back.abs() > hysteresis {
                (self.direction, self.back) = (self.back.signum(), 0.0);
            }
        } else {
            self.back = (self.back - self.direction * moved).max(0.0);
            if self.back > hysteresis {
                (self.direction, self.back) = (-self.direction, 0.0);
            }
        }
    }

    /// Advances by one cycle: returns true if the switch is TRUE.
    pub(super) fn step(
        &mut self,
        switch: &CamSwitch,
        options: TrackOptions,
        way: (Option<&Place>, &Place),
        axis: &Axis,
    ) -> bool {
        let (before, place) = way;
        let (modulo, cycle_time) = (axis.params().modulo, axis.params().cycle_time);
        self.turn(before.map_or(0.0, |before| nearest(place.x - before.x, modulo)), options.hysteresis);
        let direction = if self.direction < 0.0 { -1.0 } else { 1.0 };
        let cam = Cam { switch, options, modulo, direction };
        let is_near = |edge| cam.beyond(edge, place).abs() <= options.hysteresis;
        let was_held = self.held.is_some();
        self.held = self.held.filter(|edge| is_near(*edge));
        let is_for_direction = match switch.direction {
            CamDirection::Both => true,
            CamDirection::Positive => self.direction > 0.0,
            CamDirection::Negative => self.direction < 0.0,
        };
        if let CamEnd::Duration(duration) = switch.end {
            self.cycles = self.cycles.map(|cycles| cycles.saturating_add(1));
            let is_passed = before.is_some_and(|before| cam.passes(Edge::First, before, place));
            if is_passed && is_for_direction && !was_held {
                (self.cycles, self.held) = (Some(0), Some(Edge::First).filter(|edge| is_near(*edge)));
            }
            let length = duration + options.off_compensation - options.on_compensation;
            // Rounding does not add a cycle to a whole number of them.
            self.cycles = self.cycles.filter(|cycles| *cycles as f64 * cycle_time < length - 1e-9 * cycle_time);
            self.is_on = self.cycles.is_some();
        } else {
            let is_known = place.x.is_finite() && place.v.is_finite();
            let is_on = is_known && is_for_direction && cam.contains(before, place);
            if self.held.is_none() && is_on != self.is_on {
                self.is_on = is_on;
                self.held = [Edge::First, Edge::Last].into_iter().find(|edge| is_near(*edge));
            }
        }
        self.is_on
    }
}
