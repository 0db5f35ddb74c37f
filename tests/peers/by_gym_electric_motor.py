"""The loop in gym-electric-motor: its synchronous motor behind its averaged inverter and its dead time of a period.

It is controlled by servobench's equations (docs/loop.md) in plain Python, without the limits, which are not reached; the
controllers that come with it tune themselves to other gains. It is run three ways: as an environment with the solver that it has
by default, as one with Euler's method, and with Euler's method and no environment around it (no reward, no reference, no
constraints).
"""

import math
import time
from collections.abc import Callable

import gym_electric_motor
import numpy
from gym_electric_motor import PhysicalSystem, physical_systems
from gym_electric_motor.physical_system_wrappers import DeadTimeProcessor, DqToAbcActionProcessor
from gym_electric_motor.physical_systems.solvers import EulerSolver, OdeSolver, ScipyOdeSolver
from gym_electric_motor.reference_generators import ConstReferenceGenerator

from loop import Loop


class Control:
    """Velocity and current loop, called once in a period."""

    def __init__(self, loop: Loop) -> None:
        torque_constant = 1.5 * loop.pole_pairs * loop.flux_linkage
        self.velocity_gain = loop.inertia * loop.velocity_bandwidth / torque_constant
        self.velocity_share = loop.period * loop.velocity_bandwidth / 4
        self.gain_d = loop.current_bandwidth * loop.inductance_d
        self.gain_q = loop.current_bandwidth * loop.inductance_q
        self.current_share = loop.period * loop.current_bandwidth * loop.resistance
        self.pole_pairs, self.flux_linkage = loop.pole_pairs, loop.flux_linkage
        self.inductance_d, self.inductance_q = loop.inductance_d, loop.inductance_q
        self.i_q_integral = self.u_d_integral = self.u_q_integral = 0.0

    def step(self, reference: float, velocity: float, i_d: float, i_q: float) -> tuple[float, float]:
        """The voltage in d and q."""
        proportional = self.velocity_gain * (reference - velocity)
        e_q = proportional + self.i_q_integral - i_q
        self.i_q_integral += self.velocity_share * proportional
        omega = self.pole_pairs * velocity
        u_d = self.u_d_integral - self.gain_d * i_d - omega * self.inductance_q * i_q
        u_q = self.u_q_integral + self.gain_q * e_q + omega * (self.inductance_d * i_d + self.flux_linkage)
        self.u_d_integral -= self.current_share * i_d
        self.u_q_integral += self.current_share * e_q
        return u_d, u_q


def parts(loop: Loop, solver: OdeSolver) -> dict:
    """What both kinds of simulation are made of."""
    limits = {
        "omega": 2 * max(loop.velocities),
        "torque": loop.max_torque,
        "i": loop.max_current,
        "u": loop.dc_link,
        "epsilon": math.pi,
    }
    motor = {
        "p": loop.pole_pairs,
        "r_s": loop.resistance,
        "l_d": loop.inductance_d,
        "l_q": loop.inductance_q,
        "psi_p": loop.flux_linkage,
        # Half of the inertia: a load has to have some.
        "j_rotor": loop.inertia / 2,
    }
    load = {"a": 0.0, "b": 0.0, "c": 0.0, "j_load": loop.inertia / 2}
    return {
        "supply": physical_systems.IdealVoltageSupply(u_nominal=loop.dc_link),
        "converter": physical_systems.ContB6BridgeConverter(tau=loop.period),
        "motor": physical_systems.PermanentMagnetSynchronousMotor(
            motor_parameter=motor, limit_values=limits, nominal_values=dict(limits)
        ),
        "load": physical_systems.PolynomialStaticLoad(load_parameter=load, limits={"omega": limits["omega"]}),
        "ode_solver": solver,
        "tau": loop.period,
    }


def followed(
    loop: Loop, system: PhysicalSystem, state: numpy.ndarray, step: Callable[[numpy.ndarray], numpy.ndarray]
) -> tuple[float, dict[str, float]]:
    """Follows the reference from `state`; seconds by the clock, and the course. States are parts of the limits of `system`."""
    places = [system.state_names.index(name) for name in ("omega", "i_sd", "i_sq")]
    to_si = system.limits[places]
    count = round(loop.duration / loop.period)
    reference = numpy.interp(numpy.arange(count) * loop.period, loop.times, loop.velocities).tolist()
    rows = []
    control, full_voltage = Control(loop), loop.dc_link / 2
    begun = time.perf_counter()
    for wanted in reference:
        velocity, i_d, i_q = row = (state[places] * to_si).tolist()
        rows.append(row)
        u_d, u_q = control.step(wanted, velocity, i_d, i_q)
        state = step(numpy.array((u_d / full_voltage, u_q / full_voltage)))
    seconds = time.perf_counter() - begun
    return seconds, loop.course(numpy.array(reference), *numpy.array(rows).T)


def environment(loop: Loop, solver: OdeSolver) -> tuple[float, dict[str, float]]:
    """As its examples run it."""
    made = gym_electric_motor.make(
        "Cont-SC-PMSM-v0",
        disable_env_checker=True,
        reference_generator=ConstReferenceGenerator("omega", 0.5),
        constraints=(),
        visualization=(),
        physical_system_wrappers=(DeadTimeProcessor(steps=1), DqToAbcActionProcessor.make("PMSM")),
        **parts(loop, solver),
    )
    (state, _), _ = made.reset()
    return followed(loop, made.unwrapped.physical_system, state, lambda action: made.step(action)[0][0])


def with_default_solver(loop: Loop) -> tuple[float, dict[str, float]]:
    """The environment, with Dormand and Prince's method of SciPy."""
    return environment(loop, ScipyOdeSolver())


def with_euler(loop: Loop) -> tuple[float, dict[str, float]]:
    """The environment, with Euler's method."""
    return environment(loop, EulerSolver())


def bare(loop: Loop) -> tuple[float, dict[str, float]]:
    """The motor with its inverter, without the environment, with Euler's method."""
    system = physical_systems.SynchronousMotorSystem(control_space="dq", **parts(loop, EulerSolver()))
    system = DeadTimeProcessor(steps=1).set_physical_system(system)
    return followed(loop, system, system.reset(), system.simulate)
