//! `follows`: between two turning points of the request, the load moves as the linear loop would.
use super::rules::Driven;
use super::task::{Piece, Task};

/// Largest allowance for deflection, as a share of the span of the response.
const OF_DEFLECTION: f64 = 0.25;
/// Allowance as a share of the distance between response and request: the lag of a loop depends on its gains, which are not known
/// to better than that.
const OF_LAG: f64 = 0.1;
/// Least share of the distance where no loop is known: its lag is included.
const UNKNOWN_LOOP: f64 = 0.25;
/// Allowance in increments of the encoder.
const INCREMENTS: f64 = 10.0;

/// Reasons why the load does not follow; `None` where no position is requested.
pub(super) fn broken(task: &Task<'_>) -> Option<Vec<String>> {
    let mut ways = task.pieces.iter().filter(|(piece, _)| *piece == Piece::Way).peekable();
    ways.peek().filter(|_| task.rules.driven != Driven::Not)?;
    let deflection = &task.rules.deflection;
    let follows = task.rules.tolerances.follows;
    let is_known = task.rules.servo.is_some() || task.rules.driven == Driven::Exactly;
    let share_of_way = if is_known { follows } else { follows.max(UNKNOWN_LOOP) };
    let elastic = deflection.elastic + deflection.elastic_per_effort * task.on_load;
    // An integral removes the effect of a disturbance during the motion afterwards.
    let gives_way = elastic + deflection.droop(task.disturbance).max(deflection.explained_alone(task.disturbance));
    let left = ways.filter(|(_, way)| !task.is_excused(&way.rows)).filter_map(|(_, way)| {
        let span = way.span() + task.beside(&way.rows);
        let bound = (share_of_way * span).max(way.lag.min(OF_LAG * span))
            + gives_way.min(OF_DEFLECTION * span)
            + INCREMENTS * task.rules.increment;
        let (off, row) = way.worst;
        (off.is_nan() || off > bound).then(|| {
            format!(
                "the load is {} from the response of the loop at {}{}: more than {} on a path of {}{}",
                task.length(off),
                task.time(row),
                task.within(row),
                task.length(bound),
                task.length(span),
                task.bound_by(&way.rows)
            )
        })
    });
    Some(left.collect())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::requirement::tests::{expecting, rules};
    use crate::requirement::{Deflection, Expected, Rules, Servo};
    use crate::synthetic::{Build, planned};
    use servobench_signals::Signal;
    use servobench_trace::{Event, Recording};

    /// Out to 0.2 m and back in a second without a rest; the load is at `load(x)` where the request is `x`.
    fn there_and_back(load: impl Fn(f64) -> f64) -> Recording {
        let x = |t: f64| 0.4 * t.min(1.0 - t.min(1.0));
        Build::new(1000, 2001)
            .channel(Signal::RequestPosition, "m", x)
            .channel(Signal::RequestVelocity, "m/s", |t| {
                if t < 0.5 {
                    0.4
                } else if t < 1.0 {
                    -0.4
                } else {
                    0.0
                }
            })
            .channel(Signal::LoadPosition, "m", |t| load(x(t)))
            .requests(&[(0.0, "follow"), (1.0, "rest")])
            .moves([planned(0.0, 0.5, 0.0, 0.2).made(), planned(0.5, 1.0, 0.2, 0.0).made()])
            .finish()
    }

    /// A loop whose response is the request.
    const AT_ONCE: Servo = Servo {
        gain: 1e3,
        position_integral_time: None,
        velocity_feedforward: 1.0,
        bandwidth: 1e6,
        reference_weight: 1.0,
        integral_time: None,
        inertia_feedforward: 1.0,
        viscous: 0.0,
        viscous_feedforward: 0.0,
        is_closed_at_the_load: false,
    };

    fn found(recording: &Recording, rules: &Rules<'_>, expected: &[Expected]) -> Vec<String> {
        broken(&Task::of(recording, rules, expected)).unwrap_or_default()
    }

    #[test]
    fn a_load_that_stays_is_named_on_each_way_with_what_held_it() {
        let mut recording = there_and_back(|_| 0.0);
        recording.events.push(Event::bound(0.1, 0.4, "velocity loop", "effort limit", false));
        assert_eq!(
            found(&recording, &rules(), &[]),
            [
                "the load is 200 mm from the response of the loop at 499 ms in `move to 0.2 m`: more than 49.9 mm on a path of \
                 200 mm; effort limit bound for 300 ms",
                "the load is 200 mm from the response of the loop at 500 ms in `move to 0 m`: more than 49.9 mm on a path of 200 mm",
            ]
            .map(str::to_owned)
        );
        assert_eq!(found(&there_and_back(|x| x), &rules(), &[]), [""; 0]);
        assert_eq!(found(&there_and_back(|_| f64::NAN), &rules(), &[]).len(), 2);
    }

    /// 3 % of the distance; what deflection explains comes on top, up to a quarter.
    #[test]
    fn the_bound_is_a_share_of_the_way_and_what_is_explained() {
        let behind = |share: f64, deflection: Deflection| {
            found(&there_and_back(|x| (1.0 - share) * x), &Rules { servo: Some(AT_ONCE), deflection, ..rules() }, &[])
                .is_empty()
        };
        let rigid = Deflection::default();
        assert!(behind(0.025, rigid) && !behind(0.035, rigid));
        let droops = Deflection { effort: 3.0, per_effort: 0.01, has_integral: false, ..rigid };
        assert!(behind(0.175, droops) && !behind(0.185, droops));
        assert!(!behind(0.035, Deflection { has_integral: true, ..droops }));
        assert!(
            behind(0.275, Deflection { elastic: 1.0, ..rigid }) && !behind(0.285, Deflection { elastic: 1.0, ..rigid })
        );
    }

    /// A loop of 3 1/s without feedforward is far behind its request, which turns before the load arrives: the request does not judge it.
    #[test]
    fn a_slow_loop_is_held_to_its_own_response() {
        let soft = Servo {
            gain: 3.0,
            position_integral_time: None,
            velocity_feedforward: 0.0,
            bandwidth: 125.0,
            reference_weight: 1.0,
            integral_time: None,
            inertia_feedforward: 0.0,
            viscous: 0.0,
            viscous_feedforward: 0.0,
            is_closed_at_the_load: false,
        };
        let soft = Rules { servo: Some(soft), ..rules() };
        // Closed form of x' = 3·(r − x), r = 0.4·t up to 0.5 s.
        let slow = |t: f64| 0.4 * t - 0.4 / 3.0 * (1.0 - (-3.0 * t).exp());
        let request = |t: f64| 0.4 * t.min(0.5);
        let build = |load: &dyn Fn(f64) -> f64| {
            Build::new(1000, 501)
                .channel(Signal::RequestPosition, "m", request)
                .channel(Signal::RequestVelocity, "m/s", |_| 0.4)
                .channel(Signal::LoadPosition, "m", load)
                .requests(&[(0.0, "follow")])
                .finish()
        };
        assert_eq!(found(&build(&slow), &soft, &[]), [""; 0]);
        assert_eq!(found(&build(&request), &soft, &[]), [""; 0], "a load that is nearer to the request follows better");
        assert_eq!(found(&build(&|t| 1.2 * request(t)), &soft, &[]).len(), 1, "one that runs ahead does not");
        assert_eq!(found(&build(&|_| 0.0), &soft, &[]).len(), 1);
        assert_eq!(found(&build(&slow), &rules(), &[]).len(), 1);
    }

    #[test]
    fn the_phase_of_an_expected_fault_is_left_out() {
        let recording = there_and_back(|_| 0.0);
        let came = |met| [Expected { expectation: expecting("drive", "8611h", 0.0, 1.0), met: Some(met) }];
        assert_eq!(found(&recording, &rules(), &came(0.3)).len(), 1);
        assert_eq!(found(&recording, &rules(), &came(1.5)).len(), 2);
    }
}
