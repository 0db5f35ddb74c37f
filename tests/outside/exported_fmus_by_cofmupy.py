"""Exported FMUs coupled by CoFMPy: drive and mechanics in a loop, and an axis that is pushed.

Each is held, to the bit, against what exchanges the same numbers at the same times:
- Gauss-Seidel, the drive first: a run of the scenario, which is that loop;
- Jacobi: a run in which the drive is an FMU beside our mechanics, exchanged by our own Jacobi of order 0;
- an axis with a force on its load from a table: a run with that disturbance;
- each of these loops, the other order of Gauss-Seidel, and both methods iterated with saved states: FMPy, called here.
"""

import io
import json
import sys
import tempfile
from contextlib import redirect_stdout
from dataclasses import dataclass
from pathlib import Path
from unittest.mock import MagicMock

import fmpy
import numpy
from fmpy.fmi2 import FMU2Slave
from fmpy.fmi3 import FMU3Slave

from exports import MEASURED, ROOT, example, library, recorded

# CoFMPy loads them when it is loaded, to draw a coupling and to listen to Kafka, which nobody asks it for here.
for module in ("confluent_kafka", "matplotlib", "matplotlib.colors", "matplotlib.pyplot", "plotly", "plotly.graph_objects"):
    sys.modules[module] = MagicMock(name=module)
from cofmupy import Coordinator  # noqa: E402

SCENARIO = "scenarios/demo/jerk.toml"
# An eighth of a second: the jerk-limited start of the move, and some of its acceleration.
TICKS = 2_000
# CoFMPy's for an iteration: the difference between an input and its output, each in its own unit, and the number of steps.
AGREES, MOST = 1e-3, 10
# CoFMPy sets every input before the first step, to zero unless it is told otherwise.
START = {"start": True, "override": 1.0}
LINKS = [("drive", "effort.motor", "mechanics"), *(("mechanics", name, "drive") for name in MEASURED)]
# The drive as an FMU in a scenario of ours; CoFMPy begins a loop with zero everywhere, as the axis does here.
COUPLED = f"""
[[fmu]]
file = "drive3.fmu"
isolation = "none"
inputs = {{ {", ".join(f'"{name}" = "{name}"' for name in MEASURED)} }}
outputs = {{ "effort.motor" = "effort.motor" }}

[coupling]
method = "jacobi"
"""
# From the middle between two ticks on, so that no rounding of the time decides.
PUSH, PUSHED_AT = 50.0, 800.5 / 16_000.0
PUSHED = f"""
[[disturbance]]
on = "load"
start = "{PUSHED_AT} s"
force = "{PUSH} N"
"""
BODIES = ("motor.", "table.", "load.")

Rows = dict[tuple[str, str], numpy.ndarray]


@dataclass(frozen=True)
class Loop:
    """Drive and mechanics, by the version of their FMUs, and how they exchange."""

    method: str
    mechanics: int = 3
    order: tuple[str, str] = ("drive", "mechanics")
    is_iterated: bool = False

    def version(self, part: str) -> int:
        """CoFMPy sets inputs of FMI 2.0 as Reals alone, and `start` of the drive is a Boolean."""
        return self.mechanics if part == "mechanics" else 3

    def __str__(self) -> str:
        iterated = ", iterated" if self.is_iterated else ""
        return f"{self.method}, {self.order[0]} first, mechanics FMI {self.mechanics}{iterated}"


def by_cofmupy(configuration: dict, folder: Path, rate: int, order: tuple[str, ...]) -> Rows:
    """Every output after every step."""
    path = folder / "coupling.json"
    path.write_text(json.dumps(configuration))
    with redirect_stdout(io.StringIO()):
        coordinator = Coordinator()
        coordinator.start(str(path))
        # It takes the order within a loop out of a set of names, which changes from process to process.
        coordinator.master.sequence_order = [list(order)]
        for _ in range(TICKS):
            coordinator.do_step(1.0 / rate)
    results = coordinator.get_results()
    return {name: numpy.array(values) for name, values in results.items() if name != "time"}


