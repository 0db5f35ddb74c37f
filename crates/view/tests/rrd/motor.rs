//! The page of the motor.
use crate::content::{assert_views_are_fed, written};
use crate::{example, options};
use servobench_base::{Coordinate, Dq};
use servobench_plant::pmsm::{Bounds, Params};
use servobench_view::{MotorLimits, ViewOptions};

const LIMITS: MotorLimits = MotorLimits {
    motor: Params {
        electrical_ratio: 130.0,
        resistance: 0.8,
        inductance: Dq { d: 7.5e-3, q: 7.5e-3 },
        flux_linkage: 0.566,
    },
    bounds: Bounds { current: 70.0, voltage: 323.0 },
    dc_link: 560.0,
    effort: f64::INFINITY,
    transmission: 1.0,
    motion: Coordinate::Linear,
};

#[test]
fn a_motor_is_shown_beside_what_it_can_give() {
    let content = written(&example(4), &ViewOptions { motor: Some(LIMITS), ..options() });
    for entity in [
        "/effort_over_speed/envelope",
        "/effort_over_speed/run",
        "/current_plane/limit",
        "/current_plane/run",
        "/effort_over_angle/run",
        "/effort_over_angle/numbers",
    ] {
        assert!(content.entities.contains(entity), "{entity} is missing in {:?}", content.entities);
    }
    let titles: Vec<&str> = content.views.values().map(|view| view.title.as_str()).collect();
    assert!(titles.contains(&"Force over speed"), "{titles:?}");
    // Voltages in d and q were not recorded.
    assert!(!content.entities.iter().any(|entity| entity.starts_with("/voltage_plane")));
    assert_views_are_fed(&content);
    assert!(!written(&example(4), &options()).entities.iter().any(|entity| entity.starts_with("/effort_over")));
}

/// Mounted the other way round it turns as far.
#[test]
fn a_motor_that_counts_against_the_axis_has_all_planes() {
    let reversed = MotorLimits { transmission: -1.0, ..LIMITS };
    let content = written(&example(3), &ViewOptions { motor: Some(reversed), ..options() });
    assert!(content.entities.contains("/effort_over_angle/run"), "{:?}", content.entities);
}
