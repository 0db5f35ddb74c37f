//! `[coupling]`: exchange of values between FMUs and the axis.
use super::whole;
use crate::diagnostic::Report;
use crate::field::Slot;
use crate::file::File;
use servobench_base::{Divider, Rate};
use servobench_coupling::{Iteration, Method, MethodKind, Order, Settings};

/// Exchange of all FMUs with the axis, which comes last.
pub(super) fn resolve(file: &File, base_rate: Option<Rate>, report: &mut Report) -> Option<Settings> {
    let fmus = file.fmu.given().map_or(0, |fmus| fmus.0.len());
    let settings = |every, kind, order, iteration| {
        Some(Settings {
            base_rate: base_rate?,
            step: Divider::new(every)?,
            method: match kind {
                MethodKind::Jacobi => Method::Jacobi,
                MethodKind::GaussSeidel => Method::GaussSeidel((0..=fmus).collect()),
                MethodKind::Iterated => Method::Iterated(iteration),
            },
            order,
            algebraic: Some(iteration),
            watch: true,
        })
    };
    let held = Iteration::default();
    let given = match &file.coupling {
        Slot::Absent => return settings(1, MethodKind::default(), Order::default(), held),
        Slot::Wrong(_) => return None,
        Slot::Given(given) => given,
    };
    if matches!(file.fmu, Slot::Absent) {
        report.error(given.span, "there is nothing to couple", "give `[[fmu]]`; `[axis.fmu]` has a separate `step`");
    }
    let given = &given.value;
    let every = match &given.step {
        Slot::Absent => Some(1),
        Slot::Wrong(_) => None,
        Slot::Given(at) => whole::ticks("step", *at, base_rate, report),
    };
    let kind = given.method.optional().ok()?.copied().unwrap_or_default();
    let order = match given.extrapolation.optional().ok()? {
        None => Order::default(),
        Some(degree) => Order::ALL.into_iter().find(|order| u32::from(order.degree()) == *degree)?,
    };
    let iteration = Iteration {
        relative: given.tolerance.optional().ok()?.copied().unwrap_or(held.relative),
        most: given.iterations.optional().ok()?.copied().unwrap_or(held.most),
        ..held
    };
    settings(every?, kind, order, iteration)
}
