//! Parts of `[motor]`: effects of a real motor beyond its equations.
use crate::diagnostic::Report;
use crate::field::{Reported, Slot};
use crate::file;
use crate::flux_table::read_flux_table;
use crate::list::Many;
use crate::models::read_beside;
use crate::resolve::{Alternative, one_of};
use crate::source::{At, Sources};
use servobench_base::Coordinate;
use servobench_base::Dq;
use servobench_files::FileRole;
use servobench_plant::pmsm::{
    self, CLASS_F, COPPER, Effects, FluxData, FluxMap, Saturation, Temperature, Temperatures, ThermalNetwork,
};
use std::f64::consts::TAU;

/// The effects of `motor`; `params` are its parameters.
///
/// # Errors
/// [`Reported`] for a wrong key.
pub(super) fn resolve(
    motor: &file::Motor,
    params: &pmsm::Params,
    sources: &Sources,
    report: &mut Report,
) -> Result<Effects, Reported> {
    refuse_without_magnets(motor, params, report)?;
    let cogging = each(&motor.cogging, |one| cogging(one, params.electrical_ratio, report));
    let flux_harmonics = each(&motor.flux_harmonic, |one| flux_harmonic(&one.value));
    let phase_resistance = phase_resistance(motor, report);
    let temperature = temperature(motor, report);
    let flux_map = flux_map(motor, params, sources, report);
    let iron = motor.iron_loss.optional()?.map(iron_loss).transpose()?;
    Ok(Effects {
        cogging: cogging?,
        flux_harmonics: flux_harmonics?,
        iron,
        phase_resistance: phase_resistance?,
        temperature: temperature?,
        flux_map: flux_map?,
    })
}

/// Refuses values relative to the magnets' flux linkage for a motor without magnets.
fn refuse_without_magnets(motor: &file::Motor, params: &pmsm::Params, report: &mut Report) -> Result<(), Reported> {
    if params.flux_linkage > 0.0 {
        return Ok(());
    }
    let mut result = Ok(());
    for (key, span, why, help) in [
        (
            "flux_harmonic",
            motor.flux_harmonic.span(),
            "has parts of the magnets' flux linkage, which is 0 V s",
            "leave it out: a motor without magnets has no such harmonics",
        ),
        (
            "iron_loss",
            motor.iron_loss.span(),
            "is the loss of a rotor whose magnets turn without current, and their flux linkage is 0 V s",
            "leave it out: give such losses as friction of `axis.motor_side`",
        ),
        (
            "saturation",
            motor.saturation.span(),
            "is a share of the torque per ampere at i_d = 0, and without magnets there is none",
            "describe how it saturates by a `flux_map`",
        ),
    ] {
        if let Some(span) = span {
            report.error(span, format!("`{key}` {why}"), help);
            result = Err(Reported);
        }
    }
    result
}

/// All items of a list that may be absent.
fn each<T, U>(slot: &Slot<Many<T>>, resolved: impl FnMut(&At<T>) -> Result<U, Reported>) -> Result<Vec<U>, Reported> {
    let Some(all) = slot.optional()? else { return Ok(Vec::new()) };
    // Every item is resolved, so that the mistakes in all items are found.
    let all: Vec<Result<U, Reported>> = all.0.iter().map(resolved).collect();
    all.into_iter().collect()
}

fn or(slot: &Slot<f64>, default: f64) -> Result<f64, Reported> {
    Ok(slot.optional()?.copied().unwrap_or(default))
}

fn the<T: Copy>(slot: &Slot<T>) -> Result<T, Reported> {
    slot.given().copied().ok_or(Reported)
}

