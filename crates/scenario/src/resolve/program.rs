//! `[setpoint]` and `[[program]]` to steps.
use crate::diagnostic::Report;
use crate::field::Slot;
use crate::file;
use crate::file::File;
use crate::resolve::keys::{Keys, LIMITS, Reported};
use crate::resolve::{Alternative, filter, has_window, limits, one_of, points, rockwell};
use crate::scenario::{LONGEST_RUN, MoveStep, Step};
use crate::source::{At, Sources, Span};
use servobench_base::{Rate, Setpoint};
use servobench_motion::online::{DirectionalLimits, Sides, Target};
use servobench_planner::{Filter, Follow, Generator, PointToPoint, Positioning, Replanning, Request, TableMove};

/// Values from the rest of the file that steps depend on.
struct Known<'a> {
    base_rate: Option<Rate>,
    /// True if there is a settling window.
    has_window: bool,
    sources: &'a Sources,
}

/// The kind of the preceding step.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Before {
    /// No motion that could be aborted.
    Pause,
    /// A move that ends at rest.
    Move,
    /// A move that ends in motion.
    Motion,
}

pub(super) fn steps(file: &File, base_rate: Option<Rate>, sources: &Sources, report: &mut Report) -> Option<Vec<Step>> {
    let Some(program) = file.program.optional().ok()? else { return Some(Vec::new()) };
    refuse_endless(&program.0, report);
    let mut said = Reported::default();
    let known = Known { base_rate, has_window: has_window(file), sources };
    let defaults = file.setpoint.given().map(Keys::of_setpoint);
    let (mut steps, mut before) = (Vec::new(), Before::Pause);
    for step in &program.0 {
        let resolved = self::step(&step.value, defaults.as_ref(), before, &known, &mut said, report);
        before = match &resolved {
            Some(Step::Move(step)) if step.request.generator.ends_in_motion() => Before::Motion,
            Some(Step::Wait(_)) => Before::Pause,
            // A step with mistakes counts as a move to rest, so that the steps after it are not blamed.
            Some(Step::Move(_)) | None => Before::Move,
        };
        steps.push(resolved);
    }
    if let (Before::Motion, Some(last)) = (before, program.0.last()) {
        report.error(last.value.span, "the program ends in motion", "add a move to rest after this one");
    }
    steps.into_iter().collect()
}

/// Refuses the step at which given pauses and durations exceed the longest run. The durations of other moves are only known after
/// planning.
fn refuse_endless(program: &[At<file::ProgramStep>], report: &mut Report) {
    let mut end = 0.0;
    for step in program {
        let step = &step.value;
        let Some(length) = step.wait.at().or(step.duration.at()).or(step.hold.at()) else { continue };
        end += length.value;
        if end > LONGEST_RUN {
            let message = format!("the program would last {end} s at least, a run lasts {LONGEST_RUN} s at most");
            report.error(length.span, message, "");
            return;
        }
    }
}

/// The action of a step.
enum Does {
    To(Option<f64>, Positioning),
    Velocity(Option<f64>),
    Table,
}

fn step(
    step: &file::ProgramStep,
    defaults: Option<&Keys<'_>>,
    before: Before,
    known: &Known<'_>,
    said: &mut Reported,
    report: &mut Report,
) -> Option<Step> {
    let own = Keys::of_step(step);
    let ways = [
        ("move_to", step.move_to.span()),
        ("move_by", step.move_by.span()),
        ("reach_velocity", step.reach_velocity.span()),
        ("table", step.table.span()),
        ("wait", step.wait.span()),
    ];
    let there: Vec<_> = ways.iter().filter(|(_, span)| span.is_some()).collect();
    if let [(first, _), (second, Some(span)), ..] = there.as_slice() {
        report.error(*span, format!("`{first}` and `{second}` in one step"), "write two steps");
        return None;
    }
    let does = match one_of(&ways, report) {
        Alternative::Use(0) => Does::To(step.move_to.given().copied(), Positioning::Absolute),
        Alternative::Use(1) => Does::To(step.move_by.given().copied(), Positioning::Relative),
        Alternative::Use(2) => Does::Velocity(step.reach_velocity.given().copied()),
        Alternative::Use(3) => Does::Table,
        Alternative::Use(_) => {
            no_keys(own.named().chain(of_moves(step)), "a pause", report);
            if before == Before::Motion {
                report.error(
                    step.span,
                    "the axis does not rest here: the move before ends in motion",
                    "let the next move follow at once; a velocity that was reached is held by `hold`",
                );
            }
            return step.wait.given().copied().map(Step::Wait);
        }
        Alternative::Contradiction => return None,
        Alternative::None => {
            let help = "give `move_to`, `move_by`, `reach_velocity`, `table` or `wait`";
            report.lacking("program", step.span, "this step does nothing", help);
            return None;
        }
    };
    let metric_limits =
        step.limits.optional().ok().map(|own| own.map_or_else(Vec::new, |own| limits(own, known.has_window, report)));
    let keys = own.or(defaults);
    let context = Context { step, own: &own, keys: &keys, before, known };
    let moved = match does {
        Does::Table => context.table(said, report),
        Does::To(position, positioning) => {
            context.to(position, said, report).map(|generator| Moved { generator, positioning, hold: 0.0 })
        }
        Does::Velocity(velocity) => context.to_velocity(velocity, said, report),
    };
    let filter = filter::filter(&keys, known.base_rate, said, report);
    let Moved { generator, positioning, hold } = moved?;
    let (aborts_after, duration) =
        (step.aborts_after.optional().ok()?.copied(), step.duration.optional().ok()?.copied());
    let request = Request { duration, filter: filter?, ..Request::new(generator) };
    let step = MoveStep { request, positioning, hold, aborts_after, metric_limits: metric_limits? };
    context.check_ends(&step, report);
    Some(Step::Move(step))
}

