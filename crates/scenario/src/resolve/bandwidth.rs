//! Loops whose bandwidth is too high for their rate.
//!
//! A loop of bandwidth ω with period T around an integrator,
//!
//! ```text
//! y(k+1) = y(k) + ωT·(r − y(k))              z − 1 + ωT = 0          stable for ωT < 2: below rate/π
//! y(k+1) = y(k) + ωT·(r − y(k−1))            z² − z + ωT = 0         stable for ωT < 1: below rate/2π
//! ```
//! the second with the period that a current loop takes to compute its voltage. Any other element of the loop (a faster loop, a
//! filter, a spring) only lowers that bound. Source: Åström, Wittenmark, *Computer-Controlled Systems*, 3rd ed., §3.2 (Jury).
use crate::diagnostic::Report;
use crate::file::File;
use crate::scenario::Actuator;
use crate::source::Span;
use servobench_base::{Dq, Rate};
use servobench_drive::current::Tuning;
use std::f64::consts::{PI, TAU};

/// Sampling of a loop.
struct Sampled {
    name: &'static str,
    /// Bandwidth ω (rad/s).
    bandwidth: f64,
    rate: Rate,
    /// Divisor of the rate: the loop is unstable from a bandwidth of `rate/limit` (Hz) on.
    limit: f64,
    /// The limit in words.
    limit_in_words: &'static str,
    /// Periods from a sample to the middle of its effect.
    delay: f64,
    /// Places of bandwidth and rate.
    places: Vec<Option<Span>>,
}

/// Share of the rate above which a bandwidth causes a warning.
const DOUBTFUL: f64 = 0.1;

/// Warns of loops that are unstable on any axis, and of those near it. They are not refused: a bench may show how a loop diverges.
pub(super) fn check(file: &File, actuator: &Actuator, report: &mut Report) {
    let (Some(given), Some(drive)) = (file.drive.given(), actuator.drive()) else { return };
    let params = &drive.params;
    if let (Some((current, rate)), Some(tuning), Some(keys)) =
        (params.current_loop(), drive.current_tuning, given.current.given())
    {
        let (bandwidth, gain) = match tuning {
            Tuning::Bandwidth(bandwidth) => (bandwidth, None),
            Tuning::Gains(Dq { d, q }) => {
                let [d, q] = [d / current.motor.inductance.d, q / current.motor.inductance.q];
                if d > q { (d, keys.gain_d.span()) } else { (q, keys.gain_q.span()) }
            }
        };
        let places = vec![keys.bandwidth.span(), gain, keys.rate.span()];
        let (limit, limit_in_words) = (TAU, "rate/2π");
        Sampled { name: "current", bandwidth, rate, limit, limit_in_words, delay: 1.5, places }.check(report);
    }
    let inertia = drive.estimate.inertia_at_the_motor();
    if let Some(keys) = given.velocity.given().filter(|_| inertia > 0.0) {
        let places = vec![keys.bandwidth.span(), keys.gain.span(), keys.rate.span()];
        Sampled::cascaded("velocity", params.velocity.k_p / inertia, params.velocity_rate(), places).check(report);
    }
    if let Some(keys) = given.position.given() {
        let places = vec![keys.bandwidth.span(), keys.gain.span(), keys.rate.span()];
        Sampled::cascaded("position", params.position_gain, params.position_rate(), places).check(report);
    }
}

impl Sampled {
    fn cascaded(name: &'static str, bandwidth: f64, rate: Rate, places: Vec<Option<Span>>) -> Self {
        Self { name, bandwidth, rate, limit: PI, limit_in_words: "rate/π", delay: 0.5, places }
    }

    fn check(&self, report: &mut Report) {
        let (bandwidth, rate) = (self.bandwidth / TAU, f64::from(self.rate.hertz()));
        // Values of the scenario itself are blamed before those of a model.
        let Some(place) = self.places.iter().flatten().min_by_key(|span| span.source) else { return };
        let Self { name, limit_in_words, .. } = self;
        let it = format!("the {name} loop has a bandwidth of {bandwidth:.1} Hz at a rate of {rate} Hz");
        let most = rate / self.limit;
        if bandwidth >= most {
            let message = format!("{it}: it is unstable from {limit_in_words} on, {most:.1} Hz");
            report.warning(*place, message, "lower the bandwidth or raise the rate");
        } else if bandwidth > DOUBTFUL * rate {
            let phase = 360.0 * self.delay * bandwidth / rate;
            let message = format!("{it}: {} periods of delay take {phase:.0}° of its phase", self.delay);
            report.warning(*place, message, "a tenth of the rate is usual at most");
        }
    }
}
