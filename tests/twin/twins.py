"""Pairs of twins: a healthy machine with its task, and the same with a sabotage. All of it follows from a seed."""

import shutil
from dataclasses import dataclass, field, replace
from math import log10, pi
from pathlib import Path
from typing import Any

from draws import Random
from verdict_classes.case import Tree, quantity, toml

import fmu
import mjcf
from linear import has_margins
from machine import LEAST_TORQUE, Axis, Pmsm, draw_axis, estimate, increment_of, with_motor
from oracle import Settling, Tolerance
from sabotages import CABLES, PARTS, SABOTAGES, SHAKEN, Change, Twin, possible, with_extra
from bus_task import BUS, unit_of
from task import DIRECT, Task, draw_pace, feedforward

PROGRAMS = {**DIRECT, **BUS}
ENGINES = ("exact", "exact", "exact", "exact", "exact", "rapier", "mujoco")
FOREIGN = ("rapier", "mujoco")
"""Engines for bodies that are a file of their own."""
NEARLY_THE_SAME = 1 + 1e-9
"""The mass of a sister."""


@dataclass
class Judge:
    """What the verdict is told besides, to make it look away."""

    tables: Tree = field(default_factory=dict)
    """Tables of the file that it judges by."""
    longer: float = 1.0
    """How many times as long both machine and file run."""
    window: float | None = None
    lifted: str | None = None
    note: str = ""


@dataclass
class Pair:
    """A sabotage of a twin."""

    name: str
    sabotage: str
    change: Change
    judge: Judge | None = None


@dataclass
class Family:
    """A healthy twin, two sisters, and what was made of it."""

    name: str
    program: str
    twin: Twin
    engine: str
    tolerance: Tolerance
    settling: Settling
    is_mjcf: bool = False
    is_alone: bool = False
    """Healthy machines alone; to each there is one with a finer encoder, which tells what its own costs."""
    pairs: list[Pair] = field(default_factory=list)


NOT_BY_MJCF = ("gravity", "end stop moved", "fmu unstable")
"""Sabotages that a file of bodies here does not have."""
NOT_BY_FMU = ("load stuck", "load uncoupled", "coupling soft", "cooling weak")
"""Sabotages that a load as an FMU does not have, which is one from the beginning to the end; one that diverges turns a motor so fast that
the steps of its thermal model have no end."""


@dataclass(frozen=True)
class Drawn:
    """What families are drawn from."""

    programs: list[str]
    sabotages: list[str]
    pairs: int
    """Of each family."""
    lifts: list[str]
    """Requirements that a file may lift."""
    engines: tuple[str, ...]
    """Those that the program has; rapier stands in for others."""
    is_coarse: bool = False
    """Whether encoders are anything from 256 lines to 2^24 counts, and windows as narrow as they allow."""
    is_smooth: bool = False
    """Whether axes have next to no friction, and nothing pulls at them."""

    @property
    def is_supervised(self) -> bool:
        """Whether drives watch their motors, where they can tell over a bus what they find."""
        return self.is_coarse or self.is_smooth


