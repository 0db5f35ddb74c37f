//! Entries of a suite: runs, and files that cannot be used, in the order of the files.
use crate::args::{Keep, RunArgs};
use crate::error::CliError;
use crate::output;
use crate::sources::{self, Unusable};
use crate::suite::{Ledger, NotReady, Plan};
use servobench::Engines;
use servobench_plant::EngineName;
use servobench_results::{Digest, Digester, Finished, RunIdentity, RunResult, Unfinished};
use servobench_suite::{Job, JobIds, Source};
use std::borrow::Cow;
use std::path::Path;
use std::sync::Arc;

/// Entries of a suite. Every file is read once, and again when its turn comes, so that their number hardly affects memory.
pub(super) struct Wanted<'a> {
    args: &'a RunArgs,
    /// In the order of the suite.
    entries: Vec<Entry>,
    /// Their names, files and engines.
    planned: Vec<Unfinished>,
    /// Overrides of values in the files.
    overrides: Vec<String>,
}

enum Entry {
    Run(PlannedRun),
    /// A file that cannot be used.
    Unusable(Unusable),
}

/// A run that is to be made.
struct PlannedRun {
    id: String,
    origin: Origin,
    engine: EngineName,
    /// Digest of its inputs.
    inputs: Digest,
}

/// Origin of a scenario.
#[derive(Clone)]
enum Origin {
    File(Arc<Path>),
    Demo(Arc<Source>),
}

impl PlannedRun {
    /// The run; an error if its inputs have changed since the suite began.
    fn job(&self, args: &RunArgs) -> Result<Job, NotReady> {
        let source = match &self.origin {
            Origin::File(path) => sources::again(path, &args.suite.with).map_err(|_| NotReady::Changed)?,
            Origin::Demo(source) => source.as_ref().clone(),
        };
        let mut job = Job::new(self.id.clone(), source, self.engine);
        if args.keep == Keep::None {
            job.leave_recording_out();
        }
        if output::inputs_of(&job) == self.inputs { Ok(job) } else { Err(NotReady::Changed) }
    }
}

impl Plan for Wanted<'_> {
    fn places(&self) -> Box<dyn Iterator<Item = usize> + '_> {
        Box::new((0..self.len()).filter(|index| self.run(*index).is_some()))
    }

    fn id(&self, index: usize) -> Cow<'_, str> {
        self.run(index).map_or("", |run| &run.id).into()
    }

    fn job(&self, index: usize) -> Result<Job, NotReady> {
        self.run(index).ok_or(NotReady::Changed)?.job(self.args)
    }

    fn identity(&self, index: usize) -> RunIdentity {
        let inputs = self.run(index).map(|run| run.inputs).unwrap_or_default();
        RunIdentity { inputs, overrides: self.overrides.clone(), ..RunIdentity::default() }
    }

    fn is_sweep(&self) -> bool {
        false
    }
}

impl<'a> Wanted<'a> {
    /// The named scenarios, or the demo.
    pub(super) fn of(args: &'a RunArgs, engines: &Engines) -> Result<Self, CliError> {
        let overrides = args.suite.with.overrides.iter().map(ToString::to_string).collect();
        let mut wanted = Self { args, entries: Vec::new(), planned: Vec::new(), overrides };
        let mut ids = JobIds::default();
        if args.scenarios.is_empty() {
            // The demo names engines that this build may lack; it has no FMU.
            let there = engines.names();
            for source in sources::demo(&args.suite.with)? {
                let own = source.scenario.engines.iter().copied().filter(|engine| there.contains(engine)).collect();
                let engines: Vec<_> = if args.suite.engine.is_empty() { own } else { args.suite.engine.clone() };
                let origin = Origin::Demo(Arc::new(source.clone()));
                wanted.add(source, &origin, &engines, &mut ids);
            }
            return Ok(wanted);
        }
        for found in sources::each(&args.scenarios, &args.suite.with)? {
            match found? {
                Ok(source) => {
                    let engines = if args.suite.engine.is_empty() {
                        source.scenario.engines.clone()
                    } else {
                        args.suite.engine.clone()
                    };
                    let path = source.scenario.path.clone().unwrap_or_default();
                    wanted.add(source, &Origin::File(path.into()), &engines, &mut ids);
                }
                Err(unusable) => {
                    let RunIdentity { name, file, engine, axis, .. } = identity_of(&unusable, &wanted.overrides);
                    wanted.planned.push(Unfinished { name, file, engine, axis });
                    wanted.entries.push(Entry::Unusable(unusable));
                }
            }
        }
        Ok(wanted)
    }

