//! A scenario file that is read once for any number of sets of overrides.
use crate::access::FileAccess;
use crate::axis_name::axis_name;
use crate::diagnostic::{Invalid, LoadError, Report};
use crate::display_units::display_units;
use crate::field::Field;
use crate::file::File;
use crate::load::{Loaded, all_errors, in_order, motions};
use crate::models::lay_on_models;
use crate::overrides::{Override, Overriding};
use crate::parameters::parameters;
use crate::resolve;
use crate::scenario::AxisMechanics;
use crate::source::{Place, SourceId, Sources, Span};
use crate::tree::{self, Node, Table, Value};
use crate::{foreign, format};
use std::ops::Range;
use std::path::{Path, PathBuf};

/// A scenario file, read and parsed. Each set of [`Override`]s makes a scenario of it.
#[derive(Debug, Clone)]
pub struct Document {
    /// Its name in messages.
    name: String,
    /// The path, if it came from a file.
    path: Option<PathBuf>,
    /// The file itself.
    own: Reading,
    /// The file merged with the models it names.
    laid_on_models: Reading,
}

/// The tree of a scenario that is not resolved yet, and the diagnostics so far.
#[derive(Debug, Clone)]
struct Reading {
    sources: Sources,
    table: Table,
    report: Report,
    /// Syntax errors.
    syntax: Report,
    /// Lines with syntax errors.
    broken: Vec<(SourceId, Range<usize>)>,
}

impl Document {
    /// Reads the scenario file at `path`. The file and every file it names must be below the folder `root`, links resolved; without `root`,
    /// below the nearest folder from the scenario upwards that has a `.git`, or else below the scenario's own folder.
    ///
    /// # Errors
    /// [`LoadError::Read`] when the file cannot be read, [`LoadError::Invalid`] for a file written by a later version.
    pub fn open(path: &Path, root: Option<&Path>) -> Result<Self, LoadError> {
        let unreadable = |error| LoadError::Read { path: path.to_owned(), error };
        let folder = path.parent().unwrap_or_else(|| Path::new(""));
        let mut files = access(path, folder, root)?;
        let text = files.scenario(path).map_err(unreadable)?;
        let document = Self::parsed(&path.display().to_string(), &text, Some(folder), files)?;
        Ok(Self { path: Some(path.to_owned()), ..document })
    }

    /// Reads a scenario from `text`; `name` stands for the file in messages, and its stem is the default name of the scenario.
    /// Models and files are looked up from `folder`, below `root` as in [`open`](Self::open); without a folder, models are looked up
    /// among the embedded ones only, and no file is read.
    ///
    /// # Errors
    /// Those of [`open`](Self::open); [`LoadError::Read`] when `root` does not exist.
    pub fn parse(name: &str, text: &str, folder: Option<&Path>, root: Option<&Path>) -> Result<Self, LoadError> {
        let mut files = match folder {
            // A folder that does not exist has no file to read.
            Some(folder) if root.is_some() || folder.as_os_str().is_empty() || folder.exists() => {
                access(Path::new(name), folder, root)?
            }
            _ => FileAccess::default(),
        };
        let own = Path::new(name).file_name().map_or_else(|| name.into(), std::ffi::OsStr::to_string_lossy);
        files.note_scenario(&own, text);
        Self::parsed(name, text, folder, files)
    }

    fn parsed(name: &str, text: &str, folder: Option<&Path>, files: FileAccess) -> Result<Self, LoadError> {
        let mut sources = Sources::default();
        let place = folder.map_or_else(|| Place::Embedded("".into()), |folder| Place::Folder(folder.to_owned()));
        let id = sources.add(name.to_owned(), text.to_owned(), place);

        let mut syntax = Report::default();
        let parsed = tree::parse(id, text, &mut syntax);
        let broken = parsed.broken.into_iter().map(|line| (id, line)).collect();
        let mut report = Report { files, ..Report::default() };
        if let Some(diagnostic) = format::newer(&parsed.table) {
            // Further messages about a format that this build does not know would mislead.
            let (diagnostics, warnings) = (vec![diagnostic], Vec::new());
            return Err(LoadError::Invalid(Box::new(Invalid { diagnostics, warnings, sources })));
        }
        format::warn_of_older(&parsed.table, &mut report);
        let own = Reading { sources, table: parsed.table, report, syntax, broken };
        let mut laid_on_models = own.clone();
        laid_on_models.lay_on_models();
        Ok(Self { name: name.to_owned(), path: None, own, laid_on_models })
    }

