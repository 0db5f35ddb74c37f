//! `<ModelVariables>`.
use super::Version;
use super::clock::Ticks;
use super::combination::{initials, variabilities};
use super::declared::{Declared, DeclaredType, type_of_two};
use super::element::Element;
use super::named::one_of;
use super::numeric::Numeric;
use super::start::{MOST_ELEMENTS, start};
use super::units::Units;
use super::variable::{Alias, Causality, DataType, Dimension, Initial, Values, Variability, Variable};
use crate::error::{DescriptionProblem, FmuError};
use servobench_config::Choice;
use std::collections::HashMap;

/// The variables, with the position of each name.
#[derive(Debug, Default)]
pub(super) struct Variables {
    pub(super) all: Vec<Variable>,
    pub(super) positions: HashMap<String, usize>,
}

impl Variables {
    pub(super) fn read(
        root: Element,
        version: Version,
        units: &mut Units,
        declared: &Declared,
        remarks: &mut Vec<String>,
    ) -> Result<Self, FmuError> {
        if root.child("ModelVariables").is_none() {
            let parent = root.name().to_owned();
            return Err(root.error(DescriptionProblem::NoElement { parent, expected: "`<ModelVariables>`" }));
        }
        let mut reading = Reading { version, units, declared, remarks };
        let mut variables = Self::default();
        let mut elements = vec![];
        for element in root.grandchildren("ModelVariables") {
            let Some((attributes, data_type)) = reading.data_type(element)? else { continue };
            let variable = reading.variable(element, attributes, data_type)?;
            let at = variables.all.len();
            variables.name(element, &variable.name, at)?;
            for (alias, element) in variable.aliases.iter().zip(aliases(element)) {
                variables.name(element, &alias.name, at)?;
            }
            variables.all.push(variable);
            elements.push((element, attributes));
        }
        variables.resolve(&elements, version)?;
        Ok(variables)
    }

    /// Registers a name.
    fn name(&mut self, element: Element, name: &str, at: usize) -> Result<(), FmuError> {
        if let Some(first) = self.positions.insert(name.to_owned(), at) {
            return Err(element.twice("name", &format!("variable number {}", first + 1)));
        }
        Ok(())
    }

    /// Resolves references between variables.
    fn resolve(&mut self, elements: &[(Element, Element)], version: Version) -> Result<(), FmuError> {
        let mut references = HashMap::new();
        let mut independent = None;
        for (at, (element, _)) in elements.iter().enumerate() {
            let variable = &self.all[at];
            if version == Version::Three && references.insert(variable.value_reference, at).is_some() {
                return Err(element.twice("valueReference", "another variable"));
            }
            if variable.causality == Causality::Independent && independent.replace(at).is_some() {
                return Err(element.wrong("causality", "one independent variable only"));
            }
        }
        for (at, (element, attributes)) in elements.iter().enumerate() {
            self.all[at].derivative_of = self.derivative(*attributes, version, &references)?;
            self.all[at].dimensions = self.dimensions(*element, &references)?;
            self.check_count(at, *element)?;
            let clock = |reference: &u32| references.get(reference).map(|at| self.all[*at].data_type);
            if self.all[at].clocks.iter().any(|reference| clock(reference) != Some(DataType::Clock)) {
                return Err(element.wrong("clocks", "value references of variables of the type `Clock`"));
            }
        }
        Ok(())
    }

    fn derivative(
        &self,
        element: Element,
        version: Version,
        references: &HashMap<u32, usize>,
    ) -> Result<Option<usize>, FmuError> {
        let position = |text: &str| -> Option<usize> {
            let number: u32 = text.parse().ok()?;
            match version {
                Version::Two => usize::try_from(number).ok()?.checked_sub(1).filter(|at| *at < self.all.len()),
                Version::Three => references.get(&number).copied(),
            }
        };
        element.read("derivative", "position (FMI 2.0) or value reference (FMI 3.0) of a variable", position)
    }

