"""The shortest moves of order 4 from rest to rest against the optimum of linear programs.

Requests of every pattern: the velocity swings through its peak, touches its limit or cruises at it; jerk and acceleration
bind or not. The duration must be within 1e-4 of the optimum, 1e-3 with a cruise: there the optimum approaches the limit in
ever shorter swings, which the planner leaves out.
Size: 20 requests of each pattern, scaled by `SERVOBENCH_SWEEP`.
"""

from statistics import median

from draws import Random, sweep_size
from linear_program import all_shortest
from plans import Plan, Request, State, ask

BARS = {"swing": 1e-4, "touch": 1e-4, "cruise": 1e-3}
INTERVALS = 200
BINDING = ("neither", "jerk", "acceleration", "jerk and acceleration")
DEFECT = 1e-9
BINDS = 1 - 1e-9
"""What comes this near to a limit is at it."""

Pattern = tuple[str, str]


def request(random: Random) -> Request:
    """Any distance within limits of which each binds now and then."""
    length, time = random.decades(-4, 2), random.decades(-2, 1)
    limits = random.limits(length, time, directional=False)
    return Request("profile optimal", 4, State(), State(random.sign() * length * random.decades(-2, 1)), limits)


def pattern(plan: Plan) -> Pattern:
    """What velocity does in the middle, and what binds on the way there."""
    limits = plan.request.limits
    corners = list(plan.corners())
    is_fast = [abs(state.v) >= BINDS * limits.v_above for state, _, _ in corners]
    # At the limit of velocity for longer than an instant.
    cruises = any(one and other for one, other in zip(is_fast, is_fast[1:]))
    velocity = "cruise" if cruises else "touch" if any(is_fast) else "swing"
    jerk = max(abs(state.j) for state, _, _ in corners) >= BINDS * limits.jerk
    acceleration = max(abs(state.a) for state, _, _ in corners) >= BINDS * limits.a_above
    return velocity, BINDING[jerk + 2 * acceleration]


def draw(of_each: int) -> dict[Pattern, list[Plan]]:
    """Plans of every pattern, as many of each. The rarest is one in a thousand."""
    random = Random(4)
    plans: dict[Pattern, list[Plan]] = {(velocity, binding): [] for velocity in BARS for binding in BINDING}
    for _ in range(20):
        for plan in ask([request(random) for _ in range(500 * of_each)]):
            plans[pattern(plan)].append(plan)
        if all(len(some) >= of_each for some in plans.values()):
            return {key: some[:of_each] for key, some in plans.items()}
    raise SystemExit(f"not every pattern was drawn: { {key: len(some) for key, some in plans.items()} }")


def main() -> None:
    """Judges every pattern."""
    print("order 4 from rest to rest, duration above that of the linear program; what a grid twice as fine changes")
    print(f"{'velocity':8} {'what binds':21} {'requests':>8} {'least':>9} {'median':>9} {'largest':>9} {'grid':>9}")
    wrong = []
    for (velocity, binding), plans in draw(sweep_size(20)).items():
        optima = all_shortest([([plan], INTERVALS) for plan in plans])
        above = [plan.duration / optimum - 1 for plan, optimum in zip(plans, optima, strict=True)]
        finer = all_shortest([([plan], 2 * INTERVALS) for plan in plans[:2]])
        grid = max(abs(fine / coarse - 1) for fine, coarse in zip(finer, optima))
        columns = " ".join(f"{value:9.1e}" for value in (min(above), median(above), max(above), grid))
        print(f"{velocity:8} {binding:21} {len(plans):8} {columns}")
        bar = BARS[velocity]
        for plan, gap in zip(plans, above, strict=True):
            if gap > bar:
                wrong.append((gap / bar, f"{plan.request} takes {plan.duration} s, {gap:.1e} above the optimum"))
            defect = plan.defect()
            if defect > DEFECT:
                wrong.append((defect / DEFECT, f"{plan.request} is {defect:.1e} beyond its limits or beside its target"))
        if grid > 0.1 * bar:
            raise SystemExit(f"the grid is too coarse for the bar {bar}: {velocity}, {binding}")
    if wrong:
        raise SystemExit(f"{len(wrong)} requests are wrong, the worst: {max(wrong)[1]}")


if __name__ == "__main__":
    main()
