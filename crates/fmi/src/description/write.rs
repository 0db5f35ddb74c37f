//! The text of a model description.
//!
//! Source: FMI 2.0.5, §2.2 and §4.3.1; FMI 3.0.2, §2.4 and §4.4, and the XML schemas that belong to them.
use super::xml::{Element, Number, Xml};
use super::{
    Causality, CoSimulation, DataType, DefaultExperiment, DependencyKind, Dimension, Enumeration, ModelDescription,
    ModelStructure, Unit, Unknown, Values, Variable, Version,
};
use servobench_config::Choice;
use std::fmt::{Display, Write as _};

impl ModelDescription {
    /// A description of these variables and nothing else.
    #[must_use]
    pub fn new(version: Version, model_name: &str, instantiation_token: &str, variables: Vec<Variable>) -> Self {
        let positions = variables.iter().enumerate().map(|(at, variable)| (variable.name.clone(), at)).collect();
        Self {
            version,
            fmi_version: match version {
                Version::Two => "2.0".into(),
                Version::Three => "3.0".into(),
            },
            model_name: model_name.into(),
            instantiation_token: instantiation_token.into(),
            description: String::new(),
            author: String::new(),
            model_version: String::new(),
            copyright: String::new(),
            license: String::new(),
            generation_tool: String::new(),
            generation_date_and_time: String::new(),
            co_simulation: CoSimulation::default(),
            default_experiment: DefaultExperiment::default(),
            log_categories: vec![],
            units: vec![],
            enumerations: vec![],
            variables,
            structure: ModelStructure::default(),
            remarks: vec![],
            positions,
        }
    }

    /// The text of the file, without anything that only the other version of the standard has.
    #[must_use]
    pub fn write(&self) -> String {
        let mut xml = Xml::new();
        let token = match self.version {
            Version::Two => "guid",
            Version::Three => "instantiationToken",
        };
        let mut root = Element::new("fmiModelDescription");
        root.set("fmiVersion", &self.fmi_version)
            .set("modelName", &self.model_name)
            .set(token, &self.instantiation_token);
        for (name, text) in [
            ("description", &self.description),
            ("author", &self.author),
            ("version", &self.model_version),
            ("copyright", &self.copyright),
            ("license", &self.license),
            ("generationTool", &self.generation_tool),
            ("generationDateAndTime", &self.generation_date_and_time),
        ] {
            root.set_text(name, text);
        }
        // Names with dots are paths.
        root.set("variableNamingConvention", "structured");
        xml.within(root, |xml| {
            self.interface(xml);
            xml.group("UnitDefinitions", &self.units, unit);
            xml.group("TypeDefinitions", &self.enumerations, |xml, one| enumeration(self.version, xml, one));
            xml.group("LogCategories", &self.log_categories, |xml, one| {
                let mut element = Element::new("Category");
                element.set("name", &one.name).set_text("description", &one.description);
                xml.leaf(element);
            });
            let DefaultExperiment { start_time, stop_time, tolerance, step_size } = self.default_experiment;
            let mut experiment = Element::new("DefaultExperiment");
            for (name, value) in
                [("startTime", start_time), ("stopTime", stop_time), ("tolerance", tolerance), ("stepSize", step_size)]
            {
                experiment.set_some(name, value.map(Number));
            }
            xml.leaf(experiment);
            xml.group("ModelVariables", &self.variables, |xml, one| match self.version {
                Version::Two => self.scalar(xml, one),
                Version::Three => self.variable_of_three(xml, one),
            });
            self.structure(xml);
        });
        xml.finish()
    }

    fn interface(&self, xml: &mut Xml) {
        let (own, is_two) = (&self.co_simulation, self.version == Version::Two);
        let mut element = Element::new("CoSimulation");
        element.set("modelIdentifier", &own.model_identifier);
        let either = |two, three| if is_two { two } else { three };
        for (name, flag) in [
            ("needsExecutionTool", own.needs_execution_tool),
            ("canHandleVariableCommunicationStepSize", own.can_handle_variable_communication_step_size),
            ("canBeInstantiatedOnlyOncePerProcess", own.can_be_instantiated_only_once_per_process),
            (either("canGetAndSetFMUstate", "canGetAndSetFMUState"), own.can_get_and_set_state),
            (either("canSerializeFMUstate", "canSerializeFMUState"), own.can_serialize_state),
            (
                either("providesDirectionalDerivative", "providesDirectionalDerivatives"),
                own.provides_directional_derivatives,
            ),
        ] {
            element.set_some(name, flag.then_some(true));
        }
        let order = own.max_output_derivative_order;
        element.set_some("maxOutputDerivativeOrder", (order > 0).then_some(order));
        if is_two {
            element.set_some("canInterpolateInputs", own.can_interpolate_inputs.then_some(true));
        } else {
            element.set_some("fixedInternalStepSize", own.fixed_internal_step_size.map(Number));
            for (name, flag) in [
                ("hasEventMode", own.has_event_mode),
                ("providesIntermediateUpdate", own.provides_intermediate_update),
                ("mightReturnEarlyFromDoStep", own.might_return_early_from_do_step),
                ("canReturnEarlyAfterIntermediateUpdate", own.can_return_early_after_intermediate_update),
            ] {
                element.set_some(name, flag.then_some(true));
            }
        }
        xml.leaf(element);
    }