def coupled_by_cofmupy(loop: Loop, folder: Path, rate: int) -> Rows:
    """The loop as a file of CoFMPy's."""
    parts = ("drive", "mechanics")
    configuration = {
        "cosim_method": loop.method,
        "iterative": loop.is_iterated,
        "fmus": [
            {
                "id": part,
                "path": str(folder / f"{part}{loop.version(part)}.fmu"),
                "initialization": START if part == "drive" else {},
            }
            for part in parts
        ],
        "connections": [
            {"source": {"id": source, "variable": name}, "target": {"id": target, "variable": name}}
            for source, name, target in LINKS
        ],
    }
    return by_cofmupy(configuration, folder, rate, loop.order)


def pushed_by_cofmupy(folder: Path, rate: int) -> Rows:
    """The axis with a force that it is given from a table."""
    (folder / "push.csv").write_text(f"t,push\n0,0\n{PUSHED_AT},{PUSH}\n")
    source = {"type": "csv", "path": str(folder / "push.csv"), "variable": "push", "interpolation": "previous"}
    configuration = {
        "fmus": [{"id": "axis", "path": str(folder / "axis3.fmu"), "initialization": START}],
        "connections": [{"source": source, "target": [{"id": "axis", "variable": "force.load"}]}],
    }
    return by_cofmupy(configuration, folder, rate, ("axis",))


class Instance:
    """An FMU that is called by FMPy."""

    def __init__(self, path: Path, inputs: dict[str, float | bool]) -> None:
        description = fmpy.read_model_description(str(path))
        self.variables = {variable.name: variable for variable in description.modelVariables}
        self.outputs = [name for name, variable in self.variables.items() if variable.causality == "output"]
        self.inputs = inputs
        self.is_two = description.fmiVersion == "2.0"
        self.fmu = (FMU2Slave if self.is_two else FMU3Slave)(
            guid=description.guid,
            unzipDirectory=fmpy.extract(str(path)),
            modelIdentifier=description.coSimulation.modelIdentifier,
            instanceName=path.stem,
        )
        self.fmu.instantiate()
        if self.is_two:
            self.fmu.setupExperiment(startTime=0.0)
        self.fmu.enterInitializationMode()
        self.fmu.exitInitializationMode()

    def step(self, tick: int, rate: int) -> dict[str, float]:
        """Goes from a tick to the next one with the inputs as they are; the outputs there."""
        for name, value in self.inputs.items():
            kind = self.variables[name].type
            getattr(self.fmu, f"set{kind}")([self.variables[name].valueReference], [value])
        self.fmu.doStep(currentCommunicationPoint=tick / rate, communicationStepSize=1.0 / rate)
        references = [self.variables[name].valueReference for name in self.outputs]
        values = self.fmu.getReal(references) if self.is_two else self.fmu.getFloat64(references)
        return dict(zip(self.outputs, values))


def coupled_by_fmpy(loop: Loop, folder: Path, rate: int) -> Rows:
    """The same exchange by hand."""
    inputs = {"drive": {name: 0.0 for name in MEASURED} | START, "mechanics": {"effort.motor": 0.0}}
    parts = {part: Instance(folder / f"{part}{loop.version(part)}.fmu", inputs[part]) for part in loop.order}
    rows: dict[tuple[str, str], list[float]] = {
        (part, name): [] for part, instance in parts.items() for name in instance.outputs
    }

    def hand_on(part: str, outputs: dict[str, float]) -> None:
        for source, name, target in LINKS:
            if source == part:
                inputs[target][name] = outputs[name]

    def once(tick: int) -> dict[str, dict[str, float]]:
        outputs = {}
        for part, instance in parts.items():
            outputs[part] = instance.step(tick, rate)
            if loop.method == "gauss_seidel":
                hand_on(part, outputs[part])
        for part in parts:
            hand_on(part, outputs[part])
        return outputs

    for tick in range(TICKS):
        states = {part: instance.fmu.getFMUState() for part, instance in parts.items()} if loop.is_iterated else {}
        for attempt in range(MOST):
            before = {part: dict(held) for part, held in inputs.items()}
            if attempt > 0:
                for part, state in states.items():
                    parts[part].fmu.setFMUState(state)
            outputs = once(tick)
            if not loop.is_iterated:
                break
            if all(abs(before[to][name] - outputs[source][name]) < AGREES for source, name, to in LINKS):
                break
        for part, state in states.items():
            parts[part].fmu.freeFMUState(state)
        for part, values in outputs.items():
            for name, value in values.items():
                rows[part, name].append(value)
    for instance in parts.values():
        instance.fmu.terminate()
        instance.fmu.freeInstance()
    return {name: numpy.array(values) for name, values in rows.items()}