    /// The path, if the scenario came from a file.
    #[must_use]
    pub fn path(&self) -> Option<&Path> {
        self.path.as_deref()
    }

    /// The same document with the path `path`, for a file read by other means.
    #[must_use]
    pub fn at(self, path: &Path) -> Self {
        Self { path: Some(path.to_owned()), ..self }
    }

    /// Text of the scenario file.
    #[must_use]
    pub fn text(&self) -> &str {
        self.own.sources.text(SourceId::SCENARIO)
    }

    /// The scenario with the values of `overrides` in place of those of the file.
    ///
    /// # Errors
    /// [`LoadError::Invalid`] with every mistake in the file and in the overrides; [`LoadError::Read`] when a shortage of the operating
    /// system prevented the reading of a file that it names.
    pub fn scenario(&self, overrides: &[Override]) -> Result<Loaded, LoadError> {
        let mut reading =
            if overrides.iter().any(Override::chooses_a_model) { &self.own } else { &self.laid_on_models }.clone();
        let overriding = Overriding::new(overrides, &mut reading.sources, &mut reading.report);
        if overrides.iter().any(Override::chooses_a_model) {
            overriding.choose_models(&mut reading.table, &mut reading.report);
            reading.lay_on_models();
        }
        overriding.set(&mut reading.table, &mut reading.report);
        let mut loaded = reading.resolved(&self.name, overrides)?;
        loaded.scenario.path.clone_from(&self.path);
        Ok(loaded)
    }
}

impl Reading {
    fn lay_on_models(&mut self) {
        self.broken.extend(lay_on_models(&mut self.table, &mut self.sources, &mut self.report, &mut self.syntax));
    }

    /// The scenario that the tree describes; `name` stands for its file, and `overrides` are already in the tree.
    fn resolved(self, name: &str, overrides: &[Override]) -> Result<Loaded, LoadError> {
        let Self { mut sources, table, mut report, syntax, broken } = self;
        (report.axis, report.motor) = motions(&table);
        report.axis_name = axis_name(&table);
        let root = Node { value: Value::Table(table), span: Span::new(SourceId::SCENARIO, &(0..0)) };
        let scenario =
            File::decode("", &root, &(), &mut report).and_then(|file| resolve::scenario(&file, &sources, &mut report));

        let mut diagnostics = all_errors(syntax, &mut report, &broken);
        let mut warnings = in_order(std::mem::take(&mut report.warnings));
        foreign::shorten(&mut diagnostics, &sources);
        foreign::shorten(&mut warnings, &sources);
        // A shortage that prevented reading is not a mistake of the scenario.
        if !diagnostics.is_empty()
            && let Some((path, error)) = report.files.shortage()
        {
            return Err(LoadError::Read { path, error });
        }
        let Some(mut scenario) = scenario.filter(|_| diagnostics.is_empty()) else {
            return Err(LoadError::Invalid(Box::new(Invalid { diagnostics, warnings, sources })));
        };
        if scenario.name.is_empty() {
            scenario.name = Path::new(name).file_stem().unwrap_or_default().to_string_lossy().into_owned();
        }
        if let Value::Table(table) = &root.value {
            scenario.parameters = parameters(table, &sources);
            scenario.units = display_units(&scenario.parameters, scenario.axis.motion);
        }
        scenario.overrides = overrides.to_vec();
        scenario.warnings = warnings.iter().map(|warning| warning.placed_message(&sources)).collect();
        scenario.root = report.files.root().map(Path::to_owned);
        scenario.made_of = report.files.into_made_of();
        let mjcf = match &scenario.axis.mechanics {
            AxisMechanics::Mjcf(mjcf) => {
                Some(sources.add(mjcf.path.display().to_string(), mjcf.xml.clone(), Place::Embedded("".into())))
            }
            AxisMechanics::Bodies(_) | AxisMechanics::InTheFmu => None,
        };
        Ok(Loaded { scenario, warnings, sources, tables: report.tables, root, mjcf })
    }
}

/// Access to the files that the scenario at `path`, in `folder`, may read.
fn access(path: &Path, folder: &Path, root: Option<&Path>) -> Result<FileAccess, LoadError> {
    FileAccess::of_folder(folder, root).map_err(|error| {
        let path = root.unwrap_or(path).to_owned();
        LoadError::Read { path, error }
    })
}