    /// Adds a scenario on these engines.
    fn add(&mut self, source: Source, origin: &Origin, engines: &[EngineName], ids: &mut JobIds) {
        let mut job = Job::new(String::new(), source, EngineName::default());
        for engine in engines {
            job.engine = *engine;
            let id = ids.next(&job.scenario.name, *engine);
            let inputs = output::inputs_of(&job);
            self.planned.push(output::unfinished(&job));
            self.entries.push(Entry::Run(PlannedRun { id, origin: origin.clone(), engine: *engine, inputs }));
        }
    }

    fn unusable(&self) -> impl Iterator<Item = &Unusable> {
        self.entries
            .iter()
            .filter_map(|entry| if let Entry::Unusable(unusable) = entry { Some(unusable) } else { None })
    }

    /// The files that cannot be used.
    pub(super) fn into_unusable(self) -> Vec<Unusable> {
        let entries = self.entries.into_iter();
        entries.filter_map(|entry| if let Entry::Unusable(unusable) = entry { Some(unusable) } else { None }).collect()
    }

    /// Their mistakes, in words.
    fn mistakes(&self) -> String {
        self.unusable().map(ToString::to_string).collect::<Vec<_>>().join("\n")
    }

    /// The mistakes as a message before the others run; empty without any.
    pub(super) fn shown(&self) -> String {
        let mistakes = self.mistakes();
        if mistakes.is_empty() { mistakes } else { format!("servobench: {}\n\n", mistakes.trim_end()) }
    }

    /// Message that the demo runs because no file is named.
    pub(super) fn demo(&self, out: &Path) -> String {
        let ids: Vec<&str> = self.ids().collect();
        format!("no file is named: running the demo that is built in ({}) into {}\n", ids.join(", "), out.display())
    }

    fn run(&self, index: usize) -> Option<&PlannedRun> {
        self.entries.get(index).and_then(|entry| if let Entry::Run(run) = entry { Some(run) } else { None })
    }

    /// Digest of all inputs of the run at `index`; the default one for a file that cannot be used.
    pub(super) fn inputs(&self, index: usize) -> Digest {
        self.run(index).map_or_else(Digest::default, |run| run.inputs)
    }

    /// Names of the runs.
    pub(super) fn ids(&self) -> impl Iterator<Item = &str> {
        let entries = self.entries.iter();
        entries.filter_map(|entry| if let Entry::Run(run) = entry { Some(run.id.as_str()) } else { None })
    }

    /// Number of runs and unusable files.
    pub(super) const fn len(&self) -> usize {
        self.entries.len()
    }

    /// Takes the list of runs, in the order of the suite, out of `self`.
    pub(super) fn take_planned(&mut self) -> Vec<Unfinished> {
        std::mem::take(&mut self.planned)
    }

    /// Stems of the files that the runs leave.
    pub(super) fn stems(&self) -> Vec<String> {
        self.ids().map(str::to_owned).collect()
    }

    /// Digest of the runs in their order, and of the files that they are to leave.
    pub(super) fn digest(&self) -> Digest {
        let start = Digester::default().with(format!("{:?} {}", self.args.keep, self.args.suite.rrd));
        let all = self.entries.iter().fold(start, |digester, entry| match entry {
            Entry::Run(run) => digester.with(run.inputs.to_string()),
            Entry::Unusable(unusable) => digester.with(unusable.reasons().join("\n")),
        });
        all.finish()
    }

    /// Results of the files that cannot be used, which end at once.
    pub(super) fn invalid(&self) -> impl Iterator<Item = Finished> {
        self.entries.iter().enumerate().filter_map(|(index, entry)| {
            let Entry::Unusable(unusable) = entry else { return None };
            let result = RunResult::invalid(identity_of(unusable, &self.overrides), unusable.reasons());
            Some(Finished { index, seconds: 0.0, result })
        })
    }

    /// Notes these results, unless that was done.
    pub(super) fn note_unusable(&self, ledger: &Ledger) {
        self.invalid().filter(|one| !ledger.has(one.index)).for_each(|one| ledger.note(one));
    }
}

fn identity_of(unusable: &Unusable, overrides: &[String]) -> RunIdentity {
    let path = &unusable.path;
    let name = sources::named(path);
    let name = Path::new(&name).file_stem().map_or_else(|| name.clone(), |stem| stem.to_string_lossy().into_owned());
    let file = Some(path.display().to_string());
    RunIdentity { name, file, overrides: overrides.to_vec(), ..RunIdentity::default() }
}
