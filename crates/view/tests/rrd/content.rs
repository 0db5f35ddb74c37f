//! Reads a file back.
use re_sdk::StoreKind;
use re_sdk::external::re_log_encoding::DecoderApp;
use re_sdk::log::{Chunk, LogMsg};
use re_sdk_types::archetypes::{
    LineStrips3D, Points3D, Scalars, StateChange, StateConfiguration, TextDocument, TextLog, Transform3D,
};
use re_sdk_types::blueprint::archetypes::{ScalarAxis, ViewBlueprint, ViewContents};
use re_sdk_types::blueprint::components::QueryExpression;
use re_sdk_types::components::{LineStrip3D, Name, Range1D, Text, TextLogLevel, Translation3D};
use servobench_trace::Recording;
use servobench_view::{ViewOptions, comparison_rrd, run_rrd};
use std::collections::{BTreeMap, BTreeSet};
use std::io::Cursor;

/// A view of the blueprint.
#[derive(Default, Debug, Clone)]
pub(crate) struct View {
    /// Its title.
    pub(crate) title: String,
    /// Range of its value axis.
    pub(crate) range: Option<[f64; 2]>,
}

/// Data that were read back.
#[derive(Default)]
pub(crate) struct Content {
    /// Entities with data, static or over time.
    pub(crate) entities: BTreeSet<String>,
    /// Time (ns) and value of each curve.
    pub(crate) curves: BTreeMap<String, Vec<(i64, f64)>>,
    /// Time (ns) and state of each lane.
    pub(crate) lanes: BTreeMap<String, Vec<(i64, String)>>,
    /// Time (ns) and place of each body that moves.
    pub(crate) places: BTreeMap<String, Vec<(i64, [f32; 3])>>,
    /// First point and label of each tick of the rulers.
    pub(crate) ticks: Vec<(f32, String)>,
    /// Texts in lanes, by value.
    pub(crate) words: BTreeMap<String, Vec<(String, String)>>,
    /// Labels of points.
    pub(crate) labels: BTreeMap<String, String>,
    /// The texts of documents.
    pub(crate) documents: Vec<String>,
    /// Level and text of each line of the logs.
    pub(crate) log: Vec<(String, String)>,
    /// Entities in the order of the file.
    pub(crate) order: Vec<String>,
    /// Timelines of the data.
    pub(crate) timelines: BTreeSet<String>,
    /// The blueprint's views by their ids.
    pub(crate) views: BTreeMap<String, View>,
    /// Entities that the blueprint's views ask for.
    pub(crate) queries: BTreeSet<String>,
}

impl Content {
    /// Takes the properties of a view from `chunk` of a blueprint.
    fn read_view(&mut self, chunk: &Chunk) {
        let path = chunk.entity_path().to_string();
        let Some(id) = path.strip_prefix("/view/").and_then(|rest| rest.split('/').next()) else { return };
        let names = chunk.iter_component::<Name>(ViewBlueprint::descriptor_display_name().component);
        let name = names.flat_map(|names| names.as_slice().to_vec()).next();
        let ranges = chunk.iter_component::<Range1D>(ScalarAxis::descriptor_range().component);
        let range = ranges.flat_map(|ranges| ranges.as_slice().to_vec()).next();
        let view = self.views.entry(id.to_owned()).or_default();
        view.title = name.map_or(std::mem::take(&mut view.title), |name| name.to_string());
        view.range = range.map(|range| [range.start(), range.end()]).or(view.range);
    }

