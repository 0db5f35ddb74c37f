//! Power on and off, stops and faults.
use crate::axis::Axis;
use servobench_cia402::{Mode, PowerState};
use servobench_drive::Demand;
use servobench_drive::device::Params;

#[test]
fn an_axis_that_was_moved_is_held_where_it_is_when_it_is_enabled() {
    let mut axis = Axis::new(&Params::default());
    axis.position = 0.123;
    axis.enable(Mode::CyclicSynchronousPosition);
    assert_eq!(axis.state.power(), PowerState::OperationEnabled);
    assert_eq!(axis.actuals().mode, 8);
    assert_eq!(axis.actuals().position, 123_000);
    let Demand::Position { setpoint, .. } = axis.last else { panic!("{:?}", axis.last) };
    assert!((setpoint.x - 0.123).abs() < 1e-15 && setpoint.v.abs() < 1e-12, "{setpoint:?}");
}