    fn dimensions(&self, element: Element, references: &HashMap<u32, usize>) -> Result<Vec<Dimension>, FmuError> {
        let dimension = |element: Element| {
            let whole = "a whole number, at least 1";
            let fixed = element.read("start", whole, |text| text.parse().ok().filter(|extent| *extent > 0))?;
            let parameter = "the value reference of a structural parameter of type `UInt64`, at least 1 at the start";
            let structural = element.read("valueReference", parameter, |text| {
                let at = *references.get(&text.parse().ok()?)?;
                let one = &self.all[at];
                let is_positive =
                    matches!(&one.start, Some(Values::Integer(start)) if start.iter().all(|one| *one > 0));
                let is_one = one.causality == Causality::StructuralParameter && one.data_type == DataType::UInt64;
                (is_one && is_positive).then_some(at)
            })?;
            match (fixed, structural) {
                (Some(extent), None) => Ok(Dimension::Fixed(extent)),
                (None, Some(at)) => Ok(Dimension::Structural(at)),
                (Some(_), Some(_)) => Err(element.wrong("start", "either `start` or `valueReference`")),
                (None, None) => Err(element.error(DescriptionProblem::NoAttribute {
                    element: element.name().to_owned(),
                    attribute: "start` or `valueReference",
                })),
            }
        };
        element.children().filter(|child| child.name() == "Dimension").map(dimension).collect()
    }

    /// Checks that there is one start value for each element, or one for all.
    fn check_count(&self, at: usize, element: Element) -> Result<(), FmuError> {
        let variable = &self.all[at];
        let extent = |dimension: &Dimension| match dimension {
            Dimension::Fixed(extent) => *extent,
            Dimension::Structural(at) => match &self.all[*at].start {
                Some(Values::Integer(start)) => start.first().and_then(|&one| one.try_into().ok()).unwrap_or(0),
                _ => 0,
            },
        };
        let count = variable.dimensions.iter().map(extent).try_fold(1, u64::checked_mul);
        let Some(count) = count.filter(|count| *count <= MOST_ELEMENTS) else {
            let most = usize::try_from(MOST_ELEMENTS).unwrap_or(usize::MAX);
            return Err(element.error(DescriptionProblem::Limit { what: "the number of elements of the array", most }));
        };
        let given = variable.start.as_ref().map_or(1, |start| start.len() as u64);
        if given != 1 && given != count {
            let expected =
                if count == 1 { "one value".to_owned() } else { format!("one value or {count}, got {given}") };
            return Err(element.wrong("start", expected));
        }
        Ok(())
    }
}

/// Context of reading a variable.
struct Reading<'a> {
    version: Version,
    units: &'a mut Units,
    declared: &'a Declared,
    remarks: &'a mut Vec<String>,
}

