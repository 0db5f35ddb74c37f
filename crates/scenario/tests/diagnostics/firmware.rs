//! Blocks of the firmware for imperfections of real hardware.
use crate::{AXIS, mistakes, warnings};

fn with(lines: &str) -> Vec<String> {
    mistakes(&format!("{AXIS}\n{lines}\n"))
}

/// The only mistake contains all of `parts`.
fn says(found: &[String], parts: &[&str]) {
    assert!(found.len() == 1 && parts.iter().all(|part| found[0].contains(part)), "{found:?}");
}

#[test]
fn a_filter_has_the_keys_of_its_kind() {
    let filter = |keys: &str| with(&format!("[[drive.filter]]\n{keys}"));
    assert_eq!(filter("kind = \"notch\"\nfrequency = \"400 Hz\"\nzero_damping = 0.1\npole_damping = 0.5"), [""; 0]);
    assert_eq!(filter("kind = \"low-pass\"\nfrequency = \"400 Hz\"\norder = 2\ndamping = 0.6"), [""; 0]);
    says(&filter("kind = \"low-pass\"\nfrequency = \"400 Hz\"\npole_damping = 0.6"), &["is not for a low-pass"]);
    says(&filter("kind = \"low-pass\"\nfrequency = \"400 Hz\"\ndamping = 0.6"), &["first order", "order = 2"]);
    says(&filter("kind = \"notch\""), &["missing `frequency` in `drive.filter`"]);
    says(&filter("kind = \"bi-quad\"\nzero_frequency = \"400 Hz\""), &["missing `pole_frequency`"]);
    says(&filter("kind = \"notch\"\nfrequency = \"4 kHz\""), &["below half the rate of the velocity loop, 4000 Hz"]);
    let five = "[[drive.filter]]\nkind = \"notch\"\nfrequency = \"400 Hz\"\n".repeat(5);
    says(&with(&five), &["more than 4 filters"]);
}

#[test]
fn what_chooses_the_current_is_one_thing() {
    let current =
        |keys: &str| mistakes(&AXIS.replace("bandwidth = \"1 kHz\"", &format!("bandwidth = \"1 kHz\"\n{keys}")));
    assert_eq!(current("strategy = \"mtpa\"\nfield_weakening = true\nfield_weakening_feedback = \"10 Hz\""), [""; 0]);
    says(&current("strategy = \"mtpa\"\nd_reference = \"-1 Apk\""), &["has no `d_reference`"]);
    let unused = AXIS.replace("bandwidth = \"1 kHz\"", "bandwidth = \"1 kHz\"\nfield_weakening_share = 0.9");
    says(&warnings(&unused), &["`field_weakening_share` is not used"]);
    says(&current("dead_time_compensation = { dead_time = \"2 us\" }"), &["missing `frequency`"]);
}

/// A motor without magnets has torque from different inductances and a current in d; values relative to the magnets' flux are refused.
#[test]
fn a_motor_without_magnets_needs_saliency_and_a_current_in_d() {
    let motor = |inductance: &str, current: &str, more: &str| {
        let text = AXIS
            .replace("inductance = \"3.5 mH\"", inductance)
            .replace("flux_linkage = \"0.06 V s\"", "flux_linkage = \"0 V s\"")
            .replace("bandwidth = \"1 kHz\"", &format!("bandwidth = \"1 kHz\"\n{current}"));
        mistakes(&format!("{text}\n{more}\n"))
    };
    let (unlike, alike) = ("inductance_d = \"35 mH\"\ninductance_q = \"6 mH\"", "inductance = \"3.5 mH\"");
    let mtpa = "strategy = \"mtpa\"";
    assert_eq!(motor(unlike, mtpa, ""), [""; 0]);
    assert_eq!(motor(unlike, "d_reference = \"4 Apk\"", ""), [""; 0]);
    says(
        &motor(alike, mtpa, ""),
        &["`flux_linkage` of 0 V s and equal inductances of 0.0035 H", "`inductance_d` and an"],
    );
    says(
        &motor(unlike, "", ""),
        &["has no torque at a d-axis current of 0", "`strategy = \"mtpa\"`, or a `d_reference`"],
    );
    says(&motor(unlike, "d_reference = \"-4 Apk\"", ""), &["no torque in its direction"]);
    for (key, table) in [
        ("`iron_loss` is the loss", "[motor.iron_loss]\nspeed = \"3000 rpm\"\neddy = \"6 W\""),
        ("`flux_harmonic` has parts", "[[motor.flux_harmonic]]\norder = 6\nd = 0.01"),
        ("`saturation` is a share", "[motor.saturation]\ncurrent = \"10 Apk\"\nshare = 0.9"),
    ] {
        says(&motor(unlike, mtpa, table), &[key]);
    }
    let believed = "[drive.estimate.motor]\nflux_linkage = \"0 V s\"";
    says(&with(believed), &["the motor of the drive's estimate has no torque"]);
    says(&with(&believed.replace('0', "-1")), &["`flux_linkage` must be zero or more"]);
}

