//! What stands between the planner and the drive.
use super::arguments::Arguments;
use crate::args::{PlanArgs, PlanProfile};
use servobench_motion::shape::{Shaper, ShaperKind};
use servobench_planner::{Averages, Filter, Shaping};

/// The filters; one that is wrong is left out, and told.
pub(super) fn filter(args: &PlanArgs, arguments: &mut Arguments<'_>) -> Filter {
    if args.profile == PlanProfile::Position {
        for name in ["shaper", "averages"] {
            if arguments.is_given(name) {
                arguments.mistake(format!(
                    "--{name} is not for --profile position, whose commands a drive follows as they are: leave it out, or \
                     choose --profile pvt"
                ));
            }
        }
    }
    Filter { shaper: shaper(args, arguments), averages: averages(arguments) }
}

fn shaper(args: &PlanArgs, arguments: &mut Arguments<'_>) -> Option<Shaping> {
    arguments.take("shaper");
    let others = ["shaper-frequency", "shaper-damping", "shaper-tolerable"];
    let Some(kind) = args.shaper else {
        for name in others {
            if arguments.take(name).is_some() {
                arguments.mistake(format!("--{name} is that of a --shaper: choose one, or leave it out"));
            }
        }
        return None;
    };
    if !arguments.is_given("shaper-frequency") {
        arguments.missing("shaper-frequency", "a shaper is made for a vibration, as \"12 Hz\"");
    }
    let frequency = arguments.frequency("shaper-frequency");
    let damping = if arguments.is_given("shaper-damping") { arguments.ratio("shaper-damping") } else { Some(0.0) };
    let tolerable = if arguments.is_given("shaper-tolerable") {
        arguments.ratio("shaper-tolerable")
    } else {
        Some(Shaper::TOLERABLE)
    };
    if arguments.is_given("shaper-tolerable") && kind != ShaperKind::Ei {
        arguments.mistake("--shaper-tolerable is for --shaper ei: the others leave nothing at the frequency");
    }
    let (frequency, damping, tolerable) = (frequency?, damping?, tolerable?);
    let shaping = Shaping { shaper: Shaper::new(kind, tolerable), frequency, damping };
    shaping.impulses().map_err(|error| arguments.mistake(format!("--shaper: {error}"))).ok()?;
    Some(shaping)
}

fn averages(arguments: &mut Arguments<'_>) -> Option<Averages> {
    if !arguments.is_given("averages") {
        return None;
    }
    let lengths = arguments.times("averages");
    if !arguments.is_given("sample-time") {
        arguments.missing("sample-time", "averages are those of samples, as \"1 ms\"");
    }
    let sample_time = arguments.time("sample-time");
    Some(Averages { lengths: lengths?, sample_time: sample_time? })
}
