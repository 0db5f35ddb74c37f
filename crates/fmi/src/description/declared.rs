//! `<TypeDefinitions>`.
use super::element::Element;
use super::named::one_of;
use super::numeric::Numeric;
use super::units::Units;
use super::{DataType, Version};
use crate::error::{DescriptionProblem, FmuError};
use servobench_config::Choice;
use std::collections::HashMap;

/// An enumeration.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Enumeration {
    /// Its name.
    pub name: String,
    /// Its items in the order of the file; names are unique, values as well.
    pub items: Vec<Item>,
}

/// An item of an enumeration.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Item {
    /// Its name.
    pub name: String,
    /// Its value.
    pub value: i64,
    /// Its meaning.
    pub description: String,
}

/// A declared type.
#[derive(Debug)]
pub(super) struct DeclaredType {
    pub(super) data_type: DataType,
    pub(super) numeric: Numeric,
    /// Position of the enumeration, if it is one.
    pub(super) enumeration: Option<usize>,
}

/// The declared types by their names, and the enumerations among them.
#[derive(Debug, Default)]
pub(super) struct Declared {
    pub(super) types: HashMap<String, DeclaredType>,
    pub(super) enumerations: Vec<Enumeration>,
}

impl Declared {
    pub(super) fn read(
        root: Element,
        version: Version,
        units: &mut Units,
        remarks: &mut Vec<String>,
    ) -> Result<Self, FmuError> {
        let mut declared = Self::default();
        for element in root.grandchildren("TypeDefinitions") {
            let name = element.required("name")?;
            let (attributes, data_type) = match version {
                Version::Two => type_of_two(element)?,
                Version::Three => (element, type_of_three(element)?),
            };
            let enumeration = (data_type == DataType::Enumeration)
                .then(|| Ok::<_, FmuError>(Enumeration { name: name.to_owned(), items: items(attributes)? }))
                .transpose()?;
            let enumeration = enumeration.map(|one| {
                declared.enumerations.push(one);
                declared.enumerations.len() - 1
            });
            let numeric = Numeric::read(attributes, data_type, &Numeric::default(), units, remarks)?;
            let one = DeclaredType { data_type, numeric, enumeration };
            if declared.types.insert(name.to_owned(), one).is_some() {
                return Err(element.twice("name", "another type"));
            }
        }
        Ok(declared)
    }
}

/// Names of the types of FMI 2.0.
pub(super) const TWO: [(&str, DataType); 5] = [
    ("Real", DataType::Float64),
    ("Integer", DataType::Int32),
    ("Boolean", DataType::Boolean),
    ("String", DataType::String),
    ("Enumeration", DataType::Enumeration),
];

/// Finds the child that is the type: FMI 2.0 nests the type in the named element.
pub(super) fn type_of_two(element: Element) -> Result<(Element, DataType), FmuError> {
    let found = element
        .children()
        .find_map(|child| TWO.iter().find(|(name, _)| *name == child.name()).map(|(_, data_type)| (child, *data_type)));
    found.ok_or_else(|| {
        let parent = element.name().to_owned();
        let expected = "`<Real>`, `<Integer>`, `<Boolean>`, `<String>` or `<Enumeration>`";
        element.error(DescriptionProblem::NoElement { parent, expected })
    })
}

/// Type of an element of FMI 3.0, whose name is that of the type with "Type" appended.
fn type_of_three(element: Element) -> Result<DataType, FmuError> {
    element.name().strip_suffix("Type").and_then(DataType::from_name).ok_or_else(|| {
        let expected = format!("{} with `Type` behind it", one_of(DataType::ALL.iter().map(|(name, ..)| *name)));
        element.error(DescriptionProblem::Element { found: element.name().to_owned(), expected })
    })
}

fn items(element: Element) -> Result<Vec<Item>, FmuError> {
    let mut items: Vec<Item> = vec![];
    let mut seen = (HashMap::new(), HashMap::new());
    for item in element.children().filter(|child| child.name() == "Item") {
        let name = item.required("name")?.to_owned();
        item.required("value")?;
        let value: Option<i64> = item.read("value", "a whole number of 64 bits", |text| text.parse().ok())?;
        let value = value.unwrap_or_default();
        if let Some(first) = seen.0.insert(name.clone(), value) {
            return Err(item.twice("name", &first.to_string()));
        }
        if let Some(first) = seen.1.insert(value, name.clone()) {
            return Err(item.twice("value", &first));
        }
        items.push(Item { name, value, description: item.text_or_empty("description") });
    }
    if items.is_empty() {
        let parent = element.name().to_owned();
        return Err(element.error(DescriptionProblem::NoElement { parent, expected: "`<Item>`" }));
    }
    Ok(items)
}
