//! The stability of the master's position loop as given in `docs/fieldbus.md`, for cycles much shorter than the delay D.
//!
//! Oracle: the open loop L(s) = K·(1 + 1/(s·T_i) + T_d·s/(1 + s·T_d/10))·e^(−s·D)/s at s = jθ/D, whose magnitude falls with θ.
use std::f64::consts::{FRAC_PI_2, PI};

/// T_i/D (infinite without an integrator) and T_d/D.
#[derive(Clone, Copy)]
struct Controller {
    integral: f64,
    derivative: f64,
}

impl Controller {
    /// |L| for K·D = 1, and its phase.
    fn open_loop(self, theta: f64) -> (f64, f64) {
        // 1 + 1/(jθτ) + jθδ/(1 + jθδ/10) as real and imaginary part.
        let filtered = theta * self.derivative / 10.0;
        let lead = theta * self.derivative / (1.0 + filtered * filtered);
        let (real, imaginary) = (1.0 + lead * filtered, lead - 1.0 / (theta * self.integral));
        (real.hypot(imaginary) / theta, imaginary.atan2(real) - FRAC_PI_2 - theta)
    }

    /// The largest stable K·D, at which the phase first falls to −π.
    fn largest(self) -> f64 {
        // With an integral the phase begins below −π; it is above between two crossings, of which the last one counts.
        let theta = (1..40_000).rev().map(|k| f64::from(k) * 1e-4).find(|theta| self.open_loop(*theta).1 > -PI);
        theta.map_or(0.0, |theta| 1.0 / self.open_loop(theta).0)
    }

    /// The phase margin at the gain K·D (degrees).
    fn margin(self, gain: f64) -> f64 {
        let theta = (1..4_000_000).map(|k| f64::from(k) * 1e-6).find(|theta| gain * self.open_loop(*theta).0 < 1.0);
        theta.map_or(f64::NAN, |theta| (self.open_loop(theta).1 + PI).to_degrees())
    }
}

/// The cells of the row of the page that begins with `head`.
fn row(page: &str, head: &str) -> Vec<String> {
    let line = page.lines().find(|line| line.starts_with(head)).unwrap_or_else(|| panic!("no row {head}"));
    line.trim_matches('|').split('|').skip(1).map(|cell| cell.trim().to_owned()).collect()
}

#[test]
fn the_page_tells_the_largest_gains_and_the_margins_of_the_loop() {
    let path = concat!(env!("CARGO_MANIFEST_DIR"), "/../../docs/fieldbus.md");
    let page = std::fs::read_to_string(path).unwrap();
    let times = row(&page, "| T_i/D |");
    let gains = row(&page, "| K·D = θ·sin θ");
    let margins = row(&page, "| phase margin at half of that |");
    assert_eq!((times[0].as_str(), gains[0].as_str(), margins[0].as_str()), ("≤ 1", "unstable", "–"));
    assert!(Controller { integral: 0.999, derivative: 0.0 }.largest() < 1e-6);
    for ((time, gain), margin) in times.iter().zip(&gains).zip(&margins).skip(1) {
        let integral = if time == "none" { f64::INFINITY } else { time.parse().unwrap() };
        let controller = Controller { integral, derivative: 0.0 };
        let largest = controller.largest();
        assert_eq!(format!("{largest:.2}"), *gain, "{time}: {largest}");
        let found = controller.margin(0.5 * largest);
        assert_eq!(format!("{found:.0}°"), *margin, "{time}: {found}");
    }
    // The page's statements about the derivative.
    let with = |derivative| Controller { integral: f64::INFINITY, derivative }.largest();
    assert!(page.contains("the largest K·D from 1.57 to 1.78; from 0.5·D on it lowers it"));
    assert_eq!((format!("{:.2}", with(0.0)), format!("{:.2}", with(0.2))), ("1.57".to_owned(), "1.78".to_owned()));
    assert!(with(0.4) > with(0.0) && with(0.5) < with(0.0), "{} {}", with(0.4), with(0.5));
}
