"""Arrays of every type that PythonFMU3 has, in and out."""

import numpy as np
from pythonfmu3 import (
    Boolean,
    Dimension,
    Float64,
    Fmi3Causality,
    Fmi3Slave,
    Fmi3Variability,
    Int32,
    Int64,
    UInt64,
)

KINDS = {"f": (Float64, np.float64), "i": (Int32, np.int32), "l": (Int64, np.int64), "u": (UInt64, np.uint64), "b": (Boolean, np.bool_)}


class Arrays(Fmi3Slave):
    """Running sums of what comes in; flags go from one element to the next; a matrix is multiplied by a vector."""

    def __init__(self, **kwargs):
        super().__init__(**kwargs)
        self.time = 0.0
        three = [Dimension(start="3")]
        ports = {"in": Fmi3Causality.input, "out": Fmi3Causality.output}
        self.register_variable(
            Float64("time", causality=Fmi3Causality.independent, variability=Fmi3Variability.continuous)
        )
        for end, causality in ports.items():
            for name, (kind, number) in KINDS.items():
                is_real = kind is Float64
                variability = Fmi3Variability.continuous if is_real else Fmi3Variability.discrete
                setattr(self, name + end, np.zeros(3, dtype=number))
                setter = self.setter(name + end, (3,), number)
                self.register_variable(
                    kind(name + end, causality=causality, variability=variability, dimensions=three, setter=setter)
                )
        self.matrix, self.product = np.array([[1.0, 2.0, 3.0], [4.0, 5.0, 6.0]]), np.zeros(2)
        two = [Dimension(start="2")]
        fixed = Fmi3Variability.fixed
        self.register_variable(
            Float64(
                "matrix",
                causality=Fmi3Causality.parameter,
                variability=fixed,
                dimensions=two + three,
                setter=self.setter("matrix", (2, 3), np.float64),
            )
        )
        self.register_variable(
            Float64("product", causality=Fmi3Causality.output, variability=Fmi3Variability.continuous, dimensions=two)
        )

    def setter(self, name, shape, number):
        """That of PythonFMU3 0.3.4 calls numpy in a way that numpy no longer has."""
        return lambda values: setattr(self, name, np.array(values, dtype=number).reshape(shape))

    def do_step(self, _time, _step):
        """Adds up."""
        for name in "filu":
            setattr(self, name + "out", getattr(self, name + "out") + getattr(self, name + "in"))
        self.bout = np.roll(self.bin, 1)
        self.product = self.matrix @ self.fin
        return True
