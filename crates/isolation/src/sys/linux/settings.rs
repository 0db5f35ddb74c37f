//! Settings of the keeper, in a variable of its environment.
use crate::program::Limits;
use std::os::fd::RawFd;

/// The variable.
pub(crate) const VARIABLE: &str = "SERVOBENCH_CONTAINED";

/// Settings of the keeper.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct Settings {
    /// Its end of the control socket.
    pub(crate) control: RawFd,
    pub(crate) limits: Limits,
}

impl Settings {
    pub(crate) fn to_text(self) -> String {
        format!("{} {} {}", self.control, self.limits.memory, u8::from(self.limits.is_foreign))
    }

    /// Settings in `text`; `None` when this program did not write it.
    pub(crate) fn of_text(text: &str) -> Option<Self> {
        let words: Vec<&str> = text.split(' ').collect();
        let [control, memory, is_foreign @ ("0" | "1")] = words[..] else { return None };
        // The first three are standard input, output and error.
        let control = control.parse().ok().filter(|control| *control > 2)?;
        let limits = Limits { memory: memory.parse().ok()?, is_foreign: is_foreign == "1" };
        Some(Self { control, limits })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn settings_arrive_as_they_were_sent() {
        for is_foreign in [false, true] {
            let settings = Settings { control: 7, limits: Limits { memory: u64::MAX, is_foreign } };
            assert_eq!(Settings::of_text(&settings.to_text()), Some(settings));
        }
        for wrong in ["", "7", "7 1", "2 1 0", "7 -1 0", "7 1 2", "7 1 0 0", "x 1 0"] {
            assert_eq!(Settings::of_text(wrong), None, "{wrong}");
        }
    }
}
