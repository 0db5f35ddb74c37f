//! Physical quantities: unit, dimension, spelling, bound.
use crate::{after, mistakes};

#[test]
fn a_bare_number_is_told_its_unit() {
    let cases = [
        (
            "move_to = \"250 mm\"",
            "move_to = 250",
            "43:11: `move_to` needs a unit, got the bare number 250; write \"250 mm\"",
        ),
        ("mass = \"40 kg\"", "mass = 40.5", "9:8: `mass` needs a unit, got the bare number 40.5; write \"40.5 kg\""),
        ("mass = \"40 kg\"", "mass = \"40\"", "9:8: `mass` needs a unit, got the bare number 40; write \"40 kg\""),
        (
            "base_rate = \"16 kHz\"",
            "base_rate = 16000",
            "4:13: `base_rate` needs a unit, got the bare number 16000; write \"16000 Hz\"",
        ),
        (
            "settling_time = \"50 ms\"",
            "settling_time = 0.05",
            "50:17: `settling_time` needs a unit, got the bare number 0.05; write \"0.05 s\"",
        ),
    ];
    for (old, new, said) in cases {
        assert_eq!(after(old, new), [said], "{new}");
    }
}

/// Each value by itself would pass, and the gains derived from them would be infinite or zero.
#[test]
fn a_number_beyond_every_machine_is_refused() {
    let cases = [
        ("lead = \"10 mm\"", "lead = \"1e-28 mm\"", "7:9: `lead`: the number is too small: below 1e-30 in SI"),
        (
            "bandwidth = \"60 Hz\"",
            "bandwidth = \"1e31 Hz\"",
            "30:14: `bandwidth`: the number is too large: above 1e30 in SI",
        ),
        (
            "lead = \"10 mm\"",
            "lead = \"10 mm\"\ngear_ratio = 1e31",
            "8:14: `gear_ratio`: the number is too large: above 1e30 in SI",
        ),
        (
            "lead = \"10 mm\"",
            "lead = \"10 mm\"\ngear_ratio = 1e-31",
            "8:14: `gear_ratio`: the number is too small: below 1e-30 in SI",
        ),
    ];
    for (old, new, said) in cases {
        assert_eq!(after(old, new), [said], "{new}");
    }
}

#[test]
fn a_wrong_dimension_names_both() {
    let cases = [
        ("mass = \"40 kg\"", "mass = \"40 N\"", "9:8: `mass` must be a mass, but \"40 N\" is a force (N)"),
        (
            "stiffness = \"43 N/um\"",
            "stiffness = \"43 N um\"",
            "10:13: `stiffness` must be a stiffness, but \"43 N um\" is a torque (Nm)",
        ),
        (
            "move_to = \"250 mm\"",
            "move_to = \"90 deg\"",
            "43:11: `move_to` must be a length, but \"90 deg\" is an angle (deg)",
        ),
        (
            "gain = \"80 1/s\"",
            "gain = \"80 Hz\"",
            "33:8: `gain` must be a position gain (1/s), but \"80 Hz\" is a frequency (Hz)",
        ),
        (
            "bandwidth = \"60 Hz\"",
            "bandwidth = \"60 1/s\"",
            "30:13: `bandwidth` must be a bandwidth (Hz or rad/s), but \"60 1/s\" is a position gain (1/s); write \
             `rad/s` for the corner of a loop; its frequency in `Hz` is that over 2π",
        ),
        (
            "max_current = \"13.3 Arms\"",
            "max_current = \"13.3 A\"",
            "22:15: `max_current` must be a current (Arms or Apk), but \"13.3 A\" is neither an amplitude nor an RMS value; write \
             `Arms` or `Apk`, `Vrms` or `Vpk`",
        ),
        (
            "dc_link = \"320 V\"",
            "dc_link = \"230 Vrms\"",
            "24:11: `dc_link` must be a voltage, but \"230 Vrms\" is an amplitude or an RMS value; plain `A` or `V` is needed here",
        ),
    ];
    for (old, new, said) in cases {
        assert_eq!(after(old, new), [said], "{new}");
    }
}

