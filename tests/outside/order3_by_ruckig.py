"""Order 3 against Ruckig (Berscheid & Kröger, RSS 2021): from rest to rest and from moving starts, equal to 1e-9.

It is Ruckig's own C++, as its authors publish it for Python. A start whose acceleration carries the velocity beyond its
limit is not asked for: there Ruckig brakes first, which takes longer. What Ruckig refuses is counted.
Size: 100 000 requests, scaled by `SERVOBENCH_SWEEP`.
"""

import math

import ruckig

from draws import Random, sweep_size
from plans import Request, State, ask

BAR = 1e-9


def rest_to_rest(random: Random, method: str) -> Request:
    """Any distance, and limits that are the same in both directions."""
    length, time = random.decades(-4, 2), random.decades(-2, 1)
    limits = random.limits(length, time, directional=False)
    to = State(random.sign() * length * random.decades(-2, 1.5))
    return Request(method, 3, State(), to, limits)


def moving(random: Random) -> Request:
    """From any state within limits that differ by direction, to a position passed at a velocity or at rest."""
    length, time = random.decades(-4, 2), random.decades(-2, 1)
    limits = random.limits(length, time, directional=True)
    start = random.state(limits)
    while is_carried_beyond(start, limits.jerk, -limits.v_below, limits.v_above):
        start = random.state(limits)
    passed_at = random.choice((0.0, random.state(limits).v))
    to = State(random.sign() * length * random.decades(-2, 1.5), passed_at)
    return Request("transition fast", 3, start, to, limits)


def is_carried_beyond(start: State, jerk: float, lowest: float, highest: float) -> bool:
    """Whether the acceleration, taken back at once, carries the velocity beyond its limits."""
    return not lowest <= start.v + start.a * abs(start.a) / (2 * jerk) <= highest


def ruckig_duration(request: Request) -> float | None:
    """What Ruckig takes, or nothing where it refuses.

    It is asked in units in which the limits of velocity and jerk are one: its tolerances are absolute.
    """
    limits, start, to = request.limits, request.start, request.to
    v = limits.v_above
    time = math.sqrt(v / limits.jerk)
    a = v / time
    asked = ruckig.InputParameter(1)
    asked.current_velocity, asked.current_acceleration = [start.v / v], [start.a / a]
    asked.target_position, asked.target_velocity = [(to.x - start.x) / (v * time)], [to.v / v]
    asked.min_velocity, asked.max_velocity = [-limits.v_below / v], [1.0]
    asked.min_acceleration, asked.max_acceleration = [-limits.a_below / a], [limits.a_above / a]
    asked.max_jerk = [1.0]
    trajectory = ruckig.Trajectory(1)
    try:
        result = ruckig.Ruckig(1).calculate(asked, trajectory)
    except ruckig.RuckigError:
        return None
    return float(trajectory.duration * time) if result == ruckig.Result.Working else None


def judge(kind: str, requests: list[Request]) -> list[str]:
    """Prints what was found and returns what is wrong."""
    refused, furthest, worst_defect, wrong = 0, 0.0, 0.0, []
    for plan in ask(requests):
        defect = plan.defect()
        worst_defect = max(worst_defect, defect)
        if defect > BAR:
            wrong.append(f"{plan.request} is {defect:.1e} beyond its limits or beside its target")
        theirs = ruckig_duration(plan.request)
        if theirs is None:
            refused += 1
            continue
        difference = plan.duration / theirs - 1
        furthest = max(furthest, abs(difference))
        if abs(difference) > BAR:
            wrong.append(f"{plan.request} takes {plan.duration} s, Ruckig {theirs} s ({difference:+.1e})")
    if refused > len(requests) // 100:
        wrong.append(f"Ruckig refuses {refused} of {len(requests)} requests: {kind}")
    print(f"{kind:24} {len(requests):8} {refused:8} {furthest:13.1e} {worst_defect:9.1e}")
    return wrong


def main() -> None:
    """Judges every kind of request."""
    random, size = Random(3), sweep_size(100_000)
    print(f"{'order 3 against Ruckig':24} {'requests':>8} {'refused':>8} {'difference':>13} {'defect':>9}")
    wrong = [
        *judge("profile, rest to rest", [rest_to_rest(random, "profile optimal") for _ in range(size // 4)]),
        *judge("transition, rest to rest", [rest_to_rest(random, "transition fast") for _ in range(size // 4)]),
        *judge("transition, moving", [moving(random) for _ in range(size // 2)]),
    ]
    if wrong:
        raise SystemExit(f"{len(wrong)} requests are wrong, the first: {wrong[0]}")


if __name__ == "__main__":
    main()
