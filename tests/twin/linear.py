"""The sampled linear loop of an axis, and its margins, by numpy alone.

One period of the position loop from its own description in docs/loop.md: at a tick position loop, velocity loop, current loop, each
when it is due; the mean effort over a tick drives the mechanics, which are integrated exactly. The effort that the velocity loop asks for
may be multiplied by a complex number: a loop that stays stable under every factor from 1 to 2 has a gain margin of 6 dB there, and under
every rotation up to 30 degrees a phase margin of as much.
"""

from cmath import exp
from dataclasses import replace
from math import ceil, expm1, log2, radians

import numpy

from machine import Axis


def exponential(a: numpy.ndarray) -> numpy.ndarray:
    """Of a matrix, by scaling, a Taylor series of order 18, and squaring."""
    norm = float(numpy.abs(a).sum(axis=1).max())
    halvings = max(0, ceil(log2(norm / 0.5))) if norm > 0.5 else 0
    small, term = a / 2**halvings, numpy.eye(len(a))
    total = term.copy()
    for n in range(1, 19):
        term = term @ small / n
        total += term
    for _ in range(halvings):
        total = total @ total
    return total


def mechanics(axis: Axis) -> tuple[numpy.ndarray, numpy.ndarray]:
    """From tick to tick: positions and velocities (axis coordinate), and the effect of a force on the motor's side."""
    m, d = axis.motor.inertia / axis.r**2, axis.motor.viscous / axis.r**2
    if axis.load is None:
        a, b = numpy.array([[0, 1], [0, -d / m]]), numpy.array([0, 1 / m])
    else:
        m2, d2, k, c = axis.load.inertia, axis.load.viscous, axis.stiffness, axis.damping
        first, second = (-k / m, k / m, -(d + c) / m, c / m), (k / m2, -k / m2, c / m2, -(c + d2) / m2)
        a, b = numpy.array([(0, 0, 1, 0), (0, 0, 0, 1), first, second]), numpy.array([0, 0, 1 / m, 0])
    n = len(b)
    whole = numpy.zeros((n + 1, n + 1))
    whole[:n, :n], whole[:n, n] = a, b
    step = exponential(whole / axis.base)
    return step[:n, :n], step[:n, n]


def monodromy(axis: Axis, factor: complex = 1.0) -> numpy.ndarray:
    """The loop over a period of the position loop, with the effort of the velocity loop multiplied by `factor`."""
    phi, gamma = mechanics(axis)
    n, motor = len(gamma), len(gamma) // 2
    pmsm = axis.pmsm
    # Mechanics; filtered velocity, integrator, velocity command, effort, last position; of the q axis: current, integrator, computed
    # voltage, voltage that goes out; last speed.
    z = numpy.eye(n + 5 + (5 if pmsm else 0), dtype=complex)
    filtered, integral, command, effort, last = range(n, n + 5)
    if axis.integral_time is None:
        z[integral] = 0
    h, hv, r = 1 / axis.base, axis.velocity_every / axis.base, axis.r
    for k in range(axis.position_every):
        if k == 0:
            z[command] = -axis.position_gain * z[1 if axis.from_load else 0]
        if k % axis.velocity_every == 0:
            measured = z[motor] / r if axis.increment is None else (z[0] / r - z[last]) / hv
            z[filtered] += hv / (hv + axis.filter_time) * (measured - z[filtered])
            z[last] = z[0] / r
            error = z[command] / r - z[filtered]
            z[effort] = factor * (axis.velocity_gain * error + z[integral])
            if axis.integral_time is not None:
                z[integral] = z[integral] + hv / axis.integral_time * axis.velocity_gain * error
        given = z[effort].copy()
        if pmsm is not None:
            given = current_loop(axis, z, k, n, motor)
        z[:n] = phi @ z[:n] + numpy.outer(gamma, given / r)
    return z


def current_loop(axis: Axis, z: numpy.ndarray, k: int, n: int, motor: int) -> numpy.ndarray:
    """The q axis over a tick, about standstill; returns the mean torque. At standstill the d axis is a loop of its own."""
    p = axis.pmsm
    h, hc = 1 / axis.base, axis.current_every / axis.base
    gain, speed = p.bandwidth * p.inductance, z[motor] / axis.r
    flux = p.constant / 1.5
    current, integral, pending, out, last = range(n + 5, n + 10)
    if k % axis.current_every == 0:
        z[out] = z[pending]
        error = z[n + 3] / p.believed - z[current]
        z[pending] = gain * error + z[integral] + p.believed / 1.5 * z[n]
        z[integral] = z[integral] + hc * p.bandwidth * p.resistance * error
    mean_speed = 1.5 * speed - 0.5 * z[last]
    z[last] = speed
    ticks = h * p.resistance / p.inductance
    fall = -expm1(-ticks)
    away = z[current] - (z[out] - flux * mean_speed) / p.resistance
    mean = z[current] - away * (1 - fall / ticks)
    z[current] = z[current] - away * fall
    return p.constant * mean


def radius(axis: Axis, factor: complex = 1.0) -> float:
    """Largest magnitude of an eigenvalue."""
    return float(numpy.abs(numpy.linalg.eigvals(monodromy(axis, factor))).max())


def is_stable(axis: Axis) -> bool:
    return radius(axis) < 1


def has_margins(axis: Axis, gain: float = 2.0, phase: float = radians(30)) -> bool:
    """Whether it stays stable with the effort times up to `gain`, and turned by up to `phase`; so too with the gain of its position loop
    times as much, which is the loop around it."""
    factors = [1.0, *(gain**share for share in (0.25, 0.5, 0.75, 1.0)), *(exp(-1j * phase * share) for share in (0.25, 0.5, 0.75, 1.0))]
    if not all(radius(axis, factor) < 1 for factor in factors):
        return False
    return all(radius(replace(axis, position_gain=axis.position_gain * factor)) < 1 for factor in (gain**0.5, gain))


def slowest(axis: Axis) -> float:
    """Time constant of the slowest pole (s); infinite for one that does not decay."""
    size = radius(axis)
    period = axis.position_every / axis.base
    return -period / numpy.log(size) if size < 1 else numpy.inf