#[test]
fn what_is_no_quantity_is_pointed_at_inside_the_text() {
    let cases = [
        ("mass = \"40 kg\"", "mass = \"40 Kg\"", "9:12: `mass`: unknown unit `Kg`; did you mean `kg`?"),
        ("mass = \"40 kg\"", "mass = \"nan kg\"", "9:9: `mass`: the number must be finite"),
        ("mass = \"40 kg\"", "mass = \"forty kg\"", "9:9: `mass`: a quantity begins with a number; write \"1 kg\""),
        ("mass = \"40 kg\"", "mass = \"4,5 kg\"", "9:10: `mass`: the decimal sign is a point"),
        (
            "damping = \"1659 N s/m\"",
            "damping = \"1659 N/m s\"",
            "11:21: `damping`: a unit ends with its quotient; write \"N s/m\" or \"N/(m s)\", whichever is meant",
        ),
        ("mass = \"40 kg\"", "mass = \"40 kg\\u0020?\"", "9:8: `mass`: not a unit; write \"1 kg\""),
    ];
    for (old, new, said) in cases {
        assert_eq!(after(old, new), [said], "{new}");
    }
}

/// Proposals must be right: a wrong guess of a prefix would be wrong by a power of ten.
#[test]
fn engineers_spellings_get_the_unit_that_is_meant() {
    let cases = [
        ("move_to = \"250 mm\"", "move_to = \"250 MM\"", "43:16: `move_to`: unknown unit `MM`; did you mean `mm`?"),
        ("window = \"10 um\"", "window = \"10 micron\"", "48:14: `window`: unknown unit `micron`; did you mean `um`?"),
        ("move_to = \"250 mm\"", "move_to = \"9.8 in\"", "43:16: `move_to`: unknown unit `in`; an inch is 25.4 mm"),
        (
            "acceleration = \"6 m/s2\"",
            "acceleration = \"0.5 g\"",
            "40:16: `acceleration` must be an acceleration, but \"0.5 g\" is a mass (kg); `g` is the gram; gravity is \
             9.80665 m/s2",
        ),
        ("damping = \"1659 N s/m\"", "damping = \"1659 Ns/m\"", "11:17: `damping`: unknown unit `Ns`; write `N s`"),
        (
            "base_rate = \"16 kHz\"",
            "base_rate = \"16 KHZ\"",
            "4:17: `base_rate`: unknown unit `KHZ`; did you mean `kHz`?",
        ),
    ];
    for (old, new, said) in cases {
        assert_eq!(after(old, new), [said], "{new}");
    }
    let turning = "[run]\nbase_rate = \"16 kHz\"\n[axis]\nmotion = \"rotary\"\n[setpoint]\nvelocity = \"3000 1/min\"\n";
    let said = "6:12: `velocity` must be an angular velocity, but \"3000 1/min\" is a position gain (1/s); an angle has a \
                unit: write `rpm` for revolutions per minute, `rev/s` or `rad/s`";
    assert!(mistakes(turning).contains(&said.to_owned()), "{:#?}", mistakes(turning));
}

#[test]
fn numbers_out_of_their_bounds() {
    let cases = [
        ("mass = \"40 kg\"", "mass = \"-40 kg\"", "9:8: `mass` must be above zero, got \"-40 kg\""),
        ("mass = \"40 kg\"", "mass = nan", "9:8: `mass` needs a unit, got the bare number nan; write \"1 kg\""),
        ("coulomb = \"20 N\"", "coulomb = \"-1 N\"", "12:11: `coulomb` must be zero or more, got \"-1 N\""),
        (
            "inertia = \"1.57 kg cm2\"",
            "inertia = \"-1 kg m2\"",
            "21:11: `inertia` must be above zero, got \"-1 kg m2\"",
        ),
        ("pole_pairs = 4", "pole_pairs = 0", "17:14: `pole_pairs` must be a whole number from 1 to 1000, got 0"),
        ("pole_pairs = 4", "pole_pairs = 4.5", "17:14: `pole_pairs` must be a whole number from 1 to 1000, got 4.5"),
        ("order = 3", "order = 5", "38:9: `order` must be a whole number from 2 to 4, got 5"),
        ("velocity = true", "velocity = 1.5", "35:12: `velocity` must be from 0 to 1, got 1.5"),
        ("velocity = true", "velocity = inf", "35:12: `velocity` must be finite, got inf"),
        (
            "base_rate = \"16 kHz\"",
            "base_rate = \"16000.5 Hz\"",
            "4:13: `base_rate`: a rate must be a whole number of hertz from 1 to 4294967295, got 16000.5 Hz",
        ),
        (
            "base_rate = \"16 kHz\"",
            "base_rate = \"1 GHz\"",
            "4:13: `base_rate` must be at most 10000000 Hz, got \"1 GHz\"",
        ),
        (
            "static = \"32 N\"",
            "static = \"15 N\"",
            "13:10: `static` is 15 N, below `coulomb`, which is 20 N; friction at rest is at least that of sliding",
        ),
    ];
    for (old, new, said) in cases {
        assert_eq!(after(old, new), [said], "{new}");
    }
}
