//! Exchanged variables of an FMU, and the conversion of their numbers to SI.
use crate::like::like;
use servobench_fmi::{
    BaseUnit, Causality, Choice, DataType, DeclaredNumber, DeclaredUnit, Exponents, FmuEntry, FmuMistake,
    ModelDescription, Port, SiPort, SiUnit, Variability, Variable,
};

/// Names of SI units that tools use without defining them, with the exponents of kilogram, metre, second and ampere.
const UNDEFINED: [(&[&str], [i32; 4]); 16] = [
    (&["", "1", "-", "rad"], [0, 0, 0, 0]),
    (&["m"], [0, 1, 0, 0]),
    (&["m/s", "m.s-1"], [0, 1, -1, 0]),
    (&["m/s2", "m/s^2", "m.s-2"], [0, 1, -2, 0]),
    (&["rad/s", "rad.s-1", "1/s", "s-1", "Hz"], [0, 0, -1, 0]),
    (&["rad/s2", "rad/s^2", "rad.s-2"], [0, 0, -2, 0]),
    (&["N"], [1, 1, -2, 0]),
    (&["N.m", "N*m", "N·m", "N m", "Nm", "J"], [1, 2, -2, 0]),
    (&["s"], [0, 0, 1, 0]),
    (&["kg"], [1, 0, 0, 0]),
    (&["A"], [0, 0, 0, 1]),
    (&["V"], [1, 2, -3, -1]),
    (&["W"], [1, 2, -3, 0]),
    (&["Ohm", "Ω"], [1, 2, -3, -2]),
    (&["N/m"], [1, 0, -2, 0]),
    (&["Pa", "N/m2"], [1, -1, -2, 0]),
];

/// An exchanged number and its unit.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Wire {
    pub(crate) port: Port,
    /// `None` for SI units.
    unit: Option<BaseUnit>,
    is_relative: bool,
    pub(crate) declared: DeclaredNumber,
}

impl Wire {
    pub(crate) fn to_si(&self, value: f64) -> f64 {
        self.unit.map_or(value, |unit| unit.to_si(value, self.is_relative))
    }

    pub(crate) fn of_si(&self, si: f64) -> f64 {
        self.unit.map_or(si, |unit| unit.from_si(si, self.is_relative))
    }

    /// A value and its time derivatives.
    pub(crate) fn of_si_in_motion(&self, [value, first, second]: [f64; 3]) -> [f64; 3] {
        let rate = |si| self.unit.map_or(si, |unit| unit.from_si(si, true));
        [self.of_si(value), rate(first), rate(second)]
    }
}

/// All exchanged variables of an FMU.
#[derive(Debug, Clone, PartialEq)]
pub struct Ports {
    pub(crate) inputs: Vec<Wire>,
    pub(crate) outputs: Vec<Wire>,
}

impl Ports {
    /// Looks up the variables.
    ///
    /// # Errors
    /// [`FmuMistake`] for each variable that does not fit.
    pub fn new<'a>(
        inputs: impl IntoIterator<Item = &'a SiPort>,
        outputs: impl IntoIterator<Item = &'a SiPort>,
        it: &ModelDescription,
    ) -> Result<Self, Vec<FmuMistake>> {
        let mut mistakes = Vec::new();
        let mut all = |ports: Vec<&SiPort>, side: &Side| -> Vec<Wire> {
            let wire = |port: &SiPort| match find(it, port, side) {
                Ok(wire) => Some(wire),
                Err(what) => {
                    mistakes.push(what.of((side.entry)(port.variable.clone())));
                    None
                }
            };
            ports.into_iter().filter_map(wire).collect()
        };
        let (inputs, outputs) =
            (all(inputs.into_iter().collect(), &INPUT), all(outputs.into_iter().collect(), &OUTPUT));
        if mistakes.is_empty() { Ok(Self { inputs, outputs }) } else { Err(mistakes) }
    }
}

/// Requirements of variables that are set, or read.
struct Side {
    entry: fn(String) -> FmuEntry,
    needed: &'static str,
    fits: fn(&Variable) -> bool,
}

const INPUT: Side = Side {
    entry: FmuEntry::Input,
    needed: "an input or a tunable parameter",
    fits: |variable| match variable.causality {
        Causality::Input => true,
        Causality::Parameter => variable.variability == Variability::Tunable,
        _ => false,
    },
};

const OUTPUT: Side = Side {
    entry: FmuEntry::Output,
    needed: "an output or a local variable",
    fits: |variable| matches!(variable.causality, Causality::Output | Causality::Local),
};

/// The mistake, and the remedy.
struct What(String, String);

impl What {
    fn new(message: String, help: &str) -> Self {
        Self(message, help.to_owned())
    }

    fn of(self, at: FmuEntry) -> FmuMistake {
        FmuMistake { at, message: self.0, help: self.1 }
    }
}

