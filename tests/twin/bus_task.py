"""Tasks over a fieldbus: programs of moves in the modes csp, csv, pp, ip and pv, and function blocks."""

from dataclasses import dataclass, replace
from math import inf, log10, pi
from typing import Any

from draws import Random
from verdict_classes.case import Tree, quantity

from machine import Axis
from task import Pace, Phase, Task, moves_of, setpoint_table

ENABLED = "drive.state=Operation enabled"
"""From then on a task is heard."""


def bus_table(random: Random, axis: Axis, pace: Pace, mode: str) -> Tree:
    """`[bus]`, with what the master feeds forward."""
    table: Tree = {"cycle": f"{random.choice((1, 1, 2))} ms", "mode": mode}
    table["units"] = {"drive": 1, "axis": quantity(unit_of(pace.distance), "m" if axis.linear_axis else "deg")}
    if mode == "csv":
        # A third of what the age of the position allows, as docs/fieldbus.md has it.
        table["cycle"] = "1 ms"
        table["position_gain"] = quantity(min(axis.position_gain, 60.0), "1/s")
    if mode == "csp" and random.random() < 0.7:
        table["velocity_offset"] = True
        if random.random() < 0.7:
            table["effort_offset"] = "rigid"
    return table


def unit_of(span: float) -> float:
    """Of the drive, for moves over so much: a power of ten of a metre or of a degree, in the axis unit."""
    return 10.0 ** round(log10(span * 1e-5))


def program(mode: str) -> Any:
    """A program of moves in a mode of the bus."""

    def task(random: Random, axis: Axis, pace: Pace) -> Task:
        steps, at = [], 0.0
        for number in range(random.randint(1, 3)):
            pause = round(pace.rest, 3) if number or random.random() < 0.3 else 0.05
            step = random.sign() * pace.distance * random.uniform(0.6, 1)
            at = 0.0 if at and random.random() < 0.3 else at + step
            steps.append((pause, at))
        written: list[Tree] = []
        for pause, target in steps:
            written += [{"wait": quantity(pause, "s")}, {"move_to": quantity(target, axis.unit)}]
        phases, length = moves_of(steps, pace, pace.rest + 0.05)
        tables: Tree = {"bus": bus_table(random, axis, pace, mode), "setpoint": setpoint_table(pace.bounds, axis.unit), "program": written}
        return Task(mode, tables, phases, pace.bounds.v, pace.bounds.a, pace.distance, length, is_bus=True)

    return task


@dataclass
class Calls:
    """A chain of calls."""

    axis: Axis
    pace: Pace
    calls: list[Tree]
    phases: list[Phase]
    length: float = 0.1
    at: float = 0.0
    last: float = 0.0
    """Distance of the last move."""
    last_done: str = ""

    def call(self, block: str, name: str, start: Any = None, **inputs: Any) -> str:
        self.calls.append({"block": block, "name": name} | ({} if start is None else {"start": start}) | inputs)
        return name

    def after(self, output: str, delay: float) -> Any:
        self.length += delay
        return {"after": output, "delay": quantity(round(delay, 4), "s")} if delay else output

    def move(self, name: str, start: Any, target: float, block: str = "MC_MoveAbsolute") -> None:
        """A move and the rest behind it, which the next call cuts off."""
        distance = target - self.at
        inputs = {"position": quantity(target, self.axis.unit)} if block == "MC_MoveAbsolute" else {"distance": quantity(distance, self.axis.unit)}
        self.call(block, name, start, **inputs)
        self.phases.append(Phase("way", f"{name}.Active", f"{name}.Done", target, abs(distance)))
        if start == self.last_done and (distance > 0) == (self.last > 0):
            # A way ends where it turns, or comes to a rest.
            whole = self.phases[-3].size + abs(distance)
            self.phases[-3], self.phases[-1] = (replace(self.phases[at], size=whole) for at in (-3, -1))
        self.last, self.last_done = distance, f"{name}.Done"
        self.phases.append(Phase("rest", f"{name}.Done", inf, target, abs(distance)))
        self.length += self.pace.bounds.duration(distance) + 0.02
        self.at = target

    def task(self, name: str, bus: Tree, tables: Tree | None = None) -> Task:
        """The whole; each rest ends where the next phase begins."""
        for number, phase in enumerate(self.phases[:-1]):
            if phase.end == inf:
                self.phases[number] = Phase(phase.kind, phase.begin, self.phases[number + 1].begin, phase.target, phase.size)
        for phase in [phase for phase in self.phases if phase.kind == "rest"]:
            self.phases += [Phase(kind, phase.begin, phase.end, phase.target, phase.size) for kind in ("swing", "calm")]
        bounds = self.pace.bounds
        whole: Tree = {"bus": bus, "setpoint": setpoint_table(bounds, self.axis.unit)} | (tables or {}) | {"call": self.calls}
        whole.setdefault("plc", {"homing_required": False})
        return Task(name, whole, self.phases, bounds.v, bounds.a, self.pace.distance, self.length, is_bus=True)


def chain(axis: Axis, pace: Pace) -> Calls:
    calls = Calls(axis, pace, [], [])
    calls.call("MC_Power", "power")
    return calls


