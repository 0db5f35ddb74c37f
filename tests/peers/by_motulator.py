"""The loop in motulator, as in its examples of vector control of a synchronous motor with a speed sensor.

Its model with the averaged inverter (`zoh`), its own solver with its settings, its own control. Two things are other than in the
examples: there is no current in the d axis, as servobench has none, so that the curve of the least current is not looked up; and
the speed controller is its PI with the gains of servobench, not with two degrees of freedom.
"""

import time

import numpy
from motulator.common.control import PIController
from motulator.common.utils import Sequence
from motulator.drive import model
from motulator.drive.control import sm
from motulator.drive.utils import SynchronousMachinePars

from loop import Loop

NOMINAL_SPEED = 2 * numpy.pi * 75
"""Of the motor (electrical rad/s), for the gain of a field weakening that does not set in."""


def simulate(loop: Loop) -> tuple[float, dict[str, float]]:
    """Seconds by the clock for the simulation alone, and its course."""
    motor = SynchronousMachinePars(
        n_p=loop.pole_pairs, R_s=loop.resistance, L_d=loop.inductance_d, L_q=loop.inductance_q, psi_f=loop.flux_linkage
    )
    drive = model.Drive(
        model.VoltageSourceConverter(u_dc=loop.dc_link),
        model.SynchronousMachine(motor),
        model.StiffMechanicalSystem(J=loop.inertia),
    )
    references = sm.CurrentReferenceCfg(motor, nom_w_m=NOMINAL_SPEED, max_i_s=loop.max_current)
    references.mtpa_i_sd = lambda _torque: 0.0
    control = sm.CurrentVectorControl(
        motor, references, J=loop.inertia, T_s=loop.period, alpha_c=loop.current_bandwidth, sensorless=False
    )
    gain = loop.inertia * loop.velocity_bandwidth
    control.speed_ctrl = PIController(gain, gain * loop.velocity_bandwidth / 4, max_u=loop.max_torque)
    control.ref.w_m = Sequence(numpy.array(loop.times), loop.pole_pairs * numpy.array(loop.velocities))
    simulation = model.Simulation(drive, control)
    begun = time.perf_counter()
    simulation.simulate(t_stop=loop.duration)
    seconds = time.perf_counter() - begun
    measured, wanted = control.data.fbk, control.data.ref
    course = loop.course(
        wanted.w_m / loop.pole_pairs, measured.w_m / loop.pole_pairs, measured.i_s.real, measured.i_s.imag
    )
    return seconds, course
