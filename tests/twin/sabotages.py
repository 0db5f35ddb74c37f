"""Sabotages: what is wrong with the other twin.

Each is a function of the healthy machine. It changes the plant or a sensor, or says what no file can, with a severity that is
log-uniform over two decades. `None` where the machine has no such part.
"""

from collections.abc import Callable
from dataclasses import dataclass, field, replace
from typing import Any

from draws import Random

from machine import Axis
from task import Task


@dataclass
class Change:
    """What is changed."""

    axis: Axis
    """The machine from the first instant on."""
    then: Axis | None = None
    """Its mechanics from the time `at` on."""
    at: float = 0.0
    hooks: list[dict[str, Any]] = field(default_factory=list)
    tables: dict[str, Any] = field(default_factory=dict)
    """Tables of the scenario that are others."""
    note: str = ""
    harms: bool = False
    """Whether it is a harm by itself, so that a red verdict is never wrong."""
    stops: tuple[float, float] | None = None
    """Where stops are that the healthy machine does not have."""


@dataclass(frozen=True)
class Twin:
    """The healthy machine and its task."""

    axis: Axis
    task: Task
    tables: dict[str, Any]
    duration: float

    def when(self, random: Random) -> float:
        """Some time of its program, or the beginning."""
        return 0.0 if random.random() < 0.4 else round(random.uniform(0.0, 0.9) * self.task.length, 3)

    def on_the_way(self, random: Random) -> float:
        """Some time of its program, while something is asked for."""
        return round(random.uniform(0.1, 0.8) * self.task.length, 3)

    @property
    def needed(self) -> float:
        """The effort that the task takes."""
        return self.axis.effort(self.task.velocity, self.task.acceleration)


def torque_constant(random: Random, twin: Twin) -> Change | None:
    factor, at = random.decades(-2, 0), twin.when(random)
    motor = twin.axis.pmsm
    if motor is not None:
        weak = replace(motor, constant=factor * motor.constant)
        return Change(replace(twin.axis, pmsm=weak), note=f"{factor:.3g} of the flux linkage")
    if twin.task.name == "torque":
        # Of an ideal source nobody sees what becomes of its effort.
        return None
    return Change(twin.axis, hooks=[{"kind": "effort", "at": at, "factor": factor}], note=f"{factor:.3g} of the effort from {at} s")


def torque_limit(random: Random, twin: Twin) -> Change:
    share, at = random.decades(-1.6, 0.4), twin.when(random)
    if twin.task.name == "torque":
        return Change(replace(twin.axis, limit=0.3 * share * twin.axis.limit), note=f"{0.3 * share:.3g} of the limit")
    hook = {"kind": "effort-limit", "at": at, "most": share * twin.needed}
    return Change(twin.axis, hooks=[hook], note=f"at most {share:.3g} of the effort that is needed from {at} s")


def motor_stuck(random: Random, twin: Twin) -> Change:
    at = round(random.uniform(0, twin.duration), 4)
    return Change(twin.axis, hooks=[{"kind": "stuck", "at": at}], note=f"stuck from {at} s")


def power_lost(random: Random, twin: Twin) -> Change | None:
    if twin.task.name == "torque":
        return None
    at = round(random.uniform(0, twin.duration), 4)
    hook = {"kind": "effort", "at": at, "factor": 0.0}
    return Change(twin.axis, hooks=[hook], note=f"no effort from {at} s", harms=True)


def load_stuck(random: Random, twin: Twin) -> Change | None:
    axis, load = twin.axis, twin.axis.load
    if load is None or axis.is_fmu:
        return None
    at, size = twin.when(random), random.decades(-0.5, 1.5)
    stuck = replace(axis, load=replace(load, coulomb=load.coulomb + size * twin.needed / axis.r))
    return Change(axis, then=stuck, at=at, note=f"friction of {size:.3g} of the effort that is needed on the load from {at} s")


def uncoupled(random: Random, twin: Twin) -> Change | None:
    axis = twin.axis
    if axis.load is None or axis.is_fmu:
        return None
    at, factor = twin.when(random), random.decades(-8, -6)
    loose = replace(axis, stiffness=factor * axis.stiffness, damping=factor * axis.damping)
    return Change(axis, then=loose, at=at, note=f"{factor:.3g} of the stiffness from {at} s")