fn cogging(
    At { value: given, span }: &At<file::Cogging>,
    ratio: f64,
    report: &mut Report,
) -> Result<pmsm::Cogging, Reported> {
    let ways = [("per_rev", given.per_rev.span()), ("per_pole_pair", given.per_pole_pair.span())];
    let ratio = match one_of(&ways, report) {
        Alternative::Use(0) if report.motor == Some(Coordinate::Linear) => {
            let help = "give `per_pole_pair`, the order per two pole pitches";
            report.error(given.per_rev.span().unwrap_or(*span), "a linear motor has no revolution", help);
            return Err(Reported);
        }
        Alternative::Use(0) => f64::from(the(&given.per_rev)?),
        Alternative::Use(_) => ratio * f64::from(the(&given.per_pole_pair)?),
        Alternative::Contradiction => return Err(Reported),
        Alternative::None => {
            report.missing_with_help("motor.cogging", "per_rev", *span, "or `per_pole_pair`");
            return Err(Reported);
        }
    };
    Ok(pmsm::Cogging { ratio, amplitude: the(&given.amplitude)?, phase: or(&given.phase, 0.0)? % TAU })
}

fn flux_harmonic(given: &file::FluxHarmonic) -> Result<pmsm::FluxHarmonic, Reported> {
    Ok(pmsm::FluxHarmonic {
        order: the(&given.order)?,
        d: or(&given.d, 0.0)?,
        q: or(&given.q, 0.0)?,
        phase: or(&given.phase, 0.0)? % TAU,
    })
}

fn iron_loss(given: &file::IronLoss) -> Result<pmsm::IronLoss, Reported> {
    Ok(pmsm::IronLoss {
        speed: the(&given.speed)?,
        hysteresis: or(&given.hysteresis, 0.0)?,
        eddy: or(&given.eddy, 0.0)?,
    })
}

fn phase_resistance(motor: &file::Motor, report: &mut Report) -> Result<Option<[f64; 3]>, Reported> {
    let Some(factors) = motor.phase_resistance.optional()? else { return Ok(None) };
    let values: Vec<f64> = factors.0.iter().map(|factor| factor.value).collect();
    <[f64; 3]>::try_from(values).map(Some).map_err(|values| {
        let message = format!("`phase_resistance` must have three values, got {}", values.len());
        let span = motor.phase_resistance.span().unwrap_or(motor.span);
        report.error(span, message, "one for each of the phases a, b and c");
        Reported
    })
}

fn temperature(motor: &file::Motor, report: &mut Report) -> Result<Option<Temperature>, Reported> {
    let (given, thermal) = (motor.temperature.optional()?, motor.thermal.optional()?);
    if given.is_none() && thermal.is_none() {
        return Ok(None);
    }
    let network = thermal.map(network).transpose()?;
    let value = |slot: fn(&file::Temperature) -> &Slot<f64>, default: f64| {
        given.map_or(Ok(default), |given| or(slot(given), default))
    };
    let reference = value(|given| &given.reference, 20.0)?;
    let begins = network.map_or(reference, |network| network.ambient);
    let temperature = Temperature {
        reference,
        resistance_coefficient: value(|given| &given.resistance_coefficient, COPPER)?,
        flux_coefficient: value(|given| &given.flux_coefficient, 0.0)?,
        start: Temperatures {
            winding: value(|given| &given.winding, begins)?,
            housing: value(|given| &given.housing, begins)?,
        },
        network,
    };
    temperature.check().map(|()| Some(temperature)).map_err(|error| {
        let span = motor.temperature.span().or(motor.thermal.span()).unwrap_or(motor.span);
        report.error(span, format!("the {} must be {}, got {}", error.name, error.bound, error.value), "");
        Reported
    })
}

fn network(given: &file::Thermal) -> Result<ThermalNetwork, Reported> {
    Ok(ThermalNetwork {
        ambient: the(&given.ambient)?,
        to_housing: the(&given.to_housing)?,
        to_ambient: the(&given.to_ambient)?,
        winding_capacity: the(&given.winding_capacity)?,
        housing_capacity: the(&given.housing_capacity)?,
        winding_limit: or(&given.limit, CLASS_F)?,
    })
}

/// Relative difference of flux linkage between data sheet and map that causes a warning.
const MAGNETS_DIFFER: f64 = 0.1;

