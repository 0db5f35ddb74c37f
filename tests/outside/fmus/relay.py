"""A relay with hysteresis: booleans both ways, a tunable parameter that is set as an input."""

from pythonfmu import Boolean, Fmi2Causality, Fmi2Slave, Fmi2Variability, Real


class Relay(Fmi2Slave):
    """On above `high`, off below `low`, off while not enabled."""

    def __init__(self, **kwargs):
        super().__init__(**kwargs)
        self.u, self.enable, self.high, self.low, self.on = 0.0, True, 0.5, -0.5, False
        discrete = {"variability": Fmi2Variability.discrete}
        self.register_variable(Real("u", causality=Fmi2Causality.input))
        self.register_variable(Boolean("enable", causality=Fmi2Causality.input, **discrete))
        for name in ("high", "low"):
            self.register_variable(Real(name, causality=Fmi2Causality.parameter, variability=Fmi2Variability.tunable))
        self.register_variable(Boolean("on", causality=Fmi2Causality.output, **discrete))

    def do_step(self, _time, _step):
        """Switches."""
        if self.u > self.high:
            self.on = True
        elif self.u < self.low:
            self.on = False
        self.on = self.on and self.enable
        return True
