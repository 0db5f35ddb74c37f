//! Physical quantities: unit, dimension, spelling, bound.
use crate::after;

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
            "30:13: `bandwidth` must be a bandwidth (Hz or rad/s), but \"60 1/s\" is a position gain (1/s)",
        ),
        (
            "max_current = \"13.3 Arms\"",
            "max_current = \"13.3 A\"",
            "22:15: `max_current` must be a current (Arms or Apk), but \"13.3 A\" is a current (A); say whether the \
             amplitude or the effective value is meant: `Apk` or `Arms`, `Vpk` or `Vrms`",
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
        (
            "mass = \"40 kg\"",
            "mass = \"forty kg\"",
            "9:9: `mass`: a quantity begins with a number; write as in \"250 mm\"",
        ),
        ("mass = \"40 kg\"", "mass = \"4,5 kg\"", "9:10: `mass`: the decimal sign is a point"),
        (
            "damping = \"1659 N s/m\"",
            "damping = \"1659 N/m s\"",
            "11:21: `damping`: a unit ends with its quotient; write \"N s/m\" or \"N/(m s)\", whichever is meant",
        ),
        (
            "mass = \"40 kg\"",
            "mass = \"40 kg\\u0020?\"",
            "9:8: `mass`: this is no unit; write as in \"250 mm\", \"30 m/min\" or \"0.5 kg m2\"",
        ),
    ];
    for (old, new, said) in cases {
        assert_eq!(after(old, new), [said], "{new}");
    }
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
            "13:10: `static` is 15, below `coulomb`, which is 20 (SI); friction at rest is at least that of sliding",
        ),
    ];
    for (old, new, said) in cases {
        assert_eq!(after(old, new), [said], "{new}");
    }
}
