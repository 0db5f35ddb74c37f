//! A blueprint as a tree of containers and views, written with Rerun's blueprint archetypes.
//!
//! Rerun's own builder (`rerun::blueprint::Blueprint`) has no way to set the properties of a view, such as the camera
//! of a 3D view or the time range of a plot, so the few entities of a blueprint are logged here.
use crate::curves::TIMELINE;
use crate::error::ViewError;
use crate::rerun::BlueprintActivationCommand;
use crate::rerun::Uuid;
use crate::rerun::blueprint::archetypes as blueprint;
use crate::rerun::blueprint::components::{
    ContainerKind, IncludedContent, LoopMode, PanelState, PlayState, PlaybackSpeed, QueryExpression, RootContainer,
    TimelineName,
};
use crate::rerun::{
    AsComponents, EntityPath, RecordingStream, RecordingStreamBuilder, RecordingStreamResult, SerializedComponentBatch,
};

/// Arrangement of a recording in the viewer. Made by [`Presentation::blueprint`](crate::Presentation::blueprint).
#[derive(Debug)]
pub struct Layout {
    pub(crate) root: Node,
    /// Seconds of the run per second of playback.
    pub(crate) playback_speed: f64,
}

/// A part of the screen.
#[derive(Debug)]
pub(crate) enum Node {
    /// Several parts.
    Container(Container),
    /// One view.
    View(View),
}

/// Several parts.
#[derive(Debug)]
pub(crate) struct Container {
    pub(crate) kind: ContainerKind,
    /// Name of the tab, when it is in tabs.
    pub(crate) name: Option<&'static str>,
    /// Parts and their shares of the space.
    pub(crate) parts: Vec<(f32, Node)>,
}

/// One view.
#[derive(Debug)]
pub(crate) struct View {
    /// Rerun's name of the kind of view.
    pub(crate) class: &'static str,
    pub(crate) title: String,
    pub(crate) contents: Vec<EntityPath>,
    /// True if entities below the contents are shown too.
    pub(crate) recursive: bool,
    /// Name of the property's archetype and its components.
    pub(crate) properties: Vec<(&'static str, Vec<SerializedComponentBatch>)>,
}

impl View {
    /// A view of `class` with `contents`.
    pub(crate) fn new(class: &'static str, title: impl Into<String>, contents: Vec<EntityPath>) -> Self {
        Self { class, title: title.into(), contents, recursive: false, properties: Vec::new() }
    }

    /// Sets a property.
    #[must_use]
    pub(crate) fn with(mut self, name: &'static str, property: &dyn AsComponents) -> Self {
        self.properties.push((name, property.as_serialized_batches()));
        self
    }
}

impl Node {
    /// Parts in `kind`; a single part without a container, `None` without parts.
    pub(crate) fn of(kind: ContainerKind, name: Option<&'static str>, mut parts: Vec<(f32, Self)>) -> Option<Self> {
        match (parts.len(), name) {
            (0, _) => None,
            (1, None) => parts.pop().map(|(_, node)| node),
            _ => Some(Self::Container(Container { kind, name, parts })),
        }
    }

    /// A tab: its parts below each other.
    pub(crate) const fn tab(name: &'static str, parts: Vec<(f32, Self)>) -> Self {
        Self::Container(Container { kind: ContainerKind::Vertical, name: Some(name), parts })
    }
}

impl Layout {
    /// Sends the layout to `stream` and makes it the active one.
    ///
    /// # Errors
    /// [`ViewError::Rerun`].
    pub fn send(&self, stream: &RecordingStream) -> Result<(), ViewError> {
        let action = "write the blueprint";
        let closed = || ViewError::Rerun { action, reason: "the stream is closed".into() };
        let info = stream.store_info().ok_or_else(closed)?;
        let builder = RecordingStreamBuilder::new(info.application_id().clone()).enabled(true).blueprint();
        let (blueprint, storage) = builder.memory().map_err(ViewError::rerun(action))?;
        self.log(&blueprint).map_err(ViewError::rerun(action))?;
        let store = blueprint.store_info().ok_or_else(closed)?;
        let activate =
            BlueprintActivationCommand { blueprint_id: store.store_id.clone(), make_active: true, make_default: true };
        stream.send_blueprint(storage.take(), activate);
        Ok(())
    }

    fn log(&self, stream: &RecordingStream) -> RecordingStreamResult<()> {
        stream.set_time_sequence("blueprint", 0);
        let root = log_node(stream, &self.root)?;
        let viewport = blueprint::ViewportBlueprint::new()
            .with_root_container(RootContainer(root.into()))
            .with_auto_layout(false)
            .with_auto_views(false);
        stream.log("viewport", &viewport)?;
        for side in ["blueprint_panel", "selection_panel"] {
            stream.log(side, &blueprint::PanelBlueprint::new().with_state(PanelState::Collapsed))?;
        }
        let time = blueprint::TimePanelBlueprint::new()
            .with_state(PanelState::Collapsed)
            .with_timeline(TimelineName(TIMELINE.into()))
            .with_playback_speed(PlaybackSpeed(self.playback_speed.into()))
            .with_play_state(PlayState::Playing)
            .with_loop_mode(LoopMode::All);
        stream.log("time_panel", &time)
    }
}

/// Logs `node` as a container (a view gets a separate one) and returns the container's id.
fn log_node(stream: &RecordingStream, node: &Node) -> RecordingStreamResult<Uuid> {
    let view_alone;
    let (container, parts): (&Container, Vec<(f32, &Node)>) = match node {
        Node::Container(container) => (container, container.parts.iter().map(|(share, part)| (*share, part)).collect()),
        Node::View(_) => {
            view_alone = Container { kind: ContainerKind::Tabs, name: None, parts: Vec::new() };
            (&view_alone, vec![(1.0, node)])
        }
    };
    let mut contents = Vec::new();
    for (_, part) in &parts {
        contents.push(IncludedContent(match part {
            Node::Container(_) => format!("container/{}", log_node(stream, part)?).into(),
            Node::View(view) => format!("view/{}", log_view(stream, view)?).into(),
        }));
    }
    let shares = parts.iter().map(|(share, _)| *share);
    let mut archetype = blueprint::ContainerBlueprint::new(container.kind).with_contents(contents);
    archetype = match container.kind {
        ContainerKind::Horizontal => archetype.with_col_shares(shares),
        ContainerKind::Vertical => archetype.with_row_shares(shares),
        ContainerKind::Grid | ContainerKind::Tabs => archetype,
    };
    if let Some(name) = container.name {
        archetype = archetype.with_display_name(name);
    }
    let id = Uuid::new_v4();
    stream.log(format!("container/{id}"), &archetype)?;
    Ok(id)
}

fn log_view(stream: &RecordingStream, view: &View) -> RecordingStreamResult<Uuid> {
    let id = Uuid::new_v4();
    let below = if view.recursive { "/**" } else { "" };
    let query = |path: &EntityPath| QueryExpression(format!("+ {path}{below}").into());
    stream.log(format!("view/{id}/ViewContents"), &blueprint::ViewContents::new(view.contents.iter().map(query)))?;
    let archetype =
        blueprint::ViewBlueprint::new(view.class).with_display_name(view.title.as_str()).with_space_origin("/");
    stream.log(format!("view/{id}"), &archetype)?;
    for (name, batches) in &view.properties {
        stream.log_serialized_batches(format!("view/{id}/{name}"), false, batches.iter().cloned())?;
    }
    Ok(id)
}
