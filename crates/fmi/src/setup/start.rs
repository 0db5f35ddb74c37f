//! Start values, converted to the types of their variables.
use super::{Value, counts, position, setup};
use crate::archive::Unpacked;
use crate::description::{Causality, DataType, Initial, ModelDescription, Values, Variability, Variable, Version};
use crate::error::FmuError;
use servobench_config::Choice as _;
use std::collections::HashSet;

/// A variable and its start value, one for each element.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Start {
    pub(crate) variable: usize,
    pub(crate) values: Values,
}

/// Greatest number of elements of all arrays together, as structural parameters may set it.
const MOST_ELEMENTS: usize = 1 << 24;

/// All start values, structural parameters first, and the resulting number of elements of each variable.
pub(super) fn all(fmu: &Unpacked, given: &[(String, Value)]) -> Result<(Vec<Start>, Vec<usize>), FmuError> {
    let it = fmu.description();
    let mut starts = vec![];
    let mut rest = vec![];
    let mut seen = HashSet::new();
    let refuse = |name: &str, problem| setup(fmu, "start value", name, problem);
    for (name, value) in given {
        let at = position(it, name).map_err(|problem| refuse(name, problem))?;
        if !seen.insert(at) {
            return Err(refuse(name, "it is started twice".into()));
        }
        let variable = &it.variables[at];
        check_startable(variable).map_err(|problem| refuse(name, problem))?;
        if variable.causality == Causality::StructuralParameter {
            let values = typed(it, variable, value, 1).map_err(|problem| refuse(name, problem))?;
            if matches!(&values, Values::Integer(values) if values.iter().any(|value| *value < 1)) {
                return Err(refuse(name, "an extent of arrays is at least 1".into()));
            }
            starts.push(Start { variable: at, values });
        } else {
            rest.push((name, at, value));
        }
    }
    let counts = counts(it, &starts);
    let elements: usize = counts.iter().fold(0, |sum, count| sum.saturating_add(*count));
    if elements > MOST_ELEMENTS.max(it.variables.len()) {
        let name = starts.first().map_or("", |start| it.variables[start.variable].name.as_str());
        return Err(refuse(name, format!("arrays would have {elements} elements in all, at most {MOST_ELEMENTS}")));
    }
    for (name, variable, value) in rest {
        let values = typed(it, &it.variables[variable], value, counts[variable]);
        starts.push(Start { variable, values: values.map_err(|problem| refuse(name, problem))? });
    }
    Ok((starts, counts))
}

/// FMI 2.0.5, §2.2.7, and FMI 3.0.2, §2.3.2: before initialisation `exact` and `approx` variables can be set, except constants.
fn check_startable(variable: &Variable) -> Result<(), String> {
    let (causality, variability) = (variable.causality.name(), variable.variability.name());
    if variable.variability == Variability::Constant {
        return Err("it is a constant".into());
    }
    if !matches!(variable.initial, Some(Initial::Exact | Initial::Approx)) {
        return Err(format!("the FMU calculates it ({causality}, {variability})"));
    }
    Ok(())
}