    /// Takes places, states and words.
    fn read_scene(&mut self, chunk: &Chunk, entity: &str) {
        let texts = |component| chunk.iter_component::<Text>(component).flat_map(|texts| texts.as_slice().to_vec());
        self.documents.extend(texts(TextDocument::descriptor_text().component).map(|text| text.to_string()));
        let labels: Vec<_> = texts(Points3D::descriptor_labels().component).map(|text| text.to_string()).collect();
        if let [label] = &labels[..] {
            self.labels.insert(entity.to_owned(), label.clone());
        }
        let values = texts(StateConfiguration::descriptor_values().component).map(|text| text.to_string());
        let words = texts(StateConfiguration::descriptor_labels().component).map(|text| text.to_string());
        let words: Vec<_> = values.zip(words).collect();
        if !words.is_empty() {
            self.words.insert(entity.to_owned(), words);
        }
        let strips = chunk.iter_component::<LineStrip3D>(LineStrips3D::descriptor_strips().component);
        let strips: Vec<LineStrip3D> = strips.flat_map(|strips| strips.as_slice().to_vec()).collect();
        let names = texts(LineStrips3D::descriptor_labels().component).map(|text| text.to_string());
        self.ticks.extend(strips.iter().map(|strip| strip.0[0].x()).zip(names));
        let Some(times) = chunk.timelines().get(&"time".into()) else { return };
        let times = || times.times_raw().iter().copied();
        let states = texts(StateChange::descriptor_state().component).map(|text| text.to_string());
        let lane: Vec<_> = times().zip(states).collect();
        if !lane.is_empty() {
            self.lanes.entry(entity.to_owned()).or_default().extend(lane);
        }
        let places = chunk.iter_component::<Translation3D>(Transform3D::descriptor_translation().component);
        let places = places.flat_map(|places| places.as_slice().to_vec()).map(|place| place.0.0);
        let places: Vec<_> = times().zip(places).collect();
        if !places.is_empty() {
            self.places.entry(entity.to_owned()).or_default().extend(places);
        }
    }

    /// The view whose title begins with `name`.
    pub(crate) fn view(&self, name: &str) -> &View {
        let found = self.views.values().find(|view| view.title.starts_with(name));
        found.unwrap_or_else(|| panic!("no view `{name}` in {:?}", self.views.values()))
    }

    /// Its title.
    pub(crate) fn title(&self, name: &str) -> &str {
        &self.view(name).title
    }
}

pub(crate) fn read(bytes: &[u8]) -> Content {
    let mut content = Content::default();
    for message in DecoderApp::decode_eager(Cursor::new(bytes)).unwrap() {
        let LogMsg::ArrowMsg(store, message) = message.unwrap() else { continue };
        let chunk = Chunk::from_arrow_msg(&message).unwrap();
        if store.kind() == StoreKind::Blueprint {
            content.read_view(&chunk);
            let queries = chunk.iter_component::<QueryExpression>(ViewContents::descriptor_query().component);
            let queries = queries.flat_map(|queries| queries.as_slice().to_vec());
            content.queries.extend(queries.map(|query| query.0.trim_start_matches("+ ").to_owned()));
            continue;
        }
        let entity = chunk.entity_path().to_string();
        if entity.starts_with("/__") {
            continue;
        }
        content.order.push(entity.clone());
        content.timelines.extend(chunk.timelines().keys().map(ToString::to_string));
        let values = chunk.iter_slices::<f64>(Scalars::descriptor_scalars().component).map(|value| value[0]);
        if let Some(times) = chunk.timelines().get(&"time".into()) {
            let curve = content.curves.entry(entity.clone()).or_default();
            curve.extend(times.times_raw().iter().copied().zip(values));
        }
        content.read_scene(&chunk, &entity);
        let levels = chunk.iter_component::<TextLogLevel>(TextLog::descriptor_level().component);
        let levels = levels.flat_map(|levels| levels.as_slice().to_vec());
        let texts = chunk.iter_component::<Text>(TextLog::descriptor_text().component);
        let texts = texts.flat_map(|texts| texts.as_slice().to_vec());
        content.log.extend(levels.zip(texts).map(|(level, text)| (level.to_string(), text.to_string())));
        content.entities.insert(entity);
    }
    content.curves.retain(|_, curve| !curve.is_empty());
    content
}

pub(crate) fn written(recording: &Recording, options: &ViewOptions) -> Content {
    read(&run_rrd(recording, options).unwrap())
}

pub(crate) fn compared(runs: &[(&str, &Recording)], options: &ViewOptions) -> Content {
    read(&comparison_rrd(runs, options).unwrap())
}

/// Every entity that a view queries exists; a query of all entities below another one finds at least one.
pub(crate) fn assert_views_are_fed(content: &Content) {
    for query in &content.queries {
        let found = query.strip_suffix("/**").map_or_else(
            || content.entities.contains(query),
            |root| content.entities.iter().any(|entity| entity.starts_with(root)),
        );
        assert!(found, "a view asks for {query}, which was not logged");
    }
}
