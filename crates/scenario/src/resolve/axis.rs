//! `[axis]` to bodies: transmission, rigid couplings merged, the rotor added.
use crate::access::Refused;
use crate::diagnostic::Report;
use crate::field::{Reported, Slot};
use crate::file;
use crate::file::MotorKind;
use crate::mjcf_files;
use crate::models::read_beside;
use crate::quantity::objection;
use crate::resolve::fmu::Mechanics;
use crate::resolve::{Alternative, end_stops, friction, need, one_of};
use crate::scenario::{Axis, AxisMechanics};
use crate::source::{At, Sources, Span};
use servobench_base::{AxisName, Coordinate};
use servobench_files::FileRole;
use servobench_plant::{Body, Chain, Friction, Link, MjcfModel, Switches};
use std::f64::consts::TAU;

/// Inertia of a motor body that follows a prescribed motion: it has no effect, but engines require one.
const PRESCRIBED_INERTIA: f64 = 1.0;

pub(super) fn resolve(
    axis: &file::Axis,
    motor: &file::Motor,
    fmu: Option<Mechanics>,
    sources: &Sources,
    report: &mut Report,
) -> Option<Axis> {
    let motion = need(&axis.motion, "axis", "motion", axis.span, report);
    let motor_motion = report.motor?;
    let transmission = transmission(axis, motion?, motor, motor_motion, report);
    let mechanics = match axis.mjcf.given() {
        Some(mjcf) => {
            no_bodies_besides(axis, report);
            if let Some(span) = motor.inertia.span().or(motor.mass.span()) {
                report.warning(
                    span,
                    "the rotor's inertia is not used",
                    "the MJCF file holds it, as `armature` for example",
                );
            }
            mjcf_file(mjcf, transmission.unwrap_or(1.0), sources, report).map(AxisMechanics::Mjcf)
        }
        None if axis.mjcf.span().is_some() => None,
        None if fmu.is_some() && !has_bodies(axis) => Some(AxisMechanics::InTheFmu),
        None => bodies(axis, motor, motor_motion, transmission, report).map(AxisMechanics::Bodies),
    };
    let name = axis.name.optional().ok().map(Option::<&AxisName>::copied);
    let switches = switches(axis, motor_motion, report);
    let modulo = axis.modulo.optional().ok().map(Option::<&f64>::copied);
    let end_stops = end_stops::resolve(axis, report);
    let (motion, transmission) = (motion?, transmission?);
    let fmu = match fmu {
        Some(fmu) => Some(fmu.model([motor_motion, motion], transmission)?),
        None => None,
    };
    Some(Axis {
        name: name?,
        motion,
        motor_motion,
        transmission,
        mechanics: mechanics?,
        fmu,
        switches: switches?,
        end_stops: end_stops.ok()?,
        modulo: modulo?,
    })
}

/// Coordinate of the motor: from its own keys, or otherwise that required by the axis. A linear axis without a lead has a linear motor.
pub(crate) fn motor_motion(axis: Coordinate, has_lead: bool, own: Option<Coordinate>) -> Coordinate {
    own.unwrap_or(if axis == Coordinate::Linear && !has_lead { Coordinate::Linear } else { Coordinate::Rotary })
}

