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
    if load is None:
        return None
    at, size = twin.when(random), random.decades(-0.5, 1.5)
    stuck = replace(axis, load=replace(load, coulomb=load.coulomb + size * twin.needed / axis.r))
    return Change(axis, then=stuck, at=at, note=f"friction of {size:.3g} of the effort that is needed on the load from {at} s")


def uncoupled(random: Random, twin: Twin) -> Change | None:
    axis = twin.axis
    if axis.load is None:
        return None
    at, factor = twin.when(random), random.decades(-8, -6)
    loose = replace(axis, stiffness=factor * axis.stiffness, damping=factor * axis.damping)
    return Change(axis, then=loose, at=at, note=f"{factor:.3g} of the stiffness from {at} s")


def coupling_soft(random: Random, twin: Twin) -> Change | None:
    axis = twin.axis
    if axis.load is None:
        return None
    at, factor = twin.when(random), random.decades(-4, -2)
    loose = replace(axis, stiffness=factor * axis.stiffness, damping=factor**0.5 * axis.damping)
    return Change(axis, then=loose, at=at, note=f"{factor:.3g} of the stiffness from {at} s")


def friction(random: Random, twin: Twin) -> Change:
    axis = twin.axis
    at, size = twin.when(random), random.decades(-1.2, 0.8)
    rough = replace(axis, motor=replace(axis.motor, coulomb=axis.motor.coulomb + size * axis.limit))
    return Change(axis, then=rough, at=at, note=f"{size:.3g} of the limit more friction from {at} s")


def gravity(random: Random, twin: Twin) -> Change:
    axis = twin.axis
    at, size = twin.when(random), random.decades(-1.2, 0.8)
    pulled = replace(axis, motor=replace(axis.motor, bias=axis.motor.bias + random.sign() * size * axis.limit))
    return Change(axis, then=pulled, at=at, note=f"{size:.3g} of the limit more bias from {at} s")


def payload(random: Random, twin: Twin) -> Change:
    axis = twin.axis
    at, factor = twin.when(random), random.decades(0, 2)
    if axis.load is not None:
        heavy = replace(axis, load=replace(axis.load, inertia=factor * axis.load.inertia))
    else:
        heavy = replace(axis, motor=replace(axis.motor, inertia=factor * axis.motor.inertia))
    if at == 0.0:
        return Change(heavy, note=f"{factor:.3g} of the mass")
    return Change(axis, then=heavy, at=at, note=f"{factor:.3g} of the mass from {at} s")


def velocity_gain(random: Random, twin: Twin) -> Change:
    factor = random.decades(0.3, 2.3) ** random.sign()
    axis = replace(twin.axis, velocity_gain=factor * twin.axis.velocity_gain)
    return Change(axis, note=f"velocity gain times {factor:.3g}")


def position_gain(random: Random, twin: Twin) -> Change:
    factor = random.decades(0.7, 2.7) ** random.sign()
    axis = replace(twin.axis, position_gain=factor * twin.axis.position_gain)
    return Change(axis, note=f"position gain times {factor:.3g}")


def current_gain(random: Random, twin: Twin) -> Change | None:
    motor = twin.axis.pmsm
    if motor is None:
        return None
    factor = random.decades(0, 2) ** random.sign()
    if twin.axis.feedforward.get("effort"):
        # The delay of a feedforward that waits for the current loop has a bound.
        factor = max(factor, 0.3)
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
    at = twin.when(random)
    hook = {"kind": "encoder-scaled", "at": at, "factor": -1.0}
    return Change(twin.axis, hooks=[hook], note=f"encoder reversed from {at} s")


def encoder_late(random: Random, twin: Twin) -> Change:
    late = random.decades(-3.3, -2)
    return Change(replace(twin.axis, latency=late), note=f"encoder {late:.3g} s late")


def encoder_noisy(random: Random, twin: Twin) -> Change:
    noise = twin.task.span / twin.axis.r * random.decades(-4.5, -2.5)
    return Change(replace(twin.axis, noise=noise), note=f"noise of {noise:.3g}")


