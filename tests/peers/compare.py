"""How fast the same closed loop is simulated here and by two simulators of electric drives that are published for Python.

The loop is that of `speed_loop.toml`: the same motor, the same reference, current and velocity control with the same periods. Of
servobench the whole process of `servobench run --keep none` counts, with its start, an idle position loop, recording, metrics and
verdict; of the others the simulation alone, without the start of Python, imports and the making of the model. They run in turn, one
after the other, and the median of the rounds counts.

The program fails where one of them does not simulate the same thing: errors, current, torque, power and loss have to agree with
servobench's within `TOLERANCE`.

`cargo xtask bench peers` runs it. `SERVOBENCH` names the program. With `--json` the result is written as JSON.
"""

import json
import os
import statistics
import subprocess
import sys
import tempfile
import time
from collections.abc import Callable
from importlib.metadata import version
from pathlib import Path

# Threads for small matrices would cost more than they bring. Said before numpy is loaded.
os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")

import by_gym_electric_motor
import by_motulator
from loop import Loop

SCENARIO = Path(__file__).with_name("speed_loop.toml")
ROUNDS = 5
TOLERANCE = 0.01
"""Largest difference from servobench, as a part. The current controller of motulator and Euler's method make up to 0.75 %."""
LONG = {"run.duration": "60 s", "program.0.hold": "29.4 s", "program.1.hold": "29.4 s"}
"""The same loop, its velocities held longer: in the short run the start of the process is most of the time."""

PEERS: dict[str, Callable[[Loop], tuple[float, dict[str, float]]]] = {
    f"motulator {version('motulator')}": by_motulator.simulate,
    f"gym-electric-motor {version('gym-electric-motor')}, default solver": by_gym_electric_motor.with_default_solver,
    f"gym-electric-motor {version('gym-electric-motor')}, Euler": by_gym_electric_motor.with_euler,
    f"gym-electric-motor {version('gym-electric-motor')}, Euler, no environment": by_gym_electric_motor.bare,
}
SHORT_RUN, LONG_RUN = "servobench, whole process", "servobench, whole process, longer"


def run(servobench: str, room: Path, overrides: dict[str, str]) -> tuple[float, dict]:
    """Seconds by the clock for a whole run of servobench, and its results."""
    command = [servobench, "run", SCENARIO, "--keep", "none", "--jobs", "1", "--quiet", "--out", room / "out"]
    for key, value in overrides.items():
        command += ["--set", f"{key}={value}"]
    begun = time.perf_counter()
    done = subprocess.run(command, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, check=False)
    seconds = time.perf_counter() - begun
    if done.returncode != 0:
        sys.exit(f"servobench ended with exit code {done.returncode}: {done.stdout}")
    (result,) = json.loads((room / "out" / "results.json").read_text())["scenarios"]
    return seconds, result


def differences(ours: dict[str, dict], theirs: dict[str, float]) -> dict[str, float]:
    """By what part each value of a peer's course is beside servobench's."""
    return {name: float(value) / ours[name]["value"] - 1 for name, value in theirs.items()}


def main() -> None:
    """Simulates in turn, compares, and says who is how fast."""
    servobench = os.environ.get("SERVOBENCH") or sys.exit("SERVOBENCH has to name the program, as in `cargo xtask bench peers`")
    simulated, times, beside = {}, {}, {}
    with tempfile.TemporaryDirectory(prefix="servobench-peers-") as folder:
        room = Path(folder)
        _, known = run(servobench, room, {})
        loop = Loop.of(known["parameters"])
        for _ in range(ROUNDS):
            for name, overrides in ((SHORT_RUN, {}), (LONG_RUN, LONG)):
                seconds, result = run(servobench, room, overrides)
                simulated[name] = result["duration"]
                times.setdefault(name, []).append(seconds)
            for name, simulate in PEERS.items():
                seconds, course = simulate(loop)
                simulated[name] = loop.duration
                times.setdefault(name, []).append(seconds)
                beside[name] = differences(known["metrics"], course)
    speeds = {name: [simulated[name] / seconds for seconds in of] for name, of in times.items()}
    say = print_json if "--json" in sys.argv[1:] else print_table
    say(simulated, speeds, beside)
    for name, by in beside.items():
        for what, part in by.items():
            if not abs(part) <= TOLERANCE:
                sys.exit(f"{name} simulates something else: its {what} is {part:+.1%} beside servobench's")


def print_json(simulated: dict[str, float], speeds: dict[str, list[float]], beside: dict[str, dict[str, float]]) -> None:
    """One object: by program what it simulates, how fast in each round, and where it is beside servobench."""
    rows = {
        name: {"simulated": simulated[name], "speed": statistics.median(of), "rounds": of, "differences": beside.get(name, {})}
        for name, of in speeds.items()
    }
    print(json.dumps({"unit": "simulated seconds per second", "tolerance": TOLERANCE, "programs": rows}, indent=2))


def print_table(simulated: dict[str, float], speeds: dict[str, list[float]], beside: dict[str, dict[str, float]]) -> None:
    """A line for each program, servobench's two first."""
    medians = {name: statistics.median(of) for name, of in speeds.items()}
    names = {name: shown(name, simulated[name]) for name in speeds}
    width = max(map(len, names.values()))
    short, long = (f"{simulated[name]:g} s" for name in (SHORT_RUN, LONG_RUN))
    print(f"The loop of {SCENARIO.name} in simulated seconds per second: median of {ROUNDS} rounds,")
    print(f"least and largest; how many times as fast servobench's runs of {short} and {long}")
    print("are; the largest difference from its errors, current, torque, power and loss.")
    print("GEM is gym-electric-motor; bare is without the environment around its motor.\n")
    print(f"{'':{width}} {'speed':>6} {'':15} {short:>7} {long:>7} {'differs':>8}")
    for name, of in speeds.items():
        line = f"{names[name]:{width}} {medians[name]:6.3g} {f'({min(of):.3g}–{max(of):.3g})':15}"
        if name in beside:
            ratios = (medians[ours] / medians[name] for ours in (SHORT_RUN, LONG_RUN))
            line += "".join(f" {f'{int(ratio)} ×':>7}" for ratio in ratios)
            line += f" {max(map(abs, beside[name].values())):8.2%}"
        print(line.rstrip())


def shown(name: str, simulated: float) -> str:
    """The name in the table, which has eighty columns."""
    if name in (SHORT_RUN, LONG_RUN):
        return f"servobench, all, {simulated:g} s"
    return name.replace("gym-electric-motor", "GEM").replace("no environment", "bare")


if __name__ == "__main__":
    main()
