//! A plan for a person.
use super::{NAMES, PlannedMove, seconds};
use servobench_metrics::Quantity;

impl PlannedMove {
    /// Segment times, peaks against limits, duration.
    #[must_use]
    pub fn table(&self) -> String {
        let profile = &self.profile;
        let n = profile.order().derivative();
        let mut lines = vec![format!(
            "move of {} in {}, order {n}",
            Quantity::new(profile.distance(), self.unit),
            seconds(profile.duration())
        )];
        if let Some(samples) = profile.samples() {
            lines.push(format!("{} samples of {}", samples.total(), seconds(samples.time)));
        }
        lines.push(String::new());
        lines.extend(self.dwells().map(|(name, meaning, value)| format!("{name}  {:>12}   {meaning}", seconds(value))));
        lines.push(String::new());
        lines.push(format!("{:<13} {:>16} {:>16} {:>9}", "", "peak", "limit", "of limit"));
        for (i, (peak, limit)) in self.peaks().zip(self.limits()).enumerate() {
            let (name, unit) = (NAMES[i + 1], self.unit_of(i + 1));
            let (peak_text, limit_text) = (Quantity::new(peak, &unit), Quantity::new(limit, &unit));
            lines.push(format!("{name:<13} {peak_text:>16} {limit_text:>16} {:>7.2} %", 100.0 * peak / limit));
        }
        lines.push(String::new());
        lines.push(format!("{:>12} {:>12}  {}", "start", "length", NAMES[n]));
        let unit = self.unit_of(n);
        lines.extend(profile.segments().map(|segment| {
            let value = Quantity::new(segment.value, &unit);
            format!("{:>12} {:>12}  {value}", seconds(segment.start), seconds(segment.length))
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
        1350 samples of 0.001 s

        t_d        0.05 s   snap at its peak
        t_j        0.05 s   jerk at its peak
        t_a        0.05 s   acceleration at its peak
        t_v        0.65 s   velocity at its peak

                                  peak            limit  of limit
        velocity              1.00 m/s         1.00 m/s  100.00 %
        acceleration         5.00 m/s²        5.00 m/s²  100.00 %
        jerk                 50.0 m/s³        50.0 m/s³  100.00 %
        snap                 1000 m/s⁴        1000 m/s⁴  100.00 %

               start       length  snap
                 0 s       0.05 s  1000 m/s⁴
              0.05 s       0.05 s  0 m/s⁴
               0.1 s       0.05 s  -1000 m/s⁴
              0.15 s       0.05 s  0 m/s⁴
               0.2 s       0.05 s  -1000 m/s⁴
              0.25 s       0.05 s  0 m/s⁴
               0.3 s       0.05 s  1000 m/s⁴
              0.35 s       0.65 s  0 m/s⁴
                 1 s       0.05 s  -1000 m/s⁴
              1.05 s       0.05 s  0 m/s⁴
               1.1 s       0.05 s  1000 m/s⁴
              1.15 s       0.05 s  0 m/s⁴
               1.2 s       0.05 s  1000 m/s⁴
              1.25 s       0.05 s  0 m/s⁴
               1.3 s       0.05 s  -1000 m/s⁴
        "#);
        assert!(table.lines().all(|line| line.chars().count() <= 80), "{table}");
    }
}
