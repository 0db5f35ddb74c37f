//! Conditions: references to outputs of calls, and conditions that can never come true.
use crate::block::conditions;
use crate::diagnostic::Report;
use crate::field::Slot;
use crate::file;
use crate::resolve::{Alternative, one_of};
use crate::source::{At, Span};
use crate::when::When;
use servobench_files::suggestion;
use servobench_plcopen::program::Condition;
use servobench_plcopen::{BlockName, Output};

/// A call as conditions refer to it.
#[derive(Debug)]
pub(super) struct Instance {
    /// Empty if it is unknown.
    pub(super) name: String,
    pub(super) block: Option<BlockName>,
    pub(super) span: Span,
    /// Place of its `start`.
    pub(super) start: Option<Span>,
}

/// Calls and times that conditions refer to.
pub(super) struct Context<'a> {
    pub(super) instances: &'a [Instance],
    /// Length of the run (s), if the file gives it.
    pub(super) duration: Option<f64>,
}

pub(super) fn resolve(when: &At<When>, context: &Context<'_>, report: &mut Report) -> Option<Condition> {
    match &when.value {
        When::Output(text) => {
            let (call, output) = context.output(text, report)?;
            Some(Condition::After { call, output, delay: 0.0 })
        }
        When::Condition(condition) => context.condition(condition, report),
    }
}

impl Context<'_> {
    fn condition(&self, given: &file::Condition, report: &mut Report) -> Option<Condition> {
        let ways = [
            ("at", given.at.span()),
            ("after", given.after.span()),
            ("above", given.above.span()),
            ("below", given.below.span()),
        ];
        let mut there = ways.iter().filter_map(|(way, span)| span.map(|span| (way, span)));
        if let (Some((first, _)), Some((second, span))) = (there.next(), there.next()) {
            report.error(span, format!("`{first}` and `{second}` in one condition"), "give one of them");
            return None;
        }
        let way = one_of(&ways, report);
        if let (Slot::Absent, Some(span)) = (&given.after, given.delay.span()) {
            report.error(span, "`delay` is for `after`", "");
        }
        match way {
            Alternative::Use(0) => self.in_time(&given.at, report).map(Condition::At),
            Alternative::Use(1) => {
                let delay = match given.delay {
                    Slot::Absent => Some(0.0),
                    _ => self.in_time(&given.delay, report),
                };
                let (call, output) = self.output(given.after.at()?, report)?;
                Some(Condition::After { call, output, delay: delay? })
            }
            Alternative::Use(2) => given.above.given().copied().map(Condition::Above),
            Alternative::Use(_) => given.below.given().copied().map(Condition::Below),
            Alternative::Contradiction => None,
            Alternative::None => {
                report.error(given.span, "this condition is empty", "give `at`, `after`, `above` or `below`");
                None
            }
        }
    }

    /// A time, which must be within the run.
    fn in_time(&self, slot: &Slot<f64>, report: &mut Report) -> Option<f64> {
        let at = slot.at()?;
        match self.duration {
            Some(duration) if at.value >= duration => {
                report.error(at.span, format!("the run is over by then: it lasts {duration} s"), "");
                None
            }
            _ => Some(at.value),
        }
    }

    /// The index of the call, and the output, that `text` names: "first.Done".
    fn output(&self, text: &At<String>, report: &mut Report) -> Option<(usize, Output)> {
        let (name, output) = text.value.split_once('.').map_or((&*text.value, None), |(name, rest)| (name, Some(rest)));
        let Some(call) = self.instances.iter().position(|instance| instance.name == name && !name.is_empty()) else {
            let names = self.instances.iter().map(|instance| &*instance.name).filter(|name| !name.is_empty());
            let help = suggestion(name, names.collect::<Vec<_>>());
            report.error(text.span, format!("unknown call `{name}`"), help);
            return None;
        };
        let block = self.instances[call].block?;
        let found = output.and_then(|output| conditions(block).find(|own| own.name() == output));
        if found.is_none() {
            let message = match output {
                Some(output) => format!("{block} has no output `{output}`"),
                None => format!("`{name}` is a call: name one of its outputs"),
            };
            let outputs: Vec<_> = conditions(block).map(Output::name).collect();
            report.error(text.span, message, format!("its outputs are {}", outputs.join(", ")));
        }
        found.map(|output| (call, output))
    }
}

/// Refuses calls that wait for each other, or for themselves: none of them would ever start. Each waits for at most one other, so
/// that following the chain of waiting calls either ends or returns to its start.
pub(super) fn refuse_circles(starts: &[Option<Condition>], instances: &[Instance], report: &mut Report) {
    let waits_for = |call: usize| match starts[call] {
        Some(Condition::After { call, .. }) => Some(call),
        _ => None,
    };
    for first in 0..starts.len() {
        let round = std::iter::successors(waits_for(first), |call| waits_for(*call)).take(starts.len());
        let circle: Vec<usize> = round.take_while(|call| *call != first).collect();
        let closes = circle.last().map_or(waits_for(first), |last| waits_for(*last)) == Some(first);
        // A circle is reported once: at the call that comes first in the file.
        if !closes || circle.iter().any(|call| *call < first) {
            continue;
        }
        let name = |call: usize| format!("`{}`", instances[call].name);
        let all: Vec<_> = std::iter::once(first).chain(circle.iter().copied()).chain([first]).map(name).collect();
        let message = if circle.is_empty() {
            format!("{} waits for itself", name(first))
        } else {
            format!("{}: none of them ever starts", all.join(" waits for "))
        };
        let span = instances[first].start.unwrap_or(instances[first].span);
        report.error(span, message, "let one of them start by itself");
    }
}