    /// Attributes of a variable that both versions write alike.
    fn heading(element: &mut Element, variable: &Variable) {
        element.set("name", &variable.name).set("valueReference", variable.value_reference);
        element.set_text("description", &variable.description);
        element.set("causality", variable.causality.name()).set("variability", variable.variability.name());
        // Inputs have a start value and no choice of `initial`.
        let initial = variable.initial.filter(|_| variable.causality != Causality::Input);
        element.set_some("initial", initial.map(Choice::name));
    }

    /// Bounds, nominal value and unit of a variable.
    fn numeric(&self, element: &mut Element, variable: &Variable) {
        element.set_text("declaredType", &variable.declared_type);
        element.set_text("quantity", &variable.quantity);
        let bound =
            |bound: f64| if variable.data_type.is_float() { Number(bound).to_string() } else { bound.to_string() };
        if variable.data_type.is_float() {
            element.set_some("unit", variable.unit.and_then(|at| self.units.get(at)).map(|unit| &unit.name));
            element.set_text("displayUnit", &variable.display_unit);
            element.set_some("relativeQuantity", variable.is_relative.then_some(true));
        }
        element.set_some("min", variable.min.map(bound)).set_some("max", variable.max.map(bound));
        element.set_some("nominal", variable.nominal.filter(|_| variable.data_type.is_float()).map(Number));
    }

    /// A variable of FMI 2.0, which is a scalar of one of five types.
    fn scalar(&self, xml: &mut Xml, variable: &Variable) {
        let mut element = Element::new("ScalarVariable");
        Self::heading(&mut element, variable);
        xml.within(element, |xml| {
            let mut own = Element::new(match variable.data_type {
                DataType::Float32 | DataType::Float64 => "Real",
                DataType::Boolean => "Boolean",
                DataType::String | DataType::Binary | DataType::Clock => "String",
                DataType::Enumeration => "Enumeration",
                _ => "Integer",
            });
            self.numeric(&mut own, variable);
            own.set_some("derivative", variable.derivative_of.map(|at| at + 1));
            own.set_some("start", variable.start.as_ref().map(words));
            xml.leaf(own);
        });
    }

    fn variable_of_three(&self, xml: &mut Xml, variable: &Variable) {
        let mut element = Element::new(variable.data_type.name());
        Self::heading(&mut element, variable);
        self.numeric(&mut element, variable);
        let reference = |at: usize| self.variables.get(at).map(|one| one.value_reference);
        element.set_some("derivative", variable.derivative_of.and_then(reference));
        if let Some(ticks) = variable.ticks {
            element.set("intervalVariability", ticks.variability.name());
            element.set_some("intervalDecimal", ticks.interval.map(Number));
            element.set_some("shiftDecimal", (ticks.shift > 0.0).then_some(Number(ticks.shift)));
        }
        element.set_some("clocks", (!variable.clocks.is_empty()).then(|| list(&variable.clocks)));
        let texts: Vec<String> = match &variable.start {
            Some(Values::String(all)) => all.clone(),
            Some(Values::Binary(all)) => all.iter().map(|bytes| hexadecimal(bytes)).collect(),
            Some(start) => {
                element.set("start", words(start));
                vec![]
            }
            None => vec![],
        };
        if texts.is_empty() && variable.dimensions.is_empty() && variable.aliases.is_empty() {
            return xml.leaf(element);
        }
        xml.within(element, |xml| {
            for dimension in &variable.dimensions {
                let mut one = Element::new("Dimension");
                match dimension {
                    Dimension::Fixed(extent) => one.set("start", extent),
                    Dimension::Structural(at) => one.set_some("valueReference", reference(*at)),
                };
                xml.leaf(one);
            }
            for text in &texts {
                let mut one = Element::new("Start");
                one.set("value", text);
                xml.leaf(one);
            }
            for alias in &variable.aliases {
                let mut one = Element::new("Alias");
                one.set("name", &alias.name).set_text("description", &alias.description);
                one.set_text("displayUnit", &alias.display_unit);
                xml.leaf(one);
            }
        });
    }

