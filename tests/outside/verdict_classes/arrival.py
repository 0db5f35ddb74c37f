"""`arrives` and the swing from limit to limit, by their definitions in docs/requirements.md."""

import numpy

from draws import Random

from .case import Tree, quantity
from .course import Bounds, Course, course
from .loop import Loop, Run

SHARE = 0.02
SWINGS = 8
"""So often more than is asked for effort may go from limit to limit."""
NEAR_SWINGS = 3
OF_WAY = 0.05
"""A window counts up to this share of the way."""
EXPLAINED = 0.1
"""So much of the way droop and elastic deflection may explain."""
BESIDES = frozenset({"follows", "stands", "rings", "velocity"})
"""What a run that is bad otherwise may break, too."""


def program(random: Random, loop: Loop, unit: str, distance: float, moves: int = 1) -> tuple[Course, Tree]:
    """Moves about as fast as the position loop follows, with pauses or without, and the tables that ask for them."""
    order = random.choice((2, 3))
    time = random.uniform(3, 12) / loop.position_gain
    v = 2 * distance / time
    a = v / time * random.decades(0.3, 0.8)
    bounds = Bounds(v, a, a / time * random.decades(0.5, 1.2) if order == 3 else None)
    setpoint: Tree = {"order": order, "velocity": quantity(v, f"{unit}/s"), "acceleration": quantity(a, f"{unit}/s2")}
    if bounds.j is not None:
        setpoint["jerk"] = quantity(bounds.j, f"{unit}/s3")
    steps, written, at = [], [], 0.0
    for number in range(moves):
        pause = round(random.uniform(0.02, 0.2), 3) if number == 0 else random.choice((0.0, round(8 / loop.position_gain, 4)))
        if pause:
            written.append({"wait": quantity(pause, "s")})
        # A whole distance each time, so that none is a rounding of another.
        at += random.choice((1, -1)) * distance * random.uniform(0.6, 1.2)
        written.append({"move_to": quantity(at, unit)})
        steps.append((pause, at))
    tables: Tree = {"setpoint": setpoint, "program": written}
    if random.random() < 0.6:
        tables["measure"] = {"window": quantity(distance * random.decades(-5, -1), unit)}
    return course(steps, bounds), tables


def window_of(tree: Tree, unit: str) -> float | None:
    """The window that a scenario gives."""
    text = tree.get("measure", {}).get("window")
    return None if text is None else float(text.removesuffix(f" {unit}"))


def arrives(
    run: Run, free: Run, course: Course, duration: float, window: float | None, increment: float = 0.0
) -> tuple[bool, bool]:
    """Whether the last target is missed, and whether that is not sure; `increment` is in the axis coordinate.

    `free` is the same run without a limit of its effort: its error at rest is what loop, bias and disturbance explain. Between the window and
    the window with all that may be explained nothing is judged, and neither are targets on the way, whose rest may be too short.
    """
    missed = near = False
    sequences = list(course.sequences(duration))
    for number, (last, until) in enumerate(sequences):
        if until <= last.end:
            missed = True
            near |= until > last.end - 0.02 * (last.end - last.start)
            continue
        near |= until < last.end + 0.02 * (last.end - last.start)
        inside = (run.t >= until - (until - last.end) / 10) & (run.t <= until)
        way = abs(last.target - last.origin)
        given = window if window is not None else max(1e-3 * way, 10 * increment)
        if run.t[-1] < until - 2 * run.t[1] or not inside.any():
            # The numbers ended before.
            return True, near
        error = abs(float(numpy.mean(last.target - run.load[inside])))
        explained = float(numpy.max(numpy.abs(last.target - free.load[inside[: len(free.load)].nonzero()[0]]), initial=0.0))
        least, most = min(given, OF_WAY * way), given + explained + EXPLAINED * way
        is_missed = error > most * (1 + SHARE)
        near |= least * (1 - SHARE) < error <= most * (1 + SHARE) or (is_missed and number + 1 < len(sequences))
        missed |= is_missed
    return missed, near


def swings(run: Run, course: Course, asked: int = 1) -> tuple[bool, bool, int]:
    """Whether effort goes from limit to limit too often, whether that is near, and how often beyond what is asked for.

    A move asks for one, a disturbance for another; before the first move nothing but a disturbance does.
    """
    starts = [float("-inf"), *(move.start for move in course.moves), float("inf")]
    most = -99
    for number, (start, end) in enumerate(zip(starts, starts[1:])):
        cut = run.cut[(run.t >= start) & (run.t < end)]
        cut = cut[cut != 0]
        most = max(most, int(numpy.sum(cut[1:] != cut[:-1])) - (asked if number else asked - 1))
    return most > SWINGS, abs(most - SWINGS) <= NEAR_SWINGS, most