def commutation(random: Random, twin: Twin) -> Change | None:
    if twin.axis.pmsm is None:
        return None
    angle = random.sign() * min(180.0, random.decades(0.3, 2.3))
    return Change(replace(twin.axis, commutation=angle), note=f"commutation off by {angle:.4g} degrees")


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
    at, depth = round(random.uniform(0, 0.7) * twin.task.length, 4), 1 - random.decades(-2, 0)
    length = round(random.decades(-1, 1) * twin.task.length, 4)
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
    at = size * random.decades(-1, 0.2)
    mass = axis.load.inertia if axis.load else axis.motor.inertia / axis.r**2
    # In it for some dozen ticks.
    stiffness = mass * (axis.base / 30) ** 2
    damping = 0.3 * mass * axis.base / 30
    unit = axis.unit
    per = "N/m" if axis.linear_axis else "Nm/rad"
    loss = "N s/m" if axis.linear_axis else "Nm s/rad"
    stops = {"negative": f"{-at} {unit}", "positive": f"{at} {unit}", "stiffness": f"{stiffness} {per}", "damping": f"{damping} {loss}"}
    return Change(replace(axis, stops=stops), note=f"end stops at {at:.4g} of {size:.4g}", harms=True)


def bus_of(twin: Twin, **keys: Any) -> dict[str, Any] | None:
    """The tables of its bus with other keys."""
    return {"bus": twin.tables["bus"] | keys} if "bus" in twin.tables else None


def frames_lost(random: Random, twin: Twin) -> Change | None:
    at, cycles = twin.when(random), round(random.decades(0, 2))
    tables = bus_of(twin, fault=[{"kind": "lost", "start": f"{at} s", "cycles": cycles}])
    return tables and Change(twin.axis, tables=tables, note=f"{cycles} frames lost from {at} s", harms=True)


def frames_late(random: Random, twin: Twin) -> Change | None:
    at, ticks = twin.when(random), max(1, round(random.decades(-4, -2) * twin.axis.base))
    tables = bus_of(twin, fault=[{"kind": "late", "start": f"{at} s", "duration": "1000 s", "by": f"{ticks / twin.axis.base * 1e6} us"}])
    return tables and Change(twin.axis, tables=tables, note=f"frames {ticks} ticks late from {at} s", harms=True)


def buffer_small(random: Random, twin: Twin) -> Change | None:
    """A bus whose way is so long that the buffer of the drive is too small for it."""
    if twin.tables.get("bus", {}).get("mode") != "ip":
        return None
    delay = round(random.decades(0.3, 1.17))
    return Change(twin.axis, tables=bus_of(twin, delay=delay), note=f"{delay} cycles on the way to a buffer", harms=True)


def master_gain(random: Random, twin: Twin) -> Change | None:
    if twin.tables.get("bus", {}).get("mode") != "csv":
        return None
    factor = random.decades(0, 2) ** random.sign()
    gain = factor * float(twin.tables["bus"]["position_gain"].removesuffix(" 1/s"))
    return Change(twin.axis, tables=bus_of(twin, position_gain=f"{gain} 1/s"), note=f"gain of the master times {factor:.3g}")


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
    "phase lost": phase_lost,
    "link sag": link_sag,
    "dead time": dead_time,
    "gear ratio": gear_ratio,
    "end stop moved": end_stop_moved,
    "frames lost": frames_lost,
    "frames late": frames_late,
    "buffer small": buffer_small,
    "master gain": master_gain,
}

NEEDS: dict[str, Callable[[Axis], bool]] = {
    **dict.fromkeys(("current gain", "commutation", "phase lost", "link sag", "dead time"), lambda axis: axis.pmsm is not None),
    **dict.fromkeys(("load stuck", "load uncoupled", "coupling soft"), lambda axis: axis.load is not None),
    "gear ratio": lambda axis: axis.lead is not None,
}
"""Parts of an axis without which there is no such sabotage."""
