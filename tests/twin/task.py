"""Tasks: what a healthy axis is to do, as tables of a scenario, and as the oracle reads them.

Each kind of program is a function of a random axis. What it asks for is a list of phases, with times of the program's own (s from its
first instant), or with the calls whose outputs begin and end them.
"""

from dataclasses import dataclass, field
from math import inf
from typing import Any

import numpy

from draws import Random
from verdict_classes.case import Tree, quantity
from verdict_classes.course import Bounds, course

from machine import Axis


@dataclass(frozen=True)
class Phase:
    """A part of a task."""

    kind: str
    """`way`, `rest`, `swing` at rest that goes on, or any that is no `calm`, `stand`, `velocity`, `effort` or `stop`; `homing` is not judged."""
    begin: Any
    """Time (s), or the output of a call that begins it: `move.Active`."""
    end: Any
    """Time (s), infinite for the end of the run, or an output."""
    target: float = 0.0
    """Position, velocity or effort that is asked for; of a stop the velocity at its beginning."""
    size: float = 0.0
    """Distance of a way or of the one before a rest."""


@dataclass
class Task:
    """A task for an axis."""

    name: str
    tables: Tree
    phases: list[Phase]
    velocity: float
    acceleration: float
    """Peaks of it."""
    span: float
    """Way that its window and increments are in proportion to."""
    length: float
    """Duration of the program (s)."""
    files: dict[str, str] = field(default_factory=dict)
    is_bus: bool = False
    objects: Tree = field(default_factory=dict)
    """Of the drive."""
    switches: Tree = field(default_factory=dict)


@dataclass(frozen=True)
class Pace:
    """How fast an axis may be asked to go, so that it follows."""

    distance: float
    bounds: Bounds
    rest: float
    """Long enough to come to rest (s)."""


def draw_pace(random: Random, axis: Axis, *, follows: bool) -> Pace:
    """Moves of some dozen time constants of the position loop."""
    k = axis.position_gain
    distance = random.decades(-2.3, -0.3) if axis.linear_axis else random.decades(-0.5, 1.5)
    time = random.uniform(12, 30) / k if follows else random.uniform(32, 50) / k
    v = 1.6 * distance / time
    a = v / (time * random.uniform(0.12, 0.3))
    j = None if random.random() < 0.15 else a / (time * random.uniform(0.05, 0.15))
    return Pace(distance, Bounds(v, a, j), random.uniform(12, 20) / k)


def setpoint_table(bounds: Bounds, unit: str) -> Tree:
    table: Tree = {
        "order": 2 if bounds.j is None else 3,
        "velocity": quantity(bounds.v, f"{unit}/s"),
        "acceleration": quantity(bounds.a, f"{unit}/s2"),
    }
    if bounds.j is not None:
        table["jerk"] = quantity(bounds.j, f"{unit}/s3")
    return table


def feedforward(random: Random) -> Tree:
    """Of a drive without a bus, or none."""
    if random.random() < 0.3:
        return {}
    table: Tree = {"velocity": True}
    if random.random() < 0.7:
        table["effort"] = "rigid"
        table["friction"] = random.random() < 0.7
    return table


def moves_of(steps: list[tuple[float, float]], pace: Pace, tail: float) -> tuple[list[Phase], float]:
    """Phases of moves to targets, each `(pause before it, target)`, and when the last one ends."""
    way = course(steps, pace.bounds)
    phases = []
    first = way.moves[0].start
    if first > 0:
        phases.append(Phase("stand", 0.0, first))
    begin = origin = None
    for move, following in zip(way.moves, (*way.moves[1:], None)):
        begin, origin = (move.start, move.origin) if begin is None else (begin, origin)
        goes_on = following is not None and following.start <= move.end and (following.target > move.target) == (move.target > origin)
        if goes_on:
            # A way ends where it turns, or comes to a rest.
            continue
        size = abs(move.target - origin)
        phases.append(Phase("way", begin, move.end, move.target, size))
        begin = None
        until = inf if following is None else following.start
        if until > move.end:
            phases.append(Phase("rest", move.end, until, move.target, size))
            phases += [Phase(kind, move.end, until, move.target, size) for kind in ("swing", "calm")]
    return phases, way.moves[-1].end + tail


def moves(random: Random, axis: Axis, pace: Pace) -> Task:
    """One move."""
    pause = random.choice((0.0, round(pace.rest / 3, 3)))
    return of_moves("moves", axis, pace, [(pause, random.sign() * pace.distance * random.uniform(0.6, 1))])


