"""The sampled loop, written anew from the documentation: its monodromy matrix, and a run of it with its limits.

At a tick: sample, position loop, velocity loop, current loop, each when it is due and with what the slower one has just said;
the voltage of the current loop goes out one of its periods later. The currents are integrated exactly at the mean speed that the
last two ticks foretell, and their mean torque drives the mechanics, which are integrated exactly too. Everything is in the coordinate of the axis but the motor's own
velocity, effort and gains; r is axis per motor coordinate.
"""

from dataclasses import dataclass, replace
from functools import cache
from math import ceil, expm1, floor, inf

import numpy
from scipy.linalg import expm

from .course import Course


@dataclass(frozen=True)
class Pmsm:
    """A synchronous motor and its current loop."""

    ratio: float
    resistance: float
    inductance: float
    flux: float
    bandwidth: float
    every: int
    """Base ticks per turn of the current loop."""

    @property
    def constant(self) -> float:
        return 1.5 * self.ratio * self.flux


@cache
def held(base: int, m: float, d: float, load: tuple[float, float, float, float] | None) -> tuple[numpy.ndarray, numpy.ndarray]:
    """One or two masses on the ground, over a tick in which the force on the first is held."""
    if load is None:
        a, b = numpy.array([[0, 1], [0, -d / m]]), numpy.array([0, 1 / m])
    else:
        m2, k, c, d2 = load
        first, second = (-k / m, k / m, -(d + c) / m, c / m), (k / m2, -k / m2, c / m2, -(c + d2) / m2)
        a, b = numpy.array([(0, 0, 1, 0), (0, 0, 0, 1), first, second]), numpy.array([0, 0, 1 / m, 0])
    n = len(b)
    whole = numpy.zeros((n + 1, n + 1))
    whole[:n, :n], whole[:n, n] = a, b
    step = expm(whole / base)
    return step[:n, :n], step[:n, n]


@dataclass(frozen=True)
class Loop:
    """Axis and firmware."""

    base: int
    """Ticks per second."""
    velocity_every: int
    position_every: int
    r: float
    """Axis coordinate per motor coordinate."""
    inertia: float
    """Of the motor's side, in its coordinate."""
    position_gain: float
    gain: float
    """Of the velocity loop, in the motor's coordinate."""
    integral_time: float | None = None
    filter_time: float = 0.0
    velocity_share: float = 0.0
    viscous: float = 0.0
    bias: float = 0.0
    """Viscous friction and constant resistance, in the motor's coordinate."""
    load: tuple[float, float, float, float] | None = None
    """Mass, stiffness, damping and viscous friction of a second body, in the axis coordinate."""
    pmsm: Pmsm | None = None
    limit: float = inf
    """Of the effort."""
    increment: float | None = None
    """Of the motor's encoder, in its coordinate; without one it is ideal and gives the velocity too. The linear loop has its
    differences, but not its steps."""
    from_load: bool = False
    """Whether the position of the load closes the position loop."""

    def mechanics(self) -> tuple[numpy.ndarray, numpy.ndarray]:
        """From tick to tick: positions and velocities, and the effect of a force on the motor's side (axis coordinate)."""
        return held(self.base, self.inertia / self.r**2, self.viscous / self.r**2, self.load)

    def monodromy(self) -> numpy.ndarray:
        """The linear loop over its common period, that of the position loop, from one turn of it to the next."""
        phi, gamma = self.mechanics()
        n = len(gamma)
        # Mechanics; filtered velocity, integrator, velocity command, effort, last position; then by axis q and d: current,
        # integrator, computed voltage, voltage that goes out; last speed.
        z = numpy.eye(n + 5 + (9 if self.pmsm else 0))
        filtered, integral, command, effort, last = range(n, n + 5)
        motor = n // 2
        h, hv = 1 / self.base, self.velocity_every / self.base
        for k in range(self.position_every):
            if k == 0:
                z[command] = -self.position_gain * z[1 if self.from_load else 0]
            if k % self.velocity_every == 0:
                measured = z[motor] / self.r if self.increment is None else (z[0] / self.r - z[last]) / hv
                z[filtered] += hv / (hv + self.filter_time) * (measured - z[filtered])
                z[last] = z[0] / self.r
                error = z[command] / self.r - z[filtered]
                z[effort] = self.gain * error + z[integral]
                if self.integral_time is not None:
                    z[integral] += hv / self.integral_time * self.gain * error
            given = z[effort].copy()
            if self.pmsm is not None:
                given = self.currents(self.pmsm, z, k, h, n, motor)
            z[:n] = phi @ z[:n] + numpy.outer(gamma, given / self.r)
        return z

    def currents(self, p: Pmsm, z: numpy.ndarray, k: int, h: float, n: int, motor: int) -> numpy.ndarray:
        """The current loop and the motor over a tick, about standstill; returns the mean torque."""
        last = n + 13
        speed = z[motor] / self.r
        hc = p.every * h
        gain = p.bandwidth * p.inductance
        for axis in range(2):
            current, integral, pending, out = (n + 5 + 4 * axis + i for i in range(4))
            if k % p.every == 0:
                z[out] = z[pending]
                wanted = z[n + 3] / p.constant if axis == 0 else 0.0
                error = wanted - z[current]
                z[pending] = gain * error + z[integral] + (p.ratio * p.flux * z[n] if axis == 0 else 0.0)
                z[integral] = z[integral] + hc * p.bandwidth * p.resistance * error
        mean_speed = 1.5 * speed - 0.5 * z[last]
        z[last] = speed
        # What the current is away from its steady value falls by the time constant L/R.
        ticks = h * p.resistance / p.inductance
        fall = -expm1(-ticks)
        means = []
        for axis in range(2):
            current, out = n + 5 + 4 * axis, n + 8 + 4 * axis
            emf = p.ratio * p.flux * mean_speed if axis == 0 else 0.0
            away = z[current] - (z[out] - emf) / p.resistance
            means.append(z[current] - away * (1 - fall / ticks))
            z[current] = z[current] - away * fall
        return p.constant * means[0]

    def radius(self) -> float:
        """Largest magnitude of an eigenvalue over the common period."""
        return float(max(abs(numpy.linalg.eigvals(self.monodromy()))))

    def is_stable(self) -> bool:
        return self.radius() <= 1.0

    def near_gains(self, share: float) -> list["Loop"]:
        """This one with its gains larger or smaller by `share`, each alone and both."""
        up, down = 1 + share, 1 - share
        pairs = [(up, 1), (down, 1), (1, up), (1, down), (up, up), (down, down)]
        return [replace(self, gain=v * self.gain, position_gain=p * self.position_gain) for v, p in pairs]