/// Keys of moves that do not concern their profile.
fn of_moves(step: &file::ProgramStep) -> impl Iterator<Item = (&'static str, Option<Span>)> {
    [
        ("end_velocity", step.end_velocity.span()),
        ("hold", step.hold.span()),
        ("aborts_after", step.aborts_after.span()),
        ("duration", step.duration.span()),
        ("limits", step.limits.span()),
    ]
    .into_iter()
}

/// Refuses keys that `what` does not have.
fn no_keys(keys: impl IntoIterator<Item = (&'static str, Option<Span>)>, what: &str, report: &mut Report) {
    for (key, span) in keys {
        if let Some(span) = span {
            report.error(span, format!("{what} has no `{key}`"), "");
        }
    }
}

/// A move being resolved.
struct Context<'a> {
    step: &'a file::ProgramStep,
    /// Keys of the step itself.
    own: &'a Keys<'a>,
    /// Keys in effect: the step's own, or those of `[setpoint]`.
    keys: &'a Keys<'a>,
    before: Before,
    known: &'a Known<'a>,
}

/// A move without the parts common to all moves.
struct Moved {
    generator: Generator,
    positioning: Positioning,
    hold: f64,
}

impl Context<'_> {
    /// A move to a position.
    fn to(&self, position: Option<f64>, said: &mut Reported, report: &mut Report) -> Option<Generator> {
        no_keys([("hold", self.step.hold.span())], "a move to a position", report);
        if let Some(rockwell) = self.keys.rockwell.at() {
            return self.rockwell(position, rockwell, said, report);
        }
        if self.keys.rockwell.span().is_some() {
            return None;
        }
        if self.in_motion().is_some() || self.keys.online.span().is_some() {
            let end_velocity = self.step.end_velocity.optional().ok()?.copied().unwrap_or(0.0);
            return self.online(position.map(|x| Target::Position { x, v: end_velocity }), said, report);
        }
        let unused = self.own.named().filter(|(key, _)| key.starts_with("negative_"));
        no_keys(unused, "a move that is not planned `online`", report);
        let order_and_limits = self.keys.order_and_limits(self.step.span, said, report);
        let grid = filter::grid(self.keys, self.known.base_rate, said, report);
        let (order, limits) = order_and_limits?;
        let method = self.keys.method.optional().ok()?.copied().unwrap_or_default();
        Some(Generator::PointToPoint(PointToPoint { distance: position?, order, limits, method, grid: grid? }))
    }

    /// A move to a velocity.
    fn to_velocity(&self, velocity: Option<f64>, said: &mut Reported, report: &mut Report) -> Option<Moved> {
        no_keys([("end_velocity", self.step.end_velocity.span())], "a move to a velocity", report);
        if let Some(span) = self.own.rockwell.span() {
            report.error(span, "Rockwell's move goes to a position", "leave `rockwell` out of this step");
        }
        let hold = self.step.hold.optional().ok()?.copied().unwrap_or(0.0);
        let generator = self.online(velocity.map(Target::Velocity), said, report)?;
        Some(Moved { generator, positioning: Positioning::Relative, hold })
    }

    /// A move from any state of motion.
    fn online(&self, target: Option<Target>, said: &mut Reported, report: &mut Report) -> Option<Generator> {
        for (key, span) in self.own.named() {
            let is_of_rest = matches!(key, "method" | "sample_time" | "sampling" | "execution");
            if let (Some(span), true) = (span, is_of_rest) {
                let message = format!("`{key}` is for moves from rest to rest, this one is planned in motion");
                report.error(span, message, "");
            }
        }
        let (order, limits) = self.keys.order_and_limits(self.step.span, said, report)?;
        let [velocity, acceleration] = self.keys.negative.map(Slot::optional);
        let sides = |above: f64, below: Option<&f64>| Sides { above, below: below.copied().unwrap_or(above) };
        let limits = DirectionalLimits {
            velocity: sides(limits.velocity, velocity.ok()?),
            acceleration: sides(limits.acceleration, acceleration.ok()?),
            jerk: limits.jerk,
            snap: limits.snap,
        };
        let effort = self.keys.online.optional().ok()?.copied().unwrap_or_default();
        let target = target?;
        let (Target::Position { v, .. } | Target::Velocity(v)) = target;
        let most = if v < 0.0 { limits.velocity.below } else { limits.velocity.above };
        let asked = self.step.end_velocity.span().or(self.step.reach_velocity.span());
        if let (Some(span), true) = (asked, v.abs() > most) {
            report.error(span, format!("beyond the velocity limit, {most} in SI"), "lower it or raise the limit");
            return None;
        }
        Some(Generator::Replanning(Replanning { from: Setpoint::default(), target, order, limits, effort }))
    }

    /// Rockwell's axis move.
    fn rockwell(
        &self,
        distance: Option<f64>,
        keys: &At<file::Rockwell>,
        said: &mut Reported,
        report: &mut Report,
    ) -> Option<Generator> {
        if let Some(span) = self.in_motion() {
            let help = "leave `rockwell` out of this step, or let the axis rest";
            report.error(span, "Rockwell's move starts and ends at rest", help);
            return None;
        }
        let unused = self.own.named().filter(|(key, _)| !matches!(*key, "rockwell" | "shaper" | "averages"));
        let unused = unused.filter(|(key, _)| !LIMITS[..3].contains(key));
        no_keys(unused, "Rockwell's move", report);
        let limits = self.keys.limits(2, 3, "Rockwell's move", self.step.span, said, report);
        let is_own = self.own.rockwell.span().is_some();
        let operands = rockwell::Operands {
            limits: limits.map(|[velocity, acceleration, ..]| [velocity, acceleration]),
            acceleration: self.keys.limits[1],
            jerk_beside: if is_own { self.own.limits[2] } else { self.keys.limits[2] },
            jerk: self.keys.limits[2],
        };
        rockwell::resolve(keys, &operands, distance, report).map(Generator::Rockwell)
    }

    /// A move through a table.
    fn table(&self, said: &mut Reported, report: &mut Report) -> Option<Moved> {
        let table = self.step.table.at();
        let by_limits = table.is_some_and(|table| points::chooses_by_limits(&table.value));
        let is_used = |key: &str| matches!(key, "shaper" | "averages") || by_limits && LIMITS[..2].contains(&key);
        let unused = self.own.named().filter(|(key, _)| !is_used(key));
        let of_motion = of_moves(self.step).filter(|(key, _)| !matches!(*key, "duration" | "limits"));
        no_keys(unused.chain(of_motion), "a table", report);
        if self.before == Before::Motion {
            report.error(self.step.span, "a table starts at rest", "let the move before end at rest");
            return None;
        }
        let limits = if by_limits { self.velocity_and_acceleration(said, report) } else { None };
        let (table, positioning) = points::resolve(table?, limits, self.known.sources, report)?;
        Some(Moved { generator: Generator::Table(table), positioning, hold: 0.0 })
    }

    /// The limits from which the share of plateaus is chosen.
    fn velocity_and_acceleration(&self, said: &mut Reported, report: &mut Report) -> Option<[f64; 2]> {
        for (key, slot) in LIMITS.into_iter().zip(self.keys.limits).take(2) {
            if matches!(slot, Slot::Absent) {
                said.missing(key, self.step.span, "`plateau_share = \"auto\"` is chosen by it", report);
            }
        }
        let [velocity, acceleration, ..] = self.keys.limits.map(Slot::given);
        Some([*velocity?, *acceleration?])
    }

    /// Place of the key by which the move starts or ends in motion.
    fn in_motion(&self) -> Option<Span> {
        let starts = (self.before == Before::Motion).then_some(self.step.span);
        self.step.aborts_after.span().or(self.step.end_velocity.span()).or(starts)
    }

    /// Refuses keys that do not fit the start and the end of the move.
    fn check_ends(&self, step: &MoveStep, report: &mut Report) {
        if let (Before::Pause, Some(span)) = (self.before, self.step.aborts_after.span()) {
            report.error(
                span,
                "this step has no move to abort",
                "give the step before a move, or leave `aborts_after` out",
            );
        }
        let starts_in_motion = self.before == Before::Motion || step.aborts_after.is_some();
        let is_in_motion = starts_in_motion || step.request.generator.ends_in_motion();
        let message = match &step.request.generator {
            _ if is_in_motion => {
                "a move that starts or ends in motion is not filtered or slowed: its velocity would jump"
            }
            Generator::Table(TableMove { follow: Follow::Plateaus { .. } | Follow::Steps { .. }, .. }) => {
                "a position profile is not filtered: it sends velocities"
            }
            _ => return,
        };
        let Filter { shapers, averages } = &step.request.filter;
        let is_slowed = is_in_motion && step.request.duration.is_some();
        for (is_there, slot, help) in [
            (!shapers.is_empty(), self.keys.shaper.span(), "write `shaper = { kind = \"none\" }` into this step"),
            (averages.is_some(), self.keys.averages.span(), "write `averages = []` into this step"),
            (is_slowed, self.step.duration.span(), "leave it out: limits say how fast the move is"),
        ] {
            if is_there {
                report.error(slot.unwrap_or(self.step.span), message, help);
            }
        }
    }
}
