//! The best set-point near another one: step by step to the optimum of a linear model.
use crate::merit::Merit;
use crate::search::{Allowance, Found, Planned, Reading, Search};
use crate::set_point::{Room, SetPoint};

/// Largest and smallest step, relative to the length of an average.
pub(crate) type Steps = (f64, f64);

/// Largest number of models.
const MOST: usize = 40;
/// Number of models after which a set-point is abandoned unless it promises less than the bound.
const PATIENCE: usize = 2;
/// Smallest step while the limits are not met.
const FINEST: f64 = 0.0003;
/// Share of the longest average that is added to the scale of short ones.
const FLOOR: f64 = 0.1;
/// Factors of the step after a failure, and after a success.
const SHORTER: f64 = 0.4;
const LONGER: f64 = 1.5;
/// Ratio of steps for which a model remains valid.
const REACH: f64 = 6.0;
/// Difference for the slopes, relative to the step, and its minimum, which five digits still resolve.
const DIFFERENCE: (f64, f64) = (0.25, 0.0004);
/// Ratio to the largest use from which on machines are in the model from the start.
const BINDING: f64 = 0.7;
/// Relative extension of the averages until the limits are met, doubled each time, and the largest number of extensions.
const STRETCHES: (f64, i32) = (0.002, 11);
/// Share of a limit that the model allows, so that its error does not lead beyond the limit.
const WITHIN: f64 = 0.999;
/// Number of grid positions along each average in the search of the model, and number of times that the grid is halved.
const POSITIONS: usize = 5;
const HALVINGS: i32 = 8;

/// The best near `start`, which may exceed its limits. Limits that bind on several machines form kinks, along which no single average can
/// be shortened: the model sees all of them. A machine on which a step fails joins the model.
pub(crate) fn refined(
    search: &mut Search<'_>,
    room: &Room<'_>,
    order: u32,
    allowed: &Allowance,
    start: Found,
    (first, last): Steps,
    bound: f64,
) -> Found {
    let (mut best, mut step) = (start, first);
    for k in 0..MOST {
        if k >= PATIENCE && best.merit.promise() > bound {
            break;
        }
        let uses = search.uses(&best.planned, allowed);
        let most = uses.iter().map(|one| one.1).fold(0.0, f64::max);
        let mut machines: Vec<usize> = uses.iter().filter(|one| one.1 >= BINDING * most).map(|one| one.0).collect();
        let mut model = Model::new(room, order, &best);
        model.add(search, room, allowed, &machines, step);
        let floor = if best.merit.keeps() { last } else { last.min(FINEST) };
        let coarsest = floor.max(step / REACH);
        while step >= coarsest {
            let point = model.best(room, step);
            let planned = if point.key() == best.planned.point.key() { None } else { search.planned(&[point]).pop() };
            let Some(planned) = planned else {
                step *= SHORTER;
                continue;
            };
            if let Some(better) = search.better(&planned, allowed, &best) {
                best = better;
                step = first.min(LONGER * step);
                break;
            }
            let uses = search.uses(&planned, allowed).into_iter();
            let failed = uses.filter(|(machine, over)| *over > 1.0 && !machines.contains(machine)).map(|one| one.0);
            let failed: Vec<usize> = failed.collect();
            if failed.is_empty() {
                // The model does not see jumps, as of a settling time.
                let shorter = if best.merit.keeps() { model.shorter(room, step) } else { Vec::new() };
                let shorter = search.planned(&shorter);
                if let Some(better) = shorter.iter().find_map(|one| search.better(one, allowed, &best)) {
                    best = better;
                    break;
                }
                step *= SHORTER;
            }
            model.add(search, room, allowed, &failed, step);
            machines.extend(failed);
        }
        if step < floor
            && !best.merit.keeps()
            && best.planned.duration < bound
            && let Some(kept) = lengthened(search, room, order, allowed, &best)
        {
            best = kept;
            step = first;
        }
        if step < floor {
            break;
        }
    }
    best
}

/// `found` with all averages extended until the limits are met; `None` if that does not suffice.
fn lengthened(
    search: &mut Search<'_>,
    room: &Room<'_>,
    order: u32,
    allowed: &Allowance,
    found: &Found,
) -> Option<Found> {
    let own = found.planned.point.boxes(room.distance);
    (0..STRETCHES.1).find_map(|k| {
        let factor = 1.0 + STRETCHES.0 * 2_f64.powi(k);
        let point = room.point(found.planned.point.family, order, own.map(|length| length * factor));
        let planned = search.planned(&[point]);
        search.on_all(&planned, allowed, f64::INFINITY, Merit::time_kept).pop()
    })
}

/// A figure of a run, linear in the lengths of the averages.
struct Linear {
    value: f64,
    slopes: [f64; 4],
}

