//! A scenario: loaded, its keys set, checked, run.
use crate::check::{objections, unmeasurable};
use crate::engines::{EngineMissing, Engines};
use crate::error::Error;
use crate::linear::Linear;
use crate::preview::{Preview, preview, warnings};
use crate::run::{Judging, Run, early_end};
use servobench_plant::Engine;
use servobench_scenario::{self as scenario, Document, Key, Override, embedded_demo};
use servobench_sim::{self as sim, MechanicsAtRest, NoFmus, mechanics_at_rest};
use servobench_sweep::Value;
use std::path::Path;
use std::sync::Arc;

/// An axis with its drive, its moves and its limits, as a scenario file describes it, with some of its keys set to other values.
///
/// A clone is cheap beside a run: the file is read once.
#[derive(Debug, Clone)]
pub struct Scenario {
    document: Arc<Document>,
    settings: Vec<Override>,
    resolved: scenario::Scenario,
}

impl Scenario {
    /// Loads the scenario file at `path`. Models are looked up in `models/` beside it, in up to four folders above, and among the embedded
    /// ones.
    ///
    /// # Errors
    /// [`Error::Scenario`] with every mistake in the file, each at its line.
    pub fn load(path: impl AsRef<Path>) -> Result<Self, Error> {
        Self::of(Document::open(path.as_ref(), None)?)
    }

    /// Reads a scenario from `text`, called `name` in messages. Models are looked up among the embedded ones; it cannot name files.
    ///
    /// # Errors
    /// As [`load`](Self::load).
    pub fn parse(name: &str, text: &str) -> Result<Self, Error> {
        Self::of(Document::parse(name, text, None, None)?)
    }

    /// The scenarios of the demo: one move of a flexible axis with a jerk limit, and with a snap limit.
    ///
    /// # Errors
    /// None: they are built in.
    pub fn demo() -> Result<Vec<Self>, Error> {
        embedded_demo().into_iter().map(|(name, text)| Self::parse(name, text)).collect()
    }

    fn of(document: Document) -> Result<Self, Error> {
        let resolved = document.scenario(&[])?.scenario;
        Ok(Self { document: Arc::new(document), settings: Vec::new(), resolved })
    }

    /// Sets `key`, as the reference of scenario files names it (`setpoint.jerk`, `program[0].move_to`), to `value`: a number with its unit
    /// `(200.0, "m/s3")`, a pure number, `true` or `false`, or a text as the file would have it.
    ///
    /// # Errors
    /// [`Error::Setting`] of a text that is not a key, [`Error::Scenario`] of a key that the scenario does not have, or a value that does
    /// not fit it. The scenario is then unchanged.
    pub fn set(&mut self, key: &str, value: impl Into<Value>) -> Result<&mut Self, Error> {
        *self = self.with([(key, value.into())])?;
        Ok(self)
    }

    /// The same scenario with several keys set at once: for values that fit only together.
    ///
    /// # Errors
    /// As [`set`](Self::set).
    pub fn with<'a>(&self, settings: impl IntoIterator<Item = (&'a str, Value)>) -> Result<Self, Error> {
        let mut all = self.settings.clone();
        for (key, value) in settings {
            let key: Key = key.parse()?;
            all.retain(|one| !one.key().is(&key));
            all.push(Override::new(&key, &value)?);
        }
        let resolved = self.document.scenario(&all)?.scenario;
        Ok(Self { document: Arc::clone(&self.document), settings: all, resolved })
    }

    /// The name of the scenario.
    #[must_use]
    pub fn name(&self) -> &str {
        &self.resolved.name
    }

    /// The scenario as the loop is built of it: every value in SI.
    #[must_use]
    pub const fn resolved(&self) -> &scenario::Scenario {
        &self.resolved
    }

    /// The first of its engines that this library has.
    ///
    /// # Errors
    /// [`Error::EngineMissing`] where it has none of them.
    pub fn engine(&self) -> Result<&'static dyn Engine, Error> {
        let engines = &self.resolved.engines;
        let found = engines.iter().find_map(|name| Engines::EMBEDDED.get(*name).ok());
        let missing = || EngineMissing::Build { name: engines.first().copied().unwrap_or_default() };
        Ok(found.ok_or_else(missing)?)
    }

    /// Checks that it can be built and that its limits can be measured, without running it. Returns warnings, each behind its place: moves
    /// beyond the capability of motor or inverter, modes too fast for the engine, unstable loops.
    ///
    /// # Errors
    /// [`Error::Refused`] with every reason why it cannot be built; [`Error::EngineMissing`].
    pub fn check(&self) -> Result<Vec<String>, Error> {
        let engine = self.engine()?;
        let mut found = objections(&self.resolved, engine, &NoFmus)?;
        if found.is_empty() {
            found = unmeasurable(&self.resolved);
        }
        if found.is_empty() { Ok(warnings(&self.resolved, engine.name())) } else { Err(Error::Refused(found)) }
    }

    /// Properties known without a run: duration, torque and voltage against the available ones, modes, margins of the loops, memory.
    ///
    /// # Errors
    /// [`Error::Build`] of moves or bodies that cannot be planned.
    pub fn preview(&self) -> Result<Preview, Error> {
        let model = self.engine().ok().and_then(|engine| self.model(engine));
        Ok(preview(&self.resolved, &self.resolved.engines, model.as_ref())?)
    }

    /// Runs it on its first engine, measures and judges it.
    ///
    /// # Errors
    /// [`Error::Build`], [`Error::EngineMissing`], [`Error::Failed`] where nothing is left to judge. A run whose mechanics diverge, or
    /// whose program gives up, is returned as not passed.
    pub fn run(&self) -> Result<Run, Error> {
        self.run_on(self.engine()?)
    }

    /// The same on an engine supplied by the caller. `mujoco` ends the process when its library meets an error: the program `servobench`
    /// runs it in a separate process.
    ///
    /// # Errors
    /// As [`run`](Self::run).
    pub fn run_on(&self, engine: &dyn Engine) -> Result<Run, Error> {
        let outcome = sim::Bench::new(&self.resolved, engine)?.run(&mut |_| {});
        let ended = outcome.failure.map(early_end).transpose()?;
        let model = self.model(engine);
        let judging = Judging { ended, model: model.as_ref(), ..Judging::default() };
        Run::judged(&self.resolved, outcome.recording, judging).map_err(Error::NotKept)
    }

    /// The linear loop of the drive around standstill: its poles, and the distance of its gains from instability.
    ///
    /// # Errors
    /// [`Error::Build`] where it cannot be built.
    pub fn linear(&self) -> Result<Linear, Error> {
        let model = self.engine().ok().and_then(|engine| self.model(engine));
        Linear::of(&self.resolved, model.as_ref())
    }

    fn model(&self, engine: &dyn Engine) -> Option<MechanicsAtRest> {
        mechanics_at_rest(&self.resolved, engine)
    }
}
