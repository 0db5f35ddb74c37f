"""FMUs that others made, simulated by the crate `fmi` and by FMPy.

Seven are built here by PythonFMU and PythonFMU3 out of `fmus/`, seven were made by OpenModelica and PythonFMU3 and come with the
package `gemseo-fmu`. For each one
- what is read of every variable in the description is what FMPy reads;
- every output after every step is FMPy's within 1e-9, with inputs that change from step to step; in two of them also after going
  ahead and back to a saved state.
"""

import io
import json
import math
import os
import subprocess
import sysconfig
import tempfile
from collections.abc import Callable
from contextlib import redirect_stdout
from dataclasses import dataclass, field
from importlib.util import find_spec
from pathlib import Path
from typing import Any

import fmpy
import numpy as np
from pythonfmu import FmuBuilder as Builder2
from pythonfmu3 import FmuBuilder as Builder3

ROOT = Path(__file__).resolve().parents[2]
MODELS = Path(__file__).parent / "fmus"
# Both call the same library in the same order. FMPy interpolates its inputs, which costs roundings of 1e-16.
BAR = 1e-9

Signal = Callable[[float], Any]


@dataclass
class Case:
    """One FMU and what is done with it."""

    name: str
    outputs: list[str]
    step: float
    steps: int
    start: dict[str, Any] = field(default_factory=dict)
    inputs: dict[str, Signal] = field(default_factory=dict)
    build: Any = None
    options: dict[str, Any] = field(default_factory=dict)
    files: dict[str, str] = field(default_factory=dict)
    rewind: tuple[int, int] | None = None


def cases() -> list[Case]:
    """Those that are built here, then those that come with the package."""
    sine, ramp = (lambda t: math.sin(9 * t)), (lambda t: t)
    # FMPy 0.3.32 takes arrays as inputs if they are real numbers.
    constant = {"iin": [-1, 2, 3], "lin": [4, -5, 6], "uin": [7, 8, 9], "bin": [True, False, True]}
    return [
        Case("bouncing_ball", ["x", "v", "bounces"], 0.05, 60, {"e": 0.8, "x": 2.0}, build=Builder2),
        Case(
            "spring_damper",
            ["x", "v"],
            0.01,
            200,
            {"k": 80.0},
            {"f": sine},
            Builder2,
            {"canGetAndSetFMUstate": True},
            rewind=(50, 7),
        ),
        Case(
            "relay",
            ["on"],
            0.02,
            100,
            {"low": -0.25},
            {"u": sine, "enable": lambda t: not 0.4 < t < 0.9, "high": lambda t: 0.5 if t < 1.0 else 0.9},
            Builder2,
        ),
        Case("source", ["y", "draws"], 0.01, 100, {"form": "saw", "seed": 42}, build=Builder2, files={"gain.txt": "1.25"}),
        Case(
            "two_masses",
            ["a", "b", "va", "vb"],
            0.001,
            300,
            {"j": 2e-3},
            {"torque": sine},
            Builder3,
            {"canGetAndSetFMUState": True},
            rewind=(20, 11),
        ),
        Case(
            "arrays",
            ["fout", "iout", "lout", "uout", "bout", "product"],
            0.1,
            30,
            {"matrix": [1.0, 2.0, 3.0, 4.0, 5.0, 7.0]} | constant,
            {"fin": lambda t: np.array([t, 1.0 - t, 2.0])},
            Builder3,
        ),
        Case(
            "machine",
            ["way", "state", "pieces"],
            0.1,
            100,
            {"mode": "FAST", "recipe": "6 gears"},
            {"run": lambda t: not 0.3 < t < 0.7},
            Builder3,
        ),
        Case("ramp", ["out"], 0.1, 20),
        Case("add", ["y"], 0.1, 20, inputs={"u1": sine, "u2": ramp}),
        Case("Mass_Damper", ["y"], 0.01, 20),
        Case("MassSpringSystem", ["x1", "x2", "v1", "v2"], 0.01, 200),
        Case("MassSpringSubSystem1", ["x1", "v1"], 0.01, 200, inputs={"x2": sine}),
        Case("MassSpringSubSystem2", ["x2", "v2"], 0.01, 200, inputs={"x1": sine}),
        Case("FMU3Model", ["output", "vector"], 0.1, 20),
    ]


def file_of(case: Case, folder: Path) -> Path:
    """The FMU: built, or one that comes with the package."""
    if case.build is None:
        spec = find_spec("gemseo_fmu")
        if spec is None or spec.origin is None:
            raise SystemExit("the package `gemseo-fmu` is not installed")
        return Path(spec.origin).parent / "problems" / "fmu_files" / "linux" / f"{case.name}.fmu"
    files = [folder / name for name in case.files]
    for path in files:
        path.write_text(case.files[path.name], encoding="utf-8")
    return Path(case.build.build_FMU(MODELS / f"{case.name}.py", dest=folder, project_files=files, **case.options))


def elements(name: str, shape: tuple[int, ...]) -> list[Any]:
    """How our program names the elements of a variable."""
    return [[name, element] for element in range(math.prod(shape))] if shape else [name]


def flat(values: Any) -> list[float]:
    """The numbers of a scalar or an array."""
    return [float(value) for value in np.asarray(values).flatten()]


