//! Values drawn for each group, in layers.
use super::metric::Measure;
use super::scale::range;
use super::survey::{CONFIDENCE, Spread, Survey};

/// Most metrics drawn.
pub(super) const MOST_LAYERS: usize = 4;
/// Values that differ by a smaller fraction of themselves are the same everywhere.
const SAME: f64 = 1e-9;

/// A metric in every group.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Layer {
    pub(super) measure: Measure,
    /// Its spread in each group.
    pub(super) spreads: Vec<Option<Spread>>,
}

impl Layer {
    /// The range drawn: of the medians, or of everything.
    pub(super) fn range(&self, of_medians: bool) -> Option<(f64, f64)> {
        let spreads = self.spreads.iter().flatten();
        if of_medians {
            return range(spreads.map(|spread| spread.median));
        }
        range(spreads.flat_map(|spread| [spread.low, spread.median, spread.high]))
    }
}

/// Time and vibration, the metrics that differ among the groups, and for draws the share that keeps all limits; and the names of the
/// metrics that are not drawn.
pub(super) fn layers(survey: &Survey<'_, '_>) -> (Vec<Layer>, Vec<String>) {
    let (mut layers, mut left_out) = (Vec::new(), Vec::new());
    let share = kept(survey);
    let room = MOST_LAYERS - usize::from(share.is_some());
    let layer = |column: usize| Layer {
        measure: Measure::of(&survey.table.columns[column]),
        spreads: (0..survey.table.groups()).map(|group| survey.spread(column, group)).collect(),
    };
    let columns = survey.metrics.in_order(&survey.table);
    for column in &columns {
        let is_main = [survey.metrics.time, survey.metrics.vibration].contains(&Some(*column));
        let is_room = layers.len() < room;
        if !is_room {
            left_out.push(Measure::of(&survey.table.columns[*column]).name);
            continue;
        }
        let layer = layer(*column);
        let differs =
            layer.range(false).is_some_and(|(low, high)| high / 2.0 - low / 2.0 > SAME * low.abs().max(high.abs()));
        if is_main || differs {
            layers.push(layer);
        } else {
            left_out.push(layer.measure.name);
        }
    }
    if layers.is_empty() {
        layers.extend(columns.first().map(|column| layer(*column)));
        left_out.retain(|name| layers.iter().all(|layer| layer.measure.name != *name));
    }
    layers.extend(share);
    (layers, left_out)
}

/// The share that keeps all limits, with its bounds on either side, unless it is all everywhere.
fn kept(survey: &Survey<'_, '_>) -> Option<Layer> {
    let spread = |group: usize| {
        let kept = survey.kept(group);
        let [low, high] = [kept.at_least(CONFIDENCE), kept.at_most(CONFIDENCE)];
        (kept.trials() > 0).then(|| Spread { low, median: kept.share(), high })
    };
    let spreads: Vec<_> = (0..survey.table.groups()).map(spread).collect();
    let is_less = spreads.iter().flatten().any(|spread| spread.median < 1.0);
    (survey.is_judged && survey.is_drawn && is_less).then(|| Layer { measure: Measure::share(), spreads })
}

/// Note on the metrics that are not drawn; `None` without any.
pub(super) fn note_of_left_out(left_out: &[String]) -> Option<String> {
    let (count, names) = (left_out.len(), left_out.join(", "));
    match count {
        0 => None,
        1 => Some(format!("1 metric is not drawn, which is the same everywhere or has no room: {names}")),
        _ => Some(format!("{count} metrics are not drawn, which are the same everywhere or have no room: {names}")),
    }
}
