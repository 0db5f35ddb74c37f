//! Attributes of numbers, set by a declared type and overridden by a variable.
use super::element::{Element, float};
use super::units::Units;
use super::variable::DataType;
use crate::error::FmuError;

/// Attributes of numbers.
#[derive(Debug, Clone, PartialEq, Default)]
pub(super) struct Numeric {
    pub(super) min: Option<f64>,
    pub(super) max: Option<f64>,
    pub(super) nominal: Option<f64>,
    pub(super) quantity: String,
    pub(super) unit: Option<usize>,
    pub(super) display_unit: String,
    pub(super) is_relative: bool,
}

impl Numeric {
    /// Reads the attributes of an element; missing ones are taken from `defaults`.
    pub(super) fn read(
        element: Element,
        data_type: DataType,
        defaults: &Self,
        units: &mut Units,
        remarks: &mut Vec<String>,
    ) -> Result<Self, FmuError> {
        #[expect(clippy::cast_precision_loss, reason = "documented: bounds of 64-bit integers are rounded")]
        let number = |text: &str| match data_type.integers() {
            Some((least, most)) => {
                text.parse::<i128>().ok().filter(|value| (least..=most).contains(value)).map(|value| value as f64)
            }
            None => float(text).filter(|value| !value.is_nan()),
        };
        let bound = |attribute| {
            let Some(text) = element.text(attribute) else { return Ok(None) };
            let expected = || match data_type.integers() {
                Some((least, most)) => format!("a whole number from {least} to {most}"),
                None => "a number".to_owned(),
            };
            number(text.trim()).map(Some).ok_or_else(|| element.wrong(attribute, expected()))
        };
        let min = bound("min")?.or(defaults.min);
        let max = bound("max")?.or(defaults.max);
        if let (Some(min), Some(max)) = (min, max)
            && min > max
        {
            let (attribute, bound) = if element.text("max").is_some() {
                ("max", format!("at least `min`, {min}"))
            } else {
                ("min", format!("at most `max`, {max}"))
            };
            return Err(element.wrong(attribute, bound));
        }
        let text =
            |attribute, default: &String| element.text(attribute).map_or_else(|| default.clone(), ToOwned::to_owned);
        let unit = element.text("unit").filter(|name| !name.is_empty());
        Ok(Self {
            min,
            max,
            nominal: element.number("nominal")?.or(defaults.nominal),
            quantity: text("quantity", &defaults.quantity),
            unit: unit.map(|name| units.position(name, remarks)).or(defaults.unit),
            display_unit: text("displayUnit", &defaults.display_unit),
            is_relative: element.boolean("relativeQuantity")? || defaults.is_relative,
        })
    }
}
