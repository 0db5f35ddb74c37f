//! Limits of the machine that bound during a run, in words.
use crate::results::RunResult;
use servobench_metrics::Quantity;
use servobench_trace::Event;

/// One line for each limit that bound, unless a reason of the verdict says it: `voltage limit bound for 636 ms`.
pub(crate) fn bound_limits(run: &RunResult) -> Vec<String> {
    let is_said = |words: &String| run.reasons.iter().any(|reason| reason.contains(words.as_str()));
    words(&run.events).into_iter().filter(|words| !is_said(words)).collect()
}

fn words(events: &[Event]) -> Vec<String> {
    let mut limits: Vec<Bound<'_>> = Vec::new();
    for event in events {
        let Some(limit) = &event.limit else { continue };
        let index = limits.iter().position(|bound| bound.limit == limit.name).unwrap_or_else(|| {
            limits.push(Bound { limit: &limit.name, times: 0, seconds: 0.0, is_all: true });
            limits.len() - 1
        });
        let bound = &mut limits[index];
        bound.times += 1;
        bound.seconds += event.end - event.start;
        bound.is_all &= !limit.is_last_noted;
    }
    limits.iter().map(Bound::words).collect()
}

struct Bound<'a> {
    limit: &'a str,
    times: usize,
    seconds: f64,
    is_all: bool,
}

impl Bound<'_> {
    fn words(&self) -> String {
        let Self { limit, times, seconds, is_all } = self;
        let seconds = Quantity::new(*seconds, "s");
        match (*is_all, *times) {
            (false, _) => format!("{limit} bound more than {times} times, for more than {seconds} in all"),
            (true, 1) => format!("{limit} bound for {seconds}"),
            (true, _) => format!("{limit} bound {times} times, for {seconds} in all"),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn times_are_summed_for_each_limit() {
        let bound = |start, end, limit| Event::bound(start, end, "loop", limit, false);
        let events = [
            bound(0.1, 0.2, "voltage limit"),
            bound(0.3, 0.7, "effort limit"),
            Event::new(0.5, 0.5, "loop", "what binds is something else"),
            bound(0.8, 1.0, "voltage limit"),
        ];
        assert_eq!(words(&events), ["voltage limit bound 2 times, for 300 ms in all", "effort limit bound for 400 ms"]);
        let cut = [Event::bound(0.0, 0.5, "loop", "effort limit", true)];
        assert_eq!(words(&cut), ["effort limit bound more than 1 times, for more than 500 ms in all"]);
    }
}
