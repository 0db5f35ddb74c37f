//! What is written, and what is refused.
use crate::drawn::{elements, text, whole};
use crate::recordings::{aborted, channel, empty, logic, signal};
use roxmltree::Document;
use servobench_report::{TimingOptions, timing_diagram};
use servobench_trace::Recording;

fn refusal(recording: &Recording, options: &TimingOptions) -> String {
    timing_diagram(recording, options).unwrap_err().to_string()
}

#[test]
fn names_and_states_may_hold_anything() {
    let nasty = "<&\"'>]]>";
    let mut recording = empty();
    recording.about.scenario = nasty.into();
    recording.signals = vec![signal(nasty, nasty, &[(0.0, nasty), (1.0, "a\0b\u{1b}")]), logic("<i>", "Done", &[0.5])];
    let svg = whole(&recording);
    let document = Document::parse(&svg).unwrap();
    let written = |tag: &'static str, class: &str| -> Vec<String> {
        elements(&document, tag, class).into_iter().map(|node| text(node).to_owned()).collect()
    };
    assert_eq!(written("text", "t"), [nasty]);
    assert_eq!(written("text", "n"), [nasty, "<i>"]);
    assert_eq!(written("text", "r"), [nasty, "Done"]);
    assert_eq!(written("text", "bt"), [nasty, "a\u{fffd}…"]);
    assert!(svg.contains("a\u{fffd}b\u{fffd}"), "a tooltip, as the bar is narrow: {svg}");
}

#[test]
fn the_title_has_the_name_of_the_axis() {
    let mut recording = aborted();
    let title = |recording: &Recording| {
        let svg = whole(recording);
        let document = Document::parse(&svg).unwrap();
        let titles = elements(&document, "text", "t");
        text(titles[0]).to_owned()
    };
    assert_eq!(title(&recording), "second block aborts the first");
    for channel in &mut recording.channels {
        channel.spec.axis = Some("x".parse().unwrap());
    }
    assert_eq!(title(&recording), "second block aborts the first (axis x)");
}

#[test]
fn a_state_is_cut_to_its_bar_and_whole_in_its_tooltip() {
    let mode = [(0.0, "idle"), (1.0, "cyclic synchronous position"), (1.6, "homing"), (1.605, "profile velocity")];
    let recording = Recording { signals: vec![signal("drive", "mode", &mode)], ..aborted() };
    let svg = whole(&recording);
    let document = Document::parse(&svg).unwrap();
    let texts: Vec<_> = elements(&document, "text", "bt").into_iter().map(text).collect();
    let [idle, cut, whole] = texts[..] else { panic!("{texts:?}") };
    assert_eq!((idle, whole), ("idle", "profile velocity"));
    assert!(cut.starts_with("cyclic") && cut.ends_with('…'), "{cut}");
    let tooltips = elements(&document, "rect", "bs").into_iter().filter_map(|bar| bar.first_element_child()?.text());
    assert_eq!(tooltips.collect::<Vec<_>>(), ["cyclic synchronous position", "homing"]);
}

#[test]
fn signals_in_which_nothing_happens_are_counted() {
    let names = |svg: &str| {
        let document = Document::parse(svg).unwrap();
        elements(&document, "text", "r").into_iter().map(|node| text(node).to_owned()).collect::<Vec<_>>()
    };
    let mut recording = aborted();
    recording.signals.extend([signal("First", "ErrorID", &[(0.0, "0")]), signal("First", "Status", &[(0.0, "TRUE")])]);
    let svg = whole(&recording);
    let note = "5 signals left out, in which nothing happens: First.Done, First.Error, First.ErrorID, Second.CommandAborted, \
                Second.Error";
    assert!(svg.contains(note), "{svg}");
    assert_eq!(names(&svg).len(), 13);
    let all = timing_diagram(&recording, &TimingOptions { with_idle: true, ..TimingOptions::default() }).unwrap();
    assert!(!all.contains("left out"));
    assert_eq!(names(&all).len(), 18);
    // Where there is nothing else, they are shown.
    let idle = Recording { signals: vec![logic("First", "Done", &[])], ..empty() };
    assert_eq!(names(&whole(&idle)), ["Done"]);
}

/// An error is red from where it rises to where it falls, a fault wherever it is.
#[test]
fn what_went_wrong_is_red() {
    let signals = vec![
        logic("First", "Error", &[1.0, 2.0]),
        signal("First", "ErrorID", &[(0.0, "0"), (1.0, "16#2001"), (2.0, "0")]),
        signal("drive", "state", &[(0.0, "Switch on disabled"), (3.0, "Fault")]),
    ];
    let svg = whole(&Recording { signals, ..aborted() });
    let document = Document::parse(&svg).unwrap();
    assert_eq!(elements(&document, "path", "x").len(), 1);
    let texts = |class: &'static str| elements(&document, "rect", class).len();
    assert_eq!((texts("bx"), texts("bo"), texts("bs")), (2, 2, 1));
}

#[test]
fn only_the_sources_that_are_asked_for_are_shown() {
    let sources = vec!["axis".to_owned(), "First".to_owned()];
    let svg = timing_diagram(&aborted(), &TimingOptions { sources, ..TimingOptions::default() }).unwrap();
    let document = Document::parse(&svg).unwrap();
    let names: Vec<_> = elements(&document, "text", "n").into_iter().map(text).collect();
    assert_eq!(names, ["First", "axis"]);
    assert!(!svg.contains("4.55"), "no guide lines of others");
}

#[test]
fn what_is_missing_is_said() {
    let options = TimingOptions::default;
    assert_eq!(
        refusal(&empty(), &options()),
        "there is nothing to draw: no signals are recorded, and none of the channels `setpoint.velocity`, \
         `load.velocity`, `setpoint.position` and `load.position`: name one in `record.channels`"
    );
    let other = Recording { channels: vec![channel("current.q", "A", vec![1.0; 10])], ..empty() };
    assert!(refusal(&other, &options()).starts_with("there is nothing to draw"));
    assert_eq!(
        refusal(&aborted(), &TimingOptions { sources: vec!["Fist".into()], ..options() }),
        "no signals of `Fist` are recorded; there are those of `First`, `Second`, `axis`, `drive`, `link`"
    );
    assert_eq!(
        refusal(&other, &TimingOptions { sources: vec!["First".into()], ..options() }),
        "no signals of `First` are recorded; there are none at all"
    );
    for (from, to) in [(Some(5.0), None), (Some(2.0), Some(1.0)), (None, Some(-1.0)), (Some(f64::NAN), None)] {
        let text = refusal(&aborted(), &TimingOptions { from, to, ..options() });
        assert!(text.ends_with("choose a stretch of at least 1 ns between 0.0 s and 5.0 s"), "{text}");
    }
    assert_eq!(
        refusal(&aborted(), &TimingOptions { width: 100, ..options() }),
        "a drawing of 100 pixels; it is from 480 to 4000 pixels wide"
    );
}

#[test]
fn the_same_recording_is_the_same_to_the_byte() {
    assert_eq!(whole(&aborted()), whole(&aborted()));
}
