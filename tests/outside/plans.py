"""Asks the crate `servobench-motion` for plans, through its example `plan_lines`, and follows them by itself."""

import math
import subprocess
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import NamedTuple

ROOT = Path(__file__).resolve().parents[2]


class State(NamedTuple):
    """Position and its derivatives (SI)."""

    x: float = 0.0
    v: float = 0.0
    a: float = 0.0
    j: float = 0.0

    def after(self, snap: float, t: float) -> "State":
        """The state `t` later under a constant snap."""
        x, v, a, j = self
        return State(
            x + t * (v + t * (a / 2 + t * (j / 6 + t * snap / 24))),
            v + t * (a + t * (j / 2 + t * snap / 6)),
            a + t * (j + t * snap / 2),
            j + t * snap,
        )


class Limits(NamedTuple):
    """What a plan may not exceed, magnitudes by direction (SI)."""

    v_below: float
    v_above: float
    a_below: float
    a_above: float
    jerk: float
    snap: float = math.inf

    @classmethod
    def both(cls, v: float, a: float, jerk: float, snap: float = math.inf) -> "Limits":
        """The same in both directions."""
        return cls(v, v, a, a, jerk, snap)

    def excess(self, state: State) -> float:
        """The largest part by which the state is beyond a limit; below zero within all of them."""
        return max(
            state.v / self.v_above - 1,
            -state.v / self.v_below - 1,
            state.a / self.a_above - 1,
            -state.a / self.a_below - 1,
            abs(state.j) / self.jerk - 1,
        )


@dataclass(frozen=True)
class Request:
    """From a state to `to`, a position and a velocity. `method` is a planner and its method, as `plan_lines` has them."""

    method: str
    order: int
    start: State
    to: State
    limits: Limits

    def line(self) -> str:
        """As `plan_lines` reads it."""
        planner, method = self.method.split()
        l = self.limits
        if planner == "profile":
            numbers: tuple[float, ...] = (self.to.x - self.start.x, l.v_above, l.a_above, l.jerk, l.snap)
        else:
            numbers = (*self.start, self.to.x, self.to.v, *l)
        return " ".join([planner, str(self.order), method, *map(repr, map(float, numbers))])


@dataclass(frozen=True)
class Plan:
    """What was planned: the highest derivative and the length of each segment."""

    request: Request
    duration: float
    segments: Sequence[tuple[float, float]]

    def corners(self) -> Iterator[tuple[State, float, float]]:
        """The state in which each segment begins, its snap and its length."""
        state = self.request.start
        for value, length in self.segments:
            snap = value
            if self.request.order == 3:
                state, snap = state._replace(j=value), 0.0
            yield state, snap, length
            state = state.after(snap, length)
        yield state, 0.0, 0.0

    def instants(self) -> list[float]:
        """When the segments begin, and the end."""
        times = [0.0]
        for _, length in self.segments:
            times.append(times[-1] + length)
        return times

    def at(self, t: float) -> State:
        """The state `t` after the start."""
        for state, snap, length in self.corners():
            if t <= length:
                return state.after(snap, t)
            t -= length
        return state

    def defect(self) -> float:
        """How far it is from what was asked: beyond the limits, or beside the target, as a part of the sizes of both."""
        limits, to = self.request.limits, self.request.to
        worst = 0.0
        for state, snap, length in self.corners():
            extremes = [0.0, *_zeros(snap / 2, state.j, state.a)]
            if snap:
                extremes.append(-state.j / snap)
            for t in extremes:
                if 0 <= t <= length:
                    worst = max(worst, limits.excess(state.after(snap, t)))
        travel = abs(to.x - self.request.start.x) + max(limits.v_below, limits.v_above) * self.duration
        missed = [
            abs(state.x - to.x) / travel,
            abs(state.v - to.v) / limits.v_above,
            abs(state.a) / limits.a_above,
            abs(state.j) / limits.jerk if self.request.order == 4 else 0.0,
            abs(self.instants()[-1] / self.duration - 1),
        ]
        return max(worst, *missed)


def _zeros(c2: float, c1: float, c0: float) -> list[float]:
    """Where c2·t² + c1·t + c0 is zero."""
    if c2 == 0:
        return [-c0 / c1] if c1 else []
    square = c1 * c1 - 4 * c2 * c0
    if square < 0:
        return []
    larger = -(c1 + math.copysign(math.sqrt(square), c1)) / 2
    return [larger / c2, c0 / larger] if larger else [0.0]


def ask(requests: Sequence[Request]) -> list[Plan]:
    """Has every request planned, by one call of the program."""
    command = ["cargo", "run", "--quiet", "--release", "--package", "servobench-motion", "--example", "plan_lines"]
    lines = "".join(request.line() + "\n" for request in requests)
    done = subprocess.run(command, cwd=ROOT, input=lines, stdout=subprocess.PIPE, text=True, check=True)
    plans = []
    for request, answer in zip(requests, done.stdout.splitlines(), strict=True):
        duration, *numbers = map(float, answer.split())
        plans.append(Plan(request, duration, list(zip(numbers[::2], numbers[1::2], strict=True))))
    return plans
