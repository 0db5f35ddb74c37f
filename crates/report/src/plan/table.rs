//! A plan for a person.
use super::times::Times;
use super::{NAMES, PlannedMove};
use servobench_metrics::Quantity;

impl PlannedMove {
    /// Segment times, peaks against limits, duration: in the units in which distance and limits were given, all times
    /// in one unit.
    #[must_use]
    pub fn table(&self) -> String {
        let profile = &self.profile;
        let n = profile.order().derivative();
        let segments = profile.segments().flat_map(|segment| [segment.start, segment.length]);
        let all = self.dwells().map(|(.., time)| time).chain(segments).chain([profile.duration()]);
        let times = Times::new(profile.duration(), all);
        let distance = self.in_given_unit(0, profile.distance(), profile.distance());
        let mut lines = vec![format!("move of {distance} in {}, order {n}", times.show(profile.duration()))];
        if let Some(samples) = profile.samples() {
            let time = Times::new(samples.time, [samples.time]).show(samples.time);
            lines.push(format!("{} samples of {time}", samples.total()));
        }
        lines.push(String::new());
        lines.extend(
            self.dwells().map(|(name, meaning, value)| format!("{name}  {:>TIME$}   {meaning}", times.show(value))),
        );
        lines.push(String::new());
        lines.push(format!("{:<13} {:>QUANTITY$} {:>QUANTITY$} {:>9}", "", "peak", "limit", "of limit"));
        for (i, (peak, limit)) in self.peaks().zip(self.limits()).enumerate() {
            let (peak_text, limit_text) =
                (self.in_given_unit(i + 1, peak, limit), self.in_given_unit(i + 1, limit, limit));
            let share = 100.0 * peak / limit;
            lines.push(format!("{:<13} {peak_text:>QUANTITY$} {limit_text:>QUANTITY$} {share:>7.2} %", NAMES[i + 1]));
        }
        lines.push(String::new());
        lines.push(format!("{:>TIME$} {:>TIME$}  {}", "start", "length", NAMES[n]));
        let limit = self.limits().last().unwrap_or(f64::INFINITY);
        lines.extend(profile.segments().map(|segment| {
            let value = self.in_given_unit(n, segment.value, limit);
            format!("{:>TIME$} {:>TIME$}  {value}", times.show(segment.start), times.show(segment.length))
        }));
        lines.join("\n") + "\n"
    }

    /// Derivative `n` in the unit in which `given` (SI) was given; in SI when it was not.
    fn in_given_unit(&self, n: usize, value: f64, given: f64) -> String {
        match &self.given[n] {
            Some(quantity) if given != 0.0 => quantity.times(value / given),
            _ => Quantity::new(value, &self.unit_of(n)).to_string(),
        }
    }
}

/// `125.663706 ms` fits.
const TIME: usize = 13;
const QUANTITY: usize = 16;

#[cfg(test)]
mod tests {
    use super::super::{PlannedMove, moves};
    use servobench_motion::{Limits, Order, Profile};
    use std::f64::consts::TAU;

    /// 90° at 60 rpm and 50 rad/s²: the triangle peaks at √(π/2·50) rad/s = 8.862 rad/s, above 2π rad/s, so it cruises.
    #[test]
    fn units_are_those_of_the_user() {
        let limits = Limits { velocity: TAU, acceleration: 50.0, jerk: f64::INFINITY, snap: f64::INFINITY };
        let profile = Profile::plan(Order::Second, -TAU / 4.0, &limits).unwrap();
        let table = PlannedMove::new(profile, limits, "rad").as_given("-90 deg", ["60 rpm", "50 rad/s2"]).table();
        insta::assert_snapshot!(table, @r#"
        move of -90 deg in 375.663706 ms, order 2

        t_a  125.663706 ms   acceleration at its peak
        t_v  124.336294 ms   velocity at its peak

                                  peak            limit  of limit
        velocity                60 rpm           60 rpm  100.00 %
        acceleration         50 rad/s2        50 rad/s2  100.00 %

                start        length  acceleration
          0.000000 ms 125.663706 ms  -50 rad/s2
        125.663706 ms 124.336294 ms  0 rad/s2
        250.000000 ms 125.663706 ms  50 rad/s2
        "#);
    }

    #[test]
    fn the_published_move() {
        let table = moves::sampled(1e-3).table();
        insta::assert_snapshot!(table, @r#"
        move of 1.00 m in 1.35 s, order 4
        1350 samples of 1 ms

        t_d         0.05 s   snap at its peak
        t_j         0.05 s   jerk at its peak
        t_a         0.05 s   acceleration at its peak
        t_v         0.65 s   velocity at its peak

                                  peak            limit  of limit
        velocity              1.00 m/s         1.00 m/s  100.00 %
        acceleration         5.00 m/s²        5.00 m/s²  100.00 %
        jerk                 50.0 m/s³        50.0 m/s³  100.00 %
        snap                 1000 m/s⁴        1000 m/s⁴  100.00 %

                start        length  snap
               0.00 s        0.05 s  1000 m/s⁴
               0.05 s        0.05 s  0 m/s⁴
               0.10 s        0.05 s  -1000 m/s⁴
               0.15 s        0.05 s  0 m/s⁴
               0.20 s        0.05 s  -1000 m/s⁴
               0.25 s        0.05 s  0 m/s⁴
               0.30 s        0.05 s  1000 m/s⁴
               0.35 s        0.65 s  0 m/s⁴
               1.00 s        0.05 s  -1000 m/s⁴
               1.05 s        0.05 s  0 m/s⁴
               1.10 s        0.05 s  1000 m/s⁴
               1.15 s        0.05 s  0 m/s⁴
               1.20 s        0.05 s  1000 m/s⁴
               1.25 s        0.05 s  0 m/s⁴
               1.30 s        0.05 s  -1000 m/s⁴
        "#);
        assert!(table.lines().all(|line| line.chars().count() <= 80), "{table}");
    }
}