def coupling_soft(random: Random, twin: Twin) -> Change | None:
    axis = twin.axis
    if axis.load is None or axis.is_fmu:
        return None
    at, factor = twin.when(random), random.decades(-5, -3)
    loose = replace(axis, stiffness=factor * axis.stiffness, damping=factor**0.5 * axis.damping)
    return Change(axis, then=loose, at=at, note=f"{factor:.3g} of the stiffness from {at} s")


def friction(random: Random, twin: Twin) -> Change:
    axis = twin.axis
    at, size = twin.when(random), random.decades(-0.9, 1.1)
    rough = replace(axis, motor=replace(axis.motor, coulomb=axis.motor.coulomb + size * axis.limit))
    return Change(axis, then=rough, at=at, note=f"{size:.3g} of the limit more friction from {at} s")


def gravity(random: Random, twin: Twin) -> Change:
    axis = twin.axis
    at, size = twin.when(random), random.decades(-1.2, 0.8)
    pulled = replace(axis, motor=replace(axis.motor, bias=axis.motor.bias + random.sign() * size * axis.limit))
    return Change(axis, then=pulled, at=at, note=f"{size:.3g} of the limit more bias from {at} s")


def payload(random: Random, twin: Twin) -> Change:
    axis = twin.axis
    at, factor = 0.0 if axis.is_fmu else twin.when(random), random.decades(0, 2)
    if axis.load is not None:
        heavy = replace(axis, load=replace(axis.load, inertia=factor * axis.load.inertia))
    else:
        heavy = replace(axis, motor=replace(axis.motor, inertia=factor * axis.motor.inertia))
    if at == 0.0:
        return Change(heavy, note=f"{factor:.3g} of the mass")
    return Change(axis, then=heavy, at=at, note=f"{factor:.3g} of the mass from {at} s")


def velocity_gain(random: Random, twin: Twin) -> Change:
    factor = random.decades(0.8, 2.8) ** random.sign()
    axis = replace(twin.axis, velocity_gain=factor * twin.axis.velocity_gain)
    return Change(axis, note=f"velocity gain times {factor:.3g}")


def position_gain(random: Random, twin: Twin) -> Change:
    factor = random.decades(1.3, 3.3) ** random.sign()
    axis = replace(twin.axis, position_gain=factor * twin.axis.position_gain)
    return Change(axis, note=f"position gain times {factor:.3g}")


def current_gain(random: Random, twin: Twin) -> Change | None:
    motor = twin.axis.pmsm
    if motor is None:
        return None
    factor = random.decades(0.3, 2.3) ** random.sign()
    if twin.axis.feedforward or twin.tables.get("bus", {}).get("velocity_offset"):
        # The delay of a feedforward that waits for the current loop has a bound.
        factor = max(factor, 0.7)
    axis = replace(twin.axis, pmsm=replace(motor, bandwidth=factor * motor.bandwidth))
    return Change(axis, note=f"bandwidth of the current loop times {factor:.3g}")


def encoder_frozen(random: Random, twin: Twin) -> Change:
    at = round(random.uniform(0, twin.duration), 4)
    return Change(twin.axis, hooks=[{"kind": "encoder-frozen", "at": at}], note=f"encoder frozen from {at} s")


def encoder_scaled(random: Random, twin: Twin) -> Change:
    at, factor = twin.when(random), 1 + random.sign() * random.decades(-2.3, -0.3)
    hook = {"kind": "encoder-scaled", "at": at, "factor": factor}
    return Change(twin.axis, hooks=[hook], note=f"encoder counts {factor:.4g} for one from {at} s")


def encoder_reversed(random: Random, twin: Twin) -> Change:
    at = round(random.uniform(0.3, 1) * twin.duration, 4)
    hook = {"kind": "encoder-scaled", "at": at, "factor": -1.0}
    return Change(twin.axis, hooks=[hook], note=f"encoder reversed from {at} s")


def encoder_late(random: Random, twin: Twin) -> Change:
    at, late = twin.when(random), random.decades(-2.7, -0.7)
    hook = {"kind": "encoder-late", "at": at, "by": late}
    return Change(twin.axis, hooks=[hook], note=f"encoder {late:.3g} s late from {at} s")


def encoder_noisy(random: Random, twin: Twin) -> Change:
    noise = twin.task.span / twin.axis.r * random.decades(-4.5, -2.5)
    return Change(replace(twin.axis, noise=noise), note=f"noise of {noise:.3g}")