def draw_family(seed: str, drawn: Drawn) -> Family:
    """The family of a seed."""
    random = Random(f"twin {seed}")
    # Programs in turn, and for each of them sabotages in turn.
    turn, at = divmod(int(seed.rpartition("-")[2]), len(drawn.programs))
    program = drawn.programs[at]
    names = possible(program, drawn.sabotages)
    wanted = [names[(turn * drawn.pairs + number) % len(names)] for number in range(drawn.pairs)] if names else []
    while True:
        axis, task, window, is_mjcf = draw_machine(random, program, wanted, drawn)
        # Its encoder and its motor came last, and belong to its loop.
        if has_margins(axis):
            break
    if "shaken" in wanted:
        # It rests long enough to see that a swing stays, and its window is small beside one.
        task.length += SHAKEN / axis.position_gain
        window = max(20 * axis.grain, task.span * random.decades(-4.3, -3.3))
    if program == "pp":
        # The drive takes the next target when it has reached the one before.
        unit = unit_of(task.span) * (1.0 if axis.linear_axis else pi / 180)
        axis = replace(axis, objects={"6067h": max(10, round((window or 1e-3 * task.span) / unit))})
    if drawn.is_supervised and task.is_bus and axis.pmsm is not None:
        axis = supervised(axis, task)
    duration = round(task.length + random.uniform(0.02, 0.3), 4)
    tables = task.tables | ({"measure": {"window": quantity(window, axis.unit)}} if window else {})
    engine = random.choice(FOREIGN if is_mjcf else ENGINES)
    if engine not in drawn.engines:
        engine = "rapier"
    if is_mjcf:
        axis = replace(axis, motor=replace(axis.motor, bias=0.0))
        axis = replace(axis, estimate=estimate(axis))
    twin = Twin(axis, task, tables, duration)
    tolerance = Tolerance(window, task.span, axis.r * (axis.increment or 0.0), axis.r * axis.noise, droop(axis))
    family = Family(seed, program, twin, engine, tolerance, settling(axis, task), is_mjcf, drawn.is_coarse)
    number = 0
    while len(family.pairs) < drawn.pairs and number < 20 * drawn.pairs:
        # A seed for each. In place of one that the machine cannot have comes any.
        of_pair = Random(f"pair {seed} {number}")
        if not names:
            break
        name = wanted[number] if number < len(wanted) else of_pair.choice(names)
        change = (SABOTAGES | CABLES)[name](of_pair, twin)
        if change is not None and not (is_mjcf and name in NOT_BY_MJCF):
            family.pairs.append(Pair(f"{seed}.{number}", name, change, draw_judge(of_pair, twin, drawn.lifts)))
        number += 1
    return family


TRIES = 60


def draw_machine(random: Random, program: str, wanted: list[str], drawn: Drawn) -> tuple[Axis, Task, float | None, bool]:
    """An axis with its task and window; whether its bodies are a file of their own."""
    axis = draw_stable(random, wanted, program)
    if drawn.is_smooth:
        axis = smooth(axis)
    is_mjcf = mjcf.can_be(axis) and not set(wanted) & set(NOT_BY_MJCF) and random.random() < 0.5
    if not is_mjcf and fmu.can_be(axis) and not set(wanted) & set(NOT_BY_FMU) and ("fmu unstable" in wanted or random.random() < 0.2):
        axis = with_fmu(random, axis)
    # A master that feeds forward does so by its own keys.
    forward = feedforward(random) if program in (*DIRECT, "pp", "ip") else {}
    pace = draw_pace(random, axis, follows=bool(forward))
    task = PROGRAMS[program](random, axis, pace)
    axis, window = with_task(random, axis, task, forward, drawn)
    return axis, task, window, is_mjcf


def smooth(axis: Axis) -> Axis:
    """The axis with a hundredth of its friction."""
    load = axis.load and replace(axis.load, viscous=0.01 * axis.load.viscous)
    return replace(axis, motor=replace(axis.motor, viscous=0.01 * axis.motor.viscous), load=load)


def supervised(axis: Axis, task: Task) -> Axis:
    """The axis with a drive that watches its motor, by what an engineer knows of it: top speed and largest current."""
    top, most = task.velocity / axis.r, axis.limit / axis.pmsm.believed
    table: Tree = {
        "overspeed": quantity(2 * top, "rad/s"),
        "overcurrent": quantity(2 * most, "Apk"),
        "commutation": {"speed": quantity(0.2 * top, "rad/s"), "current": quantity(0.25 * most, "Apk")},
        "stall": {"speed": quantity(0.01 * top, "rad/s"), "time": "0.1 s"},
        "phase_loss": {"current": quantity(0.1 * most, "Apk"), "time": "20 ms"},
    }
    if "motor.thermal" in axis.pmsm.extras:
        table["winding_temperature"] = quantity(HOTTEST, "degC")
    return with_extra(axis, {"drive.supervision": table})


def with_fmu(random: Random, axis: Axis) -> Axis:
    """The axis with an FMU for its load: soft enough for a force that is a tick late, and damped. As it was where that has no margins."""
    load = replace(axis.load, viscous=0.0)
    reduced = 1 / (1 / load.inertia + axis.r**2 / axis.motor.inertia)
    omega = min((axis.stiffness / reduced) ** 0.5, 0.04 * axis.base)
    damping = 2 * random.decades(-1.1, -0.7) * reduced * omega
    soft = replace(axis, load=load, stiffness=reduced * omega**2, damping=damping, is_fmu=True)
    return soft if has_margins(with_motor(random, soft, 0.1 * axis.r, 1.0) if axis.pmsm else soft) else axis