fn find(it: &ModelDescription, wanted: &SiPort, side: &Side) -> Result<Wire, What> {
    let name = &wanted.variable;
    let (variable, element) = element(it, name, side)?;
    if !(side.fits)(variable) {
        let what = format!("`{}` of the FMU is {}, not {}", variable.name, is(variable), side.needed);
        return Err(What::new(what, &names(it, name, side)));
    }
    if matches!(variable.data_type, DataType::String | DataType::Binary | DataType::Clock) {
        return Err(What::new(
            format!("`{name}` of the FMU is no number"),
            "connect a number, or set it as a parameter",
        ));
    }
    let unit = unit(it, variable, wanted.unit.as_ref())?;
    let port = Port { variable: variable.name.clone(), element };
    let declared = DeclaredNumber { data_type: variable.data_type, unit: declared_unit(it, variable) };
    Ok(Wire { port, unit, is_relative: variable.is_relative, declared })
}

/// Kind of a variable, in the terms of the standard.
fn is(variable: &Variable) -> String {
    let article = |word: &str| if word.starts_with(['a', 'e', 'i', 'o', 'u']) { "an" } else { "a" };
    match variable.causality {
        Causality::Input | Causality::Output => {
            let word = variable.causality.name();
            format!("{} {word}", article(word))
        }
        Causality::Local => "a local variable".into(),
        Causality::Independent => "the time".into(),
        Causality::Parameter | Causality::CalculatedParameter | Causality::StructuralParameter => {
            format!("a {} parameter", variable.variability.name())
        }
    }
}

/// The variable and the index of its element.
fn element<'a>(it: &'a ModelDescription, name: &str, side: &Side) -> Result<(&'a Variable, usize), What> {
    let unknown = || What(format!("the FMU has no variable `{name}`"), names(it, name, side));
    let (variable, indices) = if let Some(variable) = it.variable(name) {
        (variable, Vec::new())
    } else {
        let (variable, indices) = name.strip_suffix(']').and_then(|name| name.rsplit_once('[')).ok_or_else(unknown)?;
        let indices = indices.split(',').map(|index| index.trim().parse().unwrap_or(0)).collect();
        (it.variable(variable).ok_or_else(unknown)?, indices)
    };
    let shape = it.shape(variable);
    let fits = indices.len() == shape.len()
        && indices.iter().zip(&shape).all(|(index, length): (&u64, _)| (1..=*length).contains(index));
    if !fits {
        let what = format!("`{name}`: `{}` has the dimensions {shape:?}", variable.name);
        return Err(What::new(what, "name an element like `x[2]` or `x[2,1]`; indices count from 1"));
    }
    let element = indices.iter().zip(&shape).fold(0, |element, (index, length)| element * length + index - 1);
    Ok((variable, usize::try_from(element).unwrap_or(usize::MAX)))
}

/// The unit of a variable; an error if it does not measure the same as `wanted`.
fn unit(it: &ModelDescription, variable: &Variable, wanted: Option<&SiUnit>) -> Result<Option<BaseUnit>, What> {
    let Some(unit) = it.unit(variable) else { return Ok(None) };
    let name = &variable.name;
    let undefined = UNDEFINED.iter().find(|(names, _)| names.contains(&unit.name.as_str()));
    let (exponents, base) = match (unit.base, undefined) {
        (Some(base), _) => (mechanical(base.exponents), Some(base)),
        // Tools without unit definitions write only names; a name that is not of an SI unit would be taken for one.
        (None, Some((_, exponents))) => (Some(*exponents), None),
        (None, None) => {
            let what = format!("`{name}` of the FMU counts in `{}`, of which it does not say what that is", unit.name);
            return Err(What::new(what, "the model description lacks its `BaseUnit`: export it with one"));
        }
    };
    match wanted {
        Some(wanted) if exponents != Some(wanted.exponents) => {
            let what =
                format!("`{name}` of the FMU counts in `{}`, which cannot be turned into {}", unit.name, wanted.name);
            Err(What::new(what, "connect what it is a measure of"))
        }
        _ => Ok(base),
    }
}

/// The unit of a variable, either defined or a known name of an SI unit.
fn declared_unit(it: &ModelDescription, variable: &Variable) -> Option<DeclaredUnit> {
    let unit = it.unit(variable)?;
    let exponents = if let Some(base) = unit.base {
        base.exponents
    } else {
        let (_, [kg, m, s, a]) = UNDEFINED.iter().find(|(names, _)| names.contains(&unit.name.as_str()))?;
        Exponents { kg: *kg, m: *m, s: *s, a: *a, ..Exponents::default() }
    };
    (!unit.name.is_empty()).then(|| DeclaredUnit { name: unit.name.clone(), exponents })
}

/// Exponents of kilogram, metre, second and ampere, if all others except the radian's are zero.
pub(crate) fn mechanical(exponents: Exponents) -> Option<[i32; 4]> {
    let Exponents { kg, m, s, a, k, mol, cd, rad: _ } = exponents;
    ([k, mol, cd] == [0; 3]).then_some([kg, m, s, a])
}

/// Suggestions of its variables instead.
fn names(it: &ModelDescription, name: &str, side: &Side) -> String {
    let fitting = it.variables.iter().filter(|variable| (side.fits)(variable)).map(|variable| variable.name.as_str());
    match &like(name, fitting)[..] {
        [] => format!("it has no {}", side.needed.split_once(' ').map_or("", |(_, needed)| needed)),
        shown => format!("it has `{}`", shown.join("`, `")),
    }
}