def commutation(random: Random, twin: Twin) -> Change | None:
    if twin.axis.pmsm is None:
        return None
    angle = random.sign() * random.decades(1.3, 2.255)
    return Change(replace(twin.axis, commutation=angle), note=f"commutation off by {angle:.4g} degrees")


def commutation_off(random: Random, twin: Twin) -> Change | None:
    """Anywhere round the turn, not near zero alone."""
    if twin.axis.pmsm is None:
        return None
    angle = random.sign() * random.uniform(10, 180)
    return Change(replace(twin.axis, commutation=angle), note=f"commutation off by {angle:.4g} degrees")


def cable_swapped(random: Random, twin: Twin) -> Change | None:
    if twin.axis.pmsm is None:
        return None
    legs = random.choice(("ab", "bc", "ca"))
    return Change(with_extra(twin.axis, {"motor.connection": {"swapped": legs}}), note=f"legs {legs} swapped")


def with_extra(axis: Axis, extras: dict[str, Any]) -> Axis:
    assert axis.pmsm is not None
    return replace(axis, pmsm=replace(axis.pmsm, extras=axis.pmsm.extras | extras))


def phase_lost(random: Random, twin: Twin) -> Change | None:
    if twin.axis.pmsm is None:
        return None
    at = round(random.uniform(0, twin.task.length), 4)
    lost = {"open": random.choice("abc"), "open_at": f"{at} s"}
    return Change(with_extra(twin.axis, {"motor.connection": lost}), note=f"phase lost at {at} s")


def link_sag(random: Random, twin: Twin) -> Change | None:
    motor = twin.axis.pmsm
    if motor is None:
        return None
    at, depth = round(random.uniform(0, 0.5) * twin.task.length, 4), 1 - random.decades(-3, -1)
    length = round(random.decades(-0.7, 1) * twin.task.length, 4)
    link = {"capacitance": "470 uF", "source_resistance": f"{0.02 * motor.dc_link / 10} Ohm"}
    link["sag"] = {"start": f"{at} s", "duration": f"{length} s", "depth": depth}
    return Change(with_extra(twin.axis, {"drive.link": link}), note=f"link down by {depth:.3g} from {at} s for {length} s")


def dead_time(random: Random, twin: Twin) -> Change | None:
    if twin.axis.pmsm is None:
        return None
    rate = twin.axis.base // twin.axis.current_every
    share = random.decades(-3, -1.001)
    inverter = {"carrier": f"{rate} Hz", "dead_time": f"{share / rate} s"}
    return Change(with_extra(twin.axis, {"drive.inverter": inverter}), note=f"dead time of {share:.3g} of the period")


def gear_ratio(random: Random, twin: Twin) -> Change | None:
    axis = twin.axis
    if axis.lead is None:
        return None
    factor = 1 + random.sign() * random.decades(-2.3, -0.3)
    return Change(replace(axis, lead=factor * axis.lead), note=f"lead times {factor:.4g}")


def end_stop_moved(random: Random, twin: Twin) -> Change | None:
    axis, task = twin.axis, twin.task
    size = max((abs(phase.target) for phase in task.phases if phase.kind == "way"), default=0.0)
    if size == 0.0:
        return None
    # Behind the farthest target, or before it.
    away = random.decades(-2.5, -0.1)
    at = size * (1 + away if random.random() < 0.35 else 1 - away)
    mass = axis.load.inertia if axis.load else axis.motor.inertia / axis.r**2
    # In it for some dozen ticks.
    stiffness = mass * (axis.base / 30) ** 2
    damping = 0.3 * mass * axis.base / 30
    unit = axis.unit
    per = "N/m" if axis.linear_axis else "Nm/rad"
    loss = "N s/m" if axis.linear_axis else "Nm s/rad"
    stops = {"negative": f"{-at} {unit}", "positive": f"{at} {unit}", "stiffness": f"{stiffness} {per}", "damping": f"{damping} {loss}"}
    return Change(replace(axis, stops=stops), note=f"end stops at {at:.4g} of {size:.4g}", stops=(-at, at))


def bus_of(twin: Twin, **keys: Any) -> dict[str, Any] | None:
    """The tables of its bus with other keys."""
    return {"bus": twin.tables["bus"] | keys} if "bus" in twin.tables else None


def frames_lost(random: Random, twin: Twin) -> Change | None:
    at, cycles = twin.on_the_way(random), round(random.decades(0.7, 2.7))
    tables = bus_of(twin, fault=[{"kind": "lost", "start": f"{at} s", "cycles": cycles}])
    return tables and Change(twin.axis, tables=tables, note=f"{cycles} frames lost from {at} s")


