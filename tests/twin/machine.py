"""A random healthy axis with its drive, as numbers, and as the tables of a scenario.

Everything that a drive believes of its axis is written out (gains, limits, estimates), so that a machine that is changed afterwards keeps
the drive of the healthy one.
"""

from dataclasses import dataclass, field, replace
from math import pi, sqrt

from draws import Random
from verdict_classes.case import Tree, quantity

RATES = [(4_000, 1, 1, 1), (4_000, 1, 1, 2), (8_000, 1, 1, 2), (8_000, 1, 2, 4), (12_000, 1, 3, 6)]
"""Base rate; base ticks per turn of current, velocity and position loop."""


LEAST_TORQUE = 1.6
"""What a healthy drive can give, as a share of what its task takes."""


@dataclass(frozen=True)
class Body:
    """Of the motor's side in the motor coordinate, of the load in that of the axis."""

    inertia: float
    viscous: float = 0.0
    coulomb: float = 0.0
    bias: float = 0.0


@dataclass(frozen=True)
class Pmsm:
    """A synchronous motor, its inverter, and the bandwidth of its current loop."""

    pole_pairs: int
    resistance: float
    inductance: float
    constant: float
    """Torque per peak ampere."""
    believed: float
    """What the drive takes it for."""
    dc_link: float
    bandwidth: float
    extras: Tree = field(default_factory=dict)
    """More tables of `[motor]` and `[drive]`, by their dotted names."""


