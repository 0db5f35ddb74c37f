"""Two masses and a shaft with units of its own: FMI 3.0, a state that can be saved."""

from pythonfmu3 import Float64, Fmi3Causality, Fmi3Initial, Fmi3Slave, Fmi3Variability, Unit


class TwoMasses(Fmi3Slave):
    """j·a'' = t - s, l·b'' = s with s = c·(a - b) + d·(a' - b'), semi-implicit Euler with steps of 0.1 ms."""

    def __init__(self, **kwargs):
        super().__init__(**kwargs)
        self.time = 0.0
        self.j, self.l, self.c, self.d = 1e-3, 2e-3, 300.0, 0.01
        self.torque, self.a, self.b, self.va, self.vb = 0.0, 0.0, 0.0, 0.0, 0.0
        self.register_units([Unit("N.m", kg=1, m=2, s=-2), Unit("rad", rad=1)])
        continuous = {"variability": Fmi3Variability.continuous}
        self.register_variable(Float64("time", causality=Fmi3Causality.independent, **continuous))
        for name in "jlcd":
            self.register_variable(Float64(name, causality=Fmi3Causality.parameter, variability=Fmi3Variability.fixed))
        self.register_variable(Float64("torque", causality=Fmi3Causality.input, unit="N.m", **continuous))
        for name in ("a", "b"):
            self.register_variable(
                Float64(name, causality=Fmi3Causality.output, initial=Fmi3Initial.exact, unit="rad", **continuous)
            )
        for name in ("va", "vb"):
            self.register_variable(Float64(name, causality=Fmi3Causality.local, **continuous))

    def do_step(self, _time, step):
        """Steps of equal length."""
        parts = max(1, round(step / 1e-4))
        h = step / parts
        for _ in range(parts):
            shaft = self.c * (self.a - self.b) + self.d * (self.va - self.vb)
            self.va += h * (self.torque - shaft) / self.j
            self.vb += h * shaft / self.l
            self.a += h * self.va
            self.b += h * self.vb
        return True
