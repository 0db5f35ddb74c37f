//! A plan for a person.
use super::times::Times;
use super::{NAMES, PlannedMove};
use servobench_metrics::Quantity;

impl PlannedMove {
    /// Segment times, peaks against limits, duration.
    #[must_use]
    pub fn table(&self) -> String {
        let profile = &self.profile;
        let n = profile.order().derivative();
        let segments = profile.segments().flat_map(|segment| [segment.start, segment.length]);
        let all = self.dwells().map(|(.., time)| time).chain(segments).chain([profile.duration()]);
        let times = Times::new(profile.duration(), all);
        let distance = Quantity::new(profile.distance(), self.unit);
        let mut lines = vec![format!("move of {distance} in {}, order {n}", times.show(profile.duration()))];
        if let Some(samples) = profile.samples() {
            let time = Times::new(samples.time, [samples.time]).show(samples.time);
            lines.push(format!("{} samples of {time}", samples.total()));
        }
        lines.push(String::new());
        lines.extend(
            self.dwells().map(|(name, meaning, value)| format!("{name}  {:>13}   {meaning}", times.show(value))),
        );
        lines.push(String::new());
        lines.push(format!("{:<13} {:>16} {:>16} {:>9}", "", "peak", "limit", "of limit"));
        for (i, (peak, limit)) in self.peaks().zip(self.limits()).enumerate() {
            let (name, unit) = (NAMES[i + 1], self.unit_of(i + 1));
            let (peak_text, limit_text) = (Quantity::new(peak, &unit), Quantity::new(limit, &unit));
            lines.push(format!("{name:<13} {peak_text:>16} {limit_text:>16} {:>7.2} %", 100.0 * peak / limit));
        }
        lines.push(String::new());
        lines.push(format!("{:>13} {:>13}  {}", "start", "length", NAMES[n]));
        let unit = self.unit_of(n);
        lines.extend(profile.segments().map(|segment| {
            let value = Quantity::new(segment.value, &unit);
            format!("{:>13} {:>13}  {value}", times.show(segment.start), times.show(segment.length))
        }));
        lines.join("\n") + "\n"
    }
}

#[cfg(test)]
mod tests {
    use super::super::moves;

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