/// Axis coordinate per motor coordinate.
fn transmission(
    axis: &file::Axis,
    motion: Coordinate,
    motor: &file::Motor,
    motor_motion: Coordinate,
    report: &mut Report,
) -> Option<f64> {
    let gear = axis.gear_ratio.optional().ok().map(|ratio| ratio.copied().unwrap_or(1.0));
    match (motion, motor_motion) {
        (Coordinate::Rotary, Coordinate::Rotary) => {
            if let Some(span) = axis.lead.span() {
                report.error(span, "a rotary axis has no `lead`", "give `gear_ratio`");
            }
            Some(1.0 / gear?)
        }
        (Coordinate::Rotary, Coordinate::Linear) => {
            let span = motor.pole_pitch.span().unwrap_or(motor.span);
            report.error(span, "a linear motor cannot turn a rotary axis", "a motor that turns has `pole_pairs`");
            None
        }
        (Coordinate::Linear, Coordinate::Rotary) => {
            if matches!(axis.lead, Slot::Absent) {
                let help =
                    "give the travel per revolution of the motor; a linear motor has `pole_pitch`, no `pole_pairs`";
                report.missing_with_help("axis", "lead", axis.span, help);
            }
            Some(axis.lead.given()? / TAU / gear?)
        }
        (Coordinate::Linear, Coordinate::Linear) => {
            if let Some(span) = axis.lead.span() {
                report.error(
                    span,
                    "a linear motor has no `lead`",
                    "a motor that turns has `pole_pairs`, no `pole_pitch`",
                );
            }
            if let Some(span) = axis.gear_ratio.span() {
                report.error(
                    span,
                    "a linear motor has no `gear_ratio`",
                    "a motor that turns a screw or pinion has a `lead`",
                );
            }
            Some(1.0)
        }
    }
}

fn switches(axis: &file::Axis, motor_motion: Coordinate, report: &mut Report) -> Option<Switches> {
    let turns = motor_motion == Coordinate::Rotary;
    let Some(given) = axis.switches.optional().ok()? else {
        return Some(Switches { index: turns.then_some(0.0), ..Switches::default() });
    };
    let ends = [&given.negative, &given.positive].map(|slot| slot.optional().map(Option::<&f64>::copied));
    if let (Some(negative), Some(positive)) = (given.negative.at(), given.positive.at())
        && negative.value >= positive.value
    {
        report.error(positive.span, "the positive end is not above the negative one", "swap them");
    }
    let home = given.home.optional().ok()?;
    if let Some(home) = home
        && let (Some(from), Some(to)) = (home.from.at(), home.to.at())
        && from.value >= to.value
    {
        report.error(to.span, "the home switch ends at or below where it begins", "swap `from` and `to`");
    }
    let home = match home {
        Some(home) => Some(*home.from.given()?..=*home.to.given()?),
        None => None,
    };
    if let (false, Some(span)) = (turns, given.index.span()) {
        report.error(span, "a linear motor has no index pulse", "a home switch is where homing can end");
    }
    // Just below a full revolution, rounding yields a full one, which is zero.
    let index = given.index.optional().ok()?.copied().unwrap_or(0.0).rem_euclid(TAU) % TAU;
    let [negative, positive] = ends;
    let (negative, positive, index) = (negative.ok()?, positive.ok()?, turns.then_some(index));
    Some(Switches { negative, positive, home, index, normally_closed: false })
}

fn has_bodies(axis: &file::Axis) -> bool {
    [axis.motor_side.span(), axis.table.span(), axis.load.span()].iter().any(Option::is_some)
}

fn no_bodies_besides(axis: &file::Axis, report: &mut Report) {
    for (key, span) in
        [("motor_side", axis.motor_side.span()), ("table", axis.table.span()), ("load", axis.load.span())]
    {
        if let Some(span) = span {
            report.error(span, format!("`{key}` and `mjcf` cannot be together"), "the MJCF file holds all bodies");
        }
    }
}

/// The file as passed to engines, for an axis of this transmission.
fn mjcf_file(mjcf: &file::Mjcf, transmission: f64, sources: &Sources, report: &mut Report) -> Option<MjcfModel> {
    let file = mjcf.file.at()?;
    let Some(place) = sources.place(file.span.source) else {
        report.error(file.span, "a scenario without a folder cannot name files", "");
        return None;
    };
    let read = read_beside(&file.value, FileRole::Mjcf, place, &mut report.files);
    let looked_through = read.and_then(|(path, xml)| {
        mjcf_files::look_through(&path, &xml, &mut report.files)?;
        Ok((path, xml))
    });
    let (path, xml) = match looked_through {
        Ok((path, xml)) => (path, xml.to_string()),
        Err(Refused { message, help }) => {
            report.error(file.span, message, help);
            return None;
        }
    };
    let text = |slot: &Slot<String>| slot.given().cloned();
    let (motor_joint, load_joint) = (text(&mjcf.motor_joint)?, text(&mjcf.load_joint)?);
    let actuator = text(&mjcf.actuator)?;
    Some(MjcfModel { xml, path, motor_joint, load_joint, actuator, transmission, axis: None, is_smooth: false })
}

