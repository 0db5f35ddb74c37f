//! The request as JSON.
use crate::options::ViewOptions;
use serde::{Deserialize, Serialize};
use thiserror::Error;

/// Name and version of the format.
const FORMAT: &str = "servobench-view/1";

/// Everything to be shown that is not in the recordings.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Request {
    /// Labels of the recordings, in their order; none for a single run.
    pub labels: Vec<String>,
    /// Data shown beside the channels.
    pub options: ViewOptions,
}

/// Reasons why a text is not a request.
#[derive(Debug, Error)]
pub enum RequestError {
    /// The text is not JSON, or has other fields.
    #[error("standard input is not a request: {0}")]
    Json(#[from] serde_json::Error),
    /// Another version of the format.
    #[error(
        "standard input has a request in the format `{found}`; this program reads `{FORMAT}`: take servobench and \
             servobench-view from one build"
    )]
    Format {
        /// Its format.
        found: String,
    },
}

#[derive(Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct Written {
    format: String,
    #[serde(default)]
    labels: Vec<String>,
    #[serde(default)]
    options: ViewOptions,
}

impl Request {
    /// As JSON; numbers read back to the same bits.
    ///
    /// # Errors
    /// [`RequestError::Json`].
    pub fn to_json(&self) -> Result<String, RequestError> {
        let Self { labels, options } = self.clone();
        Ok(serde_json::to_string(&Written { format: FORMAT.to_owned(), labels, options })?)
    }

    /// Reads JSON; an empty text stands for an empty request.
    ///
    /// # Errors
    /// [`RequestError`].
    pub fn from_json(text: &str) -> Result<Self, RequestError> {
        #[derive(Deserialize)]
        struct Head {
            format: String,
        }
        if text.trim().is_empty() {
            return Ok(Self::default());
        }
        let Head { format: found } = serde_json::from_str(text)?;
        if found != FORMAT {
            return Err(RequestError::Format { found });
        }
        let Written { labels, options, .. } = serde_json::from_str(text)?;
        Ok(Self { labels, options })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{MotorLimits, Outcome, Verdict};
    use servobench_base::{Coordinate, Dq};
    use servobench_metrics::Name;
    use servobench_plant::pmsm::{Bounds, Params};

    /// Numbers whose shortest decimal forms are long, and those that JSON does not have.
    fn request() -> Request {
        let third = 1.0 / 3.0;
        let motor = Params {
            electrical_ratio: 4.0,
            resistance: third,
            inductance: Dq { d: 0.1 + 0.2, q: 5e-324 },
            flux_linkage: 0.545,
        };
        let motor = MotorLimits {
            motor,
            bounds: Bounds { current: f64::INFINITY, voltage: 320.0 / 3_f64.sqrt() },
            dc_link: 320.0,
            effort: f64::INFINITY,
            transmission: -third,
            motion: Coordinate::Linear,
        };
        let verdict = Verdict {
            outcome: Outcome::Failed,
            reasons: vec!["settling_time 35.2 ms, limit 20.0 ms".into()],
            warnings: vec!["a \"µ\"\u{1b}".into()],
        };
        let options = ViewOptions {
            verdicts: vec![verdict, Verdict::default()],
            limits: vec![("current.q".into(), 18.000_000_000_000_004)],
            allowed: Name::ALL.iter().map(|name| (*name, third)).collect(),
            window: Some(5e-6),
            residual_from: Some(0.1),
            max_instants: 7,
            exaggeration: Some(10.0),
            motor: Some(motor),
        };
        Request { labels: vec!["jerk".into(), "snap".into()], options }
    }

    #[test]
    fn a_request_reads_back_to_the_same_bits() {
        for request in [request(), Request::default()] {
            assert_eq!(Request::from_json(&request.to_json().unwrap()).unwrap(), request);
        }
        assert_eq!(Request::from_json(" \n").unwrap(), Request::default());
    }

    #[test]
    fn the_request_of_the_page_is_one() {
        let page = std::fs::read_to_string("../../docs/viewer.md").unwrap();
        let example = page.split_once("```json\n").and_then(|(_, rest)| rest.split_once("```")).unwrap().0;
        let Request { labels, options } = Request::from_json(example).unwrap();
        assert_eq!((labels.len(), options.verdicts.len(), options.allowed.len()), (2, 2, 1));
        assert_eq!(options.max_instants, ViewOptions::default().max_instants, "what is left out is the default");
        let written: serde_json::Value = serde_json::from_str(&Request::default().to_json().unwrap()).unwrap();
        for option in written["options"].as_object().unwrap().keys() {
            assert!(page.contains(&format!("| `{option}` |")), "{option} is not described");
        }
    }

    #[test]
    fn a_request_of_another_build_is_refused_by_its_format() {
        let written = request().to_json().unwrap();
        let refusal = |from: &str, to: &str| {
            assert!(written.contains(from));
            Request::from_json(&written.replacen(from, to, 1)).unwrap_err().to_string()
        };
        let later = refusal(FORMAT, "servobench-view/2");
        assert!(later.contains("`servobench-view/2`") && later.ends_with("from one build"), "{later}");
        assert!(refusal("\"window\"", "\"windows\"").contains("unknown field `windows`"));
        assert!(refusal("settling_time\",", "settling_tim\",").contains("settling_tim"));
        assert!(Request::from_json("[]").unwrap_err().to_string().starts_with("standard input is not a request"));
    }
}
