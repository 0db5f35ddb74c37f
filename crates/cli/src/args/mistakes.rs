//! Every mistake of a command line in one go. The parser stops at its first one; it is asked again with that one let through, until it
//! finds nothing more or what it cannot go on from.
use super::Cli;
use crate::console::{print, say};
use clap::builder::{StyledStr, ValueParser};
use clap::error::{ContextKind, ContextValue, ErrorKind};
use clap::parser::ValueSource;
use clap::{Arg, ArgMatches, Command, CommandFactory, Error, Parser};
use servobench_report::{painted, shown, wrapped};
use std::error::Error as _;
use std::ffi::OsString;

/// Columns for the meaning of an argument that is missing.
const WIDTH: usize = 74;

/// The arguments of this process; it ends with exit code 2 where they are wrong, and with 0 where they ask for help.
pub(crate) fn parse() -> Cli {
    let words: Vec<OsString> = std::env::args_os().collect();
    Cli::try_parse_from(&words).unwrap_or_else(|first| {
        let (others, last) = mistakes(&words, first);
        for other in others {
            say(&other);
        }
        let text = rendered(&last);
        if last.use_stderr() {
            say(&text);
        } else {
            // What cannot be printed is no other mistake.
            print(&text).ok();
        }
        std::process::exit(last.exit_code())
    })
}

/// What the parser says, in its colours. It quotes words of the command line as they are: where one of them is not fit for a terminal,
/// there are no colours, since nobody could tell them from it.
fn rendered(error: &Error) -> String {
    let text = error.render();
    let plain = text.to_string();
    if shown(&plain, false) == plain { painted(&text.ansi().to_string()) } else { plain }
}

/// What is wrong with `words`: a line or a few each, and the last mistake as the parser puts it, with what is to be typed.
fn mistakes(words: &[OsString], first: Error) -> (Vec<String>, Error) {
    let mut line = Line::of(words);
    let (mut before, mut error) = (Vec::new(), line.explained(first));
    while line.let_through(&error) {
        let Err(next) = line.command.clone().try_get_matches_from(&line.words) else { break };
        let (told, next) = (brief(&error), line.explained(next));
        // Never the same question twice, whatever could not be let through.
        if brief(&next) == told {
            break;
        }
        before.push(told);
        error = next;
    }
    (before, error)
}

/// A command line and the program that it is for.
struct Line {
    words: Vec<OsString>,
    /// The program as it is asked.
    command: Command,
    /// The same with all names and inherited options in place, to look them up.
    built: Command,
    /// Names of the subcommands that it asks for, from the outermost.
    path: Vec<String>,
    /// The arguments that it gives to the innermost of them, as the parser calls them: `--jerk <JERK>`.
    given: Vec<String>,
}

impl Line {
    fn of(words: &[OsString]) -> Self {
        let (command, mut built) = (Cli::command(), Cli::command());
        built.build();
        let found = command.clone().ignore_errors(true).try_get_matches_from(words);
        let (mut path, mut given) = (Vec::new(), Vec::new());
        if let Ok(outermost) = &found {
            let (mut matches, mut innermost) = (outermost, &built);
            given.extend(given_in(matches, innermost));
            while let Some((name, inner)) = matches.subcommand()
                && let Some(subcommand) = innermost.find_subcommand(name)
            {
                (matches, innermost) = (inner, subcommand);
                path.push(name.to_owned());
                given.extend(given_in(matches, innermost));
            }
        }
        Self { words: words.to_vec(), command, built, path, given }
    }

