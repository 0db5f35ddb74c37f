//! `<UnitDefinitions>`.
use super::element::Element;
use super::unit::{BaseUnit, DisplayUnit, Exponents, Unit};
use crate::error::FmuError;
use std::collections::HashMap;

/// The units, with the position of each name.
#[derive(Debug, Default)]
pub(super) struct Units {
    pub(super) all: Vec<Unit>,
    positions: HashMap<String, usize>,
}

impl Units {
    pub(super) fn read(root: Element) -> Result<Self, FmuError> {
        let mut units = Self::default();
        for element in root.grandchildren("UnitDefinitions").filter(|child| child.name() == "Unit") {
            let name = element.required("name")?;
            if units.positions.contains_key(name) {
                return Err(element.twice("name", "another unit"));
            }
            let base = element.child("BaseUnit").map(base_unit).transpose()?;
            let display = element.children().filter(|child| child.name() == "DisplayUnit").map(display_unit);
            let display = display.collect::<Result<_, _>>()?;
            units.push(Unit { name: name.to_owned(), base, display });
        }
        Ok(units)
    }

    fn push(&mut self, unit: Unit) -> usize {
        let at = self.all.len();
        self.positions.insert(unit.name.clone(), at);
        self.all.push(unit);
        at
    }

    /// The position of a unit that is referred to. An undefined one has only its name.
    pub(super) fn position(&mut self, name: &str, remarks: &mut Vec<String>) -> usize {
        if let Some(at) = self.positions.get(name) {
            return *at;
        }
        remarks.push(format!("the unit `{}` is not defined in <UnitDefinitions>", name.escape_debug()));
        self.push(Unit { name: name.to_owned(), base: None, display: vec![] })
    }
}

fn base_unit(element: Element) -> Result<BaseUnit, FmuError> {
    let exponent = |attribute| {
        let read = element.read(attribute, "a whole number of 32 bits", |text| text.parse().ok())?;
        Ok::<i32, FmuError>(read.unwrap_or(0))
    };
    let exponents = Exponents {
        kg: exponent("kg")?,
        m: exponent("m")?,
        s: exponent("s")?,
        a: exponent("A")?,
        k: exponent("K")?,
        mol: exponent("mol")?,
        cd: exponent("cd")?,
        rad: exponent("rad")?,
    };
    Ok(BaseUnit { exponents, factor: factor(element)?, offset: element.number("offset")?.unwrap_or(0.0) })
}

fn display_unit(element: Element) -> Result<DisplayUnit, FmuError> {
    Ok(DisplayUnit {
        name: element.required("name")?.to_owned(),
        factor: factor(element)?,
        offset: element.number("offset")?.unwrap_or(0.0),
        inverse: element.boolean("inverse")?,
    })
}

fn factor(element: Element) -> Result<f64, FmuError> {
    let factor = element.number("factor")?.unwrap_or(1.0);
    // Division by a factor whose inverse overflows is impossible.
    if !(factor.is_normal() && factor.recip().is_normal()) {
        return Err(element.wrong("factor", "a finite number that is not zero"));
    }
    Ok(factor)
}
