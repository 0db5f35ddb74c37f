//! Mass, centre of mass and inertia of a body, from its `<inertial>` or from its geoms, as in MuJoCo.
use super::refusal::MjcfRefusal;
use mjcf_rs::body::{Body, Geom, GeomType, InertiaSpec, Inertial};
use mjcf_rs::compiler::{Compiler, InertiaFromGeom};
use mjcf_rs::glam::{DMat3, DQuat, DVec3};
use nalgebra::{Matrix3, SymmetricEigen};
use rapier3d_f64::prelude::MassProperties;
use std::f64::consts::PI;

/// A mass with extent.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Lump {
    /// Mass (kg).
    mass: f64,
    /// Centre of mass in the body's frame (m).
    centre: DVec3,
    /// Inertia about the centre of mass, in the body's axes (kg·m²).
    inertia: DMat3,
}

/// Mass properties of `body`; all zero without `<inertial>` and geoms.
pub(crate) fn mass_properties(body: &Body, compiler: &Compiler) -> Result<MassProperties, MjcfRefusal> {
    let name = || body.name.clone().unwrap_or_else(|| "(without a name)".into());
    let from_geoms = match compiler.inertia_from_geom {
        InertiaFromGeom::True => true,
        InertiaFromGeom::False => false,
        InertiaFromGeom::Auto => body.inertial.is_none(),
    };
    let lump = match &body.inertial {
        Some(inertial) if !from_geoms => of_inertial(inertial),
        _ if from_geoms => body.geoms.iter().filter_map(|geom| of_geom(geom, compiler)).fold(NOTHING, join),
        _ => NOTHING,
    };
    let refusal = |what, bound| Err(MjcfRefusal::Mass { body: name(), what, bound });
    if !(lump.mass.is_finite() && lump.mass >= 0.0) {
        return refusal(format!("mass {}", lump.mass), "finite and not negative");
    }
    if !lump.inertia.is_finite() {
        return refusal("an inertia that is not finite".into(), "finite");
    }
    let (principal, axes) = principal_axes(lump.inertia);
    let (smallest, largest, sum) = (principal.min_element(), principal.max_element(), principal.element_sum());
    // Rounding of the decomposition.
    let slack = 1e-9 * largest.abs();
    let what = || format!("principal inertias {principal}");
    if smallest < -slack {
        return refusal(what(), "not negative");
    }
    if 2.0 * largest > sum + slack {
        return refusal(what(), "such that none exceeds the sum of the other two");
    }
    let principal = principal.max(DVec3::ZERO);
    Ok(MassProperties::with_principal_inertia_frame(lump.centre, lump.mass, principal, axes))
}

/// Principal inertias, and the rotation from their axes to the body's.
///
/// By nalgebra's QR iteration: Rapier's own closed form loses half the digits when two of the three are equal, as
/// for every shaft.
fn principal_axes(inertia: DMat3) -> (DVec3, DQuat) {
    if inertia == DMat3::from_diagonal(inertia.diagonal()) {
        return (inertia.diagonal(), DQuat::IDENTITY);
    }
    let SymmetricEigen { eigenvectors, eigenvalues } = Matrix3::from(inertia.to_cols_array_2d()).symmetric_eigen();
    let handed = if eigenvectors.determinant() < 0.0 { -eigenvectors } else { eigenvectors };
    let axes = DMat3::from_cols_array(&handed.as_slice().try_into().unwrap_or_default());
    (DVec3::from_slice(eigenvalues.as_slice()), DQuat::from_mat3(&axes).normalize())
}

const NOTHING: Lump = Lump { mass: 0.0, centre: DVec3::ZERO, inertia: DMat3::ZERO };

