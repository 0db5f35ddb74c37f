"""The loop that is simulated: its numbers, its reference, and what is compared of its course."""

import math
from dataclasses import dataclass

import numpy

UNITS = {
    "Hz": 1.0,
    "kHz": 1e3,
    "s": 1.0,
    "V": 1.0,
    "V s": 1.0,
    "Ohm": 1.0,
    "mH": 1e-3,
    "kg m2": 1.0,
    "rad/s": 1.0,
    "rad/s2": 1.0,
    "Arms": math.sqrt(2),
}
"""Factors to SI, and to peak values of a phase."""


@dataclass(frozen=True)
class Loop:
    """A synchronous motor on a rigid axis under a velocity and a current loop of one rate. All values are SI, currents peak."""

    pole_pairs: int
    resistance: float
    inductance_d: float
    inductance_q: float
    flux_linkage: float
    max_current: float
    dc_link: float
    inertia: float
    period: float
    """Of both loops (s)."""
    current_bandwidth: float
    """rad/s."""
    velocity_bandwidth: float
    """rad/s. The gain is inertia times bandwidth, the integral time 4/bandwidth."""
    times: tuple[float, ...]
    """Corners of the reference."""
    velocities: tuple[float, ...]
    """Of the reference at its corners, rad/s of the motor; straight lines between them."""

    @classmethod
    def of(cls, parameters: dict[str, str]) -> "Loop":
        """The loop of a scenario, by the parameters in its results."""

        def number(key: str) -> float:
            value, unit = parameters[key].split(" ", maxsplit=1)
            return float(value) * UNITS[unit]

        rates = {number(f"drive.{loop}.rate") for loop in ("current", "velocity")} | {number("run.base_rate")}
        assert len(rates) == 1, f"the loops have different rates: {rates}"
        times, velocities = [0.0], [0.0]
        for step in range(sum(key.endswith(".reach_velocity") for key in parameters)):
            to = number(f"program.{step}.reach_velocity")
            times.append(times[-1] + abs(to - velocities[-1]) / number("setpoint.acceleration"))
            velocities.append(to)
            if f"program.{step}.hold" in parameters:
                times.append(times[-1] + number(f"program.{step}.hold"))
                velocities.append(to)
        times.append(max(number("run.duration"), times[-1]))
        velocities.append(velocities[-1])
        return cls(
            pole_pairs=int(parameters["motor.pole_pairs"]),
            resistance=number("motor.resistance"),
            inductance_d=number("motor.inductance_d"),
            inductance_q=number("motor.inductance_q"),
            flux_linkage=number("motor.flux_linkage"),
            max_current=number("motor.max_current"),
            dc_link=number("drive.dc_link"),
            inertia=number("motor.inertia") + number("axis.motor_side.inertia"),
            period=1 / rates.pop(),
            current_bandwidth=2 * math.pi * number("drive.current.bandwidth"),
            velocity_bandwidth=2 * math.pi * number("drive.velocity.bandwidth"),
            times=tuple(times),
            velocities=tuple(velocities),
        )

    @property
    def duration(self) -> float:
        """What is simulated (s)."""
        return self.times[-1]

    @property
    def max_torque(self) -> float:
        """The torque at the current limit, without current in the d axis."""
        return 1.5 * self.pole_pairs * self.flux_linkage * self.max_current

    def torque(self, i_d: numpy.ndarray, i_q: numpy.ndarray) -> numpy.ndarray:
        """The air-gap torque of these currents."""
        return 1.5 * self.pole_pairs * (self.flux_linkage + (self.inductance_d - self.inductance_q) * i_d) * i_q

    def course(
        self, reference: numpy.ndarray, velocity: numpy.ndarray, i_d: numpy.ndarray, i_q: numpy.ndarray
    ) -> dict[str, float]:
        """What is compared, from values at each period, by the names of servobench's metrics (docs/metrics.md)."""
        error, squared, torque = reference - velocity, i_d**2 + i_q**2, self.torque(i_d, i_q)
        return {
            "velocity_error_peak": numpy.max(numpy.abs(error)),
            "following_error_peak_motor": numpy.max(numpy.abs(numpy.cumsum(error))) * self.period,
            "current_peak": math.sqrt(numpy.max(squared)),
            "torque_rms": math.sqrt(numpy.mean(torque**2)),
            "shaft_power_peak": numpy.max(numpy.abs(torque * velocity)),
            "copper_loss": 1.5 * self.resistance * numpy.sum(squared) * self.period,
        }
