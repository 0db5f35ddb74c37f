"""A ball that bounces: events within a communication step, an integer output, start values of states."""

from pythonfmu import Fmi2Causality, Fmi2Initial, Fmi2Slave, Fmi2Variability, Integer, Real


class BouncingBall(Fmi2Slave):
    """x'' = -g; at x = 0 the velocity is turned and multiplied by e."""

    def __init__(self, **kwargs):
        super().__init__(**kwargs)
        self.x, self.v, self.e, self.bounces = 1.0, 0.0, 0.7, 0
        exact = {"initial": Fmi2Initial.exact}
        self.register_variable(Real("x", causality=Fmi2Causality.output, **exact))
        self.register_variable(Real("v", causality=Fmi2Causality.output, **exact))
        self.register_variable(Real("e", causality=Fmi2Causality.parameter, variability=Fmi2Variability.tunable))
        self.register_variable(Integer("bounces", causality=Fmi2Causality.output, variability=Fmi2Variability.discrete))

    def do_step(self, _time, step):
        """Exact between bounces."""
        g = 9.81
        while True:
            to_ground = (self.v + (self.v * self.v + 2 * g * max(self.x, 0.0)) ** 0.5) / g
            part = min(step, to_ground)
            self.x += self.v * part - g * part * part / 2
            self.v -= g * part
            step -= part
            if step <= 0 or self.bounces > 50:
                return True
            self.x, self.v, self.bounces = 0.0, -self.e * self.v, self.bounces + 1
