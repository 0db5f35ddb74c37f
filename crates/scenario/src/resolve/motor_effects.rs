//! Parts of `[motor]`: what a real one does beside its equations.
use crate::diagnostic::Report;
use crate::field::{Reported, Slot};
use crate::file;
use crate::list::Many;
use crate::resolve::{Alternative, one_of};
use crate::source::At;
use servobench_base::Coordinate;
use servobench_plant::pmsm::{self, COPPER, Effects, Temperature, Temperatures, ThermalNetwork};
use std::f64::consts::TAU;

/// The effects of `motor`, whose own parameters are `params`.
///
/// # Errors
/// [`Reported`] when a key is wrong.
pub(super) fn resolve(motor: &file::Motor, params: &pmsm::Params, report: &mut Report) -> Result<Effects, Reported> {
    let cogging = each(&motor.cogging, |one| cogging(one, params.electrical_ratio, report));
    let flux_harmonics = each(&motor.flux_harmonic, |one| flux_harmonic(&one.value));
    let phase_resistance = phase_resistance(motor, report);
    let temperature = temperature(motor, report);
    let iron = motor.iron_loss.optional()?.map(iron_loss).transpose()?;
    Ok(Effects {
        cogging: cogging?,
        flux_harmonics: flux_harmonics?,
        iron,
        phase_resistance: phase_resistance?,
        temperature: temperature?,
    })
}

/// All of a list that may be absent.
fn each<T, U>(slot: &Slot<Many<T>>, resolved: impl FnMut(&At<T>) -> Result<U, Reported>) -> Result<Vec<U>, Reported> {
    let Some(all) = slot.optional()? else { return Ok(Vec::new()) };
    // Every item, so that the mistakes of all are found.
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
    })
}
