"""A program of function blocks.

It is written in lines: an instance with its block and its inputs, or what changes from a cycle on,

    move: MC_MoveAbsolute position=4 velocity=0.25
    at 0: move.execute
    at 40: move.execute=false axis.input.2

where `axis` is the drive.
"""

import re
from dataclasses import dataclass
from functools import cached_property

# Lengths are multiplied by this: a sixth of a jerk is a binary number then, and no position is off by rounding, for which pyplcopen
# would add a cycle.
LENGTH = 0.75
LENGTHS = ("position", "distance", "velocity", "end_velocity", "velocity_difference", "acceleration", "deceleration", "jerk")
LENGTHS += ("first_position", "last_position")
# Blocks that brake, and blocks that move. What has no limits of its own gets those with which every part of a ramp takes a whole
# cycle, to which pyplcopen rounds it up: a cycle of jerk, one of acceleration, one of jerk.
BRAKES = ("MC_HaltSuperimposed", "MC_Halt", "MC_Stop")
MOVES = ("MC_MoveAbsolute", "MC_MoveRelative", "MC_MoveAdditive", "MC_MoveVelocity", "MC_MoveContinuousAbsolute")
MOVES += ("MC_MoveContinuousRelative", "MC_MoveSuperimposed")

# An output of an instance, and the cycles in which it differs.
Differences = dict[str, list[int]]


@dataclass(frozen=True)
class Program:
    """A program, and what both implementations are known to do differently in it."""

    name: str
    # Where the test suite of pyplcopen has it.
    test: str
    cycles: int
    lines: str
    # A reason and what differs for it, a line: `reason: instance.Output 3-5 9, instance.Output 7`.
    differs: str = ""
    is_powered: bool = True

    @cached_property
    def request(self) -> str:
        """The program as both implementations read it."""
        blocks, events = [], []
        for line in filter(None, map(str.strip, self.lines.splitlines())):
            head, _, words = line.partition(": ")
            if match := re.fullmatch(r"at (\d+)", head):
                for word in words.split():
                    target, _, value = word.partition("=")
                    name, _, key = target.partition(".")
                    events.append((int(match[1]), name, key, value or "true"))
            else:
                block, *own = words.split()
                blocks.append(f"block {head} {block}")
                inputs = with_limits(block, dict(word.split("=") for word in own))
                events += [(0, head, key, value) for key, value in inputs.items()]
        events.sort(key=lambda event: event[0])
        lines = [f"program {self.cycles} {'on' if self.is_powered else 'off'}", "limits 10 10 10", *blocks]
        lines += [f"{cycle} {name} {key} {scaled(key, value)}" for cycle, name, key, value in events]
        return "\n".join([*lines, "end"]) + "\n"

    @cached_property
    def declared(self) -> dict[str, Differences]:
        """By reason, what differs."""
        declared: dict[str, Differences] = {}
        for line in filter(None, map(str.strip, self.differs.splitlines())):
            reason, _, items = line.partition(": ")
            for item in items.split(", "):
                output, *spans = item.split()
                declared.setdefault(reason, {})[output] = [cycle for span in spans for cycle in cycles_of(span)]
        return declared


def cycles_of(span: str) -> range:
    """The cycles of `3` or `3-5`."""
    first, _, last = span.partition("-")
    return range(int(first), int(last or first) + 1)


def spans_of(cycles: list[int]) -> str:
    """Cycles in the way that programs write them."""
    starts = [cycle for cycle in cycles if cycle - 1 not in cycles]
    ends = [cycle for cycle in cycles if cycle + 1 not in cycles]
    return " ".join(f"{first}" if first == last else f"{first}-{last}" for first, last in zip(starts, ends))


def scaled(key: str, value: str) -> str:
    """The value of an input in the unit of the axis."""
    return repr(LENGTH * float(value)) if key in LENGTHS else value


def with_limits(block: str, inputs: dict[str, str]) -> dict[str, str]:
    """The inputs of a block, with all limits if it moves the axis or brakes."""
    if block not in MOVES + BRAKES:
        return inputs
    velocity = "velocity_difference" if block == "MC_MoveSuperimposed" else "velocity"
    half = str(abs(float(inputs.get(velocity, 1))) / 2)
    limits = {} if block in BRAKES else {velocity: "1", "acceleration": half}
    return limits | {"deceleration": half, "jerk": half} | inputs
