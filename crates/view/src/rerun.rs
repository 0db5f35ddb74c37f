//! Items of Rerun in use, under the names in its documentation.
//!
//! The package `rerun` would add its data-platform client, chunk store and analytics, 47 packages without use here.
pub(crate) use re_sdk::external::re_log_types::BlueprintActivationCommand;
pub(crate) use re_sdk::log::TimeColumn;
pub(crate) use re_sdk::{
    AsComponents, EntityPath, EntityPathPart, RecordingStream, RecordingStreamBuilder, RecordingStreamResult,
    SerializedComponentBatch,
};
pub(crate) use re_sdk_types::archetypes::{
    Arrows3D, Boxes3D, Cylinders3D, LineStrips2D, LineStrips3D, Points2D, Points3D, Scalars, SeriesLines, StateChange,
    StateConfiguration, TextDocument, TextLog, Transform3D, ViewCoordinates,
};
pub(crate) use re_sdk_types::components::{Color, FillMode, InterpolationMode, ShowLabels};
pub(crate) use re_sdk_types::datatypes::{
    Angle, Mat3x3, Range2D, RotationAxisAngle, TimeInt, TimeRange, TimeRangeBoundary,
};
pub(crate) use re_sdk_types::external::uuid::Uuid;

/// Arrangement of the viewer.
pub(crate) mod blueprint {
    pub(crate) use re_sdk_types::blueprint::{archetypes, components, datatypes};
}
