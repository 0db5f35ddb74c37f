"""A signal source: its form is a text, its seed an integer, and it reads a file of its resources."""

import math
from pathlib import Path

from pythonfmu import Fmi2Causality, Fmi2Slave, Fmi2Variability, Integer, Real, String


class Source(Fmi2Slave):
    """Sine, square or saw, and numbers of a congruential generator on top."""

    def __init__(self, **kwargs):
        super().__init__(**kwargs)
        self.form, self.amplitude, self.frequency, self.seed, self.y, self.draws = "sine", 1.0, 2.0, 1, 0.0, 0
        self.gain = 1.0
        fixed = {"causality": Fmi2Causality.parameter, "variability": Fmi2Variability.fixed}
        self.register_variable(String("form", **fixed))
        self.register_variable(Real("amplitude", **fixed))
        self.register_variable(Real("frequency", **fixed))
        self.register_variable(Integer("seed", **fixed))
        self.register_variable(Real("y", causality=Fmi2Causality.output))
        self.register_variable(Integer("draws", causality=Fmi2Causality.output, variability=Fmi2Variability.discrete))

    def exit_initialization_mode(self):
        """The factor is in a file."""
        self.gain = float((Path(self.resources) / "gain.txt").read_text(encoding="utf-8"))

    def do_step(self, time, step):
        """The value at the end of the step."""
        phase = self.frequency * (time + step) % 1.0
        wave = {"sine": math.sin(2 * math.pi * phase), "square": math.copysign(1, 0.5 - phase), "saw": 2 * phase - 1}
        self.seed = (1103515245 * self.seed + 12345) % 2**31
        self.draws += 1
        self.y = self.gain * self.amplitude * wave[self.form] + 1e-3 * self.seed / 2**31
        return True