def draw_stable(random: Random, wanted: list[str], program: str) -> Axis:
    """An axis with margins, that can have the sabotages that are wanted if one is found."""
    tries = 0
    while True:
        axis = draw_axis(random)
        tries += 1
        # A torque that is held shows the constant of a motor, and of an ideal source nothing.
        is_seen = program != "torque" or "torque constant" not in wanted or axis.pmsm is not None
        if tries < TRIES and not (is_seen and all(PARTS[name](axis) for name in wanted if name in PARTS)):
            continue
        # Nothing that is drawn later changes its loop but the motor, whose resistance and inductance hardly do.
        probe = with_motor(random, axis, 0.1 * axis.r, 1.0) if axis.pmsm else axis
        if has_margins(probe):
            return axis


def draw_judge(random: Random, twin: Twin, lifts: list[str]) -> Judge | None:
    """Now and then something that would make a verdict look away: a wide window, a late look, few rows, a requirement that is lifted."""
    kind = random.choice(("window", "from", "rate", "lift", "longer")) if random.random() < 0.2 else None
    measure = dict(twin.tables.get("measure", {}))
    match kind:
        case "lift" if not lifts:
            return None
        case "window":
            window = twin.task.span * random.decades(-2, 0)
            return Judge({"measure": measure | {"window": quantity(window, twin.axis.unit)}}, window=window, note=f"window {window:.3g}")
        case "from":
            return Judge({"measure": measure | {"from": quantity(0.95 * twin.duration, "s")}}, note="measured from the end")
        case "longer" if twin.task.name != "torque":
            times = random.decades(0, 0.6)
            return Judge(longer=times, note=f"{times:.3g} times as long")
        case "rate":
            return Judge({"record": {"rate": f"{twin.axis.base // 400} Hz"}}, note="few rows")
        case "lift":
            name = random.choice(lifts)
            return Judge({"requirements": {name: False}}, lifted=name, note=f"{name} lifted")
    return None


def with_task(random: Random, axis: Axis, task: Task, forward: Tree, drawn: Drawn) -> tuple[Axis, float | None]:
    """The axis with everything that depends on its task: gravity, friction, encoder, motor; and the window."""
    bare = axis.total * task.acceleration / axis.r
    motor = axis.motor
    # A torque is not held against them.
    is_free = task.name == "torque" or drawn.is_smooth
    if not is_free and random.random() < 0.4:
        motor = replace(motor, coulomb=bare * random.decades(-2, -0.5))
    if not is_free and (random.random() < 0.4 or task.name.startswith("hold")):
        bias = bare * random.decades(-1, -0.2)
        if task.is_bus:
            # Without power it would sag, and the link would lead it back: friction holds it.
            motor = replace(motor, coulomb=1.25 * bias)
        motor = replace(motor, bias=random.sign() * bias)
    axis = replace(axis, motor=motor, feedforward=forward, objects=task.objects, switches=task.switches)
    increment = None if random.random() < 0.3 else task.span * random.decades(-6.5, -4)
    if drawn.is_coarse:
        # Counts of a revolution; of a linear motor of 20 mm.
        turn = (2 * pi if axis.rotary_motor else 0.02) * axis.r
        increment = turn * 10 ** random.uniform(-7.2, max(-7.1, min(-3.1, log10(coarsest(axis, task) / turn))))
    noise = increment is not None and random.random() < 0.2
    if increment is not None:
        axis = replace(axis, increment=increment_of(axis, increment / axis.r), noise=increment * random.uniform(0.2, 2) / axis.r if noise else 0.0)
    if not drawn.is_coarse and axis.increment is not None:
        # What the edges and the noise make of the effort stays below a tenth of what there is.
        edge = axis.velocity_gain * (axis.increment + 2 * axis.noise) * axis.base / axis.velocity_every
        finer = min(1.0, 0.1 * axis.effort(task.velocity, task.acceleration) / edge)
        axis = replace(axis, increment=increment_of(axis, finer * axis.increment), noise=finer * axis.noise)
    axis = replace(axis, seed=random.randint(1, 1000))
    axis = with_motor(random, axis, task.velocity, axis.effort(task.velocity, task.acceleration))
    if axis.pmsm is not None and not axis.is_fmu:
        axis = replace(axis, pmsm=replace(axis.pmsm, extras={"motor.thermal": thermal(axis.pmsm, axis.effort(task.velocity, task.acceleration), task.length)}))
    if task.name.startswith("hold") and random.random() < 0.7:
        # Something that it has to stand against.
        effort = random.sign() * axis.effort(task.velocity, task.acceleration) * random.uniform(0.3, 0.7)
        step = {"on": "motor", "start": quantity(round(random.uniform(0.5, 0.6) * task.length, 4), "s"), "duration": "1000 s"}
        task.tables["disturbance"] = [step | {"torque" if axis.rotary_motor else "force": quantity(effort, axis.effort_unit)}]
    if drawn.is_coarse:
        return axis, max(10 * axis.grain, 10 * unit_of(task.span), task.span * random.decades(-4.5, -2))
    window = None if random.random() < 0.25 else max(20 * axis.grain, task.span * random.decades(-4, -2))
    return axis, window


