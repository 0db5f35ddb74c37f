"""Limits: a limit on a metric, judged by the value of that metric in a run of our own."""

from math import inf

import numpy

from draws import Random

from .arrival import arrives, program, window_of
from .axes import draw_axis
from .case import Case, quantity
from .course import Course
from .loop import Run, run

SHARE = 0.02
METRICS = ("following_error_peak_load", "following_error_peak_motor", "settling_time", "overshoot", "torque_peak", "move_time")


def settling(found: Run, course: Course, duration: float, window: float) -> float:
    """Last exit from the window after the end of the profile (s); infinite where the load has not settled."""
    move = course.moves[-1]
    behind = found.t >= move.end
    t, outside = found.t[behind], numpy.abs(found.load[behind] - move.target) > window
    if not outside.any():
        return 0.0
    last = t[numpy.flatnonzero(outside)[-1]]
    return inf if duration - last < (duration - move.end) / 20 else last + 0.5 * (t[1] - t[0]) - move.end


def values(found: Run, course: Course, duration: float, window: float) -> dict[str, tuple[float, float]]:
    """Each metric, and how far it may be off by what is only sampled."""
    move = course.moves[-1]
    way = 1.0 if move.target > move.origin else -1.0
    after = found.t >= move.start
    beyond = max(0.0, float(numpy.max(way * (found.load[after] - move.target))))
    tick = found.t[1] - found.t[0]
    return {
        "following_error_peak_load": (float(numpy.max(numpy.abs(found.reference - found.load))), 0.0),
        "following_error_peak_motor": (float(numpy.max(numpy.abs(found.reference - found.motor))), 0.0),
        "settling_time": (settling(found, course, duration, window), tick),
        "overshoot": (beyond, 1e-9 * abs(move.target)),
        "torque_peak": (float(numpy.max(numpy.abs(found.effort))), 0.0),
        "move_time": (move.end - move.start, 0.0),
    }


def draw(random: Random) -> Case | None:
    """A move with one to three limits."""
    axis = draw_axis(random, pmsm=False, sane=True)
    loop, u = axis.loop, axis.units
    if not all(other.is_stable() for other in [loop, *loop.near_gains(0.2)]) or loop.radius() > 1 - 1e-4:
        return None
    course, tables = program(random, loop, u.length, random.decades(-3, 0))
    duration = round(course.moves[-1].end + random.uniform(6, 25) / loop.position_gain, 3)
    window = window_of(tables, u.length)
    if duration > 2.5 or window is None:
        return None
    found = run(loop, course, duration)
    missed, near = arrives(found, found, course, duration, window)
    if missed or near:
        return None
    tree = axis.tables() | tables | {"limits": {}}
    tree["run"]["duration"] = quantity(duration, "s")
    tree["record"] = {"rate": f"{loop.base // loop.position_every} Hz"}
    unit = {"settling_time": "s", "move_time": "s", "torque_peak": u.effort}
    measured = [values(found, course, duration, window * factor) for factor in (1.0, 1 - SHARE, 1 + SHARE)]
    breaks, notes = set(), []
    for name in random.sample(METRICS, random.choice((1, 1, 2, 3))):
        value, off = measured[0][name]
        usual = value if 0 < value < inf else 0.1 / loop.position_gain if "time" in name else 1e-3 * abs(course.moves[0].target)
        limit = usual * random.decades(-0.6, 0.6)
        least = None
        if random.random() < 0.2:
            least = limit * random.uniform(0.3, 0.95)
        bounds = [limit] if least is None else [least, limit]
        is_missed = [m[name][0] > limit or (least is not None and m[name][0] < least) for m in measured]
        near |= len(set(is_missed)) > 1
        near |= any(abs(value - bound) <= SHARE * bound + off for bound in bounds)
        if is_missed[0]:
            breaks.add(name)
        text = quantity(limit, unit.get(name, u.length))
        tree["limits"][name] = text if least is None else {"min": quantity(least, unit.get(name, u.length)), "max": text}
        notes.append(f"{name} {value:.6g}")
    return Case(tree, frozenset(breaks), frozenset(), near, ", ".join(notes))
