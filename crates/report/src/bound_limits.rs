//! Limits of the machine that bound during a run, in words.
use crate::failures::lifted;
use servobench_metrics::Quantity;
use servobench_results::RunResult;
use servobench_trace::Event;

/// One line for each limit that bound and is not named in a reason or a lifted requirement: `voltage limit bound for 636 ms`.
pub(crate) fn bound_limits(run: &RunResult) -> Vec<String> {
    let lifted = lifted(run);
    let is_said = |words: &String| run.reasons.iter().chain(&lifted).any(|said| said.contains(words.as_str()));
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
    use servobench_metrics::Standing;
    use servobench_results::samples;

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

    /// A broken or lifted requirement names it already.
    #[test]
    fn what_is_said_already_is_not_said_again() {
        let why = || vec!["the load ended 50.0 mm short of 200 mm; effort limit bound for 400 ms".to_owned()];
        let mut run = samples::kept();
        run.events = vec![Event::bound(0.3, 0.7, "loop", "effort limit", false)];
        assert_eq!(bound_limits(&run), ["effort limit bound for 400 ms"]);
        run.requirements = samples::requirements([("arrives", Standing::Lifted, why())]);
        assert_eq!(bound_limits(&run), [""; 0]);
        run.requirements = samples::requirements([]);
        run.reasons = why();
        assert_eq!(bound_limits(&run), [""; 0]);
    }
}
