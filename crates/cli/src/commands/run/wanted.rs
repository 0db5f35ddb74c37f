//! What is to be run: jobs, and files that cannot be used, in the order of the files.
use super::Timed;
use crate::args::RunArgs;
use crate::error::CliError;
use crate::sources::{self, Unusable};
use servobench_report::{RunIdentity, RunResult};
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
            let demo = sources::demo(&args.with.overrides)?;
            // The demo names engines that this build may lack; an FMU it has none of.
            let mut there = engines.names();
            there.retain(|engine| demo.iter().any(|source| source.scenario.engines.contains(engine)));
            let jobs = jobs(demo, if args.engine.is_empty() { &there } else { &args.engine });
            return Ok(Self { files: vec![File::Jobs(jobs.len())], jobs, overrides });
        }
        let (mut usable, mut files) = (Vec::new(), Vec::new());
        for found in sources::each(&args.scenarios, &args.with.overrides)? {
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

    /// What the jobs came to, and what is invalid, in the order of the files.
    pub(super) fn in_order(&self, ended: Vec<Timed>) -> Vec<Timed> {
        let mut ended = ended.into_iter();
        let mut all = Vec::new();
        for file in &self.files {
            match file {
                File::Jobs(count) => all.extend(ended.by_ref().take(*count)),
                File::Unusable(unusable) => all.push((invalid(unusable, &self.overrides), Duration::ZERO)),
            }
        }
        all
    }
}

fn invalid(unusable: &Unusable, overrides: &[String]) -> RunResult {
    let path = &unusable.path;
    let name = sources::named(path);
    let name = Path::new(&name).file_stem().map_or_else(|| name.clone(), |stem| stem.to_string_lossy().into_owned());
    let file = Some(path.display().to_string());
    let identity = RunIdentity { name, file, overrides: overrides.to_vec(), ..RunIdentity::default() };
    RunResult::invalid(identity, unusable.reasons())
}
