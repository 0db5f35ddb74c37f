//! The switches and tracks of MC_DigitalCamSwitch, checked by the block's own rule.
use crate::diagnostic::Report;
use crate::field::Slot;
use crate::file;
use crate::resolve::keys::Reported;
use crate::source::{At, Span};
use servobench_plcopen::{BlockError, CamDirection, CamEnd, CamSwitch, TrackOptions};

/// A list being read, once for the call and once for each of its updates.
pub(super) struct Reading<'a> {
    /// Period of a modulo axis; absent for an axis with ends.
    pub(super) modulo: &'a Slot<f64>,
    pub(super) said: &'a mut Reported,
    pub(super) report: &'a mut Report,
}

impl Reading<'_> {
    fn error(&mut self, span: Span, message: String, help: &str) {
        self.said.once(span, |report| report.error(span, message, help), self.report);
    }

    /// The switches in the list at `span`.
    pub(super) fn switches(&mut self, list: &[At<file::CamSwitch>], span: Span) -> Option<Vec<CamSwitch>> {
        if list.is_empty() {
            let help = "write `switches = [{ track = 0, first = …, last = … }]`";
            self.error(span, "`switches` must not be empty".to_owned(), help);
            return None;
        }
        let all: Vec<_> = list.iter().map(|at| self.switch(at)).collect();
        all.into_iter().collect()
    }

    fn switch(&mut self, at: &At<file::CamSwitch>) -> Option<CamSwitch> {
        let own = &at.value;
        if let (Some(_), Some(span)) = (own.last.span(), own.duration.span()) {
            self.error(span, "a switch ends at `last` or after a `duration`".to_owned(), "give one of them");
            return None;
        }
        if matches!((&own.last, &own.duration), (Slot::Absent, Slot::Absent)) {
            let help = "the upper end of its window, or a `duration` from `first` on";
            let say = |report: &mut Report| report.missing_with_help("call.switches", "last", at.span, help);
            self.said.once(at.span, say, self.report);
        }
        let end = match (own.last.optional().ok()?, own.duration.optional().ok()?) {
            (Some(last), _) => CamEnd::Position(*last),
            (None, duration) => CamEnd::Duration(*duration?),
        };
        let direction = own.direction.optional().ok()?.copied().unwrap_or(CamDirection::Both);
        let switch = CamSwitch { track: *own.track.given()?, first: *own.first.given()?, end, direction };
        let keys = [("FirstOnPosition", "first", own.first.span()), ("LastOnPosition", "last", own.last.span())];
        self.known(switch, |modulo| switch.check(modulo), &keys)
    }

    /// The options of tracks that have `switches`.
    pub(super) fn tracks(
        &mut self,
        list: &[At<file::TrackOptions>],
        switches: &[At<file::CamSwitch>],
    ) -> Option<Vec<TrackOptions>> {
        let all: Vec<_> = list.iter().map(|at| self.options(&at.value)).collect();
        let mut is_right = true;
        for (i, at) in list.iter().enumerate() {
            let Some(track) = at.value.track.at() else { continue };
            if list[..i].iter().any(|other| other.value.track.given() == Some(&track.value)) {
                self.error(track.span, format!("track {} has two options", track.value), "join them");
                is_right = false;
            } else if !switches.iter().any(|one| one.value.track.given().is_none_or(|given| *given == track.value)) {
                self.error(track.span, format!("no switch is on track {}", track.value), "leave its options out");
                is_right = false;
            }
        }
        let all: Option<Vec<_>> = all.into_iter().collect();
        all.filter(|_| is_right)
    }

    fn options(&mut self, own: &file::TrackOptions) -> Option<TrackOptions> {
        let or_none = |slot: &Slot<f64>| slot.optional().ok().map(|value| value.copied().unwrap_or(0.0));
        let options = TrackOptions {
            track: *own.track.given()?,
            on_compensation: or_none(&own.on_compensation)?,
            off_compensation: or_none(&own.off_compensation)?,
            hysteresis: or_none(&own.hysteresis)?,
        };
        let keys = [("Hysteresis", "hysteresis", own.hysteresis.span())];
        self.known(options, |modulo| options.check(modulo), &keys)
    }

    /// `value` if the block accepts it; otherwise reports why not, at the entry of `keys` for the input of the standard.
    fn known<T>(
        &mut self,
        value: T,
        check: impl Fn(Option<f64>) -> Result<(), BlockError>,
        keys: &[(&str, &str, Option<Span>)],
    ) -> Option<T> {
        let Err(BlockError::Input { input, bound, .. }) = check(self.modulo.optional().ok()?.copied()) else {
            return Some(value);
        };
        if let Some((_, key, Some(span))) = keys.iter().find(|(name, ..)| *name == input) {
            let help = match (*key, self.modulo) {
                ("last", Slot::Absent) => {
                    "`first` is the lower end of the window; one over the zero needs `modulo` in `[axis]`"
                }
                _ => "",
            };
            self.error(*span, format!("`{key}` must be {bound}"), help);
        }
        None
    }
}