impl<'a> Reading<'a> {
    /// The element that carries the attributes of the type, and the type; none if the element is not a variable.
    fn data_type<'e>(&self, element: Element<'e>) -> Result<Option<(Element<'e>, DataType)>, FmuError> {
        match self.version {
            Version::Two if element.name() == "ScalarVariable" => type_of_two(element).map(Some),
            Version::Three if element.name() == "Annotations" => Ok(None),
            Version::Three => match DataType::from_name(element.name()) {
                Some(data_type) => Ok(Some((element, data_type))),
                None => Err(unknown(element, one_of(DataType::ALL.iter().map(|(name, ..)| *name)))),
            },
            Version::Two => Err(unknown(element, "`<ScalarVariable>`".into())),
        }
    }

    fn variable(&mut self, element: Element, attributes: Element, data_type: DataType) -> Result<Variable, FmuError> {
        let name = element.required("name")?.to_owned();
        if name.is_empty() {
            return Err(element.wrong("name", "a name that is not empty"));
        }
        element.required("valueReference")?;
        let causality = element.named("causality")?.unwrap_or(Causality::Local);
        let variability = self.variability(element, causality, data_type)?;
        // In FMI 3.0 an attribute of the type, in FMI 2.0 of the variable.
        let initial = self.initial(element, &name, causality, variability)?;
        let declared = self.declared_type(attributes, data_type)?;
        let defaults = declared.map(|declared| declared.numeric.clone()).unwrap_or_default();
        let numeric = Numeric::read(attributes, data_type, &defaults, self.units, self.remarks)?;
        let start = start(attributes, data_type, self.version)?;
        self.remark_on_start(&name, causality, data_type, initial, start.is_some());
        Ok(Variable {
            name,
            value_reference: element.unsigned("valueReference")?.unwrap_or_default(),
            description: element.text_or_empty("description"),
            causality,
            variability,
            initial,
            data_type,
            declared_type: attributes.text_or_empty("declaredType"),
            enumeration: declared.and_then(|declared| declared.enumeration),
            dimensions: vec![],
            start,
            min: numeric.min,
            max: numeric.max,
            nominal: numeric.nominal,
            quantity: numeric.quantity,
            unit: numeric.unit,
            display_unit: numeric.display_unit,
            is_relative: numeric.is_relative,
            derivative_of: None,
            ticks: (data_type == DataType::Clock).then(|| Ticks::read(element, causality)).transpose()?,
            clocks: element.references("clocks")?.unwrap_or_default(),
            aliases: aliases(element).map(alias).collect::<Result<_, _>>()?,
        })
    }

    /// The variability, checked against causality and type.
    fn variability(
        &self,
        element: Element,
        causality: Causality,
        data_type: DataType,
    ) -> Result<Variability, FmuError> {
        let is_parameter =
            matches!(causality, Causality::Parameter | Causality::StructuralParameter | Causality::CalculatedParameter);
        let given = element.named("variability")?;
        let variability = given.unwrap_or(match self.version {
            // FMI 3.0 allows no other for these; tools omit it.
            Version::Three if is_parameter => Variability::Fixed,
            // FMI 2.0 has continuous as the default for all and allows it for `Real` alone.
            _ if data_type.is_float() => Variability::Continuous,
            _ => Variability::Discrete,
        });
        let allowed = variabilities(causality);
        let fits = |one: Variability| data_type.is_float() || one != Variability::Continuous;
        if allowed.contains(&variability) && fits(variability) {
            return Ok(variability);
        }
        let what = format!(
            "causality `{}`, variability `{}`, type `{}`",
            causality.name(),
            variability.name(),
            data_type.name()
        );
        let names = allowed.iter().copied().filter(|one| fits(*one)).map(Choice::name);
        let allowed = format!("{} for this causality and type", one_of(names));
        let variable = element.text_or_empty("name");
        let attribute = if given.is_some() { "variability" } else { "causality" };
        Err(element.error_at(attribute, DescriptionProblem::Combination { variable, found: what, allowed }))
    }

    /// The kind of initialisation, checked against causality and variability.
    fn initial(
        &mut self,
        element: Element,
        name: &str,
        causality: Causality,
        variability: Variability,
    ) -> Result<Option<Initial>, FmuError> {
        let allowed = initials(causality, variability);
        let Some(given) = element.named("initial")? else { return Ok(allowed.first().copied()) };
        if causality == Causality::Input && self.version == Version::Two {
            self.remarks.push(format!("input `{name}` has `initial`, which FMI 2.0 has for no input"));
        }
        if allowed.contains(&given) {
            return Ok(Some(given));
        }
        let (variable, found) = (name.to_owned(), format!("initial `{}`", given.name()));
        let names = one_of(allowed.iter().copied().map(Choice::name));
        let allowed = format!("{names} for causality `{}`, variability `{}`", causality.name(), variability.name());
        Err(element.error_at("initial", DescriptionProblem::Combination { variable, found, allowed }))
    }

    fn declared_type(&self, element: Element, data_type: DataType) -> Result<Option<&'a DeclaredType>, FmuError> {
        let Some(name) = element.text("declaredType") else {
            if data_type == DataType::Enumeration {
                element.required("declaredType")?;
            }
            return Ok(None);
        };
        let declared = self.declared.types.get(name).filter(|declared| declared.data_type == data_type);
        let expected = || format!("a type of <TypeDefinitions> that is `{}`", data_type.name());
        declared.map(Some).ok_or_else(|| element.wrong("declaredType", expected()))
    }

    /// Remarks on a missing or superfluous start value. It does no harm: the library has its own.
    fn remark_on_start(
        &mut self,
        name: &str,
        causality: Causality,
        data_type: DataType,
        initial: Option<Initial>,
        has_start: bool,
    ) {
        let needs_one = causality == Causality::Input || matches!(initial, Some(Initial::Exact | Initial::Approx));
        if needs_one && !has_start && data_type != DataType::Clock {
            self.remarks.push(format!("`{name}` has no start value and should have one"));
        } else if !needs_one && has_start {
            self.remarks.push(format!("`{name}` has a start value, which is not used: it is calculated"));
        }
    }
}

fn unknown(element: Element, expected: String) -> FmuError {
    element.error(DescriptionProblem::Element { found: element.name().to_owned(), expected })
}

fn aliases(element: Element<'_>) -> impl Iterator<Item = Element<'_>> {
    element.children().filter(|child| child.name() == "Alias")
}

fn alias(element: Element) -> Result<Alias, FmuError> {
    Ok(Alias {
        name: element.required("name")?.to_owned(),
        description: element.text_or_empty("description"),
        display_unit: element.text_or_empty("displayUnit"),
    })
}
