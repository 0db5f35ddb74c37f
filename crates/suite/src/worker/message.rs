//! Messages of a worker.
use serde::{Deserialize, Serialize};
use servobench::check::Objection;
use servobench_sim::MechanicsAtRest;

/// One message of a worker, a line.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub(super) enum Message {
    /// Completed share, from 0 to 1.
    Progress(f64),
    /// Reasons why the scenario cannot be built.
    Objections(Vec<Objection>),
    /// The linear model of an MJCF file.
    AtRest(MechanicsAtRest),
    /// Memory that the worker occupies after the order (B).
    Holds(u64),
    /// The last message on an order.
    End(End),
}

/// End of an order.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum End {
    /// The recording, or the answer, is complete.
    Done,
    /// The input is wrong: the reason.
    Input(String),
    /// The run diverged; the recording ends there.
    Diverged {
        /// Time of the divergence (s).
        time: f64,
        /// The reason, in the engine's words.
        reason: String,
    },
    /// The program gave up: the reason. The recording ends there.
    GaveUp(String),
    /// The run reached its time limit at this simulated time (s). The recording ends there.
    Stopped(f64),
    /// The run failed: the reason. The recording ends there.
    Failed(String),
}

impl Message {
    /// As one line.
    pub(super) fn line(&self) -> serde_json::Result<String> {
        Ok(serde_json::to_string(self)? + "\n")
    }

    /// Parses `line`; `None` when it is not a message.
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
