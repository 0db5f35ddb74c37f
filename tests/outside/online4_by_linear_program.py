"""Transitions of order 4 from moving states against the optimum of linear programs.

The states are those in which moves are aborted that were themselves begun by aborting others, within limits that differ by
direction; the targets are at rest. In the median nothing is above the optimum. What is allowed beside is for the approach to
a limit in ever shorter swings, which the planner leaves out, and in `fast` for the bounded amount of work.
Size: 300 states, scaled by `SERVOBENCH_SWEEP`.
"""

from dataclasses import replace

import numpy as np

from draws import Random, sweep_size
from linear_program import all_shortest
from plans import Plan, Request, State, ask

BARS = {"fast": {50: 1e-6, 90: 1e-2}, "refined": {50: 1e-6, 99: 2e-3}}
"""The largest part above the optimum, by percentile."""

DEFECT = 1e-9
INTERVALS = 200
ABORTS = 3


class Axis:
    """An axis that is given new targets while it moves."""

    def __init__(self, random: Random) -> None:
        """At rest at zero."""
        self.random = random
        self.length, time = random.decades(-4, 2), random.decades(-2, 1)
        self.limits = random.limits(self.length, time, directional=True)
        self.state = State()

    def request(self, passed_at: float = 0.0) -> Request:
        """To anywhere."""
        away = self.random.sign() * self.length * self.random.decades(-2, 1)
        return Request("transition fast", 4, self.state, State(self.state.x + away, passed_at), self.limits)

    def abort(self, plan: Plan) -> None:
        """Follows the plan to any time of it, from where position counts anew."""
        self.state = plan.at(self.random.uniform(0, plan.duration))._replace(x=0.0)


def draw(size: int) -> list[Request]:
    """From moving states to rest."""
    random = Random(5)
    axes = [Axis(random) for _ in range(size)]
    for _ in range(ABORTS):
        passed = [random.choice((0.0, random.state(axis.limits).v)) for axis in axes]
        for axis, plan in zip(axes, ask([axis.request(v) for axis, v in zip(axes, passed)]), strict=True):
            axis.abort(plan)
    return [axis.request() for axis in axes]


def main() -> None:
    """Judges both settings."""
    requests = draw(sweep_size(300))
    plans = {effort: ask([replace(request, method=f"transition {effort}") for request in requests]) for effort in BARS}
    both = list(zip(*plans.values(), strict=True))
    optima = all_shortest([(pair, INTERVALS) for pair in both])
    # What the grid does to the optimum, of one in ten.
    finer = all_shortest([(pair, 2 * INTERVALS) for pair in both[::10]])
    grid = [abs(fine / coarse - 1) for fine, coarse in zip(finer, optima[::10], strict=True)]

    print(f"order 4 from {len(requests)} moving states, duration above that of the linear program")
    print(f"{'':8} {'least':>9} {'median':>9} {'90 %':>9} {'99 %':>9} {'largest':>9} {'defect':>9}")
    wrong = []
    for effort, bars in BARS.items():
        above = [plan.duration / optimum - 1 for plan, optimum in zip(plans[effort], optima, strict=True)]
        defects = [plan.defect() for plan in plans[effort]]
        columns = " ".join(f"{value:9.1e}" for value in [*np.percentile(above, (0, 50, 90, 99, 100)), max(defects)])
        print(f"{effort:8} {columns}")
        slowest, worst = (plans[effort][int(np.argmax(of))] for of in (above, defects))
        for percent, bar in bars.items():
            found = np.percentile(above, percent)
            if found > bar:
                wrong.append(f"`{effort}` is {found:.1e} above the optimum at {percent} %, at most {bar} is allowed")
                wrong.append(f"the worst, {max(above):.1e} above: {slowest.request} takes {slowest.duration} s")
        if max(defects) > DEFECT:
            wrong.append(f"{worst.request} is {max(defects):.1e} beyond its limits or beside its target")
    print(f"a grid twice as fine changes the optimum by {np.median(grid):.1e} in the median, {max(grid):.1e} at most")
    if np.median(grid) > 1e-7 or max(grid) > 2e-4:
        wrong.append("the grid is too coarse for the bars")
    if wrong:
        raise SystemExit("\n".join(wrong))


if __name__ == "__main__":
    main()
