"""A load that is an FMU: a mass on a spring and a damper, of which the program sees only a force."""

import subprocess
import zipfile
from pathlib import Path

from verdict_classes.case import Tree

from machine import Axis

SOURCE = Path(__file__).resolve().parents[2] / "crates" / "engine-fmu" / "tests" / "native" / "oscillator"
"""Of the FMUs of two masses, with which the coupling is tested."""
FILE = "spring.fmu"


def build(folder: Path) -> None:
    """Compiles and packs the FMU into a folder."""
    library = folder / "spring.so"
    command = ["cc", "-O2", "-shared", "-fPIC", "-DSPRING", "-o", library, SOURCE / "oscillator.c", "-lm"]
    subprocess.run(command, check=True)
    with zipfile.ZipFile(folder / FILE, "w", zipfile.ZIP_DEFLATED) as archive:
        archive.write(SOURCE / "spring.xml", "modelDescription.xml")
        archive.write(library, "binaries/linux64/spring.so")
    library.unlink()


def can_be(axis: Axis) -> bool:
    """Whether its load can be one: it stands at rest by itself, and nothing measures it."""
    return axis.load is not None and not axis.from_load


def tables(axis: Axis) -> Tree:
    """`[[fmu]]` and `[coupling]` of its load."""
    load = axis.load
    parameters = {"m": load.inertia, "c": axis.stiffness, "d": axis.damping}
    fmu: Tree = {"name": "payload", "file": FILE, "isolation": "none", "parameters": parameters}
    fmu |= {"inputs": {"x1": "load.position", "v1": "load.velocity"}, "outputs": {"f": "disturbance.load"}}
    return {"fmu": [fmu], "coupling": {"extrapolation": 1}}
