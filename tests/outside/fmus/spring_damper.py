"""A mass on a spring and a damper: an input, parameters, a state that can be saved."""

from pythonfmu import Fmi2Causality, Fmi2Slave, Fmi2Variability, Real


class SpringDamper(Fmi2Slave):
    """m·x'' = f - k·x - d·x', semi-implicit Euler with steps of at most 1 ms."""

    def __init__(self, **kwargs):
        super().__init__(**kwargs)
        self.m, self.k, self.d, self.f, self.x, self.v = 2.0, 50.0, 1.5, 0.0, 0.0, 0.0
        for name in "mkd":
            self.register_variable(Real(name, causality=Fmi2Causality.parameter, variability=Fmi2Variability.fixed))
        self.register_variable(Real("f", causality=Fmi2Causality.input))
        for name in "xv":
            self.register_variable(Real(name, causality=Fmi2Causality.output))

    def do_step(self, _time, step):
        """Steps of equal length."""
        parts = max(1, round(step / 1e-3))
        for _ in range(parts):
            self.v += step / parts * (self.f - self.k * self.x - self.d * self.v) / self.m
            self.x += step / parts * self.v
        return True
