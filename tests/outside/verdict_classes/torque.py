"""Torque: moves with from a hundredth to three times the effort that they need, judged by a run of our own."""

from dataclasses import dataclass, replace

import numpy

from draws import Random

from .arrival import BESIDES, SHARE, arrives, program, swings, window_of
from .axes import Axis, draw_axis
from .case import NOTHING, Case, Tree, quantity
from .course import Course
from .loop import Loop, Run, run

LONGEST = 2.5
"""No run is longer (s)."""
FOLLOWS = 0.01
"""An axis that follows is no further from where it goes without a limit than this share of its shortest way."""
WIDTHS = 10
"""So many widths of the set-point's range positions may be outside of it."""


def draw_loop(random: Random) -> Axis | None:
    """A loop that is stable by far, or nothing."""
    axis = draw_axis(random, pmsm=False, sane=True)
    loop = replace(axis.loop, velocity_share=random.choice((0.0, 0.0, 1.0)))
    # A faster position loop goes from limit to limit where the effort is scarce.
    loop = replace(loop, position_gain=random.choice((1.0, 1.0, 3.0, 6.0)) * loop.position_gain)
    if loop.radius() > 1 - 1e-4 or not all(other.is_stable() for other in loop.near_gains(0.2)):
        return None
    return Axis(loop, axis.units)


@dataclass
class Asked:
    """What a run is to do."""

    course: Course
    tables: Tree
    duration: float
    push: tuple[float, float] | None


def draw_moves(random: Random, axis: Axis) -> tuple[Loop, Asked, float] | None:
    """Moves, now and then with a push, and the loop with its limit, its bias and its encoder; and the share of the limit."""
    loop, u = axis.loop, axis.units
    course, tables = program(random, loop, u.length, random.decades(-2.5, -0.5), random.choice((1, 1, 2, 3)))
    end = course.moves[-1].end
    slack = random.uniform(4, 40) / loop.position_gain
    duration = round(end + random.choice((slack, slack, slack, 0.1 * slack, -random.uniform(0, 0.02))), 3)
    if not 0.05 < duration < LONGEST:
        return None
    total = loop.inertia + (loop.load[0] * loop.r**2 if loop.load else 0.0)
    bounds = course.moves[0].bounds
    bias = random.choice((0.0, random.uniform(-0.5, 0.5))) * total * bounds.a / loop.r
    needed = total * bounds.a / loop.r + loop.viscous * bounds.v / loop.r + abs(bias)
    share = random.decades(-2, 0.5)
    increment = None
    if random.random() < 0.25:
        increment = abs(course.moves[0].target) / loop.r * random.decades(-5, -3.3)
    loop = replace(loop, bias=bias, limit=share * needed, increment=increment)
    push = None
    if random.random() < 0.2:
        push = (round(random.uniform(0, duration), 3), random.sign() * random.uniform(0.1, 1.5) * loop.limit)
        text = quantity(push[1], u.effort)
        name = "force" if u.effort == "N" else "torque"
        tables["disturbance"] = [{"on": "motor", "start": quantity(push[0], "s"), name: text}]
    return loop, Asked(course, tables, duration, push), share


def outside(found: Run) -> float:
    """How far motor or load go outside the range of the set-point, in widths of it; 0 where nothing is to move."""
    low, high = float(numpy.min(found.reference)), float(numpy.max(found.reference))
    if low == high:
        return 0.0
    both = numpy.concatenate((found.motor, found.load))
    return float(max(numpy.max(both) - high, low - numpy.min(both))) / (high - low)


def follows(found: Run, free: Run, course: Course) -> bool:
    """Whether the axis follows by far: the load goes where it goes without a limit of the effort."""
    ticks = min(len(found.t), len(free.t))
    shortest = min(abs(move.target - move.origin) for move in course.moves)
    return float(numpy.max(numpy.abs(found.load[:ticks] - free.load[:ticks]))) < FOLLOWS * shortest


def draw(random: Random) -> Case | None:
    """Moves under an effort limit."""
    axis = draw_loop(random)
    drawn = None if axis is None else draw_moves(random, axis)
    if axis is None or drawn is None:
        return None
    loop, asked, share = drawn
    course, duration, length = asked.course, asked.duration, axis.units.length
    found = run(loop, course, duration, asked.push)
    free = run(replace(loop, limit=float("inf")), course, duration, asked.push)
    tree = Axis(loop, axis.units).tables() | asked.tables
    tree["run"]["duration"] = quantity(duration, "s")
    tree["record"] = {"rate": f"{loop.base // loop.position_every} Hz"}
    increment = loop.r * (loop.increment or 0.0)
    missed, near = arrives(found, free, course, duration, window_of(tree, length), increment)
    swinging, close, often = swings(found, course, 1 if asked.push is None else 2)
    breaks = {name for name, is_broken in (("arrives", missed), ("stable", swinging)) if is_broken}
    farthest = outside(found)
    if farthest > WIDTHS:
        breaks.add("bounded")
    # Swings within a few increments of an encoder are no limit cycle.
    near |= swinging and increment > 0.0
    near |= close or abs(farthest / WIDTHS - 1) < SHARE
    # Whether it followed on the way, though it arrived, is another class's: only who followed by far is good.
    near |= not breaks and not follows(found, free, course)
    note = f"{share:.3g} of the effort that is needed, {often} swings from limit to limit beyond what is asked for"
    return lifted(random, tree, frozenset(breaks), near, f"{note}, {farthest:.3g} widths of the set-point's range outside of it")


def lifted(random: Random, tree: Tree, breaks: frozenset[str], near: bool, note: str) -> Case:
    """Now and then a requirement is lifted, or the drive is off and nothing is asked."""
    if random.random() < 0.03:
        tree["drive"]["enabled"] = False
        return Case(tree, frozenset({"executed"}), is_near=False, note="the drive is off")
    if random.random() < 0.15:
        name = random.choice(("arrives", "stable", "bounded"))
        tree["requirements"] = dict.fromkeys((name, *sorted(BESIDES)), False)
        breaks -= {name}
    return Case(tree, breaks, BESIDES if breaks else NOTHING, near, note)