@dataclass(frozen=True)
class Axis:
    """Plant and drive. Efforts and gains of the velocity loop are in the motor coordinate, the rest in that of the axis."""

    base: int
    current_every: int
    velocity_every: int
    position_every: int
    rotary_motor: bool
    linear_axis: bool
    lead: float | None
    motor: Body
    load: Body | None
    stiffness: float
    damping: float
    pmsm: Pmsm | None
    # The drive.
    believed_lead: float | None
    estimate: Tree
    velocity_gain: float
    integral_time: float | None
    filter_time: float
    position_gain: float
    limit: float
    feedforward: Tree
    # Sensors: increment and noise of the motor's encoder in the motor coordinate.
    increment: float | None
    noise: float = 0.0
    seed: int = 1
    latency: float = 0.0
    commutation: float = 0.0
    from_load: bool = False
    is_fmu: bool = False
    """Whether its load is an FMU beside the axis."""
    stops: Tree = field(default_factory=dict)
    switches: Tree = field(default_factory=dict)
    objects: Tree = field(default_factory=dict)

    @property
    def r(self) -> float:
        """Axis coordinate per motor coordinate."""
        return 1.0 if self.lead is None else self.lead / (2 * pi)

    @property
    def total(self) -> float:
        """Inertia of the whole axis in the motor coordinate."""
        return self.motor.inertia + (self.load.inertia * self.r**2 if self.load else 0.0)

    @property
    def unit(self) -> str:
        """Of the axis coordinate."""
        return "m" if self.linear_axis else "rad"

    @property
    def effort_unit(self) -> str:
        """Of the motor coordinate."""
        return "Nm" if self.rotary_motor else "N"

    @property
    def grain(self) -> float:
        """An increment and the noise, in the axis coordinate."""
        return self.r * ((self.increment or 0.0) + self.noise)

    def friction(self) -> float:
        """Of both bodies, in the motor coordinate."""
        load = self.load
        return self.motor.coulomb + (load.coulomb * self.r if load else 0.0)

    def bias(self) -> float:
        load = self.load
        return self.motor.bias + (load.bias * self.r if load else 0.0)

    def effort(self, velocity: float, acceleration: float) -> float:
        """Largest effort of a move with these peaks (axis coordinate)."""
        load = self.load
        viscous = self.motor.viscous + (load.viscous * self.r**2 if load else 0.0)
        return (self.total * acceleration + viscous * velocity) / self.r + self.friction() + abs(self.bias())

    def tables(self) -> Tree:
        """The tables `run`, `axis`, `motor` and `drive`."""
        motor_mass = ("inertia", "kg m2", "Nm s/rad", "Nm") if self.rotary_motor else ("mass", "kg", "N s/m", "N")
        load_mass = ("mass", "kg", "N s/m", "N") if self.linear_axis else ("inertia", "kg m2", "Nm s/rad", "Nm")
        axis: Tree = {"motion": "linear" if self.linear_axis else "rotary"}
        if self.lead is not None:
            axis["lead"] = quantity(self.lead, "m")
        rotor = self.pmsm is not None and self.rotary_motor
        # A rotor has a part of the inertia of the motor's side.
        axis["motor_side"] = body(self.motor, motor_mass, 0.5 if rotor else 1.0)
        if self.load is not None and not self.is_fmu:
            axis["load"] = body(self.load, load_mass, 1.0)
            axis["load"]["stiffness"] = quantity(self.stiffness, "N/m" if self.linear_axis else "Nm/rad")
            axis["load"]["damping"] = quantity(self.damping, load_mass[2])
        if self.stops:
            axis["end_stops"] = self.stops
        if self.switches:
            axis["switches"] = self.switches
        tables = {"run": {"base_rate": f"{self.base} Hz"}, "axis": axis, "motor": self.motor_table(), "drive": self.drive_table()}
        for name, value in (self.pmsm.extras if self.pmsm else {}).items():
            table, key = name.split(".")
            tables[table][key] = value
        return tables

    def motor_table(self) -> Tree:
        unit = "rad" if self.rotary_motor else "m"
        encoder: Tree = {}
        if self.increment is not None and self.rotary_motor:
            encoder["counts_per_rev"] = round(2 * pi / self.increment)
        elif self.increment is not None:
            encoder["step"] = f"{round(1e9 * self.increment)} nm"
        if self.noise:
            encoder |= {"noise": quantity(self.noise, unit), "seed": self.seed}
        if self.latency:
            encoder["latency"] = quantity(self.latency, "s")
        if self.commutation:
            encoder["commutation_offset"] = quantity(self.commutation, "deg")
        table: Tree = {"kind": "ideal-source"}
        if self.pmsm is not None:
            p = self.pmsm
            table = {
                "kind": "pmsm",
                "pole_pairs": p.pole_pairs,
                "resistance": quantity(p.resistance, "Ohm"),
                "inductance": quantity(p.inductance, "H"),
                "flux_linkage": quantity(p.constant / (1.5 * p.pole_pairs), "V s"),
                "inertia": quantity(0.5 * self.motor.inertia, "kg m2"),
                "max_current": quantity(1.2 * self.limit / min(p.constant, p.believed), "Apk"),
            }
        return table | ({"encoder": encoder} if encoder else {})

    def drive_table(self) -> Tree:
        gain_unit = "Nm s/rad" if self.rotary_motor else "N s/m"
        velocity: Tree = {
            "rate": f"{self.base // self.velocity_every} Hz",
            "kind": "p" if self.integral_time is None else "pi",
            "gain": quantity(self.velocity_gain, gain_unit),
        }
        if self.integral_time is not None:
            velocity["integral_time"] = quantity(self.integral_time, "s")
        if self.filter_time:
            velocity["filter_time"] = quantity(self.filter_time, "s")
        drive: Tree = {
            "max_torque" if self.rotary_motor else "max_force": quantity(self.limit, self.effort_unit),
            "velocity": velocity,
            "position": {"rate": f"{self.base // self.position_every} Hz", "gain": quantity(self.position_gain, "1/s")},
            "estimate": dict(self.estimate),
        }
        if self.believed_lead is not None:
            drive["estimate"]["lead"] = quantity(self.believed_lead, "m")
        if self.pmsm is not None and self.pmsm.believed != self.pmsm.constant:
            flux = self.pmsm.believed / (1.5 * self.pmsm.pole_pairs)
            drive["estimate"]["motor"] = {"flux_linkage": quantity(flux, "V s")}
        if self.feedforward:
            drive["feedforward"] = self.feedforward
        if self.objects:
            drive["objects"] = self.objects
        if self.from_load:
            drive |= {"position_feedback": "load", "load_encoder": {"step": "1 nm" if self.linear_axis else "1e-6 deg"}}
        if self.pmsm is not None:
            rate = f"{self.base // self.current_every} Hz"
            drive["current"] = {"rate": rate, "bandwidth": quantity(self.pmsm.bandwidth, "rad/s")}
            drive["dc_link"] = quantity(self.pmsm.dc_link, "V")
        return drive


def body(of: Body, units: tuple[str, str, str, str], share: float) -> Tree:
    """The table of a body: name and unit of its inertia, units of viscous friction and of effort."""
    name, inertia, viscous, effort = units
    table: Tree = {name: quantity(share * of.inertia, inertia)}
    if of.viscous:
        table["viscous"] = quantity(of.viscous, viscous)
    if of.coulomb:
        table["coulomb"] = quantity(of.coulomb, effort)
    if of.bias:
        table["bias"] = quantity(of.bias, effort)
    return table