class Ours:
    """The example `simulate` with what FMUs of Python need: its library and its packages."""

    def __init__(self) -> None:
        build = ["cargo", "build", "--release", "--package", "servobench-fmi", "--example", "simulate"]
        messages = subprocess.run(
            [*build, "--message-format=json"], cwd=ROOT, stdout=subprocess.PIPE, text=True, check=True
        ).stdout
        found = [json.loads(line).get("executable") for line in messages.splitlines()]
        self.program = next(path for path in found if path)
        variables = sysconfig.get_config_vars()
        library = Path(variables["LIBDIR"]) / variables["INSTSONAME"]
        if not library.is_file():
            raise SystemExit(f"{library} is not there: FMUs of Python need a Python that is a shared library")
        packages = sysconfig.get_paths()["purelib"]
        self.environment = os.environ | {"LD_PRELOAD": str(library), "PYTHONPATH": packages}

    def simulate(self, case: Case, fmu: Path, description: Any) -> dict[str, Any]:
        """Rows of time and outputs, and what is read of the variables."""
        shapes = {variable.name: variable.shape or () for variable in description.modelVariables}
        times = [at * case.step for at in range(case.steps + 1)]
        rows = [[[value, 0.0, 0.0] for signal in case.inputs.values() for value in flat(signal(t))] for t in times]
        request = {
            "fmu": str(fmu),
            "start": case.start,
            "inputs": [port for name in case.inputs for port in elements(name, shapes[name])],
            "outputs": [port for name in case.outputs for port in elements(name, shapes[name])],
            "step": case.step,
            "steps": case.steps,
            "values": rows,
            "rewind": case.rewind,
        }
        done = subprocess.run(
            [self.program], input=json.dumps(request), env=self.environment, capture_output=True, text=True, check=False
        )
        if done.returncode != 0:
            raise SystemExit(f"{case.name}: {done.stderr[-2000:]}")
        # An FMU may print what it likes before.
        return dict(json.loads(done.stdout.splitlines()[-1]))


def theirs(case: Case, fmu: Path, description: Any) -> list[list[float]]:
    """The same rows by FMPy."""
    variables = {variable.name: variable for variable in description.modelVariables}
    inputs = None
    if case.inputs:
        kinds = {"Real": float, "Float64": float, "Boolean": bool}
        dtype = [("time", float)] + [
            (name, kinds.get(variables[name].type, np.int64), variables[name].shape or ()) for name in case.inputs
        ]
        times = [at * case.step for at in range(case.steps + 1)]
        inputs = np.array([(t, *(signal(t) for signal in case.inputs.values())) for t in times], dtype=dtype)
    start = dict(case.start)
    for name, value in start.items():
        declared = variables[name].declaredType
        items = {item.name: int(item.value) for item in declared.items} if declared and declared.items else {}
        start[name] = items.get(value, value) if isinstance(value, str) else value
    # It warns of inputs that are not given.
    with redirect_stdout(io.StringIO()):
        result = fmpy.simulate_fmu(
            str(fmu),
            fmi_type="CoSimulation",
            validate=False,
            stop_time=case.step * case.steps,
            step_size=case.step,
            output_interval=case.step,
            start_values=start,
            input=inputs,
            output=case.outputs,
            set_stop_time=False,
        )
    return [[row["time"], *(value for name in case.outputs for value in flat(row[name]))] for row in result]


TYPES = {"Real": "Float64", "Integer": "Int32"}


def check_variables(case: Case, ours: list[dict[str, Any]], description: Any) -> int:
    """Every variable is what FMPy reads."""

    def number(text: str | None) -> float | None:
        return None if text is None else float(text)

    for mine, variable in zip(ours, description.modelVariables, strict=True):
        declared = variable.declaredType
        expected = {
            "name": variable.name,
            "reference": variable.valueReference,
            "type": TYPES.get(variable.type, variable.type),
            "causality": variable.causality,
            "variability": variable.variability,
            "initial": variable.initial,
            "shape": list(variable.shape or ()),
            "unit": variable.unit or getattr(declared, "unit", None),
            "min": number(variable.min or getattr(declared, "min", None)),
            "max": number(variable.max or getattr(declared, "max", None)),
            "derivative_of": getattr(variable.derivative, "name", None) if case.build is not Builder3 else None,
        }
        if mine != expected:
            raise SystemExit(f"{case.name}: {mine} is {expected} by FMPy")
    return len(ours)


def check_rows(case: Case, ours: list[list[float]], expected: list[list[float]]) -> float:
    """The largest difference."""
    if len(ours) != len(expected):
        raise SystemExit(f"{case.name}: {len(ours)} rows, {len(expected)} by FMPy")
    largest = 0.0
    for mine, row in zip(ours, expected, strict=True):
        for value, other in zip(mine, row, strict=True):
            difference = abs(value - other) / max(1.0, abs(other))
            largest = max(largest, difference)
            if not difference <= BAR:
                raise SystemExit(f"{case.name}: {mine} is {row} by FMPy")
    numbers = np.array(expected)[:, 1:]
    if len(expected) < 2 or not np.any(numbers != numbers[0]):
        raise SystemExit(f"{case.name}: nothing happens")
    return largest


def main() -> None:
    """Runs every case."""
    ours = Ours()
    print("FMUs of others, largest difference from FMPy")
    print(f"{'':24} {'FMI':>4} {'made by':32} {'variables':>9} {'rows':>5} {'difference':>10}")
    with tempfile.TemporaryDirectory() as folder:
        for case in cases():
            fmu = file_of(case, Path(folder))
            description = fmpy.read_model_description(str(fmu), validate=False)
            answer = ours.simulate(case, fmu, description)
            variables = check_variables(case, answer["variables"], description)
            largest = check_rows(case, answer["rows"], theirs(case, fmu, description))
            tool = description.generationTool.removeprefix("OpenModelica Compiler ")[:32]
            rows = len(answer["rows"])
            print(f"{case.name:24} {description.fmiVersion:>4} {tool:32} {variables:9} {rows:5} {largest:10.1e}")


if __name__ == "__main__":
    main()