    fn structure(&self, xml: &mut Xml) {
        let ModelStructure { outputs, derivatives, initial_unknowns } = &self.structure;
        xml.within(Element::new("ModelStructure"), |xml| match self.version {
            Version::Two => {
                for (name, all) in
                    [("Outputs", outputs), ("Derivatives", derivatives), ("InitialUnknowns", initial_unknowns)]
                {
                    xml.group(name, all, |xml, one| self.unknown("Unknown", xml, one));
                }
            }
            Version::Three => {
                for (name, all) in [
                    ("Output", outputs),
                    ("ContinuousStateDerivative", derivatives),
                    ("InitialUnknown", initial_unknowns),
                ] {
                    for one in all {
                        self.unknown(name, xml, one);
                    }
                }
            }
        });
    }

    fn unknown(&self, name: &'static str, xml: &mut Xml, unknown: &Unknown) {
        let mut element = Element::new(name);
        let number = |at: usize| match self.version {
            Version::Two => u32::try_from(at + 1).ok(),
            Version::Three => self.variables.get(at).map(|one| one.value_reference),
        };
        let attribute = if self.version == Version::Two { "index" } else { "valueReference" };
        element.set_some(attribute, number(unknown.variable));
        if let Some(all) = &unknown.dependencies {
            let numbers: Vec<u32> = all.iter().filter_map(|(at, _)| number(*at)).collect();
            element.set("dependencies", list(&numbers));
            if all.iter().any(|(_, kind)| *kind != DependencyKind::Dependent) {
                element.set("dependenciesKind", list(all.iter().map(|(_, kind)| kind.name())));
            }
        }
        xml.leaf(element);
    }
}

fn unit(xml: &mut Xml, unit: &Unit) {
    let mut element = Element::new("Unit");
    element.set("name", &unit.name);
    if unit.base.is_none() && unit.display.is_empty() {
        return xml.leaf(element);
    }
    xml.within(element, |xml| {
        if let Some(base) = &unit.base {
            let mut own = Element::new("BaseUnit");
            let e = base.exponents;
            for (name, exponent) in [
                ("kg", e.kg),
                ("m", e.m),
                ("s", e.s),
                ("A", e.a),
                ("K", e.k),
                ("mol", e.mol),
                ("cd", e.cd),
                ("rad", e.rad),
            ] {
                own.set_some(name, (exponent != 0).then_some(exponent));
            }
            own.set_scale(base.factor, base.offset);
            xml.leaf(own);
        }
        for display in &unit.display {
            let mut own = Element::new("DisplayUnit");
            own.set("name", &display.name).set_scale(display.factor, display.offset);
            own.set_some("inverse", display.inverse.then_some(true));
            xml.leaf(own);
        }
    });
}

fn enumeration(version: Version, xml: &mut Xml, enumeration: &Enumeration) {
    let items = |xml: &mut Xml| {
        for item in &enumeration.items {
            let mut one = Element::new("Item");
            one.set("name", &item.name).set("value", item.value).set_text("description", &item.description);
            xml.leaf(one);
        }
    };
    match version {
        Version::Two => {
            let mut own = Element::new("SimpleType");
            own.set("name", &enumeration.name);
            xml.within(own, |xml| xml.within(Element::new("Enumeration"), items));
        }
        Version::Three => {
            let mut own = Element::new("EnumerationType");
            own.set("name", &enumeration.name);
            xml.within(own, items);
        }
    }
}

/// Start values as a list; for texts, the first.
fn words(values: &Values) -> String {
    match values {
        Values::Float(all) => list(all.iter().copied().map(Number)),
        Values::Integer(all) => list(all),
        Values::Boolean(all) => list(all),
        Values::String(all) => all.first().cloned().unwrap_or_default(),
        Values::Binary(all) => all.first().map(|bytes| hexadecimal(bytes)).unwrap_or_default(),
    }
}

fn list<T: Display>(all: impl IntoIterator<Item = T>) -> String {
    all.into_iter().map(|one| one.to_string()).collect::<Vec<_>>().join(" ")
}

