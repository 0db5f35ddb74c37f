"""Verdicts of random scenarios against a judgement of our own: no bad run passes, no good one fails.

Six classes: gains around the boundary of stability, torque that is scarce or not, limits on metrics, programs of function
blocks, modulo axes, and faults. Of some scenarios hardly anything is recorded, which changes no verdict. What is bad, and which requirement of docs/requirements.md or which limit it breaks, is known from the
eigenvalues of a loop and from runs that are computed here (verdict_classes/loop.py), or from how the scenario was put together.
Nothing is judged within 2 % of a threshold: that is left out, and counted. At least a quarter of each class is good, and a
quarter bad.

The program is `SERVOBENCH`, or the one in the folder of cargo's builds (`cargo build --release`).
Size: 40 scenarios of each class, scaled by `SERVOBENCH_SWEEP`; `SERVOBENCH_SEED` draws others.
"""

import json
import os
import re
import shutil
import subprocess
import sys
import tempfile
import time
from collections import Counter
from collections.abc import Callable
from pathlib import Path

# Small matrices only: threads would cost more than they bring. Said before numpy is loaded.
os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")

from built import program
from draws import Random, sweep_size
from verdict_classes import blocks, faults, gains, limits, modulo, torque
from verdict_classes.case import Case, toml

SEED = int(os.environ.get("SERVOBENCH_SEED", "1"))
CLASSES: dict[str, Callable[[Random], Case | None]] = {
    "gains": gains.draw,
    "torque": torque.draw,
    "limits": limits.draw,
    "blocks": blocks.draw,
    "modulo": modulo.draw,
    "faults": faults.draw,
}
USUAL = 40
CHUNK = 100
"""So many scenarios are run at a time: their recordings are thrown away before the next are made."""
DRAWS = 200
"""So many draws are made for each scenario before a class gives up."""


def draw(name: str, size: int) -> tuple[list[Case], int]:
    """So many cases, at most three quarters of them good and as many bad, and how many were left out."""
    random, thinning = Random(f"{SEED} {name}"), Random(f"{SEED} {name} recorded")
    cases: list[Case] = []
    counts, left_out = Counter[bool](), 0
    most = size - max(1, size // 4) if size > 1 else 1
    for _ in range(DRAWS * size):
        if len(cases) == size:
            break
        case = CLASSES[name](random)
        if case is None:
            continue
        if case.is_near:
            left_out += 1
        elif counts[case.is_bad] < most:
            counts[case.is_bad] += 1
            thin_out(thinning, case)
            cases.append(case)
    assert len(cases) == size, f"{name}: {len(cases)} scenarios of {size} in {DRAWS * size} draws"
    return cases, left_out


def thin_out(random: Random, case: Case) -> None:
    """Now and then a row in a hundred ticks or so is kept, and of it one channel. A limit needs the channels of its metric."""
    if random.random() < 0.7:
        return
    base = int(case.tree["run"]["base_rate"].removesuffix(" Hz"))
    kept: dict[str, str] = {"rate": f"{random.choice([rate for rate in range(50, 400) if base % rate == 0])} Hz"}
    if "limits" not in case.tree:
        kept["channels"] = random.choice(("motor.position", "motor.velocity", "load.position", "setpoint.position"))
    case.tree["record"] = kept


def broken(run: dict) -> set[str]:
    """Requirements and limits that a run is said to break; `expected` is a fault that did not come."""
    heads = {re.split(r"[^a-z_]", reason, maxsplit=1)[0] for reason in run["reasons"]}
    if any("expected, but did not occur" in reason for reason in run["reasons"]):
        heads.add("expected")
    return heads | {name for name, of in run.get("requirements", {}).items() if of["standing"] in ("broken", "missed")}


def wrong(case: Case, run: dict | None) -> str | None:
    """What is wrong about the verdict, if anything."""
    if run is None:
        return "no result"
    verdict = run["verdict"]
    if verdict not in ("passed", "unjudged", "failed"):
        return "not run"
    if verdict != "failed":
        return "bad passes" if case.is_bad else None
    if not case.is_bad:
        return "good fails"
    found = broken(run)
    return None if case.breaks <= found <= case.breaks | case.may_break else "wrong reason"


def run(servobench: Path, folder: Path, cases: dict[str, Case]) -> dict[str, dict]:
    """The results by name."""
    folder.mkdir()
    for name, case in cases.items():
        (folder / f"{name}.toml").write_text(toml(case.tree))
    out = folder / "out"
    jobs = ["--jobs", os.environ["SERVOBENCH_JOBS"]] if "SERVOBENCH_JOBS" in os.environ else []
    command = [servobench, "run", folder, "--quiet", "--out", out, *jobs]
    said = subprocess.run(command, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True, check=False)
    if not (out / "results.json").exists():
        mistakes = [line for line in said.stderr.splitlines() if "×" in line or "mistake" in line]
        sys.exit("\n".join([f"no results of {folder}, exit code {said.returncode}:", *(mistakes or [said.stderr])]))
    results = json.loads((out / "results.json").read_text())["scenarios"]
    shutil.rmtree(out)
    return {Path(one["file"]).stem: one for one in results}


def main() -> int:
    """Draws, runs, compares; one if any verdict is wrong."""
    servobench, size = program(), sweep_size(USUAL)
    wanted = sys.argv[1:] or list(CLASSES)
    room = Path(tempfile.mkdtemp(prefix="servobench-verdicts-"))
    print(f"seed {SEED}, {size} scenarios of each class")
    head = ("class", "good", "bad", "left out", "bad passes", "good fails", "wrong reason", "not run", "drawn in", "run in")
    print("  ".join(head))
    total, lines, kinds = 0, [], {}
    for name in wanted:
        begun = time.monotonic()
        cases, left_out = draw(name, size)
        drawn = time.monotonic()
        by_name = {f"{name}-{number:04}": case for number, case in enumerate(cases)}
        counts, names = Counter[str](), list(by_name)
        for first in range(0, size, CHUNK):
            chunk = {one: by_name[one] for one in names[first : first + CHUNK]}
            folder = room / f"{name}-{first:04}"
            results = run(servobench, folder, chunk)
            for one, case in chunk.items():
                result = results.get(one)
                what = wrong(case, result)
                if what is None:
                    (folder / f"{one}.toml").unlink()
                    continue
                counts[what] += 1
                told = "" if result is None else f"{result['verdict']} {result['reasons']}"[:400]
                wants = f"breaks {', '.join(sorted(case.breaks))}" if case.is_bad else "good"
                lines.append(f"{what}: {folder / one}.toml\n    {wants}: {case.note}\n    {told}")
            if not list(folder.iterdir()):
                folder.rmdir()
        bad = sum(case.is_bad for case in cases)
        kinds[name] = Counter(what for case in cases for what in case.breaks)
        numbers = (size - bad, bad, left_out, *(counts[what] for what in head[4:7]), counts["not run"] + counts["no result"])
        times = (f"{drawn - begun:.1f} s", f"{time.monotonic() - drawn:.1f} s")
        print("  ".join(f"{value:>{len(title)}}" for title, value in zip(head, (name, *numbers, *times))), flush=True)
        total += sum(counts.values())
    for name, counts in kinds.items():
        print(f"{name}: bad by {', '.join(f'{what} ({times})' for what, times in counts.most_common())}")
    for line in lines:
        print(line)
    if total:
        print(f"{total} verdicts are wrong; their scenarios are in {room}")
        return 1
    shutil.rmtree(room)
    return 0


if __name__ == "__main__":
    sys.exit(main())