impl Linear {
    fn at(&self, moved: &[f64; 4]) -> f64 {
        self.value + self.slopes.iter().zip(moved).map(|(slope, moved)| slope * moved).sum::<f64>()
    }
}

/// All uses of all limits, and all settling times, near a set-point.
struct Model<'f> {
    order: u32,
    found: &'f Found,
    own: [f64; 4],
    uses: Vec<Linear>,
    settling: Vec<Linear>,
}

impl<'f> Model<'f> {
    fn new(room: &Room<'_>, order: u32, found: &'f Found) -> Self {
        let own = found.planned.point.boxes(room.distance);
        Self { order, found, own, uses: Vec::new(), settling: Vec::new() }
    }

    /// Change of an average (s) for a step of one.
    fn scale(&self, k: usize) -> f64 {
        self.own[k] + FLOOR * self.own[0]
    }

    /// Adds machines to the model.
    fn add(&mut self, search: &mut Search<'_>, room: &Room<'_>, allowed: &Allowance, machines: &[usize], step: f64) {
        let Planned { point, .. } = self.found.planned;
        let part = (DIFFERENCE.0 * step).max(DIFFERENCE.1);
        let longer = |k: usize| {
            let mut boxes = self.own;
            boxes[k] += part * self.scale(k);
            room.point(point.family, self.order, boxes)
        };
        let points: Vec<SetPoint> = (0..self.order as usize).map(longer).collect();
        for machine in machines {
            let base = figures(search.reading(&self.found.planned, *machine), allowed, self.found.planned.duration);
            let mut slopes = vec![[0.0; 4]; base.len()];
            for (k, point) in points.iter().enumerate() {
                let Some(planned) = search.planned(&[*point]).pop() else { continue };
                let figures = figures(search.reading(&planned, *machine), allowed, planned.duration);
                // A longer average lengthens those that contain it.
                let moved: Vec<f64> =
                    point.boxes(room.distance).iter().zip(self.own).map(|(one, own)| one - own).collect();
                for ((slopes, figure), base) in slopes.iter_mut().zip(figures).zip(&base) {
                    let outer: f64 = (0..k).map(|outer| slopes[outer] * moved[outer]).sum();
                    slopes[k] = (figure - base - outer) / moved[k];
                }
            }
            let mut all = base.into_iter().zip(slopes).map(|(value, slopes)| Linear { value, slopes });
            self.settling.extend(all.next().filter(|one| one.value.is_finite()));
            self.uses.extend(all.filter(|one| one.value.is_finite()));
        }
    }

    /// Merit of `boxes` according to the model (s).
    fn penalised(&self, boxes: &[f64; 4]) -> f64 {
        let moved: [f64; 4] = std::array::from_fn(|k| boxes[k] - self.own[k]);
        let settling = self.settling.iter().map(|one| one.at(&moved)).fold(0.0, f64::max);
        let over = self.uses.iter().map(|one| one.at(&moved).abs()).fold(WITHIN, f64::max) / WITHIN;
        Merit { time: self.found.planned.duration + moved.iter().sum::<f64>() + settling, over }.penalised()
    }

    /// Set-points with one average a step shorter.
    fn shorter(&self, room: &Room<'_>, step: f64) -> Vec<SetPoint> {
        let with = |k: usize| {
            let mut boxes = self.own;
            boxes[k] -= step * self.scale(k);
            room.point(self.found.planned.point.family, self.order, boxes)
        };
        (0..self.order as usize).map(with).collect()
    }

    /// The optimum of the model within a step.
    fn best(&self, room: &Room<'_>, step: f64) -> SetPoint {
        let count = self.order as usize;
        let (mut centre, mut least) = (self.own, self.penalised(&self.own));
        for halving in 0..HALVINGS {
            let finer = 0.5_f64.powi(halving);
            let from = centre;
            for code in 0..POSITIONS.pow(self.order) {
                let mut rest = code;
                let boxes = std::array::from_fn(|k| {
                    if k >= count {
                        return 0.0;
                    }
                    let half = (POSITIONS / 2) as f64;
                    let part = ((rest % POSITIONS) as f64 - half) / half;
                    rest /= POSITIONS;
                    let room = step * self.scale(k);
                    (from[k] + part * finer * room).clamp(self.own[k] - room, self.own[k] + room)
                });
                let boxes = room.fitted(self.order, boxes);
                let merit = self.penalised(&boxes);
                if merit < least {
                    (centre, least) = (boxes, merit);
                }
            }
        }
        room.point(self.found.planned.point.family, self.order, centre)
    }
}

/// The settling time, and the use of each limit as a share of the allowed value.
fn figures(reading: &Reading, allowed: &Allowance, duration: f64) -> Vec<f64> {
    let uses = reading.usage.iter().zip(allowed).map(|(usage, most)| usage / most);
    std::iter::once(reading.time - duration).chain(uses).collect()
}
