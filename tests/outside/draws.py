"""Random requests, the same in every run: limits of which each binds now and then, in any unit of length and of time."""

import os
import random

from plans import Limits, State


def sweep_size(usual: int) -> int:
    """Size of a random sweep: `SERVOBENCH_SWEEP` is 100 000 for the usual size, and scales it."""
    return max(1, usual * int(os.environ.get("SERVOBENCH_SWEEP", "100000")) // 100_000)


class Random(random.Random):
    """Seeded random numbers."""

    def decades(self, low: float, high: float) -> float:
        """Between 10^low and 10^high."""
        return float(10 ** self.uniform(low, high))

    def sign(self) -> float:
        """One or minus one."""
        return self.choice((-1.0, 1.0))

    def limits(self, length: float, time: float, *, directional: bool) -> Limits:
        """Limits of which each is around that of a move over `length` in about `time`, by most of a decade more or less."""
        v, a, jerk, snap = (length / time**n * self.decades(-0.7, 0.7) for n in (1, 2, 3, 4))
        if not directional:
            return Limits.both(v, a, jerk, snap)
        return Limits(v * self.uniform(0.7, 1.4), v, a * self.uniform(0.7, 1.4), a, jerk, snap)

    def within(self, below: float, above: float) -> float:
        """Between -below and above; now and then at one of them or at zero."""
        return self.choice((-below, 0.0, above)) if self.random() < 0.2 else self.uniform(-below, above)

    def state(self, limits: Limits) -> State:
        """At zero, with a velocity and an acceleration within the limits."""
        v = self.within(limits.v_below, limits.v_above)
        return State(0.0, v, self.within(limits.a_below, limits.a_above))
