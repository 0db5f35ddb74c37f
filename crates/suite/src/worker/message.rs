//! What a worker says.
use serde::{Deserialize, Serialize};
use servobench::check::Objection;
use servobench_sim::MechanicsAtRest;

/// One line of what a worker says.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub(super) enum Message {
    /// Share that is done, from 0 to 1.
    Progress(f64),
    /// What keeps the scenario from being built.
    Objections(Vec<Objection>),
    /// The linear model of an MJCF file.
    AtRest(MechanicsAtRest),
    /// Memory that the worker has for itself after the order (B).
    Holds(u64),
    /// The last word on an order.
    End(End),
}

/// How an order ends.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum End {
    /// The recording, or the answer, is complete.
    Done,
    /// The input is wrong: why.
    Input(String),
    /// The run diverged; the recording is there as far as it came.
    Diverged {
        /// When (s).
        time: f64,
        /// Why, in the engine's words.
        reason: String,
    },
    /// The program gave up: why. The recording is there as far as it came.
    GaveUp(String),
    /// The run reached its limit of time at this simulated time (s). The recording is there as far as it came.
    Stopped(f64),
    /// The run broke off: why. The recording is there as far as it came.
    Failed(String),
}

impl Message {
    /// As one line.
    pub(super) fn line(&self) -> serde_json::Result<String> {
        Ok(serde_json::to_string(self)? + "\n")
    }

    /// What `line` says; nothing when it is none of ours.
    pub(super) fn of(line: &[u8]) -> Option<Self> {
        serde_json::from_slice(line).ok()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_message_is_one_line_that_reads_back() {
        let objection = Objection { key: "axis".into(), line: Some(2), message: "no".into(), help: String::new() };
        let why = "engine `mujoco`: \"half\n a µm\" too far".to_owned();
        for (message, line) in [
            (Message::Progress(0.25), "{\"progress\":0.25}\n"),
            (
                Message::Objections(vec![objection]),
                "{\"objections\":[{\"key\":\"axis\",\"line\":2,\"message\":\"no\",\"help\":\"\"}]}\n",
            ),
            (Message::AtRest(Err("no".into())), "{\"atrest\":{\"Err\":\"no\"}}\n"),
            (Message::Holds(5), "{\"holds\":5}\n"),
            (Message::End(End::Done), "{\"end\":\"done\"}\n"),
            (Message::End(End::Input("no".into())), "{\"end\":{\"input\":\"no\"}}\n"),
            (
                Message::End(End::Diverged { time: 0.25, reason: "not finite".into() }),
                "{\"end\":{\"diverged\":{\"time\":0.25,\"reason\":\"not finite\"}}}\n",
            ),
            (Message::End(End::GaveUp("no".into())), "{\"end\":{\"gaveup\":\"no\"}}\n"),
            (Message::End(End::Stopped(0.5)), "{\"end\":{\"stopped\":0.5}}\n"),
            (
                Message::End(End::Failed(why)),
                "{\"end\":{\"failed\":\"engine `mujoco`: \\\"half\\n a µm\\\" too far\"}}\n",
            ),
        ] {
            assert_eq!(message.line().unwrap(), line);
            assert_eq!(Message::of(line.as_bytes()), Some(message));
        }
        assert_eq!(Message::of(b"WARNING: a library speaks"), None);
    }
}