def coarsest(axis: Axis, task: Task) -> float:
    """The increment (axis unit) of which one in a tick of the velocity loop, and its noise of up to two increments at most, asks for as much
    effort as there is. Beyond it, a loop is a relay: it is cut off more in one direction than in the other, moves 4 to 9 % slower or
    faster than it is told, and swings by tens of increments; with a finer encoder each of 44 such machines does its task. An engineer
    would filter the velocity, or set the gain lower, so these are no healthy machines."""
    tick = axis.velocity_every / axis.base
    most = LEAST_TORQUE * axis.effort(task.velocity, task.acceleration)
    return axis.r * most * (tick + axis.filter_time) / axis.velocity_gain / 3


AMBIENT, HOTTEST = 40.0, 120.0
"""Temperatures (°C) of the surroundings, and that the winding bears."""


def thermal(motor: Pmsm, effort: float, length: float) -> Tree:
    """`[motor.thermal]` of a motor that is small for its task: in its time the losses of the effort that is needed warm it by some 50 K at
    most."""
    loss = 1.5 * motor.resistance * (effort / motor.constant) ** 2
    capacity = loss * length / 50
    table = {"ambient": quantity(AMBIENT, "degC"), "limit": quantity(HOTTEST, "degC")}
    table |= {"to_housing": quantity(30 / loss, "K/W"), "to_ambient": quantity(15 / loss, "K/W")}
    return table | {"winding_capacity": quantity(capacity, "J/K"), "housing_capacity": quantity(20 * capacity, "J/K")}


def droop(axis: Axis) -> float:
    """By how much friction and bias displace a load whose velocity loop has no integral (axis unit)."""
    if axis.integral_time is not None:
        return 0.0
    return axis.r * (axis.friction() + abs(axis.bias())) / (axis.velocity_gain * axis.position_gain)


def settling(axis: Axis, task: Task) -> Settling:
    """By the slowest time constants that its gains make."""
    slow = 2 / axis.position_gain if axis.integral_time is None else max(2 / axis.position_gain, 2 * axis.integral_time)
    steps = tuple(float(one["start"].removesuffix(" s")) for one in task.tables.get("disturbance", []))
    return Settling(rest=max(8 / axis.position_gain, 5 * axis.integral_time if axis.integral_time else 0.0), stand=5 * slow, velocity=2.5 * slow, steps=steps)


def tree(family: Family, axis: Axis, tables: Tree | None = None, longer: float = 1.0) -> Tree:
    """The scenario of a machine that does the task of the family."""
    whole = axis.tables() | family.twin.tables | (tables or {}) | (fmu.tables(axis) if axis.is_fmu else {})
    whole["run"] = whole["run"] | {"duration": quantity(longer * family.twin.duration, "s")}
    return whole


def put(path: Path, family: Family, axis: Axis, whole: Tree, note: str = "") -> None:
    """Writes a scenario, and beside it the bodies where they are a file of their own."""
    if family.is_mjcf:
        xml = path.with_suffix(".xml")
        xml.write_text(mjcf.text(axis))
        whole = whole | {"axis": mjcf.table(axis, xml.name) | ({"switches": axis.switches} if axis.switches else {})}
    path.write_text((f"# {note}\n" if note else "") + toml(whole))