def same(what: str, found: numpy.ndarray, wanted: numpy.ndarray) -> int:
    """Compares to the bit; how many numbers."""
    if found.shape != wanted.shape:
        raise SystemExit(f"{what}: {found.shape} numbers instead of {wanted.shape}")
    if len(wrong := numpy.flatnonzero(found.view(numpy.uint64) != wanted.view(numpy.uint64))):
        at = wrong[0]
        raise SystemExit(f"{what} differs after step {at}: {found[at]!r}, expected {wanted[at]!r}")
    return len(found)


def same_rows(what: str, found: Rows, wanted: Rows) -> int:
    """Compares all outputs."""
    if found.keys() != wanted.keys():
        raise SystemExit(f"{what}: outputs {found.keys() ^ wanted.keys()} are on one side alone")
    return sum(same(f"{what}: {name}", values, wanted[name]) for name, values in found.items())


def same_as_run(what: str, found: Rows, channels: dict[str, numpy.ndarray]) -> int:
    """Compares with a recording: bodies are where they are at the end of a step, everything else is of the tick that has ended."""
    count = 0
    for (_, name), values in found.items():
        if name in channels:
            first = 1 if name.startswith(BODIES) else 0
            count += same(f"{what}: {name}", values, channels[name][first : first + TICKS])
    return count


def same_as_coupled_run(what: str, found: Rows, channels: dict[str, numpy.ndarray]) -> int:
    """Compares with the recording of a run whose drive is an FMU: it has no channels of the drive but the effort, and that as it
    acts, a step later.
    """
    bodies = {name: values for name, values in found.items() if name[1].startswith(BODIES)}
    late = same(f"{what}: effort", found["drive", "effort.motor"][:-1], channels["effort.motor"][1:TICKS])
    return late + same_as_run(what, bodies, channels)


def check(folder: Path) -> None:
    """Exports, couples and compares."""
    inside = library()
    for part, version in (("axis", 3), ("drive", 3), ("mechanics", 2), ("mechanics", 3)):
        example("export_fmu", SCENARIO, str(version), part, inside, str(folder / f"{part}{version}.fmu"))
    text = (ROOT / SCENARIO).read_text()
    runs = {}
    for name, more in (("alone", ""), ("coupled", COUPLED), ("pushed", PUSHED)):
        (folder / f"{name}.toml").write_text(text + more)
        rate, runs[name] = recorded(str(folder / f"{name}.toml"))

    equal = same_as_run("pushed axis", pushed_by_cofmupy(folder, rate), runs["pushed"])
    print(f"{'axis, pushed from a table':<58} values equal to the bit: {equal:6} to a run with the disturbance")
    for mechanics in (2, 3):
        loop = Loop("gauss_seidel", mechanics)
        rows = coupled_by_cofmupy(loop, folder, rate)
        report(loop, same_as_run(str(loop), rows, runs["alone"]), "to a run of the axis", rows, folder, rate)
        loop = Loop("jacobi", mechanics)
        rows = coupled_by_cofmupy(loop, folder, rate)
        equal = same_as_coupled_run(str(loop), rows, runs["coupled"])
        report(loop, equal, "to our own Jacobi", rows, folder, rate)
    # CoFMPy 1.0 calls functions of FMI 3.0 alone for states.
    others = (
        Loop("gauss_seidel", order=("mechanics", "drive")),
        Loop("gauss_seidel", is_iterated=True),
        Loop("jacobi", is_iterated=True),
    )
    for loop in others:
        report(loop, 0, "", coupled_by_cofmupy(loop, folder, rate), folder, rate)


def report(loop: Loop, equal: int, to: str, rows: Rows, folder: Path, rate: int) -> None:
    """Compares a loop with FMPy, and prints a line."""
    ours = f"{equal:6} {to}, " if equal else ""
    by_hand = same_rows(str(loop), rows, coupled_by_fmpy(loop, folder, rate))
    print(f"{loop!s:<58} values equal to the bit: {ours}{by_hand:6} to FMPy")


def main() -> None:
    with tempfile.TemporaryDirectory() as room:
        # CoFMPy leaves what it unpacks.
        tempfile.tempdir = room
        check(Path(room))


if __name__ == "__main__":
    main()
