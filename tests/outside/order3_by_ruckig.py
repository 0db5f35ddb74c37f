"""Order 3 against Ruckig (Berscheid & Kröger, RSS 2021): from rest to rest and from moving starts, equal to 1e-9.

It is Ruckig's own C++, as its authors publish it for Python. Where the acceleration at the start carries the velocity beyond
its limit, whatever is done, Ruckig first comes back to the limit and plans from there: then ours may be shorter, but not go
further beyond. What Ruckig refuses is counted.
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
    to = State(random.sign() * length * random.decades(-2, 1.5), random.choice((0.0, random.state(limits).v)))
    return Request("transition fast", 3, random.state(limits), to, limits)


def carried(request: Request) -> float:
    """By which part of the limit the acceleration at the start carries the velocity beyond it, taken back at once."""
    _, v, a, _ = request.start
    return max(0.0, request.limits.excess(State(v=v + a * abs(a) / (2 * request.limits.jerk))))


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


def judge(kind: str, requests: list[Request]) -> list[tuple[float, str]]:
    """Prints what was found and returns what is wrong, each with how much."""
    differences, defects, wrong = [], [], []
    for plan in ask(requests):
        unavoidable = carried(plan.request)
        defect = plan.defect() - unavoidable
        defects.append(defect)
        if defect > BAR:
            wrong.append((defect, f"{plan.request} is {defect:.1e} beyond its limits or beside its target"))
        theirs = ruckig_duration(plan.request)
        if theirs is None:
            continue
        difference = plan.duration / theirs - 1
        differences.append(difference)
        if difference > BAR or (difference < -BAR and unavoidable == 0):
            wrong.append((abs(difference), f"{plan.request} takes {plan.duration} s, Ruckig {theirs} s"))
    refused = len(requests) - len(differences)
    if refused > len(requests) // 100:
        wrong.append((math.inf, f"Ruckig refuses {refused} of {len(requests)} requests: {kind}"))
    columns = min(differences, default=math.nan), max(differences, default=math.nan), max(defects)
    print(f"{kind:26} {len(requests):8} {refused:8} {' '.join(f'{value:9.1e}' for value in columns)}")
    return wrong


def main() -> None:
    """Judges every kind of request."""
    random, size = Random(3), sweep_size(100_000)
    moved = [moving(random) for _ in range(size // 2)]
    print("order 3, duration above that of Ruckig")
    print(f"{'':26} {'requests':>8} {'refused':>8} {'least':>9} {'largest':>9} {'defect':>9}")
    wrong = [
        *judge("profile, rest to rest", [rest_to_rest(random, "profile optimal") for _ in range(size // 4)]),
        *judge("transition, rest to rest", [rest_to_rest(random, "transition fast") for _ in range(size // 4)]),
        *judge("transition, moving", [request for request in moved if carried(request) == 0]),
        *judge("transition, carried beyond", [request for request in moved if carried(request) > 0]),
    ]
    if wrong:
        raise SystemExit(f"{len(wrong)} requests are wrong, the worst: {max(wrong)[1]}")


if __name__ == "__main__":
    main()
