"""Modulo: a rotary axis that turns on and on, and a run that is long enough for one way round and too short for the other."""

from math import radians
from typing import Any

from draws import Random

from .case import NOTHING, Case, Tree
from .machine import Program, draw_machine

UNITS = {"m": "rad", "mm": "mrad", "kg": "kg m2", "N": "Nm", "N s/m": "Nm s/rad", "m/s": "rad/s", "m/s2": "rad/s2", "m/s3": "rad/s3"}
KEYS = {"mass": "inertia", "max_force": "max_torque"}


def turned(value: Any) -> Any:
    """The same with angles for lengths."""
    match value:
        case dict():
            return {KEYS.get(key, key): turned(one) for key, one in value.items()}
        case list():
            return [turned(one) for one in value]
        case str() if " " in value:
            number, unit = value.split(" ", 1)
            return f"{number} {UNITS.get(unit, unit)}"
    return value


def way(random: Random, origin: float, target: float, period: float) -> tuple[float, Tree]:
    """Which way the axis goes, and what the call says of it."""
    forward = (target - origin) % period
    backward = forward - period
    shortest = min(forward, backward, key=abs)
    ways = {"positive": forward, "negative": backward, "shortest": shortest, None: shortest}
    direction = random.choice(list(ways))
    return ways[direction], {} if direction is None else {"direction": direction}


def draw(random: Random) -> Case | None:
    """One to four moves to positions within the period; the last one ends in the run, or does not."""
    p = Program(draw_machine(random), random)
    p.machine.tree["plc"] = {"homing_required": False}
    p.power()
    degrees, origin = random.randint(30, 90), 0.0
    period = radians(degrees)
    duration_of = p.machine.bounds.duration
    for _ in range(random.randint(0, 3)):
        target = round(random.uniform(0, period), 4)
        forward = (target - origin) % period
        if min(forward, period - forward, abs(2 * forward - period)) < 0.02:
            return None
        distance, inputs = way(random, origin, target, period)
        name = p.call("MC_MoveAbsolute", p.after, position=f"{target} m", **inputs)
        p.time, p.after, origin = p.time + duration_of(distance), f"{name}.Done", target
    begun = p.time + 0.012 * len(p.calls)
    near = random.uniform(0.03, 0.2) * period * random.sign()
    target = round((origin + near) % period, 4)
    distance, inputs = way(random, origin, target, period)
    short, long = (duration_of(one) for one in (abs(near), period - abs(near)))
    if long - short < 0.3:
        return None
    p.call("MC_MoveAbsolute", p.after, position=f"{target} m", **inputs)
    is_far = abs(distance) > period / 2
    tree = p.tree(begun + (short + long) / 2)
    tree["bus"] = tree["bus"] | {"units": {"drive": 1, "axis": "1e-5 deg"}}
    tree = turned(tree)
    tree["axis"] |= {"motion": "rotary", "modulo": f"{degrees} deg"}
    note = f"{distance:.4g} rad of a period of {period:.4g} rad, from {begun:.3f} s on; {short:.3f} s or {long:.3f} s long"
    if is_far:
        return Case(tree, frozenset({"executed"}), frozenset({"arrives"}), note=note)
    return Case(tree, NOTHING, note=note)
