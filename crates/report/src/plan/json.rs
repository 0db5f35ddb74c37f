//! A plan for a program.
use super::{NAMES, PlannedMove};
use crate::error::ReportError;
use crate::ordered::Ordered;
use serde::Serialize;

/// A plan; values are SI.
#[derive(Debug, Serialize)]
struct Plan {
    order: usize,
    /// Unit of positions.
    unit: &'static str,
    distance: f64,
    duration_s: f64,
    /// `t_d` … `t_v` (s).
    #[serde(flatten)]
    dwells: Ordered<f64>,
    /// What the pulses of the highest derivative reach, signed: `snap_effective` at order 4.
    #[serde(flatten)]
    effective: Ordered<f64>,
    /// Largest magnitudes.
    peaks: Ordered<f64>,
    #[serde(flatten)]
    samples: Option<Samples>,
    segments: Vec<Segment>,
}

#[derive(Debug, Serialize)]
struct Samples {
    sample_time_s: f64,
    samples: u64,
}

/// A stretch of constant highest derivative.
#[derive(Debug, Serialize)]
struct Segment {
    start_s: f64,
    length_s: f64,
    value: f64,
}

impl PlannedMove {
    /// The plan as JSON, in SI.
    ///
    /// # Errors
    /// [`ReportError::Json`].
    pub fn json(&self) -> Result<String, ReportError> {
        let profile = &self.profile;
        let n = profile.order().derivative();
        let effective = (format!("{}_effective", NAMES[n]), profile.amplitude());
        let peaks = NAMES[1..].iter().map(|name| (*name).to_owned()).zip(self.peaks());
        let samples = profile.samples();
        let plan = Plan {
            order: n,
            unit: self.unit,
            distance: profile.distance(),
            duration_s: profile.duration(),
            dwells: self.dwells().map(|(name, _, value)| (name.to_owned(), value)).collect(),
            effective: [effective].into_iter().collect(),
            peaks: peaks.collect(),
            samples: samples.map(|samples| Samples { sample_time_s: samples.time, samples: samples.total() }),
            segments: profile
                .segments()
                .map(|segment| Segment { start_s: segment.start, length_s: segment.length, value: segment.value })
                .collect(),
        };
        Ok(serde_json::to_string_pretty(&plan)? + "\n")
    }
}

#[cfg(test)]
mod tests {
    use super::super::moves;
    use servobench_motion::Order;

    /// Lambrechts' limits at order 2: 1 m at 1 m/s, and 0.2 s more for 5 m/s² up and down.
    #[test]
    fn a_trapezoid() {
        insta::assert_snapshot!(moves::lambrechts(Order::Second).json().unwrap(), @r#"
        {
          "order": 2,
          "unit": "m",
          "distance": 1.0,
          "duration_s": 1.2,
          "t_a": 0.2,
          "t_v": 0.8,
          "acceleration_effective": 5.0,
          "peaks": {
            "velocity": 1.0,
            "acceleration": 5.0
          },
          "segments": [
            {
              "start_s": 0.0,
              "length_s": 0.2,
              "value": 5.0
            },
            {
              "start_s": 0.2,
              "length_s": 0.8,
              "value": 0.0
            },
            {
              "start_s": 1.0,
              "length_s": 0.2,
              "value": -5.0
            }
          ]
        }
        "#);
    }

    #[test]
    fn samples_are_counted() {
        let plan: serde_json::Value = serde_json::from_str(&moves::sampled(1e-3).json().unwrap()).unwrap();
        assert_eq!((&plan["samples"], &plan["sample_time_s"]), (&1350.into(), &1e-3.into()), "{plan}");
        assert_eq!(plan["segments"].as_array().unwrap().len(), 15);
    }
}