    /// `program` and the commands below it that the line asks for, from the outermost.
    fn commands<'a>(&self, program: &'a Command) -> Vec<&'a Command> {
        let mut commands = vec![program];
        for name in &self.path {
            commands.extend(commands.last().and_then(|command| command.find_subcommand(name)));
        }
        commands
    }

    /// The argument that the parser calls `name`.
    fn find(&self, name: &str) -> Option<&Arg> {
        let commands = self.commands(&self.built).into_iter().rev();
        commands.flat_map(Command::get_arguments).find(|arg| arg.to_string() == name)
    }

    /// How deep the command is that has the argument `id` itself.
    fn depth_of(&self, id: &str) -> Option<usize> {
        let has_it = |command: &&Command| command.get_arguments().any(|arg| arg.get_id().as_str() == id);
        self.commands(&self.command).iter().rposition(has_it)
    }

    /// The option `flag` in commands beside those of the line, each with the words that call it.
    fn elsewhere(&self, flag: &str) -> Vec<(String, &Arg)> {
        let commands = self.commands(&self.built);
        let Some(family) = commands.get(1).copied() else { return Vec::new() };
        let own = commands.last().map(|command| command.get_name());
        let name = format!("{} {}", self.built.get_name(), family.get_name());
        let inner = family.get_subcommands().map(|inner| (format!("{name} {}", inner.get_name()), inner));
        std::iter::once((name.clone(), family))
            .chain(inner)
            .filter(|(_, command)| Some(command.get_name()) != own)
            .filter_map(|(name, command)| Some((name, option(command, flag)?)))
            .collect()
    }

    /// Makes the parser take what `error` is about, if it can go on then.
    fn let_through(&mut self, error: &Error) -> bool {
        let Some(name) = string(error, ContextKind::InvalidArg) else { return false };
        match error.kind() {
            ErrorKind::InvalidValue | ErrorKind::ValueValidation => {
                let is_given = string(error, ContextKind::InvalidValue).is_some_and(|value| !value.is_empty());
                // What is hidden is only there to say what took its place.
                let Some(arg) = self.find(name).filter(|arg| is_given && !arg.is_hide_set()) else { return false };
                let id = arg.get_id().as_str().to_owned();
                let Some(depth) = self.depth_of(&id) else { return false };
                self.amend(depth, |command| command.mut_arg(id, |arg| arg.value_parser(ValueParser::os_string())));
                true
            }
            ErrorKind::UnknownArgument => {
                let Some((_, arg)) = self.elsewhere(name).into_iter().next() else { return false };
                let has_value = arg.get_action().takes_values();
                self.leave_out(name, has_value)
            }
            _ => false,
        }
    }

    /// Takes the option `flag` and its value out of the words, if it is there.
    fn leave_out(&mut self, flag: &str, has_value: bool) -> bool {
        let with_value = format!("{flag}=");
        let is_it = |word: &OsString| word == flag || word.to_string_lossy().starts_with(&with_value);
        let Some(first) = self.words.iter().position(is_it) else { return false };
        let count = if has_value && self.words[first] == flag { 2 } else { 1 };
        let last = (first + count).min(self.words.len());
        self.words.drain(first..last);
        true
    }

    /// Changes the command at `depth` of the line.
    fn amend(&mut self, depth: usize, change: impl FnOnce(Command) -> Command) {
        let command = std::mem::take(&mut self.command);
        self.command = amended(command, &self.path[..depth], change);
    }

    /// `error` with what the program knows of it beyond the parser.
    fn explained(&self, mut error: Error) -> Error {
        match error.kind() {
            ErrorKind::UnknownArgument => {
                let flag = string(&error, ContextKind::InvalidArg).unwrap_or_default();
                let names: Vec<String> = self.elsewhere(flag).into_iter().map(|(name, _)| name).collect();
                if !names.is_empty() {
                    let tip = format!("it is an option of {}", names.join(", "));
                    error.remove(ContextKind::SuggestedArg);
                    error.insert(ContextKind::Suggested, ContextValue::StyledStrs(vec![StyledStr::from(tip)]));
                }
            }
            ErrorKind::MissingRequiredArgument => {
                let missing = strings(&error, ContextKind::InvalidArg);
                let missing = missing.into_iter().map(|name| self.with_meaning(name)).collect();
                error.insert(ContextKind::InvalidArg, ContextValue::Strings(missing));
            }
            // Of a group the parser lists every member.
            ErrorKind::ArgumentConflict => {
                let mut others = strings(&error, ContextKind::PriorArg);
                others.retain(|other| self.given.contains(other));
                let others = match <[String; 1]>::try_from(others) {
                    Ok([other]) => ContextValue::String(other),
                    Err(others) if others.is_empty() => return error,
                    Err(others) => ContextValue::Strings(others),
                };
                error.insert(ContextKind::PriorArg, others);
            }
            _ => {}
        }
        error
    }

    /// An argument that is missing, and what it is for.
    fn with_meaning(&self, name: String) -> String {
        let meaning = self.find(&name).and_then(Arg::get_help).map(ToString::to_string);
        let lines = wrapped(&meaning.unwrap_or_default(), WIDTH);
        lines.into_iter().fold(name, |text, line| text + "\n      " + &line)
    }
}

