"""Set-points of a program, in closed form: moves of order 2 and 3 from rest to rest, and pauses.

The profile of order 3 goes +j, 0, −j, 0, −j, 0, +j with the times (t_j, t_a, t_j, t_v, t_j, t_a, t_j); its distance is
j·t_j·(t_j + t_a)·(2·t_j + t_a + t_v). Of order 2: a·t_a·(t_a + t_v).
"""

from dataclasses import dataclass
from math import cbrt, sqrt

import numpy


@dataclass(frozen=True)
class Bounds:
    """What a move respects; without a jerk it is of order 2."""

    v: float
    a: float
    j: float | None = None

    def pieces(self, distance: float) -> list[tuple[float, float]]:
        """Durations, and the highest derivative in each."""
        sign, d = (1.0 if distance >= 0 else -1.0), abs(distance)
        if self.j is None:
            ta = min(sqrt(d / self.a), self.v / self.a)
            tv = d / (self.a * ta) - ta
            return [(ta, sign * self.a), (tv, 0.0), (ta, -sign * self.a)]
        j = sign * self.j
        tj = min(cbrt(d / (2 * self.j)), sqrt(self.v / self.j), self.a / self.j)
        ta = (sqrt(tj * tj + 4 * d / (self.j * tj)) - 3 * tj) / 2
        ta = max(0.0, min(ta, self.v / (self.j * tj) - tj))
        tv = max(0.0, d / (self.j * tj * (tj + ta)) - 2 * tj - ta)
        return [(tj, j), (ta, 0.0), (tj, -j), (tv, 0.0), (tj, -j), (ta, 0.0), (tj, j)]

    def duration(self, distance: float) -> float:
        return sum(time for time, _ in self.pieces(distance))


@dataclass(frozen=True)
class Move:
    """One move of a program, with its place in time."""

    start: float
    end: float
    origin: float
    target: float
    bounds: Bounds


@dataclass(frozen=True)
class Course:
    """A program of moves."""

    moves: tuple[Move, ...]

    def at(self, t: numpy.ndarray) -> tuple[numpy.ndarray, numpy.ndarray, numpy.ndarray]:
        """Position, velocity and acceleration of the set-point."""
        x, v, a = numpy.zeros_like(t), numpy.zeros_like(t), numpy.zeros_like(t)
        for move in self.moves:
            x[t >= move.start] = move.origin
            distance, time = move.target - move.origin, move.start
            at, speed, acceleration = move.origin, 0.0, 0.0
            for duration, highest in move.bounds.pieces(distance):
                inside = (t >= time) & (t < time + duration)
                s = t[inside] - time
                jerk = 0.0
                if move.bounds.j is None:
                    acceleration = highest
                else:
                    jerk = highest
                x[inside] = at + speed * s + acceleration * s**2 / 2 + jerk * s**3 / 6
                v[inside] = speed + acceleration * s + jerk * s**2 / 2
                a[inside] = acceleration + jerk * s
                at += speed * duration + acceleration * duration**2 / 2 + jerk * duration**3 / 6
                speed += acceleration * duration + jerk * duration**2 / 2
                acceleration += jerk * duration
                time += duration
            assert abs(at - move.target) <= 1e-9 * abs(distance), "a profile ends at its target"
            behind = t >= move.end
            x[behind], v[behind], a[behind] = move.target, 0.0, 0.0
        return x, v, a

    def sequences(self, end: float) -> list[tuple[Move, float]]:
        """The last move of each sequence, and when the next sequence begins or the run ends."""
        ends = []
        for move, following in zip(self.moves, (*self.moves[1:], None)):
            until = end if following is None else following.start
            if following is None or until > move.end:
                ends.append((move, until))
        return ends


def course(steps: list[tuple[float, float]], bounds: Bounds) -> Course:
    """Moves to targets, each `(pause before it, target)`."""
    time, at, moves = 0.0, 0.0, []
    for pause, target in steps:
        start = time + pause
        time = start + bounds.duration(target - at)
        moves.append(Move(start, time, at, target, bounds))
        at = target
    return Course(tuple(moves))
