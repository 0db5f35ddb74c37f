//! The commands, one module each.
mod advise;
mod check;
mod compare;
mod completions;
mod examples;
mod explain;
#[cfg(feature = "fmu")]
mod fmu;
mod init;
mod man;
mod models;
mod objects;
mod plan;
mod plc;
mod run;
mod schema;
mod sweep;
mod timing;
mod view;
mod worker;

pub(crate) use advise::{AdviseMistake, advise};
pub(crate) use check::{Findings, check};
pub(crate) use compare::compare;
pub(crate) use completions::completions;
pub(crate) use examples::examples;
pub(crate) use explain::explain;
#[cfg(feature = "fmu")]
pub(crate) use fmu::{fmu, fmu_host};
pub(crate) use init::init;
pub(crate) use man::man;
pub(crate) use models::models;
pub(crate) use objects::objects;
pub(crate) use plan::{EXAMPLES as PLAN_EXAMPLES, PlanArgs, PlanMistake, plan};
pub(crate) use plc::plc;
pub(crate) use run::run;
pub(crate) use schema::schema;
pub(crate) use sweep::sweep;
pub(crate) use timing::timing;
pub(crate) use view::view;
pub(crate) use worker::worker;