def blocks(random: Random, axis: Axis, pace: Pace) -> Task:
    """Moves to positions and by distances, one behind the other."""
    calls = chain(axis, pace)
    after, delay = "power.Status", random.choice((0.0, 0.05))
    for number in range(random.randint(1, 3)):
        name = f"move_{number}"
        step = random.sign() * pace.distance * random.uniform(0.6, 1)
        target = 0.0 if calls.at and random.random() < 0.3 else calls.at + step
        calls.move(name, calls.after(after, delay), target, random.choice(("MC_MoveAbsolute", "MC_MoveRelative")))
        after, delay = f"{name}.Done", random.choice((0.0, pace.rest, pace.rest))
    calls.length += pace.rest
    return calls.task("blocks", bus_table(random, axis, pace, "csp"))


def velocity(random: Random, axis: Axis, pace: Pace) -> Task:
    """A velocity that is held to the end, in csp, csv or pv."""
    calls = chain(axis, pace)
    speed = random.sign() * pace.bounds.v * random.uniform(0.3, 1)
    calls.call("MC_MoveVelocity", "go", "power.Status", velocity=quantity(speed, f"{axis.unit}/s"))
    calls.phases.append(Phase("velocity", "go.InVelocity", inf, speed))
    calls.length += 2 * abs(speed) / pace.bounds.a + 2 * pace.rest
    return calls.task("velocity", bus_table(random, axis, pace, random.choice(("csp", "csv", "pv"))))


def stop(random: Random, axis: Axis, pace: Pace) -> Task:
    """A velocity, and then a stop by MC_Stop or MC_Halt."""
    calls = chain(axis, pace)
    speed = random.sign() * pace.bounds.v * random.uniform(0.3, 1)
    calls.call("MC_MoveVelocity", "go", "power.Status", velocity=quantity(speed, f"{axis.unit}/s"))
    block = random.choice(("MC_Stop", "MC_Halt"))
    calls.call(block, "stop", calls.after("go.InVelocity", pace.rest))
    calls.phases.append(Phase("velocity", "go.InVelocity", "stop.Busy", speed))
    calls.phases.append(Phase("stop", "stop.Done", inf, speed))
    calls.length += 4 * abs(speed) / pace.bounds.a + 1.5 * pace.rest
    return calls.task("stop", bus_table(random, axis, pace, random.choice(("csp", "csv", "pv"))))


def hold(random: Random, axis: Axis, pace: Pace) -> Task:
    """Power, and nothing else."""
    calls = chain(axis, pace)
    calls.phases.append(Phase("stand", "power.Status", inf))
    calls.length += 4 * pace.rest
    return calls.task("hold over a bus", bus_table(random, axis, pace, random.choice(("csp", "csp", "csv"))))


def torque(random: Random, axis: Axis, pace: Pace) -> Task:
    """A torque or a force that is held to the end."""
    calls = chain(axis, pace)
    held = random.uniform(0.2, 0.4)
    # It gets faster all the time.
    effort = random.sign() * axis.total * 0.5 * pace.bounds.v / held / axis.r * random.uniform(0.3, 1)
    calls.call("MC_TorqueControl", "push", "power.Status", torque=quantity(effort, axis.effort_unit))
    calls.phases.append(Phase("effort", "push.InTorque", inf, effort))
    calls.length += held - 0.1
    bus = bus_table(random, axis, pace, "csp") | {"velocity_offset": False, "effort_offset": "off"}
    return calls.task("torque", bus)


def homing(random: Random, axis: Axis, pace: Pace) -> Task:
    """A search of the home switch, and a move from there."""
    calls = chain(axis, pace)
    unit, fast = unit_of(pace.distance) * (1 if axis.linear_axis else pi / 180), 0.3 * pace.bounds.v
    at = pace.distance * random.uniform(0.1, 0.4)
    method = random.choice((19, 21, 20, 22, 24, 28))
    leftwards = method in (21, 22, 28)
    edge = -at if leftwards else at
    width = 0.3 * pace.distance
    home = {"from": quantity(min(edge, edge - width if leftwards else edge), axis.unit), "to": quantity(max(edge, edge + width if not leftwards else edge), axis.unit)}
    calls.call("MC_Home", "home", "power.Status")
    calls.length += at / fast * 1.6 + 8 * fast / (0.5 * pace.bounds.a) + 2.5
    calls.phases.append(Phase("homing", "power.Status", "home.Done", edge))
    calls.move("move", {"after": "home.Done", "delay": quantity(round(pace.rest, 4), "s")}, random.sign() * pace.distance * random.uniform(0.6, 1))
    calls.length += 2 * pace.rest
    objects = {"6098h": method, "6099h.1": round(fast / unit), "6099h.2": max(1, round(0.2 * fast / unit)), "609Ah": round(0.5 * pace.bounds.a / unit)}
    task = calls.task("homing", bus_table(random, axis, pace, "csp"), {"plc": {"homing_required": True}})
    task.objects = objects
    task.switches = {"home": home}
    return task


BUS = {
    "csp": program("csp"),
    "csv": program("csv"),
    "pp": program("pp"),
    "ip": program("ip"),
    "blocks": blocks,
    "velocity": velocity,
    "stop": stop,
    "hold over a bus": hold,
    "torque": torque,
    "homing": homing,
}