/// Values of a variable of `count` elements.
fn typed(it: &ModelDescription, variable: &Variable, value: &Value, count: usize) -> Result<Values, String> {
    let mut flat = vec![];
    flatten(value, &mut flat)?;
    if flat.len() != count && matches!(value, Value::List(_)) {
        return Err(format!("it has {count} elements, got {}", flat.len()));
    }
    let each = |at: usize| if flat.len() == count { flat[at] } else { flat[0] };
    let wrong = |value: &Value| format!("it is a `{}`, got {}", variable.data_type.name(), shown(value));
    match variable.data_type {
        DataType::Float32 | DataType::Float64 => {
            let float = |at| match each(at) {
                Value::Number(number) if number.is_finite() => within(variable, *number, *number),
                #[expect(clippy::cast_precision_loss, reason = "a float is as near as it gets")]
                Value::Integer(number) => within(variable, *number as f64, *number as f64),
                other => Err(wrong(other)),
            };
            (0..count).map(float).collect::<Result<_, _>>().map(Values::Float)
        }
        DataType::Boolean => {
            let boolean = |at| match each(at) {
                Value::Boolean(is) => Ok(*is),
                other => Err(wrong(other)),
            };
            (0..count).map(boolean).collect::<Result<_, _>>().map(Values::Boolean)
        }
        DataType::String => {
            let text = |at| match each(at) {
                Value::Text(text) if !text.contains('\0') => Ok(text.clone()),
                other => Err(wrong(other)),
            };
            (0..count).map(text).collect::<Result<_, _>>().map(Values::String)
        }
        DataType::Binary => {
            let bytes = |at| match each(at) {
                Value::Binary(bytes) => Ok(bytes.clone()),
                other => Err(wrong(other)),
            };
            (0..count).map(bytes).collect::<Result<_, _>>().map(Values::Binary)
        }
        DataType::Clock => Err("it is a `Clock`, which has no value".into()),
        integers => {
            // Enumerations of FMI 2.0 are as long as its integers.
            let is_short = it.version == Version::Two;
            let (least, most) =
                if is_short { DataType::Int32.integers() } else { integers.integers() }.unwrap_or_default();
            let integer = |at| {
                let number = match each(at) {
                    #[expect(clippy::cast_possible_truncation, reason = "whole and within 2^64")]
                    Value::Number(number) if number.fract() == 0.0 && number.abs() <= 2.0_f64.powi(64) => {
                        *number as i128
                    }
                    Value::Integer(number) => *number,
                    Value::Text(item) if integers == DataType::Enumeration => item_value(it, variable, item)?,
                    other => return Err(wrong(other)),
                };
                if !(least..=most).contains(&number) {
                    return Err(format!("it takes {least} to {most}, got {number}"));
                }
                #[expect(clippy::cast_precision_loss, reason = "bounds are rounded in the same way")]
                within(variable, number as f64, number)
            };
            (0..count).map(integer).collect::<Result<_, _>>().map(Values::Integer)
        }
    }
}

/// The elements of nested lists.
fn flatten<'a>(value: &'a Value, flat: &mut Vec<&'a Value>) -> Result<(), String> {
    // Not recursive: lists come from files.
    let mut open = vec![value];
    while let Some(value) = open.pop() {
        match value {
            Value::List(values) => open.extend(values.iter().rev()),
            scalar => flat.push(scalar),
        }
    }
    if flat.is_empty() { Err("a list without elements starts nothing".into()) } else { Ok(()) }
}

/// The shortest digits that identify a number.
fn in_few_digits(number: f64) -> String {
    let size = number.abs();
    if size != 0.0 && size.is_finite() && !(1e-3..1e7).contains(&size) {
        format!("{number:e}")
    } else {
        number.to_string()
    }
}

/// `value`, if its number is within the bounds of the variable.
fn within<T>(variable: &Variable, number: f64, value: T) -> Result<T, String> {
    let (min, max) = (variable.min.unwrap_or(f64::NEG_INFINITY), variable.max.unwrap_or(f64::INFINITY));
    if number < min || number > max {
        return Err(format!(
            "it takes {} to {}, got {}",
            in_few_digits(min),
            in_few_digits(max),
            in_few_digits(number)
        ));
    }
    Ok(value)
}

fn item_value(it: &ModelDescription, variable: &Variable, name: &str) -> Result<i128, String> {
    let items = it.enumeration(variable).map_or(&[][..], |enumeration| &enumeration.items);
    let item = items.iter().find(|item| item.name == name);
    item.map(|item| item.value.into()).ok_or_else(|| {
        let names: Vec<_> = items.iter().map(|item| format!("`{}`", item.name)).collect();
        format!("it has no item `{name}`; it has {}", names.join(", "))
    })
}

fn shown(value: &Value) -> String {
    match value {
        Value::Number(number) => number.to_string(),
        Value::Integer(number) => number.to_string(),
        Value::Boolean(is) => is.to_string(),
        Value::Quantity { text, .. } => format!("the quantity `{}`", text.escape_debug()),
        Value::Text(text) => format!("the text `{}`", text.escape_debug()),
        Value::Binary(bytes) => format!("{} bytes", bytes.len()),
        Value::List(_) => "a list".to_owned(),
    }
}
