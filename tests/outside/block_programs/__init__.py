"""Programs of function blocks on one axis, as the test suite of pyplcopen runs them, one module for each kind of block."""

from block_programs import axis, continuous, homing, moves, on_top, probe, states, values
from block_programs.program import Program

PROGRAMS: list[Program] = [
    program for module in (moves, continuous, on_top, axis, homing, probe, values, states) for program in module.PROGRAMS
]
