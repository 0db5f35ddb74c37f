//! Mass and inertia of geoms.
use super::{H, build, effort, world};
use std::f64::consts::PI;

/// What joint `m` of this kind has to move in this body: effort over acceleration.
fn inertia(kind: &str, axis: &str, body: &str) -> f64 {
    let xml = world(&format!(r#"<body><joint name="m" type="{kind}" axis="{axis}"/>{body}</body>"#));
    let mut axis = build(&xml, "m", H, vec![]);
    axis.advance(&effort(1.0)).unwrap();
    H / axis.bodies()[0].velocity
}

fn assert_close(found: f64, expected: f64, what: &str) {
    // A dozen roundings, and those of Rapier's inverse of the inertia.
    assert!((found / expected - 1.0).abs() < 1e-10, "{what}: {found} against {expected}");
}

/// Oracle: textbook inertias about the three axes, of 2 kg each.
#[test]
fn solids_have_their_textbook_inertia() {
    let (a, b, c) = (0.1_f64, 0.2_f64, 0.3_f64);
    let disc = 2.0 * (a * a / 4.0 + b * b / 3.0);
    // A capsule: a cylinder and two half balls, sharing 2 kg by volume.
    let (rod, ball) = (2.0 * PI * a * a * b, 4.0 / 3.0 * PI * a * a * a);
    let (rod, ball) = (2.0 * rod / (rod + ball), 2.0 * ball / (rod + ball));
    let across =
        rod * (a * a / 4.0 + b * b / 3.0) + ball * (0.4 * a * a - (0.375 * a).powi(2) + (b + 0.375 * a).powi(2));
    let along = rod * a * a / 2.0 + ball * 0.4 * a * a;
    for (geom, [x, y, z]) in [
        (r#"type="sphere" size="0.1""#, [0.8 * a * a; 3]),
        (r#"type="box" size="0.1 0.2 0.3""#, [b * b + c * c, a * a + c * c, a * a + b * b].map(|s| 2.0 / 3.0 * s)),
        (r#"type="ellipsoid" size="0.1 0.2 0.3""#, [b * b + c * c, a * a + c * c, a * a + b * b].map(|s| 0.4 * s)),
        (r#"type="cylinder" size="0.1 0.2""#, [disc, disc, a * a]),
        (r#"type="capsule" size="0.1 0.2""#, [across, across, along]),
    ] {
        let body = format!(r#"<geom {geom} mass="2"/>"#);
        for (axis, expected) in [("1 0 0", x), ("0 1 0", y), ("0 0 1", z)] {
            assert_close(inertia("hinge", axis, &body), expected, &format!("{geom} about {axis}"));
        }
        assert_close(inertia("slide", "1 2 3", &body), 2.0, geom);
    }
}

/// Oracle: volumes times density, which is that of water unless the geom says otherwise.
#[test]
fn density_is_that_of_water() {
    let (ball, rod) = (4.0 / 3.0 * PI * 1e-3, 2.0 * PI * 1e-2 * 0.2);
    for (geom, mass) in [
        (r#"size="0.1""#, 1e3 * ball),
        (r#"type="sphere" size="0.1" density="2700""#, 2.7e3 * ball),
        (r#"type="box" size="0.1 0.2 0.3""#, 1e3 * 0.048),
        (r#"type="ellipsoid" size="0.1 0.2 0.3""#, 1e3 * 4.0 / 3.0 * PI * 6e-3),
        (r#"type="cylinder" size="0.1 0.2""#, 1e3 * rod),
        (r#"type="capsule" size="0.1 0.2""#, 1e3 * (rod + ball)),
        (r#"type="capsule" size="0.1" fromto="0 0 0 0.4 0 0""#, 1e3 * (rod + ball)),
    ] {
        assert_close(inertia("slide", "0 0 1", &format!("<geom {geom}/>")), mass, geom);
    }
}

/// Oracle: the parallel axis theorem by hand, for two geoms turned and off the axis, and for a body welded on.
#[test]
fn geoms_and_welded_bodies_add_up() {
    // A rod of 3 kg, 0.4 m long, radius 0.1 m, lying along x at y = 0.5; a ball of 2 kg, radius 0.1 m, at x = -0.3.
    let rod = r#"<geom type="cylinder" size="0.1 0.2" mass="3" pos="0 0.5 0.7" euler="0 1.5707963267948966 0"/>"#;
    let ball = r#"<geom type="sphere" size="0.1" mass="2" pos="-0.3 0 -0.1"/>"#;
    let expected = 3.0 * (0.01 / 4.0 + 0.04 / 3.0 + 0.25) + 2.0 * (0.4 * 0.01 + 0.09);
    assert_close(inertia("hinge", "0 0 1", &format!("{rod}{ball}")), expected, "two geoms");
    assert_close(inertia("hinge", "0 0 1", &format!("{rod}<body>{ball}</body>")), expected, "a welded body");
    let turned =
        format!(r#"{rod}<body pos="0 0 1" euler="0 0 3.141592653589793">{}</body>"#, ball.replace("-0.3", "0.3"));
    assert_close(inertia("hinge", "0 0 1", &turned), expected, "a welded body, turned");
    assert_close(inertia("slide", "0 1 0", &turned), 5.0, "mass of both");
    // From end to end, the same rod.
    let ends = r#"<geom type="cylinder" size="0.1" mass="3" fromto="-0.2 0.5 0.7 0.2 0.5 0.7"/>"#;
    assert_close(inertia("hinge", "0 0 1", &format!("{ends}{ball}")), expected, "from end to end");
    // About the axis at x = -0.3 the ball has no arm.
    let xml = world(&format!(r#"<body><joint name="m" pos="-0.3 0 0" axis="0 0 1"/>{ball}</body>"#));
    let mut axis = build(&xml, "m", H, vec![]);
    axis.advance(&effort(1.0)).unwrap();
    assert_close(H / axis.bodies()[0].velocity, 2.0 * 0.4 * 0.01, "an axis off the origin");
}

/// Oracle: the inertia about the axis n is nᵀ·I·n.
#[test]
fn a_full_inertia_is_a_tensor() {
    let body = r#"<inertial pos="0 0 0" mass="1" fullinertia="0.05 0.06 0.07 0.01 -0.005 0.002"/>"#;
    assert_close(inertia("hinge", "1 0 0", body), 0.05, "Ixx");
    assert_close(inertia("hinge", "0 0 1", body), 0.07, "Izz");
    let skew = (0.05 + 0.06 + 0.07 + 2.0 * (0.01 - 0.005 + 0.002)) / 3.0;
    assert_close(inertia("hinge", "1 1 1", body), skew, "about (1, 1, 1)");
    let diagonal = r#"<inertial pos="0 0 0" mass="1" diaginertia="0.05 0.06 0.07" euler="0 0 0.5"/>"#;
    let turned = 0.05 * 0.5_f64.cos().powi(2) + 0.06 * 0.5_f64.sin().powi(2);
    assert_close(inertia("hinge", "1 0 0", diagonal), turned, "turned principal axes");
}

/// `<inertial>` wins over geoms, unless the file says to take the geoms.
#[test]
fn inertiafromgeom_is_obeyed() {
    let body = r#"<inertial pos="0 0 0" mass="7" diaginertia="1 1 1"/><geom size="0.1" mass="2"/>"#;
    assert_close(inertia("slide", "1 0 0", body), 7.0, "auto");
    let xml = world(&format!(r#"<body><joint name="m" type="slide" axis="1 0 0"/>{body}</body>"#));
    for (choice, mass) in [("true", 2.0), ("false", 7.0)] {
        let compiler = format!(r#"angle="radian" inertiafromgeom="{choice}""#);
        let mut axis = build(&xml.replace(r#"angle="radian""#, &compiler), "m", H, vec![]);
        axis.advance(&effort(1.0)).unwrap();
        assert_close(H / axis.bodies()[0].velocity, mass, choice);
    }
}
