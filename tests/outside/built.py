"""The program `servobench` as cargo built it."""

import json
import os
import subprocess
import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]


def program() -> Path:
    """The program that is judged."""
    given = os.environ.get("SERVOBENCH")
    if given:
        return Path(given)
    command = ["cargo", "metadata", "--no-deps", "--format-version=1"]
    metadata = subprocess.run(command, cwd=ROOT, stdout=subprocess.PIPE, text=True, check=True).stdout
    built = Path(json.loads(metadata)["target_directory"]) / "release" / "servobench"
    if not built.exists():
        sys.exit(f"{built} is not there: build it (`cargo build --release -p servobench-cli`), or name another in SERVOBENCH")
    return built
