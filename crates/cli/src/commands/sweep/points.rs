//! The points of a sweep as runs of a suite.
use crate::args::{Keep, SweepArgs};
use crate::build_id;
use crate::console::say;
use crate::error::CliError;
use crate::outputs::reads;
use crate::sources::{self, SWEEP};
use crate::suite::{NotReady, Plan};
use servobench_config::Choice as _;
use servobench_metrics::Name;
use servobench_plant::EngineName;
use servobench_results::{Digest, Digester, Planned, RunIdentity, Unfinished, printable, printable_lines};
use servobench_scenario::{
    Document, LoadError, Override, OverrideError, Seed, Step, SweepRequest, load_sweep, root_of,
};
use servobench_suite::{Job, Source, equal_length, file_name};
use servobench_sweep::{Setting, Sweep};
use std::borrow::Cow;
use std::collections::HashMap;
use std::ffi::OsStr;
use std::path::{Path, PathBuf};
use std::sync::{Mutex, PoisonError};

/// Most combinations for which all are read before the first run; of more, each value is read once.
const MOST_CHECKED: usize = 1_000;

/// Number of seeds that distinguishes a difference from chance.
const ENOUGH_SEEDS: usize = 5;

/// The points of a sweep: on the first engine, then on the next one.
pub(super) struct Points<'a> {
    args: &'a SweepArgs,
    request: SweepRequest,
    engines: Vec<EngineName>,
    /// The scenario without the sweep.
    base: Source,
    /// The file of that scenario.
    document: Document,
    /// Prefix of the names of the runs.
    stem: String,
    /// Digests of the files that scenarios name, as they were when they were first read.
    files: Mutex<HashMap<String, String>>,
}

impl<'a> Points<'a> {
    /// The points of the sweep file at `path`.
    pub(super) fn of(path: &Path, args: &'a SweepArgs) -> Result<Self, CliError> {
        reads(path, format_args!("the sweep {}", path.display()));
        let request = load_sweep(path)?;
        let given = args.suite.with.root.as_deref();
        let folder = path.parent().unwrap_or_else(|| Path::new(""));
        let root =
            root_of(folder, given).map_err(|error| CliError::Read { path: given.unwrap_or(path).to_owned(), error })?;
        let (document, base) = sources::base(&request.scenario, &args.suite.with.overrides, &root)?;
        let engines = [&args.suite.engine, &request.engines, &base.scenario.engines];
        let engines = engines.into_iter().find(|engines| !engines.is_empty()).cloned().unwrap_or_default();
        let stem = file_name(&base.scenario.name);
        let points = Self { args, request, engines, base, document, stem, files: Mutex::default() };
        points.check()?;
        Ok(points)
    }

    pub(super) const fn sweep(&self) -> &Sweep {
        &self.request.sweep
    }

    pub(super) fn description(&self) -> &str {
        &self.request.description
    }

    /// True if a run can fail by its metrics: the scenario has limits.
    pub(super) fn is_judged(&self) -> bool {
        let of_moves = |step: &Step| matches!(step, Step::Move(step) if !step.metric_limits.is_empty());
        let scenario = &self.base.scenario;
        !scenario.limits.is_empty() || scenario.program.iter().any(of_moves)
    }

    /// Largest difference of vibrations that count as equal (axis unit).
    pub(super) fn equal_length(&self) -> f64 {
        let engine = self.engines.first().copied().unwrap_or_default();
        equal_length(&[Job::new(self.stem.clone(), self.base.clone(), engine)])
    }

    /// Key of a seed of the scenario with too few values to distinguish a difference from chance; `None` where it has no seed, or where one
    /// has enough.
    pub(super) fn too_few_seeds(&self) -> Option<String> {
        let seeds = self.base.scenario.seeds();
        let has_enough = |seed: &Seed| {
            let is_it = |key: &str| key.replace('[', ".").replace(']', "") == seed.key;
            let axes = self.sweep().axes().iter().any(|axis| is_it(&axis.key) && axis.values.len() >= ENOUGH_SEEDS);
            let drawn = self.sweep().draws().is_some_and(|draws| draws.keys().iter().any(|drawn| is_it(&drawn.key)));
            axes || drawn
        };
        if seeds.iter().any(has_enough) { None } else { seeds.into_iter().next().map(|seed| seed.key) }
    }

    /// True if a metric was requested.
    pub(super) fn is_asked(&self, metric: Name) -> bool {
        self.request.metrics.is_empty() || self.request.metrics.contains(&metric)
    }

    pub(super) fn engines(&self) -> Vec<String> {
        self.engines.iter().map(|engine| engine.name().to_owned()).collect()
    }

    /// Number of runs.
    pub(super) fn len(&self) -> usize {
        self.sweep().points() * self.engines.len()
    }

    /// Names, files and engines of the runs.
    pub(super) fn planned(&self) -> Planned {
        let scenario = &self.base.scenario;
        let file = scenario.path.as_ref().map(|path| path.display().to_string());
        let of = |engine: &EngineName| Unfinished {
            name: scenario.name.clone(),
            file: file.clone(),
            engine: engine.name().to_owned(),
            axis: scenario.axis.name,
        };
        Planned::repeated(self.engines.iter().map(of).collect(), self.sweep().points())
    }