def refined(axis: Axis) -> Axis:
    """The same with an encoder without noise that is a thousand times finer, or as fine as a file can have it."""
    if axis.increment is None:
        return replace(axis, noise=0.0)
    finest = 2 * pi / 4e9 if axis.rotary_motor else 1e-9
    return replace(axis, increment=increment_of(axis, max(1e-3 * axis.increment, finest)), noise=0.0)


def sisters(family: Family) -> list[Axis]:
    """The healthy machine with another seed, and with a mass that is next to the same."""
    axis = family.twin.axis
    heavier = replace(axis, motor=replace(axis.motor, inertia=NEARLY_THE_SAME * axis.motor.inertia))
    return [replace(axis, seed=axis.seed + 1000), heavier]


def write(folder: Path, family: Family) -> list[dict[str, Any]]:
    """Writes the scenarios of a family; the jobs that run them."""
    folder.mkdir(parents=True, exist_ok=True)
    for name, text in family.twin.task.files.items():
        (folder / name).write_text(text)
    if family.twin.axis.is_fmu:
        shutil.copy(folder.parent / fmu.FILE, folder)
    jobs = []

    def job(name: str, axis: Axis, change: Change | None = None, judge: Judge | None = None) -> None:
        file = folder / f"{name}.toml"
        tables, longer = change.tables if change else None, judge.longer if judge else 1.0
        put(file, family, axis, tree(family, axis, tables, longer), f"{change.note} {change.hooks or ''}" if change else "")
        one = {"id": f"{family.name}/{name}", "run": str(file), "judge": str(folder / "healthy.toml"), "engine": family.engine}
        one |= {"rows": str(folder / f"{name}.f64"), "channels": channels(family), "every": every(family)}
        if change is not None and change.then is not None:
            then = folder / f"{name}-then.toml"
            put(then, family, change.then, tree(family, change.then, tables, longer), f"from {change.at} s on")
            one |= {"then": str(then), "at": change.at}
        if change is not None and change.hooks:
            one["sabotage"] = change.hooks
        if judge is not None:
            by = folder / f"{name}-judge.toml"
            put(by, family, family.twin.axis, tree(family, family.twin.axis, judge.tables, longer), judge.note)
            one["judge"] = str(by)
        jobs.append(one)

    job("healthy", family.twin.axis)
    for number, axis in enumerate(sisters(family)):
        job(f"sister-{number}", axis)
    if family.is_alone:
        job("refined", refined(family.twin.axis))
    for pair in family.pairs:
        job(pair.name, pair.change.axis, pair.change, pair.judge)
    return jobs


def write_longer(folder: Path, family: Family, pair: Pair) -> dict[str, Any]:
    """A run of a sabotaged machine that is four times as long, with a push at the end of its task; the job."""
    axis, duration = pair.change.axis, family.twin.duration
    name, effort = f"{pair.name}-longer", "torque" if axis.rotary_motor else "force"
    push = {"on": "motor", "start": quantity(duration, "s"), "duration": "2 ms", effort: quantity(0.2 * axis.limit, axis.effort_unit)}
    whole = tree(family, axis, pair.change.tables)
    whole["disturbance"] = [*whole.get("disturbance", []), push]
    whole["run"] = whole["run"] | {"duration": quantity(4 * duration, "s")}
    put(folder / f"{name}.toml", family, axis, whole)
    job = {"id": f"{family.name}/{name}", "run": str(folder / f"{name}.toml"), "engine": family.engine, "rows": str(folder / f"{name}.f64")}
    job |= {"channels": channels(family), "every": every(family), "sabotage": pair.change.hooks}
    if pair.change.then is not None:
        job |= {"then": str(folder / f"{pair.name}-then.toml"), "at": pair.change.at}
    return job


def channels(family: Family) -> list[str]:
    bus = ["bus.position"] if family.twin.task.is_bus else []
    motor = family.twin.axis.pmsm
    warm = ["temperature.winding"] if motor is not None and "motor.thermal" in motor.extras else []
    voltages = ["voltage.q"] if motor is not None else []
    return ["load.position", "motor.position", "reference.position", "setpoint.position", "effort.motor", *bus, *warm, *voltages]


def every(family: Family) -> int:
    """Of so many ticks one row: about two in a millisecond."""
    return max(1, family.twin.axis.base // 2000)
