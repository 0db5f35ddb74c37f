"""A machine whose mode is an enumeration and whose recipe is a text; it ends the simulation when it is done."""

from enum import Enum

from pythonfmu3 import (
    Boolean,
    Enumeration,
    EnumerationType,
    Float64,
    Fmi3Causality,
    Fmi3Slave,
    Fmi3StepResult,
    Fmi3Variability,
    Int32,
    String,
)


class Mode(Enum):
    """How fast it is."""

    IDLE = 1
    SLOW = 2
    FAST = 5


class Machine(Fmi3Slave):
    """Feeds with the rate of its mode; a recipe is the number of pieces and what is made."""

    def __init__(self, **kwargs):
        super().__init__(**kwargs)
        self.time = 0.0
        self.mode, self.state, self.recipe, self.run, self.way, self.pieces = 2, 1, "4 gears", True, 0.0, 0
        self.register_variable(
            Float64("time", causality=Fmi3Causality.independent, variability=Fmi3Variability.continuous)
        )
        discrete = {"variability": Fmi3Variability.discrete}
        mode_type = EnumerationType("Mode", values=Mode)
        fixed = {"causality": Fmi3Causality.parameter, "variability": Fmi3Variability.fixed}
        mode = Enumeration("mode", **fixed)
        state = Enumeration("state", causality=Fmi3Causality.output, **discrete)
        for variable in (mode, state):
            # PythonFMU3 0.3.4 asks for both and has neither.
            variable.dimensions, variable.size = [], lambda _variables: 1
            self.register_variable(variable, var_type=mode_type)
        self.register_variable(String("recipe", **fixed))
        self.register_variable(Boolean("run", causality=Fmi3Causality.input, **discrete))
        self.register_variable(
            Float64("way", causality=Fmi3Causality.output, variability=Fmi3Variability.continuous)
        )
        self.register_variable(Int32("pieces", causality=Fmi3Causality.output, **discrete))

    def do_step(self, _time, step):
        """A piece is made on each unit of the way."""
        self.state = self.mode if self.run else 1
        self.way += step * {1: 0.0, 2: 1.0, 5: 4.0}[self.state]
        self.pieces = int(self.way)
        is_done = self.pieces >= int(self.recipe.split()[0])
        return Fmi3StepResult(terminateSimulation=is_done)