def frames_late(random: Random, twin: Twin) -> Change | None:
    at, ticks = twin.on_the_way(random), max(1, round(random.decades(-2.5, -0.5) * twin.axis.base))
    tables = bus_of(twin, fault=[{"kind": "late", "start": f"{at} s", "duration": "1000 s", "by": f"{ticks / twin.axis.base * 1e6} us"}])
    return tables and Change(twin.axis, tables=tables, note=f"frames {ticks} ticks late from {at} s")


def frames_frozen(random: Random, twin: Twin) -> Change | None:
    """The values of the task are lost, so that the master has nothing new to send."""
    at, cycles = twin.on_the_way(random), round(random.decades(1.5, 3.5))
    tables = bus_of(twin, fault=[{"kind": "task-lost", "start": f"{at} s", "cycles": cycles}])
    return tables and Change(twin.axis, tables=tables, note=f"{cycles} frames frozen from {at} s")


def units_wrong(random: Random, twin: Twin) -> Change | None:
    """The gear ratio that the drive computes its units with (6091h) is not that of the machine."""
    whole = 9973
    turns = whole + random.sign() * round(whole * random.decades(-3.6, -0.5))
    objects = twin.axis.objects | {"6091h.1": round(turns), "6091h.2": whole}
    return Change(replace(twin.axis, objects=objects), note=f"units {turns / whole:.4f} times as long")


def master_gain(random: Random, twin: Twin) -> Change | None:
    if twin.tables.get("bus", {}).get("mode") != "csv":
        return None
    factor = random.decades(0, 2) ** random.sign()
    gain = factor * float(twin.tables["bus"]["position_gain"].removesuffix(" 1/s"))
    return Change(twin.axis, tables=bus_of(twin, position_gain=f"{gain} 1/s"), note=f"gain of the master times {factor:.3g}")


def fmu_unstable(random: Random, twin: Twin) -> Change | None:
    """A damping that drives: so many e-foldings in the run if nothing else damped the load on its spring. More of them are beyond all
    numbers, and what that costs is for other tests."""
    axis = twin.axis
    if not axis.is_fmu:
        return None
    foldings = random.decades(1.4, 2.4)
    damping = -2 * axis.load.inertia * foldings / twin.duration
    return Change(replace(axis, damping=damping), note=f"{foldings:.3g} e-foldings by the damping of the FMU")


SHAKEN = 50
"""So many time constants of the position loop a machine that is to be shaken rests longer."""


def shaken(random: Random, twin: Twin) -> Change | None:
    """A force that goes to and fro in the last rest of a task, far below what there is."""
    axis, task = twin.axis, twin.task
    rest = next((phase for phase in reversed(task.phases) if phase.kind == "rest"), None)
    if rest is None or axis.integral_time is None:
        return None
    effort, frequency = random.decades(-1.1, 0.7) * twin.needed, random.uniform(0.3, 0.6) * axis.position_gain
    start = twin.duration - 0.9 * SHAKEN / axis.position_gain
    disturbance = {"on": "motor", "start": f"{start} s", "duration": "1000 s", "frequency": f"{frequency} Hz"}
    disturbance["torque" if axis.rotary_motor else "force"] = f"{effort} {axis.effort_unit}"
    tables = {"disturbance": [*twin.tables.get("disturbance", []), disturbance]}
    return Change(axis, tables=tables, note=f"shaken by {effort / twin.needed:.3g} of the effort that is needed with {frequency:.4g} Hz")


def cooling_weak(random: Random, twin: Twin) -> Change | None:
    motor = twin.axis.pmsm
    if motor is None or "motor.thermal" not in motor.extras:
        return None
    factor, thermal = random.decades(0.3, 2.3), dict(motor.extras["motor.thermal"])
    for key, by in {"to_housing": factor, "to_ambient": factor, "winding_capacity": 1 / factor, "housing_capacity": 1 / factor}.items():
        value, unit = thermal[key].split()
        thermal[key] = f"{by * float(value)} {unit}"
    return Change(with_extra(twin.axis, {"motor.thermal": thermal}), note=f"{factor:.3g} times warmer")