fn hexadecimal(bytes: &[u8]) -> String {
    bytes.iter().fold(String::new(), |mut text, byte| {
        // A `String` takes everything.
        let _ = write!(text, "{byte:02x}");
        text
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Oracle: the reader. A description that was read, written and read again is the same.
    #[test]
    fn what_is_written_is_read_as_it_was() {
        for (version, text) in [(Version::Two, TWO), (Version::Three, THREE)] {
            let read = ModelDescription::read(text, "first").unwrap_or_else(|error| panic!("{error}"));
            assert_eq!(read.version, version);
            let again =
                ModelDescription::read(&read.write(), "again").unwrap_or_else(|e| panic!("{e}\n{}", read.write()));
            assert_eq!(again, read, "{}", read.write());
        }
    }

    const TWO: &str = r#"<fmiModelDescription fmiVersion="2.0" modelName="a &lt; b" guid="{1}" description="x&#10;y" license="MIT">
<CoSimulation modelIdentifier="m" canGetAndSetFMUstate="true" canInterpolateInputs="true" maxOutputDerivativeOrder="2"/>
<UnitDefinitions>
<Unit name="rpm"><BaseUnit rad="1" s="-1" factor="0.10471975511965977"/><DisplayUnit name="1/s" factor="0.016666666666666666"/></Unit>
<Unit name="degC"><BaseUnit K="1" offset="273.15"/></Unit><Unit name="bare"/></UnitDefinitions>
<TypeDefinitions><SimpleType name="E"><Enumeration><Item name="one" value="1"/><Item name="two" value="7" description="d"/></Enumeration>
</SimpleType></TypeDefinitions>
<LogCategories><Category name="logStatusError"/></LogCategories>
<DefaultExperiment startTime="0.5" stepSize="6.25e-5"/>
<ModelVariables>
<ScalarVariable name="u" valueReference="0" causality="input" variability="continuous"><Real unit="rpm" displayUnit="1/s" start="1.5" min="-3" max="4.0"/></ScalarVariable>
<ScalarVariable name="y.a" valueReference="1" causality="output" variability="continuous" initial="calculated"><Real unit="degC" relativeQuantity="true" nominal="2.0"/></ScalarVariable>
<ScalarVariable name="n" valueReference="2" causality="parameter" variability="fixed"><Integer start="-4" min="-5" max="9"/></ScalarVariable>
<ScalarVariable name="e" valueReference="3" causality="parameter" variability="fixed"><Enumeration declaredType="E" start="7"/></ScalarVariable>
<ScalarVariable name="b" valueReference="4" causality="parameter" variability="tunable"><Boolean start="true"/></ScalarVariable>
<ScalarVariable name="s" valueReference="5" causality="parameter" variability="fixed"><String start="a &quot;b&quot;"/></ScalarVariable>
</ModelVariables>
<ModelStructure><Outputs><Unknown index="2" dependencies="1" dependenciesKind="constant"/></Outputs>
<InitialUnknowns><Unknown index="2" dependencies=""/></InitialUnknowns></ModelStructure></fmiModelDescription>"#;

    const THREE: &str = r#"<fmiModelDescription fmiVersion="3.0" modelName="m" instantiationToken="{2}">
<CoSimulation modelIdentifier="m" fixedInternalStepSize="1e-3" hasEventMode="true" mightReturnEarlyFromDoStep="true"/>
<TypeDefinitions><EnumerationType name="E"><Item name="one" value="1"/></EnumerationType></TypeDefinitions>
<ModelVariables>
<Float64 name="time" valueReference="0" causality="independent" variability="continuous"/>
<UInt64 name="n" valueReference="9" causality="structuralParameter" variability="fixed" start="2"/>
<Float64 name="a" valueReference="1" causality="input" variability="continuous" start="1.0 2.5"><Dimension valueReference="9"/></Float64>
<Int8 name="i" valueReference="2" causality="output" variability="discrete" initial="calculated"/>
<String name="s" valueReference="3" causality="parameter" variability="fixed"><Start value="x y"/></String>
<Binary name="raw" valueReference="4" causality="parameter" variability="fixed"><Start value="00ff"/></Binary>
<Enumeration name="e" valueReference="5" declaredType="E" causality="parameter" variability="fixed" start="1"><Alias name="also e"/></Enumeration>
<Boolean name="b" valueReference="6" causality="input" variability="discrete" start="false"/>
</ModelVariables>
<ModelStructure><Output valueReference="2" dependencies="1 6" dependenciesKind="dependent constant"/>
<InitialUnknown valueReference="2"/></ModelStructure></fmiModelDescription>"#;
}