fn join(a: Lump, b: Lump) -> Lump {
    let mass = a.mass + b.mass;
    if mass == 0.0 {
        return a;
    }
    let centre = (a.mass * a.centre + b.mass * b.centre) / mass;
    let about = |lump: Lump| {
        let arm = lump.centre - centre;
        lump.inertia + lump.mass * (DMat3::from_diagonal(DVec3::splat(arm.length_squared())) - outer(arm))
    };
    Lump { mass, centre, inertia: about(a) + about(b) }
}

fn outer(v: DVec3) -> DMat3 {
    DMat3::from_cols(v * v.x, v * v.y, v * v.z)
}

/// `diagonal` in axes that are rotated by `rotation` against the body's.
fn turned(diagonal: DMat3, rotation: DQuat) -> DMat3 {
    let turn = DMat3::from_quat(rotation);
    turn * diagonal * turn.transpose()
}

fn of_inertial(inertial: &Inertial) -> Lump {
    let inertia = match inertial.inertia {
        InertiaSpec::Diagonal(diagonal) => DMat3::from_diagonal(DVec3::from_array(diagonal)),
        InertiaSpec::Full([xx, yy, zz, xy, xz, yz]) => {
            DMat3::from_cols(DVec3::new(xx, xy, xz), DVec3::new(xy, yy, yz), DVec3::new(xz, yz, zz))
        }
    };
    Lump { mass: inertial.mass, centre: inertial.pose.translation, inertia: turned(inertia, inertial.pose.rotation) }
}

/// A homogeneous solid; a plane has no mass.
fn of_geom(geom: &Geom, compiler: &Compiler) -> Option<Lump> {
    let (mut centre, mut rotation, [mut a, mut b, mut c]) = (geom.pose.translation, geom.pose.rotation, geom.size);
    if let Some([x1, y1, z1, x2, y2, z2]) = geom.fromto {
        // From end to end along z; the first size is the radius or the two half-widths.
        let (from, to) = (DVec3::new(x1, y1, z1), DVec3::new(x2, y2, z2));
        centre = (from + to) / 2.0;
        rotation = DQuat::from_rotation_arc(DVec3::Z, (to - from).normalize());
        let half = (to - from).length() / 2.0;
        match geom.type_ {
            GeomType::Box | GeomType::Ellipsoid => (b, c) = (a, half),
            _ => b = half,
        }
    }
    // Volume, and inertia per mass about each axis.
    let (volume, [xx, yy, zz]) = match geom.type_ {
        GeomType::Sphere => (4.0 / 3.0 * PI * a.powi(3), [0.4 * a * a; 3]),
        GeomType::Box => (8.0 * a * b * c, [b * b + c * c, a * a + c * c, a * a + b * b].map(|s| s / 3.0)),
        GeomType::Ellipsoid => {
            (4.0 / 3.0 * PI * a * b * c, [b * b + c * c, a * a + c * c, a * a + b * b].map(|s| s / 5.0))
        }
        GeomType::Cylinder => {
            let across = a * a / 4.0 + b * b / 3.0;
            (2.0 * PI * a * a * b, [across, across, a * a / 2.0])
        }
        GeomType::Capsule => {
            // A cylinder and two half spheres, whose centres of mass are 3/8 of the radius off their bases.
            let (cylinder, ball) = (2.0 * PI * a * a * b, 4.0 / 3.0 * PI * a.powi(3));
            let off = b + 3.0 / 8.0 * a;
            let across = cylinder * (a * a / 4.0 + b * b / 3.0) + ball * (83.0 / 320.0 * a * a + off * off);
            let along = cylinder * a * a / 2.0 + ball * 0.4 * a * a;
            let volume = cylinder + ball;
            (volume, [across / volume, across / volume, along / volume])
        }
        _ => return None,
    };
    a = geom.mass.unwrap_or_else(|| volume * geom.density.unwrap_or(compiler.inertia_density));
    let inertia = turned(DMat3::from_diagonal(a * DVec3::new(xx, yy, zz)), rotation);
    Some(Lump { mass: a, centre, inertia })
}
