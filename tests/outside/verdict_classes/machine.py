"""A linear axis on a fieldbus, and programs of function blocks for it that are put together of pieces."""

from dataclasses import dataclass, field
from math import pi
from typing import Any

from draws import Random

from .case import Tree, quantity
from .course import Bounds

# Base rate, and base ticks per turn of velocity and position loop; a position turn is a whole part of a cycle.
RATES = [(8_000, 2, 4), (10_000, 5, 5), (12_000, 3, 6), (16_000, 2, 4), (20_000, 5, 10), (24_000, 3, 6)]
RANGE = 0.4
"""Moves go to positions from 0 to here (m)."""


@dataclass
class Machine:
    """The axis, and what its position loop and its set-points are."""

    tree: Tree
    bounds: Bounds
    gain: float
    """Of the position loop (1/s)."""
    follows: bool
    """Whether velocity and force are fed forward; if not, the axis lags by velocity over gain."""

    @property
    def rest(self) -> float:
        """How long the axis takes to rest behind the set-point, to e^-18 (s)."""
        return 0.0 if self.follows else 18 / self.gain


def draw_machine(random: Random, *, follows: bool = True) -> Machine:
    base, velocity, position = random.choice(RATES)
    mass = round(random.uniform(3, 60), 2)
    gain = 2 * pi * random.uniform(9, 16)
    v, a = round(random.uniform(0.2, 0.7), 3), round(random.uniform(2, 9), 2)
    bounds = Bounds(v, a, round(a / random.uniform(0.02, 0.06), 1))
    cycle = random.choice((1, 1, 2))
    tree: Tree = {
        "run": {"base_rate": f"{base} Hz"},
        "axis": {"motion": "linear", "motor_side": {"mass": f"{mass} kg", "viscous": f"{random.randint(0, 40)} N s/m"}},
        "motor": {"kind": "ideal-source"},
        "drive": {
            # What 60B2h is counted in; no move needs as much.
            "max_force": quantity(mass * (4 * a + 100), "N"),
            "velocity": {"rate": f"{base // velocity} Hz", "bandwidth": quantity(5.5 * gain, "rad/s")},
            "position": {"rate": f"{base // position} Hz", "gain": quantity(gain, "1/s")},
        },
        "bus": {"cycle": f"{cycle} ms", "units": {"drive": 1, "axis": "0.1 um"}},
        "setpoint": {"order": 3, "velocity": f"{v} m/s", "acceleration": f"{a} m/s2", "jerk": f"{bounds.j} m/s3"},
        "record": {"rate": "500 Hz"},
    }
    if follows:
        tree["bus"] |= {"velocity_offset": True, "effort_offset": "rigid"}
    if random.random() < 0.3:
        tree["bus"]["motion_cycle"] = f"{2 * cycle} ms"
    return Machine(tree, bounds, gain, follows)


@dataclass
class Program:
    """Calls in a chain: each piece starts when the one before is over."""

    machine: Machine
    random: Random
    calls: list[Tree] = field(default_factory=list)
    expected: list[Tree] = field(default_factory=list)
    after: str = ""
    """The output that the next piece waits for; none: the first cycle."""
    time: float = 0.0
    """The chain takes as long, but for some cycles for each piece (s)."""
    at: float | None = 0.0
    """Where the set-point rests then, if that is known (m)."""

    def call(self, block: str, start: Any = None, **inputs: Any) -> str:
        """One more call; returns its name."""
        name = f"c{len(self.calls)}"
        self.calls.append({"block": block, "name": name} | ({} if start is None else {"start": start}) | inputs)
        return name

    def then(self, delay: float = 0.0) -> Any:
        """The start of the next piece, so long after the one before."""
        delay += self.machine.rest if len(self.calls) > 1 else 0.0
        self.time += delay
        return {"after": self.after, "delay": quantity(delay, "s")} if delay else self.after

    def power(self) -> None:
        self.after = f"{self.call('MC_Power')}.Status"

    def target(self, least: float = 0.03) -> float:
        """A position that is at least so far away."""
        while True:
            target = round(self.random.uniform(0, RANGE), 4)
            if self.at is None or abs(target - self.at) >= least:
                return target

    def far(self) -> float:
        """A position that is far from a known one, so that a move has time to be broken off."""
        return self.at + self.random.sign() * self.random.uniform(0.15, 0.4)

    def move(self, **inputs: Any) -> str:
        """A move to a position."""
        target = self.target()
        name = self.call("MC_MoveAbsolute", self.then(), position=f"{target} m", **inputs)
        self.went(target, name)
        return name

    def went(self, target: float | None, name: str, output: str = "Done") -> None:
        """The piece ends with an output, at a position that is known or not."""
        known = None not in (self.at, target)
        self.time += self.machine.bounds.duration(target - self.at if known else 3 * RANGE)
        self.at, self.after = target, f"{name}.{output}"

    def expect(self, who: str, fault: str, start: float | None = None, end: float | None = None) -> None:
        window = {"from": start, "to": end}
        self.expected.append({"fault": fault, "who": who} | {k: quantity(t, "s") for k, t in window.items() if t is not None})

    def tree(self, duration: float | None = None) -> Tree:
        """The whole scenario; long enough for all of it unless it is told how long it is."""
        ample = 0.3 + self.machine.rest + 1.05 * self.time + 0.03 * len(self.calls)
        tree = self.machine.tree | {"call": self.calls, "measure": {"window": "0.2 mm"}}
        tree["run"] = tree["run"] | {"duration": quantity(round(duration or ample, 3), "s")}
        if self.expected:
            tree["expect"] = self.expected
        return tree