    /// Stems of the files that the runs leave.
    pub(super) fn stems(&self) -> Vec<String> {
        let leaves_any = self.args.keep != Keep::None;
        (0..self.len()).filter(|_| leaves_any).map(|index| self.id(index).into_owned()).collect()
    }

    /// True if a run has the name `id`.
    pub(super) fn has_id(&self, id: &str) -> bool {
        let number = || id.strip_prefix(&self.stem)?.strip_prefix('-')?.split_once('.')?.0.parse::<usize>().ok();
        number().is_some_and(|number| (1..=self.sweep().points()).contains(&number))
    }

    /// Digest of the runs in their order, and of the files that they are to leave.
    pub(super) fn digest(&self) -> Digest {
        let start = Digester::default().with(build_id::program()).with(format!("{:?}", self.args.keep));
        let start = start.with(format!("{}", self.args.suite.rrd)).with(&self.request.text).with(&self.base.text);
        let overrides = &self.args.suite.with.overrides;
        let start = overrides.iter().fold(start, |digester, one| digester.with(one.to_string()));
        let start = self.engines.iter().fold(start, |digester, engine| digester.with(engine.name()));
        self.base.scenario.made_of.iter().fold(start, |digester, file| digester.with(&file.sha256)).finish()
    }

    /// Keys that vary in the run at `index`, with their values.
    fn settings(&self, index: usize) -> Vec<Setting<'_>> {
        self.sweep().settings(index % self.sweep().points())
    }

    /// The engine of the run at `index`.
    fn engine(&self, index: usize) -> EngineName {
        self.engines.get(index / self.sweep().points()).copied().unwrap_or_default()
    }

    /// The scenario of the run at `index`.
    fn source(&self, index: usize) -> Result<Source, NotReady> {
        let mut overrides = self.args.suite.with.overrides.clone();
        for setting in self.settings(index) {
            let wrong = |error: OverrideError| NotReady::Invalid(vec![format!("`{}`: {error}", setting.written())]);
            let set = |key| Override::new(key, &setting.value);
            overrides.extend(self.request.keys.get(setting.key).map(set).transpose().map_err(wrong)?);
        }
        let source = sources::varied(&self.document, &overrides).map_err(NotReady::from)?;
        let mut files = self.files.lock().unwrap_or_else(PoisonError::into_inner);
        for file in &source.scenario.made_of {
            if let Some(known) = files.get(&file.path) {
                if *known != file.sha256 {
                    return Err(NotReady::Changed);
                }
            } else {
                files.insert(file.path.clone(), file.sha256.clone());
            }
        }
        Ok(source)
    }

    /// Reads combinations before anything runs. An invalid one does not stop the others; if all are invalid, the sweep is.
    fn check(&self) -> Result<(), CliError> {
        let places = self.sweep().cover(MOST_CHECKED);
        let refusals: Vec<(usize, NotReady)> =
            places.iter().filter_map(|index| Some((*index, self.source(*index).err()?))).collect();
        let Some((index, first)) = refusals.first() else { return Ok(()) };
        let point = self.settings(*index).iter().map(Setting::written).collect::<Vec<_>>().join(", ");
        let why = first.to_string();
        if refusals.len() == places.len() {
            return Err(CliError::NoValidPoint { checked: places.len(), point, why });
        }
        let of = format!("{} of the {} points that were tried are invalid", refusals.len(), places.len());
        let first = format!("the first with {}:\n{}", printable(&point), printable_lines(&why));
        say(&format!("servobench: {of}, {first}\n"));
        Ok(())
    }
}

impl From<LoadError> for NotReady {
    fn from(error: LoadError) -> Self {
        Self::Invalid(sources::reasons(&error))
    }
}

impl Plan for Points<'_> {
    fn places(&self) -> Box<dyn Iterator<Item = usize> + '_> {
        Box::new(0..self.len())
    }

    fn id(&self, index: usize) -> Cow<'_, str> {
        let number = index % self.sweep().points() + 1;
        format!("{}-{number}.{}", self.stem, self.engine(index)).into()
    }

    fn job(&self, index: usize) -> Result<Job, NotReady> {
        let mut job = Job::new(self.id(index).into_owned(), self.source(index)?, self.engine(index));
        if self.args.keep == Keep::None {
            job.leave_recording_out();
        }
        if !self.request.metrics.is_empty() {
            job.measure_only(&self.request.metrics);
        }
        Ok(job)
    }

    fn identity(&self, index: usize) -> RunIdentity {
        let own = &self.args.suite.with.overrides;
        let overrides = own.iter().map(ToString::to_string);
        let overrides = overrides.chain(self.settings(index).iter().map(Setting::written)).collect();
        RunIdentity { overrides, ..RunIdentity::default() }
    }

    fn is_sweep(&self) -> bool {
        true
    }
}

/// Default folder of a sweep's results, named after its file.
pub(super) fn default_folder(path: &Path) -> PathBuf {
    let name = path.file_name().and_then(OsStr::to_str).unwrap_or("sweep");
    let name = name.strip_suffix(SWEEP).or_else(|| name.strip_suffix(".toml")).unwrap_or(name);
    Path::new("servobench-out").join(file_name(name))
}