def sequences(random: Random, axis: Axis, pace: Pace) -> Task:
    """Two to four moves, with pauses or without; now and then there and back."""
    steps, at = [], 0.0
    for number in range(random.randint(2, 4)):
        pause = round(random.choice((0.0, pace.rest)), 4) if number else round(random.choice((0.0, 0.05)), 3)
        step = random.sign() * pace.distance * random.uniform(0.6, 1)
        at = 0.0 if at and random.random() < 0.3 else at + step
        steps.append((pause, at))
    return of_moves("sequences", axis, pace, steps)


def of_moves(name: str, axis: Axis, pace: Pace, steps: list[tuple[float, float]]) -> Task:
    written: list[Tree] = []
    for pause, target in steps:
        if pause:
            written.append({"wait": quantity(pause, "s")})
        written.append({"move_to": quantity(target, axis.unit)})
    phases, length = moves_of(steps, pace, pace.rest)
    tables: Tree = {"setpoint": setpoint_table(pace.bounds, axis.unit), "program": written}
    return Task(name, tables, phases, pace.bounds.v, pace.bounds.a, pace.distance, length)


def hold(random: Random, axis: Axis, pace: Pace) -> Task:
    """Nothing but to stand, which gravity makes a task."""
    length = random.uniform(3, 6) * pace.rest
    return Task("hold", {}, [Phase("stand", 0.0, inf)], pace.bounds.v, pace.bounds.a, pace.distance, length)


def table_of(random: Random, axis: Axis, pace: Pace) -> tuple[str, list[Phase], float]:
    """Points with velocities along two or three moves that follow each other at once, phases of the way through them, and its length."""
    steps, at = [], 0.0
    for _ in range(random.randint(1, 3)):
        at += random.sign() * pace.distance * random.uniform(0.6, 1)
        steps.append((0.0, at))
    way = course(steps, pace.bounds)
    points = ["time [s],position [m],velocity [m/s]".replace("[m", f"[{axis.unit}")]
    for move in way.moves:
        times = numpy.linspace(move.start, move.end, random.randint(9, 15))
        x, v, _ = way.at(times)
        x[-1], v[-1] = move.target, 0.0
        if move is way.moves[0]:
            x[0], v[0] = 0.0, 0.0
        points += [f"{t:.6f},{p!r},{s!r}" for t, p, s in list(zip(times.tolist(), x.tolist(), v.tolist()))[0 if move is way.moves[0] else 1 :]]
    phases, _ = moves_of(steps, pace, 0.0)
    return "\n".join(points) + "\n", phases, way.moves[-1].end


def table(random: Random, axis: Axis, pace: Pace) -> Task:
    """A way through the points of a table, with turning points."""
    points, phases, length = table_of(random, axis, pace)
    tables: Tree = {"program": [{"table": {"file": "points.csv"}}]}
    return Task("table", tables, phases, pace.bounds.v, 2 * pace.bounds.a, pace.distance, length + pace.rest, files={"points.csv": points})


def ramp(bounds: Bounds, velocity: float) -> float:
    """How long it takes to change a velocity by so much (s)."""
    v = abs(velocity)
    if bounds.j is None:
        return v / bounds.a
    return v / bounds.a + bounds.a / bounds.j if v >= bounds.a**2 / bounds.j else 2 * (v / bounds.j) ** 0.5


def velocity(random: Random, axis: Axis, pace: Pace) -> Task:
    """A velocity that is held, and then to stand."""
    speed, held = random.sign() * pace.bounds.v * random.uniform(0.3, 1), round(2 * pace.rest, 3)
    time = ramp(pace.bounds, speed)
    per = f"{axis.unit}/s"
    steps = [{"reach_velocity": quantity(speed, per), "hold": quantity(held, "s")}, {"reach_velocity": quantity(0.0, per)}]
    end, target = 2 * time + held, speed * (time + held)
    phases = [Phase("velocity", time, time + held, speed)]
    # Its set-point is one of positions all the way, so that its end is a rest.
    phases.append(Phase("way", 0.0, end, target, abs(target)))
    phases += [Phase(kind, end, inf, target, abs(target)) for kind in ("rest", "swing", "calm")]
    tables: Tree = {"setpoint": setpoint_table(pace.bounds, axis.unit), "program": steps}
    return Task("velocity, direct", tables, phases, pace.bounds.v, pace.bounds.a, pace.distance, 2 * time + held + pace.rest)


DIRECT = {"moves": moves, "sequences": sequences, "hold": hold, "table": table, "velocity, direct": velocity}
