"""The shortest way of order 4 from any state to rest, by linear programs: an optimum that shares nothing with the planner.

The duration T is given to a program. Its variables are the snap in each interval of a grid over T and the state at each
node, linked by exact integration, bounded by the limits, at rest at the end; it maximises (or minimises) the position at
the end. What can be reached in T can be reached in any longer time, by waiting at rest: so the shortest T is where the
target comes within reach.

The grid is uniform, with the instants put in at which the plan to be judged switches. That plan is then among the ways
of the program, and what is found to be shorter is no effect of the grid. A grid twice as fine says what the error is.
"""

import math
import os
from collections.abc import Sequence
from concurrent.futures import ProcessPoolExecutor

import highspy
import numpy as np
from numpy.typing import NDArray
from scipy.optimize import brentq
from scipy.sparse import csc_array

from plans import Limits, Plan, State

Vector = NDArray[np.float64]

TOLERANCE = 1e-9
"""Of the programs, as a part of what limits each variable."""

NEARER = 1e-6
"""Of nodes nearer than this part of the duration only one is kept."""

SLACK = 1e-5
"""A plan that is on the grid is found with this much more time, whatever was rounded."""

POWERS = np.array([1, 2, 3, 4])


class Ways:
    """All ways on one grid from a state to rest somewhere, within the limits.

    The unit of time is the duration, that of the snap its limit: only the bounds of the program depend on the duration, and
    each solution starts from the one before. The states are in units of the least that limits them, divided by a power of
    the number of intervals: the rows of the program then hold numbers of similar size.
    """

    def __init__(self, start: State, limits: Limits, nodes: Vector, duration: float) -> None:
        """`nodes` is the grid, over 0 … 1; `duration` about that which will be asked for."""
        self.start, self.limits, self.intervals = start, limits, len(nodes) - 1
        n = self.intervals
        bounds = np.array([limits.jerk, limits.a_above, limits.v_above, math.inf]) / (limits.snap * duration**POWERS)
        self.scale = np.minimum.accumulate(np.minimum(bounds, 1)) / n ** (POWERS / 2)
        rows = integration(np.diff(nodes), self.scale)
        program = highspy.HighsLp()
        program.num_row_, program.num_col_ = rows.shape
        program.row_lower_ = program.row_upper_ = np.zeros(4 * n)
        program.col_lower_ = program.col_upper_ = program.col_cost_ = np.zeros(5 * n + 4)
        matrix = program.a_matrix_
        matrix.format_ = highspy.MatrixFormat.kColwise
        matrix.start_, matrix.index_, matrix.value_ = rows.indptr, rows.indices, rows.data
        self.solver = highspy.Highs()
        self.solver.silent()
        for option in ("primal_feasibility_tolerance", "dual_feasibility_tolerance"):
            self.solver.setOptionValue(option, TOLERANCE)
        self.solver.passModel(program)

    @classmethod
    def around(cls, plans: Sequence[Plan], intervals: int) -> "Ways":
        """The ways from where the plans start, on a uniform grid with their instants put in."""
        instants = [t / plan.duration for plan in plans for t in plan.instants()[1:-1]]
        nodes = [0.0]
        for node in sorted([*np.linspace(0, 1, intervals + 1), *instants]):
            if node - nodes[-1] > NEARER:
                nodes.append(float(node))
        nodes[-1] = 1.0
        return cls(plans[0].request.start, plans[0].request.limits, np.array(nodes), plans[0].duration)

    def reach(self, duration: float, direction: float) -> float:
        """How far in `direction` a way of `duration` can come to rest; minus infinity where none can."""
        n, limits, start = self.intervals, self.limits, self.start
        unit = self.scale * limits.snap * duration**POWERS
        low, high = np.full(5 * n + 4, -highspy.kHighsInf), np.full(5 * n + 4, highspy.kHighsInf)
        low[:n], high[:n] = -1, 1
        sides = (limits.jerk, limits.jerk), (limits.a_below, limits.a_above), (limits.v_below, limits.v_above)
        for i, (below, above) in enumerate(sides):
            low[n + i :: 4], high[n + i :: 4] = -below / unit[i], above / unit[i]
        low[n : n + 4] = high[n : n + 4] = np.array([start.j, start.a, start.v, 0]) / unit
        low[-4:-1] = high[-4:-1] = 0
        every = np.arange(5 * n + 4, dtype=np.int32)
        self.solver.changeColsBounds(len(every), every, low, high)
        self.solver.changeColCost(len(every) - 1, -direction)
        # The simplex now and then ends without an answer; the interior point then has one.
        for method, presolve in (("simplex", "off"), ("ipm", "off"), ("simplex", "on")):
            self.solver.setOptionValue("solver", method)
            self.solver.setOptionValue("presolve", presolve)
            self.solver.run()
            match self.solver.getModelStatus():
                case highspy.HighsModelStatus.kOptimal:
                    return direction * self.solver.getSolution().col_value[-1] * float(unit[3])
                case highspy.HighsModelStatus.kInfeasible:
                    return -math.inf
            self.solver.clearSolver()
        raise ArithmeticError(f"no answer for {duration} s from {start} within {limits}")


def integration(lengths: Vector, scale: Vector) -> csc_array:
    """The rows that link the snap of each interval with the states (j, a, v, x) before and after it; each sum is zero."""
    n = len(lengths)
    k = np.arange(n)
    entries = []
    for i in range(4):
        entries.append((i, n + 4 * (k + 1) + i, np.ones(n)))
        entries.append((i, k, -(lengths ** (i + 1)) / math.factorial(i + 1) / scale[i]))
        for m in range(i + 1):
            entries.append((i, n + 4 * k + m, -(lengths ** (i - m)) / math.factorial(i - m) * scale[m] / scale[i]))
    rows = np.concatenate([4 * k + i for i, _, _ in entries])
    columns = np.concatenate([column for _, column, _ in entries])
    values = np.concatenate([value for _, _, value in entries])
    return csc_array((values, (rows, columns)), shape=(4 * n, 5 * n + 4))


def shortest(plans: Sequence[Plan], intervals: int) -> float:
    """The shortest duration of what the plans do, which have the same request: from a state to rest at a position."""
    request = plans[0].request
    ways = Ways.around(plans, intervals)
    longest = min(plan.duration for plan in plans) * (1 + SLACK)
    away = request.to.x - request.start.x
    size = abs(away) + max(request.limits.v_below, request.limits.v_above) * longest

    def beyond(duration: float, direction: float) -> float:
        """How far the target is within reach, below zero where it is not; as a part of all distances."""
        return max(-1.0, (ways.reach(duration, direction) - direction * away) / size)

    needed = 0.0
    for direction in (1.0, -1.0):
        # Most plans are within this of the optimum.
        part = 1e-3
        low = max(needed, longest * (1 - part))
        while needed < low and beyond(low, direction) >= 0:
            part *= 8
            low = max(needed, longest * (1 - part))
        if low == 0 or beyond(low, direction) >= 0:
            continue
        needed = float(brentq(beyond, low, longest, args=(direction,), xtol=1e-9 * longest, rtol=1e-12))
    return needed


def _shortest(task: tuple[Sequence[Plan], int]) -> float:
    return shortest(*task)


def all_shortest(tasks: Sequence[tuple[Sequence[Plan], int]]) -> list[float]:
    """As `shortest`, for many, on all processors."""
    with ProcessPoolExecutor(os.cpu_count()) as pool:
        return list(pool.map(_shortest, tasks))
