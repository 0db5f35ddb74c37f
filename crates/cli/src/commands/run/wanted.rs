//! What is to be run: jobs, and files that cannot be used, in the order of the files.
use super::ledger::Ledger;
use crate::args::RunArgs;
use crate::error::CliError;
use crate::output::{self, Written};
use crate::sources::{self, Unusable};
use servobench_results::{Digest, Digester, RunIdentity, RunResult, Unfinished};
use servobench_suite::{Engines, Job, jobs};
use std::path::Path;
use std::time::Duration;

/// What is to be run.
pub(super) struct Wanted {
    /// The jobs.
    pub(super) jobs: Vec<Job>,
    files: Vec<File>,
    /// Values that are not those of the files.
    overrides: Vec<String>,
}

/// What became of a file.
enum File {
    /// So many jobs.
    Jobs(usize),
    Unusable(Unusable),
}

impl Wanted {
    /// The scenarios that are named, or the demo.
    pub(super) fn of(args: &RunArgs, engines: &Engines) -> Result<Self, CliError> {
        let overrides = args.with.overrides.iter().map(ToString::to_string).collect();
        if args.scenarios.is_empty() {
            let demo = sources::demo(&args.with)?;
            // The demo names engines that this build may lack; an FMU it has none of.
            let mut there = engines.names();
            there.retain(|engine| demo.iter().any(|source| source.scenario.engines.contains(engine)));
            let jobs = jobs(demo, if args.engine.is_empty() { &there } else { &args.engine });
            return Ok(Self { files: vec![File::Jobs(jobs.len())], jobs, overrides });
        }
        let (mut usable, mut files) = (Vec::new(), Vec::new());
        for found in sources::each(&args.scenarios, &args.with)? {
            match found {
                Ok(source) => {
                    let engines = if args.engine.is_empty() { &source.scenario.engines } else { &args.engine };
                    files.push(File::Jobs(engines.len()));
                    usable.push(source);
                }
                Err(unusable) => files.push(File::Unusable(unusable)),
            }
        }
        Ok(Self { jobs: jobs(usable, &args.engine), files, overrides })
    }

    fn unusable(&self) -> impl Iterator<Item = &Unusable> {
        self.files.iter().filter_map(|file| if let File::Unusable(unusable) = file { Some(unusable) } else { None })
    }

    /// The files that cannot be used.
    pub(super) fn into_unusable(self) -> Vec<Unusable> {
        let files = self.files.into_iter();
        files.filter_map(|file| if let File::Unusable(unusable) = file { Some(unusable) } else { None }).collect()
    }

    /// What is wrong with them.
    fn mistakes(&self) -> String {
        self.unusable().map(ToString::to_string).collect::<Vec<_>>().join("\n")
    }

    /// The same before the others run, nothing where nothing is wrong.
    pub(super) fn shown(&self) -> String {
        let mistakes = self.mistakes();
        if mistakes.is_empty() { mistakes } else { format!("servobench: {}\n\n", mistakes.trim_end()) }
    }

    /// What runs when nobody names a file.
    pub(super) fn demo(&self, out: &Path) -> String {
        let ids: Vec<&str> = self.jobs.iter().map(|job| job.id.as_str()).collect();
        format!("no file is named: running the demo that is built in ({}) into {}\n", ids.join(", "), out.display())
    }

    /// Each job with its place in the suite: that of its file, what is invalid counted.
    pub(super) fn places(&self) -> impl Iterator<Item = (usize, &Job)> {
        let mut jobs = self.jobs.iter();
        self.in_order().enumerate().filter_map(move |(index, unusable)| match unusable {
            None => Some((index, jobs.next()?)),
            Some(_) => None,
        })
    }

    /// What is at each place of the suite: a file that cannot be used, or `None` for a job.
    fn in_order(&self) -> impl Iterator<Item = Option<&Unusable>> {
        self.files.iter().flat_map(|file| match file {
            File::Jobs(count) => std::iter::repeat_n(None, *count),
            File::Unusable(unusable) => std::iter::repeat_n(Some(unusable), 1),
        })
    }

    /// The runs of the suite, in its order.
    pub(super) fn planned(&self) -> Vec<Unfinished> {
        let mut jobs = self.jobs.iter();
        let run =
            |identity: RunIdentity| Unfinished { name: identity.name, file: identity.file, engine: identity.engine };
        self.in_order()
            .filter_map(|unusable| match unusable {
                Some(unusable) => Some(run(identity_of(unusable, &self.overrides))),
                None => jobs.next().map(|job| run(output::identity(job, Written::default()))),
            })
            .collect()
    }

    /// Stems of the files that the jobs leave.
    pub(super) fn stems(&self) -> Vec<String> {
        self.jobs.iter().map(|job| job.id.clone()).collect()
    }

    /// Digest of the runs in their order, and of what they are to leave.
    pub(super) fn digest(&self, args: &RunArgs) -> Digest {
        let mut jobs = self.jobs.iter();
        let start = Digester::default().with(format!("{:?} {}", args.keep, args.rrd));
        let all = self.in_order().fold(start, |digester, unusable| {
            let part = unusable.map(|unusable| unusable.reasons().join("\n"));
            let part = part.or_else(|| jobs.next().map(|job| output::inputs_of(job).to_string()));
            digester.with(part.unwrap_or_default())
        });
        all.finish()
    }

    /// What of the suite is invalid.
    pub(super) fn invalid(&self) -> Vec<RunResult> {
        self.unusable().map(|unusable| invalid(unusable, &self.overrides)).collect()
    }

    /// Files that cannot be used have come to their end at once.
    pub(super) fn note_unusable(&self, ledger: &Ledger) {
        for (index, unusable) in self.in_order().enumerate() {
            if let Some(unusable) = unusable.filter(|_| !ledger.has(index)) {
                ledger.note(index, invalid(unusable, &self.overrides), Duration::ZERO);
            }
        }
    }
}

fn invalid(unusable: &Unusable, overrides: &[String]) -> RunResult {
    RunResult::invalid(identity_of(unusable, overrides), unusable.reasons())
}

fn identity_of(unusable: &Unusable, overrides: &[String]) -> RunIdentity {
    let path = &unusable.path;
    let name = sources::named(path);
    let name = Path::new(&name).file_stem().map_or_else(|| name.clone(), |stem| stem.to_string_lossy().into_owned());
    let file = Some(path.display().to_string());
    RunIdentity { name, file, overrides: overrides.to_vec(), ..RunIdentity::default() }
}
