//! A set-point in the terms of drive vendors.
use super::{AdviceOptions, DIGITS};
use crate::style::{Ink, Style};
use crate::text::wrapped;
use servobench_advise::{Advice, Question};
use servobench_base::Coordinate;
use servobench_metrics::digits;

/// The terms: CiA 402 objects, PLCopen inputs, Rockwell's percent of time, a smoothing time.
pub(super) fn words(question: &Question, advice: &Advice, options: &AdviceOptions<'_>, style: Style) -> String {
    let family = &question.families[advice.point.family];
    let [velocity, acceleration, jerk, snap] = advice.point.limits;
    let [.., rise, rise_of_jerk] = advice.point.boxes(question.distance);
    // User units as most drives have them.
    let (unit, scale) = if options.motion == Coordinate::Linear { ("mm", 1e3) } else { ("°", 1f64.to_degrees()) };
    let number = |value: f64| digits(value, DIGITS);
    let in_units = |value: f64| number(scale * value);
    let mut rows = vec![(
        "CiA 402",
        format!(
            "6081h {} {unit}/s, 6083h and 6084h {} {unit}/s²{}",
            in_units(velocity),
            in_units(acceleration),
            if jerk.is_finite() {
                format!(", 6086h 3 (jerk-limited), 60A4h {} {unit}/s³", in_units(jerk))
            } else {
                ", 6086h 0 (linear ramp)".to_owned()
            }
        ),
    )];
    let deceleration = in_units(acceleration);
    let of_jerk = if jerk.is_finite() { format!(", Jerk := {}", in_units(jerk)) } else { String::new() };
    rows.push((
        "PLCopen",
        format!("MC_MoveAbsolute(Velocity := {}, Acceleration := {deceleration}, Deceleration := {deceleration}{of_jerk}) in {unit}, s", in_units(velocity)),
    ));
    if jerk.is_finite() {
        // J = (A²/V)·(200/% − 1)
        let percent = 200.0 / (jerk * velocity / (acceleration * acceleration) + 1.0);
        let of_time = if percent <= 100.0 {
            format!("Jerk {} % of time", number(percent))
        } else {
            "Jerk 100 % of time at most: this ramp does not reach its acceleration".to_owned()
        };
        rows.push((
            "Rockwell",
            format!(
                "MAM Speed {}, Accel and Decel {deceleration} (units of {unit}, s), S-Curve, {of_time}",
                in_units(velocity)
            ),
        ));
        let of_snap = if snap.is_finite() {
            format!(" and a second one of {} ms", number(1e3 * rise_of_jerk))
        } else {
            String::new()
        };
        rows.push((
            "smoothing",
            format!("a trapezoid through a moving average of {} ms{of_snap} is the same profile", number(1e3 * rise)),
        ));
    } else {
        rows.push((
            "Rockwell",
            format!("MAM Speed {}, Accel and Decel {deceleration}, Trapezoidal", in_units(velocity)),
        ));
    }
    if snap.is_finite() {
        rows.push((
            "snap",
            format!(
                "{} {unit}/s⁴: most drives have no key for it; `servobench plc export` writes a block that plans it",
                in_units(snap)
            ),
        ));
    }
    if let (Some(kind), Some(frequency)) = (&family.shaper, options.shaper_frequency) {
        rows.push(("shaper", format!("{kind} at {} Hz behind the profile", number(frequency))));
    }
    let row = |(name, text): &(&str, String)| {
        let lines = wrapped(text, style.width.saturating_sub(11));
        format!("{name:<11}{}\n", lines.join(&format!("\n{}", " ".repeat(11))))
    };
    let heading = style.paint(Ink::Heading, "The same in other words");
    format!("\n{heading}\n{}", rows.iter().map(row).collect::<String>())
}