fn flux_map(
    motor: &file::Motor,
    params: &pmsm::Params,
    sources: &Sources,
    report: &mut Report,
) -> Result<Option<FluxMap>, Reported> {
    match one_of(&[("saturation", motor.saturation.span()), ("flux_map", motor.flux_map.span())], report) {
        Alternative::None => Ok(None),
        Alternative::Contradiction => Err(Reported),
        Alternative::Use(0) => saturation(motor, params, report).map(Some),
        Alternative::Use(_) => table(motor, params, sources, report).map(Some),
    }
}

fn saturation(motor: &file::Motor, params: &pmsm::Params, report: &mut Report) -> Result<FluxMap, Reported> {
    let given = motor.saturation.given().ok_or(Reported)?;
    let saturation = Saturation {
        current: the(&given.current)?,
        share: the(&given.share)?,
        residual: or(&given.residual, Saturation::RESIDUAL)?,
    };
    FluxMap::curve(&saturation, params.flux_linkage, params.inductance).map_err(|error| {
        let span = given.share.span().or(motor.saturation.span()).unwrap_or(motor.span);
        report.error(span, format!("the {} must be {}, got {}", error.name, error.bound, error.value), "");
        Reported
    })
}

fn table(
    motor: &file::Motor,
    params: &pmsm::Params,
    sources: &Sources,
    report: &mut Report,
) -> Result<FluxMap, Reported> {
    let file = motor.flux_map.given().and_then(|given| given.file.at()).ok_or(Reported)?;
    let place = sources.place(file.span.source).ok_or(Reported)?;
    let (path, text) = read_beside(&file.value, FileRole::Table, place, &mut report.files).map_err(|refused| {
        report.error(file.span, refused.message, refused.help);
        Reported
    })?;
    report.note_table(&file.value, &text);
    let data = read_flux_table(&text).map_err(|error| {
        report.error(file.span, format!("{}:{error}", path.display()), "");
        Reported
    })?;
    for (name, currents) in [("i_d", &data.i_d), ("i_q", &data.i_q)] {
        if !currents.contains(&0.0) {
            let ends = [currents.first(), currents.last()].map(|end| end.copied().unwrap_or(f64::NAN));
            let message = format!(
                "{}: `{name}` must have 0 A among its currents, got {} A to {} A without it",
                path.display(),
                ends[0],
                ends[1]
            );
            report.error(file.span, message, "the run begins without current: add the rows of 0 A to the table");
            return Err(Reported);
        }
    }
    let map = FluxMap::table(&data).map_err(|error| {
        report.error(file.span, format!("{}: {error}", path.display()), error.way_out());
        Reported
    })?;
    doubtful(motor, params, &data, &map, report);
    Ok(map)
}

/// Warns of a table that may belong to another motor, or is too small.
fn doubtful(motor: &file::Motor, params: &pmsm::Params, data: &FluxData, map: &FluxMap, report: &mut Report) {
    let Some(span) = motor.flux_map.span() else { return };
    let (of_map, own) = (map.flux(Dq::default()).d, params.flux_linkage);
    let largest = data.psi_d.iter().fold(0.0, |most: f64, psi| most.max(psi.abs()));
    if (of_map - own).abs() > MAGNETS_DIFFER * own + f64::EPSILON * largest {
        let message = format!("without current the map has a flux linkage of {of_map} V s, the motor {own} V s");
        report.warning(span, message, "the drive's estimate is that of the motor: is the map that of this motor?");
    }
    let furthest = data.i_q.iter().fold(0.0, |most: f64, i| most.max(i.abs()));
    if let Some(most) = motor.max_current.given().filter(|most| **most > furthest * (1.0 + 1e-9)) {
        let message = format!("the map ends at i_q = {furthest} Apk, `max_current` is {most} Apk");
        report.warning(span, message, "beyond the map the flux continues with its last inductances");
    }
}