/// A body of the chain, and its coupling to the one before it.
struct Placed {
    body: Body,
    link: Option<Link>,
    /// Place of its friction, or else of the body.
    span: Span,
}

fn bodies(
    axis: &file::Axis,
    motor: &file::Motor,
    motor_motion: Coordinate,
    transmission: Option<f64>,
    report: &mut Report,
) -> Option<Chain> {
    let first = motor_side(axis, motor, motor_motion, transmission.unwrap_or(1.0), report);
    let others: Vec<_> = [("table", &axis.table), ("load", &axis.load)]
        .into_iter()
        .filter(|(_, slot)| slot.span().is_some())
        .map(|(name, slot)| slot.given().and_then(|body| self::body(name, body, axis.motion.given().copied(), report)))
        .collect();
    let (mut chain, mut links) = (vec![first?], Vec::new());
    for other in others {
        let Placed { body, link, span } = other?;
        let Some(last) = chain.last_mut() else { continue };
        if let Some(link) = link {
            chain.push(body);
            links.push(link);
        } else if last.name == "motor" {
            merge(last, &body, transmission?, span, report);
        } else {
            merge(last, &body, 1.0, span, report);
            last.name = body.name;
        }
    }
    if let Some(motor_body) = chain.first_mut().filter(|body| body.inertia == 0.0) {
        if motor.kind.given() != Some(&MotorKind::Prescribed) {
            let key = if motor_motion == Coordinate::Rotary { "inertia" } else { "mass" };
            let help = format!("give `{key}` in `[axis.motor_side]` or in `[motor]`");
            if !report.without_model.contains(&"motor") {
                report.lacking("axis", axis.span, "nothing moves with the motor", help);
            }
            return None;
        }
        motor_body.inertia = PRESCRIBED_INERTIA;
    }
    // Every value is within its bound by now.
    Chain::new(chain, links).ok()
}

/// The motor's body in its own coordinate, rotor included; its inertia is zero if none is given.
fn motor_side(
    axis: &file::Axis,
    motor: &file::Motor,
    coordinate: Coordinate,
    transmission: f64,
    report: &mut Report,
) -> Option<Body> {
    let rotor = inertia(&motor.mass, &motor.inertia, coordinate, "motor", report);
    let free = |inertia| Body { transmission, ..free("motor", coordinate, inertia) };
    let Some(side) = axis.motor_side.given() else {
        return match axis.motor_side {
            Slot::Wrong(_) => None,
            _ => Some(free(rotor?)),
        };
    };
    let own = inertia(&side.mass, &side.inertia, coordinate, "motor", report);
    let friction = friction::resolve(&side.friction(), coordinate, report);
    let (bias, friction) = (or_zero(&side.bias)?, friction?);
    Some(Body { friction, bias, ..free(rotor? + own?) })
}

fn body(name: &'static str, body: &file::Body, motion: Option<Coordinate>, report: &mut Report) -> Option<Placed> {
    let inertia = motion.and_then(|motion| inertia(&body.mass, &body.inertia, motion, "axis", report));
    if inertia == Some(0.0) {
        let key = if motion == Some(Coordinate::Rotary) { "inertia" } else { "mass" };
        report.missing(&format!("axis.{name}"), key, body.span);
        return None;
    }
    let friction = motion.and_then(|motion| friction::resolve(&body.friction(), motion, report));
    let link = coupling(body, inertia, report);
    let (bias, friction) = (or_zero(&body.bias)?, friction?);
    let span = body.breakaway.at().map_or(body.span, |at| at.span);
    Some(Placed { body: Body { friction, bias, ..free(name, motion?, inertia?) }, link: link.ok()?, span })
}

