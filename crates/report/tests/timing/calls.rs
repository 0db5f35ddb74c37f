//! Calls that were never executed, or failed: a row says so, with the reason.
use crate::drawn::{Scale, elements, number, text, whole};
use crate::recordings::{aborted, channel, empty, logic};
use roxmltree::Document;
use servobench_report::{TimingOptions, timing_diagram};
use servobench_trace::{Call, CallFate, Recording};

fn call(name: &str, is_optional: bool, fate: CallFate) -> Call {
    Call { name: name.into(), block: "MC_MoveAbsolute".into(), is_optional, fate }
}

fn never(why: &str) -> CallFate {
    CallFate::NeverExecuted(why.into())
}

/// First aborted by Second, as in the figure; Third and Fourth wait in vain.
fn waiting() -> Recording {
    let mut recording = aborted();
    recording.calls = vec![
        call("First", false, CallFate::Executed),
        call("Third", false, never("`First.Done` did not become TRUE")),
        call("Second", false, CallFate::Executed),
        call("Fourth", true, never("`Second.Error` did not become TRUE")),
    ];
    // Third has outputs, which stay FALSE; Fourth has none that were recorded.
    recording.signals.push(logic("Third", "Execute", &[]));
    recording
}

fn names<'a>(document: &'a Document<'_>, class: &str) -> Vec<&'a str> {
    elements(document, "text", class).into_iter().map(text).collect()
}

#[test]
fn blocks_that_never_ran_are_shown_with_the_reason() {
    let svg = whole(&waiting());
    let document = Document::parse(&svg).unwrap();
    // One with signals stands where these were recorded, one without after the call before it.
    assert_eq!(names(&document, "n"), ["First", "Second", "Fourth", "axis", "drive", "link", "Third"]);
    assert_eq!(names(&document, "r").iter().filter(|name| **name == "never executed").count(), 2);
    let reasons = |class: &'static str| -> Vec<(f64, f64)> {
        let bars = elements(&document, "rect", class);
        bars.into_iter().map(|bar| (number(bar, "x"), number(bar, "width"))).collect()
    };
    let time = Scale::of_time(&document);
    // Red from the beginning to the end, beside the underflow of the link; white where the run may do without it.
    let is_whole =
        |bar: &&(f64, f64)| (bar.0 - time.at(0.0)).abs() < 0.02 && (bar.1 - (time.at(5.0) - time.at(0.0))).abs() < 0.02;
    assert_eq!((reasons("bx").iter().filter(is_whole).count(), reasons("bx").len()), (1, 2));
    assert_eq!(reasons("bo").iter().filter(is_whole).count(), 1);
    let said = names(&document, "bt");
    assert!(said.contains(&"`First.Done` did not become TRUE"), "{said:?}");
    assert!(said.contains(&"`Second.Error` did not become TRUE"), "{said:?}");
    assert!(svg.contains("nothing happens: First.Done, First.Error") && svg.contains("Third.Execute"), "idle as ever");
}

#[test]
fn a_call_that_failed_says_why_from_then_on() {
    let mut recording = aborted();
    let fate = CallFate::Failed { time: 3.0, id: 5, message: "the target is outside".into() };
    recording.calls = vec![call("Second", false, fate)];
    let svg = whole(&recording);
    let document = Document::parse(&svg).unwrap();
    let time = Scale::of_time(&document);
    let failed =
        elements(&document, "rect", "bx").into_iter().find(|bar| (number(*bar, "x") - time.at(3.0)).abs() < 0.02);
    let bar = failed.unwrap();
    assert!((number(bar, "x") + number(bar, "width") - time.at(5.0)).abs() < 0.02);
    assert!(names(&document, "bt").contains(&"the target is outside"));
    // Before its own outputs.
    let rows = names(&document, "r");
    let at = rows.iter().position(|row| *row == "failed").unwrap();
    assert_eq!(rows[at + 1], "Execute");
    // Not in a stretch of time before it.
    let options = TimingOptions { to: Some(2.9), ..TimingOptions::default() };
    assert!(!timing_diagram(&recording, &options).unwrap().contains("outside"));
}

#[test]
fn a_call_can_be_asked_for_by_name() {
    let sources = vec!["Fourth".to_owned()];
    let svg = timing_diagram(&waiting(), &TimingOptions { sources, ..TimingOptions::default() }).unwrap();
    let document = Document::parse(&svg).unwrap();
    assert_eq!(names(&document, "n"), ["Fourth"]);
    let unknown = TimingOptions { sources: vec!["Fifth".into()], ..TimingOptions::default() };
    let error = timing_diagram(&waiting(), &unknown).unwrap_err().to_string();
    assert!(
        error.ends_with("there are those of `First`, `Second`, `axis`, `drive`, `link`, `Third`, `Fourth`"),
        "{error}"
    );
}

/// A program of which nothing ran is a diagram too, and whatever a reason holds is XML that can be read.
#[test]
fn a_call_alone_is_enough() {
    let calls = vec![call("<a>", false, never("<&\0>")), call("b", false, never(""))];
    let svg = whole(&Recording { calls: calls.clone(), ..empty() });
    let document = Document::parse(&svg).unwrap();
    assert_eq!(names(&document, "n"), ["<a>", "b"]);
    let fate = CallFate::Failed { time: f64::NAN, id: 0, message: "never seen".into() };
    let with_channel = Recording {
        calls: vec![call("c", false, fate)],
        channels: vec![channel("setpoint.velocity", "m/s", vec![0.0, 1.0, 2.0])],
        ..empty()
    };
    assert!(!whole(&with_channel).contains("NaN"));
}
