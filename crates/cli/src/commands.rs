//! The commands, one module each.
mod advise;
mod check;
mod compare;
mod completions;
#[cfg(feature = "fmu")]
mod fmu;
mod man;
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
#[cfg(feature = "fmu")]
pub(crate) use fmu::{fmu, fmu_host};
pub(crate) use man::man;
pub(crate) use objects::objects;
pub(crate) use plan::{EXAMPLES as PLAN_EXAMPLES, PlanArgs, PlanMistake, plan};
pub(crate) use plc::plc;
pub(crate) use run::run;
pub(crate) use schema::schema;
pub(crate) use sweep::sweep;
pub(crate) use timing::timing;
pub(crate) use view::view;
pub(crate) use worker::worker;
