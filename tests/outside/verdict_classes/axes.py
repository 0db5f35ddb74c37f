"""Random axes and drives, as a loop of ours and as tables of a scenario."""

from dataclasses import dataclass
from math import inf, pi

from draws import Random

from .case import Tree, quantity
from .loop import Loop, Pmsm

# Base rate, and base ticks per turn of current, velocity and position loop.
RATES = [
    (8_000, 1, 1, 1),
    (8_000, 1, 2, 4),
    (10_000, 1, 2, 4),
    (12_000, 1, 1, 3),
    (12_000, 1, 2, 4),
    (15_000, 1, 3, 6),
    (16_000, 2, 4, 8),
    (18_000, 1, 3, 9),
    (20_000, 1, 2, 4),
    (20_000, 2, 2, 4),
    (24_000, 1, 3, 6),
    (24_000, 2, 6, 12),
]


FINE = 1e-13
"""An increment (m or rad) that is not seen beside what the loops do."""


@dataclass(frozen=True)
class Units:
    """Units of a kind of axis."""

    motion: str
    lead: float | None
    length: str
    effort: str
    gain: str
    inertia: str
    mass: str
    viscous: str
    load_viscous: str
    stiffness: str

    @property
    def body(self) -> str:
        """What the inertia of the motor's side is called."""
        return "mass" if self.inertia == "kg" else "inertia"

    @property
    def load_body(self) -> str:
        return "mass" if self.mass == "kg" else "inertia"

    @property
    def limit(self) -> str:
        return "max_force" if self.effort == "N" else "max_torque"


TURNS = ("Nm", "Nm s/rad", "kg m2")
LINEAR = Units("linear", None, "m", "N", "N s/m", "kg", "kg", "N s/m", "N s/m", "N/m")
ROTARY = Units("rotary", None, "rad", *TURNS, "kg m2", "Nm s/rad", "Nm s/rad", "Nm/rad")


def screw(lead: float) -> Units:
    return Units("linear", lead, "m", *TURNS, "kg", "Nm s/rad", "N s/m", "N/m")


@dataclass(frozen=True)
class Axis:
    """An axis with its drive."""

    loop: Loop
    units: Units

    def tables(self) -> Tree:
        """Of a scenario, but for `run.duration` and what it is to do."""
        loop, u = self.loop, self.units
        side = {u.body: quantity(loop.inertia, u.inertia)}
        if loop.pmsm is not None and u.body == "inertia":
            # All of it is the rotor's.
            side = {}
        if loop.viscous:
            side["viscous"] = quantity(loop.viscous, u.viscous)
        if loop.bias:
            side["bias"] = quantity(loop.bias, u.effort)
        axis: Tree = {"motion": u.motion}
        if u.lead is not None:
            axis["lead"] = quantity(u.lead, "m")
        if side:
            axis["motor_side"] = side
        if loop.load is not None:
            mass, stiffness, damping, viscous = loop.load
            axis["load"] = {u.load_body: quantity(mass, u.mass), "stiffness": quantity(stiffness, u.stiffness)}
            axis["load"] |= {"damping": quantity(damping, u.load_viscous), "viscous": quantity(viscous, u.load_viscous)}
        return {"run": {"base_rate": f"{loop.base} Hz"}, "axis": axis, "motor": self.motor(), "drive": self.drive()}

    def motor(self) -> Tree:
        loop, u = self.loop, self.units
        unit = "m" if u.effort == "N" else "rad"
        encoder: Tree = {} if loop.increment is None else {"encoder": {"step": quantity(loop.increment, unit)}}
        if loop.pmsm is None:
            return {"kind": "ideal-source"} | encoder
        p = loop.pmsm
        return {
            "kind": "pmsm",
            "pole_pairs": round(p.ratio),
            "resistance": quantity(p.resistance, "Ohm"),
            "inductance": quantity(p.inductance, "H"),
            "flux_linkage": quantity(p.flux, "V s"),
            "inertia": quantity(loop.inertia, "kg m2"),
            "max_current": "100 Apk",
        } | encoder

    def drive(self) -> Tree:
        loop, u = self.loop, self.units
        velocity: Tree = {
            "rate": f"{loop.base // loop.velocity_every} Hz",
            "kind": "p" if loop.integral_time is None else "pi",
            "gain": quantity(loop.gain, u.gain),
        }
        if loop.integral_time is not None:
            velocity["integral_time"] = quantity(loop.integral_time, "s")
        if loop.filter_time:
            velocity["filter_time"] = quantity(loop.filter_time, "s")
        position = {"rate": f"{loop.base // loop.position_every} Hz", "gain": quantity(loop.position_gain, "1/s")}
        drive: Tree = {"velocity": velocity, "position": position}
        if loop.pmsm is not None:
            p = loop.pmsm
            rate = f"{loop.base // p.every} Hz"
            drive["current"] = {"rate": rate, "bandwidth": quantity(p.bandwidth, "rad/s")}
            drive["dc_link"] = "560 V"
        if loop.limit < inf:
            drive[u.limit] = quantity(loop.limit, u.effort)
        if loop.from_load:
            drive |= {"position_feedback": "load", "load_encoder": {"step": quantity(FINE, u.length)}}
        if loop.velocity_share:
            drive["feedforward"] = {"velocity": loop.velocity_share, "delay": "0 s"}
        return drive


def draw_axis(random: Random, *, pmsm: bool, sane: bool) -> Axis:
    """An axis with gains in any proportion, or in those of a drive that is well set (`sane`)."""
    base, current, velocity, position = random.choice(RATES)
    kind = random.choice(("linear", "rotary", "screw"))
    if pmsm and kind == "linear":
        kind = "rotary"
    units = {"linear": LINEAR, "rotary": ROTARY}.get(kind) or screw(round(random.decades(-2.5, -1.5), 5))
    r = 1.0 if units.lead is None else units.lead / (2 * pi)
    inertia = random.decades(-0.5, 2) if kind == "linear" else random.decades(-4.3, -2)
    motor, total = None, inertia
    if pmsm:
        inductance = random.decades(-3, -2)
        bandwidth = 2 * pi * random.uniform(0.02, 0.08) * base / current
        flux = random.decades(-1.5, -0.5)
        resistance = inductance / random.decades(-2.5, -1.7)
        motor = Pmsm(random.randint(2, 6), resistance, inductance, flux, bandwidth, current)
    load = None
    if random.random() < 0.5:
        mass = inertia / r**2 * random.decades(-0.7, 0.4)
        reduced = 1 / (1 / mass + r**2 / inertia)
        omega = 2 * pi * random.uniform(20, 300)
        stiffness = reduced * omega**2
        damping = 2 * random.decades(-2, -1) * reduced * omega
        load = (mass, stiffness, damping, reduced * random.uniform(0, 2))
        total += mass * r**2
    turns = base / velocity
    lowest = 2 * pi * random.uniform(2, 12) if sane and load else None
    omega_v = turns * random.decades(-2.2, -1) if lowest is None else 5 * lowest
    omega_p = min(omega_v / random.uniform(4, 10), base / position / 10) if lowest is None else lowest
    loop = Loop(
        base=base,
        velocity_every=velocity,
        position_every=position,
        r=r,
        inertia=inertia,
        position_gain=omega_p,
        gain=total * omega_v,
        integral_time=random.choice((None, random.uniform(3, 8) / omega_v)),
        filter_time=random.choice((0.0, random.uniform(0.02, 0.2 if sane else 0.8) / omega_v)),
        viscous=total * random.uniform(0, 3),
        load=load,
        pmsm=motor,
    )
    return Axis(loop, units)