/// Coupling of a body to the one before it, from its own keys or from the mode in which it oscillates on that body; `None`: rigid.
fn coupling(body: &file::Body, inertia: Option<f64>, report: &mut Report) -> Result<Option<Link>, Reported> {
    let stiffness = one_of(&[("stiffness", body.stiffness.span()), ("frequency", body.frequency.span())], report);
    let damping = one_of(&[("damping", body.damping.span()), ("damping_ratio", body.damping_ratio.span())], report);
    let stiffness = match stiffness {
        Alternative::Contradiction => return Err(Reported),
        Alternative::None => {
            let of_damping = [("damping", body.damping.span()), ("damping_ratio", body.damping_ratio.span())];
            let Some((key, span)) = of_damping.into_iter().find_map(|(key, span)| Some((key, span?))) else {
                return Ok(None);
            };
            let message = format!("`{key}` belongs to a coupling that has no `stiffness`");
            report.error(span, message, "without one the coupling is rigid");
            return Err(Reported);
        }
        Alternative::Use(0) => *body.stiffness.given().ok_or(Reported)?,
        Alternative::Use(_) => {
            let At { value: frequency, span } = body.frequency.at().ok_or(Reported)?;
            let stiffness = inertia.ok_or(Reported)? * (TAU * frequency) * (TAU * frequency);
            derived("stiffness", stiffness, *span, report)?
        }
    };
    let damping = match damping {
        Alternative::Contradiction => return Err(Reported),
        Alternative::None => 0.0,
        Alternative::Use(0) => *body.damping.given().ok_or(Reported)?,
        Alternative::Use(_) => {
            let At { value: ratio, span } = body.damping_ratio.at().ok_or(Reported)?;
            let damping = 2.0 * ratio * stiffness.sqrt() * inertia.ok_or(Reported)?.sqrt();
            derived("damping", damping, *span, report)?
        }
    };
    Ok(Some(Link { stiffness, damping }))
}

/// A derived value, if its magnitude is one that a key could have.
fn derived(what: &str, value: f64, span: Span, report: &mut Report) -> Result<f64, Reported> {
    let Some(objection) = objection(value, value == 0.0) else { return Ok(value) };
    report.error(span, format!("the {what} that follows from it: {objection}"), "correct its unit");
    Err(Reported)
}

/// A body without friction, in the axis coordinate.
const fn free(name: &'static str, coordinate: Coordinate, inertia: f64) -> Body {
    Body { name, coordinate, inertia, transmission: 1.0, friction: Friction::NONE, bias: 0.0 }
}

/// Value of a key that defaults to zero.
pub(super) fn or_zero(slot: &Slot<f64>) -> Option<f64> {
    slot.optional().ok().map(|value| value.copied().unwrap_or_default())
}

/// Mass or moment of inertia, as fits the coordinate; 0 if none is given.
fn inertia(mass: &Slot<f64>, inertia: &Slot<f64>, motion: Coordinate, of: &str, report: &mut Report) -> Option<f64> {
    let (fitting, other, right, wrong) = match motion {
        Coordinate::Linear => (mass, inertia, "mass", "inertia"),
        Coordinate::Rotary => (inertia, mass, "inertia", "mass"),
    };
    if let Some(span) = other.span() {
        let moves = if motion == Coordinate::Linear { "moves along a line" } else { "turns" };
        report.error(span, format!("the {of} {moves} and has no `{wrong}`"), format!("give its `{right}`"));
        return None;
    }
    or_zero(fitting)
}

/// Adds a rigidly coupled body to the one before it; `ratio` is the axis coordinate per coordinate of the latter.
fn merge(into: &mut Body, body: &Body, ratio: f64, span: Span, report: &mut Report) {
    if let Some(friction) = into.friction.joined(&body.friction.carried(ratio)) {
        into.friction = friction;
    } else {
        let message =
            format!("`{}` and `{}` are coupled rigidly but differ in Stribeck velocity", into.name, body.name);
        report.error(span, message, "give static friction on one of them, or a `stiffness` between them");
    }
    into.inertia += ratio * ratio * body.inertia;
    into.bias += ratio * body.bias;
}
