"""Gains: a linear loop on either side of its boundary, judged by the eigenvalues of its monodromy matrix.

Nothing binds but, in the end, the numbers. What grows is bad even where the run is too short to show it.
"""

from dataclasses import replace
from math import exp, log

from draws import Random

from .arrival import BESIDES, arrives, program, window_of
from .axes import FINE, Axis, draw_axis
from .case import Case, quantity
from .loop import Loop, run

SHARE = 0.02
"""So near to the boundary, as a share of the gains, nothing is judged."""
MARGIN = 0.4
"""A loop that is stable with gains larger or smaller by this share follows its moves."""
FOLLOWS = frozenset({"arrives", "bounded"}) | BESIDES
"""What a loop that is unstable may break besides."""


def with_factor(loop: Loop, knob: str, factor: float) -> Loop:
    return replace(loop, **{knob: factor * getattr(loop, knob)})


def boundary(loop: Loop, knob: str) -> float | None:
    """The factor of a gain at which the loop ceases to be stable, if there is one near."""
    factor, step = 1.0, 1.25
    stable = loop.is_stable()
    for _ in range(30):
        following = factor * (step if stable else 1 / step)
        if with_factor(loop, knob, following).is_stable() != stable:
            low, high = sorted((factor, following))
            for _ in range(12):
                middle = (low * high) ** 0.5
                low, high = (middle, high) if with_factor(loop, knob, middle).is_stable() else (low, middle)
            return low
        factor = following
    return None


def draw(random: Random) -> Case | None:
    """A loop around its boundary; nothing where it has none."""
    axis = draw_axis(random, pmsm=random.random() < 0.5, sane=False)
    by_load = axis.loop.load is not None and random.random() < 0.3
    differences = FINE if random.random() < 0.3 else None
    axis = Axis(replace(axis.loop, from_load=by_load, increment=differences), axis.units)
    knob = random.choice(("gain", "gain", "position_gain"))
    factor = boundary(axis.loop, knob)
    if factor is None:
        return None
    loop = with_factor(axis.loop, knob, factor * exp(random.uniform(-1, 1) * log(random.choice((1.15, 1.6, 3.0)))))
    stable = loop.is_stable()
    near = any(other.is_stable() != stable for other in loop.near_gains(SHARE))
    return judged(random, Axis(loop, axis.units), stable, near)


def judged(random: Random, axis: Axis, stable: bool, near: bool) -> Case:
    """With an initial velocity of the load, or a small move."""
    loop, u = axis.loop, axis.units
    tree, duration = axis.tables(), round(random.uniform(0.2, 0.6), 3)
    tree["record"] = {"rate": f"{loop.base // loop.position_every} Hz"}
    breaks = frozenset() if stable else frozenset({"stable"})
    if loop.pmsm is None and random.random() < 0.4:
        course, tables = program(random, loop, u.length, random.decades(-4, -2))
        duration = round(course.moves[-1].end + random.uniform(0.3, 1.0), 3)
        tree |= tables
        found = run(loop, course, duration)
        missed, close = arrives(found, found, course, duration, window_of(tree, u.length))
        if stable:
            # A loop beside its boundary swings about its path for so long that whether it follows is not judged.
            near |= close or not all(other.is_stable() for other in loop.near_gains(MARGIN))
            breaks |= frozenset({"arrives"}) if missed else frozenset()
    else:
        speed = f"{u.length}/s"
        tree["initial"] = {"load_velocity": quantity(random.sign() * random.decades(-6, -4), speed)}
    tree["run"]["duration"] = quantity(duration, "s")
    radius = loop.radius()
    turns = duration * loop.base / loop.position_every
    note = f"largest |eigenvalue| {radius:.9f}, growth over the run e^{turns * log(radius):.3g}"
    return Case(tree, breaks, FOLLOWS if breaks else frozenset(), near, note)
