"""Exports FMUs, through the crate `servobench-fmu`, and records what its axis does without one."""

import csv
import subprocess
from pathlib import Path

import numpy

ROOT = Path(__file__).resolve().parents[2]
# What the drive measures of the mechanics.
MEASURED = ("shaft.position", "shaft.velocity", "load.position", "load.velocity")


def cargo(*arguments: str) -> str:
    """What a command of cargo prints."""
    command = ["cargo", *arguments]
    return subprocess.run(command, cwd=ROOT, stdout=subprocess.PIPE, text=True, check=True).stdout


def example(name: str, *arguments: str) -> str:
    """What an example of the crate `fmu` prints."""
    return cargo("run", "--quiet", "--release", "--package", "servobench-fmu", "--example", name, "--", *arguments)


def library() -> str:
    """The library inside the FMUs, built."""
    cargo("build", "--quiet", "--release", "--package", "servobench-fmu", "--lib")
    target = cargo("metadata", "--no-deps", "--format-version=1").split('"target_directory":"')[1].split('"')[0]
    return str(Path(target) / "release" / "libservobench_fmu.so")


def recorded(scenario: str) -> tuple[int, dict[str, numpy.ndarray]]:
    """The base rate in Hz, and what a run records at every tick."""
    rows = list(csv.reader(example("record", scenario).splitlines()))
    values = numpy.array([row[1:] for row in rows[1:]], dtype=float)
    return int(rows[0][0]), dict(zip(rows[0][1:], values.T))