def estimate(axis: Axis) -> Tree:
    """What the drive believes of the axis, which is the truth as long as it is healthy."""
    inertia, viscous, stiffness, effort = (
        ("kg", "N s/m", "N/m", "N") if axis.linear_axis else ("kg m2", "Nm s/rad", "Nm/rad", "Nm")
    )
    r = axis.r
    table: Tree = {
        "motor_inertia": quantity(axis.motor.inertia / r**2, inertia),
        "motor_viscous": quantity(axis.motor.viscous / r**2, viscous),
        "coulomb": quantity(axis.friction() / r, effort),
        "bias": quantity(axis.bias() / r, effort),
    }
    if axis.is_fmu:
        table["motor_inertia"] = quantity(axis.total / r**2, inertia)
    elif axis.load is not None:
        table |= {
            "load_inertia": quantity(axis.load.inertia, inertia),
            "load_viscous": quantity(axis.load.viscous, viscous),
            "stiffness": quantity(axis.stiffness, stiffness),
        }
    return table


def increment_of(axis: Axis, about: float) -> float:
    """An increment of the motor's encoder near `about` (motor coordinate) that is a ratio of whole numbers to its revolution or metre."""
    return 2 * pi / round(2 * pi / about) if axis.rotary_motor else max(1, round(1e9 * about)) * 1e-9


def draw_axis(random: Random) -> Axis:
    """A well set axis of any kind. The limit of its effort and its encoder are set when its task is known."""
    base, current, velocity, position = random.choice(RATES)
    kind = random.choice(("linear", "rotary", "screw", "screw"))
    pmsm = kind != "linear" and random.random() < 0.4
    if pmsm:
        base, current, velocity, position = random.choice(((8_000, 1, 1, 2), (8_000, 1, 2, 4), (16_000, 1, 2, 4)))
    lead = round(random.decades(-2.5, -1.5), 5) if kind == "screw" else None
    r = 1.0 if lead is None else lead / (2 * pi)
    inertia = random.decades(0, 2) if kind == "linear" else random.decades(-4, -2)
    # The velocity loop is fast for its rate, or slow.
    omega_v = 2 * pi * random.uniform(0.004, 0.012) * base / velocity
    omega_v = min(omega_v, 2 * pi * 60)
    load, stiffness, damping, total = None, 0.0, 0.0, inertia
    if random.random() < 0.55:
        mass = inertia / r**2 * random.decades(-0.6, 0.4)
        reduced = 1 / (1 / mass + r**2 / inertia)
        omega = omega_v * random.uniform(6, 20)
        stiffness, damping = reduced * omega**2, 2 * random.decades(-2, -1) * reduced * omega
        load = Body(mass, viscous=mass * random.uniform(0, 1))
        total += mass * r**2
    axis = Axis(
        base=base,
        current_every=current,
        velocity_every=velocity,
        position_every=position,
        rotary_motor=kind != "linear",
        linear_axis=kind != "rotary",
        lead=lead,
        motor=Body(inertia, viscous=total * random.uniform(0, 2)),
        load=load,
        stiffness=stiffness,
        damping=damping,
        pmsm=None,
        believed_lead=lead,
        estimate={},
        velocity_gain=total * omega_v,
        integral_time=None if random.random() < 0.15 else random.uniform(4, 8) / omega_v,
        filter_time=random.choice((0.0, random.uniform(0.02, 0.1) / omega_v)),
        position_gain=omega_v / random.uniform(4.5, 9),
        limit=0.0,
        feedforward={},
        increment=None,
        from_load=load is not None and random.random() < 0.15,
    )
    if not pmsm:
        return axis
    return replace(axis, pmsm=Pmsm(random.randint(2, 5), 0.0, 0.0, 0.0, 0.0, 0.0, 2 * pi * base / current / 25))


def with_motor(random: Random, axis: Axis, velocity: float, needed: float) -> Axis:
    """The same axis with the limit of its effort, by what its task needs, and with a synchronous motor that gives that much."""
    axis = replace(axis, limit=needed * random.uniform(LEAST_TORQUE, 4))
    axis = replace(axis, estimate=estimate(axis))
    if axis.pmsm is None:
        return axis
    p = axis.pmsm
    current = random.uniform(2, 10)
    constant = needed / current
    speed = velocity / axis.r * p.pole_pairs
    emf = speed * constant / (1.5 * p.pole_pairs)
    resistance = max(emf, 5.0) / current * random.uniform(0.05, 0.2)
    inductance = resistance * random.uniform(3e-3, 8e-3)
    peak = 1.2 * axis.limit / constant
    voltage = emf + resistance * peak + inductance * peak * (speed + 0.15 * p.bandwidth)
    motor = replace(p, resistance=resistance, inductance=inductance, constant=constant, believed=constant, dc_link=sqrt(3) * 1.5 * voltage)
    return replace(axis, pmsm=motor)
