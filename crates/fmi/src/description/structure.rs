//! Dependencies between variables.
use super::element::Element;
use super::{Version, variable::Variable};
use crate::error::{DescriptionProblem, FmuError};
use servobench_config::Choice as _;
use std::collections::HashMap;

servobench_config::choices! {
    /// How an unknown depends on a variable.
    pub enum DependencyKind {
        /// somehow
        Dependent = "dependent",
        /// linearly, by a constant factor
        Constant = "constant",
        /// linearly, by a factor of fixed parameters
        Fixed = "fixed",
        /// linearly, by a factor of tunable parameters
        Tunable = "tunable",
        /// linearly, by a factor that changes at events
        Discrete = "discrete",
    }
}

/// Dependencies of an unknown. Variables are given by their position in [`crate::ModelDescription::variables`].
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Unknown {
    /// The variable.
    pub variable: usize,
    /// Variables it depends on; `None` if it may depend on any.
    pub dependencies: Option<Vec<(usize, DependencyKind)>>,
}

/// The unknowns of an FMU.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub struct ModelStructure {
    /// Outputs.
    pub outputs: Vec<Unknown>,
    /// Derivatives of continuous states.
    pub derivatives: Vec<Unknown>,
    /// Variables computed during initialisation.
    pub initial_unknowns: Vec<Unknown>,
}

impl ModelStructure {
    /// True if an output may follow an input at once, without a step; also where the FMU does not exclude it.
    #[must_use]
    pub fn feeds_through(&self, output: usize, input: usize) -> bool {
        let unknown = self.outputs.iter().find(|unknown| unknown.variable == output);
        let dependencies = unknown.and_then(|unknown| unknown.dependencies.as_ref());
        dependencies.is_none_or(|all| all.iter().any(|(variable, _)| *variable == input))
    }

    pub(super) fn read(root: Element, version: Version, variables: &[Variable]) -> Result<Self, FmuError> {
        let Some(element) = root.child("ModelStructure") else {
            let parent = root.name().to_owned();
            return Err(root.error(DescriptionProblem::NoElement { parent, expected: "`<ModelStructure>`" }));
        };
        let known = Known::of(version, variables);
        let all = |group: &str, name: &str| -> Result<Vec<_>, FmuError> {
            match version {
                Version::Two => element.grandchildren(group).map(|unknown| known.unknown(unknown)).collect(),
                Version::Three => element
                    .children()
                    .filter(|child| child.name() == name)
                    .map(|unknown| known.unknown(unknown))
                    .collect(),
            }
        };
        Ok(Self {
            outputs: all("Outputs", "Output")?,
            derivatives: all("Derivatives", "ContinuousStateDerivative")?,
            initial_unknowns: all("InitialUnknowns", "InitialUnknown")?,
        })
    }
}

/// References from unknowns to variables.
enum Known {
    /// By the position from 1 (FMI 2.0).
    Positions(usize),
    /// By the value reference (FMI 3.0).
    References(HashMap<u32, usize>),
}

impl Known {
    fn of(version: Version, variables: &[Variable]) -> Self {
        match version {
            Version::Two => Self::Positions(variables.len()),
            Version::Three => {
                Self::References(variables.iter().enumerate().map(|(at, one)| (one.value_reference, at)).collect())
            }
        }
    }

    fn position(&self, number: u32) -> Option<usize> {
        match self {
            Self::Positions(count) => usize::try_from(number).ok()?.checked_sub(1).filter(|at| at < count),
            Self::References(known) => known.get(&number).copied(),
        }
    }

    fn unknown(&self, element: Element) -> Result<Unknown, FmuError> {
        let (attribute, expected) = match self {
            Self::Positions(count) => ("index", format!("the position of a variable, 1 to {count}")),
            Self::References(_) => ("valueReference", "the value reference of a variable".to_owned()),
        };
        element.required(attribute)?;
        let variable = element.read(attribute, &expected, |text| self.position(text.parse().ok()?))?;
        let Some(variable) = variable else { return Err(element.wrong(attribute, expected)) };
        let Some(numbers) = element.references("dependencies")? else {
            return Ok(Unknown { variable, dependencies: None });
        };
        let positions: Option<Vec<_>> = numbers.iter().map(|number| self.position(*number)).collect();
        let Some(positions) = positions else {
            return Err(element.wrong("dependencies", format!("of each number: {expected}")));
        };
        let kinds = match element.text("dependenciesKind") {
            None => vec![DependencyKind::Dependent; positions.len()],
            Some(text) => {
                let kinds: Option<Vec<_>> = text.split_ascii_whitespace().map(DependencyKind::from_name).collect();
                kinds.filter(|kinds| kinds.len() == positions.len()).ok_or_else(|| {
                    element
                        .wrong("dependenciesKind", format!("a kind for each of the {} dependencies", positions.len()))
                })?
            }
        };
        Ok(Unknown { variable, dependencies: Some(positions.into_iter().zip(kinds).collect()) })
    }
}