/// The arguments of `command` that are on the command line.
fn given_in(matches: &ArgMatches, command: &Command) -> Vec<String> {
    let is_given = |arg: &&Arg| matches.value_source(arg.get_id().as_str()) == Some(ValueSource::CommandLine);
    command.get_arguments().filter(is_given).map(ToString::to_string).collect()
}

/// The option of `command` that is written `flag`.
fn option<'a>(command: &'a Command, flag: &str) -> Option<&'a Arg> {
    let long = flag.strip_prefix("--")?;
    command.get_arguments().find(|arg| arg.get_long() == Some(long) && !arg.is_hide_set())
}

fn amended(command: Command, path: &[String], change: impl FnOnce(Command) -> Command) -> Command {
    let Some((name, inner)) = path.split_first() else { return change(command) };
    command.mut_subcommand(name, |command| {
        let change: Box<dyn FnOnce(Command) -> Command + '_> = Box::new(change);
        amended(command, inner, change)
    })
}

/// `error` without usage and where to find help.
fn brief(error: &Error) -> String {
    if let (Some(reason), Some(name)) = (error.source(), string(error, ContextKind::InvalidArg)) {
        let value = string(error, ContextKind::InvalidValue).unwrap_or_default();
        let words = format!("invalid value '{value}' for '{name}': {reason}\n");
        return Error::raw(error.kind(), words).render().to_string();
    }
    let mut brief = Error::new(error.kind());
    for (kind, value) in error.context().filter(|(kind, _)| *kind != ContextKind::Usage) {
        brief.insert(kind, value.clone());
    }
    brief.render().to_string()
}

fn string(error: &Error, kind: ContextKind) -> Option<&str> {
    if let Some(ContextValue::String(text)) = error.get(kind) { Some(text) } else { None }
}

fn strings(error: &Error, kind: ContextKind) -> Vec<String> {
    match error.get(kind) {
        Some(ContextValue::Strings(all)) => all.clone(),
        Some(ContextValue::String(one)) => vec![one.clone()],
        _ => Vec::new(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// What is told of the words of `line`, all but the last in short.
    fn told(line: &str) -> (Vec<String>, String) {
        let words: Vec<OsString> = line.split_whitespace().map(OsString::from).collect();
        let first = Cli::try_parse_from(&words).unwrap_err();
        let (before, last) = mistakes(&words, first);
        (before, last.render().to_string())
    }

    #[test]
    fn a_single_mistake_is_in_the_words_of_the_parser() {
        for line in
            ["servobench run --jobs 0", "servobench runn", "servobench run --quiet --verbose", "servobench --help"]
        {
            let parser = Cli::try_parse_from(line.split_whitespace()).unwrap_err().render().to_string();
            assert_eq!(told(line), (Vec::new(), parser));
        }
    }

    #[test]
    fn values_that_are_wrong_are_told_together() {
        let (before, last) = told("servobench run --jobs 0 --engine nothing --worker-timeout 9");
        assert_eq!(before.len(), 2, "{before:?}");
        assert_eq!(before[0], "error: invalid value '0' for '--jobs <N>': 0 is not in 1..=65535\n");
        assert!(
            before[1].starts_with("error: invalid value 'nothing' for '--engine <NAME>'\n  [possible values: exact, ")
        );
        assert!(last.starts_with("error: invalid value '9' for '--worker-timeout <TIME>': "), "{last}");
    }
}