def switch_wrong(random: Random, twin: Twin) -> Change | None:
    """A home switch that closes where it should open, is not connected, or sits elsewhere; the last the machine may not notice."""
    home = twin.task.switches.get("home")
    if home is None:
        return None
    low, high = (float(home[key].split()[0]) for key in ("from", "to"))
    edge, away = (low, 1.0) if low > 0 else (high, -1.0)
    kind = random.choice(("inverted", "missing", "moved", "moved"))
    span = abs(high - low)
    match kind:
        case "inverted":
            ends = (edge, edge - away * 100 * twin.task.span)
        case "missing":
            ends = (1e3 * edge, 1e3 * edge + away * span)
        case _:
            edge *= random.decades(-1, 1)
            ends = (edge, edge + away * span)
    unit = twin.axis.unit
    switches = {"home": {"from": f"{min(ends)} {unit}", "to": f"{max(ends)} {unit}"}}
    return Change(replace(twin.axis, switches=switches), note=f"{edge:.4g} home switch {kind}")


SABOTAGES: dict[str, Callable[[Random, Twin], Change | None]] = {
    "torque constant": torque_constant,
    "torque limit": torque_limit,
    "motor stuck": motor_stuck,
    "power lost": power_lost,
    "load stuck": load_stuck,
    "load uncoupled": uncoupled,
    "coupling soft": coupling_soft,
    "friction": friction,
    "gravity": gravity,
    "payload": payload,
    "velocity gain": velocity_gain,
    "position gain": position_gain,
    "current gain": current_gain,
    "encoder frozen": encoder_frozen,
    "encoder scaled": encoder_scaled,
    "encoder reversed": encoder_reversed,
    "encoder late": encoder_late,
    "encoder noisy": encoder_noisy,
    "commutation": commutation,
    "cooling weak": cooling_weak,
    "phase lost": phase_lost,
    "link sag": link_sag,
    "dead time": dead_time,
    "gear ratio": gear_ratio,
    "end stop moved": end_stop_moved,
    "frames lost": frames_lost,
    "frames late": frames_late,
    "frames frozen": frames_frozen,
    "units wrong": units_wrong,
    "master gain": master_gain,
    "fmu unstable": fmu_unstable,
    "shaken": shaken,
    "switch wrong": switch_wrong,
}

CABLES: dict[str, Callable[[Random, Twin], Change | None]] = {"cable swapped": cable_swapped, "commutation off": commutation_off}
"""Mistakes of commissioning, for a drill of their own."""

PARTS: dict[str, Callable[[Axis], bool]] = {
    **dict.fromkeys((*CABLES, "current gain", "commutation", "phase lost", "link sag", "dead time", "cooling weak"), lambda axis: axis.pmsm is not None),
    **dict.fromkeys(("load stuck", "load uncoupled", "coupling soft"), lambda axis: axis.load is not None),
    "fmu unstable": lambda axis: axis.load is not None and not axis.from_load,
    "gear ratio": lambda axis: axis.lead is not None,
    "shaken": lambda axis: axis.integral_time is not None,
}
"""Parts of an axis without which there is no such sabotage. Those that exclude each other stand apart in the list: neighbours are wanted of
one machine."""

BUSES = ("csp", "csv", "pp", "ip", "blocks", "velocity", "stop", "hold over a bus", "torque", "homing")
WAYS = ("moves", "sequences", "table", "velocity, direct", "csp", "csv", "pp", "ip", "blocks", "homing")
OF_PROGRAMS: dict[str, tuple[str, ...]] = {
    **dict.fromkeys(("frames lost", "frames late"), BUSES),
    # The drive makes the way in the others, and what stands is sent the same all the time.
    "frames frozen": ("csp", "csv", "pp", "ip", "blocks", "velocity", "stop", "torque"),
    "units wrong": tuple(bus for bus in BUSES if bus not in ("torque", "hold over a bus")),
    "master gain": ("csv",),
    "switch wrong": ("homing",),
    "end stop moved": WAYS,
    "shaken": WAYS,
}
"""Programs in which there are such sabotages; of the others all."""

WITHOUT: dict[str, tuple[str, ...]] = {
    # The loops of position and velocity are open, and so are the encoders for them.
    "torque": ("position gain", "velocity gain", "power lost", *(f"encoder {kind}" for kind in ("frozen", "scaled", "reversed", "late", "noisy"))),
    # The master closes the loop of position.
    "csv": ("position gain",),
}
"""Sabotages that do nothing in a program."""


def possible(program: str, names: list[str]) -> list[str]:
    """Those of a list that a program can have."""
    return [name for name in names if program in OF_PROGRAMS.get(name, (program,)) and name not in WITHOUT.get(program, ())]