@dataclass
class Run:
    """What a run leaves, a value for each tick."""

    t: numpy.ndarray
    reference: numpy.ndarray
    motor: numpy.ndarray
    load: numpy.ndarray
    effort: numpy.ndarray
    cut: numpy.ndarray
    """1 where the upper limit cuts the effort, -1 the lower one, 0 elsewhere."""


def run(loop: Loop, course: Course, duration: float, push: tuple[float, float] | None = None) -> Run:
    """A run on an ideal source, with its effort limit, the back-calculation of the integrator and the increments of the encoder.

    `push` is an effort on the motor from a time on.
    """
    phi, gamma = (part.tolist() for part in loop.mechanics())
    ticks = round(duration * loop.base) + 1
    t = numpy.arange(ticks) / loop.base
    reference, speed, _ = course.at(t)
    xr, vr = reference.tolist(), speed.tolist()
    r, hv, limit = loop.r, loop.velocity_every / loop.base, loop.limit
    share, kp = hv / (hv + loop.filter_time), loop.gain
    ki = 0.0 if loop.integral_time is None else hv / loop.integral_time
    two = loop.load is not None
    step = loop.increment
    begins, pushes = (ticks, 0.0) if push is None else (ceil(push[0] * loop.base - 1e-9), push[1])
    x0 = x1 = v0 = v1 = last = 0.0
    filtered = integral = command = effort = 0.0
    which = 0
    motor, load, efforts, cut = [], [], [], []
    for k in range(ticks):
        read = x0 / r if step is None else floor(x0 / r / step + 0.5) * step
        if k % loop.position_every == 0:
            command = loop.position_gain * (xr[k] - (x1 if loop.from_load else r * read)) + loop.velocity_share * vr[k]
        if k % loop.velocity_every == 0:
            measured = v0 / r if step is None else (read - last) / hv
            filtered += share * (measured - filtered)
            last = read
            error = command / r - filtered
            wanted = kp * error + integral
            effort = max(-limit, min(limit, wanted))
            which = 0 if effort == wanted else 1 if wanted > 0 else -1
            integral += ki * (kp * error + effort - wanted)
        motor.append(x0)
        load.append(x1 if two else x0)
        efforts.append(effort)
        cut.append(which)
        f = (effort - loop.bias + (pushes if k >= begins else 0.0)) / r
        if two:
            x0, x1, v0, v1 = (row[0] * x0 + row[1] * x1 + row[2] * v0 + row[3] * v1 + g * f for row, g in zip(phi, gamma))
        else:
            x0, v0 = (row[0] * x0 + row[1] * v0 + g * f for row, g in zip(phi, gamma))
        if not abs(x0) < 1e100:
            break
    n = len(motor)
    return Run(t[:n], reference[:n], *(numpy.array(values) for values in (motor, load, efforts, cut)))