#[test]
fn a_thermal_load_has_one_time() {
    let motor = |keys: &str| with(&format!("[drive.i2t]\nmotor = {{ {keys} }}"));
    assert_eq!(motor("continuous_current = \"5 Arms\", peak_time = \"2 s\""), [""; 0]);
    says(&motor("continuous_current = \"5 Arms\""), &["missing `time_constant`", "peak_time"]);
    says(&motor("continuous_current = \"14 Arms\", peak_time = \"2 s\""), &["is not above the continuous current"]);
    let fault = "continuous_current = \"5 Arms\", time_constant = \"2 s\", reaction = \"fault\"";
    says(&motor(fault), &["without a `[bus]`"]);
}

#[test]
fn a_schedule_goes_up_and_a_p_loop_follows_its_reference() {
    says(&with("[drive.gain_schedule]\nfrom = \"100 rpm\"\nto = \"90 rpm\""), &["`to` must be above `from`"]);
    let p = AXIS.replace("bandwidth = \"60 Hz\"", "bandwidth = \"60 Hz\"\nkind = \"p\"\nreference_weight = 0.5");
    says(&mistakes(&p), &["a P loop has no `reference_weight`"]);
    let nine = "[[drive.cogging]]\norder = 12\namplitude = \"0.02 Nm\"\n".repeat(9);
    says(&with(&nine), &["more than 8 harmonics"]);
}

/// On the axis of the other tests, over a bus.
fn supervised(keys: &str) -> Vec<String> {
    with(&format!("[bus]\ncycle = \"1 ms\"\nunits = {{ drive = 1, axis = \"1 um\" }}\n[drive.supervision]\n{keys}"))
}

#[test]
fn a_supervision_needs_somebody_to_tell_and_thresholds_in_order() {
    let all = "undervoltage = \"200 V\"\novervoltage = \"400 V\"\noverspeed = \"6500 rpm\"\n\
        commutation = { speed = \"200 rpm\", current = \"4 Arms\" }\nstall = { speed = \"5 rpm\", time = \"0.2 s\" }\n\
        phase_loss = { current = \"1 Arms\", time = \"10 ms\" }";
    assert_eq!(supervised(all), [""; 0]);
    says(&with(&format!("[drive.supervision]\n{all}")), &["without a `[bus]`"]);
    says(&supervised("undervoltage = \"400 V\"\novervoltage = \"400 V\""), &["`overvoltage` must be above"]);
    says(&supervised("stall = { speed = \"5 rpm\" }"), &["missing `time`"]);
    says(&supervised("phase_loss = { current = \"0 Arms\", time = \"10 ms\" }"), &["current", "0"]);
}

#[test]
fn a_phase_is_lost_at_a_time_only_if_it_is_lost() {
    let connection = |keys: &str| with(&format!("[motor.connection]\n{keys}"));
    assert_eq!(connection("swapped = \"ab\"\nopen = \"c\"\nopen_at = \"0.3 s\""), [""; 0]);
    says(&connection("open_at = \"0.3 s\""), &["`open_at` is when a phase is lost", "give `open`"]);
    says(&connection("swapped = \"aa\""), &["aa"]);
    let saturated = connection("open = \"c\"\n[motor.saturation]\ncurrent = \"30 Apk\"\nshare = 0.7");
    says(&saturated, &["a motor that saturates is not simulated with a lost phase", "leave out one of"]);
}
